#!/usr/bin/env bash
# The Generate panel in the window, under an X server of its own: what is only shown leaves no trace, what is
# applied is the command that the history tells and replays to the same heights; presets are kept.
#   window_generate.sh PROGRAM SOURCE-FOLDER
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
printf 'table 256x256\nbump height=0.1\n' >flat.wrinkle

configure() {
    printf '%s\n' 'width 1200' 'height 800' 'turning 0' 'ants 0' 'tab 0' 'lower 0.42' >config/wrinkle/window.conf
}
newest() { sed -nE 's/^[0-9a-f]+ [0-9]+ [cb] //p' state/wrinkle/journals/*.wj 2>/dev/null | tail -n 1; }
# shellcheck disable=SC2053 # a pattern
newest_is() { [[ $(newest) == $1 ]]; }
becomes() {
    until_true 10 "$2" newest_is "$1" || complain "the newest command is: $(newest)"
}
key() {
    xdotool key "$1"
    sleep 0.15
}
click() {
    xdotool mousemove $((X + $1)) $((Y + $2))
    sleep 0.2
    xdotool click 1
    sleep 0.3
}
# search WORDS: run the action that is found first.
search() {
    key ctrl+Return
    sleep 0.3
    xdotool type --delay 30 "$1"
    sleep 0.3
    key Return
    settle
}
# slide X Y DX: drag slowly, so that no two events come into one picture of the window.
slide() {
    xdotool mousemove $((X + $1)) $((Y + $2))
    sleep 0.2
    xdotool mousedown 1
    for ((i = 0; i < 6; i++)); do
        sleep 0.1
        xdotool mousemove_relative -- "$3" 0
    done
    sleep 0.2
    xdotool mouseup 1
    settle
}
save_as() { answer_file "$1" ctrl+shift+s; }
quit() {
    xdotool key ctrl+q
    sleep 0.5
    is_gone || xdotool key d
    ends 0
}
# same_as A B WHAT: the two pictures of the table are the same.
same_as() {
    local changed
    changed=$(differs "$1" "$2" 400x500+60+150)
    [[ ${changed%.*} -eq 0 ]] || complain "$3: $changed pixels differ"
}
differs_much() {
    local changed
    changed=$(differs "$1" "$2" 400x500+60+150)
    [[ ${changed%.*} -gt 5000 ]] || complain "$3: only $changed pixels differ"
}

# The second slider of the panel, the list of presets, and the glyph that saves one, at this size.
slider_x=1100 slider_y=237 presets_x=1090 presets_y=159 save_x=1145

# ---- found by its name, shown at once; a slider changes what is shown; Escape leaves no trace ----
configure
start flat.wrinkle
home
shot before
search "patterns knurl"
home
shot shown
differs_much before shown "a pattern that is chosen is shown"
slide $slider_x $slider_y 6
home
shot slid
differs_much shown slid "a slider changes what is shown"
[[ -z $(newest) ]] || complain "what is only shown became the command $(newest)"
title_is 'untitled' || complain "what is only shown makes unsaved work"
key Escape
key b
home
shot after
same_as before after "Escape brings back what was there"
save_as untouched.exr
"$program" run - <<<"$(printf 'table 256x256\nbump height=0.1\nsave plain.exr\n')" >/dev/null || complain "no plain.exr"
[[ $(hash_of untouched.exr) == "$(hash_of plain.exr)" ]] || complain "a pattern given up changed the document"

# ---- Enter makes it one command; its replay gives the same heights ----
search "patterns knurl"
key Return
becomes 'pattern knurl *rows=*' "the command of what was shown"
line=$(newest)
home
save_as applied.exr
"$program" run - <<<"$(printf 'table 256x256\nbump height=0.1\n%s\nsave replayed.exr\n' "$line")" >/dev/null ||
    complain "no replay of $line"
[[ $(hash_of applied.exr) == "$(hash_of replayed.exr)" ]] || complain "the replay of $line gives other heights"

# ---- dragged on the table, it moves its origin, round the edges ----
search "patterns hexagons"
drag 270 420 3 2 20
key Return
becomes 'pattern hexagons *origin=0.*,0.*' "a pattern moved by hand"
read -r u v < <(newest | sed -E 's/.*origin=([0-9.]+),([0-9.]+).*/\1 \2/')
# 60 pixels to the right and 40 down: as far in u, but for the zoom, as 3 is to 2, and down is round the edge
awk -v u="$u" -v v="$v" 'BEGIN { d = u / (1 - v) - 1.5; exit !(u > 0.1 && d < 0.05 && d > -0.05) }' ||
    complain "dragged by 60, 40 pixels the origin is at $u,$v"

# ---- a preset of its own: saved, kept, taken again ----
search "patterns dots"
slide $slider_x $slider_y 6
click $save_x $presets_y
xdotool type --delay 30 'many dots'
key Return
until_true 10 "the file of presets" file_is_there config/wrinkle/presets.wrinkle
grep -q '^# many dots$' config/wrinkle/presets.wrinkle || complain "the preset has no name"
line=$(grep '^pattern dots ' config/wrinkle/presets.wrinkle)
[[ $line == *rows=* ]] || complain "the preset's line is: $line"
home
key Escape
quit
start flat.wrinkle
search "patterns dots"
click $presets_x $presets_y
click $presets_x $((presets_y + 58))
home
key Return
becomes "$line" "the preset's own command"
quit

# ---- what cannot be made says why, and changes nothing ----
start flat.wrinkle
search "formulas polynomial"
click $slider_x $((slider_y - 28))
key ctrl+a
xdotool type --delay 30 'nonsense'
home
key Return
sleep 0.5
[[ -z $(newest) ]] || complain "nonsense became the command $(newest)"
key Escape
quit

# ---- text is typed into what is shown ----
if "$program" help text >help 2>/dev/null && grep -q '^  text' help; then
    start flat.wrinkle
    home
    shot before
    key t
    sleep 0.5
    key ctrl+a
    xdotool type --delay 30 'Blinn "78"'
    sleep 1
    shot written
    differs_much before written "letters are shown as they are typed"
    xdotool mousemove $((X + 330)) $((Y + 400))
    key ctrl+Return
    becomes 'text "Blinn *' "the text as a command"
    home
    save_as written.exr
    "$program" run - <<<"$(printf '%s\n' 'table 256x256' 'bump height=0.1' 'text "Blinn \"78\""' 'save said.exr')" >/dev/null ||
        complain "no said.exr"
    [[ $(hash_of written.exr) == "$(hash_of said.exr)" ]] || complain "what was typed is not what the command writes"
    quit
fi

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
printf 'ok\n'
