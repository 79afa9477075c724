# cpack reads this file before it packs anything.
if(CPACK_PBS_NATIVE)
    message(FATAL_ERROR
        "PBS_NATIVE = ON: the kernels are for this machine alone; expected a build for any machine of its kind "
        "(cmake --workflow --preset package)")
endif()
