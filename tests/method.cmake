# Tests of the method and of the metrics. They need neither mesh files nor characters, and build even if every option is off.
set(threads)
if(PBS_WITH_THREADS)
    find_known(TBB)
    set(threads TBB::tbb)
endif()

pbs_tests(unit pbs_geometry FOLDERS pbs/geometry
    EXCEPT pbs/geometry/content_format pbs/geometry/child_process pbs/geometry/guarded_reading pbs/geometry/medit_files
        pbs/geometry/mesh_checks pbs/geometry/mesh_io
        pbs/geometry/mesh_io_unavailable pbs/geometry/mesh_repairs pbs/geometry/meshing pbs/geometry/meshing_unavailable
        pbs/geometry/msh_files pbs/geometry/self_intersection pbs/geometry/surface_obj pbs/geometry/surface_polygons
        pbs/geometry/text_words pbs/geometry/vtk_files
    LIBRARIES pbs_method)
pbs_tests(unit pbs_skinning FOLDERS pbs/skinning pbs/constraints LIBRARIES pbs_method)
pbs_tests(unit pbs_solver FOLDERS pbs/packed pbs/contact pbs/solver pbs/author LIBRARIES pbs_method ${threads})
pbs_tests(unit analysis FOLDERS analysis LIBRARIES analysis GSL::gsl)
target_compile_definitions(test_unit_analysis PRIVATE ${claims_file})
pbs_tests(properties method FOLDERS pbs analysis
    EXCEPT pbs/geometry/meshing_repeats pbs/solver/orders
    LIBRARIES analysis ${threads})
pbs_tests(verification method FOLDERS pbs/solver pbs/near_rest analysis LIBRARIES analysis pbs_near_rest GSL::gsl)
pbs_tests(robustness method FOLDERS pbs/solver LIBRARIES pbs_method)
pbs_tests(claims method FOLDERS pbs LIBRARIES pbs_method)
