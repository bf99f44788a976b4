#!/usr/bin/env bash
# The window itself, under an X server of its own: it opens, a stroke changes the table and the patch, what
# is saved is what was painted, and nothing is lost without asking.  window.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
server='' window='' pid='' failures=0

cleanup() {
    # shellcheck disable=SC2086
    [[ -z $pid ]] || kill -KILL $pid 2>/dev/null
    # shellcheck disable=SC2086
    [[ -z $server ]] || kill -TERM $server 2>/dev/null
    wait
    rm -rf "$folder"
}
trap cleanup EXIT
trap 'exit 1' INT TERM

for tool in Xvfb xdotool import compare convert; do
    command -v "$tool" >/dev/null && continue
    printf '%s is missing: apt-get install xvfb xdotool imagemagick\n' "$tool"
    exit 1
done

complain() {
    printf '%s\n' "$*"
    failures=$((failures + 1))
}

# until_true SECONDS WHAT COMMAND...: the command comes true in time, or that is a failure.
until_true() {
    local end=$((SECONDS + $1)) what=$2
    shift 2
    until "$@"; do
        if [[ $SECONDS -ge $end ]]; then
            complain "in vain waited for: $what"
            return 1
        fi
        sleep 0.05
    done
}

# ---- the server, on whatever display is free ----
mkfifo "$folder/display"
Xvfb -displayfd 3 -screen 0 1280x900x24 -nolisten tcp 3>"$folder/display" >"$folder/server.log" 2>&1 &
server=$!
read -r -t 30 number <"$folder/display" || { cat "$folder/server.log"; exit 1; }
export DISPLAY=:$number
unset WAYLAND_DISPLAY SDL_VIDEODRIVER WRINKLE_SCALE
export HOME=$folder XDG_CONFIG_HOME=$folder/config XDG_STATE_HOME=$folder/state WRINKLE_DATA=$source WRINKLE_DIALOG=own
export WRINKLE_RENDERER=software WRINKLE_TIMING=1
mkdir -p "$folder/config/wrinkle"
# The patch and the outline of a selection stand still, so that the picture changes only when it has a
# reason to.
printf 'width 1200\nheight 800\nturning 0\nants 0\nradius 24\nstrength 0.4\nmode 1\n' >"$folder/config/wrinkle/window.conf"
cd "$folder" || exit 1

has_window() {
    window=$(xdotool search --name ' - Wrinkle$' 2>/dev/null | head -n 1)
    [[ -n $window ]]
}
shows_picture() { grep -q 'first picture' err; }
is_gone() { ! kill -0 "$pid" 2>/dev/null; }

# start ARGUMENT...: open the window and wait until it has drawn itself.
start() {
    : >err
    "$program" paint "$@" >out 2>err &
    pid=$!
    until_true 30 "the first picture" shows_picture || { cat err; exit 1; }
    until_true 10 "the window" has_window || exit 1
    eval "$(xdotool getwindowgeometry --shell "$window" | grep -E '^(X|Y|WIDTH|HEIGHT)=')"
    # Without a window manager keys go where the pointer is.
    xdotool mousemove $((X + 330)) $((Y + 400))
    settle
}

# ends STATUS: the program ends by itself with that status.
ends() {
    until_true 20 "the end of the program" is_gone || return
    wait "$pid"
    local got=$?
    [[ $got == "$1" ]] || complain "exit status $got, not $1: $(cat err)"
    pid=''
}

shot() { import -window "$window" "$1.ppm"; }

# home: the pointer goes where its outline is not in the way of comparisons.
home() {
    xdotool mousemove $((X + 340)) $((Y + 400)) # else, if it is there, it would not be seen to move
    xdotool mousemove $((X + 330)) $((Y + 400))
    settle
}

# settle: wait until two pictures in a row are the same. The line that blinks in a text field is not
# waited for: nobody calls this while there is one.
settle() {
    local end=$((SECONDS + 20))
    shot settled
    while :; do
        sleep 0.3
        cp settled.ppm before.ppm
        shot settled
        cmp -s before.ppm settled.ppm && return
        [[ $SECONDS -lt $end ]] || { complain "the window does not come to rest"; return; }
    done
}

# differs A B GEOMETRY: how many pixels of that part differ.
differs() {
    convert "$1.ppm" -crop "$3" +repage a.ppm
    convert "$2.ppm" -crop "$3" +repage b.ppm
    compare -metric AE a.ppm b.ppm null: 2>&1
}
canvas=380x500+60+120
patch=380x500+500+120

# drag X Y DX DY STEPS: press the left button, move in steps, let go.
drag() {
    xdotool mousemove $((X + $1)) $((Y + $2))
    xdotool mousedown 1
    for ((i = 0; i < $5; i++)); do xdotool mousemove_relative -- "$3" "$4"; done
    xdotool mouseup 1
}

hash_of() { "$program" inspect "$1" --json | sed -n 's/.*"hash":"\([0-9a-f]*\)".*/\1/p'; }
title_is() { [[ $(xdotool getwindowname "$window" 2>/dev/null) == "$1 - Wrinkle" ]]; }

# save_as NAME [KEY]: by hand, and wait until the file is there.
file_is_there() { [[ -s $1 ]]; }
shows_dialog() {
    shot asking
    changed=$(differs unasked asking 400x200+400+270)
    [[ ${changed%.*} -gt 20000 ]]
}
save_as() {
    shot unasked
    xdotool key "${2:-ctrl+shift+s}"
    until_true 10 "the question for a file" shows_dialog || return
    sleep 0.2
    xdotool key ctrl+a
    xdotool type --delay 20 "$folder/$1"
    xdotool key Return
    until_true 20 "the file $1" file_is_there "$1"
    until_true 10 "the title of $1" title_is "$1"
}
layers_of() { "$program" inspect "$1" --json | grep -o '"blend"' | wc -l; }

# ---- it opens, with something to wrinkle ----
start
shot start
[[ $WIDTH == 1200 && $HEIGHT == 800 ]] || complain "the window is $WIDTH x $HEIGHT"
colours=$(convert start.ppm -crop "$patch" -unique-colors -format '%w' info:)
[[ $colours -gt 500 ]] || complain "the patch has only $colours colours"
title_is 'bricks (starter)' || complain "the title is $(xdotool getwindowname "$window")"

# ---- a stroke changes the table at once, and the patch ----
drag 180 300 6 4 25
until_true 10 "the mark of unsaved work" title_is 'bricks (starter) *'
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
grep -q '"size":\[512,512\]' inspected || complain "the saved table has another size: $(cat inspected)"
[[ $(hash_of painted.exr) != "$(hash_of "$source/samples/bricks.wrinkle")" ]] ||
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
until_true 10 "the mark of unsaved work" title_is 'second.exr *'
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
until_true 10 "the mark of unsaved work" title_is 'second.exr *'
xdotool key ctrl+q
settle
xdotool key Return
ends 0
[[ $(hash_of painted.exr) != "$(hash_of second.exr)" ]] || complain "saving at the end wrote nothing"

# ---- layers are added and painted by hand; undone, the document is what it was, bit for bit ----
start painted.exr
shot start
xdotool key ctrl+shift+n
until_true 10 "the mark of a new layer" title_is 'painted.exr *'
drag 180 300 6 4 20
xdotool key ctrl+shift+n
drag 380 520 -5 -3 20
home
shot layers
changed=$(differs start layers "$canvas")
[[ ${changed%.*} -gt 2000 ]] || complain "strokes on two layers changed only $changed pixels"
save_as layered.exr
[[ $(layers_of layered.exr) == 3 ]] || complain "the document has $(layers_of layered.exr) layers, not 3"
[[ $(hash_of layered.exr) != "$(hash_of painted.exr)" ]] || complain "layers leave no trace in the file"
xdotool key ctrl+z ctrl+z ctrl+z ctrl+z
home
shot undone
changed=$(differs start undone "$canvas")
[[ ${changed%.*} -lt 20 ]] || complain "four steps undone, $changed pixels of the table are others"
save_as undone.exr
[[ $(hash_of undone.exr) == "$(hash_of painted.exr)" ]] || complain "undoing all does not give the same document"
xdotool key ctrl+shift+z ctrl+y y ctrl+shift+z
settle
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
until_true 10 "the mark of an operation" title_is 'cancelled.exr *'
xdotool key ctrl+z
until_true 10 "an operation undone" title_is cancelled.exr

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

# ---- a signal ends the program ----
start painted.exr
kill -TERM "$pid"
ends 0

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
