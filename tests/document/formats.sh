#!/usr/bin/env bash
# Files of earlier versions, kept in formats/, open as they were written; a document of a newer version opens with one note, and is not
# replaced.  formats.sh PROGRAM SOURCE-FOLDER
#
# document.wrinkle says the heights of all documents: u/2 + v/4, plus half of 1/8, plus 1/4, at the centre of each texel; they are
# exact in 32 bits. plain.exr and mesh.exr have the first sum alone.
set -uo pipefail
program=$1 kept=$2/tests/document/formats
folder=$(mktemp -d) && cd "$folder" || exit 1
child=
trap '[[ -z $child ]] || kill -9 "$child" 2>/dev/null; rm -rf "$folder"' EXIT
export WRINKLE_STATE=$folder/state XDG_CONFIG_HOME=$folder/config XDG_DATA_HOME=$folder/data HOME=$folder
unset DISPLAY WAYLAND_DISPLAY
bad=0
complain() { printf 'formats: %s\n' "$*"; bad=1; }

# are RAW CONSTANT WHAT: exported floats are u/2 + v/4 + CONSTANT, bit for bit. Rows begin at the top, v = 1.
are() {
    od -An -v -t f4 -w4 "$1" | awk -v constant="$2" '
        {
            x = (NR - 1) % 8
            y = int((NR - 1) / 8)
            want = (x + 0.5) / 16 + (3.5 - y) / 16 + constant
            if ($1 != want) { printf "(%d, %d) is %s, not %s\n", x, y, $1, want; bad = 1 }
        }
        END { exit bad || NR != 32 }' >wrong || complain "$3: $(head -n 3 wrong)"
}
# heights FILE CONSTANT: those of the composite.
heights() {
    "$program" export "$1" --as height -o h.r32 >out 2>err || { complain "$1 does not open: $(cat err)"; return; }
    are h.r32 "$2" "$1"
}
heights "$kept/plain.exr" 0
heights "$kept/mesh.exr" 0
for file in document.exr document.ora document.wrinkle history.wrinkle; do
    heights "$kept/$file" 0.3125
    # The group's members are there, and the generator layer keeps its command.
    open="open $kept/$file"
    [[ $file != *.wrinkle ]] || open="macro $kept/$file"
    printf '%s\nlayer set constant change="c=0,0,0.5"\nsave again.exr\n' "$open" >change.wrinkle
    "$program" run change.wrinkle >out 2>err || complain "$file: its generator does not change: $(cat err)"
    heights again.exr 0.5625
done
# The four files are one document.
hashes=$(for file in document.exr document.ora document.wrinkle history.wrinkle; do
    "$program" inspect "$kept/$file" --json 2>/dev/null | jq -r '.layers, .hash' | tr -d '\n'
    echo
done | sort -u | wc -l)
[[ $hashes == 1 ]] || complain "the kept files are $hashes different documents"

# ---- each version of the two formats, N.exr and N.ora ----
# 1.exr and 2.exr are of the programs of those versions, the others of 1.0.0, which writes the lowest version that can hold a document:
# 3 one layer; 4 a mesh; 5, 2.ora a normal map; 6 surroundings; 7, 3.ora the cell's size; 8, 4.ora a picture of roughness; 5.ora a
# hidden filter layer; 9, 6.ora a filter layer; 10, 7.ora the projection of a mesh; 11, 8.ora a generator layer; 12, 9.ora a group;
# 13, 10.ora a view of colours.
# Saved again, each needs the same version: without its feature it would need a lower one.
version_of() {
    case $1 in
    *.exr) LC_ALL=C grep -aoP 'wrinkle:version\x00string\x00[\x01-\x03]\x00\x00\x00\K[0-9]+' "$1" | head -n 1 ;;
    *) python3 -c 'import sys, zipfile; print(zipfile.ZipFile(sys.argv[1]).read("stack.xml").decode())' "$1" | sed -n 's/.*wrinkle:version="\([0-9]*\)".*/\1/p' | head -n 1 ;;
    esac
}
for file in "$kept"/[0-9]*; do
    name=$(basename "$file") constant=0
    case $name in
    2.exr | 12.exr | 9.ora) constant=0.0625 ;; # half of 1/8
    11.exr | 8.ora) constant=0.25 ;;
    esac
    [[ $(version_of "$file") == "${name%.*}" ]] || complain "$name is of version $(version_of "$file")"
    again=again.${name##*.}
    printf '%s\n' "open $file" 'export height a.r32' "save $again" "open $again" 'export height b.r32' >again.wrinkle
    "$program" run again.wrinkle >out 2>err || { complain "$name is not saved again: $(cat err)"; continue; }
    are a.r32 $constant "$name"
    are b.r32 $constant "$name, saved again"
    again=$(version_of "$again") same=${name%.*}
    [[ $name != 1.exr ]] || same=3 # of one layer
    [[ $again == "$same" ]] || complain "$name: saved again it is of version $again"
done
[[ $(find "$kept" -name '[0-9]*.exr' | wc -l) == $(sed -n 's/^#define WR_DOCUMENT_VERSION \([0-9]*\)$/\1/p' "$2/src/document/document_file.h") ]] ||
    complain 'not one EXR document of each version'
[[ $(find "$kept" -name '[0-9]*.ora' | wc -l) == $(sed -n 's/^#define WR_ORA_VERSION \([0-9]*\).*/\1/p' "$2/src/document/ora.h") ]] ||
    complain 'not one OpenRaster document of each version'

# The mesh: a square from -1 to 1 in the plane of x and z, seen from its side; its file is not needed.
"$program" inspect "$kept/mesh.exr" --at 0.5,0.5 >out 2>err || complain "mesh.exr: $(cat err)"
awk '$1 == "n" { n = $3 * $3 } $1 == "P" && $2 * $2 == 1 && $3 == 0 && $4 * $4 == 1 { p = 1 } END { exit !(n == 1 && p) }' out ||
    complain "mesh.exr: its corner or normal is lost: $(grep -E '^(P|n) ' out)"

# The brush: a dab raises heights near its centre, and none beyond its radius.
printf 'table 64x64\nstroke preset=%s radius=8 strength=0.5 points=0.5,0.5\nexport height dab.exr\n' "$kept/brush.myb" >dab.wrinkle
"$program" run dab.wrinkle >out 2>err || complain "brush.myb: $(cat err)"
oiiotool --dumpdata dab.exr | awk '/Pixel/ { gsub(/[(),:]/, " "); far = ($2 - 31.5) ^ 2 + ($3 - 31.5) ^ 2
    if (far > 400 && $4 != 0) bad = 1
    if (far < 2 && $4 > 0) near = 1 } END { exit bad || !near }' || complain 'brush.myb paints another dab'

# The settings: values stay over a session of the window, and lines of another version do not stop it.
if ! "$program" paint </dev/null 2>&1 | grep -q 'no window: try'; then
    mkdir -p config/wrinkle
    { cat "$kept/window.conf"; echo 'of_a_later_version 7 words'; } >config/wrinkle/window.conf
    touch -d '2020-01-01' config/wrinkle/window.conf
    : >err
    SDL_VIDEODRIVER=dummy WRINKLE_TIMING=1 "$program" "$kept/plain.exr" >out 2>err </dev/null &
    child=$!
    until grep -q 'first picture' err || ! kill -0 "$child" 2>/dev/null; do sleep 0.05; done
    kill -TERM "$child" 2>/dev/null
    wait "$child" || complain "the window with settings of 1.0.0: $(cat err)"
    child=
    ! grep '^wrinkle: ' err || complain 'messages with settings of 1.0.0'
    [[ $(find config/wrinkle/window.conf -newermt 2021-01-01) ]] || complain 'the settings were not written'
    for line in 'theme 1' 'radius 23.5' 'hardness 0.75'; do
        grep -qx "$line" config/wrinkle/window.conf || complain "the setting '$line' is lost: $(grep "^${line% *} " config/wrinkle/window.conf)"
    done
fi

# ---- newer versions: one note, and no saving over the file ----
python3 - "$kept" <<'PYTHON'
import sys, zipfile
kept = sys.argv[1]
exr = open(kept + '/document.exr', 'rb').read()
old, new = (b'wrinkle:version\0string\0\x02\0\0\0' + version for version in (b'12', b'99'))
assert exr.count(old) == 1
open('newer.exr', 'wb').write(exr.replace(old, new))
with zipfile.ZipFile(kept + '/document.ora') as ora, zipfile.ZipFile('newer.ora', 'w') as out:
    for entry in ora.infolist():
        content = ora.read(entry)
        if entry.filename == 'stack.xml':
            assert content.count(b'wrinkle:version="9"') == 1
            content = content.replace(b'wrinkle:version="9"', b'wrinkle:version="99"')
        out.writestr(entry, content)
PYTHON
for file in newer.exr newer.ora; do
    heights $file 0.3125
    [[ $(grep -c 'newer version' err) == 1 ]] && grep -q "$file: was saved by a newer version of the program (document version 99" err ||
        complain "$file: $(cat err)"
    cp $file before
    printf 'open %s\nlayer set 1 opacity=0.5\nsave %s\n' $file $file >over.wrinkle
    "$program" run over.wrinkle >out 2>err && complain "$file is replaced"
    [[ $(tail -n 1 err) == *"newer version"* ]] || complain "$file: $(tail -n 1 err)"
    cmp -s $file before || complain "$file has changed"
done
printf 'table 8x4\nunheard of\n' >newer.wrinkle
"$program" render newer.wrinkle -o n.png >out 2>err && complain 'an unknown command is skipped'
[[ $(wc -l <err) == 1 ]] && grep -q 'newer\.wrinkle:2: .*unheard' err || complain "newer.wrinkle: $(cat err)"
sed 's/"version": 3/"version": 4/' "$kept/brush.myb" >newer.myb
printf 'table 64x64\nstroke preset=newer.myb points=0.5,0.5\n' >dab.wrinkle
"$program" run dab.wrinkle >out 2>err && complain 'a brush of a newer version is read'
[[ $(wc -l <err) == 1 ]] && grep -q 'newer\.myb.*version' err || complain "newer.myb: $(cat err)"
exit $bad
