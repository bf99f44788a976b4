#!/usr/bin/env bash
# The window on Wayland itself, under a compositor in an X server, which passes on mouse and keys: it opens, paints, reports that
# the compositor has no tablets, and ends. Skipped without weston.  window_wayland.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"
command -v weston >/dev/null || { echo "weston is missing: apt-get install weston"; exit 77; }

serve
export XDG_RUNTIME_DIR=$folder/run
mkdir -m 700 run
weston --backend=x11-backend.so --use-pixman --shell=kiosk-shell.so --socket=wayland --width=1200 --height=800 --idle-time=0 >weston.log 2>&1 &
compositor=$!
trap 'kill -TERM "$compositor" 2>/dev/null; cleanup' EXIT
has_socket() { [[ -S run/wayland ]]; }
until_true 60 "the compositor" has_socket || { tail weston.log; exit 1; }
has_window() {
    window=$(sed -n 's/.*x11 output .*window id //p' weston.log)
    [[ -n $window ]]
}
until_true 60 "the compositor's window" has_window || { tail weston.log; exit 1; }
xdotool windowfocus "$window"

printf 'turning 0\nants 0\nrange_follows 0\n' >config/wrinkle/window.conf
printf 'table 256x256\nbump height=1\n' >flat.wrinkle
on_wayland=$folder/on_wayland
printf '#!/bin/sh\nunset DISPLAY\nexec env WAYLAND_DISPLAY=wayland SDL_VIDEODRIVER=wayland "%s" "$@"\n' "$program" >"$on_wayland"
chmod +x "$on_wayland"
program=$on_wayland

start flat.wrinkle
shot before
drag 200 420 6 2 20
becomes 'stroke *' "a drag paints"
shot after
changed=$(differs before after 400x400+60+250)
[[ ${changed%.*} -gt 500 ]] || complain "the stroke shows $changed pixels"
shot unasked
xdotool key ctrl+shift+t
settle
shot tester
changed=$(differs unasked tester 500x300+350+250)
[[ ${changed%.*} -gt 10000 ]] || complain "the tablet tester shows $changed pixels"
key Escape
xdotool key ctrl+q
settle
xdotool key d
ends 0
grep -v '^at rest\|^timing\|^first picture\|^Couldn.t open plugin\|^No plugins found' err | grep -i 'error\|fail' && complain "messages of the program"
[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
