# The oldest and the newest version with which the project was tried stand in packages.txt, beside the Debian package
# that has the library.

# find_known(NAME [arguments of find_package]): finds a package that the build requires. One that is missing, or older
# than the oldest version tried, ends the configuration with one sentence. One that is newer than the newest is named.
macro(find_known name)
    find_package(${name} QUIET ${ARGN})
    require_known_version(${name} "${${name}_FOUND}" "${${name}_VERSION}")
endmacro()

# The same for a library without a CMake package: its header states the version in macros. MAJOR and MINOR are their
# names.
function(require_known_header name header major minor)
    foreach(macro IN LISTS major minor)
        file(STRINGS ${header} ${macro} REGEX "^#define ${macro} +[0-9]")
        string(REGEX REPLACE "^#define ${macro} +([0-9]+).*" "\\1" ${macro} "${${macro}}")
    endforeach()
    require_known_version(${name} TRUE "${${major}}.${${minor}}")
endfunction()

function(require_known_version name found version)
    file(STRINGS ${PROJECT_SOURCE_DIR}/cmake/packages.txt row REGEX "^[^#].*[[, ]${name}[],]")
    string(REGEX MATCHALL "[^ ]+" row "${row}")
    list(GET row 0 package)
    list(GET row 1 oldest)
    list(GET row 2 newest)
    if(NOT found)
        message(FATAL_ERROR "${name} is not installed; on Debian and Ubuntu: apt-get install ${package}")
    endif()
    string(REPLACE GNU g++ name "${name}")
    # By major and minor: some packages state the patch of another release, such as assimp's 5.2.4 for 5.2.5.
    foreach(release IN ITEMS oldest newest version)
        string(REGEX MATCH "^[0-9]+(\\.[0-9]+)?" ${release} "${${release}}")
    endforeach()
    if(version AND version VERSION_LESS oldest)
        message(FATAL_ERROR "${name} ${version} is older than ${oldest}, the oldest version that was tried; "
            "Debian 12 and later releases have it (${package})")
    elseif(version AND version VERSION_GREATER newest)
        message(NOTICE "${name} ${version} is newer than ${newest}, the newest version that was tried (Debian 13)")
    endif()
endfunction()
