#!/usr/bin/env bash
# The two pages of the guide that walk through the sources keep to the tree: the files that they name are there, what
# they name of a file is in it, and the numbers to move are in the window.  papers.sh SOURCE-FOLDER
set -uo pipefail
cd "$1" || exit 1
bad=0
fail() {
    printf '%s\n' "$*"
    bad=1
}
# shellcheck disable=SC2016 # backquotes of Markdown
quoted() { grep -oE '`[^`]+`' <<<"$1" | tr -d '`'; }

count=0
for page in ui/guide/paper.md ui/guide/lecture.md; do
    # Paragraphs and rows as one line each: a name may stand on the line after its file's.
    while IFS= read -r block; do
        files=() names=()
        while IFS= read -r word; do
            [[ $word =~ ^(src|ui|tests|samples)/[A-Za-z0-9_./-]+$ ]] && files+=("$word")
            [[ $word =~ ^[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)+$ || $word =~ ^Wr[A-Z][A-Za-z]+$ ]] && names+=("$word")
        done < <(quoted "$block")
        for file in ${files[@]+"${files[@]}"}; do
            count=$((count + 1))
            [[ -e $file ]] || fail "$page: $file is not there"
        done
        for name in ${names[@]+"${names[@]}"}; do
            count=$((count + 1))
            [[ $name == noise_u ]] && continue # what inspect prints
            [[ ${#files[@]} -gt 0 ]] && grep -qsw -- "$name" "${files[@]}" ||
                fail "$page: $name is in none of the files beside it: ${files[*]-}"
        done
    done < <(awk '/^    / { next } /^(\||- |#|$)/ { print line; line = "" } { line = line " " $0 } END { print line }' "$page")
    # **Radius** is what a row of the window is called: in quotes in the source, capital or not.
    while IFS= read -r label; do
        count=$((count + 1))
        grep -rqiF --include='*.c' --include='*.h' "\"${label% [xyz]}\"" ui src || fail "$page: the window has no '$label'"
    done < <(grep -oE '\*\*[^*.]{1,60}\*\*' "$page" | tr -d '*' | grep -vE '^(The|the) ' | sort -u)
done
[[ $count -gt 100 ]] || fail "only $count names found"
exit $bad
