#!/usr/bin/env bash
# Build and test everything: bash tests/run.sh [--full]
#
#   build/        optimised, warnings as errors: every test
#   build-asan/   address and undefined-behaviour sanitizers: the quick tests once more (--full: the heavy too,
#                 which count much and allocate little)
#   build-tsan/   thread sanitizer: the quick tests (--full only)
#
# --full also runs the tests labelled bench and slow, and takes large counts whole, not a tenth of them.
# The last line is "N passed, N failed"; the exit status is 0 only if tests ran and none failed. A build
# that fails counts as one failure.
set -uo pipefail

root=$(CDPATH='' cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd -P)
# shellcheck source=ui/setup.sh
source "$root/ui/setup.sh"

full=no
for argument in "$@"; do
    case $argument in
    --full)
        full=yes
        export WR_FULL=1 # the whole of each large count, not a tenth
        ;;
    *)
        wr_say "tests/run.sh: '$argument' is not known; there is only --full"
        exit 2
        ;;
    esac
done

export DEBIAN_FRONTEND=noninteractive
export CTEST_OUTPUT_ON_FAILURE=1
# The libraries behind pictures and windows keep a little memory until the end; ours must not.
export LSAN_OPTIONS=suppressions=$root/tests/leaks.supp:print_suppressions=0
# Blocks of thread-local memory that modules bring are not looked through: where one begins the leak checker guesses from an
# address, and where it guesses wrong it falls over itself, after all tests have passed.
export ASAN_OPTIONS=intercept_tls_get_addr=0
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=ignore_noninstrumented_modules=1:suppressions=$root/tests/threads.supp

passed=0 failed=0
prefix=${WRINKLE_BUILD:-$root/build}

finish() {
    wr_say "all of it took $SECONDS s"
    if [[ $((passed + failed)) -eq 0 ]]; then
        failed=1
    fi
    printf '%d passed, %d failed\n' "$passed" "$failed"
    [[ $failed -eq 0 ]]
    exit
}

# build NAME FOLDER OPTION=VALUE...
build() {
    local name=$1 folder=$2 begin=$SECONDS
    shift 2
    if ! wr_build "$folder" all "$@" WR_WERROR=ON WR_TESTS=ON; then
        wr_say "$name: the build failed after $((SECONDS - begin)) s"
        return 1
    fi
    wr_say "$name: built in $((SECONDS - begin)) s"
}

# tests_of FOLDER LOG CTEST-ARGUMENT...: runs tests of a folder that was built.
tests_of() {
    local folder=$1 log=$2
    shift 2
    ctest --test-dir "$folder" --parallel $(($(nproc) * 3 / 2)) --timeout 900 "$@" 2>&1 | tee "$log"
}

# count NAME LOG: adds what tests_of wrote.
count() {
    local bad all
    # "97% tests passed, 2 tests failed out of 60"
    read -r bad all < <(sed -nE 's/.* ([0-9]+) tests? failed out of ([0-9]+)$/\1 \2/p' "$2") || true
    if [[ -z ${all:-} || $all -eq 0 ]]; then
        wr_say "$1: no test ran"
        failed=$((failed + 1))
        return
    fi
    passed=$((passed + all - bad))
    failed=$((failed + bad))
    wr_say "$1: $all tests, $bad failed, after $SECONDS s"
}

# run_tests NAME FOLDER CTEST-ARGUMENT...
run_tests() {
    local name=$1 log=$2/tests.log
    tests_of "$2" "$log" "${@:3}"
    count "$name" "$log"
}

packages=("${wr_program_packages[@]}" "${wr_test_packages[@]}")
[[ $full == yes ]] && packages+=("${wr_full_packages[@]}")
if ! wr_install_packages "${packages[@]}"; then
    failed=1
    finish
fi
wr_say "packages are there after $SECONDS s"

leave_out='window|bench|slow' sanitized=quick kernels=native
[[ $full == yes ]] && leave_out=window sanitized='quick|heavy' kernels=all
# All instruction sets compile one text: it is tested plain and as this processor runs it; --full compiles and tests all.
address=(CMAKE_BUILD_TYPE=Debug 'WR_SANITIZE=address,undefined' "WR_KERNELS=$kernels")
optimised=(CMAKE_BUILD_TYPE=RelWithDebInfo WR_SANITIZE= "WR_KERNELS=$kernels")
if build "optimised" "$prefix" "${optimised[@]}"; then
    ready=yes
else
    ready=no failed=$((failed + 1))
fi
# Some tests wait: the next build takes the processor time that is left.
(
    renice -n 19 "$BASHPID" >/dev/null
    build "address and undefined" "$prefix-asan" "${address[@]}"
) &
builder=$!
[[ $ready == yes ]] && run_tests "optimised" "$prefix" -LE "$leave_out"
# Tests of the window wait most of the time; sanitized ones run beside them, and step back.
window='' log=$prefix/window.log
if [[ -f $prefix/wrinkle ]]; then
    tests_of "$prefix" "$log" -L window >/dev/null &
    window=$!
fi
if wait "$builder"; then
    (
        renice -n 19 "$BASHPID" >/dev/null
        tests_of "$prefix-asan" "$prefix-asan/tests.log" -L "$sanitized"
    )
    count "address and undefined" "$prefix-asan/tests.log"
else
    failed=$((failed + 1))
fi
if [[ -n $window ]]; then
    wait "$window"
    cat "$log"
    count "window" "$log"
fi
if [[ $full == yes ]]; then
    if build "threads" "$prefix-tsan" CMAKE_BUILD_TYPE=Debug WR_SANITIZE=thread WR_KERNELS=all; then
        run_tests "threads" "$prefix-tsan" -L quick
    else
        failed=$((failed + 1))
    fi
fi
finish
