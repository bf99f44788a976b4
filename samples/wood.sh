#!/usr/bin/env bash
# wood.sh PROGRAM [FOLDER] - makes the two pictures that wood.wrinkle shows, as the lecture's exercise has them:
# wood-diffuse.jpg, the colour, and wood-normal.jpg, the normal map. ImageMagick's convert gives the grey its browns.
set -euo pipefail
program=${1:?usage: wood.sh PROGRAM [FOLDER]} folder=${2:-.}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
boards='pattern planks across=1 rows=3 rings=8 tilt=0 joint=2 bevel=3 seed=4'
fibres='noise perlin cells=3 rows=45 octaves=3 seed=9 blend=add'

# What is dark: rings, fibres, the gaps; no two boards are the same.
"$program" export --do 'table 384x384' --do "$boards wood=0.75 uneven=0.35" --do "$fibres amplitude=0.12" \
    --as height -o "$work/grey.png" >"$work/said"
convert -size 1x128 gradient:'#fad7a0-#c68642' gradient:'#c68642-#45230f' -append -rotate 180 "$work/browns.png"
convert "$work/grey.png" -depth 8 "$work/browns.png" -clut -quality 88 "$folder/wood-diffuse.jpg"

# What is felt: the same boards, the rings hardly, the gaps well.
"$program" export --do 'table 384x384' --do "$boards wood=0.12 uneven=0.1" --do "$fibres amplitude=0.02" --do 'bump height=0.02 scheme=bspline' \
    --as normal+y -o "$folder/wood-normal.jpg" >>"$work/said"
