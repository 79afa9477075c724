# Scenes, deformers, studies and the command line.
if(NOT TARGET pbskin)
    return()
endif()

pbs_test(unit experiments/scene experiments)
pbs_test(unit experiments/limb_stations experiments)
pbs_test(unit experiments/frame_measurement experiments)
pbs_test(unit experiments/studies/worker_pool experiments)
pbs_test(unit experiments/studies/study_run experiments)
pbs_test(unit experiments/verification/verification_row experiments)
if(TARGET fem_verification)
    pbs_test(unit experiments/verification/structured_mesh fem_verification)
    pbs_test(verification experiments/verification_record fem_verification experiments)
endif()
pbs_test(robustness experiments/scene_errors experiments)

# The program as its users meet it: exit status, messages, folders. Python stands outside, so that no code is shared with what it checks.
function(pbs_program_test kind name)
    add_test(NAME ${kind}/${name} COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/${kind}/${name}.py)
    set_tests_properties(${kind}/${name} PROPERTIES LABELS ${kind} TIMEOUT 900
        ENVIRONMENT "PBSKIN=$<TARGET_FILE:pbskin>;PBS_SOURCE=${PROJECT_SOURCE_DIR};PYTHONPATH=${CMAKE_CURRENT_SOURCE_DIR}/support")
endfunction()
pbs_program_test(robustness experiments/command_line)
pbs_program_test(verification experiments/recomputed_frames)
pbs_program_test(claims volume)
pbs_program_test(regression experiments/limb_volume)
