#!/usr/bin/env bash
# The Blender add-on from its zip, in Blender without a window (blender_addon.py).  blender_addon.sh BUILD-FOLDER SOURCE-FOLDER
set -uo pipefail
command -v blender >/dev/null || { echo "${0##*/}: there is no blender here"; exit 77; }
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
export HOME=$folder XDG_CONFIG_HOME=$folder/config XDG_DATA_HOME=$folder/data WRINKLE_STATE=$folder/state
export WRINKLE=$1/wrinkle ZIP=$1/wrinkle-blender.zip
blender -b --factory-startup --python-exit-code 1 -P "$2/tests/ui/blender_addon.py" >said 2>&1
status=$?
grep -vE '^(Fra:|Saved:| Time:|Blender |Color management|addon_utils|$)' said
[[ $status == 0 ]] && grep -q '^all of it ran$' said
