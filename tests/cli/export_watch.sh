#!/usr/bin/env bash
# export --watch: a set follows a script that is written, replaced and away for a moment; a wrong script leaves the
# old files, with a message, and the next right one replaces them; an interrupt ends it; it sleeps meanwhile.  export_watch.sh PROGRAM
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
until_true waits 6
grep -q '^wrinkle: tile.wrinkle:2: unknown command "nonsense"' err || complain "it says: $(tail -n 2 err)"
grep -q 'note: watching: the files written last stay' err || complain 'it does not say what stays'
[[ $(sha256sum out/*) == "$sum" ]] || complain 'an error changed files'
[[ -z $(find . -name '.?*') ]] || complain "something stays: $(find . -name '.?*')"
printf 'table 37x20\nimage nowhere.png\n' >tile.wrinkle # another error, then the old content: nothing to write
until_true waits 7
printf 'table 37x20\n' >tile.wrinkle
expect 4 8 37
printf 'table 39x20\n' >tile.wrinkle
expect 5 9 39
rm -r out && : >out # a folder that cannot be written to is no end either, and the same content is tried again
printf 'table 41x20\n' >tile.wrinkle
until_true waits 10
rm out && mkdir out
printf 'table 41x20 # once more\n' >tile.wrinkle
expect 6 11 41
kill -TERM "$child"
wait "$child"
child=

# A script that is wrong from the beginning is waited for; a shell line that is wrong is not.
printf 'table 43x\n' >tile.wrinkle
(trap - INT; exec "$program" export tile.wrinkle --as unreal -o out --watch >told 2>err) &
child=$!
until_true waits 1
printf 'table 43x20\n' >tile.wrinkle
expect 1 2 43
kill -TERM "$child"
wait "$child"
child=
timeout 60 "$program" export tile.wrinkle --as unrael -o out --watch >told 2>err
[[ $? == 1 ]] && grep -q 'did you mean unreal' err || complain "a wrong kind: $(cat err)"
timeout 60 "$program" export tile.wrinkle --as unreal --do nonsense -o out --watch >told 2>err
[[ $? == 1 ]] && grep -q 'unknown command "nonsense"' err || complain "a wrong --do: $(cat err)"
timeout 60 "$program" export none.wrinkle --as unreal -o out --watch >told 2>err
[[ $? == 1 ]] && grep -q 'none.wrinkle: No such file' err || complain "no file: $(cat err)"

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
printf 'no picture' >other/p.png # reported once, not again and again
until_true waits 5
sleep 1
[[ $(grep -c '^wrinkle: tile.wrinkle:1: image' err) == 1 ]] || complain "a broken picture: $(cat err)"
picture 27x20 4 new.png && mv new.png other/p.png
expect 5 6 27
rm other/p.png # a picture that is gone is no reason to wait where the script no longer needs it
printf 'table 29x20\n' >tile.wrinkle
expect 6 7 29
printf 'tabel 29x20\n' >tile.wrinkle
until_true waits 8
grep -q '^wrinkle: tile.wrinkle:1: unknown command "tabel"' err || complain "a typo: $(tail -n 2 err)"
printf 'table 31x20\n' >tile.wrinkle
expect 7 9 31
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
