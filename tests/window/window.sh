#!/usr/bin/env bash
# The window itself, under an X server of its own: it opens, a stroke changes the table and the patch, what
# is saved is what was painted, and nothing is lost without asking.  window.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
# The patch and the outline of a selection stand still, so that the picture changes only when it has a
# reason to.
printf 'width 1200\nheight 800\nturning 0\nants 0\nrange_follows 0\nlower 0.42\nradius 24\nstrength 0.4\nmode 1\n' >"$folder/config/wrinkle/window.conf"

canvas=380x500+60+120
patch=380x500+500+120

layers_of() { "$program" inspect "$1" --json | grep -o '"blend"' | wc -l; }

# ---- it opens, with something to wrinkle ----
start
shot start
[[ $WIDTH == 1200 && $HEIGHT == 800 ]] || complain "the window is $WIDTH x $HEIGHT"
colours=$(convert start.ppm -crop "$patch" -format '%k' info:)
[[ $colours -gt 250 ]] || complain "the patch has only $colours colours"
title_is 'bricks (starter)' || complain "the title is $(xdotool getwindowname "$window")"

# ---- a stroke changes the table at once, and the patch ----
drag 180 300 6 4 25
until_true 120 "the mark of unsaved work" title_is 'bricks (starter) *'
settle
shot painted
changed=$(differs start painted "$canvas")
[[ ${changed%.*} -gt 2000 ]] || complain "a stroke changed only $changed pixels of the table"
changed=$(differs start painted "$patch")
[[ ${changed%.*} -gt 200 ]] || complain "a stroke changed only $changed pixels of the patch"

# ---- the patch is turned by hand, the table stays ----
drag 700 450 8 3 15
settle
shot turned
changed=$(differs painted turned "$patch")
[[ ${changed%.*} -gt 20000 ]] || complain "a drag changed only $changed pixels of the patch"
xdotool mousemove $((X + 330)) $((Y + 400))
settle
shot saved

# ---- it is saved where it was typed ----
save_as painted.exr ctrl+s
"$program" inspect painted.exr --json >inspected || complain "the saved file is no document"
grep -q '"size":\[256,256\]' inspected || complain "the saved table has another size: $(cat inspected)"
[[ $(hash_of painted.exr) != "$(hash_of "$source/samples/starters/bricks.wrinkle")" ]] ||
    complain "the saved document is the starter: nothing was painted"

# ---- nothing unsaved: it ends without a question ----
xdotool key ctrl+q
ends 0

# ---- opened again it is the same, and saved again it has the same hash ----
start painted.exr
title_is painted.exr || complain "the title is $(xdotool getwindowname "$window")"
shot again
changed=$(differs saved again "$canvas")
[[ ${changed%.*} -lt 200 ]] || complain "opened again, $changed pixels of the table are others"
save_as second.exr
[[ $(hash_of painted.exr) == "$(hash_of second.exr)" ]] || complain "saved again it has another hash"

# ---- unsaved work is asked about; Escape goes back to it, D gives it up ----
drag 200 500 5 0 20
until_true 120 "the mark of unsaved work" title_is 'second.exr *'
settle
shot unsaved
xdotool key ctrl+q
settle
shot question
changed=$(differs unsaved question 400x200+400+270)
[[ ${changed%.*} -gt 20000 ]] || complain "quitting with unsaved work asks nothing"
is_gone && complain "quitting with unsaved work lost it"
xdotool key Escape
settle
shot back
changed=$(differs unsaved back 400x200+400+270)
[[ ${changed%.*} -lt 200 ]] || complain "Escape does not go back to the work: $changed pixels differ"
xdotool key ctrl+q
settle
xdotool key d
ends 0
[[ $(hash_of painted.exr) == "$(hash_of second.exr)" ]] || complain "discarding wrote the file"

# ---- the question can also be answered by saving ----
start second.exr
drag 200 500 5 0 20
until_true 120 "the mark of unsaved work" title_is 'second.exr *'
xdotool key ctrl+q
settle
xdotool key Return
ends 0
[[ $(hash_of painted.exr) != "$(hash_of second.exr)" ]] || complain "saving at the end wrote nothing"

# ---- layers are added and painted by hand; undone, the document is what it was, bit for bit ----
start painted.exr
shot start
xdotool key ctrl+shift+n
until_true 120 "the mark of a new layer" title_is 'painted.exr *'
drag 180 300 6 4 20
xdotool key ctrl+shift+n
drag 380 520 -5 -3 20
home
shot layers
changed=$(differs start layers "$canvas")
[[ ${changed%.*} -gt 2000 ]] || complain "strokes on two layers changed only $changed pixels"
save_as layered.exr
[[ $(layers_of layered.exr) == 8 ]] || complain "the document has $(layers_of layered.exr) layers, not 8"
[[ $(hash_of layered.exr) != "$(hash_of painted.exr)" ]] || complain "layers leave no trace in the file"
for key in ctrl+z ctrl+z ctrl+z ctrl+z; do
    xdotool key "$key"
    settle
done
home
shot undone
changed=$(differs start undone "$canvas")
[[ ${changed%.*} -lt 20 ]] || complain "four steps undone, $changed pixels of the table are others"
save_as undone.exr
[[ $(hash_of undone.exr) == "$(hash_of painted.exr)" ]] || complain "undoing all does not give the same document"
# One after the other: a step that a busy machine does for long makes the window refuse the next, with words.
for key in ctrl+shift+z ctrl+y y ctrl+shift+z; do
    xdotool key "$key"
    settle
done
save_as redone.exr
[[ $(hash_of redone.exr) == "$(hash_of layered.exr)" ]] || complain "redoing all does not give the same document"

# ---- an operation shows what it would do, and cancelled leaves no trace ----
home
shot calm
xdotool key ctrl+i
home
shot tried
changed=$(differs calm tried "$canvas")
[[ ${changed%.*} -gt 2000 ]] || complain "an operation that is tried changes only $changed pixels"
title_is redone.exr || complain "trying an operation makes unsaved work"
xdotool key Escape
home
shot back
changed=$(differs calm back "$canvas")
[[ ${changed%.*} -lt 20 ]] || complain "a cancelled operation leaves $changed pixels changed"
save_as cancelled.exr
[[ $(hash_of cancelled.exr) == "$(hash_of redone.exr)" ]] || complain "a cancelled operation changes the document"
xdotool key ctrl+i
settle
xdotool key Return
until_true 120 "the mark of an operation" title_is 'cancelled.exr *'
xdotool key ctrl+z
until_true 120 "an operation undone" title_is cancelled.exr

# ---- a stroke keeps to what is selected ----
xdotool key shift+r
drag 250 200 4 20 20
xdotool key b
home
shot selected
changed=$(differs back selected "$canvas")
[[ ${changed%.*} -gt 200 ]] || complain "a selection is outlined by $changed pixels only"
drag 200 500 9 0 20
home
shot confined
changed=$(differs selected confined 40x80+265+460)
[[ ${changed%.*} -gt 500 ]] || complain "a stroke changed only $changed pixels of what is selected"
changed=$(differs selected confined 50x80+190+460)
[[ ${changed%.*} -lt 20 ]] || complain "a stroke changed $changed pixels outside the selection"
xdotool key ctrl+shift+a
settle
xdotool key ctrl+q
settle
xdotool key d
ends 0

# ---- V and dragging: a straight line, aimed first and drawn when it is let go, however the hand shook ----
start painted.exr
home
shot calm
xdotool mousemove $((X + 150)) $((Y + 520))
xdotool keydown v
rest
xdotool mousedown 1
for step in '60 -60' '60 60' '60 -60' '40 60'; do
    # shellcheck disable=SC2086
    xdotool mousemove_relative -- $step
done
settle
title_is painted.exr || complain "a line that is only aimed counts as work"
xdotool mouseup 1
xdotool keyup v
until_true 120 "the line" title_is 'painted.exr *'
home
shot lined
changed=$(differs calm lined 200x20+160+510)
[[ ${changed%.*} -gt 2000 ]] || complain "a straight line changed only $changed pixels on its way"
changed=$(differs calm lined 200x24+160+456)
[[ ${changed%.*} -lt 20 ]] || complain "a straight line changed $changed pixels where the hand shook"

# ---- Escape gives up the stroke that is being drawn ----
xdotool mousemove $((X + 150)) $((Y + 260))
xdotool mousedown 1
for ((i = 0; i < 10; i++)); do xdotool mousemove_relative -- 15 0; done
xdotool key Escape
xdotool mouseup 1
home
shot given_up
changed=$(differs lined given_up "$canvas")
[[ ${changed%.*} -lt 20 ]] || complain "a stroke that was given up changed $changed pixels"
xdotool key ctrl+z
until_true 120 "the line undone" title_is painted.exr

# ---- on the patch the brush paints the table under it, the patch stays as it is turned; undone it is gone ----
home
shot calm
xdotool key a
settle
drag 660 430 6 3 15
until_true 120 "a stroke on the patch" title_is 'painted.exr *'
home
shot on_patch
changed=$(differs calm on_patch "$canvas")
[[ ${changed%.*} -gt 500 ]] || complain "a stroke on the patch changed only $changed pixels of the table"
changed=$(differs calm on_patch 150x110+630+405)
[[ ${changed%.*} -gt 500 ]] || complain "a stroke on the patch changed only $changed pixels under it"
changed=$(differs calm on_patch 300x60+520+560)
[[ ${changed%.*} -lt 400 ]] || complain "painting on the patch turned it: $changed pixels differ"
xdotool key ctrl+z
until_true 120 "the stroke on the patch undone" title_is painted.exr
home
shot undone
changed=$(differs calm undone "$canvas")
[[ ${changed%.*} -lt 20 ]] || complain "undone, a stroke on the patch leaves $changed pixels changed"
xdotool key a
xdotool key ctrl+q
ends 0

# ---- a brush on a string follows when the string is taut ----
sed -i '/^steady/d' "$folder/config/wrinkle/window.conf"
printf 'steady 2\nsteady_string 100\n' >>"$folder/config/wrinkle/window.conf"
start painted.exr
shot calm
drag 180 300 8 0 25
home
shot pulled
changed=$(differs calm pulled 100x60+160+270)
[[ ${changed%.*} -gt 1000 ]] || complain "on a string a stroke changed only $changed pixels"
changed=$(differs calm pulled 70x60+330+270)
[[ ${changed%.*} -lt 20 ]] || complain "on a string the brush reached $changed pixels too far"
xdotool key ctrl+q
settle
xdotool key d
ends 0
sed -i '/^steady/d' "$folder/config/wrinkle/window.conf"

# ---- a signal ends the program; unsaved work is asked for first, and kept if a second signal comes before the answer ----
start painted.exr
kill -TERM "$pid"
ends 0
start painted.exr
drag 180 300 8 0 25
kill -TERM "$pid"
settle
kill -0 "$pid" 2>/dev/null || complain "a signal ended the program without the question"
kill -TERM "$pid"
ends 0
"$program" recover | grep -q painted.exr || complain "work that no question was answered for is lost"

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
