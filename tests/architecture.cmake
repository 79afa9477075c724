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

find_program(PBS_CPPCHECK NAMES cppcheck)
if(PBS_CPPCHECK)
    add_test(NAME architecture/static_analysis
        COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/static_analysis_test.py)
    set_tests_properties(architecture/static_analysis PROPERTIES LABELS architecture TIMEOUT 600 ENVIRONMENT PBS_CPPCHECK=${PBS_CPPCHECK})
else()
    message(STATUS "cppcheck is not there: its test is left out")
endif()

find_program(PBS_SHELLCHECK NAMES shellcheck)
if(PBS_SHELLCHECK)
    add_test(NAME architecture/shell_scripts
        COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/shell_scripts_test.py)
    set_tests_properties(architecture/shell_scripts PROPERTIES LABELS architecture TIMEOUT 60 ENVIRONMENT PBS_SHELLCHECK=${PBS_SHELLCHECK})
else()
    message(STATUS "shellcheck is not there: its test is left out")
endif()
