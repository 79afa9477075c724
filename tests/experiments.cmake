# Scenes, deformers, studies and the command line.
if(NOT TARGET pbskin)
    return()
endif()

# Tests that load deal.II at run time, in the modules pbskin_fem and pbskin_verification.
set(with_the_module experiments/deformers/fem/fem_module experiments/deformers/flesh_limits
    experiments/studies/convergence/convergence_case
    experiments/studies/ensemble/ensemble
    experiments/studies/shared/posed_reference experiments/studies/stability/broken_fem_starts
    experiments/studies/temporal/temporal experiments/broken_bulge)
set(left_out)
if(NOT PBS_WITH_FEM)
    set(left_out ${with_the_module})
endif()

# A verdict changes with its records: the project's own claims with the values of the studies. A broken solver changes
# the values and verdicts that it must change by theory, and no others.
pbs_tests(claims experiments FOLDERS experiments EXCEPT ${left_out} LIBRARIES experiments)
target_compile_definitions(test_claims_experiments PRIVATE ${claims_file})
pbs_tests(unit experiments BLAS
    FOLDERS experiments/process experiments/scene experiments/run experiments/deformers experiments/trial
    FILES experiments/deformers/fem/fem_module
    EXCEPT experiments/deformers/fem ${left_out}
    LIBRARIES experiments)
pbs_tests(unit experiments_studies BLAS FOLDERS experiments/studies experiments/reproduce EXCEPT ${left_out}
    LIBRARIES experiments)
pbs_tests(properties experiments FOLDERS experiments EXCEPT experiments/meshes LIBRARIES experiments)
pbs_tests(regression experiments FOLDERS experiments LIBRARIES experiments)
target_compile_definitions(test_regression_experiments PRIVATE
    PBS_KEPT_RECORDS="${PROJECT_SOURCE_DIR}/experiments/records/full")
pbs_tests(verification experiments BLAS FOLDERS experiments
    EXCEPT experiments/meshes experiments/clips experiments/characters experiments/deformers/fem
        experiments/studies/verification/calculix experiments/verification_record
        experiments/studies/stability/broken_fem_starts ${left_out}
    LIBRARIES experiments)
if(PBS_WITH_FEM)
    foreach(target claims_experiments unit_experiments unit_experiments_studies verification_experiments
        verification_experiments_fem)
        add_dependencies(test_${target} pbskin_fem pbskin_verification)
    endforeach()
endif()

# The program as users run it: exit status, messages, folders. The tests are in Python, so that they share no code with
# the program.
function(pbs_program_test kind name)
    add_test(NAME ${kind}/${name} COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/${kind}/${name}.py)
    # ctest starts the costliest tests first, so that no core is idle in the end: these are longer than most.
    set_tests_properties(${kind}/${name} PROPERTIES LABELS ${kind} TIMEOUT 900 COST 60
        ENVIRONMENT
        "PBSKIN=$<TARGET_FILE:pbskin>;PBS_SOURCE=${PROJECT_SOURCE_DIR};PYTHONPATH=${CMAKE_CURRENT_SOURCE_DIR}/support")
endfunction()
pbs_program_test(robustness experiments/command_line)
pbs_program_test(verification experiments/artist_skin)
pbs_program_test(verification experiments/artist_volume)
pbs_program_test(robustness experiments/own_character)
pbs_program_test(robustness experiments/touching_parts)
pbs_program_test(robustness experiments/trial_files)
pbs_program_test(robustness experiments/moving_characters)
pbs_program_test(robustness experiments/meshing_ends)
pbs_program_test(robustness experiments/changed_rigs)
set_tests_properties(robustness/experiments/changed_rigs PROPERTIES TIMEOUT 14400)  # 1,000 models in ./check --long
pbs_program_test(robustness experiments/own_deformer)
pbs_program_test(robustness experiments/bad_input)
pbs_program_test(robustness experiments/changing_files)
pbs_program_test(robustness experiments/bench)
pbs_program_test(robustness experiments/check)
pbs_program_test(robustness experiments/foreign_frames)
pbs_program_test(robustness experiments/foreign_surfaces)
pbs_program_test(robustness experiments/full_disk)
pbs_program_test(robustness experiments/references)
if(PBS_WITH_FEM)
    pbs_program_test(verification experiments/baked_correctives)
    pbs_program_test(robustness experiments/breakdown)
    pbs_program_test(robustness experiments/kills)
    pbs_program_test(properties experiments/same_records)
endif()
pbs_program_test(verification experiments/recomputed_frames)
set_tests_properties(verification/experiments/recomputed_frames PROPERTIES LABELS "verification;blas")
pbs_program_test(claims recomputed)
pbs_program_test(claims concluded)
pbs_program_test(claims volume)
pbs_program_test(regression pages)
pbs_program_test(regression decisions)
pbs_program_test(robustness experiments/compare)
pbs_program_test(robustness experiments/kept_records)
