#!/usr/bin/env bash
# The desktop's files: valid metadata, icons that show the drawing, and a desktop entry with a type for each kind of file that the
# program opens by its name, recognised by name and, for our own types, by content.  desktop.sh SOURCE-FOLDER
set -uo pipefail
cd "$1" || exit 1
desktop=$PWD/ui/desktop
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
bad=0
complain() {
    printf '%s\n' "$*"
    bad=1
}

appstreamcli validate --no-net "$desktop/org.wrinkle.Wrinkle.metainfo.xml" >"$folder/log" 2>&1 || complain "$(cat "$folder/log")"
desktop-file-validate "$desktop/wrinkle.desktop" || complain 'the desktop entry is not valid'
version=$(sed -nE 's/^project\(wrinkle VERSION ([0-9.]+) .*/\1/p' CMakeLists.txt)
released=$(sed -nE '0,/<release /s/.*<release version="([0-9.]+)".*/\1/p' "$desktop/org.wrinkle.Wrinkle.metainfo.xml")
# Before a release the metadata may be one ahead; afterwards they agree.
[[ $(printf '%s\n' "$version" "$released" | sort -V | tail -n 1) == "$released" ]] ||
    complain "the newest release in the metadata is $released, the program's version $version"
[[ -f $desktop/$(sed -nE 's/.*<launchable type="desktop-id">(.*)<.*/\1/p' "$desktop/org.wrinkle.Wrinkle.metainfo.xml") ]] ||
    complain 'the metadata name no desktop entry'

# ---- types ----

# The extensions that the program opens: pictures and documents of the Open dialog, meshes, brushes.
list() { # FILE NAME: the strings of this table
    tr '\n' ' ' <"$1" | sed 's/\\//g' | grep -oE "$2[^;#]*" | head -n 1 | grep -oE '"[a-z0-9]+"' | tr -d '"'
}
endings=$(
    list ui/app/jobs/files.c '#define PICTURES'
    list ui/app/jobs/files.c 'documents\[\] = '
    list src/image/mesh.h '#define WR_MESH_ENDINGS'
    echo myb
)
endings=$(sort -u <<<"$endings")
[[ $(wc -w <<<"$endings") -ge 35 ]] || complain "only these extensions were found: $endings"
# No desktop has a type for these.
untyped=' 3ds dae dpx fbx hdr lwo off pfm x3d '

mkdir -p "$folder/data/mime/packages"
cp "$desktop/wrinkle-mime.xml" "$folder/data/mime/packages/wrinkle.xml"
xmllint --noout "$desktop/wrinkle-mime.xml" || complain 'the MIME types are not valid XML'
shared=''
folders=${XDG_DATA_DIRS:-/usr/local/share:/usr/share}
for place in ${folders//:/ }; do
    [[ ! -f $place/mime/globs2 ]] || shared+=" $place/mime/globs2"
done
[[ -n $shared ]] || { complain 'shared-mime-info is not installed'; exit 1; }
update-mime-database "$folder/data/mime" >"$folder/log" 2>&1 || complain "$(cat "$folder/log")"
entry=";$(sed -n 's/^MimeType=//p' "$desktop/wrinkle.desktop")"
used=' '
for ending in $endings; do
    # shellcheck disable=SC2086
    types=$(grep -hE ":\*\.$ending(:cs)?\$" $shared "$folder/data/mime/globs2" | cut -d: -f2 | sort -u)
    named=no
    for type in $types; do
        [[ $entry != *";$type;"* ]] || { named=yes used+="$type "; }
    done
    if [[ $untyped == *" $ending "* ]]; then continue; fi
    [[ $named == yes ]] || complain "the desktop entry has no type of .$ending: $(tr '\n' ' ' <<<"$types")"
done
IFS=';' read -ra types <<<"${entry#;}"
for type in "${types[@]}"; do
    [[ $used == *" $type "* ]] || complain "the desktop entry has $type, of no file that the program opens"
done

# By content, without an extension: our own types.
for sample in samples/bricks.wrinkle:application/x-wrinkle samples/stone.ply:model/x-ply brushes/chain.myb:application/x-mypaint-brush; do
    cp "${sample%:*}" "$folder/sample"
    kind=$(XDG_DATA_HOME=$folder/data python3 - "$folder/data/mime/magic" "$folder/sample" <<'PYTHON'
import re, sys
# The binary form of the magic: [priority:type], then lines INDENT>OFFSET=LENGTH VALUE[+RANGE].
magic, content = open(sys.argv[1], 'rb').read(), open(sys.argv[2], 'rb').read()
at, kind, path, found = 12, '', [], ''
while at < len(magic):
    if magic[at:at + 1] == b'[':
        end = magic.index(b']\n', at)
        kind, path = magic[at + 1:end].decode().split(':')[1], []
        at = end + 2
        continue
    head = re.compile(rb'(\d*)>(\d+)=').match(magic, at)
    indent, offset = int(head[1] or 0), int(head[2])
    at = head.end()
    length = int.from_bytes(magic[at:at + 2], 'big')
    value = magic[at + 2:at + 2 + length]
    at += 2 + length
    tail = re.compile(rb'(?:~\d+)?(?:\+(\d+))?\n').match(magic, at)
    at, spread = tail.end(), int(tail[1] or 1)
    hit = any(content[o:o + length] == value for o in range(offset, offset + spread))
    path = path[:indent] + [hit]
    last = not re.compile(rb'%d>' % (indent + 1)).match(magic, at)
    if last and all(path): found = kind
print(found)
PYTHON
    )
    [[ $kind == "${sample#*:}" ]] || complain "${sample%:*}: by its content $kind, not ${sample#*:}"
done

# ---- icons ----

if command -v rsvg-convert >/dev/null && command -v compare >/dev/null; then
    bash "$desktop/icons.sh" "$folder/icons"
    for icon in "$folder"/icons/*.png; do
        # Versions of the renderer differ a little at edges: at most 1 % of the pixels by more than 10 %.
        size=$(identify -format %w "$icon")
        off=$(compare -metric AE -fuzz 10% "$icon" "$desktop/icons/${icon##*/}" null: 2>&1)
        [[ ${off%%[!0-9]*} -le $((size * size / 100)) ]] || complain "ui/desktop/icons/${icon##*/} differs from ui/icon.svg in $off pixels: bash ui/desktop/icons.sh"
    done
fi
exit $bad
