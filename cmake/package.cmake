# The Debian packages, `cmake --workflow --preset package`: pbskin (the program) and libpbs-dev (the libraries). Their
# dependencies follow from the linked libraries.
set(CPACK_PACKAGE_NAME pbskin)
set(CPACK_PACKAGE_VENDOR "The pbskin maintainers")
set(CPACK_PACKAGE_CONTACT "The pbskin maintainers <pbskin@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_FILE ${PROJECT_SOURCE_DIR}/cmake/package/description.txt)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)

set(CPACK_COMPONENTS_ALL program method meshes characters analysis)
if(PBS_WITH_FEM)
    list(APPEND CPACK_COMPONENTS_ALL fem)
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME pbskin)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS
    "assimp-testmodels, python3, python3-numpy, python3-matplotlib, python3-vtk9, xvfb, xauth")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "libpbs-dev, cube2-data, npm, snakemake, slurm-client")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Static libraries, headers and the CMake package pbs.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpbs-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libtbb-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS
    "libvtk9-dev, libassimp-dev, libminizip-dev, libcgal-dev, libpugixml-dev, libtomlplusplus-dev, nlohmann-json3-dev, \
libgsl-dev, libfmt-dev, libxxhash-dev, libdeal.ii-dev, libsuitesparse-dev")

# cpack refuses kernels that are built for the instructions of one machine.
set(CPACK_PBS_NATIVE ${PBS_NATIVE})
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/package/portable_only.cmake)

install(FILES cmake/package/copyright DESTINATION share/doc/pbskin COMPONENT program)
install(FILES cmake/package/copyright DESTINATION share/doc/libpbs-dev COMPONENT method)
include(CPack)
cpack_add_component_group(program)
cpack_add_component_group(development)
cpack_add_component(program GROUP program)
set(libraries ${CPACK_COMPONENTS_ALL})
list(REMOVE_ITEM libraries program)
foreach(component IN LISTS libraries)
    cpack_add_component(${component} GROUP development)
endforeach()
