#!/usr/bin/env bash
# Does the compiler notice what has no row? Every line of table_rows.txt counts one more of something, and names the
# files that have a table of it or choose by it: each must then not compile, for that reason.
#   table_rows.sh SOURCE check                 the lines alone: the counts are there, and the files are
#   table_rows.sh SOURCE run BUILD FOLDER      in a copy in FOLDER, with the commands of BUILD, one after the other
set -uo pipefail
source=$(cd "$1" && pwd) what=$2
table=$source/tests/table_rows.txt
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
            [[ -f $source/$file ]] || { echo "table_rows: $name: there is no $file"; bad=1; }
        done
    done < <(grep -v '^#' "$table")
    rm -f "$scratch"
    return $bad
}

check || exit 1
[[ $what == check ]] && exit 0
build=$(cd "$3" && pwd) || exit 1
mkdir -p "$4" || exit 1
folder=$(cd "$4" && pwd)
tree=$folder/tree
rm -rf "$tree" && mkdir -p "$tree" || exit 1
(cd "$source" && find src ui -name '*.[ch]' -print0 | tar -c --null -T -) | tar -x -C "$tree" || exit 1

# FILE TAB COMMAND: as the build compiles it, but in the copy, and no further than its meaning.
SOURCE=$source TREE=$tree perl -MJSON::PP -0777 -ne '
    for my $e (@{ decode_json($_) }) {
        my ($file, $command) = ($e->{file}, $e->{command});
        $file =~ s/^\Q$ENV{SOURCE}\E\/// or next;
        $command =~ s/ -o \S+ / /;
        $command =~ s/\Q$ENV{SOURCE}\E\/(src|ui|tests)\b/$ENV{TREE}\/$1/g;
        $command =~ s/-I\Q$ENV{SOURCE}\E(?=\s)/-I$ENV{TREE}/g;
        print "$file\tcd $e->{directory} && $command -fsyntax-only -Werror\n";
    }' "$build/compile_commands.json" >"$folder/commands"
[[ -s $folder/commands ]] || fail "$build/compile_commands.json tells nothing"

# Says what the compiler says of a file, in FOLDER/said/FILE.
# shellcheck disable=SC2317  # called by xargs
try() {
    local command said=$folder/said/${1//\//_}
    command=$(awk -F '\t' -v f="$1" '$1 == f { print $2; exit }' "$folder/commands")
    [[ -n $command ]] || { echo "no command for $1" >"$said"; return; }
    CCACHE_DISABLE=1 LC_ALL=C bash -c "$command" >"$said" 2>&1 || echo 'it stopped' >>"$said"
}
export -f try
export folder
try_all() {
    rm -rf "$folder/said" && mkdir "$folder/said" || exit 1
    # shellcheck disable=SC2016  # for the shell that is started
    printf '%s\n' "$@" | sort -u | xargs -P "$(nproc)" -I {} bash -c 'try "$1"' try {}
}

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
