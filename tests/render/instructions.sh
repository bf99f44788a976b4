#!/usr/bin/env bash
# What effects cost that are left out, in instructions, which do not depend on how busy a machine is: a scene that has an
# effect and leaves it out costs within 1 % of one that never names it, and a small dab costs the tiles that it reaches,
# whatever the table's size. What is the same at two sizes of the picture, as preparing is, is taken off.
#   instructions.sh PROGRAM
set -uo pipefail
program=$1
command -v valgrind >/dev/null || { echo 'valgrind is missing: apt-get install valgrind'; exit 1; }
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT

# Pictures always in memory of their own, which comes empty: what was freed before must be emptied, and would count. So the
# end of what small blocks have is given back at once; else a small picture finds room there, now and then.
export GLIBC_TUNABLES=glibc.malloc.mmap_threshold=32768:glibc.malloc.trim_threshold=4096:glibc.malloc.top_pad=0
valgrind --tool=callgrind --callgrind-out-file="$folder/out" --collect-atstart=no --toggle-collect=wr_test_counted \
    --dump-after=wr_test_counted "$program" >"$folder/calls" 2>"$folder/err" ||
    { cat "$folder/err"; exit 1; }

# WHAT|FORM|SIZE|SAMPLES|INSTRUCTIONS, in the order of the calls.
while IFS= read -r call; do
    number=$((${number:-0} + 1))
    printf '%s|%s\n' "$call" "$(awk '/^(summary|totals):/ { print $2; exit }' "$folder/out.$number")"
done <"$folder/calls" >"$folder/counts"

awk -F '|' '
    function wrong(text) { print text; failed = 1 }
    { samples[$1, $2, $3] = $4; cost[$1, $2, $3] = $5; if (!($1 in seen)) { seen[$1] = ++whats; name[whats] = $1 } }
    $5 + 0 <= 0 { wrong("not counted: " $0) }
    END {
        for (w = 1; w <= whats; w++) {
            what = name[w]
            if (what == "dab") continue
            off = cost[what, "off", 256] - cost[what, "off", 64]
            unnamed = cost[what, "unnamed", 256] - cost[what, "unnamed", 64]
            many = samples[what, "unnamed", 256] - samples[what, "unnamed", 64]
            printf "%-36s %8.1f instructions a sample, unnamed %8.1f: %+.2f %%\n", what, off / many,
                   unnamed / many, 100 * (off / unnamed - 1)
            if (off > 1.01 * unnamed) wrong("more than 1 % dearer than never named: " what)
            if (samples[what, "off", 256] != samples[what, "unnamed", 256]) wrong("other samples: " what)
        }
        for (i = 0; i < 2; i++) {
            size = i ? 1024 : 256
            share[i] = samples["dab", "dab", size] / samples["dab", "all", size]
            spent[i] = cost["dab", "dab", size]
            part = spent[i] / cost["dab", "all", size]
            printf "a dab on %4d x %-4d %9d instructions: %.3f of the whole picture for %.3f of its samples\n", size,
                   size, spent[i], part, share[i]
            if (!(share[i] > 0 && share[i] < 0.3)) wrong("the dab reaches too much, or nothing")
            if (part > 1.15 * share[i] + 0.05) wrong("a dab costs more than its tiles")
        }
        if (spent[1] > 1.25 * spent[0]) wrong("a dab costs more on a larger table")
        exit failed
    }' "$folder/counts"
