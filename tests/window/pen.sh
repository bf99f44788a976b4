#!/usr/bin/env bash
# Pens in the window itself, under an X server of its own with a tablet made of software (tests/window/pen/): what
# pressure, tilt, the eraser, buttons and fingers do to the table, that no event is lost, and that a tablet
# may go away at any time.  pen.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

for tool in Xorg cc pkg-config xinput xdotool import compare convert jq; do
    command -v "$tool" >/dev/null && continue
    printf '%s is missing: apt-get install xserver-xorg-core xserver-xorg-video-dummy xserver-xorg-dev xinput xdotool imagemagick jq\n' "$tool"
    exit 1
done

# ---- the server, on whatever display is free ----
cd "$folder" || exit 1
mkdir -p modules/input config/wrinkle
read -ra flags <<<"$(pkg-config --cflags xorg-server)"
cc -O2 -w -shared -fPIC "${flags[@]}" "$source/tests/window/pen/testpen.c" -o modules/input/testpen_drv.so || exit 1
cc -O2 -Wall -Wextra -Werror "$source/tests/window/pen/play.c" -o play || exit 1
sed "s,FOLDER,$folder,g" "$source/tests/window/pen/xorg.conf" >xorg.conf
mkfifo display
# -r: a key that a busy machine holds for long is still pressed once, as in window_help.sh.
Xorg -r -displayfd 3 -config "$folder/xorg.conf" -logfile "$folder/Xorg.log" -noreset -nolisten tcp \
    3>display >server.log 2>&1 &
server=$!
read -r -t 30 number <display || { cat server.log; tail -n 30 Xorg.log; exit 1; }
export DISPLAY=:$number
quiet_environment
devices=$(xinput list --name-only)
for device in 'testpen front' 'testpen back' 'testpen glass'; do
    grep -qxF "$device" <<<"$devices" && continue
    printf 'the server has no device "%s"\n' "$device"
    tail -n 30 Xorg.log
    exit 1
done

# settings [LINE...]: the window's, where nothing moves by itself and pressure is strength.
settings() {
    printf 'width 1200\nheight 800\nturning 0\nants 0\nrange_follows 0\nradius 12\nhardness 0.8\nstrength 0.5\nmode 0\npressure 0\n' \
        >config/wrinkle/window.conf
    [[ $# == 0 ]] || printf '%s\n' "$@" >>config/wrinkle/window.conf
}
printf 'save_history: Ctrl+Alt+H\n' >config/wrinkle/keys.conf
printf 'table 256x256\nbump height=1\n' >flat.wrinkle

canvas=380x500+60+120

# ---- pens ----

# The screen is 1280 x 1024; an axis of 0..65535 lies over it.
device_units='function X(x) { return (x0 + x) * 65536 / 1280 } function Y(y) { return (y0 + y) * 65536 / 1024 }'

# stroke DEVICE X0 Y0 X1 Y1 P0 P1 MOVES MS [T0 T1] [open]: press, move in a line, let go unless `open`.
# Pixels of the window, pressure 0..1, tilt -64..63; the turn is twice the tilt in degrees.
stroke() {
    awk -v x0="$X" -v y0="$Y" -v ax="$2" -v ay="$3" -v bx="$4" -v by="$5" -v p="$6" -v q="$7" -v n="$8" \
        -v ms="$9" -v s="${10:-0}" -v t="${11:-0}" -v open="${12:-}" "$device_units"'
        function place(k) {
            return sprintf("%.3f %.3f %.1f %.1f %.1f %.1f", X(ax + (bx - ax) * k), Y(ay + (by - ay) * k),
                           65535 * (p + (q - p) * k), s + (t - s) * k, (s - t) * k, 10 * (s + (t - s) * k))
        }
        BEGIN {
            print "m", place(0)
            print "b 1 1", place(0)
            for (i = 1; i <= n; i++) print "w " ms "\nm " place(i / n)
            if (open == "") print "w " ms "\nb 1 0", X(bx), Y(by), 0, t, s - t
        }' | ./play "$1" || complain "the device $1 does not answer"
}

# lift DEVICE X Y: let go of a stroke that was left open.
lift() {
    awk -v x0="$X" -v y0="$Y" -v x="$2" -v y="$3" "$device_units"'
        BEGIN { print "b 1 0", X(x), Y(y), 0, 0, 0 }' | ./play "$1" || complain "the device $1 does not answer"
}

# button DEVICE BUTTON X Y DX DY: press it there, move, let go.
button() {
    awk -v x0="$X" -v y0="$Y" -v b="$2" -v x="$3" -v y="$4" -v dx="$5" -v dy="$6" "$device_units"'
        BEGIN {
            print "m", X(x), Y(y), 0, 0, 0
            print "b", b, 1, X(x), Y(y), 0, 0, 0
            for (i = 1; i <= 10; i++) print "w 5\nm", X(x + dx * i / 10), Y(y + dy * i / 10), 0, 0, 0
            print "b", b, 0, X(x + dx), Y(y + dy), 0, 0, 0
        }' | ./play "$1" || complain "the device $1 does not answer"
}

finger() {
    awk -v x0="$X" -v y0="$Y" -v x="$1" -v y="$2" -v dx="$3" -v dy="$4" "$device_units"'
        BEGIN {
            print "t begin", X(x), Y(y)
            for (i = 1; i <= 20; i++) print "w 5\nt update", X(x + dx * i / 20), Y(y + dy * i / 20)
            print "t end", X(x + dx), Y(y + dy)
        }' | ./play glass || complain "the touch screen does not answer"
}

# fingers COUNT X Y DX: side by side; the last one moves.
fingers() {
    awk -v x0="$X" -v y0="$Y" -v n="$1" -v x="$2" -v y="$3" -v dx="$4" "$device_units"'
        BEGIN {
            for (k = 0; k < n; k++) print "t begin", X(x + 40 * k), Y(y), k
            for (i = 1; i <= 10 && dx; i++) print "w 10\nt update", X(x + 40 * (n - 1) + dx * i / 10), Y(y), n - 1
            for (k = 0; k < n; k++) print "t end", X(x + 40 * k + (k == n - 1 ? dx : 0)), Y(y), k
        }' | ./play glass || complain "the touch screen does not answer"
}

# ---- what became of it ----

# history: the commands so far, in history.wrinkle.
history() {
    rm -f history.wrinkle
    answer_file history.wrinkle ctrl+alt+h
}
strokes() { grep -c '^stroke ' history.wrinkle; }
# points_of N: the samples of the Nth stroke, one a line: u v pressure tilt_x tilt_y seconds.
points_of() {
    grep '^stroke ' history.wrinkle | sed -n "$1s/.* points=\\([^ ]*\\).*/\\1/p" | tr ';' '\n' | tr ',' ' '
}
expect_strokes() {
    history
    [[ $(strokes) == "$1" ]] || complain "$2: $(strokes) strokes in the history, not $1"
}
# heights FILE: F at places u,v of standard input, one a line.
heights() {
    local at=()
    while read -r u v _; do at+=(--at "$u,$v"); done
    "$program" inspect "$1" "${at[@]}" --json | jq .F
}

# ---- pressure: harder is higher, and none of the samples is missing ----
settings
start flat.wrinkle
stroke front 160 420 380 420 0 1 100 4
until_true 120 "the mark of unsaved work" title_is 'untitled *'
expect_strokes 1 'after one stroke'
points_of 1 >points
[[ $(wc -l <points) == 101 ]] || complain "a press and 100 moves gave $(wc -l <points) samples"
awk 'NF < 3 { $3 = 1 } # a pressure of 1 is not written
     NR > 1 && ($1 <= u || $3 <= p || ($2 - v) ^ 2 > 1e-8) { bad = 1 } { u = $1; v = $2; p = $3 } NR == 1 && p != 0 { bad = 1 }
     END { exit bad || p != 1 }' points || complain "the samples do not follow the pen: $(cat points)"
save_as ramp.exr
awk 'NR % 10 == 1' points | heights ramp.exr >ramp
[[ $(wc -l <ramp) == 11 ]] || complain "no heights along the stroke"
awk '$1 < last - 1e-4 { bad = 1 } { last = $1 } NR == 1 && $1 > 0.05 { bad = 1 } END { exit bad || last < 0.45 }' ramp ||
    complain "more pressure is not more height: $(tr '\n' ' ' <ramp)"

# ---- the other end of the pen erases ----
stroke back 300 420 400 420 1 1 40 4
expect_strokes 2 'after the eraser'
save_as erased.exr
high=$(sed -n 81p points | heights ramp.exr) low=$(sed -n 81p points | heights erased.exr)
awk -v h="$high" -v l="$low" 'BEGIN { exit !(h > 0.2 && l < 0.02 && l > -0.02) }' ||
    complain "the eraser made $low of the height $high"

# ---- the upper button on the barrel moves the table, the lower one picks a height ----
home
shot before
button front 3 250 600 60 40
home
shot moved
changed=$(differs before moved "$canvas")
[[ ${changed%.*} -gt 500 ]] || complain "the upper button moved only $changed pixels of the table"
button front 3 310 640 -60 -40
home
shot back
changed=$(differs before back "$canvas")
[[ ${changed%.*} -lt 200 ]] || complain "moved back, $changed pixels of the table are others"
button front 2 250 420 0 0
expect_strokes 2 'after both buttons'

# ---- 1000 events at 1000 a second: all of them are in the stroke ----
stroke front 150 300 390 340 0.2 0.9 1000 1
expect_strokes 3 'after a quick stroke'
count=$(points_of 3 | wc -l)
[[ $count == 1001 ]] || complain "a press and 1000 moves at 1000 Hz gave $count samples"

# ---- switched off in the middle of a stroke: it ends, the program goes on, the pen comes back ----
stroke front 150 500 380 500 0.2 0.8 30 4 0 0 open
xinput disable 'testpen front'
rest
expect_strokes 4 'after a pen was switched off'
xinput enable 'testpen front'
rest
stroke front 150 540 380 540 0.2 0.8 30 4
expect_strokes 5 'after it was switched on again'
count=$(points_of 5 | wc -l)
[[ $count == 31 ]] || complain "switched on again, a stroke of 31 samples has $count"

# ---- a finger paints, but not while a pen is near ----
stroke front 170 560 172 560 0.5 0.5 2 4 0 0 open
rest
finger 160 580 200 0
rest
lift front 172 560
rest # the pen was near until now at the latest
sleep 1.3
finger 160 620 200 0
expect_strokes 7 'after a tap, a palm and a finger'
count=$(points_of 7 | wc -l)
[[ $count -ge 15 && $count -le 21 ]] || complain "a finger's stroke has $count samples"
[[ $(points_of 7 | awk 'NF > 2 && $3 != 1' | wc -l) == 0 ]] || complain "a finger's pressure is not 1"

# ---- the tester shows what comes ----
home
xdotool key ctrl+shift+t
settle
shot tester
stroke front 300 350 500 380 0.1 1 60 4
settle
shot scribbled
changed=$(differs tester scribbled 320x200+270+270)
[[ ${changed%.*} -gt 400 ]] || complain "the scribble of the tester shows $changed pixels"
# The pen also drags the lower point of its curve upwards, as a mouse would.
stroke front 301 593 301 543 0.1 0.1 20 20 0 0 open
rest
lift front 301 543
settle
xdotool key Escape
settle
expect_strokes 7 'after the tester'

# ---- two fingers undo, three redo; two that move change the view ----
sleep 1.3 # the pen was near
fingers 2 200 600 0
rest
expect_strokes 6 'after a tap of two fingers'
fingers 3 200 600 0
rest
expect_strokes 7 'after a tap of three fingers'
home
shot before
fingers 2 200 600 80
home
shot pinched
changed=$(differs before pinched "$canvas")
[[ ${changed%.*} -gt 500 ]] || complain "two fingers changed only $changed pixels of the view"
expect_strokes 7 'after two fingers that moved'
xdotool key ctrl+q
settle
xdotool key d
ends 0
awk '/^pen .* testpen front$/ { y = $6 } END { exit !(y > 0.45 && y < 0.65) }' config/wrinkle/window.conf ||
    complain "the curve that was dragged is not kept: $(grep '^pen ' config/wrinkle/window.conf)"
picked=$(sed -n 's/^to //p' config/wrinkle/window.conf)
awk -v f="$picked" 'BEGIN { exit !(f > 0.1 && f < 0.3) }' || complain "on the middle of the ramp $picked was picked"

# ---- a recorded session replayed makes the same document ----
settings
export WRINKLE_PEN_RECORD=$folder/record.pen
start flat.wrinkle
stroke front 160 420 380 500 0.1 1 60 5
stroke back 250 380 260 520 0.5 1 60 5
save_as played.exr
xdotool key ctrl+q
ends 0
unset WRINKLE_PEN_RECORD
[[ $(grep -c '^down ' record.pen) == 2 ]] || complain "two strokes are recorded as $(grep -c '^down ' record.pen)"
export WRINKLE_PEN_REPLAY=$folder/record.pen
settings
start flat.wrinkle
settle
save_as replayed.exr
xdotool key ctrl+q
ends 0
unset WRINKLE_PEN_REPLAY
[[ $(hash_of played.exr) == "$(hash_of replayed.exr)" ]] || complain "a replay makes another document"

# ---- tilt and turn reach a brush that goes by them ----
settings 'preset classic/marker_fat'
start flat.wrinkle
stroke front 160 420 380 420 0.8 0.8 60 4 -60 60
expect_strokes 1 'with a preset'
points_of 1 >points
awk 'NR == 1 { a = $4; d = $7 } { b = $4; c = $5; s = $6; e = $7 }
     END { exit !(a < -0.9 && b > 0.9 && c < -1.8 + 0.9 && s > 0.2 && s < 2 && (d + 120) ^ 2 < 0.1 && (e - 120) ^ 2 < 0.1) }' points ||
    complain "tilt, turn and time do not reach the stroke: $(tail -n 1 points)"
awk '/^stroke/ { head = $0; sub(/ points=.*/, "", head); points = $0; sub(/.* points=/, "", points); sub(/ .*/, "", points)
        n = split(points, p, ";"); line = ""
        for (i = 1; i <= n; i++) {
            split(p[i] ",0,0,0", c, ",") # what is left out at the end is 0, but for pressure
            line = line (i > 1 ? ";" : "") c[1] "," c[2] "," c[3] ",0,0," c[6]
        }
        print head " points=" line; next } { print }' history.wrinkle >upright.wrinkle
[[ $(hash_of history.wrinkle) != "$(hash_of upright.wrinkle)" ]] || complain "tilt does not change what is painted"
xdotool key ctrl+q
settle
xdotool key d
ends 0

# ---- a window that is late does what pens and keys did in their order ----
settings
start flat.wrinkle
kill -STOP "$pid"
stroke front 160 420 380 420 0.5 0.5 30 4
sleep 0.2
xdotool key e
sleep 0.2
stroke front 160 460 380 460 0.5 0.5 30 4
sleep 0.2
xdotool key e
kill -CONT "$pid"
expect_strokes 2 'after strokes and keys that came at once'
modes=$(sed -n 's/^stroke .*mode=\([a-z]*\).*/\1/p' history.wrinkle | tr '\n' ' ')
[[ $modes == 'raise erase ' ]] || complain "strokes before and after the key for erasing: $modes"

# ---- a mouse that holds its button is let go, also while a pen hovers ----
xdotool mousemove $((X + 160)) $((Y + 520))
rest
sleep 0.5 # the server says that the pen moved: for a tenth of a second after that a mouse is its shadow
xdotool mousedown 1
for i in 1 2 3 4 5 6; do xdotool mousemove $((X + 160 + 30 * i)) $((Y + 520)); done
rest
awk -v x0="$X" -v y0="$Y" "$device_units"'
    BEGIN { for (i = 0; i < 100; i++) print "m", X(340 + i % 2), Y(520), 0, 0, 0 "\nw 10" }' | ./play front &
sleep 0.5
xdotool mouseup 1
wait $!
rest
stroke front 160 560 380 560 0.5 0.5 30 4
expect_strokes 4 'after a mouse beside a pen that hovers'
xdotool key ctrl+q
settle
xdotool key d
ends 0

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
