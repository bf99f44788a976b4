#!/usr/bin/env bash
# Our maps in Blender: a plane and a sphere with the normal map and with the heights of the set `blender`, by Cycles, beside
# our own pictures under the same light from the same place. By hand, where Blender is:
#   tests/manual/maps_blender.sh BUILD [FOLDER-FOR-PICTURES]
# It fails where bumps are dents, green is upside down, or brightness is off by more than is said in each line:
#   normal maps  their 16 bits on the plane; on the sphere half a texel's interpolation besides, and its facets
#   baked        the same of a coarser sphere that is a mesh for both
#   heights      Cycles takes differences of a pixel forwards where we take derivatives: half a pixel's change of slope
set -uo pipefail
here=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/manual/maps_help.sh
source "$here/maps_help.sh"
needs blender
side=256
printf '%s\n' "$cell" >cell.wrinkle
"$program" export cell.wrinkle --as blender -o . >/dev/null || exit 1
cat >look.wrinkle <<'X'
material ambient=0 diffuse=1 specular=0 colour=1,1,1
background plain colour=0,0,0
rotate 0,0,0
dials aa=point
X
plane='surface plane
camera orthographic eye=0,0,3 target=0,0,0 up=0,1,0 size=1'
sphere='surface sphere
camera orthographic eye=5,0,0 target=0,0,0 up=0,0,1 size=2.2
replicate 4,2'
heights='image cell_displacement.exr
bump mode=blinn scheme=catmull height='

# lit NAME LIGHT LINES: our pictures of a scene under the light, and lit along each axis.
lit() {
    printf '%s\n' "$3" | cat - look.wrinkle >"$1.wrinkle"
    local axis
    for axis in "lit $2" 'x 1,0,0' '-x -1,0,0' 'y 0,1,0' '-y 0,-1,0' 'z 0,0,1' '-z 0,0,-1'; do
        "$program" render "$1.wrinkle" --do "light directional to=${axis#* }" --size "${side}x$side" -o "$1_${axis% *}.exr" 2>/dev/null || exit 1
    done
}
on_plane=-0.6,0.5,1 on_sphere=1,-0.5,0.5
lit plane "$on_plane" "${heights}0.02
$plane"
lit flat "$on_plane" "table 1x1
$plane"
lit ball "$on_sphere" "${heights}0.04
$sphere"
lit round "$on_sphere" "table 1x1
$sphere"
lit mapped "$on_sphere" "table 1x1
$sphere
normalmap cell_normal.png frame=mikk"
# A sphere of 256 x 128 quads, and the cell 4 x 2 times round it as one map.
awk 'BEGIN {
    pi = atan2(0, -1); wide = 256; tall = 128
    for (j = 0; j <= tall; j++)
        for (i = 0; i < wide; i++) {
            a = 2 * pi * i / wide; b = pi * j / tall
            p = sprintf("%.9f %.9f %.9f", cos(a) * sin(b), sin(a) * sin(b), -cos(b))
            print "v " p "\nvn " p
        }
    for (j = 0; j <= tall; j++)
        for (i = 0; i <= wide; i++) printf "vt %.9f %.9f\n", i / wide, j / tall
    for (j = 1; j < tall - 1; j++)
        for (i = 0; i < wide; i++) {
            printf "f"
            for (k = 0; k < 4; k++) {
                x = i + (k == 1 || k == 2); y = j + (k > 1); n = y * wide + x % wide + 1
                printf " %d/%d/%d", n, y * (wide + 1) + x + 1, n
            }
            print ""
        }
}' >ball.obj
"$program" export cell.wrinkle --as height repeat=4x2 depth=32 -o round.exr >/dev/null || exit 1
mesh="surface mesh file=ball.obj
${sphere#*$'\n'}"
mesh=${mesh%$'\n'*}
lit mesh "$on_sphere" "image round.exr
bump mode=blinn scheme=catmull height=0.04
$mesh"
lit smooth "$on_sphere" "table 1x1
$mesh"
"$program" export mesh.wrinkle --as normal-baked depth=16 -o baked.png >/dev/null || exit 1
blender -b --factory-startup -P "$here/maps_blender.py" -- $side \
    "plane_normal,plane,normal,cell_normal.png,0,${on_plane//,/:},plane,flat,0.0002,0.00002" \
    "plane_heights,plane,bump,cell_displacement.exr,0.02,${on_plane//,/:},plane,flat,0.12,0.01" \
    "sphere_normal,sphere,normal,cell_normal.png,0,${on_sphere//,/:},mapped,round,0.02,0.002" \
    "mesh_baked,ball,normal,baked.png,0,${on_sphere//,/:},mesh,smooth,0.03,0.003" \
    "sphere_heights,sphere,bump,cell_displacement.exr,0.04,${on_sphere//,/:},ball,round,0.5,0.02" >said 2>&1
grep '^compared' said
[[ $(grep -c '^compared.*: good$' said) == 5 ]] || { grep -v '^Fra:' said | tail -n 20; exit 1; }
[[ -z $pictures ]] && exit
for name in plane flat ball mapped; do "$program" render "$name.wrinkle" --do "light directional to=$([[ $name == plane ]] && echo $on_plane || echo $on_sphere)" --size "${side}x$side" -o "$name.png" 2>/dev/null; done
for name in plane_normal plane_heights sphere_normal sphere_heights; do oiiotool "theirs_$name.exr" --ch R,G,B --colorconvert linear sRGB -o "$name.png"; done
convert \( plane.png mapped.png ball.png +append \) \( plane_normal.png sphere_normal.png sphere_heights.png +append \) -append "$pictures/maps-blender.png"
