#!/usr/bin/env bash
# A painter's first hours, by hand: fifty tasks in the real window, each checked by what was saved or written, a
# screenshot of each kept.  window_tour.sh PROGRAM SOURCE-FOLDER [PICTURES [WIDTHxHEIGHT [SCALE [THEME [MANAGER]]]]]
#
# PICTURES: a folder that keeps the screenshots, or none. THEME: 0 dark, 1 light, 2 high contrast. MANAGER: a window
# manager such as openbox. Actions are found by the search for them, so that no place on the screen but the table's
# and the patch's matters.
set -uo pipefail
program=$1
source=$2
pictures=${3:-}
size=${4:-1280x800}
scale=${5:-1}
theme=${6:-0}
manager=${7:-}
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

WR_TEST_SCREEN=$size serve
# A window that is mapped while a manager starts may never be told that it is.
is_managed() { xprop -root _NET_SUPPORTING_WM_CHECK 2>/dev/null | grep -q 0x; }
if [[ -n $manager ]]; then
    "$manager" >manager.log 2>&1 &
    server="$server $!"
    until_true 60 "the window manager" is_managed
fi
printf '%s\n' "width ${size%x*}" "height ${size#*x}" "scale $scale" "theme $theme" 'turning 0' 'ants 0' 'radius 20' \
    'strength 0.5' 'mode 0' >config/wrinkle/window.conf
printf 'table 300x200 wrap=periodic\nbump height=0.1\n' >mine.wrinkle
[[ -z $pictures ]] || mkdir -p "$pictures"

# ---- what a painter does ----

# The table lies about the middle of the left half, the patch in the right one: per mille of the window.
place_x() { echo $((WIDTH * $1 / 1000)); }
place_y() { echo $((HEIGHT * $1 / 1000)); }
# stroke X Y TOX TOY, per mille of the window
stroke() {
    local i
    xdotool mousemove $((X + $(place_x "$1"))) $((Y + $(place_y "$2")))
    rest
    xdotool mousedown 1
    for ((i = 1; i <= 12; i++)); do
        xdotool mousemove $((X + $(place_x $(($1 + ($3 - $1) * i / 12))))) $((Y + $(place_y $(($2 + ($4 - $2) * i / 12)))))
    done
    rest
    xdotool mouseup 1
    rest
}
tap() { click "$(place_x "$1")" "$(place_y "$2")"; }

# ---- how a task is checked ----
tasks=0
# task NAME: begins one; the picture of the one before was kept by done_with.
task() {
    name=$1
    tasks=$((tasks + 1))
    failures_before=$failures
}
done_with() {
    settle
    if [[ -n $pictures ]]; then
        import -window "$window" "$pictures/$(printf '%02d' "$tasks")-$name.png"
        printf '%4d s: %s\n' "$SECONDS" "$name"
    fi
    [[ $failures == "$failures_before" ]] || printf 'task %d, %s\n' "$tasks" "$name"
}
saved() { # saved NAME: the document, written by hand
    save_as "$1.exr"
}
ask() { "$program" inspect "$1.exr" --json | jq -r "$2"; }
height() { "$program" inspect "$1.exr" --at "$2,$3" --json | jq -r .F; }
is() { [[ $1 == "$2" ]] || complain "$name: $3 is $1, not $2"; }
# became PATTERN: the newest command is like that.
became() { until_true 120 "$name: a command like '$1'" newest_is "$1" || complain "the newest command is: $(newest)"; }
there() { [[ -s $1 ]]; }
type_path() {
    settle
    key ctrl+a
    xdotool type --delay 15 "$folder/$1"
    rest
    key Return
    until_true 120 "$name: the file $1" there "$1"
}
save() { # save NAME: by hand
    xdotool key ctrl+shift+s
    type_path "$1.exr"
    until_true 120 "$name: the title of $1.exr" title_is "$1.exr"
}
more() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a > b) }'; }

start mine.wrinkle

task 'first stroke'
stroke 150 450 320 520
became 'stroke *radius=20 *strength=0.5 mode=raise points=*'
save first
done_with
more "$(ask first '.layers')" 0 || complain "$name: nothing was saved"

task 'larger brush'
key bracketright
key bracketright
stroke 180 600 300 600
read -r radius < <(newest | sed -E 's/.* radius=([0-9.]+).*/\1/')
more "$radius" 20 || complain "$name: the radius is $radius after ]"
done_with

task 'undo and redo'
before=$(newest)
save larger
xdotool key ctrl+z
rest
save undone
[[ $(hash_of undone.exr) == "$(hash_of first.exr)" ]] || complain "$name: undone is not as it was"
xdotool key ctrl+shift+z
rest
save redone
[[ $(hash_of redone.exr) == "$(hash_of larger.exr)" ]] || complain "$name: redone is not as it was"
done_with

task 'a straight line'
tap 150 350
xdotool keydown shift
tap 330 350
xdotool keyup shift
became 'stroke *points=*'
done_with

task 'a smooth patch'
search 'Smooth'
stroke 180 600 300 600
became '* mode=smooth*'
search 'Brush'
done_with

task 'a height picked, painted to'
xdotool keydown ctrl
tap 240 600
xdotool keyup ctrl
stroke 200 400 300 380
became 'stroke*mode=to to=*'
search "Reset the brush's values"
search 'Swap raise and lower'
search 'Swap raise and lower'
done_with

task 'a mirror'
search 'Symmetry is on'
stroke 170 480 200 560
became 'stroke*mirror*'
search 'Symmetry is on'
done_with

task 'a stamp'
search 'Stamp'
tap 240 500
became 'dab *'
search 'Brush'
done_with

task 'an ellipse, filled'
search 'Ellipse'
stroke 200 440 280 560
became 'shape ellipse*'
search 'Brush'
done_with

task 'a new layer'
save one-layer
search 'New layer'
became 'layer add*'
stroke 160 520 330 430
save two-layers
is "$(ask two-layers .layers)" 2 'the number of layers'
done_with

task 'a layer is hidden and shown'
search 'Layer is shown'
save hidden
is "$(ask hidden '.layer_list[1].visible')" false 'the layer shown'
search 'Layer is shown'
save shown
[[ $(hash_of shown.exr) == "$(hash_of two-layers.exr)" ]] || complain "$name: shown again it is another document"
done_with

task 'a mask, painted on'
search 'Mask that shows all'
search 'Paint on the mask'
stroke 200 500 280 500
search 'Paint on the mask'
save masked
is "$(ask masked '.layer_list[1].mask')" true 'the mask'
done_with

task 'a selection, raised'
search 'Rectangle selection'
stroke 190 430 290 570
became 'select rect*'
search 'Fill...'
settle
key Return
became 'fill*'
done_with

task 'copied, pasted, moved'
search 'Copy'
search 'Paste'
became 'layer paste *'
search 'Free transform'
stroke 240 500 270 540
key Return
became 'transform *'
search 'Select none'
done_with

task 'levels over the histogram'
search 'Levels...'
settle
key Return
became 'adjust levels*'
done_with

task 'letters'
key t
settle
xdotool type --delay 15 'Oak'
key ctrl+Return
became 'text *'
done_with

task 'bricks'
search 'pattern brick'
settle
key Return
became 'pattern brick*'
done_with

task 'noise added'
search 'noise perlin'
settle
key Return
became 'noise *'
done_with

task 'a sphere by the Z-buffer'
search 'solid sphere'
settle
key Return
became 'solid sphere*'
done_with

task 'a layer changed after the fact'
save spheres
search 'Edit filter or generator'
settle
key ctrl+a
done_with
key Return

task 'layers in a group'
search 'Layer below'
search 'Choose all layers'
search 'Group layers'
became 'layer group *'
save grouped
is "$(ask grouped '[.layer_list[] | select(.group)] | length')" 1 'the number of groups'
done_with

task 'a linked copy'
search 'Layer below'
search 'Linked copy'
became 'layer duplicate *linked=on*'
save linked
done_with

task 'a live mask'
search 'Live mask'
settle
key Return
became 'layer mask * live=*'
done_with

task 'two variants'
search 'New variant'
settle
xdotool type --delay 15 'new'
key Return
became 'variant add *'
search 'Layer is shown'
search 'New variant'
settle
xdotool type --delay 15 'worn'
key Return
became 'variant add worn*'
save variants
done_with

task 'a layer becomes heights'
search 'Rasterize layer'
became 'layer rasterize*'
search 'Layer is shown'
done_with

task 'half a cell on'
search 'Offset by half a cell'
became 'adjust offset*'
done_with

task 'painted on the patch'
search 'Paint on the patch'
stroke 600 520 680 560
became 'stroke*'
search 'Paint on the patch'
done_with

task 'the patch turned'
title=$(xdotool getwindowname "$window")
stroke 600 520 680 480
[[ $(xdotool getwindowname "$window") == "$title" ]] || complain "$name: the title becomes $(xdotool getwindowname "$window")"
done_with

task 'a ground, and the camera'
search 'Ground'
became 'ground*'
search 'From the right'
search 'Fill the picture'
done_with

task 'the accuracy page'
search 'Accuracy'
done_with
search 'Brushes' # measurements end with their tab

task 'the guide'
search 'Guide'
settle
done_with
key Escape

task 'the light theme, and back'
shot before
search 'Light colours of the window'
settle
shot after
[[ $theme == 1 || $(differs before after "${WIDTH}x60+0+0") != 0 ]] || complain "$name: nothing changed"
done_with
search "$([[ $theme == 2 ]] && echo 'High contrast' || echo 'Dark colours of the window')"

task 'a picture of the patch'
search 'Render a picture...'
done_with
key Return
type_path picture.png
[[ $(identify -format '%m' picture.png) == PNG ]] || complain "$name: no PNG"

task 'heights for another program'
search 'Export...'
done_with
key Return
type_path out.png

task 'several layers moved together'
search 'Choose all layers'
search 'Free transform'
settle
key Right
key Return
became 'transform *of=*'
done_with

task 'a brush by its name'
search 'Chisel'
stroke 170 380 320 420
became 'stroke *preset=* points=*'
search 'Round brush'
done_with

task 'a seam made seamless'
search 'Make seamless...'
settle
key Return
became 'adjust seamless*'
done_with

task 'two edges matched'
search 'Match edges...'
settle
key Return
became 'adjust match-edges*'
done_with

task 'evened light'
search 'Even out light...'
settle
key Return
became 'adjust even-light*'
done_with

task 'gold'
search 'Gold'
became 'material *gold*'
done_with

task 'raking light'
search 'Raking light'
became 'light preset raking*'
done_with

task 'a mug'
search 'Mug'
became 'camera fill *' # the camera stood nearer than the mug needs
done_with
key ctrl+z # pictures of a mesh close at hand are slow

task 'a row by the search, a number typed'
row 'bump height'
click $((row_end - 40)) "$row_y"
rest
key ctrl+a
xdotool type --delay 15 0.25
key Return
became 'bump *height=0.25*'
done_with

task 'relief on the canvas'
search 'Shaded relief'
shot relief
key alt+1
shot grey
[[ $(differs relief grey "$(place_x 200)x$(place_y 300)+$(place_x 120)+$(place_y 350)") != 0 ]] || complain "$name: the canvas is the same"
done_with

task 'workspaces'
key ctrl+2
settle
shot generating
key ctrl+1
settle
shot painting
[[ $(differs generating painting "$(place_x 200)x$(place_y 600)+$(place_x 790)+$(place_y 150)") != 0 ]] || complain "$name: the panel is the same"
done_with

task 'a macro with its values'
printf 'noise perlin cells=5 amplitude=0.3\n' >macro.wrinkle
search 'Run a macro...'
type_path macro.wrinkle
settle
key Return
became 'macro *macro.wrinkle*'
done_with

task 'a view kept'
search 'Keep this view'
became 'camera save *'
done_with

task 'the cost of accuracy'
key ctrl+Return
xdotool type --delay 30 'Tour: cost of accuracy'
rest
xdotool key Return
sleep 2 # it measures, and so never rests
xdotool key F5
done_with

task 'history as a script'
search 'Save history as script...'
type_path history.wrinkle
save last
"$program" run history.wrinkle --do 'save replayed.exr' || complain "$name: the script does not run"
[[ $(hash_of replayed.exr) == "$(hash_of last.exr)" ]] || complain "$name: replayed it is another document"
done_with

task 'closed, opened again'
xdotool key ctrl+q
ends 0
start last.exr
shot again
save again
[[ $(hash_of again.exr) == "$(hash_of last.exr)" ]] || complain "$name: opened again it is another document"
done_with
xdotool key ctrl+q
ends 0

[[ $failures == 0 ]] || printf '%d tasks, %d complaints\n' "$tasks" "$failures"
exit $((failures > 0))
