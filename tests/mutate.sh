#!/usr/bin/env bash
# Do the hard cases notice what they guard? Every line of mutations.txt breaks one thing in the program's own
# code - a sign, a bound, a fallback, an epsilon - and names the cases that must then fail.
#   mutate.sh SOURCE check           the table alone: its texts are there, its files are
#   mutate.sh SOURCE run FOLDER      build all of them at once in FOLDER, and break one after the other
# A mutation whose cases all pass survives: they have no teeth there. `run` tells those, and writes what came out
# to FOLDER/results: number, cases, file, which of them noticed, which missed it.
set -uo pipefail
source=$(cd "$1" && pwd) what=$2 folder=${3:-}
table=$source/tests/mutations.txt
fail() {
    printf 'mutate: %s\n' "$*" >&2
    exit 1
}

# Texts that are not there.
check() {
    local bad=0 rows file old new
    while IFS=$'\t' read -r rows file old new; do
        [[ -z $rows || $rows == '#'* || $rows == ' '* || -z $file ]] && continue
        [[ -n $new && -f $source/$file ]] || { echo "mutate: not four columns, or no file: $rows $file"; bad=1; }
        grep -qF -- "$old" "$source/$file" || { echo "mutate: $file does not hold: $old"; bad=1; }
    done < <(grep -v '^#' "$table")
    return $bad
}

# The tree with all of them in it, the number in WR_MUTANT choosing one.
plant() {
    local tree=$1 number=0 rows file old new
    rm -rf "$tree" && mkdir -p "$tree" || return 1
    (cd "$source" && git ls-files -z CMakeLists.txt LICENSE README.md src tests ui samples | tar -c --null -T -) | tar -x -C "$tree" || return 1
    # the longer texts first: a shorter one may stand within them
    while IFS=$'\t' read -r number rows file old new; do
        OLD=$old NUMBER=$number perl -0pi -e '
            s/\A/extern int wr_mutant;\n/ unless /extern int wr_mutant;/;
            s/\Q$ENV{OLD}\E/(wr_mutant == $ENV{NUMBER} ? (\@NEW$ENV{NUMBER}\@) : ($ENV{OLD}))/g;
            ' "$tree/$file" || return 1
        grep -q "@NEW$number@" "$tree/$file" || { echo "mutate: $number: not planted: $old"; return 1; }
    done < <(grep -v '^#' "$table" | awk -F '\t' '{ print length($3) "\t" NR "\t" $0 }' | sort -rn | cut -f 2-)
    number=0
    while IFS=$'\t' read -r rows file old new; do
        number=$((number + 1))
        NEW=$new NUMBER=$number perl -0pi -e 's/\@NEW$ENV{NUMBER}\@/$ENV{NEW}/g' "$tree/$file"
    done < <(grep -v '^#' "$table")
    printf '%s\n' '#include <stdlib.h>' 'int wr_mutant;' \
        '__attribute__((constructor)) static void wr_mutant_read(void)' '{' \
        '    const char *text = getenv("WR_MUTANT");' '    wr_mutant = text ? atoi(text) : 0;' '}' \
        >>"$tree/src/base/error.c"
}

build() {
    cmake -S "$1" -B "$2" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DWR_SANITIZE= -DWR_WERROR=OFF \
        -DWR_TESTS=ON >"$folder/configure.log" 2>&1 || fail "configure: see $folder/configure.log"
    ninja -C "$2" hard_rows >"$folder/build.log" 2>&1 || fail "build: see $folder/build.log"
}

check || exit 1
[[ $what == check ]] && exit 0
[[ -n $folder ]] || fail 'run needs a folder'
mkdir -p "$folder"
plant "$folder/tree" || exit 1
build "$folder/tree" "$folder/build"
rows_program=$folder/build/hard_rows
number=0 survivors=0 wrong=0
: >"$folder/results"
while IFS=$'\t' read -r rows file old new; do
    number=$((number + 1))
    read -ra ids <<<"$rows"
    [[ -n ${WR_MUTATE_TENTH:-} && $(((number * 7 + WR_MUTATE_TENTH) % 10)) != 0 ]] && continue
    WR_MUTANT=0 timeout 120 "$rows_program" "${ids[@]}" >"$folder/sound" 2>&1 ||
        { echo "mutate: $rows: does not pass unbroken"; wrong=1; }
    noticed=$(WR_MUTANT=$number timeout 120 "$rows_program" "${ids[@]}" 2>/dev/null)
    status=$?
    [[ $status -gt 1 ]] && noticed="$noticed stopped"
    missed=
    for id in "${ids[@]}"; do [[ $noticed == *$id* || $noticed == *stopped* ]] || missed+=" $id"; done
    [[ -n $noticed ]] || { survivors=$((survivors + 1)); echo "mutate: $number survives $rows: $file: $old -> $new"; }
    printf '%s\t%s\t%s\t%s\t%s\n' "$number" "$rows" "$file" "$(tr '\n' ' ' <<<"$noticed")" "$missed" >>"$folder/results"
done < <(grep -v '^#' "$table")
tried=$(wc -l <"$folder/results")
cases=$(cut -f 2 "$folder/results" | tr ' ' '\n' | LC_ALL=C sort -u | wc -l)
"$rows_program" | LC_ALL=C sort -u >"$folder/measured"
grep -v '^#' "$table" | cut -f 1 | tr ' ' '\n' | LC_ALL=C sort -u | comm -23 "$folder/measured" - | tr '\n' ' ' |
    sed 's/^/mutate: nothing is aimed at: /; s/$/\n/'
echo "mutate: $tried mutations aimed at $cases cases, $survivors survive"
# WR_PAGE=1: the page of the measurements tells it.
[[ -n ${WR_PAGE:-} && -z ${WR_MUTATE_TENTH:-} ]] && sed -i -E \
    "s/^\`tests\/mutate.sh\`: .*/\`tests\/mutate.sh\`: $tried mutations aimed at $cases cases, $survivors survive./" \
    "$source/samples/accuracy/README.md"
exit $((survivors > 0 || wrong))
