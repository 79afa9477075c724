# Tests that read the source tree: what includes what, sizes, the build files, the text.
add_library(architecture_laws STATIC
    architecture/source_tree.cpp architecture/include_laws.cpp architecture/heavy_headers.cpp architecture/size_laws.cpp
    architecture/build_laws.cpp architecture/kernel_laws.cpp architecture/package_laws.cpp architecture/text_laws.cpp)
target_link_libraries(architecture_laws PUBLIC pbs_settings)
target_compile_definitions(architecture_laws PRIVATE PBS_SOURCE_ROOT="${PROJECT_SOURCE_DIR}")

pbs_test(architecture include_laws_test architecture_laws)
pbs_test(architecture size_laws_test architecture_laws)
pbs_test(architecture build_laws_test architecture_laws)
pbs_test(architecture kernel_laws_test architecture_laws)
pbs_test(architecture text_laws_test architecture_laws)
