# Our own parsing, and the validation behind the readers' processes, on any bytes. In every build the corpus and past findings are replayed
# (robustness); with PBS_WITH_FUZZ, by clang, libFuzzer looks for new ones: `cmake --preset fuzz`, then `ctest -L fuzz`, 60 s a
# target (fuzz/targets.py).
if(NOT PBS_WITH_RIG_IMPORT OR NOT PBS_WITH_EXPERIMENTS)
    return()
endif()
find_package(fmt REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)

# fuzz_target(NAME TARGET SOURCE...): the target and what it tries, compiled for it alone, so that all of it is instrumented.
function(fuzz_target name target)
    list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/)
    set(kinds replay)
    if(PBS_WITH_FUZZ)
        list(APPEND kinds fuzz)
    endif()
    foreach(kind IN LISTS kinds)
        add_executable(${kind}_${name} ${target} ${ARGN})
        target_link_libraries(${kind}_${name} PRIVATE pbs_settings fmt::fmt tomlplusplus::tomlplusplus nlohmann_json::nlohmann_json)
        set_target_properties(${kind}_${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
    endforeach()
    set(folders ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus/${name})
    if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/findings/${name})
        list(APPEND folders ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/findings/${name})
    endif()
    target_sources(replay_${name} PRIVATE fuzz/replay.cpp)
    add_test(NAME robustness/fuzz/replay_${name} COMMAND replay_${name} ${folders})
    set_tests_properties(robustness/fuzz/replay_${name} PROPERTIES LABELS robustness TIMEOUT 60)
    if(PBS_WITH_FUZZ)
        target_compile_options(fuzz_${name} PRIVATE -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined)
        target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer,address,undefined)
    endif()
endfunction()

fuzz_target(scene fuzz/scene.cpp experiments/scene/scene_values.cpp experiments/scene/scene_schema.cpp analysis/records/record_text.cpp
    pbs/geometry/toml_text.cpp pbs/geometry/nearest_name.cpp
    pbs/geometry/input_error.cpp)
fuzz_target(mesh fuzz/mesh.cpp pbs/geometry/guarded_reading.cpp pbs/geometry/isolated_reader.cpp pbs/geometry/reading_limits.cpp
    pbs/geometry/mesh_io_checks.cpp pbs/geometry/mesh_io_files.cpp pbs/geometry/text_file.cpp
    pbs/geometry/tet_volume.cpp pbs/geometry/topology.cpp pbs/geometry/input_error.cpp)
fuzz_target(skeleton fuzz/skeleton.cpp pbs/character/skeleton_file.cpp pbs/character/skeleton_order.cpp pbs/geometry/text_file.cpp
    pbs/geometry/toml_text.cpp
    pbs/geometry/nearest_name.cpp pbs/geometry/input_error.cpp)
fuzz_target(clip fuzz/clip.cpp pbs/character/clip_bytes.cpp pbs/character/retarget.cpp pbs/character/retarget_plan.cpp
    pbs/character/joint_map.cpp
    pbs/skinning/pose.cpp pbs/skinning/skeleton.cpp pbs/geometry/input_error.cpp)
fuzz_target(texts fuzz/texts.cpp analysis/records/csv_reader.cpp analysis/records/csv_table.cpp analysis/records/atomic_file.cpp experiments/scene/scene_values.cpp
    experiments/scene/scene_schema.cpp analysis/records/record_text.cpp pbs/character/bvh_header.cpp pbs/geometry/atomic_file.cpp
    pbs/geometry/text_file.cpp pbs/geometry/toml_text.cpp pbs/geometry/nearest_name.cpp pbs/geometry/input_error.cpp)
fuzz_target(files fuzz/files.cpp pbs/character/iqm.cpp pbs/character/weights_file.cpp pbs/skinning/skeleton.cpp
    pbs/geometry/tetgen_reader.cpp pbs/geometry/msh_reader.cpp pbs/geometry/mesh_io_files.cpp pbs/geometry/text_file.cpp
    pbs/geometry/nearest_name.cpp pbs/geometry/input_error.cpp)
if(PBS_WITH_FUZZ)
    set(settings PBS_SOURCE=${PROJECT_SOURCE_DIR} PBS_FUZZ_PROGRAMS=${CMAKE_BINARY_DIR}/tests PBS_FUZZ_FOLDER=${CMAKE_BINARY_DIR}/fuzz
        PYTHONPATH=${CMAKE_CURRENT_SOURCE_DIR}/support)
    add_test(NAME fuzz/targets COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/targets.py)
    set_tests_properties(fuzz/targets PROPERTIES LABELS fuzz TIMEOUT 400 ENVIRONMENT "${settings}")
endif()
