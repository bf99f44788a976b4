#!/usr/bin/env bash
# What is no file is refused wherever a file can be named, at once and by what it is: every way to name one
# meets every kind of thing that can stand there, under a watchdog. The source has one door for such names,
# and nothing passes by it. An interrupt ends the program even where it does not listen.
# doors.sh SOURCE-FOLDER PROGRAM HANG-LIBRARY
set -uo pipefail
source=$1 program=$2 hang=$3
folder=$(mktemp -d) || exit 1
pipe_holder=
trap '[[ -z $pipe_holder ]] || kill "$pipe_holder" 2>/dev/null; rm -rf "$folder"' EXIT
export WRINKLE_STATE=$folder/state XDG_CONFIG_HOME=$folder/config XDG_DATA_HOME=$folder/data
failures=0

complain() {
    printf '%s\n' "$*"
    failures=$((failures + 1))
}

# ---- the source ----

# Names of our own making: files that are being made in folders of ours, what they and their folders are synced by, the
# lock of the settings, and the pipe that a test asks the window by. src/system opens what it is told to, and what the
# system tells about this process.
allowed='WR_OPEN_NEW|base/file\.c:[0-9]+:    int fd = wr_fd_open\(group->list, how\)|(target|journal)->temporary, how\)|fdopen\(|base/file\.c:[0-9]+:    int fd = wr_fd_open\(path, (how|WR_OPEN_WRITE \| WR_OPEN_CREATE \| WR_OPEN_EMPTY) \| WR_OPEN_NO_WAIT\)'
allowed+='|ui/app/idle_probe\.c:[0-9]+:    int fifo|ui/app/state/settings\.c:[0-9]+:    int fd = path \? wr_fd_open\(path, how\)'
allowed+='|(base/file|document/recovery_journal)\.c:[0-9]+:    int fd = wr_fd_open\((path|folder), WR_OPEN_READ\);'
passing=$(cd "$source" && grep -nE '(^|[^a-z_.>])(wr_fd_open|f?open(at)?(64)?|freopen|ifstream[^;]*)\(' -r src ui \
    --exclude-dir=system --include='*.c' --include='*.cpp' --include='*.h' --include='*.hpp' | grep -vE "$allowed" |
    grep -vE ':\s*(\*|/\*|//)')
[[ -z $passing ]] || complain "opened past wr_file_open: $passing"

# ---- every way to name a file, every thing that is none ----

cd "$folder" || exit 1
mkfifo pipe
mkdir things
ln -s ../pipe things/link
ln -s /dev/zero things/zero
mkdir folder.exr
python3 -c 'import socket; socket.socket(socket.AF_UNIX).bind("socket")' 2>/dev/null
# A pipe that gives for ever to whoever reads it.
(while :; do printf 'dab 0.5,0.5\n'; done) >pipe 2>/dev/null &
pipe_holder=$!

sanitized=no
nm -D "$program" | grep -q __asan_init && sanitized=yes
things=(/dev/zero:device "$folder/things/link:pipe" "$folder/folder.exr:folder")
# A program with checks takes its time to begin: one thing, by which every way is gone once.
[[ $sanitized == no ]] || things=("$folder/things/link:pipe")
if [[ ${WR_FULL:-0} == 1 ]]; then
    things+=(/dev/full:device /dev/tty:device /dev/urandom:device "$folder/pipe:pipe" "$folder/things/zero:device")
    [[ -S socket ]] && things+=("$folder/socket:socket")
fi

# A line of a script for each command that takes a file; FILE stands for its name. TEXT@ENDING: through a link
# of that ending, by which the program chooses how to read.
lines=('open FILE' 'image FILE' 'colour FILE' 'normalmap FILE' 'picture photo FILE' 'picture normals FILE' 'picture paste FILE' 'layer paste FILE'
       'terrain elevation FILE' 'terrain elevation FILE@r16' 'terrain elevation FILE@r32' 'solid mesh FILE'
       'solid mesh FILE@ply' 'solid mesh FILE@gltf' 'text ab file=FILE' 'text ab file=FILE@ttf'
       'text ab fallback=FILE missing=sign' 'text ab fallback3=FILE'
       'stroke points=0.5,0.5 preset=FILE@myb' 'stroke points=0.5,0.5 tip=FILE@gbr'
       'stroke points=0.5,0.5 tip=FILE@gih' 'stroke points=0.5,0.5 tip=FILE@png' 'open FILE@ora'
       'open FILE@exr' 'open FILE@wrinkle' 'image FILE@exr' 'image FILE@tif')
# Subcommands likewise.
words=('inspect FILE' 'inspect FILE@wrinkle' 'inspect FILE@ora' 'run FILE' 'run FILE@wrinkle' 'explain FILE'
       'render FILE -o out.png' 'export FILE --as height -o out.png')

# name TEXT THING: TEXT with the thing's name, through a link where it asks for an ending.
name() {
    local text=$1 thing=$2 ending
    if [[ $text =~ FILE@([a-z0-9]+) ]]; then
        ending=${BASH_REMATCH[1]}
        ln -sfn "$thing" "$folder/as.$ending"
        text=${text/FILE@$ending/$folder/as.$ending}
    fi
    printf '%s' "${text/FILE/$thing}"
}

# refused STATUS KIND WHAT: within the watchdog's time, with one sentence that says what it is.
refused() {
    local status=$1 kind=$2 what=$3
    if ((status >= 124)); then complain "ended by $status: $what"
    elif ((status == 0)); then complain "taken: $what"
    elif [[ $what == *preset=* ]] && grep -qF 'no brush preset' err; then : # by its own name it is no .myb file
    elif ! grep -qF "is a $kind" err; then complain "not refused as a $kind: $what: $(head -c 300 err)"
    fi
}

for pair in "${things[@]}"; do
    thing=${pair%:*} kind=${pair##*:}
    for line in "${lines[@]}"; do
        named=$(name "$line" "$thing")
        timeout -k 1 60 "$program" run - <<<"$named" >out 2>err
        refused $? "$kind" "$named"
    done
    for word in "${words[@]}"; do
        read -ra arguments <<<"$(name "$word" "$thing")"
        timeout -k 1 60 "$program" "${arguments[@]}" >out 2>err </dev/null
        refused $? "$kind" "${arguments[*]}"
    done
    # A recording of a pen and a document to be written; nothing is written to a device.
    printf 'save %s\n' "$(name 'FILE@exr' "$thing")" | timeout -k 1 60 "$program" run - >out 2>err
    status=$?
    ((status > 0 && status < 124)) || complain "save to $thing: $status"
done

# ---- files that say they have nothing and give without end, or wait ----

for thing in /proc/self/environ /proc/kmsg /proc/self/mem /sys/kernel/debug/tracing/trace_pipe; do
    [[ -e $thing ]] || continue
    for word in "inspect $thing" "inspect FILE@exr" "run $thing"; do
        read -ra arguments <<<"$(name "$word" "$thing")"
        timeout -k 1 60 "$program" "${arguments[@]}" >out 2>err </dev/null
        status=$?
        ((status < 124)) || complain "ended by $status: ${arguments[*]}"
    done
done

# ---- an interrupt where nobody listens ----

printf 'some bytes' >file.exr
if [[ $sanitized == yes ]]; then : # preloading needs care there
else
    for signal in TERM INT; do
        : >err
        LD_PRELOAD=$hang "$program" inspect file.exr >out 2>err &
        job=$!
        for ((i = 0; i < 1200; i++)); do
            grep -q hanging err && break
            sleep 0.05
        done
        kill "-$signal" "$job"
        for ((i = 0; i < 1200; i++)); do
            kill -0 "$job" 2>/dev/null || break
            sleep 0.05
        done
        kill -KILL "$job" 2>/dev/null
        wait "$job"
        status=$?
        [[ $status == 143 ]] || complain "hanging, interrupted by $signal: $status, not 143"
    done
fi

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
