# Tests of the method and of the metrics. They need neither mesh files nor characters, and build even if every option is off.
set(threads)
if(PBS_WITH_THREADS)
    find_package(TBB REQUIRED)
    set(threads TBB::tbb)
endif()

pbs_tests(unit pbs_geometry FOLDERS pbs/geometry
    EXCEPT pbs/geometry/isolated_reader pbs/geometry/mesh_io pbs/geometry/mesh_io_checks pbs/geometry/mesh_io_unavailable
        pbs/geometry/meshing_builtin pbs/geometry/meshing_count pbs/geometry/meshing_surface pbs/geometry/meshing_unavailable
        pbs/geometry/module pbs/geometry/self_intersection pbs/geometry/surface_reader
    LIBRARIES pbs_method)
pbs_tests(unit pbs_skinning FOLDERS pbs/skinning pbs/constraints LIBRARIES pbs_method)
pbs_tests(unit pbs_solver FOLDERS pbs/solver LIBRARIES pbs_method ${threads})
pbs_tests(unit analysis FOLDERS analysis LIBRARIES analysis GSL::gsl)
set_source_files_properties(unit/analysis/claims.cpp unit/analysis/verdict.cpp PROPERTIES COMPILE_DEFINITIONS ${claims_file})
pbs_tests(properties method FOLDERS pbs analysis
    EXCEPT pbs/geometry/meshing_repeats pbs/solver/orders
    LIBRARIES analysis ${threads})
pbs_tests(verification method FOLDERS pbs/solver pbs/near_rest analysis LIBRARIES analysis pbs_near_rest GSL::gsl)
pbs_tests(robustness method FOLDERS pbs/solver LIBRARIES pbs_method)
pbs_tests(claims method FOLDERS pbs LIBRARIES pbs_method)
