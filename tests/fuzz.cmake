# Tests of the project's own parsing, and of the validation after the readers' processes, with any bytes. Every build replays the corpus and
# past findings (robustness). With PBS_WITH_FUZZ and clang, libFuzzer searches for new ones: `cmake --preset fuzz`, then `ctest -L fuzz`,
# 60 s per target (fuzz/targets.py).
if(NOT PBS_WITH_RIG_IMPORT OR NOT PBS_WITH_EXPERIMENTS)
    return()
endif()
find_known(fmt)
find_known(tomlplusplus)
find_known(nlohmann_json)
find_known(assimp)
find_known(pugixml)
find_known(ZLIB)
find_known(VTK COMPONENTS CommonCore CommonDataModel CommonMisc IOLegacy IOXML)

# fuzz_target(fuzz/NAME.cpp LIBRARY SOURCE...): a target and the sources that it tests. The replay links the library. libFuzzer's program
# compiles the sources itself, instrumented and without CGAL, and takes from the library what else they call, so that the preset compiles
# each source alone. Libraries from elsewhere are linked by fuzz_libraries(NAME LIBRARY...).
function(fuzz_target target library)
    cmake_path(GET target STEM name)
    set(folders ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus/${name})
    if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/findings/${name})
        list(APPEND folders ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/findings/${name})
    endif()
    add_executable(replay_${name} ${target} fuzz/replay.cpp)
    # The precompiled header of the tests includes GoogleTest and JSON.
    target_link_libraries(replay_${name} PRIVATE ${library} nlohmann_json::nlohmann_json GTest::gtest)
    target_precompile_headers(replay_${name} REUSE_FROM ${PBS_TEST_HEADERS})
    unity_build(replay_${name})
    set_target_properties(replay_${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
    add_test(NAME robustness/fuzz/replay_${name} COMMAND replay_${name} ${folders})
    set_tests_properties(robustness/fuzz/replay_${name} PROPERTIES LABELS robustness TIMEOUT 60)
    if(PBS_WITH_FUZZ)
        list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/)
        add_executable(fuzz_${name} ${target} ${ARGN})
        target_link_libraries(fuzz_${name} PRIVATE pbs_settings ${library} fmt::fmt tomlplusplus::tomlplusplus nlohmann_json::nlohmann_json)
        set_target_properties(fuzz_${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
        target_compile_options(fuzz_${name} PRIVATE -UPBS_WITH_CGAL -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined)
        target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer,address,undefined)
    endif()
endfunction()

function(fuzz_libraries name)
    target_link_libraries(replay_${name} PRIVATE ${ARGN})
    if(PBS_WITH_FUZZ)
        target_link_libraries(fuzz_${name} PRIVATE ${ARGN})
    endif()
endfunction()

fuzz_target(fuzz/scene.cpp experiments
    experiments/settings/scene_values.cpp experiments/scene/scene_keys.cpp experiments/deformers/pbs_settings.cpp
    experiments/deformers/fem/fem_kind.cpp experiments/process/machine.cpp pbs/geometry/module.cpp
    pbs/geometry/files.cpp pbs/geometry/input_error.cpp)
fuzz_target(fuzz/mesh.cpp pbs_mesh_io
    pbs/geometry/mesh_checks.cpp pbs/geometry/mesh_repairs.cpp pbs/geometry/files.cpp pbs/geometry/tet_mesh.cpp
    pbs/geometry/topology.cpp pbs/geometry/input_error.cpp)
fuzz_target(fuzz/skeleton.cpp pbs_character
    pbs/character/skeleton_file.cpp pbs/character/folded_skeleton.cpp pbs/geometry/files.cpp pbs/geometry/input_error.cpp)
fuzz_target(fuzz/clip.cpp pbs_character
    pbs/character/clip.cpp pbs/character/joint_names.cpp pbs/character/retarget.cpp pbs/skinning/pose.cpp pbs/geometry/input_error.cpp)
fuzz_target(fuzz/rig.cpp pbs_rig
    pbs/rig/rigged_body.cpp pbs/rig/gltf_rig.cpp pbs/rig/gltf_model.cpp pbs/rig/rig_pose.cpp
    pbs/rig/rig_reader.cpp pbs/rig/rig_repairs.cpp pbs/skinning/pose.cpp
    pbs/geometry/content_format.cpp pbs/geometry/files.cpp pbs/geometry/input_error.cpp)
fuzz_target(fuzz/texts.cpp experiments
    analysis/records/tables.cpp analysis/records/record_files.cpp
    experiments/settings/scene_values.cpp experiments/scene/scene_keys.cpp experiments/deformers/pbs_settings.cpp
    experiments/deformers/fem/fem_kind.cpp experiments/process/machine.cpp pbs/geometry/module.cpp
    pbs/character/clip.cpp pbs/geometry/files.cpp pbs/geometry/input_error.cpp)
fuzz_target(fuzz/files.cpp pbs_character
    pbs/character/frankie.cpp pbs/character/skinning_weights.cpp pbs/skinning/pose.cpp pbs/geometry/mesh_io.cpp
    pbs/geometry/content_format.cpp pbs/geometry/medit_files.cpp pbs/geometry/msh_files.cpp pbs/geometry/surface_obj.cpp
    pbs/geometry/text_words.cpp pbs/geometry/mesh_checks.cpp pbs/geometry/mesh_repairs.cpp pbs/geometry/files.cpp
    pbs/geometry/input_error.cpp)
fuzz_target(fuzz/assimp.cpp pbs_rig
    pbs/rig/collada_curves.cpp pbs/rig/collada_document.cpp pbs/rig/collada_rig.cpp pbs/rig/fbx_animation.cpp
    pbs/rig/fbx_document.cpp pbs/rig/fbx_mesh.cpp
    pbs/rig/fbx_objects.cpp pbs/rig/fbx_polygons.cpp pbs/rig/fbx_rig.cpp pbs/rig/fbx_transform.cpp
    pbs/rig/rigged_body.cpp pbs/rig/rig_pose.cpp pbs/rig/rig_reader.cpp pbs/rig/rig_repairs.cpp pbs/skinning/pose.cpp
    pbs/geometry/content_format.cpp
    pbs/geometry/files.cpp pbs/geometry/input_error.cpp)
fuzz_libraries(assimp assimp::assimp pugixml::pugixml ${MINIZIP_LIBRARY} ZLIB::ZLIB)
fuzz_target(fuzz/content.cpp pbs_rig
    pbs/geometry/content_format.cpp pbs/geometry/mesh_io.cpp pbs/geometry/mesh_checks.cpp pbs/geometry/mesh_repairs.cpp
    pbs/geometry/msh_files.cpp pbs/geometry/files.cpp pbs/geometry/vtk_files.cpp pbs/rig/surface_reader.cpp
    pbs/geometry/tet_mesh.cpp pbs/geometry/topology.cpp pbs/geometry/input_error.cpp)
fuzz_libraries(content pbs_mesh_io ${VTK_LIBRARIES})
if(PBS_WITH_FUZZ)
    set(settings PBS_SOURCE=${PROJECT_SOURCE_DIR} PBS_FUZZ_PROGRAMS=${CMAKE_BINARY_DIR}/tests PBS_FUZZ_FOLDER=${CMAKE_BINARY_DIR}/fuzz
        PYTHONPATH=${CMAKE_CURRENT_SOURCE_DIR}/support)
    add_test(NAME fuzz/targets COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/targets.py)
    set_tests_properties(fuzz/targets PROPERTIES LABELS fuzz TIMEOUT 600 ENVIRONMENT "${settings}")
endif()
