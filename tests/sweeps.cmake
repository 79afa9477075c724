# Tests of parameter sweeps; only ./check --long runs those on a Slurm cluster.
add_test(NAME unit/experiments/sweeps/sweep
    COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/experiments/sweeps/sweep_test.py)
set_tests_properties(unit/experiments/sweeps/sweep PROPERTIES LABELS unit TIMEOUT 240)

if(TARGET pbskin)
    add_test(NAME robustness/experiments/slurm_sweep
        COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/robustness/experiments/slurm_sweep.py -v)
    set(environment PBSKIN=$<TARGET_FILE:pbskin> PBS_SOURCE=${PROJECT_SOURCE_DIR}
        PYTHONPATH=${CMAKE_CURRENT_SOURCE_DIR}/support)
    set_tests_properties(robustness/experiments/slurm_sweep PROPERTIES LABELS robustness SKIP_RETURN_CODE 77
        TIMEOUT 1800 ENVIRONMENT "${environment}")
endif()
