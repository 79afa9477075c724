# Tests of the project's own parsing, and of the validation after the readers' processes, with any bytes. Every build
# replays the corpus and past findings (robustness). With PBS_WITH_FUZZ and clang, libFuzzer searches for new ones:
# `cmake --preset fuzz`, then `ctest -L fuzz`, 60 s per target (fuzz/targets.py).
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

# fuzz_target(fuzz/NAME.cpp LIBRARY SOURCE...): a target and the sources that it tests. The replay links the library.
# libFuzzer's program compiles the sources itself, instrumented and without CGAL, and takes from the library what else
# they call, so that the preset compiles each source alone. Libraries from elsewhere are linked by fuzz_libraries
# (NAME LIBRARY...).
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
        target_link_libraries(fuzz_${name} PRIVATE pbs_settings ${library} fmt::fmt tomlplusplus::tomlplusplus
            nlohmann_json::nlohmann_json)
        set_target_properties(fuzz_${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
        target_compile_options(fuzz_${name} PRIVATE -UPBS_WITH_CGAL -fsanitize=fuzzer,address,undefined
            -fno-sanitize-recover=undefined)
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
    experiments/deformers/fem/fem_kind.cpp experiments/process/machine.cpp pbs/system/module.cpp
    pbs/system/files.cpp pbs/geometry/input_error.cpp)
fuzz_target(fuzz/mesh.cpp pbs_meshes
    experiments/meshes/mesh_checks.cpp experiments/meshes/mesh_repairs.cpp pbs/system/files.cpp
    pbs/geometry/tet_mesh.cpp pbs/geometry/topology.cpp pbs/geometry/input_error.cpp)
fuzz_target(fuzz/skeleton.cpp pbs_characters
    experiments/characters/skeleton_file.cpp experiments/characters/folded_skeleton.cpp pbs/system/files.cpp
    pbs/geometry/input_error.cpp)
fuzz_target(fuzz/clip.cpp pbs_characters
    experiments/clips/clip.cpp experiments/clips/joint_names.cpp experiments/clips/retarget.cpp pbs/skinning/pose.cpp
    pbs/geometry/input_error.cpp)
if(PBS_WITH_FUZZ)
    # its table of names as a text
    target_include_directories(fuzz_clip PRIVATE ${PROJECT_BINARY_DIR}/experiments/clips)
endif()
fuzz_target(fuzz/rig.cpp pbs_rigs
    experiments/rigs/rigged_body.cpp experiments/rigs/gltf_rig.cpp experiments/rigs/gltf_model.cpp
    experiments/rigs/rig_pose.cpp experiments/rigs/rig_reader.cpp experiments/rigs/rig_repairs.cpp pbs/skinning/pose.cpp
    experiments/meshes/content_format.cpp pbs/system/files.cpp pbs/geometry/input_error.cpp)
fuzz_target(fuzz/texts.cpp experiments
    analysis/records/tables.cpp analysis/records/record_files.cpp
    experiments/settings/scene_values.cpp experiments/scene/scene_keys.cpp experiments/deformers/pbs_settings.cpp
    experiments/deformers/fem/fem_kind.cpp experiments/process/machine.cpp pbs/system/module.cpp
    experiments/clips/clip.cpp pbs/system/files.cpp pbs/geometry/input_error.cpp)
fuzz_target(fuzz/files.cpp pbs_characters
    experiments/characters/frankie.cpp experiments/characters/skinning_weights.cpp pbs/skinning/pose.cpp
    experiments/meshes/mesh_io.cpp experiments/meshes/content_format.cpp experiments/meshes/medit_files.cpp
    experiments/meshes/msh_files.cpp experiments/meshes/surface_obj.cpp experiments/meshes/text_words.cpp
    experiments/meshes/mesh_checks.cpp experiments/meshes/mesh_repairs.cpp pbs/system/files.cpp
    pbs/geometry/input_error.cpp)
fuzz_target(fuzz/assimp.cpp pbs_rigs
    experiments/rigs/collada_curves.cpp experiments/rigs/collada_document.cpp experiments/rigs/collada_rig.cpp
    experiments/rigs/fbx_animation.cpp experiments/rigs/fbx_document.cpp experiments/rigs/fbx_mesh.cpp
    experiments/rigs/fbx_objects.cpp experiments/rigs/fbx_polygons.cpp experiments/rigs/fbx_rig.cpp
    experiments/rigs/fbx_transform.cpp experiments/rigs/rigged_body.cpp experiments/rigs/rig_pose.cpp
    experiments/rigs/rig_reader.cpp experiments/rigs/rig_repairs.cpp pbs/skinning/pose.cpp
    experiments/meshes/content_format.cpp pbs/system/files.cpp pbs/geometry/input_error.cpp)
fuzz_libraries(assimp assimp::assimp pugixml::pugixml ${MINIZIP_LIBRARY} ZLIB::ZLIB)
fuzz_target(fuzz/content.cpp pbs_rigs
    experiments/meshes/content_format.cpp experiments/meshes/mesh_io.cpp experiments/meshes/mesh_checks.cpp
    experiments/meshes/mesh_repairs.cpp experiments/meshes/msh_files.cpp pbs/system/files.cpp
    experiments/meshes/vtk_files.cpp experiments/rigs/surface_reader.cpp pbs/geometry/tet_mesh.cpp
    pbs/geometry/topology.cpp pbs/geometry/input_error.cpp)
fuzz_libraries(content pbs_meshes ${VTK_LIBRARIES})
if(PBS_WITH_FUZZ)
    set(settings PBS_SOURCE=${PROJECT_SOURCE_DIR} PBS_FUZZ_PROGRAMS=${CMAKE_BINARY_DIR}/tests
        PBS_FUZZ_FOLDER=${CMAKE_BINARY_DIR}/fuzz PYTHONPATH=${CMAKE_CURRENT_SOURCE_DIR}/support)
    add_test(NAME fuzz/targets COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/targets.py)
    set_tests_properties(fuzz/targets PROPERTIES LABELS fuzz TIMEOUT 600 ENVIRONMENT "${settings}")
endif()
