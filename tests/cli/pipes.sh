#!/usr/bin/env bash
# Files through pipes, several inputs in one line, and receipts: the bytes are those of the named file, the reports go
# elsewhere, one failure stops nothing else, and a receipt agrees with the file.  pipes.sh PROGRAM
set -uo pipefail
program=$1
folder=$(mktemp -d) && cd "$folder" || exit 1
trap 'rm -rf "$folder"' EXIT
export WRINKLE_STATE=$folder/state XDG_CONFIG_HOME=$folder/config TMPDIR=$folder/tmp
mkdir tmp
bad=0
complain() { printf 'pipes: %s\n' "$*"; bad=1; }
# run STATUS ARGUMENTS...: standard output in `out`, errors in `err`.
run() {
    local want=$1 got
    shift
    "$program" "$@" >out 2>err </dev/null
    got=$?
    [[ $got == "$want" ]] || complain "status $got, not $want: $*: $(head -c 300 err)"
    [[ -z $(ls -A tmp) ]] || complain "temporary files stay: $*: $(find tmp)"
}
has() { grep -qF -- "$2" "$1" || complain "$1 lacks '$2': $(head -c 300 "$1")"; }
same() { cmp -s "$1" "$2" || complain "$3: other bytes"; }

printf 'table 61x37\nnoise perlin cells=3 octaves=2 seed=7\n' >a.wrinkle
printf 'table 43x29\ngrid cells=4x3\n' >b.wrinkle
printf 'table 43x29\nnonsense\n' >wrong.wrinkle

# ---- one file to standard output ----
while read -r ending words; do
    # shellcheck disable=SC2086
    run 0 export a.wrinkle --as $words -o "named.$ending"
    # shellcheck disable=SC2086
    run 0 export a.wrinkle --as $words -o - --format "$ending"
    same out "named.$ending" "export $words -o - $ending"
    has err '-: '
    [[ $(wc -l <err) == 1 ]] || complain "more than the report: $(cat err)"
done <<'KINDS'
png height depth=16
tif normal+y
exr slopes
raw height depth=16
svg lines
stl stl
ply ply error=0.5
KINDS
run 0 export a.wrinkle --as height -o named.png
run 0 export a.wrinkle --as height -o /dev/stdout
same out named.png /dev/stdout
run 0 export a.wrinkle --as height depth=32 -o named.exr
run 0 export a.wrinkle --as height depth=32 -o -
same out named.exr 'floats are exr'
run 0 render a.wrinkle --size 33x21 -o named.png
run 0 render a.wrinkle --size 33x21 -o -
same out named.png 'render -o -'
run 0 render a.wrinkle --size 33x21 -o named.exr
run 0 render a.wrinkle --size 33x21 -o - --format .EXR
same out named.exr 'render -o - --format .EXR'
[[ ! -e - ]] || complain 'a file named - was made'

# Several files, and what else has no sense there, are errors of the line.
for line in 'export a.wrinkle b.wrinkle --as height' 'export a.wrinkle --as unreal' 'export a.wrinkle --as height --watch' \
    'render a.wrinkle --frames 1-3' 'render a.wrinkle --missing'; do
    # shellcheck disable=SC2086
    run 2 $line -o -
    [[ ! -s out ]] || complain "results in spite of an error: $line"
done
run 1 export a.wrinkle --as height mips=on -o -
[[ ! -s out ]] || complain 'one of several files was written'
has err 'standard output holds one'
run 1 export a.wrinkle --as height -o - --format p.ng
run 1 export a.wrinkle --as height -o - --format xyz
has err 'extension'
run 2 export a.wrinkle --as height -o a.png --format png
run 2 render a.wrinkle -o a.png --format png
has err '--format goes with -o -'
run 1 export wrong.wrinkle --as height -o -
[[ ! -s out ]] || complain 'bytes in spite of an error'
for command in 'export height -' 'copy -' 'render /dev/stdout'; do # scripts write named files
    printf '%s\n' "$command" >s.wrinkle
    run 1 run s.wrinkle
done

# ---- standard output that takes nothing ----
"$program" export a.wrinkle --as height -o - >/dev/full 2>err
[[ $? == 1 && $(grep -c '^wrinkle: ' err) == 1 ]] || complain "a full disk: $(cat err)"
has err 'No space left on device'
{ "$program" export --do 'table 700x700' --do 'noise perlin' --as height -o - 2>err; echo $? >status; } | true
[[ $(cat status) == 1 && $(grep -c '^wrinkle: ' err) == 1 ]] || complain "a closed pipe: $(cat status err)"
has err 'standard output: the program that reads it has ended'
[[ -z $(ls -A tmp) ]] || complain "temporary files stay: $(find tmp)"

# ---- several inputs ----
mkdir single two one sets single-sets
for name in a b; do
    run 0 export $name.wrinkle --as normal+y -o single/$name.png
    run 0 export $name.wrinkle --as unreal -o single-sets
done
run 0 export a.wrinkle b.wrinkle --as normal+y -o two/ -j 2
diff -r single two >/dev/null || complain "two inputs at once: $(diff -r single two)"
[[ $(cut -d: -f1 out) == $'two/a.png\ntwo/b.png' ]] || complain "reports: $(cat out)"
run 0 export a.wrinkle b.wrinkle --as normal+y -o one --threads 1
diff -r single one >/dev/null || complain 'one input after the other'
run 0 export a.wrinkle b.wrinkle --as unreal -o sets -j 5
diff -r single-sets sets >/dev/null || complain 'sets of two inputs'
rm -f one/*
run 0 export a.wrinkle --as normal+y -o one # one input, as *.wrinkle may be
same one/a.png single/a.png 'a folder for one input'
run 0 export a.wrinkle b.wrinkle --as slopes -o one
run 0 export a.wrinkle --as height -o one --format tif
run 0 export a.wrinkle --as stl -o one
[[ $(ls one) == $'a.exr\na.png\na.stl\na.tif\nb.exr' ]] || complain "names: $(ls one)"

rm -f two/*
run 1 export wrong.wrinkle a.wrinkle none.wrinkle b.wrinkle --as normal+y -o two -j 3
diff -r single two >/dev/null || complain 'a failure stopped others'
has err 'wrinkle: wrong.wrinkle:2: unknown command "nonsense"'
has err 'wrinkle: none.wrinkle: No such file'
has err 'wrinkle: 2 of 4 files failed'
[[ $(cut -d: -f1 out) == $'two/a.png\ntwo/b.png' ]] || complain "reports beside failures: $(cat out)"

# Errors before any work.
mkdir sub && cp b.wrinkle sub/a.wrinkle
rm -f two/*
run 2 export b.wrinkle a.wrinkle sub/a.wrinkle --as height -o two
has err 'a.wrinkle and sub/a.wrinkle: both'
run 2 export b.wrinkle a.wrinkle sub/a.wrinkle --as unreal -o two
cp named.exr c.exr
run 2 export a.wrinkle c.exr --as slopes -o ./
has err 'c.exr: is an input'
same named.exr c.exr 'the input'
run 1 export a.wrinkle b.wrinkle --as height -o nowhere/
has err 'is not a folder'
run 2 export a.wrinkle b.wrinkle --as height -o two --watch
run 1 export a.wrinkle b.wrinkle --as height -o two -j 0
run 2 export a.wrinkle two.png --as height
has err 'did you mean -o two.png?'
[[ -z $(ls -A two) ]] || complain "written in spite of an error: $(ls two)"

# ---- receipts ----
# check FILE: each line is an object that agrees with its file; prints file, kind, size, channels, depth.
check() {
    python3 - "$1" <<'PYTHON'
import hashlib, json, sys
names = "file input kind width height channels depth range codes clipped triangles error unit sha256 seconds".split()
for line in open(sys.argv[1]):
    r = json.loads(line)
    assert list(r) == names, line
    assert 0 <= r["seconds"] < 600, line
    if r["file"] != "-":
        assert hashlib.sha256(open(r["file"], "rb").read()).hexdigest() == r["sha256"], line
    print(*[r[n] for n in ("file", "input", "kind", "width", "height", "channels", "depth", "unit")])
PYTHON
}
# expect FILE LINES
expect() { [[ $(check "$1" 2>&1) == "$2" ]] || complain "receipts: $(check "$1" 2>&1)"; }
run 0 export a.wrinkle b.wrinkle --as normal+y -o two --json -j 2
expect out $'two/a.png a.wrinkle normal+y 61 37 3 16 degrees\ntwo/b.png b.wrinkle normal+y 43 29 3 16 degrees'
run 0 export b.wrinkle --as stl -o b.stl --json
expect out 'b.stl b.wrinkle stl None None None None mm'
grep -q '"triangles":[1-9]' out || complain "no triangles: $(cat out)"
run 0 export b.wrinkle --as height depth=16 -o b.tif --json --do 'fill 0.25' --do 'dab 0.5,0.5 radius=4 strength=0.5'
expect out 'b.tif b.wrinkle height 43 29 1 16 height'
grep -qF '"range":[0.25,0.75],"codes":[0.25,0.75],"clipped":0' out || complain "range: $(cat out)"
run 0 export b.wrinkle --as height range=0,1 depth=8 -o b.png --json --do 'fill 2'
grep -qF "\"range\":[2,2],\"codes\":[0,1],\"clipped\":$((43 * 29))," out || complain "clipped: $(cat out)"
run 0 export b.wrinkle --as unity contact=all.png -o two --json
check out >told || complain 'receipts of a set'
grep -q '^two/all.png b.wrinkle contact ' told || complain "no contact sheet: $(cat told)"
run 0 export a.wrinkle --as height -o - --json
head -n 1 err >told
expect told '- a.wrinkle height 61 37 1 16 height'
[[ $(sha256sum <out) == "$(sed 's/.*"sha256":"//; s/".*//' told)  -" ]] || complain 'the SHA-256 of a pipe'
run 0 render a.wrinkle --size 20x10 -o 'f##.png' --frames 3-4 --of 9 --json
expect out $'f03.png a.wrinkle picture 20 10 3 8 None\nf04.png a.wrinkle picture 20 10 3 8 None'
run 0 render a.wrinkle --size 20x10 -o 'f##.png' --frames 3-5 --of 9 --missing --json
expect out 'f05.png a.wrinkle picture 20 10 3 8 None'
run 0 render a.wrinkle --size 20x10 -o f.exr --json
expect out 'f.exr a.wrinkle picture 20 10 4 32 None'
printf 'table 31x17\nsave d.exr\ncopy c.exr\nexport normal-y n.png\nrender r.png size=9x7\nmaps godot two name=k\n' >s.wrinkle
run 0 run s.wrinkle --json
check out >told || complain 'receipts of a script'
[[ $(head -n 4 told) == 'd.exr s.wrinkle document None None None None None
c.exr s.wrinkle copy 31 17 2 32 None
n.png s.wrinkle normal-y 31 17 3 16 degrees
r.png s.wrinkle picture 9 7 3 8 None' ]] || complain "a script: $(cat told)"
[[ $(grep -c '^two/k' told) -ge 2 ]] || complain "no maps: $(cat told)"
"$program" run s.wrinkle --json >/dev/full 2>err
[[ $? == 1 ]] || complain 'receipts that are lost'
exit $bad
