# Tests that read the source tree: includes, functions, build files and text.
pbs_tests(architecture laws FOLDERS . LIBRARIES pbs_settings)
target_compile_definitions(test_architecture_laws PRIVATE PBS_SOURCE_ROOT="${PROJECT_SOURCE_DIR}")

add_test(NAME architecture/readme COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/readme_test.py)
set_tests_properties(architecture/readme PROPERTIES LABELS architecture TIMEOUT 60)

find_program(PBS_CPPCHECK NAMES cppcheck)
if(PBS_CPPCHECK)
    add_test(NAME architecture/static_analysis
        COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/checkers_test.py Cppcheck)
    set_tests_properties(architecture/static_analysis PROPERTIES LABELS architecture TIMEOUT 600 COST 50
        ENVIRONMENT PBS_CPPCHECK=${PBS_CPPCHECK})
else()
    message(STATUS "cppcheck is not installed: its test is left out")
endif()

find_program(PBS_SHELLCHECK NAMES shellcheck)
if(PBS_SHELLCHECK)
    add_test(NAME architecture/shell_scripts
        COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/checkers_test.py Shellcheck)
    set_tests_properties(architecture/shell_scripts PROPERTIES LABELS architecture TIMEOUT 60
        ENVIRONMENT PBS_SHELLCHECK=${PBS_SHELLCHECK})
else()
    message(STATUS "shellcheck is not installed: its test is left out")
endif()
