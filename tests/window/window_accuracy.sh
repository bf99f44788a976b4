#!/usr/bin/env bash
# The Accuracy panel in the window, under an X server of its own: dials and points of the plot become commands,
# two settings are compared, maps lie over the patch, a hard case opens as the document that its lines make; and
# when all is measured nothing works any more.
#   window_accuracy.sh PROGRAM SOURCE-FOLDER HARD-ROWS
set -uo pipefail
program=$1
source=$2
hard_rows=$3
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
printf '%s\n' 'table 64x64' 'grid cells=4x4 width=6' 'surface sphere' 'replicate 4,2' \
    'bump mode=blinn scheme=nearest height=0.1' >small.wrinkle
printf '%s\n' 'width 1280' 'height 800' 'turning 0' 'ants 0' 'range_follows 0' 'tab 5' 'lower 0.42' >config/wrinkle/window.conf

patch=360x500+600+160 # the sphere, without the chips above and the labels below
panel=250x330+1016+140
plot=180x140+1064+265 # four steps of the wheel down
# much A B WHERE WHAT: those pictures differ there; same A B WHERE WHAT: they do not.
much() {
    local changed
    changed=$(differs "$1" "$2" "$3")
    [[ ${changed%.*} -gt 1000 ]] || complain "$4: only $changed pixels differ"
}
same() {
    local changed
    changed=$(differs "$1" "$2" "$3")
    [[ ${changed%.*} -lt 60 ]] || complain "$4: $changed pixels differ"
}
# shows A WHERE: the window shows there what that picture does.
shows() {
    local changed
    shot now
    changed=$(differs "$1" now "$2")
    [[ ${changed%.*} -lt 60 ]]
}
alters() { ! shows "$1" "$2"; }
ticks() { awk '{ print $14 + $15 }' "/proc/$pid/stat"; }
rests() { # no more than a twentieth of one processor in half a second
    local before
    before=$(ticks)
    sleep 0.5
    [[ $(($(ticks) - before)) -le 2 ]]
}
scroll() {
    xdotool mousemove $((X + 1140)) $((Y + 300))
    for ((i = 0; i < $1; i++)); do
        xdotool click "$2"
        rest
    done
    rest
}

start small.wrinkle
scroll 4 5
shot plotted # the window is not at rest before the plot is there
[[ $(convert plotted.ppm -crop $plot -unique-colors -format '%w' info:) -gt 20 ]] ||
    complain "there is no plot of what accuracy costs"
until_true 120 "rest after error and plot were measured" rests

# ---- a click on a point of the plot becomes commands, which undo takes back ----
picked() { [[ $(newest) == bump\ * || $(newest) == dials\ * ]]; }
for x in 1075 1090 1105 1125 1150; do
    for y in 285 300 315 335 355 375; do
        picked || click $x $y
    done
done
picked || complain "no click into the plot became a command: $(newest)"
count=0
while picked && [[ $((count++)) -lt 4 ]]; do
    key ctrl+z # the pointer is over the panel
done
scroll 4 4

# ---- two settings: split, its line, held and flickering ----
home
shot plain
key alt+6
until_true 120 "two pictures side by side" alters plain $patch
rest
shot split
much plain split $patch "two settings are another picture than the preview's"
drag 774 422 -20 0 8
xdotool mousemove $((X + 330)) $((Y + 400))
rest
shot dragged
much split dragged 140x400+624+200 "between the line's old place and its new one"
same split dragged 130x400+800+200 "right of the line nothing changes"
key alt+5
until_true 120 "the picture alone" shows plain $patch
xdotool keydown w
until_true 120 "B while its key is held" alters plain $patch
rest
shot held
xdotool keyup w
until_true 120 "the picture again" shows plain $patch
much plain held $patch "B is another picture"
key alt+7
until_true 120 "B while it flickers" shows held $patch
until_true 120 "A while it flickers" alters held $patch
until_true 120 "B again" shows held $patch
key alt+5
until_true 120 "no flicker any more" shows plain $patch

# ---- maps over the patch, with their scales ----
for look in alt+8 alt+9; do
    key $look
    until_true 120 "the map of $look" alters plain $patch
    rest
    shot map
    much plain map 290x70+545+690 "the scale of $look"
done
key alt+5
until_true 120 "the picture without a map" shows plain $patch

# ---- where effects ran: the picture itself in other colours, with their names, live while it is painted on ----
count() { # pixels of that colour in the newest picture of the window
    shot now
    convert now.ppm -crop $patch +repage -fill black +opaque "$1" -fill white -opaque "$1" -format '%[fx:mean*w*h]' info:
}
has() { [[ $(count "$1" | cut -d . -f 1) -gt "$2" ]]; }
key alt+0
until_true 120 "the bump's colour on the object" has '#00c8ff' 8000
rest
shot map
much plain map 290x70+545+690 "the names of the colours"
key alt+5
until_true 120 "the picture without colours" shows plain $patch

# ---- the tolerance is a command; the inspector follows the pointer ----
shot layers
key F7
rest
xdotool mousemove $((X + 760)) $((Y + 420))
rest
shot inspected
much layers inspected 250x200+1016+530 "the inspector has something to say"
xdotool mousemove $((X + 700)) $((Y + 350))
rest
shot elsewhere
changed=$(differs inspected elsewhere 250x200+1016+530)
[[ ${changed%.*} -gt 200 ]] || complain "the inspector does not follow: $changed pixels differ"
search "pin the inspector"
xdotool mousemove $((X + 780)) $((Y + 480))
rest
shot first
xdotool mousemove $((X + 720)) $((Y + 380))
rest
shot second
same first second 250x180+1016+555 "a pinned inspector stays"

# ---- painting: the error is measured anew, and then all rests ----
home
shot before
drag 250 420 4 0 10
rest
until_true 120 "rest after a stroke" rests
home
shot after
changed=$(differs before after $panel)
[[ ${changed%.*} -gt 20 ]] || complain "after a stroke the error is the same as before: $changed pixels differ"

# ---- a hard case opens as the document of its lines, after a question ----
"$hard_rows" --scene HC01 >case.wrinkle
[[ -s case.wrinkle ]] || complain "HC01 has no scene"
search "hard cases"
xdotool type --delay 30 'HC01'
rest
key Return
rest
key d # the stroke is not saved: discard it
until_true 120 "an untitled document" title_is untitled
home
key F6
answer_file opened.exr ctrl+shift+s
"$program" run - <<<"$(cat case.wrinkle; printf '\nsave lines.exr\n')" >/dev/null || complain "HC01 does not run"
[[ $(hash_of opened.exr) == "$(hash_of lines.exr)" ]] || complain "the opened case is not what its lines make"

xdotool key ctrl+q
ends 0
[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
printf 'ok\n'
