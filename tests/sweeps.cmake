# Tests of parameter sweeps; those on a Slurm cluster are skipped but by ./check --long.
foreach(test sweep_file sweep_merge sweep_runs)
    add_test(NAME unit/experiments/sweeps/${test}
        COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/experiments/sweeps/${test}_test.py)
    set_tests_properties(unit/experiments/sweeps/${test} PROPERTIES LABELS unit TIMEOUT 120)
endforeach()

if(TARGET pbskin)
    add_test(NAME robustness/experiments/slurm_sweep
        COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/robustness/experiments/slurm_sweep.py -v)
    set_tests_properties(robustness/experiments/slurm_sweep PROPERTIES LABELS robustness SKIP_RETURN_CODE 77 TIMEOUT 1800 ENVIRONMENT
        "PBSKIN=$<TARGET_FILE:pbskin>;PBSKIN_DISTRIBUTED=$<$<TARGET_EXISTS:pbskin_distributed>:$<TARGET_FILE:pbskin_distributed>>;PBS_SOURCE=${PROJECT_SOURCE_DIR};PYTHONPATH=${CMAKE_CURRENT_SOURCE_DIR}/support")
endif()
