#!/usr/bin/env bash
# The script of the stamps draws the committed files and their list: a sample of them is drawn again.
# Usage: stock.sh SOURCE
set -u
source=$1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
/usr/bin/python3 -c 'import numpy' 2>"$folder/err" || { echo "stock: there is no numpy here"; exit 77; }
bad=0
fail() {
    echo "stock: $*"
    bad=1
}
names=(rivet paw-bear trefoil number-4 plate-arrow gouge)
/usr/bin/python3 "$source/brushes/stamps/stamps.py" "$folder" "${names[@]}" || fail 'stamps.py failed'
cmp "$folder/stamps.conf" "$source/brushes/stamps/stamps.conf" || fail 'stamps.conf differs from the one of stamps.py'
for name in "${names[@]}"; do
    # Rounding may differ in the last of 12 bits from one processor to another.
    difference=$(compare -metric PAE "$folder/$name.png" "$source/brushes/stamps/$name.png" null: 2>&1 | sed -E 's/ .*//')
    awk -v d="$difference" 'BEGIN { exit !(d != "" && d + 0 <= 16) }' || fail "$name.png is $difference off the one of stamps.py"
done
for file in "$source"/brushes/stamps/*.png; do
    grep -q "^$(basename "$file" .png): " "$source/brushes/stamps/stamps.conf" || fail "$file is not in stamps.conf"
done
for cell in "$source"/samples/cells/*.wrinkle; do
    [[ $(identify -format '%wx%h' "${cell%.wrinkle}.png") == 192x192 ]] || fail "$cell: no picture of 192 x 192 pixels"
done
exit $bad
