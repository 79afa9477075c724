# The hash of the headers through which the program and its modules exchange objects. pbskin_fem and pbskin_verification
# have it as `pbskin_headers()`, so that the program refuses one that was built from other headers
# (load_module_with_blas). Functions of the other modules have new names where their arguments change. As a script, with
# SOURCES, this file writes OUTPUT.
if(NOT CMAKE_SCRIPT_MODE_FILE)
    set(SOURCES ${PROJECT_SOURCE_DIR})
endif()
set(folders pbs/* analysis/* reference_fem reference_fem/* experiments/settings experiments/deformers
    experiments/deformers/fem experiments/studies/verification)
list(TRANSFORM folders REPLACE "(.+)" "${SOURCES}/\\1/*.hpp")

if(CMAKE_SCRIPT_MODE_FILE)
    file(GLOB headers ${folders})
    foreach(header IN LISTS headers)
        file(SHA256 ${header} hash)
        string(APPEND hashes ${hash})
    endforeach()
    string(SHA256 hash "${hashes}")
    file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
        "extern \"C\" const char* pbskin_headers()\n{\n    return \"${hash}\";\n}\n")
    return()
endif()

file(GLOB headers CONFIGURE_DEPENDS ${folders})
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/shared_headers.cpp
    COMMAND ${CMAKE_COMMAND} -DSOURCES=${PROJECT_SOURCE_DIR} -DOUTPUT=${PROJECT_BINARY_DIR}/shared_headers.cpp
    -P ${CMAKE_CURRENT_LIST_FILE} DEPENDS ${headers} ${CMAKE_CURRENT_LIST_FILE} VERBATIM)
add_library(shared_headers OBJECT ${PROJECT_BINARY_DIR}/shared_headers.cpp)
