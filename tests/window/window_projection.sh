#!/usr/bin/env bash
# The projection of a mesh in the window: its handle moves, turns and scales the table by one step each, seams are
# found, and a detailed mesh is baked by the dialog.  window_projection.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
# A block of 4 x 2 x 2 mm with its corner at 3,5,7, without (u,v); each line is a side.
printf '%s\n' 'v 3 5 7' 'v 7 5 7' 'v 7 7 7' 'v 3 7 7' 'v 3 5 9' 'v 7 5 9' 'v 7 7 9' 'v 3 7 9' 'f 4 3 2 1' 'f 5 6 7 8' \
    'f 1 2 6 5' 'f 3 4 8 7' 'f 2 3 7 6' 'f 4 1 5 8' >block.obj
printf '%s\n' 'table 64x64' 'fill 0' 'surface mesh file=block.obj projection=box cell=1.5 unit=mm' 'bump height=0.1' \
    'camera orthographic eye=0,0,60 size=10' >block.wrinkle
printf '%s\n' 'width 1200' 'height 800' 'turning 0' 'ants 0' 'hints 0' 'tab 1' >config/wrinkle/window.conf

save_as() { answer_file "$1" ctrl+shift+s; }
# numbers LOW HIGH...: the newest command's numbers lie between these, in their order.
numbers() {
    local line i=0 values
    line=$(newest)
    IFS=, read -ra values <<<"${line##*=}"
    while [[ $# -gt 0 ]]; do
        awk -v x="${values[i]}" -v low="$1" -v high="$2" 'BEGIN { exit !(x >= low && x <= high) }' ||
            complain "number $((i + 1)) of $line is not between $1 and $2"
        shift 2
        i=$((i + 1))
    done
}

start block.wrinkle
search 'projection handle'
# The patch's middle, as in window_objects.sh; the mesh's middle 5,6,8 is there, and a unit is about 68 pixels.
mx=722 my=422
drag $mx $my 3 -2 20
becomes 'surface mesh at=*' "the disc moves the projection"
numbers 5.84 5.93 6.55 6.62 8 8
shot moved

# The ring is 0.6 times the bounding sphere of 2.45, about the new origin. Twice its diameter is half a turn.
mx=$((mx + 60)) my=$((my - 40))
drag $((mx - 100)) $my 5 0 10
becomes 'surface mesh turn=*' "the ring turns it"
numbers 0 0 20 25 0 0
shot turned
[[ $(differs moved turned 300x300+600+270) -gt 500 ]] || complain "the turned axes look as before"

# The square is at the lower right of the ring; twice as far from the middle the cell is twice as large.
drag $((mx + 71)) $((my + 71)) 7 7 10
becomes 'surface mesh cell=*' "the square scales the cell"
numbers 2.9 3.1 2.9 3.1
key ctrl+z
save_as undone.exr
grep -aq 'surface mesh .*cell=1.5.* turn=0,2' undone.exr || complain "one step back is not the cell of before"

# The dialog asks for the file; Enter bakes.
search 'bake a detailed mesh'
click 798 250
xdotool type --delay 20 "$folder/block.obj"
rest
key Return
settle
shot dialog
key Return
becomes 'bake *block.obj map=height samples=2 padding=8*' "the dialog bakes a layer"
save_as baked.exr
"$program" inspect baked.exr --json | jq -e '.layer_list | map(select(.name == "baked")) | length == 1' >/dev/null ||
    complain "no layer is baked"
key ctrl+q
ends 0
exit $((failures > 0))
