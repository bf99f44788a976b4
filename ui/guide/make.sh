#!/usr/bin/env bash
# Generates the reference tables of the guide from the program's own tables. The lines between
#     <!-- wrinkle help --markdown ... -->
# and the next
#     <!-- so far -->
# are replaced by the output of that command.
#
#   make.sh [--out FOLDER] [PROGRAM]
#
# PROGRAM   path of wrinkle; default: the one in build/, else in the PATH
# --out     folder for the pages; default: this folder, in which only changed pages are written
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=$here program=''
while [[ $# -gt 0 ]]; do
    case $1 in
    --out) out=$2 && shift ;;
    -*) printf 'make.sh: unknown option %s\n' "$1" >&2 && exit 2 ;;
    *) program=$1 ;;
    esac
    shift
done
if [[ -z $program ]]; then
    program=$here/../../build/wrinkle
    [[ -x $program ]] || program=wrinkle
fi

# One page, to standard output.
make_page() {
    local line skip='' words
    while IFS= read -r line; do
        [[ $line == '<!-- so far -->' ]] && skip=''
        [[ -z $skip ]] && printf '%s\n' "$line"
        if [[ $line =~ ^'<!-- wrinkle help --markdown '([a-z -]+)' -->'$ ]]; then
            read -ra words <<<"${BASH_REMATCH[1]}"
            "$program" help --markdown "${words[@]}"
            echo # ends the table
            skip=yes
        fi
    done <"$1"
    [[ -z $skip ]] || { printf 'make.sh: %s: a table without end\n' "$1" >&2 && return 1; }
}

mkdir -p "$out"
new=$(mktemp)
trap 'rm -f "$new"' EXIT
for page in "$here"/*.md; do
    make_page "$page" >"$new"
    cmp -s "$new" "$out/$(basename "$page")" || cat "$new" >"$out/$(basename "$page")"
done
