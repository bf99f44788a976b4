#!/usr/bin/env bash
# The README is true: its commands run, one after the other, in an empty folder beside the samples; its
# verbs are the program's verbs, all of them; the files that it names are there.
# readme.sh SOURCE-FOLDER PROGRAM
set -uo pipefail
source=$1 program=$2 readme=$1/README.md
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
ln -s "$source/samples" samples
ln -s "$source/brushes" brushes
export WRINKLE_DATA=$source # its brushes, wherever it was built
mkdir bin && ln -s "$program" bin/wrinkle
PATH=$folder/bin:$PATH

bad=0
fail() {
    printf 'README: %s\n' "$*"
    bad=1
}

# Indented lines that start with the program's name (or make a script for it) are run as they stand, but
# for the window's.
count=0
while IFS= read -r line; do
    [[ $line =~ ^wrinkle(\ paint.*|\ [^\ ]*\.[a-z]+)?$ ]] && continue
    count=$((count + 1))
    bash -c "$line" >out 2>err || fail "'$line' fails: $(tail -n 3 err)"
done < <(sed -nE 's/^    ((wrinkle|printf)( .*)?)$/\1/p' "$readme")
[[ $count -ge 8 ]] || fail "only $count commands found"

# The verbs in the table of the command language, word by word against the program's own table.
sed -nE '/^## The command language/,/^## /s/^\| `([a-z]+)` \| (.*) \| (.*) \|$/\1 \2 \3/p' "$readme" |
    sort >told
"$program" help --json >help.json 2>err || fail "wrinkle help --json fails: $(cat err)"
jq -r '.commands[] | .name + " " + .class + " " + .help' help.json | sort >known
[[ -s known ]] || fail "wrinkle help --json names no verb"
diff known told || fail "the program's verbs (<) are not those told of (>)"
while read -r verb _; do
    "$program" help "$verb" >out 2>err || fail "wrinkle help $verb fails"
done <told

# The rules of the plan, by number and name.
sed -nE '/^## The plan/,/^## /s/^\| (E[0-9]+) \| ([^|]*) \|.*/\1 \2/p' "$readme" | sort >told
"$program" explain samples/grid.wrinkle --json >plan.json 2>err || fail "wrinkle explain --json fails"
jq -r '.effects[] | .rule + " " + .name' plan.json | sort >known
diff known told || fail "the plan's rules (<) are not those told of (>)"

# Files and folders of the checkout, as `src/...`, `tests/...`, `ui/...`, `samples/...`.
while IFS= read -r path; do
    [[ -e $source/$path ]] || fail "$path does not exist"
done < <(grep -oE '`(src|ui|tests|samples)/[A-Za-z0-9_./-]*`' "$readme" | tr -d '`' | sort -u)
for room in "$source"/src/*/; do
    [[ -z $(find "$room" -name '*.c' -print -quit) ]] && continue
    grep -qF "src/$(basename "$room")/" "$readme" || fail "the tour leaves out src/$(basename "$room")/"
done
exit $bad
