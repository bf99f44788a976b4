#!/usr/bin/env bash
# Our heights in POV-Ray: the file of the set `povray` as a bump map and as a height field, beside our own picture under the
# same light from the same place. By hand, where POV-Ray and oiiotool are:
#   tests/maps_povray.sh BUILD [FOLDER-FOR-PICTURES]
# It fails where bumps are dents or brightness is farther off than is said: POV-Ray takes differences between pixels where we
# take derivatives.
set -uo pipefail
build=$(cd "$1" && pwd) || exit 1
pictures=${2:-}
[[ -z $pictures ]] || pictures=$(cd "$pictures" && pwd) || exit 1
for tool in povray oiiotool; do
    command -v $tool >/dev/null || { echo "maps_povray: there is no $tool here"; exit 77; }
done
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
program=$build/wrinkle failures=0
cat >cell.wrinkle <<'X'
table 256x256
text "F" at=0.35,0.62 size=150
dab 0.75,0.3 radius=40 strength=0.8
dab 0.25,0.2 radius=30 strength=-0.8
adjust blur sigma=3
bump mode=blinn scheme=catmull height=0.02
surface plane
rotate 0,0,0
camera orthographic eye=0,0,3 target=0,0,0 up=0,1,0 size=1
material ambient=0 diffuse=1 specular=0 colour=1,1,1
background plain colour=0,0,0
dials aa=point
light directional to=-0.6,0.5,1
X
"$program" render cell.wrinkle --size 256x256 -o ours.exr && "$program" export cell.wrinkle --as povray -o . >told || exit 1
# The range that the codes hold, as the report says it.
read -r low high < <(sed -nE 's/.*codes are ([^ ]+) to ([^ ,;]+).*/\1 \2/p' told)
range=$(awk -v a="$low" -v b="$high" 'BEGIN { print b - a }')
head='#version 3.7;
global_settings { assumed_gamma 1.0 }
background { color rgb 0 }'
look='pigment { color rgb 1 } finish { ambient 0 diffuse 1 }'
cat >bump.pov <<X
$head
camera { orthographic location <0.5, 0.5, -3> right x up y look_at <0.5, 0.5, 0> }
light_source { <-600, 500, -1000> color rgb 1 parallel point_at 0 }
plane { -z, 0 $look
  normal { bump_map { png "cell_hf.png" interpolate 2 bump_size $(awk -v r="$range" 'BEGIN { print 0.02 * r * 256 }') } } }
X
cat >field.pov <<X
$head
camera { orthographic location <0.5, 3, 0.5> sky z right x up y look_at <0.5, 0, 0.5> }
light_source { <-600, 1000, 500> color rgb 1 parallel point_at 0 shadowless }
height_field { png "cell_hf.png" smooth scale <1, $(awk -v r="$range" 'BEGIN { print 0.02 * r }'), 1> $look }
X
# beside NAME MOST RMS
beside() {
    povray "+I$1.pov" "+O$1.exr" +FE +W256 +H256 -D -A +WL0 >said 2>&1 || { tail -n 5 said; exit 1; }
    oiiotool "$1.exr" --ch R,G,B ours.exr --ch R,G,B --diff >difference 2>&1
    awk -v name="$1" -v most="$2" -v least="$3" '/RMS error/ { rms = $4 } /Max error/ { worst = $4 }
        END { good = rms != "" && rms <= least && worst <= most
              printf "compared %s: largest %.2g, rms %.2g (bounds %g, %g): %s\n", name, worst, rms, most, least, good ? "good" : "BAD"
              exit !good }' difference || failures=1
}
beside bump 0.12 0.01
beside field 0.09 0.008
if [[ -n $pictures ]]; then
    for name in ours bump field; do oiiotool $name.exr --ch R,G,B --colorconvert linear sRGB -o $name.png; done
    convert ours.png bump.png field.png +append "$pictures/maps-povray.png"
fi
exit $failures
