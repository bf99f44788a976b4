#!/usr/bin/env bash
# Every header compiles on its own, as C17 with all warnings; one that only C++ files include, as C++17.
# The build itself proves this for a header that some file includes first; the others are compiled here.
# Helpers of tests stand after test.h, as in every test. A header without '#pragma once' is a piece of text
# that others include on purpose, and only some places may hold such.  headers.sh SOURCE-FOLDER BUILD-FOLDER
set -uo pipefail
cd "$1" || exit 1
commands=$2/compile_commands.json
[[ -s $commands ]] || { printf '%s is missing: configure the build folder with cmake\n' "$commands"; exit 1; }

common=(-D_GNU_SOURCE -DWR_SOURCE_DIR='""' -DWR_BINARY_DIR='""' -fsyntax-only -fopenmp-simd -Wall -Wextra -Wshadow
        -Werror -Isrc -I. -Itests)
c_only=(-std=c17 -Wpedantic -Wstrict-prototypes -Wmissing-prototypes)
read -ra libraries < <(pkg-config --cflags sdl2 freetype2 cmocka imgui dbus-1)
bad=0 count=0 compiled=0

# What files of either language include, looked up once. Headers of the C++ part of the window are no C, nor what they include.
included() { grep -rhoE --include="$1" --exclude='gui_imgui*.h' '^#include "[^"]+"' src ui | sort -u; }
by_cpp=$(included '*.cpp') by_c=$(included '*.[ch]')

# Headers that a C file of the build includes before any other preprocessor line. Sources are named by their absolute paths in the
# list of commands.
proved=$(sed -nE "s|^ *\"file\": \"$PWD/((src\|ui)/[^\"]*\.c)\".*|\1|p" "$commands" | sort -u |
    xargs awk '/^[ \t]*#/ {
        if ($1 == "#include" && $2 ~ /^".*"$/) { folder = FILENAME; sub(/[^\/]*$/, "", folder); print folder, substr($2, 2, length($2) - 2) }
        nextfile }' | while read -r folder header; do
            for at in "$folder$header" "src/$header" "$header"; do
                [[ -f $at ]] && { printf '%s\n' "$at"; break; }
            done
        done | sort -u)
# Heads that name a file: it is this one.
misnamed=$(find src ui tests -name '*.[ch]' -exec awk 'FNR == 1 && $2 ~ /\.[ch]$/ && $3 == "-" {
    name = FILENAME; sub(/.*\//, "", name); if ($2 != name) print FILENAME ": its head names " $2 }' {} +)
[[ -z $misnamed ]] || { printf '%s\n' "$misnamed"; bad=1; }
without_once=$(find src ui tests -name '*.h' -exec grep -L '^#pragma once' {} +)
# has LINES LINE: one of the lines is exactly that one; without a process.
has() { [[ $'\n'$1$'\n' == *$'\n'"$2"$'\n'* ]]; }

# Through standard input, so that the header is not the main file (#pragma once would warn), and twice, so
# that its guard is tested.
compile() {
    local header=$1 first=''
    [[ $header == tests/* ]] && first='#include "test.h"\n'
    local line="#include \"${header#src/}\""
    if has "$by_cpp" "$line" && ! has "$by_c" "$line"; then
        set -- "${CXX:-c++}" -std=c++17 -x c++
    else
        set -- "${CC:-cc}" "${c_only[@]}" -x c
    fi
    printf "$first"'#include "%s"\n#include "%s"\nextern int nothing;\n' "$header" "$header" |
        "$@" "${common[@]}" "${libraries[@]}" -
}

while IFS= read -r header; do
    if has "$without_once" "$header"; then
        case $header in
        src/surface/*.h | src/*/*_list.h | src/*/*_body.h) continue ;;
        esac
        printf '%s: has no #pragma once\n' "$header"
        bad=1
        continue
    fi
    count=$((count + 1))
    if has "$proved" "$header"; then
        continue
    fi
    compiled=$((compiled + 1))
    if ! compile "$header"; then
        printf '%s: does not stand alone\n' "$header"
        bad=1
    fi
done < <(find src ui tests -name '*.h' | sort)
if [[ $count -lt 15 ]]; then
    printf 'only %d headers found: is this the right folder?\n' "$count"
    bad=1
fi
printf '%d headers, %d compiled here\n' "$count" "$compiled"
exit $bad
