# Tests of the figure scripts.
add_test(NAME unit/paper_figures COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/figures_test.py)
set_tests_properties(unit/paper_figures PROPERTIES LABELS unit TIMEOUT 300)
add_test(NAME unit/paper_figures/report COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/report_test.py)
set_tests_properties(unit/paper_figures/report PROPERTIES LABELS unit TIMEOUT 120)
