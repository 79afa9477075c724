# Tests of the figure scripts.
add_test(NAME unit/paper_figures COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/figures_test.py)
set_tests_properties(unit/paper_figures PROPERTIES LABELS unit TIMEOUT 300)
add_test(NAME unit/paper_figures/listed COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/listed_figures_test.py)
add_test(NAME unit/paper_figures/plots COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/plots_test.py)
set_tests_properties(unit/paper_figures/listed unit/paper_figures/plots PROPERTIES LABELS unit TIMEOUT 300)
add_test(NAME unit/paper_figures/viewer COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/viewer_test.py)
set_tests_properties(unit/paper_figures/viewer PROPERTIES LABELS unit TIMEOUT 300)

# Tests of the viewer's program, if node is installed; ./check --long installs it.
find_program(PBS_NODE NAMES node nodejs)
if(PBS_NODE)
    foreach(name codes faces link shown surface touch)
        add_test(NAME unit/paper_figures/viewer/${name}
            COMMAND ${PBS_NODE} --test ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/viewer/${name}.test.mjs)
        set_tests_properties(unit/paper_figures/viewer/${name} PROPERTIES LABELS unit TIMEOUT 300)
    endforeach()
else()
    message(STATUS "node is not installed: the tests of the viewer's program are left out")
endif()

# Tests in a real browser; only ./check --long runs them.
if(TARGET pbskin)
    add_test(NAME browser/viewer COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/browser/browser_test.py
        $<TARGET_FILE:pbskin> ${CMAKE_BINARY_DIR}/tests/browser)
    set_tests_properties(browser/viewer PROPERTIES LABELS browser SKIP_RETURN_CODE 77 TIMEOUT 1800)
    add_test(NAME browser/quick_results COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/browser/quick_results_test.py
        $<TARGET_FILE:pbskin> ${CMAKE_BINARY_DIR}/tests/browser_quick)
    set_tests_properties(browser/quick_results PROPERTIES LABELS browser SKIP_RETURN_CODE 77 TIMEOUT 3600)
endif()
add_test(NAME unit/paper_figures/report COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/report_test.py)
set_tests_properties(unit/paper_figures/report PROPERTIES LABELS unit TIMEOUT 120)
add_test(NAME unit/paper_figures/report_records
    COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/report_records_test.py)
set_tests_properties(unit/paper_figures/report_records PROPERTIES LABELS unit TIMEOUT 300)
add_test(NAME unit/paper_figures/own COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/own_figures_test.py)
set_tests_properties(unit/paper_figures/own PROPERTIES LABELS unit TIMEOUT 120)
add_test(NAME unit/paper_figures/stills
    COMMAND xvfb-run -a ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/stills_test.py)
set_tests_properties(unit/paper_figures/stills PROPERTIES LABELS unit TIMEOUT 300)
add_test(NAME unit/paper_figures/captions COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/captions_test.py)
set_tests_properties(unit/paper_figures/captions PROPERTIES LABELS unit TIMEOUT 120)
add_test(NAME unit/paper_figures/readme_part
    COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/readme_part_test.py)
set_tests_properties(unit/paper_figures/readme_part PROPERTIES LABELS unit TIMEOUT 120)
add_test(NAME unit/paper_figures/same_pose COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/same_pose_test.py)
set_tests_properties(unit/paper_figures/same_pose PROPERTIES LABELS unit TIMEOUT 120)
add_test(NAME unit/paper_figures/sentences COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/sentences_test.py)
set_tests_properties(unit/paper_figures/sentences PROPERTIES LABELS unit TIMEOUT 120)
add_test(NAME unit/paper_figures/whole_file COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/whole_file_test.py)
set_tests_properties(unit/paper_figures/whole_file PROPERTIES LABELS unit TIMEOUT 120)
