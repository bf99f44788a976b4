#!/usr/bin/env bash
# Our heights in POV-Ray: the file of the set `povray` as a bump map and as a height field, beside our own picture under the
# same light from the same place. By hand, where POV-Ray and oiiotool are:
#   tests/manual/maps_povray.sh BUILD [FOLDER-FOR-PICTURES]
# It fails where bumps are dents or brightness is farther off than is said: POV-Ray takes differences between pixels where we
# take derivatives.
set -uo pipefail
here=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/manual/maps_help.sh
source "$here/maps_help.sh"
needs povray oiiotool
failures=0
printf '%s\n' "$cell" 'surface plane' 'rotate 0,0,0' 'camera orthographic eye=0,0,3 target=0,0,0 up=0,1,0 size=1' \
    'material ambient=0 diffuse=1 specular=0 colour=1,1,1' 'background plain colour=0,0,0' 'dials aa=point' \
    'light directional to=-0.6,0.5,1' >cell.wrinkle
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
# beside NAME MAX_MOST RMS
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
