#!/usr/bin/env bash
# Every header compiles on its own, as C17 with all warnings; one that only C++ files include, as C++17.
# Helpers of tests stand after test.h, as in every test. A header without '#pragma once' is a piece of text
# that others include on purpose, and only some places may hold such.  headers.sh SOURCE-FOLDER
set -uo pipefail
cd "$1" || exit 1

common=(-D_GNU_SOURCE -DWR_SOURCE_DIR='""' -DWR_BINARY_DIR='""' -fsyntax-only -fopenmp-simd -Wall -Wextra -Wshadow
        -Werror -Isrc -I. -Itests)
c_only=(-std=c17 -Wpedantic -Wstrict-prototypes -Wmissing-prototypes)
read -ra libraries < <(pkg-config --cflags sdl2 freetype2 cmocka imgui)
bad=0 count=0

# What files of either language include, looked up once. Headers of the C++ part of the window are no C, nor what they include.
included() { grep -rhoE --include="$1" --exclude='gui_imgui*.h' '^#include "[^"]+"' src ui | sort -u; }
by_cpp=$(included '*.cpp') by_c=$(included '*.[ch]')

# Through standard input, so that the header is not the main file (#pragma once would warn), and twice, so
# that its guard is tested.
compile() {
    local header=$1 first=''
    [[ $header == tests/* ]] && first='#include "test.h"\n'
    local line="#include \"${header#src/}\""
    if grep -qxF "$line" <<<"$by_cpp" && ! grep -qxF "$line" <<<"$by_c"; then
        set -- "${CXX:-c++}" -std=c++17 -x c++
    else
        set -- "${CC:-cc}" "${c_only[@]}" -x c
    fi
    printf "$first"'#include "%s"\n#include "%s"\nextern int nothing;\n' "$header" "$header" |
        "$@" "${common[@]}" "${libraries[@]}" -
}

while IFS= read -r header; do
    if ! grep -q '^#pragma once' "$header"; then
        case $header in
        src/surface/*.h | src/*/*_list.h | src/*/*_body.h) continue ;;
        esac
        printf '%s: has no #pragma once\n' "$header"
        bad=1
        continue
    fi
    count=$((count + 1))
    if ! compile "$header"; then
        printf '%s: does not stand alone\n' "$header"
        bad=1
    fi
done < <(find src ui tests -name '*.h' | sort)
if [[ $count -lt 15 ]]; then
    printf 'only %d headers found: is this the right folder?\n' "$count"
    bad=1
fi
exit $bad
