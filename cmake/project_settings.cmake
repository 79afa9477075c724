# Settings that all targets of the project share.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "build type" FORCE)
endif()

# ccache caches objects with precompiled headers only with this sloppiness; `env` sets it for all users. The times of
# included files are not ignored: ccache must not keep an object whose source changed while the compiler read it.
find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

# GCC collects garbage only once 1 GB is in use, instead of 128 MB. Compiling takes 7 % less time.
add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=1000000>)

# Some 200 shared objects come with deal.II, with which mold links in half a second and the default linker in 15.
find_program(MOLD_LINKER ld.mold)
if(MOLD_LINKER AND PBS_WITH_FEM)
    add_link_options(-fuse-ld=mold)
endif()

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    require_known_version(GNU TRUE ${CMAKE_CXX_COMPILER_VERSION})
endif()
find_known(Eigen3 NO_MODULE)

# Only the include root and the warnings; an installation leaves the warnings to its user.
add_library(pbs_settings INTERFACE)
target_include_directories(pbs_settings INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include>)
target_compile_options(pbs_settings INTERFACE
    "$<BUILD_INTERFACE:-Wall;-Wextra;-Wpedantic>" $<BUILD_INTERFACE:$<$<BOOL:${PBS_WERROR}>:-Werror>>)
# GCC 12 wrongly reports copies of short strings (its bug 105651).
target_compile_options(pbs_settings INTERFACE $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>>)
# GCC 13 and later suspect every function that takes a name by reference and returns a reference into another argument.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
    target_compile_options(pbs_settings INTERFACE $<BUILD_INTERFACE:-Wno-dangling-reference>)
endif()
target_compile_features(pbs_settings INTERFACE cxx_std_20)
target_compile_options(pbs_settings INTERFACE "$<INSTALL_INTERFACE:SHELL:-include pbs/geometry/installed_eigen.hpp>")
target_link_libraries(pbs_settings INTERFACE Eigen3::Eigen)

# calls_libraries(TARGET): its sources spend their time in libraries, so that -O3 costs more in the compiler than it
# saves at run time. The level of a precompiled header is that of all its sources: GCC 12 ignores theirs. GCC takes
# Eigen's dynamic matrices for uninitialized.
function(calls_libraries target)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>
        $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endfunction()

# unity_build(TARGET [BATCH NUMBER] [ALONE SOURCE...]): compiles NUMBER sources at once, eight unless stated, so that
# their anonymous namespaces are one. A source with a name that another one has too is compiled alone or has a namespace
# of its own. The presets dev and package compile each source alone, which detects a missing include. GCC 12 warns of
# its own headers where it inlines more.
function(unity_build target)
    cmake_parse_arguments(PARSE_ARGV 1 unity "" "BATCH" "ALONE")
    if(NOT unity_BATCH)
        set(unity_BATCH 8)
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ${PBS_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE ${unity_BATCH})
    set_source_files_properties(${unity_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    if(PBS_UNITY_BUILD)
        target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    endif()
endfunction()
