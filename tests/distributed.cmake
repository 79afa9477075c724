# Tests of the linear reference on several processes, which mpirun starts.
if(NOT TARGET pbskin_distributed)
    return()
endif()

find_package(MPI REQUIRED COMPONENTS CXX)
add_test(NAME verification/experiments/distributed
    COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/verification/experiments/distributed.py)
set(environment PBSKIN=$<TARGET_FILE:pbskin> PBSKIN_DISTRIBUTED=$<TARGET_FILE:pbskin_distributed> MPIEXEC=${MPIEXEC_EXECUTABLE}
    PBS_SOURCE=${PROJECT_SOURCE_DIR} PYTHONPATH=${CMAKE_CURRENT_SOURCE_DIR}/support)
set_tests_properties(verification/experiments/distributed PROPERTIES LABELS "verification;blas" TIMEOUT 900 COST 60
    ENVIRONMENT "${environment}")
