#!/usr/bin/env bash
# Brushes and tools in the window, under an X server of its own: what the hand does becomes the command that
# it should, and the saved heights are those that the command means.  window_tools.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window_help.sh
source "$source/tests/window_help.sh"

for tool in Xvfb xdotool import compare convert jq; do
    command -v "$tool" >/dev/null && continue
    printf '%s is missing: apt-get install xvfb xdotool imagemagick jq\n' "$tool"
    exit 1
done

# ---- the server, on whatever display is free ----
mkfifo "$folder/display"
Xvfb -displayfd 3 -screen 0 1280x900x24 -nolisten tcp 3>"$folder/display" >"$folder/server.log" 2>&1 &
server=$!
read -r -t 30 number <"$folder/display" || { cat "$folder/server.log"; exit 1; }
export DISPLAY=:$number
quiet_environment
export XDG_DATA_HOME=$folder/data
mkdir -p "$folder/config/wrinkle"
cd "$folder" || exit 1
printf 'table 512x512\nbump height=1\n' >flat.wrinkle

# configure LINE...: what the window remembers from the last time.
configure() {
    printf '%s\n' 'width 1200' 'height 800' 'turning 0' 'ants 0' 'radius 16' 'hardness 1' 'strength 0.5' 'tab 0' \
        'lower 0.42' "$@" >config/wrinkle/window.conf
}

# The newest command that the journal holds, a stroke by its beginning.
newest() { sed -nE 's/^[0-9a-f]+ [0-9]+ [cb] //p' state/wrinkle/journals/*.wj 2>/dev/null | tail -n 1; }
# shellcheck disable=SC2053 # a pattern
newest_is() { [[ $(newest) == $1 ]]; }
# becomes PATTERN WHAT: the newest command comes to look like that.
becomes() {
    until_true 10 "$2" newest_is "$1" || complain "the newest command is: $(newest)"
}
key() {
    xdotool key "$1"
    sleep 0.15
}
press() { xdotool mousemove $((X + $1)) $((Y + $2)) mousedown 1; }
click() {
    xdotool mousemove $((X + $1)) $((Y + $2))
    sleep 0.2
    xdotool click 1
    sleep 0.2
}
# height FILE U V: of the saved table.
height() { "$program" inspect "$1" --at "$2,$3" --json | jq -r .F; }
# near A B: the same to 1e-4.
near() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a - b < 1e-4 && b - a < 1e-4) }'; }
save_as() { answer_file "$1" ctrl+shift+s; }

# The cell's middle lies about here at this size of the window.
cx=270 cy=420

# ---- an area is filled by a click: all of a level table is one ----
configure 'mode 0'
start flat.wrinkle
key g
click $cx $cy
becomes 'flood *mode=raise*' "a fill by a click"
home
save_as filled.exr
for at in '0.1 0.1' '0.9 0.4'; do
    # shellcheck disable=SC2086
    near "$(height filled.exr $at)" 0.5 || complain "filled with 0.5, the height at $at is $(height filled.exr $at)"
done

# ---- an ellipse's outline is painted: its rim is raised, its middle is not ----
key q
press $((cx - 60)) $((cy - 60))
xdotool mousemove $((X + cx)) $((Y + cy))
sleep 0.1
xdotool mousemove $((X + cx + 60)) $((Y + cy + 60))
sleep 0.2
xdotool mouseup 1
becomes 'shape ellipse middle=*radii=*paint=outline*' "an ellipse by a drag"
read -r u v rim < <(newest | sed -E 's/.*middle=([0-9.]+),([0-9.]+) radii=([0-9.]+),.*/\1 \2 \3/')
home
save_as ellipse.exr
near "$(height ellipse.exr "$u" "$v")" 0.5 || complain "an outline changes the ellipse's middle"
at=$(awk -v u="$u" -v r="$rim" 'BEGIN { print u + r }')
near "$(height ellipse.exr "$at" "$v")" 1 || complain "on the ellipse the height is $(height ellipse.exr "$at" "$v")"

# ---- a ramp by a drag; Escape gives a shape up ----
key shift+g
drag $((cx - 80)) $cy 4 0 40
becomes 'ramp linear from=*low=0 high=1' "a ramp by a drag"
key r
press $((cx - 40)) $cy
xdotool mousemove $((X + cx + 40)) $((Y + cy + 40))
sleep 0.1
key Escape
xdotool mouseup 1
sleep 0.2
becomes 'ramp linear*' "no rectangle after Escape"

# ---- a polygon by clicks, ended by Enter ----
key shift+q
for at in '-70 0' '0 -80' '70 10'; do
    # shellcheck disable=SC2086
    set -- $at
    click $((cx + $1)) $((cy + $2))
    sleep 0.4
done
key Return
becomes 'shape polygon points=*,*;*,*;*,* paint=outline*' "a polygon by clicks"

# ---- a Bezier path: a drag pulls its arms ----
key n
drag $((cx - 60)) $((cy + 50)) 4 -4 8
sleep 0.5
drag $((cx + 60)) $((cy + 50)) 4 4 8
sleep 0.5
key Return
becomes 'shape path points=*;*;*;* paint=outline*' "a path by drags"
key b
xdotool key ctrl+q
settle
xdotool key d
ends 0

# ---- a stamp shows itself under the pointer, on a snapshot, and its drag turns and sizes it ----
configure 'mode 0'
start flat.wrinkle
shot before
key shift+s
xdotool mousemove $((X + cx)) $((Y + cy))
settle
shot ghost
changed=$(differs before ghost 500x500+480+150)
[[ ${changed%.*} -gt 50 ]] || complain "the patch shows a stamp before it is put by only $changed pixels"
title_is 'untitled' || complain "a stamp that is only shown makes unsaved work"
press $cx $cy
for i in 8 16 24 32 40; do xdotool mousemove $((X + cx)) $((Y + cy + i)); done
sleep 0.2
xdotool mouseup 1
becomes 'dab *radius=* angle=-90*' "a stamp, turned by its drag"
read -r u v < <(newest | sed -E 's/dab ([0-9.]+),([0-9.]+) .*/\1 \2/')
home
save_as stamped.exr
near "$(height stamped.exr "$u" "$v")" 0.5 || complain "the stamp's middle is at $(height stamped.exr "$u" "$v")"

# ---- E erases with the same brush, and goes back ----
key b
key e
drag $((cx - 50)) $((cy - 60)) 5 0 20
becomes 'stroke *mode=erase*' "a stroke that erases"
key e
drag $((cx - 50)) $((cy - 60)) 5 0 20
becomes 'stroke *mode=raise*' "a stroke that raises again"

# ---- smoothing has a tool of its own, which leaves the brush its mode ----
key shift+u
drag $((cx - 50)) $((cy - 60)) 5 0 20
becomes 'stroke *mode=smooth*' "a stroke that smooths"
key b
drag $((cx - 50)) $((cy - 60)) 5 0 20
becomes 'stroke *mode=raise*' "the brush as it was"

# ---- cloning: Ctrl and a click first says from where ----
key c
xdotool mousemove $((X + cx - 60)) $((Y + cy))
sleep 0.1
xdotool keydown ctrl click 1 keyup ctrl
sleep 0.2
drag $((cx + 20)) $cy 4 0 10
becomes 'stroke *mode=clone*source=-*,*' "a stroke that clones"
xdotool key ctrl+q
settle
xdotool key d
ends 0

# ---- symmetry: what is painted at the left is painted at the right ----
configure 'mode 0'
start flat.wrinkle
key u
drag $((cx - 60)) $((cy - 90)) 1 2 20
becomes 'stroke *mirror=u*' "a stroke with a mirror"
read -r u v < <(sed -nE 's/^[0-9a-f]+ [0-9]+ s ([0-9.]+),([0-9.]+).*/\1 \2/p' state/wrinkle/journals/*.wj | head -n 1)
home
save_as mirrored.exr
other=$(awk -v u="$u" 'BEGIN { print 1 - u }')
left=$(height mirrored.exr "$u" "$v") right=$(height mirrored.exr "$other" "$v")
near "$left" 0.5 || complain "the height at the stroke is $left"
near "$left" "$right" || complain "at the left the height is $left, at the right $right"
key u

# ---- a preset is found by its name, chosen by a click, and named in the stroke ----
click 1000 157
xdotool type --delay 30 rivet
sleep 1
click 987 223
xdotool mousemove $((X + cx)) $((Y + cy))
sleep 0.3
drag $((cx - 80)) $((cy + 30)) 5 0 30
becomes 'stroke *preset=*rivet*' "a stroke with a preset that was searched for"
# ... and / goes back to the brush before.
key slash
drag $((cx - 80)) $((cy - 30)) 5 0 10
until_true 10 "a stroke of the brush before" eval '! newest_is "*preset=*"'
xdotool key ctrl+q
settle
xdotool key d
ends 0

# ---- the sculptors' keys: Ctrl turns the brush round, Shift smooths ----
configure 'mode 0' 'key_map 1'
start flat.wrinkle
xdotool keydown ctrl
drag $((cx - 80)) $cy 4 0 20
xdotool keyup ctrl
becomes 'stroke *mode=lower*' "a stroke with Ctrl, for sculptors"
xdotool keydown shift
drag $((cx - 80)) $cy 4 0 20
xdotool keyup shift
becomes 'stroke *mode=smooth*' "a stroke with Shift, for sculptors"
xdotool key ctrl+q
settle
xdotool key d
ends 0

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
