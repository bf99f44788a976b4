#!/usr/bin/env bash
# Draw the pictures of the cells, or of those named: bash samples/cells/make.sh PROGRAM [NAME...]
set -eu
program=$(realpath "$1")
shift
cd "$(dirname "$0")"
[[ $# -gt 0 ]] || set -- *.wrinkle
for cell; do
    name=$(basename "$cell" .wrinkle)
    "$program" render "$name.wrinkle" --size 192x192 -o "$name.png" --do 'surface plane' --do 'replicate 1,1' \
        --do 'camera orthographic size=0.996' --do 'light clear' --do 'light directional to=-1,1,0.9 strength=1.15' \
        --do 'light directional to=1,-0.4,0.9 strength=0.3' --do 'dials aa=supersample samples=3'
done
