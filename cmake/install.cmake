# `cmake --install`: the libraries for `find_package(pbs COMPONENTS ...)`, one install component each, and the program
# with its data. All paths are relative to the prefix, so that an installation may be moved.
include(CMakePackageConfigHelpers)
set(config_folder lib/cmake/pbs)

# pbs_install_libraries(COMPONENT TARGET=NAME...): installs static libraries, which other projects know as pbs::NAME.
function(pbs_install_libraries component)
    foreach(pair IN LISTS ARGN)
        string(REPLACE "=" ";" pair ${pair})
        list(POP_FRONT pair target name)
        set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
        install(TARGETS ${target} EXPORT pbs-${component} ARCHIVE DESTINATION lib COMPONENT ${component})
    endforeach()
    install(EXPORT pbs-${component} FILE pbs-${component}-targets.cmake NAMESPACE pbs:: DESTINATION ${config_folder}
        COMPONENT ${component})
endfunction()

# pbs_install_headers(COMPONENT FOLDER...): installs headers by the same paths below include/ as in the sources.
function(pbs_install_headers component)
    foreach(folder IN LISTS ARGN)
        file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.hpp)
        # Headers internal to readers and meshers, to text, files and signals, to solvers, and to parts of bodies.
        set(no_call_for_users
            "mesh_io_|meshing_|cgal_versions|source_file|text_words|content_format|guarded_reading|child_process"
            deferred_sigterm
            "flesh/(local_shape|packed_|projective_|vbd|xpbd_)"
            "packed/(groups|lanes|parallel|vertex_order)"
            "solver/(algorithm_1|project_plain)"
            "rigs/(assimp_|collada_|fbx_(document|objects|polygons|rig)|gltf_|tiny_gltf)"
            "characters/json_file")
        list(JOIN no_call_for_users "|" no_call_for_users)
        list(FILTER headers EXCLUDE REGEX "/(${no_call_for_users})[a-z_]*\\.hpp$")
        install(FILES ${headers} DESTINATION include/${folder} COMPONENT ${component})
    endforeach()
endfunction()

pbs_install_libraries(method pbs_settings=settings pbs_method=method)
pbs_install_headers(method pbs/geometry pbs/system pbs/packed pbs/skinning pbs/constraints pbs/solver pbs/author)
pbs_install_libraries(meshes pbs_system=system pbs_meshing=meshing pbs_meshes=meshes)
pbs_install_headers(meshes experiments/meshes)
pbs_install_libraries(characters pbs_flesh=flesh pbs_rigs=rigs pbs_clips=clips pbs_characters=characters)
pbs_install_headers(characters pbs/flesh experiments/rigs experiments/clips experiments/characters)
if(PBS_WITH_ANALYSIS)
    pbs_install_libraries(analysis analysis=analysis)
    pbs_install_headers(analysis analysis/metrics analysis/statistics analysis/verdicts analysis/records)
endif()
if(PBS_WITH_FEM)
    pbs_install_libraries(fem reference_fem_laws=fem_laws reference_fem=fem)
    pbs_install_headers(fem reference_fem reference_fem/laws reference_fem/newton reference_fem/potentials
        reference_fem/dynamics)
endif()

get_target_property(mesh_links pbs_meshes LINK_LIBRARIES)
set(vtk_components ${mesh_links})
list(FILTER vtk_components INCLUDE REGEX "^VTK::")
list(TRANSFORM vtk_components REPLACE "^VTK::" "")
list(JOIN vtk_components " " vtk_components)
configure_package_config_file(cmake/pbs-config.cmake.in pbs-config.cmake INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(pbs-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pbs-config.cmake ${PROJECT_BINARY_DIR}/pbs-config-version.cmake
    DESTINATION ${config_folder} COMPONENT method)

if(TARGET pbskin)
    include(install_program)
endif()
