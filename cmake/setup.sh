# Functions that ./reproduce and ./check share: packages, build, timeline. Bash sources this file in the repository
# root.
# shellcheck shell=bash disable=SC2034,SC2015

packages_file=cmake/packages.txt
build_folder=build/release
timeline=()

# Options of the calling script; see its usage().
size=--quick
install=yes
output=
jobs=

say() { printf '%s: %s\n' "${0##*/}" "$*"; }

# Exits with status 2: the usage is wrong or the machine is not ready.
refuse() {
    printf '%s: %s\n' "${0##*/}" "$*" >&2
    exit 2
}

# parse_options SIZES OPTION...: sets size, install, output and jobs.
parse_options() {
    local sizes=" $1 "
    shift
    while (($#)); do
        case $1 in
            --no-install) install=no ;;
            -o) output=${2-} && [[ $output ]] && shift || refuse "-o: expected a folder" ;;
            -j) jobs=${2-} && [[ $jobs =~ ^[1-9][0-9]*$ ]] && shift ||
                refuse "-j = $jobs: expected a whole number of at least 1" ;;
            -h | --help) usage && exit ;;
            *) [[ $sizes == *" $1 "* ]] && size=$1 ||
                refuse "$1: expected one of$sizes--no-install -o DIR -j N --help" ;;
        esac
        shift
    done
    [[ $jobs ]] || jobs=$(default_jobs)
    [[ -z $output || $output == /* ]] || output=$OLDPWD/$output  # relative to the folder of the caller
    [[ $output ]] || output=results/${0##*/}
}

# Prints lines `package group purpose` for the given groups.
packages_of() {
    awk -v wanted=" $* " '!/^#/ && NF { group = $4; name = $1; $1 = $2 = $3 = $4 = ""; sub(/^ +(\[[^]]*\] )?/, "")
        if (index(wanted, " " group " ")) print name, group, $0 }' "$packages_file"
}

package_is_installed() {
    [[ $(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

# provide_packages GROUP...: prints which packages are missing and their purpose, and installs them.
provide_packages() {
    if ! command -v dpkg-query >/dev/null; then
        say "no dpkg on this machine: CMake will report what is missing (the list is $packages_file)"
        return
    fi
    local missing=() name group purpose
    while read -r name group purpose; do
        package_is_installed "$name" && continue
        [[ $group == full ]] && command -v "$name" >/dev/null && continue  # npm is often installed from another source
        ((${#missing[@]})) || say "missing packages:"
        printf '  %-24s (%s) %s\n' "$name" "$group" "$purpose"
        missing+=("$name")
    done < <(packages_of "$@")
    ((${#missing[@]})) || return 0
    install_packages "${missing[@]}"
}

install_packages() {
    local apt=(apt-get) by_hand="apt-get update && apt-get install --no-install-recommends $*"
    [[ $install == yes ]] || refuse "--no-install was given; as root: $by_hand"
    if ((EUID != 0)); then
        command -v sudo >/dev/null || refuse "not root and no sudo; as root: $by_hand"
        [[ -t 0 ]] || sudo -n true 2>/dev/null ||
            refuse "sudo wants a password and there is no terminal; as root: $by_hand"
        apt=(sudo apt-get)
    fi
    logged "$output/packages.txt" "${apt[@]}" update -qq || refuse "apt-get update failed: $cause"
    local package available=()
    for package; do
        if apt-cache show "$package" &>/dev/null; then
            available+=("$package")
        elif grep -q "^$package " < <(packages_of run check); then
            refuse "$package: apt does not know this package, which is required;" \
                "$(this_system) does not have it, or \`apt-get update\`" \
                "did not reach its source (all of it: $output/packages.txt)"
        else
            say "$package: $(this_system) does not have it"
        fi
    done
    logged "$output/packages.txt" "${apt[@]}" install -y -qq --no-install-recommends "${available[@]}" ||
        refuse "apt-get install failed: $cause; by hand: $by_hand"
}

# One compiler process needs up to 3 GiB (CGAL, deal.II).
default_jobs() {
    local cores gib
    cores=$(nproc)
    gib=$(awk '/^MemAvailable/ { print int($2 / 1048576 / 3) }' /proc/meminfo)
    ((gib >= 1)) || gib=1
    echo $((cores < gib ? cores : gib))
}

# timed NAME COMMAND...: runs the command, records its seconds, and returns its status.
timed() {
    local name=$1 start=$SECONDS status=0
    shift
    say "$name ..."
    "$@" || status=$?
    timeline+=("$name $((SECONDS - start))")
    return "$status"
}

# logged FILE COMMAND...: what the command prints goes to the file. If it fails, `cause` is its first error and the name
# of the file.
logged() {
    local file=$1 status=0
    shift
    mkdir -p "$(dirname "$file")"
    "$@" >"$file" 2>&1 || status=$?
    ((status == 0)) || cause="$(first_error "$file") (all of it: $file)"
    return "$status"
}

# configured COMMAND..., built OPTION...: what they print goes to files. A failure ends the script with its first error.
# The next build compiles files with a warning again, so that it has the warning too.
configured() {
    timed configure logged "$output/configure.txt" "$@" || refuse "CMake could not configure the build: $cause"
    grep "is newer than" "$output/configure.txt" | sort -u || true
}
built() {
    timed build logged "$output/build.txt" cmake --build "$build_folder" -j "$jobs" "$@" ||
        refuse "the build failed: $cause; it was tried with Debian 12 and 13, and this is $(this_system)"
    sed -nE "s|^($PWD/[^:]+):[0-9:]* warning: .*|\1|p" "$output/build.txt" | sort -u | xargs -r -d '\n' touch
}

# The first error in what CMake, a compiler, apt or npm printed, on one line; without any, the last line. CMake breaks
# its sentences.
first_error() {
    awk '/^CMake Error: ./ { sub(/^CMake Error: /, ""); error = $0; exit }
        /^CMake Error/ { of_cmake = 1; next }
        of_cmake && /^  / { sub(/^ +/, ""); error = error (error ? " " : "") $0; next }
        of_cmake && error { exit }
        /^npm (ERR!|error) (code|errno|syscall)/ { next }
        /warning: / { last = $0; next }
        /(^|[ :])error( |:)|^E: |undefined reference|ld: cannot find |npm ERR!/ && !of_cmake { error = $0; exit }
        NF { last = $0 }
        END { print error ? error : last }' "$1"
}

this_system() { (. /etc/os-release 2>/dev/null && echo "${PRETTY_NAME:-this system}"); }

# Builds the report's viewer, bundled with three.js; npm fetches 50 MB once. Without the viewer, the report states how
# to get it.
build_viewer() {
    # npm writes the fetched file last.
    local folder=paper_figures/viewer fetched=paper_figures/viewer/node_modules/.package-lock.json
    if ! command -v npm >/dev/null; then
        echo "error: npm is not installed (any version is sufficient)"
        return 1
    fi
    if [[ ! $fetched -nt $folder/package-lock.json ]]; then
        [[ $install == yes ]] || { echo "error: --no-install was given; by hand: npm ci in $folder"; return 1; }
        (cd "$folder" &&
            npm ci --no-audit --no-fund --loglevel=error --fetch-retries=1 --fetch-timeout=30000) || return 1
        touch "$fetched"
    fi
    (cd "$folder" && npm run build --silent)
}

# Prints the minutes in all and those of the stages that a user waits for.
print_stages() {
    printf '%s\n' "${timeline[@]}" | awk -v name="${0##*/}" '
        BEGIN { split("install npm|configure build|first fetch run|viewer figures", steps, "|")
            split("packages build runs figures", stage, " ")
            for (i in steps) { n = split(steps[i], names, " "); for (k = 1; k <= n; ++k) of[names[k]] = i } }
        { total += $2; if ($1 in of) seconds[of[$1]] += $2 }
        END { for (i = 1; i <= 4; ++i) line = line (i > 1 ? ", " : "") stage[i] sprintf(" %.1f", seconds[i] / 60)
            printf "%s: done in %.0f min (%s)\n", name, total / 60, line }'
}

print_timeline() {
    local entry line=''
    for entry in "${timeline[@]}"; do
        line+="$(awk -v s="${entry##* }" -v name="${entry% *}" 'BEGIN { printf "%s %.1f", name, s / 60 }') | "
    done
    say "minutes: ${line% | }"
}

# Prints the first python3 that has the modules; a version manager's python3 on the PATH often lacks them.
python_that_imports() {
    local modules=$1 python
    for python in /usr/bin/python3 python3; do
        if "$python" -c "import $modules" 2>/dev/null; then
            echo "$python"
            return
        fi
    done
    refuse "no python3 that can import $modules: install python3-numpy, python3-matplotlib and python3-vtk9"
}
