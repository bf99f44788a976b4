#!/usr/bin/env bash
# `wrinkle accuracy` at the shell: its files and their readers, its errors, a tolerance beside everything; the
# page of samples/accuracy made anew, tiny.  accuracy.sh SOURCE-FOLDER PROGRAM
set -uo pipefail
source=$1 program=$2
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0
complain() {
    printf '%s\n' "$*"
    failures=$((failures + 1))
}
# refuse STATUS WORDS ARGUMENTS...: ends with that status, one line that holds the words, and no file.
refuse() {
    local want=$1 words=$2
    shift 2
    "$program" accuracy "$@" >out 2>err </dev/null
    [[ $? == "$want" ]] || complain "not status $want: $*"
    grep -qF -- "$words" err || complain "'$*' does not say: $words, but: $(cat err)"
    [[ ! -s out && $(wc -l <err) == 1 ]] || complain "not one clear message: $*"
    rm -f out err
    [[ -z $(ls -A) ]] || complain "$* left files"
}

refuse 1 'must be one of derivative, normal' --axis colour
refuse 1 'at most 4096' --size 5000x10
refuse 1 'is not a folder' --differences nosuch
refuse 1 'rms=VALUE or max=VALUE' --size 16x16 --tolerance time=8ms
refuse 1 'above 0' --size 16x16 --tolerance rms=0
refuse 1 'above 0' --size 16x16 --tolerance rms=nan
refuse 1 '.png or .svg' --size 8x8 --runs 3 --axis normal --plot plot.bmp
refuse 1 'No such file' nosuch.wrinkle
refuse 1 '--illusion alone' --size 8x8 --map map.png
refuse 1 'goes with --size' --size 8x8 --illusion --csv a.csv
refuse 1 'nothing to displace' --size 8x8 --illusion --do 'bump height=0'
refuse 1 'map.xyz' --size 8x8 --illusion --map map.xyz --do 'dab 0.3,0.7 radius=60 strength=1' --do 'bump height=0.1'
refuse 1 '--runs 2' --runs 2
refuse 2 '--csv' --csv

# The hard cases from the command line, interrupted once they are being measured; `hardcases` is the test that measures them.
"$program" accuracy --hard-cases --json >out 2>err & cases=$!
for ((i = 0; i < 2400; i++)); do
    read -ra stat 2>/dev/null <"/proc/$cases/stat" || break
    ((stat[13] < 30)) || break # ticks of its own
    sleep 0.05
done
kill -INT $cases
wait $cases
[[ $? != 0 && ! -s out ]] && grep -q interrupted err || complain "hard cases are not interrupted: $(cat out err)"
rm -f out err

"$program" accuracy --size 40x30 --illusion --map map.png --json --do 'dab 0.3,0.7 radius=60 strength=1' --do 'bump height=0.1' >a.json ||
    complain 'the illusion is not measured'
jq -e '.width == 40 and .shading > 0 and .outline >= 0 and .rise > 0 and (.advice | length > 20)' a.json >/dev/null || complain "the illusion's JSON lacks something"
[[ $(identify -format '%m %w' map.png) == 'PNG 40' ]] || complain 'the map is no picture 40 wide'
rm -f map.png

scene=$source/samples/accuracy/contest/cube.wrinkle
mkdir pictures
"$program" accuracy "$scene" --size 24x24 --runs 3 --axis antialiasing --csv a.csv --plot a.png --plot a.svg \
    --differences pictures --json >a.json 2>err || complain "accuracy fails: $(cat err)"
rungs=$(jq '.rungs | length' a.json) || complain 'the JSON cannot be read'
[[ $rungs -ge 10 ]] || complain "only $rungs rungs"
jq -e '.document == "cube.wrinkle" and .width == 24 and .threads == 1 and .reference.samples >= 16 and
    (.claim.bump_over_phong > 0) and ([.rungs[] | select(.front)] | length > 1) and
    ([.rungs[] | select(.note == null) | .seconds > 0 and .runs == 3] | all)' a.json >/dev/null ||
    complain 'the JSON lacks something'
# The front, recomputed.
jq -e '[.rungs[] | select(.note == null and (.model | not))] as $all |
    [$all[] | . as $r | select(.front) | [$all[] | select(.seconds < $r.seconds and .rms < $r.rms)] | length] |
    add == 0' a.json >/dev/null || complain 'a rung on the front is beaten in both'
[[ $(wc -l <a.csv) == $((rungs + 1)) ]] || complain 'the CSV has not a line a rung'
[[ $(head -n 1 a.csv) == axis,setting,front,* ]] || complain 'the CSV lacks its heading'
[[ $(identify -format '%m %w' a.png) == 'PNG 1280' ]] || complain 'the plot is no picture 1280 wide'
# Nothing is cut: what reaches the border goes on beyond it.
for plot in a.png "$source"/samples/accuracy/*-plot.png; do
    for side in east west north south; do
        strip=4x0 && [[ $side != *th ]] || strip=0x4
        [[ $(convert "$plot" -gravity $side -crop $strip+0+0 +repage -format '%[fx:minima>0.95]' info:) == 1 ]] ||
            complain "$plot: something is cut at its $side"
    done
done
grep -q '</svg>' a.svg || complain 'the SVG is not whole'
[[ $(find pictures -name '*.png' | wc -l) -ge 10 ]] || complain 'difference pictures are missing'
[[ $(identify -format '%wx%h' pictures/00-*.png) == 24x24 ]] || complain 'a difference picture has another size'

"$program" accuracy "$scene" --size 48x48 --tolerance rms=0.05 --tolerance rms=1e-7 --json >b.json 2>err ||
    complain "accuracy --tolerance fails: $(cat err)"
jq -e '.rows[0].held and (.rows[0] | has("pays_from")) and .rows[0].rms <= 0.05 and .rows[0].best_seconds > 0 and
    (.rows[1].held | not) and (.rows[1].claimed | not)' b.json >/dev/null || complain "$(cat b.json)"
"$program" explain "$scene" --size 64x64 --do 'tolerance rms=0.05' >c 2>err || complain "explain fails: $(cat err)"
grep -q '^tolerance rms=0.05: met' c && grep -q '^whole picture: scheme=' c || complain 'explain does not tell the choice'
"$program" explain "$scene" --size 64x64 --do 'tolerance rms=0.05' --json | jq -e '.tolerance.met' >/dev/null ||
    complain 'explain --json does not tell the choice'

# The page, its scenes and its pictures; hard cases as if they were measured before.
mkdir kept
printf '{"cases":[{"id":"HC07","what":"the pole","verdict":"fail"},{"id":"HC08","what":"no","verdict":"pass"}],"pass":1,"fail":1,"waits":0}' >kept/hard.json
bash "$source/samples/accuracy/make.sh" --quick --out page --keep kept "$program" >out 2>err ||
    complain "make.sh fails: $(tail -n 3 err)"
grep -q 'measures 2 cases: 1 pass, 1 fail' page/README.md && grep -qx -- '- HC07, the pole: fails.' page/README.md ||
    complain 'the page does not name the hard case that fails'
for path in "$source"/samples/accuracy/*.wrinkle; do
    name=$(basename "$path" .wrinkle)
    for page in page/README.md "$source/samples/accuracy/README.md"; do
        grep -qx "## $name" "$page" || complain "$page leaves out $name"
    done
    [[ -s page/$name.png && -s page/$name-plot.png ]] || complain "no pictures of $name"
done
for page in page "$source/samples/accuracy"; do
    while read -r file; do
        [[ -s $page/$file ]] || complain "$page/README.md shows $file, which is not there"
    done < <(grep -oE '\]\([a-z0-9-]+\.png\)' "$page/README.md" | tr -d ']()')
done
# Each script renders; an ordinary run takes every third.
count=0
turn() { [[ -n ${WR_FULL:-} || $((count++ % 3)) == 0 ]]; }
for name in "$source"/samples/accuracy/contest/*.wrinkle; do
    turn || continue
    "$program" render "$name" -o small.png --size 16x16 2>err || complain "$name: $(cat err)"
done
for name in "$source"/samples/accuracy/unseen/*.wrinkle; do
    ! turn || "$program" render "$name" -o small.png --size 16x16 2>err || complain "$name: $(cat err)"
    grep -q "^| $(basename "$name" .wrinkle) |" "$source/samples/accuracy/README.md" ||
        complain "the page leaves out $(basename "$name")"
done
[[ $failures == 0 ]]
