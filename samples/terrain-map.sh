#!/usr/bin/env bash
# terrain-map.sh PROGRAM [FOLDER] - makes terrain-map-colours.jpg, which terrain-map.wrinkle lays over its ground: water
# and meadows below, woods, rock and snow above. ImageMagick's convert gives the heights their colours.
set -euo pipefail
program=${1:?usage: terrain-map.sh PROGRAM [FOLDER]} folder=${2:-.} here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The ground as it is under the water too, a little uneven, so that no border of colours is a contour line.
grep -E '^(table|terrain) ' "$here/terrain-map.wrinkle" >"$work/ground.wrinkle"
"$program" export "$work/ground.wrinkle" --do 'noise perlin cells=24 octaves=3 amplitude=0.03 level=0 blend=add' \
    --as height range=0,1 -o "$work/grey.png" >"$work/said"
convert -size 1x86 gradient:'#17406a-#4b93a6' -size 1x7 gradient:'#d9cf9c-#a9b36a' -size 1x55 gradient:'#7f9c4a-#3f6b34' \
    -size 1x50 gradient:'#56693c-#8a7a5e' -size 1x32 gradient:'#8d8072-#b3aca4' -size 1x26 gradient:'#e6e9ee-#ffffff' \
    -append "$work/colours.png"
convert "$work/grey.png" -depth 8 "$work/colours.png" -clut -quality 88 "$folder/terrain-map-colours.jpg"
