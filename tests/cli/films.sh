#!/usr/bin/env bash
# Turntables as films by ffmpeg itself: frames, sizes, rates, loops and tags as ffprobe sees them, colours beside those of
# the same frames as files.  films.sh PROGRAM   Skipped, which is said, where ffmpeg is not installed.
set -uo pipefail
program=$1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
export HOME=$folder WRINKLE_STATE=$folder/state XDG_CONFIG_HOME=$folder/config XDG_DATA_HOME=$folder/data
failures=0
complain() {
    printf '%s\n' "$*"
    failures=$((failures + 1))
}
# refused WORDS ARGUMENTS...: render fails, says so, and leaves nothing.
refused() {
    local words=$1
    shift
    "$program" render s.wrinkle "$@" 2>err && complain "$*: was not refused"
    grep -qF -- "$words" err || complain "$*: does not say \"$words\": $(cat err)"
}
printf 'table 128x128\npattern bricks across=3 rows=4 joint=2 bevel=4\nbump height=0.1\nsurface sphere\nmaterial colour=0.9,0.2,0.05\nlight directional to=1,1,1\n' >s.wrinkle

# ---- without it ----
mkdir empty
PATH=$folder/empty "$program" render s.wrinkle -o t.mp4 --frames 1-3 2>err
[[ $? == 1 && ! -e t.mp4 ]] || complain 'a film without ffmpeg'
grep -qF "Debian's package ffmpeg" err || complain "the package is not named: $(cat err)"
refused '#### for the frame' -o t.png --frames 1-3
refused 'a film needs --frames' -o t.mp4
refused '--fps needs --frames' -o t.gif --fps 5
refused 'only for films' -o 't##.png' --frames 1-3 --fps 5
refused 'not in a film' -o t.gif --frames 1-3 --missing
refused 'must be frames a second, 0.1..240' -o t.gif --frames 1-3 --fps 0
refused 'must be how often' -o t.gif --frames 1-3 --loop -1
refused '0.1..50 frames a second of GIF' -o t.gif --frames 1-3 --fps 60

command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null || {
    [[ $failures == 0 ]] || exit 1
    echo 'skipped: the program ffmpeg is not installed'
    exit 77
}

# ---- with it ----
# probed FILE WHAT: values of its stream, parted by commas.
probed() { ffprobe -v error -count_frames -select_streams v -show_entries "stream=$2" -of csv=p=0 "$1"; }
# is VALUE WANTED WHAT
is() { [[ $1 == "$2" ]] || complain "$3: $1 instead of $2"; }
"$program" render s.wrinkle -o 'f#.png' --size 83x61 --frames 1-7 || complain 'no frames'
for ending in gif apng webp mp4; do
    "$program" render s.wrinkle -o "t.$ending" --size 83x61 --frames 1-7 --fps 12.5 2>err || complain "$ending: $(cat err)"
    grep -q "note: t.$ending: .*, 7 frames, .*; read back: " err || complain "$ending: not told: $(cat err)"
done
is "$(probed t.gif codec_name,width,height,r_frame_rate,nb_read_frames)" gif,83,61,25/2,7 gif
is "$(probed t.apng codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames)" apng,83,61,rgb24,25/2,7 apng
is "$(probed t.mp4 codec_name,width,height,pix_fmt,color_range,color_space,color_transfer,color_primaries,r_frame_rate,nb_read_frames)" \
    h264,84,62,yuv420p,tv,bt709,iec61966-2-1,bt709,25/2,7 mp4
grep -q 'sRGB' t.apng || complain 'apng: no sRGB tag'
[[ $(grep -abo moov t.mp4 | head -n 1 | cut -d: -f 1) -lt $(grep -abo mdat t.mp4 | head -n 1 | cut -d: -f 1) ]] ||
    complain 'mp4: players cannot begin before they have all of it'

# differs FILE FRAME: its root mean square difference from the frame's own file, in codes.
differs() {
    ffmpeg -v error -i "$1" -i "f$2.png" -filter_complex \
        "[0:v]select=eq(n\\,$2-1),setpts=0,crop=83:61:0:0:exact=1,format=gbrp[a];[1:v]format=gbrp[b];[a][b]psnr=f=-:shortest=1" \
        -frames:v 1 -f null - 2>/dev/null | sed -n '1s/.*mse_avg:\([0-9.]*\).*/\1/p'
}
under() { [[ -n $1 ]] && awk -v a="$1" -v b="$2" 'BEGIN { exit !(a <= b) }' || complain "$3: mean square $1 of codes, over $2"; }
for frame in 1 4 7; do
    under "$(differs t.apng $frame)" 0 "apng, frame $frame"
    under "$(differs t.gif $frame)" 3 "gif, frame $frame"
    under "$(differs t.mp4 $frame)" 60 "mp4, frame $frame"
done
cmp -s f1.png f4.png && complain 'the object does not turn'

# ---- how often ----
# bytes FILE NAME SKIP COUNT: hexadecimal bytes behind a name in a file; none if the name is not there.
bytes() {
    local name
    name=$(printf %s "$2" | od -An -v -tx1 | tr -d ' \n')
    od -An -v -tx1 "$1" | tr -d ' \n' | sed -nE "s/.*$name.{$((2 * $3))}(.{$((2 * $4))}).*/\1/p" | grep . || echo none
}
for loop in 0 1 3; do
    for ending in gif apng webp; do
        "$program" render s.wrinkle -o "l$loop.$ending" --size 20x20 --frames 1-2 --loop $loop 2>err || complain "$(cat err)"
    done
done
is "$(bytes l0.gif NETSCAPE2.0 2 2) $(bytes l1.gif NETSCAPE2.0 2 2) $(bytes l3.gif NETSCAPE2.0 2 2)" '0000 none 0200' 'loops of gif'
is "$(bytes l0.apng acTL 4 4) $(bytes l1.apng acTL 4 4) $(bytes l3.apng acTL 4 4)" '00000000 00000001 00000003' 'loops of apng'
is "$(bytes l0.webp ANIM 8 2) $(bytes l1.webp ANIM 8 2) $(bytes l3.webp ANIM 8 2)" '0000 0100 0300' 'loops of webp'

# ---- a script, a background that is none, sizes of one pixel, a tolerance ----
{ cat s.wrinkle && echo 'render one.apng size=83x61 frames=7 fps=12.5'; } >one.wrinkle
"$program" run one.wrinkle 2>err || complain "$(cat err)"
cmp one.apng t.apng || complain 'the command makes another film'
{ cat s.wrinkle && echo 'render "one##.png" size=83x61 frames=7 turn=90 step=10' && echo 'render two.png size=83x61 turn=120'; } >two.wrinkle
"$program" run two.wrinkle 2>err || complain "$(cat err)"
cmp one03.png two.png || complain 'turn and step'
for line in 'render x.png size=9x9 fps=5' 'render x.png size=9x9 step=5' 'render x.png frames=3'; do
    echo "$line" | "$program" run - 2>err && complain "$line: was not refused"
done
for ending in gif apng webp mp4; do
    for size in 1x1 16x3; do
        "$program" render s.wrinkle -o "s.$ending" --size $size --frames 1-2 2>err || complain "$ending of $size: $(cat err)"
    done
    "$program" render -o "s.$ending" --do 'surface sphere' --size 30x30 --frames 1-6 2>err || complain "$ending, all frames alike: $(cat err)"
    "$program" render s.wrinkle --do 'background none' -o "s.$ending" --size 30x30 --frames 1-3 2>err ||
        complain "$ending without background: $(cat err)"
done
is "$(probed s.apng pix_fmt)" rgba 'apng without background'
"$program" render s.wrinkle --do 'tolerance rms=0.004' -o s.gif --size 30x30 --frames 1-3 2>err || complain "$(cat err)"

# ---- an interrupt ----
echo old >i.mp4
"$program" render s.wrinkle -o i.mp4 --size 400x400 --frames 1-90000 2>err &
child=$!
until ls .i.mp4.* >/dev/null 2>&1; do sleep 0.02; done
kill -INT $child
wait $child
is $? 130 'the status after an interrupt'
is "$(cat i.mp4)" old 'the old file'
[[ -z $(find . -name '.*.part*') ]] || complain 'a half-written file stayed'

[[ $failures == 0 ]] || exit 1
echo 'all passed'
