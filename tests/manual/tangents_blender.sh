#!/usr/bin/env bash
# Our MikkTSpace frames beside Blender's, which are made by the published code, on real models. By hand, where Blender is:
#   ninja -C BUILD tangents_dump && tests/manual/tangents_blender.sh BUILD MODEL...
# such as all of Debian's assimp-testmodels. A line a model (tangents_blender.py tells of what), then their sums. It fails if
# over 1 in 200 corners is over a degree apart: at poles, where the tangents about a corner cancel, at triangles without
# an area in (u,v), and beside corners whose normals Blender cannot keep, both answers are as good.
set -uo pipefail
build=$1
here=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
shift
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
command -v blender >/dev/null || { echo 'tangents_blender: there is no Blender here'; exit 77; }
for model; do
    "$build/tangents_dump" "$model" >"$folder/corners" 2>/dev/null || continue
    said=$(blender -b --factory-startup -P "$here/tangents_blender.py" -- "$folder/corners" 2>/dev/null | grep '^compared') ||
        { printf '%s: Blender fails\n' "$model"; continue; }
    printf '%s: %s\n' "$(basename "$model")" "$said" | tee -a "$folder/all"
done
awk '{ for (i = 2; i <= NF; i++) {
           if ($i == "compared") n += $(i + 1)
           if ($i == "signs") signs += $(i + 1)
           if ($i == "over_0.05") some += $(i + 1)
           if ($i == "over_1") bad += $(i + 1) } }
     END { printf "%d models, %d corners: signs %d, over 0.05 degrees %d, over 1 degree %d\n", NR, n, signs, some, bad
           exit n == 0 || 200 * bad > n }' "$folder/all"
