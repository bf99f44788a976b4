#!/usr/bin/env bash
# Sizes and words: no file of the program over 1500 lines, no function over 80, and no word that says
# that something is unfinished.  shape.sh SOURCE-FOLDER
set -uo pipefail
cd "$1" || exit 1

bad=0
mapfile -t sources < <(find src ui -name '*.c' -o -name '*.h' -o -name '*.cpp' -o -name '*.hpp' | sort)
[[ ${#sources[@]} -ge 20 ]] || { printf 'only %d files found\n' "${#sources[@]}"; bad=1; }

# A function's body stands between a brace in the first column and the next closing one.
awk '
FNR == 1 && NR > 1 { check() }
{ lines = FNR; file = FILENAME }
/^\{/ { begin = FNR }
/^\}[ \t]*$/ && begin {
    if (FNR - begin > 81) {
        printf "%s:%d: a function of %d lines; 80 is the limit\n", FILENAME, begin, FNR - begin - 1
        bad = 1
    }
    begin = 0
}
function check() {
    if (lines > 1500) { printf "%s: %d lines; 1500 is the limit\n", file, lines; bad = 1 }
    begin = 0
}
END { check(); exit bad }' "${sources[@]}" || bad=1

# Spelt so that this line does not find itself.
words='T[O]DO|F[I]XME|X[X]X|H[A]CK|s[t]ub|not i[m]plemented|p[l]aceholder'
if find src ui brushes samples tests README.md CMakeLists.txt -type f -print0 2>/dev/null |
    xargs -0 grep -nIwE "$words"; then
    printf 'unfinished, by its own words\n'
    bad=1
fi
exit $bad
