#!/usr/bin/env bash
# The Blender add-on's files that need no Blender (test_blender_files.py).  blender_files.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
export WRINKLE=$1 ADDON=$2/ui/addons/blender/wrinkle_blender PYTHONDONTWRITEBYTECODE=1
export HOME=$folder XDG_CONFIG_HOME=$folder/config XDG_DATA_HOME=$folder/data WRINKLE_STATE=$folder/state
exec /usr/bin/python3 -W error::ResourceWarning "$2/tests/ui/test_blender_files.py"
