# cmake -DSOURCE=... -DOUTPUT=... -DVERSION=... -DBUILD_TYPE=... -DCOMPILER=... -DFLAGS=... -P write_build_facts.cmake
# Writes the git revision and whether tracked files differ from it; "unknown" without git or if SOURCE is not the root
# of a checkout.
set(revision "unknown")
set(changes "")
find_program(GIT git)
if(GIT)
    execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse --show-prefix HEAD OUTPUT_VARIABLE answer ERROR_QUIET
        RESULT_VARIABLE failed)
    if(NOT failed AND answer MATCHES "^\n([0-9a-f]+)\n$")
        set(revision ${CMAKE_MATCH_1})
        execute_process(COMMAND ${GIT} --no-optional-locks -C ${SOURCE} status --porcelain --untracked-files=no
            OUTPUT_VARIABLE changes ERROR_QUIET)
    endif()
endif()
if(changes STREQUAL "")
    set(dirty false)
else()
    set(dirty true)
endif()

# Records name no folder of the machine that built the program.
string(REGEX REPLACE "[^ ]*/[^ ]*" "<path>" FLAGS "${FLAGS}")
string(STRIP "${FLAGS}" FLAGS)
string(REGEX REPLACE "([\"\\\\])" "\\\\\\1" FLAGS "${FLAGS}")
set(text "#pragma once

namespace analysis::build_facts {
inline constexpr const char* version = \"${VERSION}\";
inline constexpr const char* git_revision = \"${revision}\";
inline constexpr bool git_dirty = ${dirty};
inline constexpr const char* compiler = \"${COMPILER}\";
inline constexpr const char* flags = \"${FLAGS}\";
inline constexpr const char* build_type = \"${BUILD_TYPE}\";
}  // namespace analysis::build_facts
")
set(before "")
if(EXISTS ${OUTPUT})
    file(READ ${OUTPUT} before)
endif()
if(NOT text STREQUAL before)
    file(WRITE ${OUTPUT} "${text}")
endif()
