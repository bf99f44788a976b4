#!/usr/bin/env bash
# All C and C++ is laid out as .clang-format says.  format.sh SOURCE-FOLDER
# To mend: clang-format -i FILE...
set -uo pipefail
cd "$1" || exit 1
if ! command -v clang-format >/dev/null; then
    printf 'clang-format is missing: apt-get install clang-format\n'
    exit 1
fi
find src ui tests -name '*.c' -o -name '*.h' -o -name '*.cpp' -o -name '*.hpp' | sort |
    xargs clang-format --dry-run -Werror --ferror-limit=3
