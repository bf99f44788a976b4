#!/usr/bin/env bash
# F1 shows the guide's pages: they come up, are found by their words, show their pictures, lead on by their links,
# and stand in the window at every size of its type.  window_guide.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
printf 'width 1200\nheight 820\nturning 0\nants 0\n' >config/wrinkle/window.conf

# changed A B GEOMETRY LEAST WHAT: so many pixels of that part differ at least.
changed() {
    local different
    different=$(differs "$1" "$2" "$3")
    [[ ${different%.*} -ge $4 ]] || complain "$5: $different pixels differ"
}
page=780x560+330+100 column=200x560+100+100

start "$source/samples/bricks.wrinkle"
shot before
key F1
settle
shot keys
changed before keys "$page" 20000 'F1 shows no guide'

# ---- the second row of the column is the guide's own page, with a picture that comes by itself ----
click 130 133
settle
shot index
changed keys index "$page" 20000 'a click on a page does not open it'
has_picture() {
    shot index
    [[ $(convert index.ppm -crop "$page" +repage -format '%k' info:) -gt 3000 ]]
}
until_true 120 "the picture on the guide's first page" has_picture

# ---- a search fills the column, opens the first that it finds, and the arrows go on ----
xdotool type --delay 20 'opacity'
settle
shot found
changed index found "$column" 2000 'a search finds nothing'
changed index found "$page" 20000 'a search opens no page'
key Down
settle
shot next
changed found next "$page" 2000 'the arrow does not go on to the next'
xdotool type --delay 20 'qqqq'
settle
shot nothing
changed next nothing "$column" 500 'what no page has is found'

# ---- the pages scroll by keys, and Escape leaves ----
key Escape
home
shot after
[[ $(differs before after 400x300+100+150) == 0 ]] || complain 'the guide stays when it is left'
key F1
settle
click 130 159 # the page of the window, which is long
settle
shot again
key Next
settle
shot lower
changed again lower "$page" 5000 'Page Down does not scroll'
key Escape
xdotool key ctrl+q
ends 0

# ---- the type's sizes: the dialog stays inside the window, with its button ----
for scale in 0.75 1.5 2.5; do
    export WRINKLE_SCALE=$scale
    start
    settle
    shot before
    key F1
    settle
    shot open
    # a strip along each edge of the window is only dimmed: nothing of the dialog reaches it
    for strip in 1200x4+0+0 1200x4+0+816 4x820+0+0 4x820+1196+0; do
        convert before.ppm -crop "$strip" +repage -format '%[fx:mean]' info: >strip.before
        convert open.ppm -crop "$strip" +repage -format '%[fx:mean]' info: >strip.open
        awk -v a="$(cat strip.before)" -v b="$(cat strip.open)" 'BEGIN { exit !(b < a && b > 0.3 * a) }' ||
            complain "at scale $scale the guide reaches the window's edge, $strip"
    done
    key Escape
    xdotool key ctrl+q
    ends 0
done

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
