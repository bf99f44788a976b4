#!/usr/bin/env bash
# The program in another Debian release: packages of ui/setup.sh installed in a new system, warnings as errors, quick tests without
# a display, Debian packages made and examined by lintian. Prints the versions of the libraries, seconds and megabytes.
# Needs root and a Debian mirror.  releases.sh SOURCE-FOLDER RELEASE (trixie, sid ...)
set -uo pipefail
source=$1 release=$2
folder=$(mktemp -d) || exit 1
trap 'rm -rf --one-file-system "$folder"' EXIT
system=$folder/system
begin=$SECONDS

fail() {
    printf '%s: %s\n' "$release" "$*"
    exit 1
}

say() {
    printf '%4d s  %s\n' $((SECONDS - begin)) "$*"
}

[[ $(id -u) -eq 0 ]] || { printf 'releases: must be run by root, who can make systems\n'; exit 77; }
command -v mmdebstrap >/dev/null || fail "mmdebstrap is missing: apt-get install mmdebstrap"

# inside COMMAND...: in the system, with processes of its own, in its copy of the checkout.
inside() {
    # shellcheck disable=SC2016 # for the shell inside
    unshare --mount --pid --fork bash -c '
        mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" &&
            exec chroot "$0" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
                bash -c "cd /wrinkle && $1"' "$system" "$1" </dev/null
}

# Lists of a mirror that is a copy of an earlier day count as well.
mmdebstrap --quiet --variant=apt --aptopt='Acquire::Check-Valid-Until "false"' "$release" "$system" http://deb.debian.org/debian \
    2>"$folder/log" || fail "mmdebstrap: $(cat "$folder/log")"
cp /etc/resolv.conf "$system/etc/"
mkdir "$system/wrinkle"
(cd "$source" && find . -path './build*' -prune -o -path ./.git -prune -o -type f -print0 | tar --null --files-from=- -cf -) |
    tar -C "$system/wrinkle" -xf - || fail "the checkout was not copied"
# shellcheck disable=SC2016 # for the shell inside
inside 'apt-get -q update && root=/wrinkle && source ui/setup.sh &&
    wr_install_packages "${wr_program_packages[@]}" "${wr_test_packages[@]}" "${wr_package_packages[@]}" lintian' >"$folder/log" 2>&1 ||
    fail "packages: $(tail -n 20 "$folder/log")"
say "packages installed, $(du -sm --one-file-system "$system" | cut -f 1) MB"
# shellcheck disable=SC2016
inside 'dpkg-query -W -f="\${Package} \${Version}\n" gcc libimgui-dev libsdl2-dev libassimp-dev libopenimageio-dev libopenexr-dev'

inside 'cmake -B build -G Ninja -DWR_WERROR=ON -DWR_TESTS=ON -DWR_KERNELS=native && cmake --build build' >"$folder/log" 2>&1 ||
    fail "build: $(grep -E 'error|FAILED' "$folder/log" | head -n 20)"
say "built"
# shellcheck disable=SC2016
inside 'ctest --test-dir build -L "^quick$" --parallel $(nproc) --timeout 900' >"$folder/log" 2>&1 ||
    fail "tests: $(tail -n 20 "$folder/log")"
say "$(grep 'tests passed' "$folder/log")"
# (They close no request for packaging, since they are not uploaded to Debian, and the project has no home page.)
# shellcheck disable=SC2016
inside 'export DEBFULLNAME="Package test" DEBEMAIL=test@debian.org && bash ui/desktop/package.sh /made &&
    known=$(lintian-explain-tags appstream-metadata-validation-failed >/dev/null 2>&1 && echo ,appstream-metadata-validation-failed);
    lintian --allow-root --fail-on=error,warning --suppress-tags=initial-upload-closes-no-bugs$known /made/*.changes' >"$folder/log" 2>&1 || fail "packages: $(tail -n 30 "$folder/log")"
say "packages made"
