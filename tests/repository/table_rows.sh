#!/usr/bin/env bash
# Does the compiler notice what has no row? Every line of table_rows.txt counts one more of something, and names the
# files that have a table of it or choose by it: each must then not compile, for that reason.
#   table_rows.sh SOURCE check                 the lines alone: the counts are there, and the files are
#   table_rows.sh SOURCE run BUILD FOLDER      in a copy in FOLDER, with the commands of BUILD, one after the other
set -uo pipefail
source=$(cd "$1" && pwd) what=$2
table=$source/tests/repository/table_rows.txt
reasons='not a row for each|not handled in switch|static assertion failed|static_assert failed|undeclared|implicit declaration|counts them'
fail() {
    printf 'table_rows: %s\n' "$*" >&2
    exit 1
}

# One more: before the count that ends an enumeration, in a number, in the list of surfaces, or in one of words.
add() {
    COUNT=$2 perl -0pi -e '
        my $n = $ENV{COUNT};
        s/\b$n(\s*\})/WR_ONE_MORE, $n$1/ or s/(#define $n) (\d+)\b/"$1 " . ($2 + 1)/e or
            s/(\n$n\(\w+\))/$1\n$n(one_more)/ or
            s/(#define $n\(X\))/$1 X(WR_ONE_MORE, "one more")/ or exit 1;' "$1"
}

check() {
    local bad=0 name header count files file scratch
    scratch=$(mktemp) || return 1
    while IFS=$'\t' read -r name header count files; do
        [[ -n $files && -f $source/$header ]] || { echo "table_rows: not four columns, or no file: $name"; bad=1; continue; }
        cp "$source/$header" "$scratch"
        add "$scratch" "$count" || { echo "table_rows: $header does not count by $count"; bad=1; }
        for file in $files; do
            [[ -f $source/$file ]] || grep -q "wr_kern($(basename "$file" .c) " "$source/$(dirname "$file")/CMakeLists.txt" ||
                { echo "table_rows: $name: there is no $file"; bad=1; }
        done
    done < <(grep -v '^#' "$table")
    rm -f "$scratch"
    return $bad
}

check || exit 1
[[ $what == check ]] && exit 0
# shellcheck source=tests/repository/compile_help.sh
source "$source/tests/repository/compile_help.sh"
scratch_tree "$source" "$3" "$4" || fail "$3/compile_commands.json has no commands"

bad=0
mapfile -t everything < <(grep -v '^#' "$table" | cut -f 4 | tr ' ' '\n' | sort -u)
try_all "${everything[@]}"
for file in "${everything[@]}"; do
    said=$folder/said/${file//\//_}
    [[ -s $said ]] && { echo "table_rows: $file does not compile as it is:"; head -3 "$said"; bad=1; }
done
[[ $bad == 0 ]] || exit 1

while IFS=$'\t' read -r name header count files; do
    cp "$tree/$header" "$folder/kept" && add "$tree/$header" "$count" || exit 1
    # shellcheck disable=SC2086  # a list of files
    try_all $files
    for file in $files; do
        said=$folder/said/${file//\//_}
        if ! grep -q 'it stopped' "$said"; then
            echo "table_rows: one more $name: $file does not notice"
            bad=1
        elif ! grep -qE "$reasons" "$said"; then
            echo "table_rows: one more $name: $file stops for another reason:"
            head -3 "$said"
            bad=1
        else
            printf '%s: %s: %s\n' "$name" "$file" "$(grep -oE "$reasons" "$said" | sort -u | paste -sd ,)"
        fi
    done
    cp "$folder/kept" "$tree/$header"
done < <(grep -v '^#' "$table")
exit $bad
