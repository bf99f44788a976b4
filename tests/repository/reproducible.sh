#!/usr/bin/env bash
# Two builds from two folders give the same bytes, and name neither folder.  reproducible.sh SOURCE-FOLDER WORK-FOLDER [TARGET]
set -uo pipefail
source=$1 work=$2 target=${3:-wrinkle}
export CCACHE_DISABLE=1 # it may return an object of another folder
bad=0
complain() {
    printf 'reproducible: %s\n' "$*"
    bad=1
}
rm -rf "$work"
first=$work/a second=$work/another-folder/of-another-length
trap 'rm -rf "$work"' EXIT
generator=()
! command -v ninja >/dev/null || generator=(-G Ninja)
mkdir -p "$first/checkout" "$second"
(cd "$source" && git ls-files -z --cached --others --exclude-standard | xargs -0 cp --parents -t "$first/checkout" 2>/dev/null)
cp -r "$first/checkout" "$second"
for folder in "$first" "$second"; do
    # One build folder is in the checkout, the other beside it.
    build=$folder/checkout/build
    [[ $folder == "$first" ]] || build=$folder/outside
    { cmake -S "$folder/checkout" -B "$build" "${generator[@]}" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DWR_TESTS=OFF -DWR_BENCH=OFF &&
        cmake --build "$build" --target "$target" --parallel "$(nproc)"; } >"$work/log" 2>&1 ||
        { complain "the build in $folder fails: $(tail -n 5 "$work/log")"; exit 1; }
    ln -s "$build" "$folder/built"
done
count=0
for file in "$first"/built/wrinkle "$first"/built/wrinkle-reader "$first"/built/*.so*; do
    [[ -f $file ]] || continue
    name=${file##*/}
    count=$((count + 1))
    cmp "$file" "$second/built/$name" || complain "$name differs"
    ! grep -qF "$work" "$file" || complain "$name names its folder: $(strings "$file" | grep -F "$work" | head -n 2)"
done
[[ $count -ge 4 ]] || complain "only $count files were built"
exit $bad
