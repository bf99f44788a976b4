#!/usr/bin/env bash
# `wrinkle brushes`: what it lists is there; the pictures of tips are what their scripts make; each of our
# own presets has its thumbnail, and it is what the program paints today.
# brushes.sh SOURCE-FOLDER PROGRAM
set -uo pipefail
source=$1 program=$2
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
export XDG_DATA_HOME=$folder/data WRINKLE_DATA=$source

bad=0
fail() {
    printf '%s\n' "$*"
    bad=1
}
# expect STATUS WORDS...: the subcommand ends so; what it says is in out and err.
expect() {
    local status=$1
    shift
    "$program" brushes "$@" >out 2>err
    local got=$?
    [[ $got -eq $status ]] || fail "brushes $*: status $got, not $status: $(head -c 300 err)"
}

# ---- the table of settings is the one that the documentation prints ----
expect 0 --settings
grep '^|' "$source/brushes/README.md" | cmp -s - out ||
    fail "brushes/README.md has another table than \`wrinkle brushes --settings\`"

# ---- lists ----
expect 0
for name in wrinkle mypaint2 mypaint1; do
    grep -qx "$name" out || fail "the list lacks the collection $name"
done
! grep -q 'cannot be read' out || fail "$(grep 'cannot be read' out)"
listed=$(grep -c '^    [^ ]' out)
own=$(find "$source/brushes" -maxdepth 1 -name '*.myb' | wc -l)
foreign=$(find /usr/share/mypaint-data/[12].0/brushes -name '*.myb' | wc -l)
[[ $own -ge 26 ]] || fail "only $own presets of our own"
[[ $listed -eq $((own + foreign)) ]] || fail "$listed presets listed; $own + $foreign are there"
expect 0 --json
[[ $(jq -s 'length' out) -eq $listed ]] || fail "as JSON there are $(jq -s length out), not $listed"
[[ $(jq -s 'map(.id) | unique | length' out) -eq $listed ]] || fail 'two presets have one id'
jq -se 'all(.[]; .brush.radius > 0 and (.brush.mode | length) > 2 and (.settings | type) == "array")' \
    out >/dev/null || fail 'a preset lacks its brush'
jq -se '[.[] | select(.collection == "wrinkle" and (.description | length) < 10)] == []' out \
    >/dev/null || fail 'one of our presets does not say what it is for'
jq -se 'map(.settings[].use) | unique == ["ignored", "mapped", "used"]' out >/dev/null ||
    fail 'settings are not used, mapped and ignored'

# ---- one preset ----
expect 0 mypaint2/classic/charcoal
grep -qx 'mypaint2/classic/charcoal' out || fail 'brushes NAME does not name it'
grep -qE '^    mode +raise$' out || fail 'brushes NAME lacks the mode'
grep -q 'settings that are left out: colour' out || fail 'brushes NAME lacks what is left out'
expect 1 mypaint2/classic/charcoall
grep -q 'charcoal' err || fail 'a wrong name is not answered by the nearest one'
expect 1 --collection nowhere
grep -q 'wrinkle' err || fail 'a wrong collection is not answered by those that there are'
expect 2 --sheeet x.png
expect 2 --collection wrinkle mypaint2/classic/charcoal
expect 1 mypaint2/classic/charcoal --sheet nowhere/sheet.png
expect 1 mypaint2/classic/charcoal --sheet sheet.unknown
expect 1 mypaint2/classic/charcoal --thumbnails nowhere

# ---- sheets ----
expect 0 --sheet sheet.png mypaint2/classic/charcoal mypaint2/classic/pencil
[[ $(identify -format '%z %[channels]' sheet.png) == '8 gray'* ]] || fail 'a sheet is not 8-bit grey'
# Background, samples and letters: more than the two greys of an empty one.
[[ $(identify -format '%k' sheet.png) -gt 40 ]] || fail 'a sheet of two presets is empty'

# ---- tips ----
count=0
for script in "$source"/brushes/tips/*.wrinkle; do
    name=$(basename "$script" .wrinkle)
    "$program" run "$script" >out 2>err || fail "$script: $(cat err)"
    "$program" inspect "$name.png" >new 2>err || fail "$name.png: $(cat err)"
    "$program" inspect "$source/brushes/$name.png" >kept 2>err || fail "brushes/$name.png: $(cat err)"
    cmp -s new kept || fail "brushes/$name.png is not what tips/$name.wrinkle makes"
    count=$((count + 1))
done
[[ $count -ge 8 ]] || fail "only $count tips"

# ---- thumbnails ----
# How far apart two pictures are, root mean square, 0..1. libmypaint's arithmetic may differ in its last
# bits from processor to processor, so a hundredth is allowed; two different presets differ by more.
apart() {
    compare -metric RMSE "$1" "$2" null: 2>&1 | sed -nE 's/.*\(([-0-9.e]+)\).*/\1/p'
}
less() {
    awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && a + 0 < b + 0) }'
}
mkdir made
expect 0 --thumbnails made
[[ $(find made -name '*_prev.png' | wc -l) -eq $own ]] || fail "$own presets, but not as many thumbnails"
for preset in "$source"/brushes/*.myb; do
    name=$(basename "$preset" .myb)
    [[ -s $source/brushes/${name}_prev.png ]] || fail "brushes/${name}_prev.png is missing"
    [[ $(identify -format '%wx%h' "made/${name}_prev.png") == 128x96 ]] || fail "$name: not 128x96"
    difference=$(apart "$source/brushes/${name}_prev.png" "made/${name}_prev.png")
    less "$difference" 0.01 || fail "brushes/${name}_prev.png is $difference off what $name paints"
done
for picture in "$source"/brushes/*_prev.png; do
    [[ -e ${picture%_prev.png}.myb ]] || fail "$picture: there is no such preset"
done
less "$(apart made/soft_prev.png made/groove_prev.png)" 0.01 && fail 'soft and groove look alike'
exit $bad
