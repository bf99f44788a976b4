#!/usr/bin/env bash
# A system that gives the program no threads: the window works all the same, on its own one, and says so; what needs
# some for good is refused with a reason.  window_threads.sh PROGRAM SOURCE-FOLDER SHIM
set -uo pipefail
program=$1
source=$2
shim=$3
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

serve
printf '%s\n' 'width 1200' 'height 800' 'turning 0' 'ants 0' 'range_follows 0' >config/wrinkle/window.conf
printf 'table 128x128\nbump height=1\ngrid cells=4x4 width=6\n' >small.wrinkle
printf 'table 128x128\nsave out.exr\nexport height out.tif\n' >save.wrinkle

# ---- in the shell ----
WR_THREADS=0 LD_PRELOAD=$shim "$program" run save.wrinkle >out 2>err && complain "exported without a thread"
grep -q 'need threads, but the system allows no more' err || complain "not the reason: $(cat err)"
[[ -s out.exr ]] || complain "a document was not saved without a thread"
[[ ! -e out.tif ]] || complain "a file was begun all the same"

# ---- in the window: a thread that loads the fonts, and one for the questions of these tests ----
export WR_THREADS=2 LD_PRELOAD=$shim
start --threads 1 small.wrinkle
unset LD_PRELOAD
drag 180 300 6 4 20
becomes 'stroke *' "a stroke"
key ctrl+z
becomes 'undo*' "the stroke undone"
key ctrl+i
key Return
becomes 'adjust invert*' "a command of the worker's"
xdotool key ctrl+q
rest
is_gone || xdotool key d
ends 0

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
