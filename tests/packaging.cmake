# Tests of the installation: by another project, and by the program outside of its source tree.
function(pbs_packaging_test name)
    add_test(NAME packaging/${name} COMMAND ${PBS_TEST_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/packaging/${name}.py)
    set(environment PBS_BUILD=${PROJECT_BINARY_DIR} PBS_SOURCE=${PROJECT_SOURCE_DIR} PBS_CMAKE=${CMAKE_COMMAND}
        CXX=${CMAKE_CXX_COMPILER})
    set_tests_properties(packaging/${name} PROPERTIES LABELS packaging SKIP_RETURN_CODE 77 TIMEOUT 3600 COST 70
        ENVIRONMENT "${environment}")
endfunction()
pbs_packaging_test(consumer)
pbs_packaging_test(presets)
pbs_packaging_test(set_up)
if(TARGET doc)
    pbs_packaging_test(documentation)
endif()
if(TARGET pbskin)
    pbs_packaging_test(installed_program)
    pbs_packaging_test(pages)
    if(PBS_WITH_CGAL)
        pbs_packaging_test(readme_example)  # the example makes its mesh from a surface
    endif()
    pbs_packaging_test(debian)
    # It makes a whole build with CMAKE_BUILD_PARALLEL_LEVEL jobs.
    set_property(TEST packaging/debian PROPERTY RUN_SERIAL ON)
endif()
