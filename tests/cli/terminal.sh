#!/usr/bin/env bash
# On a terminal, what will take long is noted before it begins, and then how far it is and how long it still takes;
# into a file goes neither.  terminal.sh PROGRAM
set -uo pipefail
program=$1
folder=$(mktemp -d) || exit 1
talk='' failures=0
cleanup() {
    [[ -z $talk ]] || kill -KILL -- "-$talk" 2>/dev/null
    rm -rf "$folder"
}
trap cleanup EXIT
cd "$folder" || exit 1
export HOME=$folder XDG_STATE_HOME=$folder XDG_CONFIG_HOME=$folder XDG_DATA_HOME=$folder
command -v script >/dev/null || { echo 'script is missing: apt-get install bsdutils'; exit 1; }
complain() {
    printf '%s\n' "$*"
    failures=$((failures + 1))
}

# Nobody waits for the end of this: hours of work.
printf 'table 4096x4096\nnoise perlin cells=64 octaves=12 warp=0.3\nterrain hydraulic rain=64\n' >long.wrinkle

# says PATTERN COMMAND...: on a terminal the text comes to hold the pattern.
says() {
    local pattern=$1
    shift
    : >said
    setsid script -qefc "$*" said >/dev/null 2>&1 </dev/null &
    talk=$!
    local end=$((SECONDS + 300))
    until grep -qE "$pattern" said; do
        [[ $SECONDS -lt $end ]] || { complain "$*: no '$pattern': $(tr '\r' '\n' <said | tail -n 3)"; break; }
        sleep 0.1
    done
    kill -KILL -- "-$talk" 2>/dev/null
    { wait "$talk"; } 2>/dev/null
    talk=''
}
says '[0-9] %' "$program" run long.wrinkle
grep -qE 'note: noise perlin: needs [0-9.]+ [MG]B of memory' said || complain "its memory is not told before: $(cat said)"
# The time left comes only at a steady rate: frames that are all alike have one.
says '[0-9] %  [0-9]+:[0-9]{2} left' "$program" render -o "'f###.png'" --size 512x512 --frames 1-900 --do "'dials aa=supersample samples=16'"

# ---- into a file ----
printf 'table 1024x1024\nnoise perlin cells=64 octaves=12 warp=0.3\n' >short.wrinkle
"$program" run short.wrinkle >out 2>err || complain "it failed: $(cat err)"
! grep -qE 'needs|left$' err || complain "a file is told of it: $(cat err)"

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
