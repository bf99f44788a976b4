#!/usr/bin/env bash
# What takes long, in the window: a bar is shown, the window is used as ever, what changes the document waits or is refused;
# Escape gives it up and leaves the document as it was; a wish to quit waits for it.  window_busy.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
printf '%s\n' 'width 1200' 'height 800' 'turning 0' 'ants 0' 'range_follows 0' 'lower 0.42' >config/wrinkle/window.conf
printf 'table 128x128\nbump height=1\ngrid cells=4x4 width=6\nsave small.exr\n' | "$program" run - >/dev/null || exit 1
# Nobody waits for the end of this: hours of work.
{
    printf 'table 4096x4096\nbump height=1\n'
    for ((i = 0; i < 1000; i++)); do printf 'noise perlin cells=64 octaves=12 seed=%d\n' "$i"; done
} >long.wrinkle
was=$(hash_of small.exr)

bar=1200x28+0+772
box=360x120+100+360 # of an opening, in the middle of the canvas
canvas=380x200+60+120
# The bar has a button where the status line of this document has nothing.
shows_bar() {
    shot now
    local changed
    changed=$(differs calm now 60x24+735+774)
    [[ ${changed%.*} -gt 200 ]]
}
shows_box() { alters calm "$box"; }
alters() {
    shot now
    local changed
    changed=$(differs "$1" now "$2")
    [[ ${changed%.*} -gt 2000 ]]
}
# changes SHOT GEOMETRY: some words there are others now.
changes() {
    shot now
    local changed
    changed=$(differs "$1" now "$2")
    [[ ${changed%.*} -gt 60 ]]
}
is_as() {
    shot now
    [[ $(differs "$1" now "$2") == 0 ]]
}
# begin: open what takes long, and wait until the window says that it does.
begin() {
    home
    shot calm
    key ctrl+o
    key ctrl+a
    xdotool type --delay 20 "$folder/long.wrinkle"
    rest
    xdotool key Return # no rest comes of this
    until_true 120 "the progress of the opening" shows_box
}

# ---- the view can be moved meanwhile, the rest is refused, Escape gives it up ----
export PATH=$folder/bin:$PATH
start small.exr
begin
shot working
xdotool mousemove $((X + 330)) $((Y + 250)) click 4 click 4 click 4
until_true 120 "a closer view meanwhile" alters working "$canvas"
shot closer
xdotool key ctrl+shift+n
refused() { alters closer "$box"; }
until_true 120 "that another command is refused" refused
shot refused
xdotool key Escape
rest
title_is small.exr || complain "given up, the title is $(xdotool getwindowname "$window")"
answer_file after.exr ctrl+shift+s
[[ $(hash_of after.exr) == "$was" ]] || complain "what was given up changed the document"
until_true 120 "the title of the copy" title_is after.exr

# ---- it is laid out anew at once when its size changes, and the narrowest has room for Cancel ----
has_size() { [[ $(identify -format '%wx%h' now.ppm) == "$1" ]]; }
# The left end of the bar is at that height: the picture behind it is no bar.
bar_at() {
    shot now
    has_size "$1" && [[ $(convert now.ppm -format "%[hex:p{3,$2}]" info:) == "$colour" ]]
}
shot calm
colour=$(convert calm.ppm -format '%[hex:p{3,797}]' info:)
begin
xdotool windowsize "$window" 640 480
until_true 120 "the bar at the foot of the smaller window" bar_at 640x480 477
xdotool mousemove $((X + 590)) $((Y + 466)) click 1
rest
xdotool windowsize "$window" 1200 800
settle
title_is after.exr || complain "given up by its button, the title is $(xdotool getwindowname "$window")"

# ---- the window lives on ----
drag 180 300 6 4 20
becomes 'stroke *' "a stroke afterwards"
key ctrl+z
until_true 120 "the stroke undone" title_is after.exr

# ---- a picture into a file: the command line's, and nothing is left of one that is given up ----
# ask_dialog WORDS: the action that they find.
ask_dialog() {
    xdotool key ctrl+Return
    settle
    xdotool type --delay 20 "$1"
    home
    key Return
    home
}
ask_dialog 'render a picture'
key Return # "Choose a file..."
home
key Return # picture.png
until_true 120 "the picture" test -f picture.png
rest
"$program" render after.exr -o same.png --size 2048x2048 2>/dev/null
cmp picture.png same.png || complain "the window's picture is another than the command line's"
rm picture.png
ask_dialog 'render a picture'
for y in 349 378; do # width and height
    xdotool mousemove $((X + 650)) $((Y + y)) click 1
    settle
    key ctrl+a
    xdotool type --delay 20 16384
    key Return
done
home
key Return
home
xdotool key Return
halves() { find . -maxdepth 1 -name '.picture.png.*' | wc -l; }
begun() { [[ $(halves) == 1 ]]; }
until_true 120 "the large picture's file" begun
until_true 120 "the bar of what takes long" shows_bar
xdotool key Escape
rest
[[ $(halves) == 0 && ! -e picture.png ]] || complain "of a picture that was given up is left: $(find . -name '*picture*')"

# film LINE: one whose program, here a script, does that.
mkdir bin
film() {
    printf '#!/bin/sh\necho $$ >"%s/film.pid.new" && mv "%s/film.pid.new" "%s/film.pid"\n%s\n' \
        "$folder" "$folder" "$folder" "$1" >"$folder/bin/ffmpeg"
    chmod +x "$folder/bin/ffmpeg"
    rm -f film.pid
    home
    shot calm
    ask_dialog 'save a turntable'
    key Return # "Choose a file..."
    home
    xdotool key Return # turn.mp4
    until_true 120 "the program that makes films" test -f film.pid
    until_true 120 "the bar of what takes long" shows_bar
}
# click_at X Y [BUTTON]
click_at() { xdotool mousemove $((X + $1)) $((Y + $2)) click "${3:-1}"; }

# ---- meanwhile the window is used; what can wait is done when the film's program has failed, which is no Cancel ----
film "while [ ! -e '$folder/go' ]; do sleep 0.05; done; exit 1"
panel=200x220+970+130
shot working
click_at 1085 90 # Scene
until_true 120 "another tab meanwhile" alters working "$panel"
shot tab
click_at 1085 300 5
until_true 120 "its rows scrolled" alters tab "$panel"
shot scrolled
xdotool key F1
until_true 120 "the guide" alters scrolled "$canvas"
xdotool key Escape
until_true 120 "the guide closed, and nothing else" is_as scrolled "$panel"
xdotool key ctrl+Return
until_true 120 "the search" alters scrolled "$canvas"
xdotool type --delay 20 'light colours'
is_light() { grep -q '^theme 1' config/wrinkle/window.conf; }
press_return() { xdotool key Return; sleep 0.2; is_light; }
until_true 120 "another theme, and written" press_return
shot light
xdotool mousemove $((X + 180)) $((Y + 300)) mousedown 1
for ((i = 0; i < 20; i++)); do xdotool mousemove_relative -- 6 4; done
xdotool mouseup 1
until_true 120 "that a stroke waits" changes light 320x28+0+772
shot stroke
click_at 970 611 # the layer's eye
until_true 120 "that two things wait" changes stroke 320x28+0+772
shot eye
xdotool key ctrl+shift+n
until_true 120 "that another command is refused" alters eye "$bar"
touch go
rest
lines() { sed -nE 's/^[0-9a-f]+ [0-9]+ [cb] //p' state/wrinkle/journals/*.wj | tail -n 2 | cut -d ' ' -f 1-3 | tr '\n' ' '; }
are_done() { [[ $(lines) == stroke*'layer set 1 '* ]]; }
until_true 120 "the stroke and the hidden layer, in their order" are_done || complain "the newest lines are: $(lines)"
key ctrl+z
key ctrl+z
until_true 120 "both undone" title_is after.exr

# ---- Cancel ends ffmpeg too, here a script that takes nothing, and nothing is left of the film, nor of what waited ----
film 'exec sleep 100'
shot working
click_at 970 611
until_true 120 "that something waits" changes working 320x28+0+772
xdotool key Escape
rest
is_ended() { [[ ! -d /proc/$(cat film.pid) ]]; }
until_true 120 "the end of that program" is_ended
[[ ! -e turn.mp4 && -z $(find . -maxdepth 1 -name '.turn*') ]] || complain "of a film that was given up is left: $(find . -name '*turn*')"
title_is after.exr || complain "what waited for what was given up is done: $(newest)"

# ---- a wish to quit waits until it is done, or given up ----
begin
shot working
xdotool key ctrl+q
promised() { changes working 320x26+90+358; } # the first line; the time is below
until_true 120 "that it will close" promised
is_gone && complain "quitting did not wait"
xdotool key Escape
ends 0
[[ $(hash_of after.exr) == "$was" ]] || complain "quitting changed the file"

[[ -z ${KEEP:-} ]] || cp ./*.ppm "$KEEP"
[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
