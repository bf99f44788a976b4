#!/usr/bin/env bash
# The scene's tab under an X server of its own: a terrain's numbers and its layer, how patches lie in the table, views that are
# kept, used and forgotten, the background, where the ground ends.  window_stage.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
cp "$source/samples/cube.bpt" .
printf '%s\n' 'width 1200' 'height 860' 'turning 0' 'ants 0' 'tab 1' 'lower 0' 'fold +Scene/CAMERA' 'fold +Scene/BACKGROUND' \
    'fold +Scene/EXPOSURE' 'fold +Scene/REAL SIZE OF THE CELL' >config/wrinkle/window.conf
for section in OBJECTS BUMP MATERIAL RELIEF LIGHT SURROUNDINGS; do
    echo "fold -Scene/$section" >>config/wrinkle/window.conf
done
# pick X Y ROW: open a list, and the row of it.
pick() {
    click "$1" "$2"
    rest
    click "$1" $(($2 + 6 + 25 * $3))
    rest
}
closed() {
    kill -KILL "$pid"
    wait "$pid" 2>/dev/null
    rm -rf state/wrinkle/journals
}

# ---- a terrain: how high white is, and the layer that it has its form of ----
printf '%s\n' 'table 96x96' 'layer add form' 'noise perlin cells=4' 'surface terrain layer=form cells=9' \
    'camera orthographic eye=0,0,5 size=2' 'dials aa=point' >hills.wrinkle
start hills.wrinkle
click 1110 369
xdotool type --delay 20 0.375
rest
xdotool key Return
rest
becomes 'surface terrain * height=0.375 cells=9 layer=form' "another height of the ground"
pick 1110 489 2
becomes 'surface terrain * height=0.375 cells=9 layer=1' "the ground of another layer"

# ---- a view is kept, used again and forgotten; the background; near the panel's end ----
row "kept views"
click 1050 $((row_y + 30))
becomes 'camera save "view 1"' "a view that is kept"
xdotool mousemove $((X + 760)) $((Y + 700))
key KP_Next
becomes 'camera from right' "another view"
row "kept views"
click 1000 $((row_y + 62))
becomes 'camera use "view 1"' "the view that was kept"
row "kept views"
xdotool mousemove $((X + row_end - 9)) $((Y + row_y + 62))
rest # with the icon's tip, which lies over a row
xdotool click 1
becomes 'camera forget "view 1"' "the view forgotten"
row "kept views"
pick 1110 $((row_y + 85)) 2
becomes 'background gradient' "a gradient behind"
pick 1110 $((row_y + 85)) 3
becomes 'background none' "nothing behind"
closed

# ---- patches: which part of the table each has ----
printf '%s\n' 'table 96x96' 'surface patches file=cube.bpt' 'dials aa=point' >patches.wrinkle
start patches.wrinkle
pick 1110 313 4
becomes 'surface patches *table=own' "a cell for each patch"
closed

# ---- the ground is a plane to the horizon, and one that ends ----
printf '%s\n' 'table 96x96' 'surface plane endless=1' 'dials aa=point' >plane.wrinkle
start plane.wrinkle
pick 1110 339 1
becomes 'surface plane a=1 b=1 endless=0' "a plane that ends"
xdotool key ctrl+q
sleep 0.5
is_gone || xdotool key d # nothing is saved
ends 0
[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
