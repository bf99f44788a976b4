#!/usr/bin/env bash
# `wrinkle bench` with parts: the JSON and the table, tiny; what each row says of itself. How long anything took is
# nobody's business here.  bench.sh PROGRAM
set -uo pipefail
program=$1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0
complain() {
    printf '%s\n' "$*"
    failures=$((failures + 1))
}
says() {
    jq -e "$2" json >/dev/null || complain "not so: $1"
}

"$program" bench all --json --quick --size 48x32 --threads 2 >json 2>err || complain "bench fails: $(cat err)"
says 'the head' '.width == 48 and .height == 32 and .threads == 2 and .rounds > 0 and .isa == "auto" and
    .arithmetic == "fast" and (has("lines") | not)'
says 'the peaks' '(.peaks.sums | length >= 1 and .[0].isa == "v1" and all(.gflops > 0)) and
    ([.peaks.copies[].level] == ["L1", "L2", "DRAM"]) and (.peaks.copies | all(.bytes > 0 and .gbytes > 0))'
says 'the parts' '[.sections[].name] == ["surfaces", "schemes", "normals", "aliasing", "effects", "isa", "plan",
    "still", "first", "output", "simd"]'
says 'each row is measured' '[.sections[].rows[] | .ms > 0 and .ratio > 0 and .table > 0] | all and length > 80'
says 'a base is a row of its part, and beside itself 1' '.sections | all(. as $s | .rows | all(. as $r |
    ($s.rows | map(select(.name == $r.base)) | length) == 1 and (.name != .base or .ratio == 1)))'
says 'each ratio is that of two times' '.sections | all(. as $s | .rows | all(. as $r |
    ($s.rows[] | select(.name == $r.base).ms) as $b | ($r.ms / $b / $r.ratio - 1) | fabs < 1e-9))'
says 'rows have names of their own' '.sections | all([.rows[].name] | length == (unique | length))'
says 'rates belong to counts' '[.sections[].rows[] |
    ((.bytes == null) == (.gbytes == null)) and ((.flops_per_sample == null) == (.gflops == null)) and
    ((.samples == 0) == (.ns_per_sample == null))] | all'
says 'bytes of a turning picture' '[.sections[] | select(.name == "schemes").rows[] |
    .bytes == 4 * 48 * 32 + 16 * .samples] | all'
says 'operations where they are counted' '[.sections[0].rows[] | {(.name): .flops_per_sample}] | add |
    .["sphere smooth"] == 182 and .["sphere bump"] == 329 and ([.[] | select(. != null)] | length) == 2'
says 'rates of operations' '[.sections[].rows[] | select(.gflops) |
    (.gflops * .ms * 1e6 / .samples / .flops_per_sample - 1) | fabs < 1e-9] | all and length > 10'
says 'the least is not above the median' '[.sections[].rows[] | .least_ms > 0 and .least_ms <= .ms] | all'
says 'each scheme' '.sections[1].rows | length == 6 and all(.base == "central")'
says 'surfaces with and without colour' '[.sections[0].rows[].name] | contains(["bezier texture",
    "bezier bump+texture", "torus texture", "torus bump+texture"])'
# Every effect that a plan has ran where the row says so, and did not in the row beside it.
planned=$("$program" explain --json --size 8x8 | jq '.effects | length')
[[ ${planned:-0} -gt 32 ]] || complain "a plan has ${planned:-no} effects"
says 'each effect' '.sections[4].rows | length == 2 * '"${planned:-0}"' and
    all(.ran == (.name | startswith("without ") | not)) and (map(.effect) | unique | length == '"${planned:-0}"')'
says 'a view at rest draws nothing, and with a dab less than all' '[.sections[7].rows[].samples] |
    .[1] == 0 and .[2] > 0 and .[2] <= .[0] and .[4] == 0'
says 'full pictures take as many samples' '[.sections[6].rows[] | .samples > 0] | all'

"$program" bench schemes output --quick --size 16x16 >table 2>err || complain "no table: $(cat err)"
[[ $(grep -cE '^(schemes|output): ' table) == 2 ]] || complain "not two parts: $(cat table)"
grep -q '^this machine at its best: .* GFLOP/s; copying L1 .* GB/s$' table || complain 'no peaks'
[[ $(grep -cE '^  .*( +[0-9.]+){5} +[0-9.-]+$' table) == 12 ]] || complain "not twelve rows: $(cat table)"

"$program" bench schemes --exact --isa ref --quick --size 16x16 --json >json || complain 'not with --exact'
says 'arithmetic and isa' '.arithmetic == "exact" and .isa == "ref" and (.sections | length) == 1'

# All at once takes a minute: what --lines prints is there too.
if [[ ${WR_FULL-} == 1 ]]; then
    "$program" bench --json --quick --size 16x16 >json 2>err || complain "bench --json fails: $(cat err)"
    says 'lines beside all parts' '(.sections | length) == 11 and (.lines | length >= 27) and
        (.lines | all(.ms >= 0 and .table >= 0 and .threads > 0)) and
        ([.lines[].what] | contains(["sphere", "bezier", "brush", "make"]))'
fi

refuse() {
    "$program" bench "${@:2}" >out 2>err
    [[ $? == 2 && ! -s out ]] || complain "not refused: ${*:2}"
    grep -qF -- "$1" err || complain "'${*:2}' does not say: $1, but: $(cat err)"
}
refuse 'did you mean schemes? It must be one of surfaces, schemes' scheme
refuse 'window has neither' window --lines
refuse 'brushes stands alone' window brushes
refuse 'stands alone' generate schemes
refuse '--size' --size 16x16
refuse 'needs --json' schemes --lines
refuse 'v9' schemes --isa v9

# Without the program that measures: one message, with its place.
mkdir alone
cp "$program" alone/wrinkle
for words in bench 'accuracy --tolerance rms=0.1'; do
    # shellcheck disable=SC2086  # words
    alone/wrinkle $words >out 2>err
    [[ $? == 1 && ! -s out && $(wc -l <err) == 1 ]] || complain "not one message without wrinkle-bench: $words: $(cat err)"
    grep -qF "${words%% *} needs the program wrinkle-bench, which was not found at: $PWD/alone/wrinkle-bench; build it" err ||
        complain "not told what is missing: $words: $(cat err)"
done

exit $((failures > 0))
