#!/usr/bin/env bash
# A turntable, cut into pieces that GNU parallel hands out: on this machine one to each processor, with its
# --sshlogin also on others that see the same folder. However it is cut, the frames are the same files; those that are
# there already and whole are left out, so that what was stopped goes on where it was.
#
#   turntable-parallel.sh FILE OUT WxH FRAMES [option of parallel...]
#
# FILE    a document or script
# OUT     the frames' names, with #### for the number
# FRAMES  how many there are in the turn
#
# PIECE   in the environment: frames of a piece (a few for each processor, 16 at most)
# WRINKLE the program, where it is not in the PATH
set -euo pipefail
[[ $# -ge 4 && $2 == *'#'* && $4 =~ ^[1-9][0-9]*$ ]] || { sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0" >&2; exit 2; }
file=$1 out=$2 size=$3 frames=$4
shift 4
command -v parallel >/dev/null || { echo 'GNU parallel is missing: apt-get install parallel' >&2; exit 1; }
piece=${PIECE:-$(((frames - 1) / ($(nproc) * 4) + 1))}
[[ -n ${PIECE:-} || $piece -le 16 ]] || piece=16

for ((first = 1; first <= frames; first += piece)); do
    last=$((first + piece - 1))
    printf '%d-%d\n' "$first" $((last < frames ? last : frames))
done | parallel --workdir "$PWD" --halt now,fail=1 "$@" \
    "$(printf %q "${WRINKLE:-wrinkle}")" render "$(printf %q "$file")" -o "$(printf %q "$out")" --size "$size" \
    --of "$frames" --threads 1 --missing --frames '{}'
