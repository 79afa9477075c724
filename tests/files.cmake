# Tests of mesh files, meshing, characters and clips. Those of the human and of CMU's clips need Debian's
# assimp-testmodels and fail without it. What an option leaves out has separate tests.
set(left_out)
if(PBS_WITH_MESH_IO)
    list(APPEND left_out experiments/meshes/mesh_io_unavailable)
else()
    list(APPEND left_out experiments/meshes/content_format experiments/meshes/guarded_reading
        experiments/meshes/medit_files experiments/meshes/mesh_checks experiments/meshes/mesh_io
        experiments/meshes/mesh_repairs experiments/meshes/msh_files experiments/meshes/surface_obj
        experiments/meshes/surface_polygons experiments/meshes/text_words experiments/meshes/vtk_files
        experiments/rigs/surface_reader experiments/characters/bodies experiments/characters/body_cache)
endif()
if(PBS_WITH_CGAL)
    list(APPEND left_out experiments/meshes/meshing_unavailable)
else()
    list(APPEND left_out experiments/meshes/meshing experiments/meshes/self_intersection
        experiments/meshes/surface_polygons experiments/characters/bodies experiments/characters/bone_capsules)
endif()
if(NOT PBS_WITH_RIG_IMPORT)
    list(APPEND left_out experiments/characters/skeleton_file experiments/characters/bodies experiments/clips/clip
        experiments/clips/clip_of_rig experiments/clips/joint_names experiments/rigs/collada_document
        experiments/rigs/collada_rig experiments/rigs/fbx_document experiments/rigs/fbx_rig experiments/rigs/glb_writer
        experiments/rigs/gltf_rig experiments/rigs/rig_reader)
endif()

pbs_tests(unit meshes FOLDERS experiments/meshes FILES pbs/system/child_process EXCEPT ${left_out}
    LIBRARIES pbs_rigs pbs_meshes pbs_meshing)
pbs_tests(unit rigs FOLDERS experiments/rigs EXCEPT ${left_out} LIBRARIES pbs_rigs pbs_meshes)
pbs_tests(unit characters FOLDERS experiments/clips experiments/characters EXCEPT ${left_out} LIBRARIES pbs_characters
    pbs_meshes)
if(TARGET pbskin_cholmod)
    pbs_tests(unit pbs_flesh FOLDERS pbs/flesh LIBRARIES pbs_flesh ${threads})
    add_dependencies(test_unit_pbs_flesh pbskin_cholmod)
endif()
if(TARGET pbskin_cholmod)  # a module that is loaded
    add_dependencies(test_unit_meshes pbskin_cholmod)
    target_compile_definitions(test_unit_meshes PRIVATE PBS_WITH_CHOLMOD)
endif()
if(PBS_WITH_MESH_IO)
    find_path(GMSH_INCLUDE_DIR gmsh.h REQUIRED)
    find_library(GMSH_LIBRARY gmsh REQUIRED)
    require_known_header(gmsh ${GMSH_INCLUDE_DIR}/gmsh.h GMSH_API_VERSION_MAJOR GMSH_API_VERSION_MINOR)
    pbs_tests(robustness meshes FOLDERS experiments/meshes LIBRARIES pbs_rigs pbs_meshes)
    # These call Gmsh's library and VTK's Python.
    pbs_tests(verification meshes FOLDERS experiments/meshes LIBRARIES pbs_meshes ${GMSH_LIBRARY})
endif()
if(PBS_WITH_CGAL)
    pbs_tests(properties meshing FILES experiments/meshes/meshing_repeats pbs/solver/orders LIBRARIES pbs_meshing)
endif()
if(PBS_WITH_RIG_IMPORT)
    if(NOT PBS_WITH_CGAL OR NOT PBS_WITH_MESH_IO)
        list(APPEND left_out experiments/characters/human experiments/characters/fetched_bodies
            experiments/characters/model_character)
    endif()
    if(PBS_WITH_MESH_IO)
        pbs_tests(robustness readers FOLDERS experiments/readers LIBRARIES pbs_characters pbs_rigs pbs_meshes)
    endif()
    pbs_tests(robustness characters FOLDERS experiments/characters LIBRARIES pbs_characters)
    pbs_tests(verification characters FOLDERS experiments/clips experiments/characters EXCEPT ${left_out}
        LIBRARIES pbs_characters)
endif()
foreach(target unit_meshes unit_rigs unit_characters robustness_readers)  # tests/support/arm_in_formats.hpp
    if(TARGET test_${target})
        target_compile_definitions(test_${target}
            PRIVATE PBS_RIG_SEEDS="${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus/assimp")
    endif()
endforeach()
