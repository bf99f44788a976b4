#!/usr/bin/env bash
# pictures.sh PROGRAM [NAME.wrinkle...] - makes the picture NAME.jpg of each starter, or only of those named, for the dialog
# of starters; and the sheet of all of them in the guide.
set -euo pipefail
program=$(realpath "${1:?pictures.sh PROGRAM [NAME...]}")
shift
cd "$(dirname "$0")"
[[ $# -gt 0 ]] || set -- *.wrinkle
for script in "$@"; do
    "$program" render "${script%.wrinkle}.wrinkle" -o "${script%.wrinkle}.jpg" --size 240x240
done
montage ./*.jpg -resize 160x160 -tile 5x -geometry +2+2 -background "#323232" -quality 88 ../../ui/guide/pictures/starters.jpg
