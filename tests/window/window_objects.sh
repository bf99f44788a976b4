#!/usr/bin/env bash
# Several objects on the patch, under an X server of its own: a click chooses, handles place, the brush reaches the layer
# that the object under it wears.  window_objects.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
printf '%s\n' 'table 256x256' 'layer rename 1 first' 'layer add second' 'object set name=left at=-0.3,0,0 size=0.5 layer=first' \
    'object add right at=0.3,0,0 size=0.5 layer=second' 'surface sphere R=0.5' 'camera orthographic eye=0,0,5 size=2' >two.wrinkle
printf '%s\n' 'width 1200' 'height 800' 'turning 0' 'ants 0' 'range_follows 0' 'radius 9' 'hardness 1' 'strength 0.5' 'tab 0' \
    'lower 0.42' >config/wrinkle/window.conf
save_as() { answer_file "$1" ctrl+shift+s; }

start two.wrinkle
# The patch's middle lies about here at this size of the window; a unit of the scene is about 340 pixels.
mx=722 my=422
click $((mx - 100)) $my
becomes 'layer use 1' "a click on the left one"
click $((mx + 100)) $((my - 30))
becomes 'layer use 2' "a click on the right one"

# The disc in the middle of its ring.
drag $((mx + 104)) $my 3 -2 10
becomes 'object set at=0.*' "the chosen one moved"
read -r x y < <(newest | sed -E 's/.*at=([-0-9.]+),([-0-9.]+),.*/\1 \2/')
awk -v x="$x" -v y="$y" 'BEGIN { exit !(x > 0.34 && x < 0.45 && y > 0.02 && y < 0.12) }' || complain "it went to $x,$y"

# A drag beside all of them goes round.
drag $mx $((my + 250)) 2 0 20
becomes 'camera orthographic eye=*' "the camera goes round"
key ctrl+z
rest

# Painting reaches the layer of the object under the brush.
key a
drag $((mx - 110)) $my 3 1 10
becomes 'stroke *' "a stroke on the left one"
home
save_as painted.exr
"$program" inspect painted.exr --json >painted.json
jq -e '.layer_list | map(select(.name == "first" and .active)) | length == 1' painted.json >/dev/null ||
    complain "the layer of the object under the brush is not active: $(jq -c .layer_list painted.json)"

# The camera's keys on the pad of numbers: six sides, round by steps, kind, fill; the last view comes back.
key a # no longer painting
xdotool mousemove $((X + mx + 60)) $((Y + my - 250))
for side in 'KP_End front' 'ctrl+KP_End back' 'KP_Next right' 'ctrl+KP_Next left' 'KP_Home top' 'ctrl+KP_Home bottom'; do
    key "${side% *}"
    becomes "camera from ${side#* }" "the key of that side, ${side#* }"
done
key KP_End
for step in 'KP_Left -*,0' 'KP_Right [1-9]*,0' 'KP_Up 0,[1-9]*' 'KP_Down 0,-*'; do
    key "${step% *}"
    becomes "camera orbit ${step#* }" "a step round by ${step% *}"
done
key alt+Left
becomes 'view back' "the view before"
key KP_Begin
becomes 'camera perspective' "the other kind of camera"
key KP_End
key Home
becomes 'camera fill *' "the objects fill the picture"

# Shift and a drag move it sideways, eye and target by the same; the middle button takes it round; the wheel comes closer.
spot() { newest | sed -E "s/.* $1=([-0-9.]+),([-0-9.]+),([-0-9.]+).*/\1 \2 \3/"; }
xdotool keydown shift
drag $((mx + 60)) $((my + 250)) -5 3 10
xdotool keyup shift
rest
becomes 'camera perspective eye=* target=*' "a drag with Shift"
read -r ex ey ez < <(spot eye)
read -r tx ty _ < <(spot target)
awk -v ex="$ex" -v ey="$ey" -v tx="$tx" -v ty="$ty" \
    'BEGIN { exit !(tx > 0.02 && ty > 0.01 && (ex - tx) ^ 2 < 1e-4 && (ey - ty) ^ 2 < 1e-4) }' ||
    complain "sideways: the eye is at $ex,$ey, the target at $tx,$ty"
xdotool mousemove $((X + mx + 60)) $((Y + my + 250)) click 4
closer() {
    local z
    read -r _ _ z < <(spot eye)
    awk -v z="$z" -v ez="$ez" 'BEGIN { exit !(z > 0 && z < 0.95 * ez) }'
}
until_true 120 "a turn of the wheel" closer

# The ground by the search, under the objects; their camera still goes round by a drag beside them.
search() {
    key ctrl+Return
    rest
    xdotool type --delay 20 "$1"
    rest
    key Return
}
search ground
becomes 'ground on' "the ground is laid"
search ground
becomes 'ground off' "the ground is taken away"
kill -KILL "$pid"
wait "$pid" 2>/dev/null
rm -f state/wrinkle/journals/*

# The profile's curve in the scene's panel: a point that is dragged is one step.
printf '%s\n' 'surface revolution' 'dials aa=point' 'background none' >vase.wrinkle
printf '%s\n' 'width 1200' 'height 800' 'turning 0' 'ants 0' 'tab 1' 'lower 0.1' >config/wrinkle/window.conf
start vase.wrinkle
# Where its picture has nothing there are squares of two greys, as many of the one as of the other.
shot bare
for grey in '#999999' '#656565'; do
    seen=$(convert bare.ppm -fill black +opaque "$grey" -fill white -opaque "$grey" -format '%[fx:int(mean*w*h)]' info:)
    [[ $seen -gt 20000 ]] || complain "nothing behind the vase: only $seen pixels of $grey"
done
drag 1127 440 -3 1 10
becomes 'surface revolution profile=*' "a point of the profile was dragged"
read -r r < <(newest | sed -E 's/[^;]*;[^;]*;[^;]*;([-0-9.]+),.*/\1/')
awk -v r="$r" 'BEGIN { exit !(r > 0.2 && r < 0.32) }' || complain "the point's r is $r, not about 0.26"
key ctrl+z
becomes 'undo' "the drag is undone"
xdotool key ctrl+q
sleep 0.5
is_gone || xdotool key d # nothing is saved
ends 0
[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
