#!/usr/bin/env bash
# pictures.sh PROGRAM - makes the picture NAME.jpg of each starter, or only of those named, for the dialog of starters.
set -euo pipefail
program=$(realpath "${1:?pictures.sh PROGRAM [NAME...]}")
shift
cd "$(dirname "$0")"
[[ $# -gt 0 ]] || set -- *.wrinkle
for script in "$@"; do
    "$program" render "${script%.wrinkle}.wrinkle" -o "${script%.wrinkle}.jpg" --size 240x240
done
