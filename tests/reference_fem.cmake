# Tests of the judge: on its own before it may judge anything, then through the skeleton's attachment.
if(NOT TARGET reference_fem)
    return()
endif()

foreach(name manufactured_solution patch_test)
    pbs_test(verification reference_fem/${name} reference_fem)
endforeach()
