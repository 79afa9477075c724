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
    ALONE pbs/geometry/topology
    LIBRARIES pbs_method)
pbs_tests(unit pbs_skinning FOLDERS pbs/skinning pbs/constraints
    ALONE pbs/skinning/blend pbs/skinning/contract pbs/skinning/correctives pbs/skinning/delta_mush pbs/skinning/pose
        pbs/skinning/pose_path pbs/skinning/weights pbs/constraints/contract pbs/constraints/region_volume pbs/constraints/volume_printed
    LIBRARIES pbs_method)
pbs_tests(unit pbs_solver FOLDERS pbs/packed pbs/contact pbs/solver pbs/author
    ALONE pbs/solver/batched/batch_program pbs/solver/batched/batched_projection pbs/solver/batched/kernels
        pbs/solver/batched/sequence pbs/packed/groups pbs/packed/vertex_order pbs/solver/constraint_set
        pbs/solver/pbs_solver pbs/solver/projection pbs/solver/steps pbs/contact/depth_constraint pbs/contact/self_contact
    LIBRARIES pbs_method ${threads})
pbs_tests(unit analysis FOLDERS analysis
    ALONE analysis/records/tables analysis/metrics/frame_metrics analysis/metrics/error_norms
    LIBRARIES analysis GSL::gsl)
set_source_files_properties(unit/analysis/verdicts/claims.cpp unit/analysis/verdicts/verdict.cpp PROPERTIES
    COMPILE_DEFINITIONS ${claims_file})
pbs_tests(properties method FOLDERS pbs analysis
    EXCEPT pbs/geometry/meshing_repeats pbs/solver/orders
    ALONE pbs/contact/separation pbs/skinning/invariance pbs/solver/invariance pbs/solver/left_out pbs/solver/threads
    LIBRARIES analysis ${threads})
pbs_tests(verification method FOLDERS pbs/solver pbs/near_rest analysis LIBRARIES analysis pbs_near_rest GSL::gsl)
pbs_tests(robustness method FOLDERS pbs/solver LIBRARIES pbs_method)
pbs_tests(claims method FOLDERS pbs LIBRARIES pbs_method)
