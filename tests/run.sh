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

# run_tests NAME FOLDER CTEST-ARGUMENT... -- OPTION=VALUE...: build a folder, run its tests, count.
run_tests() {
    local name=$1 build=$2 begin=$SECONDS log arguments=()
    shift 2
    while [[ $1 != -- ]]; do
        arguments+=("$1")
        shift
    done
    shift
    if ! wr_build "$build" all "$@" WR_WERROR=ON WR_TESTS=ON WR_KERNELS=all; then
        failed=$((failed + 1))
        wr_say "$name: the build failed after $((SECONDS - begin)) s"
        return
    fi
    wr_say "$name: built in $((SECONDS - begin)) s"
    begin=$SECONDS
    log=$build/tests.log
    ctest --test-dir "$build" --parallel $(($(nproc) * 3 / 2)) --timeout 900 "${arguments[@]}" 2>&1 | tee "$log"
    # "97% tests passed, 2 tests failed out of 60"
    local bad all
    read -r bad all < <(sed -nE 's/.* ([0-9]+) tests? failed out of ([0-9]+)$/\1 \2/p' "$log") || true
    if [[ -z ${all:-} || $all -eq 0 ]]; then
        wr_say "$name: no test ran"
        failed=$((failed + 1))
        return
    fi
    passed=$((passed + all - bad))
    failed=$((failed + bad))
    wr_say "$name: $all tests in $((SECONDS - begin)) s, $bad failed"
}

if ! wr_install_packages "${wr_program_packages[@]}" "${wr_test_packages[@]}"; then
    failed=1
    finish
fi
wr_say "packages are there after $SECONDS s"

leave_out=(-LE 'bench|slow')
sanitized=quick
[[ $full == yes ]] && leave_out=() sanitized='quick|heavy'
run_tests "optimised" "$prefix" "${leave_out[@]}" -- CMAKE_BUILD_TYPE=RelWithDebInfo WR_SANITIZE=
run_tests "address and undefined" "$prefix-asan" -L "$sanitized" -- \
    CMAKE_BUILD_TYPE=Debug WR_SANITIZE=address,undefined
if [[ $full == yes ]]; then
    run_tests "threads" "$prefix-tsan" -L quick -- CMAKE_BUILD_TYPE=Debug WR_SANITIZE=thread
fi
finish
