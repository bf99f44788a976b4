#!/usr/bin/env bash
# A material, and pictures on the object, chosen in the scene's tab under an X server of its own: a normal map is found, read, changed and taken
# off; a colour picture likewise.  window_maps.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
"$program" export --do 'table 64x64' --do 'noise perlin cells=6' --do 'bump height=0.3' --as normal-y -o n.png >log || complain "$(cat log)"
printf '%s\n' 'table 64x64' 'surface sphere' 'camera orthographic eye=0,0,5 size=2.2' >plain.wrinkle
printf '%s\n' 'width 1200' 'height 860' 'turning 0' 'ants 0' 'tab 1' 'lower 0' 'fold +Scene/PICTURES' >config/wrinkle/window.conf
for section in OBJECTS SURFACE BUMP RELIEF LIGHT ENVIRONMENT; do
    echo "fold -Scene/$section" >>config/wrinkle/window.conf
done

# choose FILE Y: by the folder in that row.
choose() {
    shot unasked
    xdotool mousemove $((X + 1177)) $((Y + $2)) click 1
    until_true 120 "the question for a file" shows_dialog || return
    rest
    key ctrl+a
    xdotool type --delay 20 "$folder/$1"
    rest
    xdotool key Return
    rest
}

start plain.wrinkle
patch=400x400+526+200
xdotool mousemove $((X + 1000)) $((Y + 300))
rest
# The pictures of materials, three in a row: gold is the second of the fourth row. Then the heading folds them.
click 1070 562
becomes 'material preset=gold' "a material that was chosen by its picture"
key ctrl+z
rest
click 1005 281
rest
xdotool mousemove $((X + 1000)) $((Y + 300))
rest
shot before
# The folders of the two rows: eleven bright pixels above one another, where no other row has as many or as few.
read -r colours normals < <(convert before.ppm -crop 1x860+1177+0 +repage -colorspace gray -depth 8 txt:- |
    awk -F '[,: ()]+' 'NR > 1 { if ($4 > 100) run++; else { if (run >= 10 && run <= 13) printf "%d ", $2 - 6; run = 0 } } END { print "" }')
[[ -n ${normals:-} ]] || { complain "the rows of pictures are not seen"; exit 1; }
choose n.png "$normals"
becomes 'normalmap *n.png sha256=*' "a normal map that was chosen"
home
shot bumped
[[ $(compare -metric AE -extract $patch before.ppm bumped.ppm null: 2>&1 | cut -d' ' -f1) -gt 20000 ]] ||
    complain "the normal map does not show"

# Its rows: space, green, frame, relief over it, strength, repeat. A click on a number types it.
click 1100 $((normals + 150))
xdotool type --delay 20 0.5
rest
xdotool key Return
rest
becomes 'normalmap strength=0.5' "half its strength"

# Green: the list opens, and its first row is up.
click 1100 $((normals + 62))
xdotool key Up
rest
xdotool key Return
rest
becomes 'normalmap green=up' "green up"

# Its space, without the file.
mv n.png gone.png
click 1100 $((normals + 33))
xdotool key Down
rest
xdotool key Return
rest
becomes 'normalmap space=object' "along the object's axes"
key ctrl+z
rest
mv gone.png n.png

click 1177 "$normals"
becomes 'normalmap off' "the normal map taken off"
home
shot after
[[ $(compare -metric AE -extract $patch before.ppm after.ppm null: 2>&1 | cut -d' ' -f1) -lt 200 ]] ||
    complain "the picture without it is another"

choose n.png "$colours"
becomes 'colour *n.png sha256=*' "a colour picture that was chosen"
key ctrl+z
rest

# Surroundings behind the patch, turned by Shift and the right button: what the gold mirrors turns with them.
kill -KILL "$pid"
wait "$pid" 2>/dev/null
rm -rf state/wrinkle/journals/*
printf '%s\n' 'surface sphere' 'material preset=gold' 'environment sky' 'background surroundings' 'tone soft exposure=-1' >sky.wrinkle
start sky.wrinkle
home
shot level
xdotool mousemove $((X + 620)) $((Y + 300))
xdotool keydown shift mousedown 3
for _ in 1 2 3 4 5 6; do xdotool mousemove_relative -- 10 0; done
xdotool mouseup 3 keyup shift
becomes 'environment turn=[1-9]*' "the surroundings were turned"
home
shot turned
[[ $(compare -metric AE -extract $patch level.ppm turned.ppm null: 2>&1 | cut -d' ' -f1) -gt 1000 ]] ||
    complain "what the patch mirrors did not turn"

kill -KILL "$pid"
wait "$pid" 2>/dev/null
pid=''
[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
