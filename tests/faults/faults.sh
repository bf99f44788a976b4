#!/usr/bin/env bash
# The whole program under the library that has calls fail (fault.h): it ends with 1 and a message over the old file, or
# with 0 over the new one; after a kill the next run clears up. Where the libraries are loaded anew for each case, a few
# cases must do; test_faults has them all.  faults.sh WRINKLE SHIM
set -uo pipefail
wrinkle=$1 shim=$2
folder=$(mktemp -d) && cd "$folder" || exit 1
trap 'rm -rf "$folder"' EXIT
export WRINKLE_STATE=$folder/state
bad=0
say() { printf 'faults: %s\n' "$*"; bad=1; }

printf 'table 64x48\ngrid cells=4x3\nlayer add b\ndab 0.5,0.5 radius=9\nsave a.exr\n' >n.wrinkle
"$wrinkle" run n.wrinkle && cp a.exr new || say "it does not run"
old='what was there before'

# MODE KIND N: one run over an old file.
try() {
    local mode=$1 kind=$2 n=$3 status
    printf '%s' "$old" >a.exr
    LD_PRELOAD=$shim WR_FAULT=$kind,$n,$mode,28 "$wrinkle" run n.wrinkle >/dev/null 2>said
    status=$?
    case $status in
    0) cmp -s a.exr new || say "$kind $n, $mode: success, and another file" ;;
    1)
        [[ $(tr -d '\0' <a.exr) == "$old" ]] || say "$kind $n, $mode: an error, and the old file is gone"
        grep -q 'save: a.exr: cannot be written' said || say "$kind $n, $mode: it says: $(<said)"
        ;;
    137) cmp -s a.exr new || [[ $(tr -d '\0' <a.exr) == "$old" ]] || say "$kind $n, $mode: neither file" ;;
    *) say "$kind $n, $mode: it ends with $status" ;;
    esac
    [[ $mode != kill || $status == 137 ]] || say "$kind $n: no such call"
    [[ $mode != kill ]] || "$wrinkle" run n.wrinkle || say "after $kind $n, $mode: it does not run"
    [[ -z $(find . -maxdepth 1 -name '.?*' -print) ]] || say "$kind $n, $mode: $(ls -A) stays"
}

try error write 3
try error rename 1
try short write 6
try kill write 6
try kill rename 1
if [[ ${WR_FULL:-} == 1 ]]; then
    for n in {1..16}; do
        try error write "$n"
        try kill write "$n"
    done
    for kind in open sync close; do
        try error $kind 1
        try kill $kind 1
    done
fi
exit $bad
