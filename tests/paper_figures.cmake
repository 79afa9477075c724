# Tests of the figure scripts. Those that draw take longer than 2 s: they are of the kind drawing instead of unit.
# figures_test(NAME FILE KIND [COMMAND...]): runs FILE of unit/paper_figures, with COMMAND if it is given.
function(figures_test name file kind)
    add_test(NAME ${kind}/paper_figures${name}
        COMMAND ${ARGN} ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/${file}_test.py)
    set_tests_properties(${kind}/paper_figures${name} PROPERTIES LABELS ${kind} TIMEOUT 300 COST 20
        ENVIRONMENT OPENBLAS_NUM_THREADS=1)  # OpenBLAS's idle threads would keep the processors busy
endfunction()
figures_test("" figures drawing)
figures_test(/listed listed_figures drawing)
figures_test(/plots plots drawing xvfb-run -a)
figures_test(/report report drawing)
figures_test(/run_page run_page drawing)
foreach(name captions compared_methods glossary looks readme_part viewer words)
    figures_test(/${name} ${name} unit)
endforeach()

# Tests of the viewer's program, if node is installed; ./check --long installs it.
find_program(PBS_NODE NAMES node nodejs)
if(PBS_NODE)
    add_test(NAME unit/paper_figures/viewer_program
        COMMAND ${PBS_NODE} --test ${CMAKE_CURRENT_SOURCE_DIR}/unit/paper_figures/viewer.test.mjs)
    set_tests_properties(unit/paper_figures/viewer_program PROPERTIES LABELS unit TIMEOUT 300)
else()
    message(STATUS "node is not installed: the tests of the viewer's program are left out")
endif()

# Tests in a real browser; only ./check --long runs them.
# browser_test(NAME FOLDER TIMEOUT)
function(browser_test name folder timeout)
    add_test(NAME browser/${name} COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/browser/browser_test.py
        $<TARGET_FILE:pbskin> ${CMAKE_BINARY_DIR}/tests/${folder} ${name})
    set_tests_properties(browser/${name} PROPERTIES LABELS browser SKIP_RETURN_CODE 77 TIMEOUT ${timeout})
endfunction()
if(TARGET pbskin)
    browser_test(viewer browser 1800)
    browser_test(quick_results browser_quick 3600)
    browser_test(trial browser_trial 900)
endif()
