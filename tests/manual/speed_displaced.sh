#!/usr/bin/env bash
# How long a displaced sphere takes, beside POV-Ray and Blender's Cycles, one thread and one sample a pixel each: ours, POV-Ray's of
# the same heights as an isosurface and its plain sphere, Cycles' of facets of a pixel (its adaptive subdivision) and of its plain
# sphere. By hand, where ImageMagick is and one of these; real-time priority where that is allowed:
#   tests/manual/speed_displaced.sh BUILD [SIZE [FOLDER-FOR-PICTURES]]
# Times are of the work alone: what we and POV-Ray say that it took, without starting, reading and writing; of Cycles, and of ours once
# more, the processor time of the process less that of one that makes a picture of one pixel. Fails where pictures do not cover the
# same, within 1 %: then they are not of the same thing.
set -uo pipefail
here=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
build=$(cd "$1" && pwd) || exit 1
size=${2:-1024} pictures=${3:-}
[[ -z $pictures ]] || pictures=$(cd "$pictures" && pwd) || exit 1
has() { command -v "$1" >/dev/null; }
has convert || { echo "speed_displaced: there is no convert here"; exit 77; }
has povray || has blender || { echo "speed_displaced: there is neither povray nor blender here"; exit 77; }
first=()
chrt -f 50 true 2>/dev/null && first=(chrt -f 50)
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
program=$build/wrinkle height=0.05
cat >cell.wrinkle <<X
table 512x512
noise gradient cells=6 octaves=3
surface sphere
rotate -90,0,0
replicate 1,1
bump mode=exact scheme=bspline height=$height displaced=on
camera perspective eye=0,0,4 target=0,0,0 up=0,1,0 fov=32
material ambient=0.05 diffuse=0.8 specular=0 colour=1,1,1
background plain colour=0,0,0
dials aa=point
light directional to=-0.5,0.7,0.6
X
"$program" render cell.wrinkle --size "${size}x$size" -o ours.png && "$program" export cell.wrinkle --as height -o h.png >told || exit 1
read -r low high < <(sed -nE 's/.*codes are ([^ ]+) to ([^ ,;]+).*/\1 \2/p' told)
head="#version 3.7; global_settings { assumed_gamma 1.0 } background { color rgb 0 }
camera { perspective location <0,0,4> look_at 0 angle 32 right -x up y }
light_source { <-500,700,600> color rgb 1 parallel point_at 0 }
#declare Look = texture { pigment { color rgb 1 } finish { ambient 0.05 diffuse 0.8 } }"
cat >displaced.pov <<X
$head
#declare F = function { pigment { image_map { png "h.png" gamma 1.0 map_type 1 interpolate 2 } } }
isosurface {
  function { sqrt(x*x+y*y+z*z) - 1 - $height*($low + ($high - $low)*F(x,y,z).gray) }
  contained_by { sphere { 0, 1 + $height*$high + 0.001 } } accuracy 0.001 max_gradient 1.6 texture { Look }
}
X
printf '%s\nsphere { 0, 1 texture { Look } }\n' "$head" >plain.pov

# The shortest of five, seconds.
ours() {
    for _ in 1 2 3 4 5; do
        "${first[@]}" "$program" explain cell.wrinkle --size "${size}x$size" --threads 1 --do "$1" | sed -nE 's/.*shaded, ([0-9.]+) ms.*/\1/p'
    done | sort -g | awk 'NR == 1 { print $1 / 1000 }'
}
theirs() {
    for _ in 1 2 3; do
        "${first[@]}" povray "+I$1.pov" "+O$1.png" "+W$size" "+H$size" +WT1 -A -D 2>&1 | sed -nE 's/.*Trace Time:.*\(([0-9.]+) seconds\).*/\1/p'
    done | sort -g | head -n 1
}
# Processor time of a command, seconds.
taken() {
    local TIMEFORMAT='%U %S'
    { time "${first[@]}" "$@" >/dev/null 2>&1; } 2>&1 | awk '{ print $1 + $2 }'
}
# The shortest of three of NAME with pictures of that many pixels a side, less that of one pixel. NAME: a function of the side.
less_loading() {
    local side
    for side in "$size" 1; do
        for _ in 1 2 3; do "$1" "$side"; done | sort -g | head -n 1
    done | awk '{ t[NR] = $1 } END { print t[1] - t[2] }'
}
our_process() { taken "$program" render cell.wrinkle --size "$1x$1" --threads 1 -o one.png; }
cycles() { taken blender --background --factory-startup --threads 1 --python "$here/speed_blender.py" -- "$1" "$low" "$high" "$2" "cycles$2.png"; }
cycles_displaced() { cycles "$1" "$height"; }
cycles_plain() { cycles "$1" 0; }
tell() { printf '%-44s %s s\n' "$@"; }
tell "Wrinkle, displaced" "$(ours 'bump displaced=on')" "Wrinkle, bump mapped" "$(ours 'bump displaced=off')" "Wrinkle, displaced, as a process" "$(less_loading our_process)"
peers=()
if has povray; then
    tell "POV-Ray, displaced (isosurface)" "$(theirs displaced)" "POV-Ray, plain sphere" "$(theirs plain)"
    peers+=(displaced.png)
fi
if has blender; then
    cycles "$size" "$height" >/dev/null && mv "cycles$height.png" cycles.png
    tell "Cycles, displaced, as a process" "$(less_loading cycles_displaced)" "Cycles, plain sphere, as a process" "$(less_loading cycles_plain)"
    peers+=(cycles.png)
fi
[[ -z $pictures ]] || cp ours.png "${peers[@]}" "$pictures"
cover() { convert "$1" -colorspace gray -threshold 0 -format "%[fx:mean]" info:; }
a=$(cover ours.png)
for peer in "${peers[@]}"; do
    b=$(cover "$peer")
    printf 'covered: %s, %s %s of the picture\n' "$a" "$peer" "$b"
    awk -v a="$a" -v b="$b" 'BEGIN { exit !(a > 0.3 && b > 0.99 * a && b < 1.01 * a) }' || exit 1
done
