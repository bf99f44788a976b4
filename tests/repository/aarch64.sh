#!/usr/bin/env bash
# The program for 64-bit ARM: cross-built with warnings as errors; its quick tests and samples run by QEMU; documents, heights
# and exact pictures of all samples compared byte by byte with those of the other program.
# Needs a Debian mirror, and root: tests start programs, which the kernel passes to QEMU (binfmt_misc).
# aarch64.sh SOURCE-FOLDER PROGRAM WORK-FOLDER; libraries and build remain in the work folder.
set -uo pipefail
root=$1 program=$2 work=$3
begin=$SECONDS

fail() {
    printf 'aarch64: %s\n' "$*"
    exit 1
}

say() {
    printf '%4d s  %s\n' $((SECONDS - begin)) "$*"
}

# shellcheck source=ui/setup.sh
source "$root/ui/setup.sh"
[[ $(id -u) -eq 0 ]] || { printf 'aarch64: must be run by root, who can register QEMU\n'; exit 77; }
for tool in mmdebstrap qemu-aarch64-static aarch64-linux-gnu-gcc aarch64-linux-gnu-g++; do
    command -v $tool >/dev/null || fail "$tool is missing: apt-get install ${wr_arm_packages[*]}"
done
mkdir -p "$work" || exit 1

# ---- the kernel starts ARM programs by QEMU ----
binfmt=/proc/sys/fs/binfmt_misc
undo=()
trap 'for ((k = ${#undo[@]} - 1; k >= 0; k--)); do eval "${undo[k]}"; done' EXIT
if [[ ! -e $binfmt/status ]]; then
    mount -t binfmt_misc binfmt_misc $binfmt || { printf 'aarch64: this kernel has no binfmt_misc\n'; exit 77; }
    undo+=("umount $binfmt")
fi
if [[ ! -e $binfmt/qemu-aarch64 ]]; then
    cat /usr/lib/binfmt.d/qemu-aarch64.conf >$binfmt/register || fail "QEMU is not registered"
    undo+=("echo -1 >$binfmt/qemu-aarch64")
fi

# ---- libraries ----
# Packages are unpacked, not installed: their scripts would take a quarter of an hour in QEMU. Build tools are those of this system.
arm=$work/system library=usr/lib/aarch64-linux-gnu
if [[ ! -e $arm.ready ]]; then
    rm -rf --one-file-system "$arm"
    packages=(libcmocka-dev fonts-inter-variable fonts-lohit-deva)
    for package in "${wr_program_packages[@]}"; do
        [[ " build-essential cmake ninja-build pkg-config gettext " == *" $package "* ]] || packages+=("$package")
    done
    suite=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
    mmdebstrap --quiet --arch=arm64 --variant=extract --skip=check/qemu --include="$(IFS=,; echo "${packages[*]}")" "$suite" "$arm" \
        2>"$work/log" || fail "mmdebstrap: $(tail -n 5 "$work/log")"
    # QEMU finds paths here first. These remain the ones of this system.
    (cd "$arm" && rm -rf dev tmp var etc/{passwd,group,hostname,hosts,resolv.conf,fstab})
    ln -s blas/libblas.so.3 lapack/liblapack.so.3 "$arm/$library/" # alternatives, which scripts would make
    find "$arm" -type l -lname '/*' -printf '%p %l\n' | while read -r link to; do ln -sfn "$arm$to" "$link"; done
    # A font cache apart from that of this system, filled before a test must wait for it.
    sed -i "s,/var/cache/fontconfig,$work/fonts," "$arm/etc/fonts/fonts.conf"
    QEMU_LD_PREFIX=$arm "$arm/usr/bin/fc-cache" || fail "fc-cache"
    touch "$arm.ready"
fi
export QEMU_LD_PREFIX=$arm
say "libraries: $(du -sh "$arm" | cut -f 1)"

# ---- the build ----
# QEMU refuses system call filters, and a process that may write no files dies in it: without these two the reader process
# would read nothing. A test that replaces these functions has its own.
aarch64-linux-gnu-gcc --sysroot="$arm" -D_GNU_SOURCE -fPIC -c -o "$work/emulated.o" -x c - <<'C' || fail "emulated.o"
#include <sys/resource.h>
__attribute__((weak)) int seccomp_load(const void *filter)
{
    return (void)filter, 0;
}
__attribute__((weak)) int setrlimit(__rlimit_resource_t which, const struct rlimit *limit)
{
    return which == RLIMIT_FSIZE && limit->rlim_max == 0 ? 0 : prlimit(0, which, limit, 0);
}
C
export PKG_CONFIG_SYSROOT_DIR=$arm PKG_CONFIG_LIBDIR=$arm/$library/pkgconfig:$arm/usr/share/pkgconfig
build=$work/build
wr_build "$build" all CMAKE_SYSTEM_NAME=Linux CMAKE_SYSTEM_PROCESSOR=aarch64 CMAKE_SYSROOT="$arm" \
    CMAKE_C_COMPILER="$(command -v aarch64-linux-gnu-gcc)" CMAKE_CXX_COMPILER="$(command -v aarch64-linux-gnu-g++)" \
    CMAKE_LIBRARY_ARCHITECTURE=aarch64-linux-gnu CMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER \
    CMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY CMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY \
    CMAKE_EXE_LINKER_FLAGS="$work/emulated.o" WR_CLANG=OFF WR_WERROR=ON WR_TESTS=ON 2>"$work/log" || fail "the build: $(tail -n 30 "$work/log")"
[[ $(od -A n -j 18 -N 2 -t x2 "$build/wrinkle") == ' 00b7' ]] || fail "$build/wrinkle is not for ARM"
say "built by $(aarch64-linux-gnu-gcc --version | head -n 1), for $(qemu-aarch64-static --version | head -n 1)"

# ---- the same documents, heights and exact pictures ----
export WRINKLE_STATE=$work/state
# made PROGRAM SAMPLE FOLDER: what the sample writes, its document, heights and picture, and the document's numbers.
made() {
    rm -rf "$3" && mkdir "$3" && cd "$3" || exit 1
    "$1" run "$2" --do 'save document.exr' --do 'export height height.exr' --do 'render picture.exr size=96x96' >../log 2>&1 &&
        "$1" inspect document.exr >inspected 2>>../log
}
count=0 different=()
for sample in "$root"/samples/*.wrinkle; do
    for of in here:"$program" arm:"$build/wrinkle"; do
        (made "${of#*:}" "$sample" "$work/${of%%:*}") || fail "$sample by ${of#*:}: $(cat "$work/log")"
    done
    count=$((count + 1))
    diff -r "$work/here" "$work/arm" >"$work/log" || different+=("$(basename "$sample" .wrinkle): $(cat "$work/log")")
done
[[ ${#different[@]} -eq 0 ]] || fail "other files than those of $program: ${different[*]}"
say "$count samples have the same documents, heights, exact pictures and exports"

# ---- the quick tests ----
# Not in QEMU: tests of filters and limits of the kernel (large, recover: of memory), of /proc/PID/exe (image), by valgrind
# (instructions), of a program that cannot be started (film: QEMU reports it as one that ended with 127).
left_out='sandbox|reader_limits|reader_process|large|recover|image|instructions|film'
unset WRINKLE_STATE # tests have their own
ctest --test-dir "$build" -L 'quick|golden' -E "^($left_out)\$" --parallel "$(nproc)" --timeout 7200 --output-on-failure >"$work/log" 2>&1 ||
    fail "$(grep -A 30 'tests passed' "$work/log")"
say "$(grep 'tests passed' "$work/log")"
