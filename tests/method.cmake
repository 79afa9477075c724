# Tests of the method and of the metrics. They need neither mesh files nor characters, and build even if every option is
# off.
set(threads)
if(PBS_WITH_THREADS)
    find_known(TBB)
    set(threads TBB::tbb)
endif()

pbs_tests(unit pbs_geometry FOLDERS pbs/geometry FILES pbs/system/deferred_sigterm pbs/system/files
    pbs/system/source_file LIBRARIES pbs_method)
pbs_tests(unit pbs_skinning FOLDERS pbs/skinning pbs/constraints LIBRARIES pbs_method)
pbs_tests(unit pbs_solver FOLDERS pbs/packed pbs/contact pbs/solver pbs/author LIBRARIES pbs_method ${threads})
pbs_tests(unit analysis FOLDERS analysis LIBRARIES analysis GSL::gsl)
target_compile_definitions(test_unit_analysis PRIVATE ${claims_file})
pbs_tests(properties method FOLDERS pbs analysis
    EXCEPT pbs/solver/orders
    LIBRARIES analysis ${threads})
pbs_tests(verification method FOLDERS pbs/solver pbs/near_rest analysis LIBRARIES analysis pbs_near_rest GSL::gsl)
pbs_tests(robustness method FOLDERS pbs/solver LIBRARIES pbs_method)
pbs_tests(claims method FOLDERS pbs LIBRARIES pbs_method)
