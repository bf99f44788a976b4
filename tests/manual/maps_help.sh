# maps_help.sh - what maps_blender.sh and maps_povray.sh share: a folder of their own with a cell that has a letter, a bump
# and a dent. Sourced with their arguments, BUILD and the folder for pictures; makes `program`, `pictures` and `cell`.
# shellcheck shell=bash disable=SC2034

build=$(cd "$1" && pwd) || exit 1
program=$build/wrinkle
pictures=${2:-}
[[ -z $pictures ]] || pictures=$(cd "$pictures" && pwd) || exit 1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
cell='table 256x256
text "F" at=0.35,0.62 size=150
dab 0.75,0.3 radius=40 strength=0.8
dab 0.25,0.2 radius=30 strength=-0.8
adjust blur sigma=3
bump mode=blinn scheme=catmull height=0.02'
# needs TOOL...: they are there, or the test does not count.
needs() {
    local tool
    for tool in "$@"; do
        command -v "$tool" >/dev/null || { echo "${0##*/}: there is no $tool here"; exit 77; }
    done
}
