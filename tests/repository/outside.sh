#!/usr/bin/env bash
# The build itself: a folder outside the checkout, no cmocka, another processor, this one alone.  outside.sh SOURCE-FOLDER
set -uo pipefail
source=$1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
failures=0
complain() {
    printf '%s\n' "$*"
    failures=$((failures + 1))
}
generator=()
! command -v ninja >/dev/null || generator=(-G Ninja)
# configure FOLDER OPTION...
configure() {
    local build=$folder/$1
    shift
    cmake -S "$source" -B "$build" "${generator[@]}" "$@" >"$build.log" 2>&1
}

# ---- what was built outside the checkout finds what ships with the program; a copy elsewhere does not ----
unset WRINKLE_DATA
configure outside -DWR_TESTS=ON || complain "configuring outside the checkout: $(tail -n 5 "$folder/outside.log")"
cmake --build "$folder/outside" --target run_base --parallel 2 >"$folder/build.log" 2>&1 ||
    complain "building outside the checkout: $(tail -n 5 "$folder/build.log")"
(cd / && "$folder/outside/run_base" data_files >"$folder/data.log" 2>&1) || complain "$(cat "$folder/data.log")"
mkdir "$folder/elsewhere"
cp "$folder/outside/run_base" "$folder/elsewhere"
(cd / && "$folder/elsewhere/run_base" data_files >/dev/null 2>&1) && complain "a copy finds the checkout's files"

# ---- without cmocka: no tests, unless they are asked for ----
mkdir "$folder/bin"
printf '#!/bin/sh\ncase " $* " in *cmocka*) exit 1 ;; esac\nexec %s "$@"\n' "$(command -v pkg-config)" >"$folder/bin/pkg-config"
chmod +x "$folder/bin/pkg-config"
export PKG_CONFIG=$folder/bin/pkg-config
configure without || complain "without cmocka: $(tail -n 5 "$folder/without.log")"
grep -q 'No tests: cmocka is missing (Debian: libcmocka-dev)' "$folder/without.log" ||
    complain "nothing says why there are no tests"
configure asked -DWR_TESTS=ON && complain "tests without cmocka are configured"
[[ $(grep -c 'CMake Error' "$folder/asked.log") == 1 ]] || complain "not one error: $(cat "$folder/asked.log")"
tr -s ' \n' ' ' <"$folder/asked.log" | grep -q 'apt-get install libcmocka-dev' || complain "the error does not name the package"
unset PKG_CONFIG

# ---- another processor: no flags of x86 ----
configure arm -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DWR_TESTS=OFF ||
    complain "configuring for another processor: $(tail -n 5 "$folder/arm.log")"
for flag in -march=x86 -mprefer-vector-width -mrecip -mavx -msse; do
    grep -q -e "$flag" "$folder/outside/compile_commands.json" ||
        [[ $flag == -mavx || $flag == -msse || $(uname -m) != x86_64 ]] || complain "$flag is not used on x86-64"
    grep -q -e "$flag" "$folder/arm/compile_commands.json" && complain "$flag is used on another processor"
done
# Where there is a compiler for it, the kernels and what chooses among them are compiled.
if command -v aarch64-linux-gnu-gcc >/dev/null; then
    compile_arm() { # FILE ARGUMENT...
        aarch64-linux-gnu-gcc -std=c17 -O1 -D_GNU_SOURCE -fopenmp-simd -ffp-contract=off -Wno-psabi -DWR_NATIVE_LEVEL=0 -I"$source/src" \
            -c "$@" -o "$folder/kern.o" || complain "$1 is not for arm64"
    }
    for file in $(find "$source/src" -name '*_kernels.c' -o -name kern.c -o -name cpu.c) "$folder"/arm/src/*/wr_*_v[34].c; do
        compile_arm "$file"
    done
fi

# ---- native: the plain set and one level's; each choice of level compiles ----
configure native -DWR_KERNELS=native -DWR_TESTS=OFF || complain "configuring native kernels: $(tail -n 5 "$folder/native.log")"
sets=$(grep -oE '"file": "[^"]*/render/wr_kern_(ref|v[1-4])\.c"' "$folder/native/compile_commands.json" | grep -oE '(ref|v[1-4])\.c' | tr '\n' ' ')
[[ $sets =~ ^(ref\.c\ v[1-4]\.c\ |v[1-4]\.c\ ref\.c\ )$ ]] || complain "a native build compiles these sets: $sets"
configure wrong -DWR_KERNELS=some -DWR_TESTS=OFF && complain "WR_KERNELS=some is configured"
for level in 0 1 2 3 4; do
    "${CC:-cc}" -std=c17 -Wall -Wextra -Werror -fsyntax-only -fopenmp-simd -DWR_NATIVE_LEVEL=$level -I"$source/src" \
        "$source/src/render/kernels/kern.c" || complain "kern.c does not compile for level $level alone"
done

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
