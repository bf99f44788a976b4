#!/usr/bin/env bash
# The two halves of samples/known-normals.wrinkle: a normal map of rivets, worked out from spheres, shows what the rivets
# themselves show. Without the map, and with green the other way, it does not.  known_normals.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1 source=$2
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cp "$source"/samples/known-normals* "$folder" && cd "$folder" || exit 1
failures=0

# halves WHAT LOW HIGH [COMMAND...]: how far the left half is from the right one, of 1, is within these.
halves() {
    local what=$1 low=$2 high=$3 off
    shift 3
    "$program" render known-normals.wrinkle "$@" -o both.png --size 560x320 2>err || { cat err; exit 1; }
    convert both.png -crop 280x320+0+0 +repage left.png
    convert both.png -crop 280x320+280+0 +repage right.png
    off=$(compare -metric RMSE left.png right.png null: 2>&1 | sed 's/.*(\(.*\)).*/\1/')
    awk -v x="$off" -v low="$low" -v high="$high" 'BEGIN { exit !(x >= low && x <= high) }' && return
    printf '%s: the halves are %s apart, should be %s to %s\n' "$what" "$off" "$low" "$high"
    failures=$((failures + 1))
}
halves 'as it is' 0 0.007
choose=(--do 'object choose mapped' --do)
halves 'without the map' 0.05 1 "${choose[@]}" 'normalmap off'
halves 'green the other way' 0.1 1 "${choose[@]}" 'normalmap green=down'
halves 'half as strong' 0.02 1 "${choose[@]}" 'normalmap strength=0.5'
# Filtered, and in MikkTSpace's frames, which on a cube with edges of 1 are those of the patch.
halves 'filtered' 0 0.012 --do 'dials aa=filter'
halves 'in frames' 0 0.007 "${choose[@]}" 'normalmap frame=mikk'
[[ $failures == 0 ]]
