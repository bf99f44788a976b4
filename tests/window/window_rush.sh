#!/usr/bin/env bash
# Input that comes faster than pictures, on a machine under load: order is kept, and nothing is lost. The same strokes, keys and
# typed numbers are played with a rest after each, and then all at once beside busy processes: both leave the same document
# and the same commands.  window_rush.sh PROGRAM SOURCE-FOLDER [BUSY-PROCESSES]
set -uo pipefail
program=$1
source=$2
busy=${3:-16}
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
printf 'table 300x200 wrap=periodic\nbump height=0.1\n' >mine.wrinkle

# open: the window with the same settings.
open() {
    printf '%s\n' 'width 1200' 'height 800' 'turning 0' 'ants 0' 'radius 20' 'strength 0.5' 'mode 0' >config/wrinkle/window.conf
    start mine.wrinkle
}
# pause: a rest, where the player is patient.
pause() { [[ $patient == no ]] || rest; }
press() {
    xdotool key "$1"
    pause
}
# stroke X Y DX DY: five steps.
stroke() {
    xdotool mousemove $((X + $1)) $((Y + $2)) mousedown 1
    for _ in 1 2 3 4 5; do
        xdotool mousemove_relative -- "$3" "$4"
        pause
    done
    xdotool mouseup 1
    pause
}

play() {
    local i
    for i in 0 1 2 3 4 5 6 7; do
        stroke $((120 + 23 * i)) $((330 + 17 * (i % 5))) $((5 + i)) $((7 - 2 * i))
        press bracketright
        case $i in
        1) press ctrl+z ;;
        2) press Insert ;; # a new layer
        3) press ctrl+z && press ctrl+z && press ctrl+shift+z && press ctrl+shift+z ;;
        4) press x ;; # lowers from here
        5) press Next ;; # the layer below
        6) press ctrl+j ;; # a copy
        esac
    done
    press ctrl+shift+h
    stroke 200 420 9 -4
    press ctrl+z
    stroke 140 360 11 6
}

# The journal has each command, an undo as well. NAME.exr is the document, saved by hand.
finish() {
    rest
    sed -nE 's/^[0-9a-f]+ [0-9]+ ([a-z]) /\1 /p' state/wrinkle/journals/*.wj >"$1.commands"
    key ctrl+shift+s
    settle
    key ctrl+a
    xdotool type --delay 20 "$folder/$1.exr"
    rest
    key Return
    until_true 120 "the file $1.exr" file_is_there "$1.exr"
    until_true 120 "the title of $1.exr" title_is "$1.exr"
    kill -KILL "$pid"
    wait "$pid" 2>/dev/null
    rm -rf state/wrinkle/journals
}

patient=yes
open
play
finish calm

loads=()
for ((i = 0; i < busy; i++)); do
    (while :; do :; done) &
    loads+=($!)
done
server="$server ${loads[*]-}" # they end with it
patient=no
open
play
[[ ${#loads[@]} == 0 ]] || kill -TERM "${loads[@]}"
finish rushed

[[ $(grep -c ' stroke' calm.commands) -ge 10 ]] || complain "$(grep -c ' stroke' calm.commands) strokes were played, not ten"
cmp calm.commands rushed.commands || { complain "the rush left other commands"; diff calm.commands rushed.commands; }
[[ $(hash_of calm.exr) == "$(hash_of rushed.exr)" ]] || complain "the rush left another document"
exit $((failures > 0))
