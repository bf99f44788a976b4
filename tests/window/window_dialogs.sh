#!/usr/bin/env bash
# What dialogs may not do: no file goes without a question, whatever its name came by.
# window_dialogs.sh PROGRAM SOURCE-FOLDER PORTAL
set -uo pipefail
program=$1
source=$2
portal=$3
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
printf 'width 1200\nheight 800\nturning 0\nants 0\nrange_follows 0\nradius 24\nstrength 0.4\nmode 1\n' >config/wrinkle/window.conf
printf 'table 128x128\nbump height=1\n' >flat.wrinkle

sum_of() { sha256sum <"$1"; }
is_sum() { [[ $(sum_of "$1") == "$2" ]]; }
is_other() { ! is_sum "$@"; }
stroke() { drag 180 $((300 + ${1:-0})) 6 4 20; }
# unharmed FILE SUM WHAT
unharmed() { is_sum "$1" "$2" || complain "$3 replaced $1"; }
quit() { # with all work saved
    xdotool key ctrl+q
    ends 0
}
# name_file NAME KEY: ask for a file by hand and press Return, wherever that leads.
name_file() {
    shot unasked
    key "$2"
    until_true 120 "the question for a file" shows_dialog || return
    key ctrl+a
    xdotool type --delay 20 "$1"
    rest
    xdotool key Return
    home
}
# declined FILE SUM WHAT: the question stands, Return does not answer it, Escape goes back to the name, and again.
declined() {
    key Return
    key Return
    unharmed "$1" "$2" "$3 and Return, Return, Return"
    key Escape
    home
    key Return # the name was kept: the same question again
    home
    key Escape
    home
    key Escape
    home
    unharmed "$1" "$2" "$3 and Escape"
    # Whatever was open is closed: a stroke reaches the table.
}

# ---- a name that is taken: with its ending, and without ----
start flat.wrinkle
stroke
save_as taken.exr ctrl+s
was=$(sum_of taken.exr)
for name in "$folder/taken.exr" "$folder/taken" taken; do
    stroke 40
    until_true 120 "the mark of unsaved work" title_is 'taken.exr *'
    name_file "$name" ctrl+shift+s
    declined taken.exr "$was" "saving as $name"
    title_is 'taken.exr *' || complain "declined, $name left the title $(xdotool getwindowname "$window")"
done
name_file taken ctrl+shift+s
key r
until_true 120 "the file to be replaced" is_other taken.exr "$was"
until_true 120 "the title of what was saved" title_is taken.exr
was=$(sum_of taken.exr)

# ---- saved onto what another program has written since ----
stroke 80
until_true 120 "the mark of unsaved work" title_is 'taken.exr *'
cp taken.exr theirs.exr
printf 'theirs' >>taken.exr
theirs=$(sum_of taken.exr)
key ctrl+s
home
key Return
unharmed taken.exr "$theirs" "saving onto a changed file"
key Escape
home
unharmed taken.exr "$theirs" "saving onto a changed file and Escape"
title_is 'taken.exr *' || complain "not saved, the title is $(xdotool getwindowname "$window")"
key ctrl+s
home
key s
home
xdotool type --delay 20 other
rest
key Return
until_true 120 "the other name" title_is other.exr
unharmed taken.exr "$theirs" "saving under another name"
stroke 120
until_true 120 "the mark of unsaved work" title_is 'other.exr *'
printf 'theirs' >>other.exr
theirs=$(sum_of other.exr)
key ctrl+s
home
key r
until_true 120 "the changed file to be replaced" is_other other.exr "$theirs"
until_true 120 "the title of what was saved" title_is other.exr

# ---- the history as a script, an export ----
printf '# theirs\n' >steps.wrinkle
was=$(sum_of steps.wrinkle)
xdotool key ctrl+Return
settle
xdotool type --delay 20 'save history'
home
key Return
home
key ctrl+a
xdotool type --delay 20 steps
rest
key Return
home
declined steps.wrinkle "$was" "the history as steps"
printf 'theirs' >height.png
was=$(sum_of height.png)
key ctrl+e
home
key Return # "Choose a file..."
home
key Return # height.png
home
declined height.png "$was" "an export"

# ---- a preset of one's own ----
mkdir -p data/wrinkle/brushes
xdotool key ctrl+Return
settle
xdotool type --delay 20 'save brush as a preset'
home
key Return
home
key ctrl+a
xdotool type --delay 20 mine
rest
key Return
preset() { find "$folder/data" -name mine.myb; }
has_preset() { [[ -n $(preset) ]]; }
until_true 120 "a preset of one's own" has_preset
printf 'theirs' >"$(preset)"
was=$(sum_of "$(preset)")
home
xdotool key ctrl+Return
settle
xdotool type --delay 20 'save brush as a preset'
home
key Return
home
key ctrl+a
xdotool type --delay 20 mine
rest
key Return
home
declined "$(preset)" "$was" "a preset's name"
quit

# ---- the desktop's dialog asks before it answers, and what it did not ask about is asked here ----
unset WRINKLE_DIALOG
mkfifo bus
"$portal" >bus &
desktop=$!
trap 'kill $desktop 2>/dev/null; cleanup' EXIT
read -r DBUS_SESSION_BUS_ADDRESS <bus || complain "there is no portal: apt-get install dbus-daemon"
export DBUS_SESSION_BUS_ADDRESS
printf 'dialogs 1\n' >>config/wrinkle/window.conf # the desktop's, however slow the machine
start flat.wrinkle
stroke
was=$(sum_of taken.exr)
printf '%s\n' "$folder/taken" >answer # an ending was never spoken of
key ctrl+s
home
grep -q '^SaveFile' asked || complain "the portal is not told that a file is written: $(cat asked)"
key Return
unharmed taken.exr "$was" "a name without its ending from the desktop's dialog"
printf '%s\n' "$folder/fresh" >answer
key Escape # asks the desktop's dialog again
until_true 120 "the file of the second answer" file_is_there fresh.exr
grep -qF "['current_name' ['taken.exr'" asked || complain "the name was not kept: $(cat asked)"
until_true 120 "the title of the second answer" title_is fresh.exr
stroke 40
until_true 120 "the mark of unsaved work" title_is 'fresh.exr *'
was=$(sum_of taken.exr)
printf '%s\n' "$folder/taken.exr" >answer # it has asked
key ctrl+shift+s
until_true 120 "the file that the desktop's dialog asked about" is_other taken.exr "$was"
until_true 120 "its title" title_is taken.exr
quit

# ---- a press let go at once opens a list, which is drawn; the keys are then for the list ----
start flat.wrinkle
region=200x200+100+60
xdotool mousemove $((X + 160)) $((Y + 50))
settle
shot closed
xdotool click 1
settle
shot opened
changed=$(differs closed opened "$region")
[[ ${changed%.*} -gt 2000 ]] || complain "a click shows only $changed pixels of a list"
canvas=200x200+100+500
key Up # at the list's first row already
key Down
key Down
key Down
key q # a tool's key
home
shot moved
changed=$(differs opened moved "$canvas")
[[ ${changed%.*} -lt 20 ]] || complain "arrows in a list move the table: $changed pixels differ"
key Return
home
stroke
becomes 'stroke *mode=*' "a stroke after a list was chosen from"
newest_is 'stroke *mode=raise*' && complain "the arrows and Return choose nothing from a list"
key space # nothing is open any more: the table can be worked on
# ... in a dialog the list goes first, then the dialog
key ctrl+e
home
shot dialog
xdotool mousemove $((X + 650)) $((Y + 294))
settle
xdotool click 1
settle
shot listed
changed=$(differs dialog listed 300x300+500+300)
[[ ${changed%.*} -gt 2000 ]] || complain "a list in a dialog shows only $changed pixels"
key Escape
home
shot unlisted
changed=$(differs dialog unlisted 400x300+450+250)
[[ ${changed%.*} -lt 500 ]] || complain "Escape in a dialog's list closes more than the list: $changed pixels differ"
key Escape
home

# ---- what is typed takes the place of the text that stands there ----
key t
home
sleep 0.5
xdotool type --delay 40 'ab'
home
key ctrl+Return
becomes 'text *ab*' "letters by hand"
newest_is 'text ab*' || complain "what is typed is added to the text that stood there: $(newest)"
stroke
xdotool key ctrl+q
settle
xdotool key d
ends 0

# ---- without its samples the program says so, and calls nothing by their name; without icons there are words ----
mkdir alone
cp "$program" "${program%/*}/wrinkle_window.so" alone/
(
    unset WRINKLE_DATA
    printf '<?xml version="1.0"?><fontconfig></fontconfig>' >none.conf
    export FONTCONFIG_FILE=$PWD/none.conf
    program=$folder/alone/wrinkle
    start
    title_is untitled || complain "without samples the title is $(xdotool getwindowname "$window")"
    shot alone
    # The sign of an error, in its colour.
    red=$(convert alone.ppm -crop 1200x28+0+772 -fuzz 5% -fill white +opaque '#e0694f' -fill black -opaque '#e0694f' \
        -format '%[fx:(1-mean)*w*h]' info:)
    [[ ${red%.*} -gt 3 ]] || complain "what is missing is not said: $red"
    xdotool key ctrl+q
    ends 0
    exit "$failures"
) || complain "started without samples and fonts"

# ---- with a window manager the whole window, its borders included, is on the screen ----
manager=''
if command -v openbox >/dev/null; then
    openbox --sm-disable >openbox.log 2>&1 &
    manager=$!
    managed() { xprop -root _NET_SUPPORTING_WM_CHECK 2>/dev/null | grep -q 0x; }
    until_true 120 "the window manager" managed
    printf 'turning 0\nwidth 1440\nheight 900\n' >config/wrinkle/window.conf
    start flat.wrinkle
    on_screen() {
        look_where
        read -r left right top bottom < <(xprop -id "$window" _NET_FRAME_EXTENTS | sed 's/.*= //; s/,//g')
        [[ ${top:-0} -gt 0 && $((WIDTH + left + right)) -le 1280 && $((HEIGHT + top + bottom)) -le 900 ]]
    }
    until_true 120 "a window that fits the screen" on_screen || complain "it is $WIDTH x $HEIGHT at $X,$Y, borders ${left:-} ${right:-} ${top:-} ${bottom:-}"
    quit
    kill -TERM "$manager"
fi

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
