#!/usr/bin/env bash
# A sample runs without a word of complaint, writes nothing, and gives the same document whatever the
# number of threads.  sample.sh SCRIPT PROGRAM
set -uo pipefail
script=$1 program=$2
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1

fail() {
    printf '%s: %s\n' "$script" "$*"
    exit 1
}
"$program" run "$script" >out 2>err || fail "run failed: $(cat err)"
[[ ! -s err ]] || fail "run complained: $(cat err)"
rm -f out err
[[ -z $(ls -A) ]] || fail "run wrote $(ls -A)"
for threads in 1 2 7; do
    "$program" inspect "$script" --threads "$threads" >"$threads" 2>err || fail "inspect failed: $(cat err)"
done
[[ -s 1 ]] || fail "inspect printed nothing"
cmp -s 1 2 && cmp -s 1 7 || fail "not the same document on 1, 2 and 7 threads"
