#!/usr/bin/env bash
# The command line: exit statuses, messages, --do, standard input, inspect, explain, render, export, and
# that nothing is written that nobody asked for.  cli.sh PROGRAM
set -uo pipefail
program=$1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0

complain() {
    printf '%s\n' "$*"
    failures=$((failures + 1))
}

# expect STATUS ARGUMENTS...: runs the program, keeps out and err; an error is one line that begins
# "wrinkle: ".
expect() {
    local want=$1 got
    shift
    "$program" "$@" >out 2>err </dev/null
    got=$?
    [[ $got == "$want" ]] || complain "status $got, not $want: $* ($(head -c 300 err))"
    if [[ $want != 0 ]]; then
        [[ $(grep -vc '^wrinkle: note: ' err) == 1 && $(tail -n 1 err) == "wrinkle: "* ]] ||
            complain "not one clear message: $*: $(cat err)"
        [[ ! -s out ]] || complain "results in spite of an error: $*"
    fi
}

# has FILE TEXT: the file holds the text.
has() { grep -qF -- "$2" "$1" || complain "$1 lacks: $2"; }

# is WHAT GOT WANT
is() { [[ $2 == "$3" ]] || complain "$1: $2, not $3"; }

# empty: the folder holds nothing but this script's own two files.
empty() {
    rm -f out err
    [[ -z $(ls -A) ]] || complain "$1 left files: $(ls -A)"
}

# ---- the shell line ----
expect 0 --version
grep -qE '^wrinkle [0-9]+\.[0-9]+\.[0-9]+$' out || complain "the version is: $(cat out)"
expect 0 --help
has out 'render    render a picture'
for command in run render export check inspect explain help; do
    expect 0 "$command" --help
    has out "wrinkle $command"
    expect 0 "$command" -h
done
expect 2 rendr
has err 'did you mean render'
expect 2 render --sise 4x4 -o a.png
has err 'did you mean --size'
expect 2 rendr nosuch.wrinkle -o a.png --size 4x4
has err 'did you mean render'
expect 2 dab 0.5,0.5
has err "it is a command of scripts: \`wrinkle render --do 'dab"
expect 2 render --out a.png
has err 'did you mean -o, --output'
expect 2 check --jsn a.png
has err 'did you mean --json'
expect 2 bench --quik
has err 'did you mean --quick'
expect 2 export --size 4x4
has err 'render, explain, accuracy'
expect 1 export --as hieght -o a.png
has err 'did you mean height?'
expect 1 export --as ambient_occlusion -o a.png
has err 'did you mean occlusion?'
expect 2 export --as height --depth 16 -o a.png
has err 'did you mean depth=VALUE'
expect 2 render --samples 16 -o a.png
has err "--do 'dials samples=...'"
expect 2 render a.exr b.png
has err 'did you mean -o b.png?'
expect 1 render --do dab 0.5,0.5 -o a.png
has err "goes in quotes: --do 'dab 0.5,0.5'"
expect 1 render --do 'environment studoi' -o a.png
has err 'did you mean studio?'
expect 2 version
has err 'did you mean --version?'
expect 1 export --as normal -o a.png
has err 'did you mean normal+y or normal-y?'
expect 1 check --as nromal a.png
has err 'did you mean normal?'
expect 1 check --coding sgined a.png
has err 'did you mean signed?'
expect 1 accuracy --axis lihgt
has err 'did you mean light?'
expect 1 inspect --isa v33
has err 'did you mean v3?'

# Each option of each subcommand with two letters swapped, one missing, one doubled: the right one is suggested.
while read -r command name; do
    for typed in "${name:0:3}${name:4:1}${name:3:1}${name:5}" "${name:0:3}${name:4}" "${name:0:3}${name:3:1}${name:3}"; do
        grep -qE -- "(^  |, )$typed( |\$)" "help.$command" && continue
        expect 2 "$command" "$typed"
        grep -qE -- "did you mean [^?]*$name|has no option $typed " err || complain "$command $typed: $(cat err)"
    done
done < <(for command in run render export check inspect explain accuracy recover brushes help; do
    "$program" "$command" --help >"help.$command"
    grep -oE '^  (-o, )?--[a-z-]+' "help.$command" | sed "s/.*--/$command --/"
done)
rm -f help.*

expect 2 render
has err '-o OUT'
expect 2 render -o
expect 2 render -o a.png --turn 5
expect 2 inspect --do
expect 2 inspect --size 4x4
expect 2 export -o a.png
expect 2 export --as height
expect 2 run
expect 2 inspect a b
expect 1 render -o a.png --size 0x0
has err '0x0'
expect 1 render -o a.png --size 4
expect 1 inspect --threads 0
expect 1 inspect --threads many
expect 1 inspect --isa mmx
expect 1 inspect --face 7
expect 1 inspect --face 1
expect 1 inspect --at 1
expect 1 inspect --at 0.5,x
expect 1 render -o $'a\nb.png'
has err 'a?b.png: the file name contains the control character 0x0a'
[ ! -e $'a\nb.png' ] || complain 'a file whose name has a line break was written'
expect 0 inspect --at 1.5,0.5 --json
has err 'the plane ends at 0 and 1'
# a rectangle of 2 x 1 whose left half and right half have the same (u,v): two places
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nvt 0 0\nvt .5 0\nvt .5 1\nvt 0 1\n%s\n%s\n' \
    'f 1/1 2/2 5/3 4/4' 'f 2/1 3/2 6/3 5/4' >twice.obj
expect 0 inspect --at 0.25,0.25 --json --do 'surface mesh file=twice.obj'
[ "$(jq -c .P out | tr '\n' ' ')" = '[0.5,0.25,0] [1.5,0.25,0] ' ] || complain "places of a mesh: $(cat out)"
[ "$(jq -c .Pu out | sort -u)" = '[2,0,0]' ] || complain "Pu of a mesh: $(cat out)"
has err '2 places have these texture coordinates'
expect 1 inspect --at 0.75,0.25 --do 'surface mesh file=twice.obj'
has err 'no place with these texture coordinates'
rm twice.obj
expect 1 export --as nosuch -o a.png
has err 'nosuch'
expect 1 export --as height nosuch=1 -o a.png
expect 1 export --as height range=0,1 range=0,2 -o a.png
expect 1 render -o a.png --frames 0-3
has err '####'
expect 1 render -o 'a####.png' --frames 3-1
expect 2 render -o a.png --of 3
has err 'needs --frames'
expect 1 render -o 'a####.png' --frames 1-3 --of 0
has err '1..1000000'
expect 1 render -o a.png --memory 0.5
expect 2 export -o a.png --missing
expect 1 help nosuch
expect 1 inspect nosuch.exr
is 'missing file' "$(cat err)" 'wrinkle: nosuch.exr: No such file or directory'
expect 1 run nosuch.wrinkle
expect 1 inspect -- --strange
expect 1 inspect /
expect 1 inspect --do 'fil 1'
has err 'wrinkle: --do: unknown command "fil": did you mean fill'
expect 1 inspect --do 'fill 1' --do 'fil 1' --do 'fill 2'
has err 'wrinkle: --do 2 of 3: unknown command "fil"'
empty 'errors'

# ---- --do, in order, before or after FILE ----
printf 'table 8x8\nfill 1\nsave s.exr\nrender s.png\nexport height s.png\n' >s.wrinkle
expect 0 inspect --do 'fill 2' s.wrinkle --do 'fill 3'
has out 'heights      3 .. 3'
is 'a note for each skipped output' "$(grep -c skipped err)" 3
[[ $(echo *) == 'err out s.wrinkle' ]] || complain "inspect of a script left $(echo *)"
expect 0 inspect s.wrinkle --do 'fill 3' --do 'fill 2' --do 'save t.exr'
has out 'heights      2 .. 2'
expect 0 --threads=1 inspect s.wrinkle
has out 'heights      1 .. 1'
expect 1 inspect s.wrinkle --do 'fill 3' --do 'fill'
for file in s.exr s.png t.exr; do [[ ! -e $file ]] || complain "$file was written"; done
rm s.wrinkle

# ---- run ----
printf 'table 8x4\nfill 0.25\n\nsave d.exr\n' | "$program" run - >out 2>err || complain "run -: $(cat err)"
[[ ! -s out && ! -s err ]] || complain 'run - talks'
expect 0 inspect d.exr
has out '8x4'
has out 'heights      0.25 .. 0.25'
printf 'fill 1\nfil 2\nsave e.exr\n' | "$program" run - >out 2>err
is 'a bad line of standard input' "$?" 1
has err 'wrinkle: standard input:2: unknown command "fil"'
[[ ! -e e.exr ]] || complain 'run went on after an error'
mkdir sub
cp d.exr sub/h.exr
printf 'image h.exr\nexport height h.png range=0,0.5\n' >sub/a.wrinkle
expect 0 run sub/a.wrinkle --do 'save f.exr'
[[ -s h.png && -s f.exr && ! -e sub/h.png ]] || complain 'run wrote elsewhere'
printf 'fill 1\ndab 9\n' >sub/b.wrinkle
expect 1 run sub/b.wrinkle
has err 'wrinkle: sub/b.wrinkle:2: dab'
rm -rf sub ./*.exr ./*.png

# ---- inspect: points whose values are known ----
# F = 0.5 (2 + 0.25 u v) = 1 + 0.125 u v on the unit plane: Fu = 0.125 v, Fv = 0.125 u, all exact in
# binary; n = (0,0,1), D = Fu (n x Pv) - Fv (n x Pu) = (-Fu, -Fv, 0).
expect 0 inspect --json --do 'analytic poly c=0,0,2;1,1,0.25' --do 'bump height=0.5 mode=blinn' \
    --at 0.5,0.25 --at 0,0
is 'objects' "$(wc -l <out)" 2
first=$(head -n 1 out)
want='{"u":0.5,"v":0.25,"P":[0.5,0.25,0],"Pu":[1,0,0],"Pv":[0,1,0],"Puu":[0,0,0],"Puv":[0,0,0],'
want+='"Pvv":[0,0,0],"N":[0,0,1],"n":[0,0,1],"F":1.015625,"Fu":0.03125,"Fv":0.0625,'
want+='"A":[0.0625,-0.03125,0],"D":[-0.03125,-0.0625,0],"N_perturbed":[-0.03125,-0.0625,1],"n_perturbed":['
[[ $first == "$want"* ]] || complain "inspect gave $first"
keys=$(grep -o '"[A-Za-z_]*":' <<<"$first" | tr -d '":' | tr '\n' ' ')
is 'the order of fields' "$keys" \
    'u v P Pu Pv Puu Puv Pvv N n F Fu Fv A D N_perturbed n_perturbed tilt_deg '
# tilt = atan |D| / |N| = atan(0.0625 sqrt(1.25))
awk -v line="$first" 'BEGIN {
    sub(/.*tilt_deg":/, "", line); x = line + 0
    y = atan2(0.0625 * sqrt(1.25), 1) * 180 / atan2(0, -1)
    exit !(x - y < 1e-12 && y - x < 1e-12)
}' || complain "tilt_deg of $first"
# A slope that only the table gives: 64 texels, 1 in texel column 32, central difference across two.
printf '0.5,0.25\n\n0.25,0.5\n' | "$program" inspect --json --at - --do 'analytic poly c=1,0,1' \
    --do 'bump height=1' >points 2>err || complain "--at -: $(cat err)"
is 'points of standard input' "$(wc -l <points)" 2
has points '"F":0.25,"Fu":1,"Fv":0'
printf '0.5,0.25\nx\n' | "$program" inspect --at - >out 2>err
is 'a bad point' "$?" 1
has err 'line 2'
[[ ! -s out ]] || complain 'results in spite of a bad point'
# D' = a D |N| / |D| of a 2 x 3 plane, |N| = 6: D = (-3 Fu, -2 Fv, 0), a = |(Fu, Fv)|.
expect 0 inspect --json --at 0.3,0.7 --do 'surface plane a=2 b=3' --do 'bump mode=invariant height=1' \
    --do 'analytic poly c=1,0,0.3;0,1,0.4'
awk '{ gsub(/.*"D_prime":\[/, ""); split($0, d, /[],]/); s = 6 * 0.5 / sqrt(0.9 * 0.9 + 0.8 * 0.8)
    x = d[1] + 0.9 * s; y = d[2] + 0.8 * s; exit !(x * x + y * y < 1e-28) }' out ||
    complain "D' is $(cat out)"
# Without slope n' is n to the bit, whatever the sizes.
expect 0 inspect --json --at 0.3,0.7 --do 'surface plane a=1.2 b=1.2' --do 'bump mode=blinn'
has out '"n_perturbed":[0,0,1],"tilt_deg":0}'
for mode in blinn invariant exact; do
    expect 0 inspect --json --at 0.3,0.7 --do 'surface sphere' --do "bump mode=$mode"
    is "n' of a flat table, $mode" "$(grep -o '"n_perturbed":[^]]*' out | cut -d: -f2)" \
        "$(grep -o '"n":[^]]*' out | cut -d: -f2)"
done
# In double to the end: the fitted spline passes through a texel that stands on a level of a million.
expect 0 inspect --json --at 0.5,0.5 --do 'table 5x3' --do 'fill 1e6' --do 'bump scheme=bspline-fit height=1' \
    --do 'dab 0.5,0.5 radius=0.6 hardness=1 strength=0.25'
awk '{ gsub(/.*"F":/, ""); x = $0 + 0 - 1000000.25; exit !(x * x < 1e-16) }' out || complain "F in $(cat out)"
expect 0 inspect --json --at 1e300,0.5 --do 'surface plane a=1e10'
has out '"N":[0,0,10000000000]'
noise='noise perlin cells=4 octaves=1 scatter=off level=2 amplitude=0.5'
expect 0 inspect --json --noise "$noise" --at 0.25,0.5 --at 0.3,0.4 # 0 at lattice points
[[ $(head -n 1 out) == '{"u":0.25,"v":0.5,"noise":0,"noise_u":'*',"F":2,"Fu":'*',"octaves":1}' ]] ||
    complain "the noise at a lattice point is $(head -n 1 out)"
[[ $(wc -l <out) == 2 ]] || complain 'not a line for each point'
expect 0 inspect --noise "$noise" --do 'table 4x4' --at 0.3,0.4 # too fine for so small a table
has out 'octaves      0'
expect 1 inspect --noise "$noise"
has err '--at U,V is missing'
expect 1 inspect --noise 'fill 3' --at 0,0
has err 'must be a noise command'
expect 1 inspect --noise 'noise perlin ratio=1' --at 0,0
has err 'ratio=1'
expect 0 inspect --json --do 'table 12x34'
want='"layer_list":[{"name":"base","blend":"add","opacity":1,"radius":0,"visible":true,"locked":false,'
want+='"cover":false,"mask":false,"active":true,"solo":false}],"selection":false}'
[[ $(cat out) == '{"size":[12,34],"layers":1,"hash":"'????????????????????????????????'",'"$want" ]] ||
    complain "summary: $(cat out)"
expect 0 inspect --do 'layer add moss blend=smooth-max radius=0.5' --do 'layer set 1 lock=on visible=off'
has out '> 2          moss  smooth-max, opacity 1, radius 0.5'
has out '  1          base  add, opacity 1, hidden, locked'
expect 1 inspect --do 'layer set 1 lock=on' --do 'fill 1'
has err 'layer 1 "base" is locked'
expect 1 inspect --do undo
has err 'nothing to undo'
expect 0 inspect --at 0.5,0.5 --do 'surface cube' --face 5 --json
expect 1 inspect --at 0.5,0.5 --do 'surface cube' --face 6
# An object that wears one layer: F is that layer's.
expect 0 inspect --at 0.3,0.6 --json --do 'table 8x8' --do 'fill 1' --do 'layer add other' --do 'fill 2' \
    --do 'object set layer=other' --do 'bump height=1'
is "F of an object that wears one layer" "$(jq .F out)" 2
rm -f points
empty 'inspect'

# ---- the same bits on any number of threads ----
cat >work.wrinkle <<'END'
table 300x200
grid cells=7x5 width=9 high=0.5
stroke points=0.1,0.1;0.9,0.4,0.5;1.2,1.1,0.9 radius=23 strength=0.2
dab 0.02,0.98 radius=50 mode=to to=-0.25 strength=0.125
surface torus
bump height=0.05
END
for threads in 1 2 7; do
    expect 0 inspect work.wrinkle --json --threads "$threads"
    mv out hash
    expect 0 render work.wrinkle -o frame.exr --size 60x50 --threads "$threads"
    cat hash <(sha256sum <frame.exr) >"same$threads"
done
{ cmp -s same1 same2 && cmp -s same1 same7; } || complain 'threads change the document or its picture'
rm -f same? hash

# ---- render and export ----
rm -f frame.exr
expect 0 render work.wrinkle -o 't####.png' --size 16x16 --frames 8-11 --turn 90
[[ $(echo t*) == 't0008.png t0009.png t0010.png t0011.png' ]] || complain "frames: $(echo t*)"
expect 0 render work.wrinkle -o still.png --size 16x16
cmp -s t0008.png still.png || complain 'frame 8 at 90 degrees a frame is not the still picture'
cmp -s t0009.png still.png && complain 'a quarter turn changes nothing'
rm -f t*.png still.png
echo before >kept.png
expect 1 render work.wrinkle -o kept.png --do 'fill x'
expect 1 render work.wrinkle -o nofolder/a.png
expect 1 render work.wrinkle -o a.nosuch
expect 1 export work.wrinkle --as height -o kept.jpg depth=16
is 'a file that an error must not touch' "$(cat kept.png)" before
expect 0 export range=0,0.5 work.wrinkle --as height -o h.png
has out 'h.png: 300x200'
[[ -s h.png ]] || complain 'export wrote nothing'
expect 0 inspect h.png
has out '300x200'
rm -f kept.png h.png

# ---- explain ----
expect 0 explain work.wrinkle --json --size 16x16
[[ $(cat out) == '{"effects":[{"rule":"E'*'}],"costs":[{"name":"preparing"'*'}],"work_seconds":'*',"width":16,"height":16,"covered":'*',"samples":'*',"seconds":'*'}' ]] ||
    complain "explain: $(cat out)"
has out '"run":true,"class":"'
# Every cost is on some row: effects and costs add up to the whole, under a tolerance too.
for words in 'dials arithmetic=exact' 'surface torus' 'dials aa=adaptive samples=4' 'dials aa=moments' 'tolerance rms=0.05'; do
    expect 0 explain work.wrinkle --json --size 48x32 --do "$words"
    jq -e '([.effects[].seconds, .costs[].seconds] | add) as $sum | .work_seconds as $all |
        ($sum - $all | fabs) < 1e-6 * $all and ([.effects[].seconds, .costs[].seconds] | min) >= 0 and
        (.costs | map(select(.name == "rest" or .name == "storing" or .name == "preparing")) | length) == 3' \
        out >/dev/null || complain "explain, $words: the rows do not add up: $(cat out)"
done
# Little of a frame is on no row of its own, however busy the machine: at best of three.
for surface in 'sphere' torus bezier; do
    for try in 1 2 3; do
        expect 0 explain work.wrinkle --json --size 192x192 --do "surface $surface" --do 'dials aa=supersample samples=4'
        jq -e '([.costs[] | select(.name == "rest") | .seconds] | add) < 0.1 * .work_seconds' out >/dev/null && break
        [[ $try -lt 3 ]] || complain "explain, $surface: a tenth of the frame and more is on no row: $(cat out)"
    done
done
# The back of a closed body is seen by an eye within it.
expect 0 explain work.wrinkle --json --size 16x16 --do 'surface torus R=1 r=0.4' --do 'camera perspective eye=1,0,0 target=1,1,0'
jq -e '.effects[] | select(.rule == "E25") | .run and (.reason | contains("inner walls"))' out >/dev/null ||
    complain "explain within a torus: $(cat out)"
# Everything that could be left out runs, and the picture is the same to the bit.
expect 0 explain work.wrinkle --full --json --size 33x21 --do 'surface sphere' --do 'bump mode=blinn scheme=catmull'
jq -e '([.effects[] | select(.reason | startswith("forced: "))] | length) > 0 and
    ([.effects[] | select(.class == "I" and .run)] | length) >= 5' out >/dev/null ||
    complain "explain --full: nothing is forced: $(cat out)"
for words in 'surface sphere' 'surface torus' 'bump mode=exact' 'bump scheme=bspline'; do
    expect 0 render work.wrinkle -o planned.exr --size 33x21 --do "$words"
    expect 0 render work.wrinkle --full -o full.exr --size 33x21 --do "$words"
    cmp planned.exr full.exr || complain "render --full is another picture: $words"
done
rm -f planned.exr full.exr
expect 0 explain work.wrinkle --size 16x16
has out 'reason'
has out 'of all threads together'
# What each effect costs and what leaving it out saves: in both forms, under a tolerance too; no time is judged.
expect 0 explain work.wrinkle --measure --size 16x16
has out 'costs ms  saved ms    spread   tiles    pixels  measured'
has out 'cannot be forced: there is no picture without it'
has out 'cannot be forced: nothing in the scene needs it'
[[ $(grep -c ' [0-9]* runs' out) -ge 5 ]] || complain "explain --measure: $(cat out)"
for words in 'surface torus' 'dials aa=moments' 'tolerance rms=0.05'; do
    expect 0 explain work.wrinkle --measure --json --size 32x32 --do "$words"
    jq -e 'def measured: map(select(.measured.why_not | not));
        ([.effects[] | select(.measured.why_not == null and .measured.runs < 3)] | length) == 0 and
        (.effects | measured | length) >= 4 and
        (.effects | measured | all((.run and .measured.saved_seconds == null and (.measured.costs_seconds | type) == "number")
            or (.run == false and .measured.costs_seconds == null and (.measured.saved_seconds | type) == "number"))) and
        (.effects | measured | all(.measured.tiles > 0 and .measured.pixels > 0 and .measured.spread_seconds >= 0)) and
        (.effects[] | select(.rule == "E28") | .measured.why_not | contains("no picture without it")) and
        (.effects[] | select(.rule == "E34") | .measured.why_not | contains("nothing in the scene needs it"))' \
        out >/dev/null || complain "explain --measure, $words: $(cat out)"
done
# Where each effect ran, as a picture whose colours are told: those of all pixels, and no others.
for words in 'surface torus' 'dials aa=adaptive samples=8' 'dials aa=moments' 'tolerance rms=0.05'; do
    expect 0 explain work.wrinkle --map map.png --size 40x32 --do "$words"
    [[ $(sed -n '/^colour  *pixels/,/^$/s/^#[0-9a-f]* *\([0-9]*\)  .*/\1/p' out | paste -sd+ | bc) == $((40 * 32)) ]] ||
        complain "explain --map, $words: $(cat out)"
    expect 0 inspect map.png
    has out '40x32'
    expect 0 explain work.wrinkle --map map.png --json --size 40x32 --do "$words"
    jq -e '([.map[].pixels] | add) == 40 * 32 and ([.map[].colour] | unique | length) == (.map | length) and
        all(.map[]; .colour | test("^#[0-9a-f]{6}$"))' out >/dev/null || complain "explain --map --json, $words: $(cat out)"
done
expect 1 explain work.wrinkle --map map.txt
expect 1 explain work.wrinkle --map nofolder/map.png
expect 1 explain work.wrinkle --map ''
rm -f map.png
# Without being asked nothing is measured.
expect 0 explain work.wrinkle --json --size 16x16
jq -e '[.effects[] | select(has("measured"))] | length == 0' out >/dev/null || complain 'explain measures unasked'
expect 0 explain work.wrinkle --json --size 32x32 --do 'tolerance rms=0.05'
grep -q '"chosen":\[{"bump":"[^"\\]*","dials":"[^"\\]*"}\]' out ||
    complain "explain tells the choice as $(cat out)"
# What cannot be kept to is told, by render as by explain.
expect 0 render work.wrinkle --size 32x32 -o t.png --do 'tolerance rms=0.0000001'
has err 'MISSED'
rm -f t.png
# A new document's edges are smooth; a script that says otherwise is taken at its word.
expect 0 render -o smooth.tif --size 64x64 --do 'table 8x8' --do 'surface sphere R=1'
expect 0 render -o two.tif --size 64x64 --do 'table 8x8' --do 'surface sphere R=1' --do 'dials aa=supersample samples=2'
expect 0 render -o point.tif --size 64x64 --do 'table 8x8' --do 'surface sphere R=1' --do 'dials aa=point'
cmp -s smooth.tif two.tif || complain 'a new document has not 2 x 2 samples'
cmp -s smooth.tif point.tif && complain 'a new document has stairs at its edges'
expect 0 help dials
has out 'supersample'
rm -f smooth.tif two.tif point.tif
# Frames of a turn have one choice, told once.
expect 0 render work.wrinkle --size 32x32 -o 't##.png' --frames 1-8 --do 'tolerance rms=0.0000001'
[[ $(grep -c 'tolerance rms' err) == 1 ]] || complain "a turn tells its choice as $(cat err)"
has err '8 frames: MISSED'
expect 0 render work.wrinkle --size 32x32 -o 't##.png' --frames 1-8 --do 'tolerance rms=0.05'
has err 'dials chosen on 2 of them for all'
rm -f t*.png

# ---- help ----
expect 0 help
has out 'stroke'
expect 0 help bump mode
has out 'mode='
expect 0 help adjust blur bump scheme
has out 'sigma='
has out 'scheme='
expect 1 help bump moed
has err 'did you mean mode?'
expect 0 help fill bump
has out 'example: fill'
has out 'example: bump'
expect 0 help render
has out 'size=WxH'
expect 0 help --json
has out '"name":"stroke","class":"edit"'
expect 0 help stroke fill --json
is 'the commands named, a line each' "$(jq -r .name out | paste -sd ' ')" 'stroke fill'
expect 2 help --completion csh
has err 'bash'
expect 0 help --markdown stroke effects
has out '## stroke'
has out '| E25 | back faces | '
expect 1 help --markdown stroek
has err 'did you mean stroke'
"$program" help >/dev/full 2>err
is 'a full disk under standard output' "$?" 1
has err 'standard output'

# ---- an interrupt ----
rm -f err
mkfifo pipe
"$program" run - <pipe >out 2>err &
job=$!
exec 9>pipe
printf 'surface torus\nreplicate 0.5,1\n' >&9 # a note tells that it runs
for ((i = 0; i < 200; i++)); do
    [[ -s err ]] && break
    sleep 0.05
done
kill -INT "$job"
wait "$job" # the pipe stays open: only the signal can end it
status=$?
exec 9>&-
is 'an interrupt' "$status" 130
has err 'wrinkle: interrupted'
rm -f pipe work.wrinkle
empty 'everything'

# ---- a kill, and what it leaves ----
export WRINKLE_STATE=$folder/state
expect 0 recover
has out 'nothing to recover'
expect 0 recover --json
is 'no journals' "$(cat out)" '[]'
mkfifo pipe
"$program" run - <pipe >out 2>err &
job=$!
exec 9>pipe
printf 'table 64x64\ndab 0.5,0.5\nlayer add moss\nreplicate 0.5,1\nsurface sphere\nreplicate 0.5,1\n' >&9
for ((i = 0; i < 200; i++)); do
    grep -q note err && break
    sleep 0.05
done
kill -KILL "$job"
wait "$job" 2>/dev/null
exec 9>&-
expect 0 recover
has out '(never saved)  '
expect 0 recover --json
has out '"commands":'
expect 1 recover 1
has err 'needs -o'
expect 1 recover 7 -o back.exr
has err 'must be a number of the list'
expect 0 recover 1 -o back.exr
"$program" inspect --do 'table 64x64' --do 'dab 0.5,0.5' --do 'layer add moss' \
    --do 'replicate 0.5,1' --do 'surface sphere' --do 'replicate 0.5,1' --json >want 2>err
"$program" inspect back.exr --json >got 2>err
is 'what a kill left' "$(cat got)" "$(cat want)"
expect 0 recover
has out 'nothing to recover'
rm -rf pipe back.exr want got state

# ---- what is damaged comes back in part, under its name, and nothing of it is removed ----
mkfifo pipe
"$program" run - <pipe >out 2>err &
job=$!
exec 9>pipe
printf '%s\n' 'table 32x32' 'save mine.exr' 'dab 0.2,0.2' 'dab 0.4,0.4' 'dab 0.6,0.6' >&9
for ((i = 0; i < 400; i++)); do
    grep -q ' 9 d ok' state/journals/*.wj 2>/dev/null && break
    sleep 0.05
done
kill -KILL "$job"
wait "$job" 2>/dev/null
exec 9>&-
rm -f pipe
sed -i 's/dab 0.4,0.4/dab 0.4,0.5/' state/journals/*.wj
expect 0 recover
has out "$PWD/mine.exr  1 commands"
has out 'damaged: 2 lines lost, 1 commands behind it'
expect 0 recover --json
has out '"beyond":1,"lost":2,"headless":false,"damaged":true'
expect 1 recover 1 -o part.exr
has err '1 of 2 commands were recovered; the journal was kept'
has err '`wrinkle recover 1 --beyond -o OUT` goes on'
has err "continued from $PWD/mine.exr"
expect 1 recover 1 --beyond -o rest.exr
has err '2 of 2 commands were recovered; the journal was kept'
"$program" inspect mine.exr --do 'dab 0.2,0.2' --json >want 2>err
"$program" inspect part.exr --json >got 2>err
is 'up to the damage' "$(cat got)" "$(cat want)"
"$program" inspect mine.exr --do 'dab 0.2,0.2' --do 'dab 0.6,0.6' --json >want 2>err
"$program" inspect rest.exr --json >got 2>err
is 'with what follows' "$(cat got)" "$(cat want)"
expect 0 recover 1 --script
has out '# 2 lines of the journal are lost here'
mv out shown
expect 0 recover 1 --script -o all.wrinkle
is 'the script' "$(cat all.wrinkle)" "$(cat shown)"
expect 1 recover 1 --in-place -o both.exr
has err 'only one of them'
expect 1 recover 1 --in-place --beyond
is 'saved in place' "$("$program" inspect mine.exr --json 2>err)" "$(cat want)"
expect 1 recover 1 --in-place
has err 'has changed since'
expect 0 recover discard 1
expect 0 recover
has out 'nothing to recover'
rm -rf mine.exr part.exr rest.exr all.wrinkle shown want got state
empty 'a recovery'

# ---- check: pictures of anybody's, good, with a seam, and none at all ----
expect 2 check
expect 2 check --nosuch a.png
expect 1 check --as nosuch a.png
expect 1 check none.png
expect 0 export --do 'table 41x23' --do 'analytic fourier terms=2,1,0.3,17,40' --as normal-y -o good.png
expect 0 export --do 'table 41x23' --do 'analytic poly c=1,0,1' --as height -o 'a "ramp".png'
head -c 300 good.png >cut.png
expect 0 check good.png
"$program" check --json 'a "ramp".png' cut.png good.png >out 2>err
is 'status of check' $? 1
is 'check as JSON' "$(jq -c '[.file, .u.seamless, .v.seamless, .normals.green, .problems, (.error | type)]' out | tr '\n' ' ')" \
    '["a \"ramp\".png",false,true,null,["seam-u"],"null"] ["cut.png",null,null,null,null,"string"] ["good.png",true,true,"down",[],"null"] '
# a document's mesh: a cube under a box projection has a seam at each edge
printf 'v %s\n' '0 0 0' '30 0 0' '30 30 0' '0 30 0' '0 0 30' '30 0 30' '30 30 30' '0 30 30' >cube.obj
printf 'f %s\n' '1 4 3 2' '5 6 7 8' '1 2 6 5' '2 3 7 6' '3 4 8 7' '4 1 5 8' >>cube.obj
printf '%s\n' 'table 8x8' 'surface mesh file=cube.obj projection=box cell=7mm' 'save cube.exr' >cube.wrinkle
expect 0 run cube.wrinkle
expect 0 check cube.exr
has out 'mesh 1   the table runs on across all edges but 12; the longest run of them is 360 long, at '
"$program" check --json cube.exr >out 2>err
is 'a mesh as JSON' "$(jq -c '[.meshes[0].object, .meshes[0].seams, .meshes[0].longest]' out)" '[1,12,360]'
# its UDIM tiles: 1002 has two triangles, 1024 one; and files with the tile's number
printf 'v %s\n' '0 0 0' '1 0 0' '1 1 0' '0 1 0' '2 0 0' '3 0 0' '3 1 0' >tiles.obj
printf 'vt %s\n' '1.1 0.1' '1.9 0.1' '1.9 0.9' '1.1 0.9' '3.1 2.1' '3.9 2.1' '3.9 2.9' >>tiles.obj
printf 'f %s\n' '1/1 2/2 3/3 4/4' '5/5 6/6 7/7' >>tiles.obj
printf '%s\n' 'grid cells=2x2' 'surface mesh file=tiles.obj udim=1002' 'save tiles.exr' >tiles.wrinkle
expect 0 run tiles.wrinkle
expect 0 check tiles.exr
has out '2 of UDIM, with triangles: 1002 (2), 1024 (1); tile 1002 shows the table'
"$program" check --json tiles.exr >out 2>err
is 'tiles as JSON' "$(jq -c '[.meshes[0].tiles["1002"], .meshes[0].tiles["1024"], .meshes[0].tile]' out)" '[2,1,1002]'
expect 0 export tiles.exr --as height -o 'h.<UDIM>.png'
has out 'h.1002.png: 512x512'
expect 0 export tiles.exr --as povray -o . name=t udim=1024
has out 't_hf.1024.png: 512x512'
rm -f tiles.* h.1002.png t_hf.1024.png
# of a script, of a mesh's file with a hole, of a script without a mesh
sed -i '$d' cube.obj
expect 0 check cube.wrinkle
has out 'mesh 1   10 triangles, open; open edges: 4, the first at '
expect 0 check cube.obj
has out 'mesh 1   10 triangles, open; open edges: 4, the first at '
"$program" check --json cube.obj >out 2>err
is "a mesh's file as JSON" "$(jq -c '[.file, .meshes[0].open.count, .meshes[0].doubled, .problems]' out)" \
    '["cube.obj",4,{"count":0,"at":null},[]]'
# a cube's last face once more, a fin, the face turned, a face without area: where a slicer guesses, status 1
printf 'v %s\n' '0 0 0' '3 0 0' '3 3 0' '0 3 0' '0 0 3' '3 0 3' '3 3 3' '0 3 3' '9 9 6' >cube.obj
printf 'f %s\n' '1 4 3' '5 6 7 8' '1 2 6 5' '2 3 7 6' '3 4 8 7' '4 1 5 8' >>cube.obj
for fault in 'f 1 3 2 f 1 3 2:doubled' 'f 1 3 2 f 1 3 9:crowded' 'f 1 2 3:turned' 'f 1 3 2 f 1 3 3:'; do
    { cat cube.obj && sed 's/ f /\nf /' <<<"${fault%:*}"; } >fault.obj
    "$program" check --json fault.obj >out 2>err
    is "status of '$fault'" $? "$([[ $fault == *: ]] && echo 0 || echo 1)"
    is "problems of '$fault'" "$(jq -r '.problems | join(",")' out)" "${fault#*:}"
done
"$program" check fault.obj >out 2>err
has out '; faces without area, left out: 1, the first at '
has out '  good'
rm fault.obj
echo 'table 8x8' >plain.wrinkle
expect 1 check plain.wrinkle
has err 'plain.wrinkle: is a script without a mesh'
# the kind by the file's ending, and arguments in help
expect 2 export cube.wrinkle -o cube.stl
has err 'needs --as KIND, here --as stl'
echo 'export cup.stl' >plain.wrinkle
expect 1 run plain.wrinkle
has err 'did you mean export stl cup.stl?'
expect 0 help projection
has out 'surface mesh' 'projection='
expect 1 help projektion
rm -rf good.png cut.png 'a "ramp".png' cube.obj cube.wrinkle plain.wrinkle cube.exr state
empty 'a check'

if [[ $failures != 0 ]]; then
    printf '%d failures\n' "$failures"
    exit 1
fi
