#!/usr/bin/env bash
# The cost of accuracy, as a page: measures the eleven scenes of this folder and what a tolerance chooses on eight of
# those and on the eight of unseen/, which nobody looked at while choosing was built, and writes README.md, the plots and
# the pictures. (contest/ has more scenes, which choosing was tuned on.)
#
#   make.sh [--quick] [--out FOLDER] [--keep FOLDER] [PROGRAM]
#
# PROGRAM      wrinkle, where it is not in the PATH or in build/
# --out        where to write (this folder)
# --keep       measurements are kept there, and those that are there already are not made again
# --quick      tiny pictures and few runs: the page is made, its numbers mean nothing
#
# Every sentence of the page that says what follows is made from the numbers. Needs jq and
# ImageMagick's convert. Takes about half an hour; --quick, half a minute.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=$here keep='' program='' size=256x256 shown_size=256x256 runs=9 contest_size=96x96 quick=''
while [[ $# -gt 0 ]]; do
    case $1 in
    --quick) quick=yes size=16x16 shown_size=72x72 runs=3 contest_size=24x24 ;;
    --out) out=$2 && shift ;;
    --keep) keep=$2 && shift ;;
    -*) printf 'make.sh: unknown option %s\n' "$1" >&2 && exit 2 ;;
    *) program=$1 ;;
    esac
    shift
done
if [[ -z $program ]]; then
    program=$here/../../build/wrinkle
    [[ -x $program ]] || program=wrinkle
fi
temporary=$(mktemp -d)
trap 'rm -rf "$temporary"' EXIT
[[ -n $keep ]] || keep=$temporary
mkdir -p "$out" "$keep"

scenes=(ribbon bricks-far sphere-poles terrain-grazing bits displacement scratches painted)
unseen=(rivets-torus curl-tiles bezier-noise cylinder-ridges sphere-gloss plane-fourier cube-letters floor-cells)
shown=("${scenes[@]}" highlights knot trio) # of the last three only the table
if [[ -n $quick ]]; then
    contestants=(painted cube-letters) large=() pieces=1 level=1
else
    pieces=12 level=9
    contestants=("${scenes[@]}" "${unseen[@]}") large=(ribbon sphere-poles sphere-gloss cube-letters)
fi

say() { printf '%s\n' "$*" >>"$temporary/page"; }
script() { if [[ -f $here/$1.wrinkle ]]; then echo "$here/$1.wrinkle"; else echo "$here/unseen/$1.wrinkle"; fi; }

# The tolerances of every scene: RMS, and of the worst pixel, of linear intensity.
rms=(0.03 0.01 0.005 0.0025)
max=(0.3 0.1 0.03)

# ---- measuring ----

# A picture as small as can be.
shrink() { convert "$1" -strip -define "png:compression-level=$level" "${@:3}" "$2"; }

measure() {
    local name=$1 pictures=$keep/$1-differences
    if [[ ! -f $keep/$name.json ]]; then
        mkdir -p "$pictures"
        "$program" accuracy "$(script "$name")" --size $size --runs $runs --plot "$keep/$name-plot.png" \
            --differences "$pictures" --json >"$keep/$name.new"
        mv "$keep/$name.new" "$keep/$name.json"
    fi
    "$program" render "$(script "$name")" -o "$temporary/picture.png" --size $shown_size
    shrink "$temporary/picture.png" "$out/$name.png" +dither -colors 256
    shrink "$keep/$name-plot.png" "$out/$name-plot.png" -colors 48
    # Errors of one sample, of the filtered table, of moments, side by side.
    local strip=() rung file
    for rung in aa-point aa-filter-footprint-anisotropic aa-moments-moments-lean-footprint-anisotropic; do
        file=$(find "$pictures" -name "[0-9]*-$rung.png" | sort | head -n 1)
        [[ -z $file ]] || strip+=("$file")
    done
    convert "${strip[@]}" +append "$temporary/strip.png"
    shrink "$temporary/strip.png" "$out/$name-errors.png" -resize 576x192 -colors 64
}

# What each dial's value is in plain words.
words=$temporary/words.json
cat >"$words" <<'END'
{ "scheme=nearest": "one constant slope per texel: relief breaks into steps",
  "scheme=bilinear": "slopes of flat facets between texels, with creases between them",
  "scheme=central": "slopes by the difference of the neighbours, as in the paper",
  "scheme=bspline": "slopes of a smooth surface near the texels, slightly rounded",
  "scheme=bspline-fit": "slopes of the smooth surface through all texels",
  "scheme=catmull": "slopes of a surface through all texels, with steps of curvature",
  "mode=none": "no bump at all", "mode=blinn": "the paper's normal, without a small term",
  "mode=exact": "the true normal of the displaced surface",
  "mode=invariant": "the paper's other normal, independent of stretch",
  "aa=point": "one sample at the middle of each pixel: stair-stepped edges",
  "aa=filter": "one sample of a table blurred to the pixel's size",
  "aa=moments": "one sample of the blurred table and of its slope variance",
  "aa=supersample": "the mean of a grid of samples in each pixel",
  "aa=adaptive": "more samples only where one sample and its neighbours are not enough",
  "spread=regular": "samples on an even grid", "spread=jittered": "samples at random places: grain in place of stair steps",
  "footprint=isotropic": "the pixel's footprint approximated by a square",
  "footprint=anisotropic": "the pixel's true footprint, even if long and thin",
  "moments=toksvig": "slope variance as one number", "moments=lean": "slope variance in both directions",
  "refine=contrast": "where an estimate requires them", "refine=bound": "wherever they are not proved unnecessary",
  "newton=-1": "the point on the surface solved to full precision",
  "newton=0": "the point on the surface from the grid, not solved",
  "newton=1": "the point on the surface solved by one step", "newton=2": "the point on the surface solved by two steps",
  "newton=3": "the point on the surface solved by three steps",
  "heights=double": "heights and slopes in double precision", "heights=float": "heights in single precision",
  "heights=half": "heights of 11 bits and an exponent", "heights=16bit": "heights in 65 536 steps",
  "heights=8bit": "heights in 256 steps, visible as terraces",
  "shading=float": "light in single precision", "shading=double": "light in double precision",
  "shading=half": "light rounded to 11 bits between stages",
  "arithmetic=exact": "the same bits on every processor", "arithmetic=fast": "the processor's own shortcuts",
  "as it stands": "the scene as in its script" }
END

# The front in pictures: a piece of the picture with each of its settings, and below how far it is off (white: 0.1),
# numbered as in the table.
show_front() {
    local name=$1 pictures=$keep/$1-differences number=0 index setting word bump dials tops=() errors=()
    while IFS=$'\t' read -r index setting; do
        bump='' dials=''
        for word in $setting; do
            case $word in
            scheme=* | mode=*) bump+=" $word" ;;
            *=*) dials+=" $word" ;;
            esac
        done
        number=$((number + 1))
        [[ $number -le $pieces ]] || break
        "$program" render "$(script "$name")" ${bump:+--do "bump$bump"} ${dials:+--do "dials$dials"} --size $size \
            -o "$temporary/piece.png"
        convert "$temporary/piece.png" -gravity center -crop 76x76+0+0 +repage -fill white -undercolor '#00000080' \
            -gravity southeast -annotate +2+1 "$number" "$temporary/top-$number.png"
        convert "$(printf '%s/%02d' "$pictures" "$index")"-*.png -gravity center -crop 76x76+0+0 +repage \
            "$temporary/off-$number.png"
        tops+=("$temporary/top-$number.png") errors+=("$temporary/off-$number.png")
    done < <(jq -r "$functions"'[.rungs | to_entries[] | select(.value.model == false and .value.note == null and .value.front)] |
        sort_by(.value.seconds)[] | "\(.key)\t\(.value.setting)"' "$keep/$name.json")
    convert \( "${tops[@]}" +append \) \( "${errors[@]}" +append \) -append "$temporary/front.png"
    shrink "$temporary/front.png" "$out/$name-front.png" +dither -colors 128
}

compete() {
    local name=$1 tolerance words=()
    [[ -f $keep/contest-$name.json ]] && return
    for tolerance in "${rms[@]}"; do words+=(--tolerance "rms=$tolerance"); done
    for tolerance in "${max[@]}"; do words+=(--tolerance "max=$tolerance"); done
    "$program" accuracy "$(script "$name")" --size $contest_size "${words[@]}" --json >"$keep/contest-$name.new"
    mv "$keep/contest-$name.new" "$keep/contest-$name.json"
}

# The same of a larger picture, for few tolerances.
compete_large() {
    [[ -f $keep/large-$1.json ]] ||
        "$program" accuracy "$(script "$1")" --size 256x256 --tolerance rms=0.01 --tolerance max=0.1 --json >"$keep/large-$1.json"
}

# ---- telling ----

# jq's side: numbers as people write them.
# shellcheck disable=SC2016
functions='
def short: if . == null then "-" elif . == 0 then "0" else
    (. as $x | ($x | fabs | log10 | floor) as $e | pow(10; 1 - $e) as $f |
    (($x * $f | round) / $f) as $r | if $e < -3 then "\(($x / pow(10; $e) * 10 | round) / 10)e\($e)"
    else "\($r)" end) end;
def ms: "\(. * 1e3 | short) ms";
def kb: "`\(.)`";
def measured: .rungs | map(select(.model == false and .note == null and .rms != null));
def named($s): measured | map(select(.setting == $s)) | first;
def more($a; $b): $a > 1.03 * $b;
def cheapest($e): measured | map(select(.rms <= $e)) | min_by(.seconds);
def front: measured | map(select(.front)) | sort_by(.seconds);
'


# The front, fast to near.
tell_front() {
    say ''
    jq -r '"Pictures of \(.width) x \(.height) pixels."' "$keep/$1.json" >>"$temporary/page"
    say ''
    say '| | best settings | ms | RMS error | 99.9 % | largest | difference in words |'
    say '| ---: | --- | ---: | ---: | ---: | ---: | --- |'
    jq -r --slurpfile words "$words" "$functions"'
        def word: . as $w | $words[0][$w] // (if startswith("samples=") then "\($w[8:]) x \($w[8:]) samples a pixel"
            elif startswith("contrast=") then "within about \($w[9:]) of full sampling"
            elif startswith("mesh=") then "the surface'"'"'s grid 2^\($w[5:]) times as fine"
            elif startswith("texels=") then "the point on the surface solved to \($w[7:]) texels"
            else error("no words for \($w)") end);
        def plain: if . == "as it stands" then word else split(" ") | map(word) | join("; ") end;
        .reference.last_rms as $own | front | to_entries[] | .key as $n | .value |
        "| \($n + 1) | \(.full | kb) | \(.seconds * 1e3 | short) | \(.rms | short)\(if .rms < 3 * $own then " ~" else "" end) | \(.p999 | short) | \(.max | short) | \(.setting | plain) |"' \
        "$keep/$1.json" >>"$temporary/page"
    say ''
    say '`~`: within three times the change of the reference at its last doubling of samples; the reference itself may have'
    say 'an error of this size.'
    say ''
    say "A crop of each, and its error (white: 0.1): ![the front in pictures]($1-front.png)"
    say ''
}

# What follows from the numbers of one scene.
tell_conclusions() {
    jq -r "$functions"'
    # The cheapest for each error.
    (0.03, 0.01, 0.004 | . as $e | $e) as $e | cheapest($e) as $r |
        if $r == null then "- No setting here has an error of at most \($e)."
        else "- For an error of at most \($e) choose \($r.full | kb): \($r.seconds | ms), \($r.rms | short) measured." end
    ' "$keep/$1.json" >>"$temporary/page"
    jq -r "$functions"'
    named("aa=point") as $p | named("aa=filter footprint=anisotropic") as $f |
    named("aa=moments moments=lean footprint=anisotropic") as $m |
    named("heights=8bit") as $h8 | named("heights=16bit") as $h16 |
    (if $p and $f then if more($f.rms; $p.rms) and $f.seconds > $p.seconds then
        "- **Costlier and worse:** filtered F (anisotropic: up to 16 look-ups a pixel) is worse than point sampling here, \($f.rms | short) against \($p.rms | short), and needs \($f.seconds / $p.seconds | short) times as long."
        elif more($p.rms; $f.rms) then "- Filtered F (anisotropic: up to 16 look-ups a pixel) is more accurate than point sampling, \($f.rms | short) against \($p.rms | short), for \($f.seconds / $p.seconds | short) times its time."
        else "- Filtered F (anisotropic: up to 16 look-ups a pixel) is as accurate as point sampling, \($f.rms | short), and needs \($f.seconds / $p.seconds | short) times as long: no gain." end else empty end),
    (named("aa=filter footprint=isotropic") as $i | if $i and $p and $f then
        "- Filtered with one look-up (isotropic): \($i.rms | short), for \($i.seconds / $p.seconds | short) times the time of one sample." else empty end),
    (if $m and $f then if more($m.rms; $f.rms) and $m.seconds > $f.seconds then
        "- **Costlier and worse:** moments are worse than filtering here, \($m.rms | short) against \($f.rms | short), and need \($m.seconds / $f.seconds | short) times as long."
        else "- Moments are \(if more($f.rms; $m.rms) then "more accurate" else "no more accurate" end) than filtering, \($m.rms | short) against \($f.rms | short), for \($m.seconds / $f.seconds | short) times its time." end else empty end),
    (if $m and $p then if more($m.rms; $p.rms) and $m.seconds > $p.seconds then
        "- **Costlier and worse:** moments are worse than one plain sample, \($m.rms | short) against \($p.rms | short)."
        else empty end else empty end),
    (measured | map(select(.setting == "as it stands" and (.full | contains("samples=4")))) | first) as $now |
    (if $m and $now then "- Compared with 4 x 4 samples: moments \($m.rms | short) against \($now.rms | short), for \($m.seconds / $now.seconds | short) times the time\(if more($now.rms; $m.rms) then ": more accurate and faster" else "" end)." else empty end),
    (if $h8 and $h16 and $h8.own_rms and $h16.own_rms then
        "- Heights of 8 bits alone cause an error of \($h8.own_rms | short), of 16 bits \($h16.own_rms | short)\(if $h16.own_rms > 0 and $h8.own_rms / $h16.own_rms > 1.5 then ": \($h8.own_rms / $h16.own_rms | short) times less" else ": here the bit depth does not matter" end)." else empty end),
    ((measured | map(select(.setting == "mode=exact")) | first) as $x | (measured | map(select(.setting == "as it stands")) | first) as $now |
        if $x and $now then "- The exact normal in place of the paper'"'"'s: \($x.rms | short) against \($now.rms | short), for \($x.seconds / $now.seconds | short) times the time." else empty end),
    (measured as $all | [$all[] | . as $r | select([$all[] | select(.seconds < 0.5 * $r.seconds and .rms < $r.rms)] | length > 0)] |
        "- \(length) of \($all | length) settings have a larger error than another one in less than half their time."),
    "- Reference: \(.reference.samples) x \(.reference.samples) samples a pixel; the last doubling changed \(.reference.last_rms | short) (RMS)\(if .reference.converged then ", under a tenth of the smallest error listed" else ", more than a tenth of the smallest error listed: errors near it are partly those of the reference" end).",
    "- In the paper, bump needs 4 times as long as Phong and 2 times as long as a colour picture; here \(.claim.bump_over_phong | short) and \(.claim.bump_over_colour | short)."
    ' "$keep/$1.json" >>"$temporary/page"
}

tell_scene() {
    local title
    title=$(sed -n '1s/^# [^ ]* - //p' "$(script "$1")")
    say "## $1"
    say ''
    sed -n '1{s/^# [^ ]* - //;s/^./\U&/};1,/^$/s/^# //;/^$/q;p' "$(script "$1")" >>"$temporary/page"
    say ''
    say "![${title%%[:.,]*}]($1.png)"
    say ''
    say "![error against time]($1-plot.png)"
    say ''
    say "Errors of one sample a pixel, of filtered F, of moments (white: 0.1): ![errors]($1-errors.png)"
    tell_front "$1"
    tell_conclusions "$1"
    say ''
}

# One kind of tolerance on those scenes: what held, and what it cost.
tell_kind() {
    local kind=$1 title=$2 name files=()
    shift 2
    for name in "$@"; do files+=("$keep/contest-$name.json"); done
    say "### $title"
    say ''
    say '| scene | tolerance | error | | first ms | each more ms | cheapest ms | ratio | pays from |'
    say '| --- | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: |'
    jq -r --arg kind "$kind" "$functions"'(.document | sub("\\.wrinkle$"; "")) as $name | .rows[] | select(.kind == $kind) |
        "| \($name) | \(.value) | \(if $kind == "rms" then .rms else .max end | short) | \(.verdict) | \(.choosing_seconds * 1e3 | short) | \(.seconds * 1e3 | short) | \(if .best_seconds then .best_seconds * 1e3 | short else "-" end) | \(if .best_seconds then .seconds / .best_seconds | short else "-" end) | \(if .pays_from then .pays_from else "never" end) |"' \
        "${files[@]}" >>"$temporary/page"
    say ''
    jq -rs --arg kind "$kind" '[.[].rows[] | select(.kind == $kind)] as $rows | ($rows | length) as $n |
        def count(f): $rows | map(select(f)) | length;
        def middle: sort | .[length / 2 | floor] * 100 | round | . / 100;
        ($rows | map(select(.best_seconds != null))) as $able |
        "Of \($n) rows, \(count(.verdict == "held")) hold the tolerance, \(count(.verdict == "BROKEN")) break it without a warning, \(count(.verdict == "not promised")) break it with a warning, \(count(.verdict == "held, not promised")) hold it with a warning, and for \(count(.verdict == "unresolved")) the reference itself is too uncertain. A single setting can meet \($able | length) rows. Compared with the cheapest such setting, each further picture needs at most 1.2 times the time in \($able | map(select(.seconds <= 1.2 * .best_seconds)) | length) of them, at most \($able | map(.seconds / .best_seconds) | middle) times in half of them; the first picture, including the choice, needs at most \($able | map(.choosing_seconds / .best_seconds) | middle) times the time in half of them. The choice pays from the first picture on in \($able | map(select(.pays_from == 1)) | length) rows, within ten in \($able | map(select(.pays_from != null and .pays_from <= 10)) | length), never in \($able | map(select(.pays_from == null)) | length)."' \
        "${files[@]}" >>"$temporary/page"
    say ''
}

tell_contest() {
    local half=$((${#contestants[@]} / 2))
    say '## Choices of a tolerance'
    say ''
    say "Pictures of ${contest_size/x/ x } pixels on one thread. For each scene and tolerance of linear intensity: the error of the"
    say 'whole picture against the reference; the verdict on the tolerance; the time of the first picture, including the'
    say 'choice, and of each further one; that of the cheapest single setting within the tolerance, from a full search over slopes,'
    say 'normals and antialiasing in all combinations; the ratio of the two; and the number of pictures from which the'
    say 'choice is cheaper than that setting, known in advance.'
    say 'The last table has larger pictures of four scenes.'
    say ''
    tell_kind rms 'Root mean square, the scenes above' "${contestants[@]:0:half}"
    tell_kind rms 'Root mean square, scenes not used for tuning' "${contestants[@]:half}"
    tell_kind max 'The worst pixel, the scenes above' "${contestants[@]:0:half}"
    tell_kind max 'The worst pixel, scenes not used for tuning' "${contestants[@]:half}"
}

# Larger pictures: the columns of tell_kind, with the tolerance's kind.
tell_large() {
    local name files=()
    [[ ${#large[@]} -gt 0 ]] || return 0
    for name in "${large[@]}"; do files+=("$keep/large-$name.json"); done
    say '### 256 x 256 pixels'
    say ''
    say '| scene | tolerance | error | | first ms | each more ms | cheapest ms | ratio | pays from |'
    say '| --- | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: |'
    jq -r "$functions"'(.document | sub("\\.wrinkle$"; "")) as $name | .rows[] |
        "| \($name) | \(.kind) \(.value) | \(if .kind == "rms" then .rms else .max end | short) | \(.verdict) | \(.choosing_seconds * 1e3 | short) | \(.seconds * 1e3 | short) | \(if .best_seconds then .best_seconds * 1e3 | short else "-" end) | \(if .best_seconds then .seconds / .best_seconds | short else "-" end) | \(if .pays_from then .pays_from else "never" end) |"' \
        "${files[@]}" >>"$temporary/page"
    say ''
}

tell_hard_cases() {
    say '## Hard cases'
    say ''
    [[ -f $keep/hard.json ]] || "$program" accuracy --hard-cases --json >"$keep/hard.json"
    jq -r '"`wrinkle accuracy --hard-cases` measures \(.cases | length) cases: \(.pass) pass, \(.fail) fail, \(.waits) concern future effects.",
        (.cases[] | select(.verdict == "fail") | "- \(.id), \(.what): fails.")' "$keep/hard.json" >>"$temporary/page"
    say ''
    bash "$here/../../tests/repository/mutate.sh" "$here/../.." tell >>"$temporary/page"
}

# ---- the page ----

for name in "${shown[@]}"; do
    measure "$name"
    show_front "$name"
done
for name in "${contestants[@]}"; do compete "$name"; done
for name in "${large[@]}"; do compete_large "$name"; done
say '# The cost of accuracy'
say ''
say 'Generated by `make.sh` from measurements, including the sentences. Errors are of linear intensity'
say 'against the reference in double precision; times are of one thread.'
say ''
say 'Reflection, surroundings, shadows and displacement have a page of their own: [light](light/README.md).'
say ''
say "Machine: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) threads."
say ''
for name in "${shown[@]}"; do tell_scene "$name"; done
tell_contest
tell_large
tell_hard_cases
mv "$temporary/page" "$out/README.md"
