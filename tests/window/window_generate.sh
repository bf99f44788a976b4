#!/usr/bin/env bash
# The Generate panel in the window, under an X server of its own: what is only shown leaves no trace, what is
# applied is the command that the history tells and replays to the same heights; presets are kept.
#   window_generate.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
printf 'table 256x256\nbump height=0.1\n' >flat.wrinkle

configure() {
    printf '%s\n' 'width 1200' 'height 800' 'turning 0' 'ants 0' 'range_follows 0' 'tab 0' 'lower 0.42' >config/wrinkle/window.conf
}
# slide X Y DX: drag slowly, so that no two events come into one picture of the window.
slide() {
    xdotool mousemove $((X + $1)) $((Y + $2))
    rest
    xdotool mousedown 1
    for ((i = 0; i < 6; i++)); do
        rest
        xdotool mousemove_relative -- "$3" 0
    done
    rest
    xdotool mouseup 1
    rest
}
save_as() { answer_file "$1" ctrl+shift+s; }
quit() {
    xdotool key ctrl+q
    rest
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

# The second slider of the panel, the list of presets, the glyph that saves one, and that which shows pictures
# of all generators, at this size.
slider_x=1100 slider_y=269 presets_x=1090 presets_y=193 save_x=1145 gallery_x=1175 gallery_y=160

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
"$program" run - <<<"$(printf 'table 256x256\nbump height=0.1\nlayer add Knurling from="%s"\nsave replayed.exr\n' "$line")" >/dev/null ||
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

quit

# ---- handles: one thing is moved by itself, sized by its corner, turned by its ring ----
# The cell's middle and a texel's size, pixels, by its outline as it is drawn.
read -r wide high left top < <(convert before.ppm -crop 440x700+48+72 +repage -fill black +opaque '#e8a25c' \
    -format '%@' info: | tr 'x+' '  ')
cx=$((48 + left + wide / 2)) cy=$((72 + top + high / 2))
corner=$(awk -v w="$wide" 'BEGIN { r = 32 * w / 256; if (r < 26) r = 26; print int(r * 0.7071 + 0.5) }')
ring=$(awk -v w="$wide" 'BEGIN { r = 32 * w / 256; if (r < 26) r = 26; print int(r + 22.5) }')
# pull X Y X2 Y2: from the cell's middle to there, by way of the middle between the two.
pull() {
    xdotool mousemove $((X + cx + $1)) $((Y + cy + $2))
    rest
    xdotool mousedown 1
    rest
    xdotool mousemove $((X + cx + ($1 + $3) / 2)) $((Y + cy + ($2 + $4) / 2))
    rest
    xdotool mousemove $((X + cx + $3)) $((Y + cy + $4))
    rest
    xdotool mouseup 1
    rest
}
start flat.wrinkle
search "solids sphere"
pull "$ring" 0 0 "-$ring"
pull "$corner" "$corner" $((corner * 3 / 2)) $((corner * 3 / 2))
pull 0 0 40 -60
home
shot ghost
differs_much before ghost "a solid is seen while it is posed"
[[ -z $(newest) ]] || complain "a pose became the command $(newest)"
key Return
becomes 'solid sphere radius=* at=*,* rotate=0,0,*' "a solid posed by hand"
newest | sed -E 's/.*radius=([0-9.]+) at=([0-9.]+),([0-9.]+) rotate=0,0,([0-9.-]+).*/\1 \2 \3 \4/' |
    awk -v w="$wide" -v h="$high" 'function off(a, b) { return a > b ? a - b : b - a }
        { exit !(off($1, 48) < 2 && off($2, 0.5 + 40 / w) < 0.01 && off($3, 0.5 + 60 / h) < 0.01 && off($4, 90) < 3) }' ||
    complain "made half as large again, turned by 90 degrees and moved by 40, -60 of $wide x $high pixels it is $(newest)"

# ---- pictures of all of them, to choose by words ----
search "patterns dots"
click $gallery_x $gallery_y
rest
xdotool type --delay 30 'basket'
key Return
rest
home
key Return
becomes 'pattern weave*' "what was chosen among the pictures"

# ---- a preset of its own: saved, kept, taken again ----
search "patterns dots"
slide $slider_x $slider_y 6
click $save_x $presets_y
rest
xdotool type --delay 30 'many dots'
key Return
until_true 120 "the file of presets" file_is_there config/wrinkle/presets.wrinkle
grep -q '^# many dots$' config/wrinkle/presets.wrinkle ||
    complain "the preset has another name: $(cat config/wrinkle/presets.wrinkle)"
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

# ---- what cannot be made says why, and changes nothing; what was shown before it goes ----
start flat.wrinkle
home
shot before
search "patterns knurl"
search "pictures photo"
home
shot missing
changed=$(differs before missing 400x500+60+150) # the brush's outline at the pointer
[[ ${changed%.*} -lt 1000 ]] || complain "without its file what was shown before still is: $changed pixels"
key Return
rest
[[ -z $(newest) ]] || complain "without its file it became the command $(newest)"
search "formulas polynomial"
click $slider_x $((slider_y - 28))
key ctrl+a
xdotool type --delay 30 'nonsense'
home
key Return
rest
[[ -z $(newest) ]] || complain "nonsense became the command $(newest)"
key Escape
quit

# ---- text is typed into what is shown ----
start flat.wrinkle
home
shot before
key t
rest
key ctrl+a
xdotool type --delay 30 'Blinn "78"'
rest
shot written
differs_much before written "letters are shown as they are typed"
xdotool mousemove $((X + 330)) $((Y + 400))
key ctrl+Return
becomes 'text "Blinn *' "the text as a command"
home
save_as written.exr
"$program" run - <<<"$(printf '%s\n' 'table 256x256' 'bump height=0.1' 'layer add "Text: Blinn \"78\"" from="text \"Blinn \\\"78\\\"\""' 'save said.exr')" >/dev/null ||
    complain "no said.exr"
[[ $(hash_of written.exr) == "$(hash_of said.exr)" ]] || complain "what was typed is not what the command writes"
quit

# ---- a font is found by typing, and stands first the next time ----
sed -i 's/^height .*/height 880/; s/^lower .*/lower 0.36/' config/wrinkle/window.conf # room for the font's row
start flat.wrinkle
home
key t
click 1095 421
xdotool type --delay 30 'serif bold dejavu'
rest
key Down
key Return
key Return
becomes 'text Wrinkle *file=*/DejaVuSerif*Bold*.ttf*' "letters of a font that was found"
chosen=$(newest)
quit
grep -q '^font 0 /.*/DejaVuSerif.*Bold' config/wrinkle/window.conf || complain "the font is not kept: $chosen"

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
printf 'ok\n'
