#!/usr/bin/env bash
# The README and the guide are true: their commands run, page by page, in an empty folder beside the samples; what is
# made of the program's tables is what the program prints now; the tables that are written by hand leave nothing out;
# the files that they and the maps of the source name are there.
# readme.sh SOURCE-FOLDER PROGRAM
set -uo pipefail
source=$1 program=$2 guide=$1/ui/guide
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
export WRINKLE_DATA=$source # its brushes, wherever it was built
export WRINKLE_STATE=$folder/state XDG_CONFIG_HOME=$folder/config XDG_DATA_HOME=$folder/data
mkdir bin && ln -s "$program" bin/wrinkle
PATH=$folder/bin:$PATH

bad=0
fail() {
    printf 'README: %s\n' "$*"
    bad=1
}

# Indented lines that start with the program's name (or make a script for it) are run as they stand, but
# for the window's; each page in a folder of its own.
run_page() {
    local page=$1 line count=0 place
    place=$folder/$(basename "$page" .md)
    mkdir "$place" && cd "$place" || exit 1
    ln -s "$source/samples" samples
    ln -s "$source/brushes" brushes
    while IFS= read -r line; do
        [[ $line =~ ^wrinkle(\ paint.*|\ [^\ ]*\.[a-z]+)?$ ]] && continue
        # A sample that is made as it is, on the pages that walk through all of them: its own test does that.
        [[ $page =~ /(paper|lecture)\.md$ && $line =~ ^wrinkle\ (run|render)\ (samples/[a-z0-9-]+\.wrinkle)(\ -o\ [a-z0-9-]+\.png\ --size\ [0-9]+x[0-9]+)?$ &&
            -f $source/${BASH_REMATCH[2]} ]] && continue
        count=$((count + 1))
        bash -c "$line" >out 2>err || fail "$(basename "$page"): '$line' fails: $(tail -n 3 err)"
    done < <(sed -nE 's/^    ((wrinkle|printf)( .*)?)$/\1/p' "$page")
    cd "$folder" || exit 1
    all=$((all + count))
}
all=0
run_page "$source/README.md"
[[ $all -ge 8 ]] || fail "only $all commands found in the README"
# The point that the README inspects shows something: the bump tilts the normal there, along u and along v.
ln -s "$source/samples" samples
shown=$(bash -c "$(sed -n 's/^    \(wrinkle inspect .*\)/\1/p' "$source/README.md")" 2>err |
    awk '$1 == "tilt_deg" && $2 > 5 { n++ } ($1 == "Fu" || $1 == "Fv") && $2 != 0 { n++ } END { print n + 0 }')
[[ $shown == 3 ]] || fail "its wrinkle inspect shows flat ground: $(cat err)"
rm samples
mkdir guide && cd guide || exit 1
folder=$folder/guide
for page in "$guide"/*.md; do run_page "$page"; done
[[ $all -ge 25 ]] || fail "only $all commands found in all"
lines=$(wc -l <"$source/README.md")
[[ $lines -le 200 ]] || fail "README.md has $lines lines; 200 is the limit"

# ---- what is made of tables ----
bash "$guide/make.sh" --out made "$program" 2>err || fail "ui/guide/make.sh fails: $(cat err)"
for page in "$guide"/*.md; do
    diff "$page" "made/$(basename "$page")" >difference ||
        fail "$(basename "$page") is not what bash ui/guide/make.sh makes: $(head -n 6 difference)"
done
"$program" help --json >help.json 2>err || fail "wrinkle help --json fails: $(cat err)"
jq -r '.commands[].name' help.json | sort >known
[[ -s known ]] || fail "wrinkle help --json names no verb"
sed -nE 's/^<!-- wrinkle help --markdown (.*) -->$/\1/p' "$guide"/commands-*.md | tr ' ' '\n' | sort >told
diff known told || fail "the verbs (<) are not those of the pages (>)"
grep -qx '<!-- wrinkle help --markdown subcommands -->' "$guide/subcommands.md" || fail "no table of subcommands"
grep -qx '<!-- wrinkle help --markdown effects -->' "$guide/plan.md" || fail "no table of effects"
grep -qx '<!-- wrinkle help --markdown verbs -->' "$guide/language.md" || fail "no table of verbs"
while read -r verb; do
    "$program" help "$verb" >out 2>err || fail "wrinkle help $verb fails"
done <known
jq -r '.commands[].name' help.json | while read -r verb; do
    grep -qE "^\| .*\`$verb\`" "$guide/README.md" || echo "$verb"
done >missing
[[ ! -s missing ]] || fail "the guide's first page leaves out $(tr '\n' ' ' <missing)"

# ---- tables by hand: every form, mode and scheme stands in its page ----
# all_in PAGE WHAT WORD...
all_in() {
    local page=$1 what=$2 word
    shift 2
    [[ $# -gt 1 ]] || fail "$what: only $# words"
    for word in "$@"; do
        grep -qE "^\\| [^|]*[\` []${word}[]\` ]" "$guide/$page" || fail "$page leaves out the $what $word"
    done
}
forms() { jq -r ".commands[] | select(.name == \"$1\").forms[].name" help.json; }
choices() { jq -r ".commands[] | select(.name == \"$1\") | [.args[], (.forms // [] | .[].args[])] | map(select(.name == \"$2\")) | .[0].choices[]" help.json; }
mapfile -t words < <(forms pattern) && all_in generating.md pattern "${words[@]}"
mapfile -t words < <(forms solid) && all_in generating.md solid "${words[@]}"
mapfile -t words < <(forms terrain) && all_in generating.md terrain "${words[@]}"
mapfile -t words < <(forms picture) && all_in generating.md picture "${words[@]}"
mapfile -t words < <(forms ramp) && all_in brushes.md ramp "${words[@]}"
mapfile -t words < <(choices stroke mode) && all_in brushes.md mode "${words[@]}"
mapfile -t words < <(forms export | sed 's/+/\\+/') && all_in files.md export "${words[@]}"
mapfile -t words < <(forms surface) && all_in formulas.md surface "${words[@]}"
mapfile -t words < <(choices bump scheme) && all_in formulas.md scheme "${words[@]}"
mapfile -t words < <(choices bump mode) && all_in formulas.md mode "${words[@]}"
mapfile -t words < <(choices material model) && all_in formulas.md 'reflection model' "${words[@]}"
mapfile -t words < <("$program" --help | sed -nE '/^subcommands:/,/^$/s/^  ([a-z]+) .*/\1/p')
all_in command-line.md subcommand "${words[@]}"

# ---- every variable of the environment that the program asks for, but the tests' own ----
grep -rhoE 'getenv\("WRINKLE_[A-Z_]+"\)' "$source/src" "$source/ui" --include=*.c --include=*.cpp |
    sed -E 's/.*"(.*)".*/\1/' | grep -vx WRINKLE_REST | sort -u >variables
[[ -s variables ]] || fail "no variable of the environment was found"
while read -r variable; do
    grep -qE "^\| [^|]*\`$variable\`" "$guide/command-line.md" || fail "command-line.md leaves out $variable"
done <variables

# ---- files and folders of the checkout, as `src/...`, `tests/...`, `ui/...`, `samples/...`; rooms in the maps ----
maps=("$source/src/README.md" "$source/ui/README.md" "$source/tests/README.md")
# shellcheck disable=SC2016 # backquotes of Markdown
while IFS= read -r path; do
    [[ -e $source/$path ]] || fail "$path does not exist"
done < <(grep -ohE '`(src|ui|tests|samples|brushes)/[A-Za-z0-9_./-]*`' "$source/README.md" "$guide"/*.md "${maps[@]}" | tr -d '`' | sort -u)
while IFS= read -r path; do
    [[ -e $source/$path ]] || fail "$path, that the README leads to, does not exist"
done < <(grep -oE '\]\([^):#]*' "$source/README.md" | sed 's/^](//' | sort -u)
for room in "$source"/src/*/; do
    [[ -z $(find "$room" -name '*.c' -print -quit) ]] && continue
    grep -qF "\`src/$(basename "$room")/\`" "$source/src/README.md" || fail "src/README.md leaves out src/$(basename "$room")/"
done
exit $bad
