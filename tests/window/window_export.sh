#!/usr/bin/env bash
# The export sheet under an X server of its own: a set is written by the button, all its files at once; its settings stay
# with the document; live, the files follow a stroke; what cannot be written is told, and ends it; also in a small window
# at scale 2; `--live` on the command line.  window_export.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
mkdir leaves
printf '%s\n' 'table 65x47' 'noise perlin cells=6' 'surface sphere' 'sheet unreal folder=leaves name=tile depth=16' >tile.wrinkle
printf '%s\n' 'width 1200' 'height 860' 'turning 0' 'ants 0' >config/wrinkle/window.conf

wrote() { [[ -s leaves/T_tile_N.png && -s leaves/T_tile_H.png ]]; }
sums() { sha256sum leaves/* | sha256sum; }
differs() { [[ $(sums) != "$1" ]]; }
# The button of the accent's colour, and the box beside it: where they are in a picture of the window.
find_button() {
    shot "$1"
    read -r bx by < <(convert "$1.ppm" -fuzz 4% -fill white -opaque '#3f6fa8' -fill black +opaque white -depth 8 txt:- |
        awk -F '[,: ]+' '/#FFFFFF/ { if ($2 > y) { y = $2; x = $1 } } END { if (y) print x + 20, y - 8 }')
    [[ -n ${by:-} ]] || { complain "no button: $1"; return 1; }
}

start tile.wrinkle
key ctrl+alt+m
settle
find_button sheet || exit 1
click "$bx" "$by"
until_true 120 "a set by the button" wrote
rest
[[ $(identify -format '%wx%h %z ' leaves/T_tile_N.png leaves/T_tile_H.png) == '65x47 16 65x47 16 ' ]] ||
    complain "not what the document's sheet says: $(identify leaves/*)"
# Close, then live from the start.
old=$(sums)
click $((bx + 175)) "$by"
settle
[[ $(sums) == "$old" ]] || complain "live writes what has not changed"
key Escape
settle
xdotool mousemove $((X + 230)) $((Y + 400))
rest
xdotool mousedown 1
rest
for _ in 1 2 3 4 5 6; do xdotool mousemove_relative -- 9 4 && rest; done
xdotool mouseup 1
rest
until_true 120 "files that follow the hand" differs "$old"
rest
"$program" check leaves/T_tile_N.png --as normal >log || complain "$(cat log)"
[[ -z $(find leaves -name '.?*') ]] || complain "something stays: $(ls -A leaves)"
# Where nothing can be written any more it says so, and stops.
old=$(sums)
mkdir gone && mv leaves/* gone && rmdir leaves
xdotool mousedown 1
rest
for _ in 1 2 3 4; do xdotool mousemove_relative -- -7 6 && rest; done
xdotool mouseup 1
rest
settle
mkdir leaves
xdotool mousedown 1
rest
for _ in 1 2 3 4; do xdotool mousemove_relative -- 7 6 && rest; done
xdotool mouseup 1
rest
settle
[[ -z $(ls -A leaves) ]] || complain "live goes on after an error"

# Small and large at once: nothing of the sheet is beyond the window.
xdotool key ctrl+q
rest
xdotool key d
ends 0
printf '%s\n' 'width 1270' 'height 880' 'turning 0' 'ants 0' >config/wrinkle/window.conf
export WRINKLE_SCALE=2
start tile.wrinkle
key ctrl+alt+m
settle
find_button large || exit 1
[[ $by -lt 840 ]] || complain "the button is at $by"
click "$bx" "$by"
until_true 120 "a set from the small window" wrote
key Escape
xdotool key ctrl+q
rest
if ! is_gone; then xdotool key d; fi
ends 0

# --live: the maps of the line's set are there without a dialog, have the document's name, and follow a stroke.
export WRINKLE_SCALE=1
mkdir maps
live_there() { [[ -s maps/tile_displacement.exr ]]; }
live_sum() { sha256sum maps/tile_displacement.exr; }
live_differs() { [[ $(live_sum) != "$1" ]]; }
start tile.wrinkle --live maps --as blender-live
until_true 120 "maps of --live" live_there
rest
[[ $(ls maps) == tile_displacement.exr ]] || complain "--live wrote $(ls maps)"
old=$(live_sum)
xdotool mousemove $((X + 230)) $((Y + 400))
rest
xdotool mousedown 1
rest
for _ in 1 2 3 4 5 6; do xdotool mousemove_relative -- 9 4 && rest; done
xdotool mouseup 1
until_true 120 "maps of --live that follow the hand" live_differs "$old"
xdotool key ctrl+q
rest
if ! is_gone; then xdotool key d; fi
ends 0
for line in 'paint --live maps' 'paint tile.wrinkle --as blender' 'paint tile.wrinkle --live maps --as blendre'; do
    # shellcheck disable=SC2086  # words of a line
    "$program" $line >log 2>&1 && complain "no error: $line"
    grep -q '^wrinkle: ' log || complain "$line: $(cat log)"
done
exit $((failures > 0))
