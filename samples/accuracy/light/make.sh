#!/usr/bin/env bash
# What light and shape cost, as a page: measures the scenes of this folder and writes README.md, plots and pictures.
#
#   make.sh [--out FOLDER] [--keep FOLDER] [PROGRAM]
#
# PROGRAM      wrinkle, where it is not in the PATH or in build/
# --out        where to write (this folder)
# --keep       measurements are kept there, and those that are there already are not made again
#
# The reference sums over all of the sky at every sample and marches to every place of a lamp, so pictures are small, those
# under a sky smallest. Needs jq, gnuplot and ImageMagick's convert. Takes some forty minutes of processor time.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=$here keep='' program=''
while [[ $# -gt 0 ]]; do
    case $1 in
    --out) out=$2 && shift ;;
    --keep) keep=$2 && shift ;;
    -*) printf 'make.sh: unknown option %s\n' "$1" >&2 && exit 2 ;;
    *) program=$1 ;;
    esac
    shift
done
if [[ -z $program ]]; then
    program=$here/../../../build/wrinkle
    [[ -x $program ]] || program=wrinkle
fi
temporary=$(mktemp -d)
trap 'rm -rf "$temporary"' EXIT
[[ -n $keep ]] || keep=$temporary
mkdir -p "$out" "$keep"
say() { printf '%s\n' "$*" >>"$temporary/page"; }

measure() {
    [[ -f $keep/$1.json ]] && return
    "$program" accuracy "$here/$1.wrinkle" --size "$2" --runs 3 --plot "$keep/$1-plot.png" --json >"$keep/$1.new"
    mv "$keep/$1.new" "$keep/$1.json"
}

# shellcheck disable=SC2016  # jq's names
tell='
def short: if . == null then "-" elif . == 0 then "0" else
    (. as $x | ($x | fabs | log10 | floor) as $e | pow(10; 1 - $e) as $f | (($x * $f | round) / $f) as $r |
    if $e < -3 then "\(($x / pow(10; $e) * 10 | round) / 10)e\($e)" else "\($r)" end) end;
def told($last): "\(short)\(if . != null and . < 3 * $last then " ~" else "" end)";
def row($last): "| `\(.setting)` | \(.seconds * 1e3 | short) | \(.rms | told($last)) | \(.own_rms | told($last)) | \(.p999 | short) | \(.max | short) |";
def good: map(select(.model == false and .note == null and .rms != null));
'

tell_scene() {
    local name=$1
    say "## $name"
    say ''
    sed -n '1{s/^# [^ ]* - //;s/^./\U&/};1,/^$/s/^# //;/^$/q;p' "$here/$name.wrinkle" >>"$temporary/page"
    say ''
    say "![$name]($name.png) ![error against time]($name-plot.png)"
    say ''
    jq -r "$tell"'.reference.last_rms as $last | "Pictures of \(.width) x \(.height) pixels. Reference: \(.reference.samples) x \(.reference.samples) samples a pixel; the last doubling changed \(.reference.last_rms | short) (RMS).",
        "", "| what differs | ms | RMS error | that axis alone | 99.9 % | largest |", "| --- | ---: | ---: | ---: | ---: | ---: |",
        (.rungs | good | map(select(.setting == "as it stands" or .front or .axis == "light" or (.setting | test("dice=")))) | sort_by(.seconds)[] | row($last))' \
        "$keep/$name.json" >>"$temporary/page"
    say ''
    "$program" render "$here/$name.wrinkle" -o "$temporary/picture.png" --size 256x256
    convert "$temporary/picture.png" -strip +dither -colors 128 -define png:compression-level=9 "$out/$name.png"
    convert "$keep/$name-plot.png" -strip -colors 48 -define png:compression-level=9 "$out/$name-plot.png"
}

# How far a picture is from another of the scene.
tell_apart() {
    local name=$1 command=$2 what=$3 file
    "$program" render "$here/$name.wrinkle" -o "$temporary/a.tif" --size 256x256
    "$program" render "$here/$name.wrinkle" --do "$command" -o "$temporary/b.tif" --size 256x256
    file=$(convert "$temporary/a.tif" "$temporary/b.tif" -metric RMSE -compare -format '%[distortion]' info:)
    say "$what: \`$command\` makes a picture that is $(printf '%.2g' "$file") off (RMS over all pixels)."
    say ''
}

measure raking-rivets 96x96
measure displaced-bricks 96x96
measure polished-wood 40x40
measure brushed-metal 40x40
say '# What light and shape cost'
say ''
# shellcheck disable=SC2016  # backquotes of the page
say 'Made by `make.sh` from measurements. Errors are of linear intensity against the reference in double precision; times'
say 'are of one thread. "That axis alone" has the dials of the other axes at their best.'
say ''
# shellcheck disable=SC2016  # a backquote of the page
say '`~`: within three times what the reference itself changed when its samples doubled last; as much of it may be the'
say "reference's. Where it sums over all of the sky at every sample (wood, metal) a picture of 40 x 40 takes it up to 20 minutes of a"
say 'processor, and one of 96 x 96 with 64 x 64 samples would take hours.'
say ''
say "Machine: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) threads."
say ''
tell_scene raking-rivets
tell_apart raking-rivets 'material shadow=off' 'Without shadows'
tell_scene displaced-bricks
tell_apart displaced-bricks 'bump displaced=off' 'Bumped in place of displaced'
# shellcheck disable=SC2016  # backquotes of the page
say 'What bump mapping lacks of it, by `wrinkle accuracy --illusion`:'
say ''
say '```'
"$program" accuracy "$here/displaced-bricks.wrinkle" --illusion --size 128x128 >>"$temporary/page"
say '```'
say ''
tell_scene polished-wood
tell_scene brushed-metal
mv "$temporary/page" "$out/README.md"
