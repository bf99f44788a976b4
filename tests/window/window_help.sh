# window_help.sh - what the tests of the window share: waiting, keys and mouse, pictures. Sourced, not run;
# needs `program` and `folder`, a folder of its own; makes `server`, `pid`, `window` and `failures`.
# shellcheck shell=bash disable=SC2154

server='' window='' pid='' asking='' failures=0

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

# The program shall find nothing of the user's.
quiet_environment() {
    unset WAYLAND_DISPLAY SDL_VIDEODRIVER WRINKLE_SCALE DBUS_SESSION_BUS_ADDRESS XDG_RUNTIME_DIR # no portal either
    export HOME=$folder XDG_CONFIG_HOME=$folder/config XDG_STATE_HOME=$folder/state WRINKLE_DATA=$source WRINKLE_DIALOG=own
    export WRINKLE_RENDERER=software WRINKLE_TIMING=1 WRINKLE_REST=$folder/rest
}

# serve: an X server on whatever display is free, and the test's own folder as the current one.
serve() {
    local tool number
    for tool in Xvfb xdotool import compare convert jq; do
        command -v "$tool" >/dev/null && continue
        printf '%s is missing: apt-get install xvfb xdotool imagemagick jq\n' "$tool"
        exit 1
    done
    mkfifo "$folder/display"
    # -r: a key that is held is pressed once, or the window would never rest meanwhile.
    Xvfb -r -noreset -displayfd 3 -screen 0 "${WR_TEST_SCREEN:-1280x900}x24" -nolisten tcp 3>"$folder/display" >"$folder/server.log" 2>&1 &
    server=$!
    read -r -t 30 number <"$folder/display" || { cat "$folder/server.log"; exit 1; }
    export DISPLAY=:$number
    quiet_environment
    export XDG_DATA_HOME=$folder/data
    mkdir -p "$folder/config/wrinkle"
    cd "$folder" || exit 1
}

has_window() {
    window=$(xdotool search --name ' - Wrinkle$' 2>/dev/null | head -n 1)
    [[ -n $window ]]
}
shows_picture() { grep -q 'first picture' err; }
is_gone() { ! kill -0 "$pid" 2>/dev/null; }

# look_where: X, Y, WIDTH and HEIGHT of the window on the screen. xdotool counts the frame of a window manager twice.
look_where() {
    eval "$(xwininfo -id "$window" | sed -nE 's/^ *Absolute upper-left ([XY]): +/\1=/p; s/^ *Width: +/WIDTH=/p; s/^ *Height: +/HEIGHT=/p')"
}
# start ARGUMENT...: open the window and wait until it has drawn itself.
start() {
    : >err
    rm -f "$WRINKLE_REST"
    mkfifo "$WRINKLE_REST"
    exec {asking}<>"$WRINKLE_REST"
    "$program" paint "$@" >out 2>err &
    pid=$!
    until_true 120 "the first picture" shows_picture || { cat err; exit 1; }
    until_true 120 "the window" has_window || exit 1
    look_where
    # Without a window manager keys go where the pointer is.
    xdotool mousemove $((X + 330)) $((Y + 400))
    settle
}

# ends STATUS: the program ends by itself with that status.
ends() {
    until_true 120 "the end of the program" is_gone || return
    wait "$pid"
    local got=$?
    [[ $got == "$1" ]] || complain "exit status $got, not $1: $(cat err)"
    pid=''
}

# Without a window `import` would wait for a click.
shot() { timeout 20 import -window "$window" "$1.ppm"; }

# home: the pointer goes where its outline is not in the way of comparisons.
home() {
    xdotool mousemove $((X + 340)) $((Y + 400)) # else, if it is there, it would not be seen to move
    xdotool mousemove $((X + 330)) $((Y + 400))
    settle
}

# rest: wait until the window has dealt with every event so far and has nothing left to compute or to draw
# (ui/app/idle_probe.h), or has ended; however long that takes on a busy machine.
answers() { grep -c '^at rest ' err; }
has_answered() { is_gone || [[ $(answers) -gt $1 ]]; }
rest() {
    local before
    before=$(answers)
    printf . >&"$asking"
    until_true 120 "the window at rest" has_answered "$before"
}

# settle: the same, and two pictures in a row are the same: small pictures in lists come a moment later.
settle() {
    local end=$((SECONDS + 120))
    rest
    is_gone && return
    shot settled
    while :; do
        rest
        is_gone && return
        cp settled.ppm settling.ppm
        shot settled
        cmp -s settling.ppm settled.ppm && return
        [[ $SECONDS -lt $end ]] || { complain "the window does not come to rest"; return; }
    done
}

# differs A B GEOMETRY: how many pixels of that part differ.
differs() {
    convert "$1.ppm" -crop "$3" +repage a.ppm
    convert "$2.ppm" -crop "$3" +repage b.ppm
    compare -metric AE a.ppm b.ppm null: 2>&1
}

# drag X Y DX DY STEPS: press the left button, move in steps, let go.
drag() {
    xdotool mousemove $((X + $1)) $((Y + $2))
    xdotool mousedown 1
    for ((i = 0; i < $5; i++)); do xdotool mousemove_relative -- "$3" "$4"; done
    xdotool mouseup 1
}

hash_of() { "$program" inspect "$1" --json | sed -n 's/.*"hash":"\([0-9a-f]*\)".*/\1/p'; }
title_is() { [[ $(xdotool getwindowname "$window" 2>/dev/null) == "$1 - Wrinkle" ]]; }

file_is_there() { [[ -s $1 ]]; }
shows_dialog() {
    shot asking
    changed=$(differs unasked asking 400x200+400+270)
    [[ ${changed%.*} -gt 20000 ]]
}
# answer_file NAME KEY: ask for a file by hand, and wait until it is there.
answer_file() {
    shot unasked
    xdotool key "$2"
    until_true 120 "the question for a file" shows_dialog || return
    rest
    key ctrl+a
    xdotool type --delay 20 "$folder/$1"
    rest
    xdotool key Return
    until_true 120 "the file $1" file_is_there "$1"
}
# save_as NAME [KEY]
save_as() {
    answer_file "$1" "${2:-ctrl+shift+s}" || return
    until_true 120 "the title of $1" title_is "$1"
}

# ---- one key, one click, and the command that comes of them ----
key() {
    xdotool key "$1"
    rest
}
click() {
    xdotool mousemove $((X + $1)) $((Y + $2))
    rest
    xdotool click 1
    rest
}
# search WORDS: run the action that is found first. Enter with nothing typed runs none.
search() {
    key ctrl+Return
    key Return
    xdotool type --delay 30 "$1"
    rest
    key Return
}
# row WORDS: the row that a search finds first; row_x, row_end and row_y are then its ends and the height of its middle.
row() {
    local left top width height
    row_x='' row_y=''
    key ctrl+Return
    xdotool type --delay 20 "$1"
    rest
    key Return
    read -r _ _ _ _ left top width height < <(grep '^at rest .* row ' err | tail -n 1)
    [[ $(tail -n 1 err) == *row* ]] || { complain "no row is found by: $1"; return 1; }
    export row_x=$left row_end=$((left + width)) row_y=$((top + height / 2))
}
# The newest command that the journal holds, a stroke by its beginning, a generator layer by its line.
newest() {
    local line
    line=$(sed -nE 's/^[0-9a-f]+ [0-9]+ [cb] //p' state/wrinkle/journals/*.wj 2>/dev/null | tail -n 1)
    if [[ $line =~ ^layer\ (add|set)\ .*from=\"(.*)\"( blend=[a-z-]+\ radius=[0-9.e-]+)?$ ]]; then
        line=${BASH_REMATCH[2]}
        line=${line//\\\\/\\} # the journal's own escapes
        line=${line//\\\\/$'\1'}
        line=${line//\\\"/\"} # quotes within quotes
        line=${line//$'\1'/\\}
    fi
    printf '%s\n' "$line"
}
# shellcheck disable=SC2053 # a pattern
newest_is() { [[ $(newest) == $1 ]]; }
# becomes PATTERN WHAT: the newest command comes to look like that.
becomes() {
    until_true 120 "$2" newest_is "$1" || complain "the newest command is: $(newest)"
}
