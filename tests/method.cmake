# Tests of the method: pbs/geometry (topology, quality, volumes), skinning, constraints, solver.
foreach(name IN ITEMS geometry/topology geometry/quality geometry/tet_volume
        skinning/skeleton skinning/pose skinning/bone_binding skinning/weights skinning/blend)
    pbs_test(unit pbs/${name} pbs_method)
endforeach()
foreach(name IN ITEMS stretch volume bind volume_printed)
    pbs_test(unit pbs/constraints/${name} pbs_method)
endforeach()
foreach(name IN ITEMS constraint_set residuals project_plain algorithm_1 pbs_solver)
    pbs_test(unit pbs/solver/${name} pbs_method)
endforeach()
