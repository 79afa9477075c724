# Tests of the reference: first by itself, before anything is compared with it, then with the attachment of the
# skeleton.
if(NOT TARGET reference_fem)
    return()
endif()

pbs_tests(unit reference_fem_laws FOLDERS reference_fem/laws LIBRARIES reference_fem_laws)
pbs_tests(unit reference_fem BLAS AT_ONCE FOLDERS reference_fem EXCEPT reference_fem/laws
    LIBRARIES reference_fem_verification)
pbs_tests(verification reference_fem_laws FILES reference_fem/laws LIBRARIES reference_fem_laws)
pbs_tests(verification reference_fem BLAS AT_ONCE FOLDERS reference_fem EXCEPT reference_fem/laws
    LIBRARIES reference_fem_verification)
if(NOT TARGET fem_verification)
    return()
endif()

set(left_out)
if(NOT PBS_WITH_CGAL)
    list(APPEND left_out experiments/studies/verification/calculix)
endif()
if(NOT PBS_WITH_RIG_IMPORT OR NOT PBS_WITH_CGAL OR NOT PBS_WITH_MESH_IO)
    list(APPEND left_out experiments/deformers/fem/bodies)
endif()
pbs_tests(unit experiments_fem BLAS AT_ONCE FOLDERS experiments/deformers/fem
    EXCEPT experiments/deformers/fem/fem_module
    LIBRARIES fem_deformer pbs_characters reference_fem_verification)
pbs_tests(verification experiments_fem BLAS AT_ONCE FOLDERS experiments/deformers/fem
    FILES experiments/studies/stability/broken_fem_starts experiments/studies/verification/calculix
    experiments/verification_record EXCEPT ${left_out}
    LIBRARIES fem_verification experiments)
target_sources(test_verification_experiments_fem PRIVATE support/blas_main.cpp)
foreach(target unit_reference_fem verification_reference_fem unit_experiments_fem)
    target_sources(test_${target} PRIVATE support/blas_main.cpp ${PROJECT_SOURCE_DIR}/experiments/process/machine.cpp)
    target_link_libraries(test_${target} PRIVATE pbs_system shared_headers)
endforeach()
