#!/usr/bin/env bash
# Do the hard cases notice what they guard, and the tests of files and recovery? Every line of mutations.txt breaks
# one thing in the program's own code - a sign, a bound, a fallback, an epsilon - and names the cases that must then
# fail. mutations_files.txt does so for what writes, reads and recovers files, mutations_plan.txt for what the plan
# leaves out; they name tests.
#   mutate.sh SOURCE check [TABLE]       the table alone: its texts are there, its files are, the page tells its counts
#   mutate.sh SOURCE tell                the sentence about them that the page has
#   mutate.sh SOURCE run FOLDER [TABLE]  build all of them at once in FOLDER, and break one after the other
# A mutation whose cases all pass survives: they have no teeth there. `run` tells those, cases that miss what is
# aimed at them, and cases that nothing is aimed at; any of these is an error. What came out is in
# FOLDER/results: number, cases, file, which of them noticed, which missed it.
set -uo pipefail
source=$(cd "$1" && pwd) what=$2 folder=
[[ $what != run ]] || { folder=${3:-}; shift; }
name=${3:-mutations.txt}
table=$source/tests/repository/$name
[[ -f $table ]] || { printf 'mutate: no table %s\n' "$name" >&2; exit 1; }
is_hard() { [[ $name == mutations.txt ]]; }
fail() {
    printf 'mutate: %s\n' "$*" >&2
    exit 1
}

# What the page says of the table. That none survives is what `run` makes sure of.
tell() {
    local count cases
    count=$(grep -vc '^#' "$table")
    cases=$(grep -v '^#' "$table" | cut -f 1 | tr ' ' '\n' | LC_ALL=C sort -u | wc -l)
    # shellcheck disable=SC2016  # backquotes of the page
    printf '`tests/repository/mutate.sh run` breaks the program in %d places, one at a time: each of the %d cases that are measured notices what is aimed at it, and 0 survive.\n' \
        "$count" "$cases"
}

# Rows whose texts are no expressions by themselves, by brackets, commas and ends: they could not be planted.
open_rows() {
    # shellcheck disable=SC2016  # perl's names
    perl -F'\t' -lane '
        next if /^#/ || @F < 4;
        for (@F[2, 3]) {
            my $rest = $_;
            1 while $rest =~ s/\([^][(){}]*\)|\[[^][(){}]*\]|\{[^][(){}]*\}//;
            next if $rest !~ /[][(){},]|;$/ && !/^(#|(if|for|while|return|static|const)\b)/;
            print "mutate: no expression by itself: $_";
            $bad = 1;
        }
        END { exit !!$bad }' "$table"
}

# Texts that are not there, and a page that tells other counts.
check() {
    local bad=0 rows file old new
    while IFS=$'\t' read -r rows file old new; do
        [[ -z $rows || $rows == '#'* || $rows == ' '* || -z $file ]] && continue
        [[ -n $new && -f $source/$file ]] || { echo "mutate: not four columns, or no file: $rows $file"; bad=1; }
        grep -qF -- "$old" "$source/$file" || { echo "mutate: $file does not hold: $old"; bad=1; }
    done < <(grep -v '^#' "$table")
    open_rows || bad=1
    ! is_hard || grep -qxF -- "$(tell)" "$source/samples/accuracy/README.md" ||
        { echo "mutate: samples/accuracy/README.md lacks: $(tell)"; bad=1; }
    return $bad
}

# The tree with all of them in it, the number in WR_MUTANT choosing one.
plant() {
    local tree=$1 number=0 rows file old new
    rm -rf "$tree" && mkdir -p "$tree" || return 1
    (cd "$source" && git ls-files -z --cached --others --exclude-standard CMakeLists.txt LICENSE README.md src tests ui samples | tar -c --null -T -) | tar -x -C "$tree" || return 1
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
        >>"$tree/src/system/fd.c"
}

# What asks: the rows of the hard cases, or the tests that the table names and what they run.
targets() {
    local known id
    is_hard && { echo hard_rows; return; }
    known=$(ninja -C "$1" -t targets all | cut -d : -f 1)
    for id in wrinkle wrinkle-reader wrinkle_oiio wrinkle_assimp wrinkle_librsvg wrinkle_window wr_fault hang $(named | sed 's/^/test_/'); do
        grep -qxF "$id" <<<"$known" && echo "$id"
    done
}
named() { grep -v '^#' "$table" | cut -f 1 | tr ' ' '\n' | LC_ALL=C sort -u; }

# Less optimised than the program, which takes half the time; the same numbers come out.
build() {
    cmake -S "$1" -B "$2" -G Ninja -DCMAKE_BUILD_TYPE=Mutants \
        -DCMAKE_C_FLAGS='-O1 -DNDEBUG' -DWR_SANITIZE= -DWR_WERROR=OFF \
        -DWR_TESTS=ON >"$folder/configure.log" 2>&1 || fail "configure: see $folder/configure.log"
    # shellcheck disable=SC2046  # a list of targets
    ninja -C "$2" $(targets "$2") >"$folder/build.log" 2>&1 || fail "build: see $folder/build.log"
}

if [[ $what == tell ]]; then
    tell
    exit
fi
check || exit 1
[[ $what == check ]] && exit 0
[[ -n $folder ]] || fail 'run needs a folder'
mkdir -p "$folder"
plant "$folder/tree" || exit 1
build "$folder/tree" "$folder/build"
rows_program=
is_hard && rows_program=$folder/build/hard_rows
# NAME, PROGRAM and its argument, of the tests in C; what is not there is a script, and run by ctest.
programs() {
    local program
    for program in "$folder"/build/run_*; do "$program" | sed "s|.*|&\t$program\t&|"; done
    for program in "$folder"/build/test_*; do printf '%s\t%s\n' "${program##*/test_}" "$program"; done
}
is_hard || programs >"$folder/programs"
rm -rf "$folder/told" && mkdir "$folder/told" || exit 1
wrong=0

# Those of the cases "$@" that fail, with the precisions that do, or that stop the program.
failing() {
    local id said command
    for id in "$@"; do
        if [[ -n $rows_program ]]; then
            said=$(timeout 120 "$rows_program" "$id" 2>/dev/null) || echo "${said:-$id float double}"
        elif IFS=$'\t' read -r -a command < <(sed -n "s/^$id\t//p" "$folder/programs"); then
            (cd "$folder/build/tests" && timeout 300 "${command[@]}") >/dev/null 2>&1 || echo "$id"
        else
            ctest --test-dir "$folder/build" --timeout 300 -R "^$id\$" >/dev/null 2>&1 || echo "$id"
        fi
    done
}
# Each mutation by itself, as many at once as there are processors.
try() {
    # shellcheck disable=SC2086  # a list of ids
    WR_MUTANT=$1 failing $2 >"$folder/told/$1"
}
export -f try failing
export rows_program folder

# Unbroken, every case must pass; and every case that is measured must be named.
if is_hard; then
    "$rows_program" >"$folder/precisions"
    cut -d ' ' -f 1 "$folder/precisions" | LC_ALL=C sort -u >"$folder/measured"
    for id in $(named | LC_ALL=C comm -23 "$folder/measured" -); do
        echo "mutate: nothing is aimed at $id"
        wrong=1
    done
fi
# shellcheck disable=SC2046  # a list of ids
failing=$(WR_MUTANT=0 failing $(named))
[[ -z $failing ]] || { echo "mutate: fails unbroken: $failing"; wrong=1; }
number=0
while IFS=$'\t' read -r rows _; do
    number=$((number + 1))
    [[ -n ${WR_MUTATE_TENTH:-} && $(((number * 7 + WR_MUTATE_TENTH) % 10)) != 0 ]] && continue
    printf '%s\0%s\0' "$number" "$rows"
done < <(grep -v '^#' "$table") | xargs -0 -n 2 -P "$(nproc)" bash -c 'try "$1" "$2"' try

number=0 tried=0 survivors=0
: >"$folder/results"
while IFS=$'\t' read -r rows file old new; do
    number=$((number + 1))
    [[ -f $folder/told/$number ]] || continue
    tried=$((tried + 1))
    noticed=$(cut -d ' ' -f 1 "$folder/told/$number" | tr '\n' ' ') missed=
    for id in $rows; do [[ " $noticed" == *" $id "* ]] || missed+=" $id"; done
    if [[ -z $noticed ]]; then
        survivors=$((survivors + 1))
        echo "mutate: $number survives $rows: $file: $old -> $new"
    elif [[ -n $missed ]]; then
        wrong=1
        echo "mutate: $number is not noticed by$missed: $file: $old -> $new"
    fi
    printf '%s\t%s\t%s\t%s\t%s\n' "$number" "$rows" "$file" "$noticed" "$missed" >>"$folder/results"
done < <(grep -v '^#' "$table")
# For who wants more: cases that were broken in one precision alone.
is_hard && {
    awk '{ for (i = 2; i <= NF; i++) print $1, $i }' "$folder/precisions" | LC_ALL=C sort >"$folder/bounds"
    awk '{ for (i = 2; i <= NF; i++) print $1, $i }' "$folder/told"/* | LC_ALL=C sort -u |
        LC_ALL=C comm -13 - "$folder/bounds" | paste -sd ',' | sed 's/^/mutate: nothing shows in /; s/,/, /g'
}
cases=$(cut -f 2 "$folder/results" | tr ' ' '\n' | LC_ALL=C sort -u | wc -l)
echo "mutate: $tried mutations aimed at $cases cases, $survivors survive"
exit $((survivors > 0 || wrong))
