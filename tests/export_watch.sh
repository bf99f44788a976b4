#!/usr/bin/env bash
# export --watch: a set follows a script that is written, replaced and away for a moment; a wrong script ends it with a
# message over the old files, an interrupt without; it sleeps meanwhile.  export_watch.sh PROGRAM
set -uo pipefail
program=$1
folder=$(mktemp -d) && cd "$folder" || exit 1
child=
trap '[[ -z $child ]] || kill -9 "$child" 2>/dev/null; rm -rf "$folder"' EXIT
export WRINKLE_STATE=$folder/state XDG_CONFIG_HOME=$folder/config
bad=0
complain() { printf 'export_watch: %s\n' "$*"; bad=1; }

# until_true COMMAND...: a minute at most.
until_true() {
    local i
    for ((i = 0; i < 600; i++)); do
        "$@" && return
        kill -0 "$child" 2>/dev/null || break
        sleep 0.1
    done
    complain "never: $*: $(cat err)"
    return 1
}
wrote() { [[ $(grep -c '^out/T_tile_H.png: ' told) == "$1" ]]; }
waits() { [[ $(grep -c 'note: watching' err) == "$1" ]]; }
width() { identify -format '%w' out/T_tile_H.png; }
# expect TIMES WAITS WIDTH: so many sets so far, so many waits, the last so wide.
expect() {
    until_true waits "$2" && wrote "$1" || complain "not $1 sets but $(cat told)"
    [[ $(width) == "$3" ]] || complain "a set $(width) wide, not $3"
}

mkdir out
printf 'table 31x20\ngrid cells=4x3\n' >tile.wrinkle
(trap - INT; exec "$program" export tile.wrinkle --as unreal -o out --watch >told 2>err) &
child=$!
expect 1 1 31
printf 'table 33x20\ngrid cells=4x3\n' >tile.wrinkle
expect 2 2 33
printf 'table 35x20\ngrid cells=4x3\n' >new && mv new tile.wrinkle
expect 3 3 35
printf 'table 35x20\n# the same\ngrid cells=4x3\n' >tile.wrinkle # nothing is written
expect 3 4 35
rm tile.wrinkle && touch out/another
printf 'table 37x20\n' >tile.wrinkle
expect 4 5 37
ticks=$(awk '{ print $14 + $15 }' "/proc/$child/stat")
sleep 1
[[ $(awk '{ print $14 + $15 }' "/proc/$child/stat") -le $((ticks + 2)) ]] || complain 'it does not sleep'
sum=$(sha256sum out/*)
printf 'table 37x20\nnonsense\n' >tile.wrinkle
wait "$child"
[[ $? == 1 ]] || complain 'it does not end with 1'
child=
grep -q '^wrinkle: tile.wrinkle:2: unknown command "nonsense"' err || complain "it says: $(tail -n 1 err)"
[[ $(sha256sum out/*) == "$sum" ]] || complain 'an error changed files'
[[ -z $(find . -name '.?*') ]] || complain "something stays: $(find . -name '.?*')"

# What the script reads is looked at too: a picture in another folder, a brush's tip behind a link.
picture() { "$program" export --do "table $1" --do "dab 0.5,0.5 radius=$2 strength=1" --as height depth=8 -o "$3" 2>/dev/null >&2; }
mkdir other
picture 21x20 4 other/p.png && picture 9x9 2 other/tip.png && ln -s other/tip.png tip.png
printf 'image other/p.png\ndab 0.5,0.5 tip=tip.png radius=4 strength=1\n' >tile.wrinkle
(trap - INT; exec "$program" export tile.wrinkle --as unreal -o out --watch >told 2>err) &
child=$!
expect 1 1 21
picture 23x20 4 other/p.png
expect 2 2 23
picture 9x9 3 other/tip.png
expect 3 3 23
picture 25x20 4 new.png && mv new.png other/p.png
expect 4 4 25
kill -TERM "$child"
wait "$child"
child=

printf 'table 37x20\n' >tile.wrinkle
(trap - INT; exec "$program" export tile.wrinkle --as height -o one.png --watch >told 2>err) &
child=$!
until_true waits 1
kill -TERM "$child"
wait "$child"
[[ $? == 130 ]] || complain 'an interrupt does not end it with 130'
child=
"$program" export --as height -o one.png --watch 2>err
[[ $? == 2 ]] && grep -q 'needs FILE to watch' err || complain 'it watches no file'
"$program" export nowhere/a.wrinkle --as height -o one.png --watch 2>err
[[ $? == 1 ]] && grep -q 'cannot be watched (No such file' err || complain "a folder that is not there: $(cat err)"
exit $bad
