#!/usr/bin/env bash
# prose.sh ROOT - plain English in comments, messages and the guide: counts the words and the constructions that made texts
# hard to read, and fails above these limits. Limits go down, never up.
set -uo pipefail
root=$1
cd "$root" || exit 2

# per 1000 words:     "what"  verbs of mind, said of code
limits='
comments               0.1    0.2
tests                  0.1    0.1
messages               1.3    1.4
guide                  0.6    0.6
'
clauses_max=0 # first lines of headers that begin with a clause instead of a noun
coined_max=0   # words of the project's own that the field has another word for; none is in the glossary of src/README.md

mind='knows|tells|asks|says|minds|wishes|wears|wants|thinks|believes|remembers|forgets|sees|likes|told|asked|wished|brings|gives|takes'
coined='caged|knots|rooms|brothers|shelf|wearer'
clause='what|how|where|which|whether|when|who|that|why|all|of|to|as'

# The text of comments, one line each, from source files on standard input.
comments() {
    awk '
    {
        line = $0
        while (line != "") {
            if (inside) {
                at = index(line, "*/")
                print at ? substr(line, 1, at - 1) : line
                line = at ? substr(line, at + 2) : ""
                inside = !at
            } else if (match(line, /"([^"\\]|\\.)*"|\047([^\047\\]|\\.)*\047|\/\*|\/\//)) {
                token = substr(line, RSTART, RLENGTH)
                if (token == "//") { print substr(line, RSTART + 2); line = "" }
                else { line = substr(line, RSTART + RLENGTH); inside = token == "/*" }
            } else line = ""
        }
    }'
}

# String literals of two words or more, from standard input.
messages() {
    grep -ohE '"([^"\\]|\\.)*[a-z] [a-z]([^"\\]|\\.)*"'
}

guide() {
    # shellcheck disable=SC2016 # backquotes of Markdown
    sed '/^```/,/^```/d; /^    /d' "$@"
}

sources() {
    find "$@" -name '*.[ch]' -o -name '*.cpp' | sort
}

of() {
    case $1 in
    comments) sources src ui | xargs cat | comments ;;
    tests) sources tests | xargs cat | comments ;;
    messages) sources src ui | xargs cat | messages ;;
    guide) guide README.md ui/guide/*.md ;;
    esac
}

failed=0
complain() {
    printf 'prose: %s\n' "$*"
    failed=1
}

while read -r name what_max mind_max; do
    [[ -n $name ]] || continue
    read -r words what verbs < <(of "$name" | tr '[:upper:]' '[:lower:]' | tr -cs "[:lower:]_'" '\n' |
        awk -v mind="^($mind)\$" '$0 != "" { n++ } $0 == "what" { w++ } $0 ~ mind { m++ } END { printf "%d %.2f %.2f\n", n, n ? 1000 * w / n : 0, n ? 1000 * m / n : 0 }')
    [[ $words -gt 1000 ]] || complain "only $words words of $name were found: the count is broken"
    printf '%-10s %7d words, per 1000: what %s, verbs of mind %s\n' "$name" "$words" "$what" "$verbs"
    awk -v a="$what" -v b="$what_max" 'BEGIN { exit !(a > b) }' &&
        complain "$name: \"what\" $what times in 1000 words, at most $what_max: use a noun"
    awk -v a="$verbs" -v b="$mind_max" 'BEGIN { exit !(a > b) }' &&
        complain "$name: verbs of mind $verbs times in 1000 words, at most $mind_max: code returns, stores, checks, passes"
done <<<"$limits"

# "/* name.h - noun phrase"
clauses=$(sources src ui | grep '\.h$' | xargs awk -v clause="^/[*] [a-z0-9_.]+ - ($clause) " '
    FNR == 1 { if (tolower($0) ~ clause) print FILENAME ": " $0; nextfile }')
count=$(grep -c . <<<"$clauses")
printf '%d headers begin with a clause\n' "$count"
[[ $count -le $clauses_max ]] || complain "$count headers begin with a clause, at most $clauses_max:"$'\n'"$clauses"

words=$(sources src ui tests | xargs cat | comments | grep -oiwE "$coined" | sort | uniq -c | sort -rn)
count=$(awk '{ n += $1 } END { print n + 0 }' <<<"$words")
printf '%d coined words\n' "$count"
[[ $count -le $coined_max ]] || complain "$count coined words in comments, at most $coined_max:"$'\n'"$words"
exit $failed
