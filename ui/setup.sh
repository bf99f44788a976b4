# setup.sh - what ui/run.sh and tests/run.sh share: the Debian packages, and how a build folder is
# made and brought up to date. Sourced, not run; needs `root`, the checkout's folder, to be set.

# The program: compiler and build tools, then the libraries that it links with, then its fonts.
wr_program_packages=(
    build-essential cmake ninja-build pkgconf
    libassimp-dev libexpat1-dev libfontconfig-dev libfreetype-dev libfribidi-dev libharfbuzz-dev libimgui-dev libjson-c-dev
    libdbus-1-dev libdeflate-dev libmd-dev libmd4c-dev libmypaint-dev libopenexr-dev libopenimageio-dev libpng-dev librsvg2-dev
    libsdl2-dev libseccomp-dev libsleef-dev libwayland-dev libx11-dev libxi-dev libxxhash-dev libzip-dev mypaint-brushes
    wayland-protocols zlib1g-dev
    gettext fonts-dejavu-core fonts-inter fonts-materialdesignicons-webfont xfonts-terminus
)
# The tests besides: the framework, checkers, an X server and hands for the window, readers of what
# the program writes.
# shellcheck disable=SC2034  # used by tests/run.sh
wr_test_packages=(
    libcmocka-dev clang clang-format libclang-rt-dev
    fonts-inter-variable fonts-lohit-deva
    dbus-daemon xvfb xauth xdotool xclip x11-utils openbox valgrind
    weston xserver-xorg-core xserver-xorg-dev xserver-xorg-video-dummy xinput
    imagemagick openimageio-tools
    appstream desktop-file-utils groff-base jq librsvg2-bin parallel python3-cffi python3-numpy shared-mime-info shellcheck
)
# Of ui/desktop/package.sh.
# shellcheck disable=SC2034
wr_package_packages=(debhelper dh-python dpkg-dev xz-utils)
# Of tests/repository/aarch64.sh.
wr_arm_packages=(gcc-aarch64-linux-gnu g++-aarch64-linux-gnu mmdebstrap qemu-user-static)
# Of tests/run.sh --full.
# shellcheck disable=SC2034
wr_full_packages=(blender clang-14 clang-19 clang-tidy-19 gcc-12 krita python3-pyqt5 lintian "${wr_arm_packages[@]}" "${wr_package_packages[@]}")

wr_say() {
    printf 'wrinkle: %s\n' "$*" >&2
}

# Print those of the packages that are not installed, one a line.
wr_missing_packages() {
    local have
    have=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null | sort -u || true)
    local package
    for package in "$@"; do
        [[ $'\n'$have$'\n' == *$'\n'"installed $package"$'\n'* ]] || printf '%s\n' "$package"
    done
}

# Install the packages that are missing; does nothing, quickly and silently, when there are none.
wr_install_packages() {
    if ! command -v dpkg-query >/dev/null; then
        return 0 # not Debian: the build itself will say what it lacks
    fi
    local missing
    mapfile -t missing < <(wr_missing_packages "$@")
    [[ ${#missing[@]} -gt 0 ]] || return 0
    local apt=(env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
    if [[ $(id -u) -ne 0 ]]; then
        if ! command -v sudo >/dev/null; then
            wr_say "these packages are missing and there is no sudo to install them:" \
                   "apt-get install ${missing[*]}"
            return 1
        fi
        apt=(sudo "${apt[@]}")
    fi
    wr_say "installing ${missing[*]}"
    "${apt[@]}" update >&2 || wr_say "the package lists could not be refreshed; trying with the old ones"
    if ! "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >&2 </dev/null; then
        wr_say "installing failed; by hand it is: apt-get install ${missing[*]}"
        return 1
    fi
}

# Whether the build folder was configured for this checkout with these options and no room has come
# since. (What an existing CMakeLists.txt says, ninja watches by itself.) An option that starts with '?'
# may have any value: it is the default of a new folder.
wr_is_configured() {
    local build=$1 option cache=$1/CMakeCache.txt stamp=$1/.configured
    shift
    [[ -f $cache && -f $stamp && ( -f $build/build.ninja || -f $build/Makefile ) ]] || return 1
    grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache" || return 1
    for option in "$@"; do
        [[ $option == \?* ]] && continue
        grep -qE "^${option%%=*}:[A-Z]+=${option#*=}\$" "$cache" || return 1
    done
    [[ -z $(find "$root/CMakeLists.txt" "$root/src" "$root/ui" "$root/tests" "$root/samples" \
                 -name CMakeLists.txt -newer "$stamp" -print -quit) ]]
}

# wr_build FOLDER TARGET OPTION=VALUE...: configure where needed and build ('?OPTION=VALUE': see above). All that is printed goes
# to standard error, and nothing is when there is nothing to do. One call at a time for each folder.
wr_build() {
    local build=$1 target=$2 lock status=0
    shift 2
    mkdir -p "$build" || return 1
    exec {lock}>"$build/.lock" || return 1
    flock "$lock"
    wr_build_locked "$build" "$target" "$@" || status=$?
    exec {lock}>&- # else the program would hold it for as long as it runs
    return $status
}

wr_build_locked() {
    local build=$1 target=$2 generator=() log=$1/configure.log
    shift 2
    if ! wr_is_configured "$build" "$@"; then
        local option name kept options=()
        for option in "$@"; do
            if [[ $option == \?* ]]; then
                name=${option#\?} name=${name%%=*}
                kept=$(sed -nE "s/^$name:[A-Z]+=(.+)\$/\1/p" "$build/CMakeCache.txt" 2>/dev/null || true)
                option=$name=${kept:-${option#*=}}
            fi
            options+=("$option")
        done
        command -v ninja >/dev/null && [[ ! -f $build/Makefile ]] && generator=(-G Ninja)
        wr_say "configuring $build"
        if ! cmake --fresh -S "$root" -B "$build" "${generator[@]}" "${options[@]/#/-D}" >"$log" 2>&1; then
            cat "$log" >&2
            wr_say "configuring failed"
            return 1
        fi
        touch "$build/.configured"
    fi
    if [[ -f $build/build.ninja ]]; then
        # -n only looks; a change in a CMakeLists.txt shows as work too.
        [[ $(ninja -C "$build" -n "$target" 2>&1) == *"no work to do"* ]] && return 0
    fi
    wr_say "building $build"
    local quiet=()
    [[ -f $build/build.ninja && ! -t 2 ]] && quiet=(-- --quiet)
    if ! cmake --build "$build" --target "$target" --parallel "$(nproc)" "${quiet[@]}" >&2; then
        wr_say "the build failed"
        return 1
    fi
}
