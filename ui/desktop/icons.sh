#!/usr/bin/env bash
# Draws the icons in ui/desktop/icons from ui/icon.svg: bash ui/desktop/icons.sh [FOLDER]
# Run it after a change of the drawing; the pictures are part of the source, so that a build needs no renderer.
set -euo pipefail
ui=$(CDPATH='' cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd -P)
folder=${1:-$ui/desktop/icons}
mkdir -p "$folder"
for size in 16 32 48 64 128 256; do
    rsvg-convert -w $size -h $size "$ui/icon.svg" -o "$folder/wrinkle-$size.png"
done
