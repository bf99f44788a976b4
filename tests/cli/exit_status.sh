#!/usr/bin/env bash
# The exit status of every subcommand, as the guide's one table has them: 0 done, 1 failed, 2 wrong line, 130
# interrupted.  exit_status.sh PROGRAM [SANITIZER]
set -uo pipefail
program=$1
folder=$(mktemp -d) && cd "$folder" || exit 1
child=
trap '[[ -z $child ]] || kill -9 "$child" 2>/dev/null; rm -rf "$folder"' EXIT
export WRINKLE_STATE=$folder/state XDG_CONFIG_HOME=$folder/config HOME=$folder
unset DISPLAY WAYLAND_DISPLAY
bad=0
complain() { printf 'exit_status: %s\n' "$*"; bad=1; }

printf 'table 16x12\nfill 0.5\n' >a.wrinkle
"$program" export a.wrinkle --as height -o a.png >/dev/null || complain 'no picture'
printf 'table 16x12\nnonsense\n' >wrong.wrinkle
{ # minutes of work
    echo 'table 4096x4096'
    for seed in {1..500}; do echo "noise perlin cells=64 seed=$seed octaves=8"; done
} >slow.wrinkle

# status STATUS LINE
status() {
    local got
    # shellcheck disable=SC2086
    "$program" $2 >out 2>err </dev/null
    got=$?
    [[ $got == "$1" ]] || complain "status $got, not $1: $2: $(head -c 300 err)"
    [[ $1 == 0 || $(tail -n 1 err) == 'wrinkle: '* ]] || complain "no message: $2: $(cat err)"
}
# True if the process is the program by now, or the benchmark's, and handles the request to end by itself.
handles() {
    local real
    real=$(readlink -f "$program")
    [[ $1 != bench* ]] || real+=-bench
    [[ $(readlink "/proc/$child/exe") == "$real" ]] &&
        [[ $((0x$(sed -n 's/^SigCgt:\t//p' "/proc/$child/status" 2>/dev/null || echo 0) & 1 << 14)) != 0 ]]
}
# interrupted LINE: ended while it works; its status would be 143 if the signal ended it.
interrupted() {
    local got
    # shellcheck disable=SC2086
    "$program" $1 >out 2>err </dev/null &
    child=$!
    until handles "${1# }" || ! kill -0 "$child" 2>/dev/null; do sleep 0.02; done
    sleep 0.5
    kill -0 "$child" 2>/dev/null || complain "it ended too soon: $1: $(head -c 300 err)"
    kill -TERM "$child" 2>/dev/null
    { wait "$child"; } 2>/dev/null
    got=$?
    child=
    [[ $got == 130 ]] || complain "status $got, not 130: $1: $(head -c 300 err)"
    [[ $(tail -n 1 err) == 'wrinkle: interrupted' ]] || complain "no message: $1: $(cat err)"
}

# subcommand | done | failed | wrong line | interrupted; -: cannot be so, or not without a window
table='
paint    | -                                     | paint --isa v9                         | paint --nosuch            | -
run      | run a.wrinkle --json                  | run wrong.wrinkle                      | run                       | run slow.wrinkle
render   | render a.wrinkle -o r.png --size 8x8  | render none.wrinkle -o r.png           | render a.wrinkle          | render slow.wrinkle -o r.png
export   | export a.wrinkle --as height -o h.png | export wrong.wrinkle --as height -o h.png | export a.wrinkle -o h.png | export slow.wrinkle --as height -o h.png
export   | export a.wrinkle a.png --as stl -o f/ | export a.wrinkle none --as stl -o f/   | export a.wrinkle a.png --as stl -o - | export slow.wrinkle a.wrinkle --as stl -o f/ -j 2
export   | export a.wrinkle --as height -o -     | export none --as height -o -           | export --as unreal -o -   | export slow.wrinkle --as height -o -
check    | check a.png --json                    | check none.png                         | check                     | check slow.wrinkle
inspect  | inspect a.wrinkle --json              | inspect wrong.wrinkle                  | inspect a.wrinkle --at    | inspect slow.wrinkle
explain  | explain a.wrinkle --json --size 8x8   | explain none.exr                       | explain --nosuch          | explain slow.wrinkle
accuracy | accuracy a.wrinkle --size 16x16 --axis light --runs 3 | accuracy --axis nosuch  | accuracy --plot           | accuracy slow.wrinkle
recover  | recover --json                        | recover 7 -o r.exr                     | recover --nosuch          | -
brushes  | brushes --json                        | brushes nosuch                         | brushes --sheet           | brushes --sheet s.png
bench    | bench --help                          | bench --size 5x                        | bench nosuch              | bench all
help     | help dab                              | help nosuch                            | help --completion         | -
'
# Under sanitizers a measurement takes longer than an interrupted program may go on.
[[ -z ${2:-} ]] || table=${table/bench all/-}
mkdir f
cp a.png b.png && table=${table//a.wrinkle a.png/a.wrinkle b.png}
while IFS='|' read -r name zero failed wrong stopped; do
    [[ -n ${name// /} ]] || continue
    [[ ${zero// /} == - ]] || status 0 "$zero"
    [[ ${failed// /} == - ]] || status 1 "$failed"
    [[ ${wrong// /} == - ]] || status 2 "$wrong"
    [[ ${stopped// /} == - ]] || interrupted "$stopped"
done <<<"$table"
# No subcommand is left out.
while read -r name; do
    grep -q "^$name " <<<"$table" || complain "$name is not in the table"
done < <("$program" --help | sed -nE '/^subcommands:/,/^$/s/^  ([a-z]+) .*/\1/p')
# Without a display there is no window: one message, which names the subcommand for pictures. SDL_VIDEODRIVER=dummy opens one.
# no_display WHY VARIABLE=VALUE...
no_display() {
    local got
    env -u SDL_VIDEODRIVER -u XDG_RUNTIME_DIR "${@:2}" timeout 300 "$program" a.wrinkle >out 2>err </dev/null
    got=$?
    [[ $got == 1 && ! -s out ]] || complain "status $got without a display: ${*:2}"
    [[ $(grep -c '^wrinkle: ' err) == 1 ]] && grep -q "there is no display ($1.*wrinkle render FILE -o PICTURE.*--do COMMAND" err ||
        complain "without a display: ${*:2}: $(cat err)"
}
if ! "$program" paint </dev/null 2>&1 | grep -q 'no window: try'; then
    no_display 'DISPLAY and WAYLAND_DISPLAY are not set' A=
    [[ $(wc -l <err) == 1 ]] || complain "not one line: $(cat err)"
    no_display 'DISPLAY and WAYLAND_DISPLAY are not set' XDG_SESSION_TYPE=wayland SDL_VIDEODRIVER= DISPLAY=
    no_display 'neither DISPLAY nor WAYLAND_DISPLAY names one' WAYLAND_DISPLAY=nosuch
    no_display 'neither DISPLAY nor WAYLAND_DISPLAY names one' DISPLAY=:4711
    SDL_VIDEODRIVER=dummy WRINKLE_TIMING=1 "$program" a.wrinkle >out 2>err </dev/null &
    child=$!
    until grep -q 'first picture' err || ! kill -0 "$child" 2>/dev/null; do sleep 0.05; done
    kill -0 "$child" 2>/dev/null || complain "no window by SDL_VIDEODRIVER=dummy: $(cat err)"
    kill -TERM "$child" 2>/dev/null
    wait "$child"
    child=
fi
[[ -z $(find . -name '.?*.part*') && ! -e r.exr ]] || complain "half-written files: $(find . -name '.?*')"
exit $bad
