# Tests of mesh files, meshing, characters and clips. Those of the human and of CMU's clips need Debian's assimp-testmodels and fail
# without it. What an option leaves out has separate tests.
set(left_out)
if(PBS_WITH_MESH_IO)
    list(APPEND left_out pbs/geometry/mesh_io_unavailable)
else()
    list(APPEND left_out pbs/geometry/content_format pbs/geometry/child_process pbs/geometry/guarded_reading pbs/geometry/medit_files
        pbs/geometry/mesh_checks pbs/geometry/mesh_io pbs/geometry/mesh_repairs pbs/geometry/msh_files pbs/geometry/surface_obj
        pbs/geometry/surface_polygons pbs/geometry/text_words pbs/geometry/vtk_files pbs/rig/surface_reader pbs/character/bodies
        pbs/character/body_cache)
endif()
if(PBS_WITH_CGAL)
    list(APPEND left_out pbs/geometry/meshing_unavailable)
else()
    list(APPEND left_out pbs/geometry/meshing pbs/geometry/self_intersection pbs/geometry/surface_polygons pbs/character/bodies
        pbs/character/bone_capsules)
endif()
if(NOT PBS_WITH_RIG_IMPORT)
    list(APPEND left_out pbs/character/skeleton_file pbs/character/clip pbs/character/clip_of_rig pbs/character/joint_names
        pbs/character/bodies pbs/rig/collada_document pbs/rig/collada_rig pbs/rig/fbx_document pbs/rig/fbx_rig pbs/rig/glb_writer
        pbs/rig/gltf_rig pbs/rig/rig_reader)
endif()

pbs_tests(unit pbs_files
    FILES pbs/geometry/content_format pbs/geometry/child_process pbs/geometry/guarded_reading pbs/geometry/medit_files
        pbs/geometry/mesh_checks pbs/geometry/mesh_io
        pbs/geometry/mesh_io_unavailable pbs/geometry/mesh_repairs pbs/geometry/meshing pbs/geometry/meshing_unavailable
        pbs/geometry/msh_files pbs/geometry/self_intersection pbs/geometry/surface_obj pbs/geometry/surface_polygons
        pbs/geometry/text_words pbs/geometry/vtk_files
    EXCEPT ${left_out}
    LIBRARIES pbs_rig pbs_mesh_io pbs_meshing pbs_module)
pbs_tests(unit pbs_rig FOLDERS pbs/rig EXCEPT ${left_out} LIBRARIES pbs_rig pbs_mesh_io)
pbs_tests(unit pbs_character FOLDERS pbs/character EXCEPT ${left_out} LIBRARIES pbs_character pbs_mesh_io)
if(TARGET pbskin_cholmod)
    pbs_tests(unit pbs_flesh FOLDERS pbs/flesh LIBRARIES pbs_flesh ${threads})
    add_dependencies(test_unit_pbs_flesh pbskin_cholmod)
endif()
if(TARGET pbskin_cholmod)  # a module that is loaded
    add_dependencies(test_unit_pbs_files pbskin_cholmod)
    target_compile_definitions(test_unit_pbs_files PRIVATE PBS_WITH_CHOLMOD)
endif()
if(PBS_WITH_MESH_IO)
    find_path(GMSH_INCLUDE_DIR gmsh.h REQUIRED)
    find_library(GMSH_LIBRARY gmsh REQUIRED)
    require_known_header(gmsh ${GMSH_INCLUDE_DIR}/gmsh.h GMSH_API_VERSION_MAJOR GMSH_API_VERSION_MINOR)
    pbs_tests(robustness pbs_geometry FOLDERS pbs/geometry LIBRARIES pbs_rig pbs_mesh_io)
    pbs_tests(verification pbs_geometry FOLDERS pbs/geometry LIBRARIES pbs_mesh_io ${GMSH_LIBRARY})  # Gmsh's library, VTK's Python
endif()
if(PBS_WITH_CGAL)
    pbs_tests(properties pbs_meshing FILES pbs/geometry/meshing_repeats pbs/solver/orders LIBRARIES pbs_meshing)
endif()
if(PBS_WITH_RIG_IMPORT)
    if(NOT PBS_WITH_CGAL OR NOT PBS_WITH_MESH_IO)
        list(APPEND left_out pbs/character/human pbs/character/fetched_bodies pbs/character/model_character)
    endif()
    if(PBS_WITH_MESH_IO)
        pbs_tests(robustness pbs_readers FOLDERS pbs/readers LIBRARIES pbs_character pbs_rig pbs_mesh_io)
    endif()
    pbs_tests(robustness pbs_character FOLDERS pbs/character LIBRARIES pbs_character)
    pbs_tests(verification pbs_character FOLDERS pbs/character EXCEPT ${left_out} LIBRARIES pbs_character)
endif()
foreach(target unit_pbs_files unit_pbs_rig unit_pbs_character robustness_pbs_readers)  # tests/support/arm_in_formats.hpp
    if(TARGET test_${target})
        target_compile_definitions(test_${target} PRIVATE PBS_RIG_SEEDS="${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus/assimp")
    endif()
endforeach()
