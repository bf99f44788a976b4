#!/usr/bin/env bash
# The pictures of the guide: a window on an X server of its own, driven by keys, and its picture taken. Look at each
# before it is kept.
#
#   pictures.sh [--out FOLDER] [PROGRAM]
#
# PROGRAM   wrinkle, where it is not in build/
# --out     where to write (pictures/ beside this script, and samples/screenshot.png)
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source=$here/../.. out=$here/pictures program=$here/../../build/wrinkle
screenshot=$source/samples/screenshot.png
while [[ $# -gt 0 ]]; do
    case $1 in
    --out) out=$2 && screenshot=$2/screenshot.png && shift ;;
    -*) printf 'pictures.sh: unknown option %s\n' "$1" >&2 && exit 2 ;;
    *) program=$1 ;;
    esac
    shift
done
mkdir -p "$out"
out=$(cd "$out" && pwd) program=$(readlink -f "$program") screenshot=$(readlink -m "$screenshot")
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"
serve

# picture FILE GEOMETRY [WIDTH]: a part of the window, made so wide, as small as a file can be.
picture() {
    settle
    sleep 0.5 # a tip or a caret goes
    settle
    shot taken
    convert taken.ppm -crop "$2" +repage ${3:+-resize "$3x"} -strip +dither -depth 8 -colors 200 -define png:compression-level=9 "PNG8:$1"
}
# found NAME: the action of that name, by the search.
found() {
    key ctrl+Return
    xdotool type --delay 20 "$1"
    rest
    key Return
    settle
}
settings() { printf 'width %d\nheight %d\nturning 0\nants 0\nhints 0\n' "$@" >config/wrinkle/window.conf; }
close() {
    xdotool key ctrl+q
    sleep 0.5
    is_gone || xdotool key d # nothing is saved
    ends 0
}

# ---- the window: bricks, and a vine that grows over them ----
settings 1270 880
vine='points=0.24,0;0.22,0.15;0.27,0.3;0.21,0.45;0.25,0.6;0.2,0.78;0.25,0.9;0.24,1'
twigs='points=0.24,0.33;0.34,0.4;0.45,0.39;0.5,0.34'
{
    cat "$source/samples/bricks.wrinkle"
    printf '%s\n' 'layer add vine' "stroke preset=rope radius=12 strength=0.5 $vine" \
        "stroke preset=rope radius=5 strength=0.4 $twigs" 'layer add leaves' \
        "stroke preset=leaves radius=44 strength=0.9 $vine" "stroke preset=leaves radius=30 strength=0.8 $twigs" \
        'save vine.exr'
} | "$program" run - || exit 1
start vine.exr
picture "$screenshot" 1270x880+0+0 1000
close

# ---- brushes, generating, the guide, accuracy ----
settings 1200 760
start "$source/samples/bricks.wrinkle"
key F5
click 1069 160 # stamps
key Down
key Return
picture "$out/brushes.png" 250x700+950+30
found 'Patterns: Scales'
settle
picture "$out/generate.png" 1200x760+0+0 800
key Escape
key F1
picture "$out/guide.png" 1200x760+0+0 800
key Escape
key F6
sleep 20 # what the dials cost is measured while nothing moves
picture "$out/accuracy.png" 250x700+950+30
close

# A filter layer's curve over the histogram, the table as a lit relief.
settings 1200 760
start "$source/samples/bricks.wrinkle"
found 'Lit relief'
found 'filter blur'
key Return
found 'filter curves'
picture "$out/filters.png" 1200x760+0+0 800
key Escape
close

# The coin of the page about live layers.
settings 1200 760
start "$source/samples/coin.wrinkle"
picture "$out/live-layers.png" 1200x760+0+0 800
close

# Maps of a table, beside its heights.
maps=()
while read -r -a words; do
    "$program" export "$source/samples/bricks.wrinkle" --as "${words[@]}" depth=8 -o "map-${words[0]}.png" >/dev/null
    maps+=("map-${words[0]}.png")
done <<'MAPS'
height
occlusion
horizon toward=90 full=2
cavity
curvature full=150
slope
direction
roughness
mask feather=0.2
wear noise=0.8 threshold=0.1
MAPS
montage "${maps[@]}" -resize 128x128 -geometry +2+2 -tile 5x -background '#2b2b2b' -strip +dither -depth 8 -colors 64 \
    -define png:compression-level=9 "PNG8:$out/maps.png"
[[ $failures == 0 ]]
