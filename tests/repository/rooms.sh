#!/usr/bin/env bash
# A file includes its own room and the rooms that its own may use, never another; outside libraries
# stay in the rooms that wrap them.  rooms.sh SOURCE-FOLDER
set -uo pipefail
cd "$1" || exit 1

{
    find src ui -name '*.c' -o -name '*.h' -o -name '*.cpp' -o -name '*.hpp'
} | sort | xargs awk '
BEGIN {
    may["system"] = " system "
    base = " system base "
    may["base"] = base
    may["noise"] = may["image"] = base
    may["field"] = base "noise "
    may["surface"] = base "field "
    may["shade"] = base "field noise image "
    may["generate"] = base "field surface noise image "
    may["brush"] = base "field surface image "
    may["scene"] = base "field surface shade image "
    may["render"] = base "field noise image surface shade scene "
    may["accuracy"] = base "field image surface shade scene render "
    may["document"] = base "field scene image "
    may["hardcases"] = may["document"] "noise surface shade generate brush render accuracy document "
    may["export"] = base "field noise image surface shade scene render document "
    may["command"] = may["export"] "generate brush accuracy export "
    may["api"] = may["command"] "command "
    may["cli"] = may["api"] "hardcases api "
    # The rooms of the window, from the ground up: each knows those before it.
    ui = may["command"] "command hardcases "
    count = split("toolkit input app/jobs canvas patch/preview app/state canvas/overlays canvas/tools patch panels/generate panels/accuracy panels/help panels app", floor)
    for (i = 1; i <= count; i++) {
        may["ui/" floor[i]] = ui below
        below = below "ui/" floor[i] " "
    }
    # Libraries, by how their headers begin, and the rooms that may say so.
    library["SDL"] = "ui"
    library["imgui"] = "ui/toolkit"
    library["X11/"] = "ui/input ui/toolkit"
    library["wayland"] = library["tablet-unstable"] = "ui/input"
    library["OpenImageIO/"] = library["openexr"] = library["libdeflate"] = library["assimp/"] = library["librsvg/"] = "image"
    library["ft2build"] = library["freetype/"] = "image ui" # the type of the window is drawn with it too
    library["hb"] = library["fribidi"] = library["fontconfig/"] = library["zlib"] = "image"
    library["sleef"] = library["xxhash"] = library["sha2"] = "base"
    library["libmypaint"] = library["mypaint"] = "brush"
    library["dbus/"] = "ui/app/jobs"
    library["md4c"] = "ui/panels/help"
    library["json-c/"] = "brush image" # presets; what a glTF names
}
FNR == 1 {
    count = split(FILENAME, part, "/")
    room = room_of(FILENAME)
    if (!(room in may)) complain("is in a room that the table does not know")
}
# The room of a file as an #include names it; rooms of the window may stand in the folder of another.
function room_of(path,    piece, inner) {
    sub(/^src\//, "", path)
    split(path, piece, "/")
    if (piece[1] != "ui") return piece[1]
    inner = "ui/" piece[2] "/" piece[3]
    return inner in may ? inner : "ui/" piece[2]
}
# The room, or the whole of ui/.
function is_in(list) {
    return index(" " list " ", " " room " ") > 0 || index(" " list " ", " " part[1] " ") > 0
}
function complain(what) {
    printf "%s:%d: %s\n", FILENAME, FNR, what
    bad = 1
}
/^[ \t]*#[ \t]*include[ \t]*["<]/ {
    name = $0
    sub(/^[^"<]*["<]/, "", name)
    sub(/[">].*/, "", name)
    if ($0 ~ /"/) {
        seen++
        if (name == "ui/app/app.h" && room == "cli") next
        if (name !~ /\//) { complain("\"" name "\" is not written from src/"); next }
        to = room_of(name)
        if (to != room && index(may[room], " " to " ") == 0)
            complain("room " room " may not use " name)
    } else {
        for (start in library)
            if (index(name, start) == 1 && !is_in(library[start]))
                complain("only " library[start] " may include <" name ">")
    }
}
END {
    if (seen < 50) { printf "only %d includes found: is this the right folder?\n", seen; bad = 1 }
    exit bad
}'
bad=$?

# What is drawn on the window, and what textures hold, goes through one room, which knows what changed; ui/app/window.c tries
# whether there is a picture at all.
if find ui -name '*.c' -o -name '*.cpp' | grep -v '^ui/toolkit/\|^ui/app/window.c$' | sort |
    xargs grep -nE '\bSDL_(UpdateTexture|LockTexture|UnlockTexture|RenderCopy|RenderFill|RenderDraw|RenderGeometry|RenderClear|RenderPresent)'; then
    printf 'only ui/toolkit draws and changes textures\n'
    bad=1
fi
exit $bad
