# Tests of the judge: on its own before it may judge anything, then through the skeleton's attachment.
if(NOT TARGET reference_fem)
    return()
endif()

foreach(name assembly direct_factor eliminated_system linear_elasticity point_location simplex_space)
    pbs_test(unit reference_fem/${name} reference_fem)
endforeach()
foreach(name hanging_bar linear_response manufactured_solution patch_test rigid_rotation spring_attachment)
    pbs_test(verification reference_fem/${name} reference_fem)
endforeach()
