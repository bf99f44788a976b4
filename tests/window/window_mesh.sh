#!/usr/bin/env bash
# Painting on the patch of an imported mesh, under an X server of its own: one stroke crosses a seam of (u,v) and
# a straight edge, and what faces away stays.  window_mesh.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
# A cube of six islands in the table, 3 x 2.
awk 'BEGIN {
    split("1 0 0 0 1 0 0 0 1;-1 0 0 0 -1 0 0 0 1;0 1 0 -1 0 0 0 0 1;0 -1 0 1 0 0 0 0 1;0 0 1 1 0 0 0 1 0;0 0 -1 1 0 0 0 -1 0", side, ";")
    for (i = 0; i < 6; i++) {
        split(side[i + 1], c, " ")
        for (k = 0; k < 4; k++) {
            x = k == 1 || k == 2 ? 1 : -1; y = k > 1 ? 1 : -1
            printf "v %g %g %g\nvt %g %g\n", c[1] + x * c[4] + y * c[7], c[2] + x * c[5] + y * c[8], c[3] + x * c[6] + y * c[9], i % 3 / 3 + 0.16 + 0.14 * x, int(i / 3) / 2 + 0.25 + 0.21 * y
        }
        printf "vn %g %g %g\nf", c[1], c[2], c[3]
        for (k = 1; k <= 4; k++) printf " %d/%d/%d", 4 * i + k, 4 * i + k, i + 1
        print ""
    }
}' >cube.obj
printf '%s\n' 'table 600x400' 'surface mesh file=cube.obj' 'bump height=0.3' 'rotate 25,-35,0' >cube.wrinkle
printf '%s\n' 'width 1200' 'height 800' 'turning 0' 'ants 0' 'range_follows 0' 'radius 14' 'hardness 0.5' 'strength 0.4' 'tab 0' \
    >config/wrinkle/window.conf

start cube.wrinkle
# The patch's middle lies about here.
mx=726 my=422
key a
shot before
# A click, and a click with Shift: a straight line from the one to the other, over the upper edge.
click $((mx - 90)) $((my + 110))
xdotool keydown shift
click $((mx - 40)) $((my - 110))
xdotool keyup shift
rest
home
shot line
changed=$(differs before line 380x500+510+200)
[[ ${changed%.*} -gt 3000 ]] || complain "a straight line changed only $changed pixels of the patch"
key ctrl+z
key ctrl+z
# From the front over the edge to the right side, whose islands lie apart.
drag $((mx - 60)) $((my + 20)) 8 0 20
becomes 'sculpt eye=*' "a stroke on the mesh"
home
shot painted
changed=$(differs before painted 380x500+510+200)
[[ ${changed%.*} -gt 3000 ]] || complain "the stroke changed only $changed pixels of the patch"
[[ $(grep -c 'sculpt ' state/wrinkle/journals/*.wj) == 3 ]] || complain "the stroke ended at the seam"
search 'faces turned away'
drag $((mx - 60)) $((my + 60)) 4 0 5
becomes 'sculpt radius=*' "a stroke for all faces"
key ctrl+z
key shift+m
drag $((mx - 60)) $((my + 60)) 4 0 5
becomes 'sculpt *mirror_axes=x *' "a stroke in the mirror"
key ctrl+z
key shift+m
search 'stamp'
click $((mx - 70)) $((my + 40))
becomes 'sculpt points=*,1 *angle=*' "a stamp upright in the view"
key ctrl+z
key b
search 'project layer onto'
becomes 'project 1 eye=*into=new*' "the layer as a slide on the mesh"
home
shot projected
key ctrl+z
answer_file painted.exr ctrl+shift+s
"$program" export painted.exr -o heights.png --as height >/dev/null || complain "the saved file is no document"
# parts of the table that were painted: the front's island above, the right side's below on the left
painted_in() { convert heights.png -crop "$1" +repage -format '%[fx:int(1000*mean)]' info:; }
[[ $(painted_in 200x200+200+0) -gt 3 && $(painted_in 200x200+0+200) -gt 3 ]] || complain "one of the two islands is bare"
[[ $(painted_in 200x200+0+0) == 0 && $(painted_in 200x200+400+0) == 0 ]] || complain "other islands were painted"

exit $((failures > 0))
