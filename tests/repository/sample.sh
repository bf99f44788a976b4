#!/usr/bin/env bash
# A sample runs without a word of complaint, writes the files that its lines name and no others, and gives
# the same document and the same files whatever the number of threads. What is kept of it in
# samples/figures comes out of it again: the picture of its name, and files that its lines write, pixel by
# pixel.  sample.sh SCRIPT PROGRAM
# WR_BLESS=1 in the environment replaces these pictures, to be looked at before they are kept.
set -uo pipefail
script=$1 program=$2
figures=$(dirname "$script")/figures name=$(basename "$script" .wrinkle)
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1

fail() {
    printf '%s: %s\n' "$script" "$*"
    exit 1
}
# kept FILE: if a file of that name is kept, it shows the same.
kept() {
    local name different old
    name=$(basename "$1")
    old=$figures/$name
    [[ -f $old ]] || return 0
    if [[ -n ${WR_BLESS:-} && $1 == *.png ]]; then
        convert "$1" -strip -define png:compression-level=9 -define png:compression-filter=5 "$old"
    elif [[ -n ${WR_BLESS:-} ]]; then
        cp "$1" "$old"
    fi
    if [[ $1 == *.png ]]; then
        different=$(compare -metric AE "$1" "$old" null: 2>&1)
        [[ $different == 0 ]] || fail "$old is not what comes out: $different pixels differ"
    else
        cmp -s "$1" "$old" || fail "$old is not what comes out"
    fi
}
# What its output lines name: the third word of an export, the second of the others.
sed -nE 's/^export +[^ ]+ +([^ ]+).*/\1/p; s/^(save|render|script) +([^ ]+).*/\2/p' "$script" |
    LC_ALL=C sort >"$folder.named"
trap 'rm -rf "$folder" "$folder.named"' EXIT
# run THREADS: run it, and put what it wrote into a folder of that name.
run() {
    mkdir "$1" && cd "$1" || exit 1
    "$program" run "$script" --threads "$1" >../out 2>../err || fail "run failed: $(cat ../err)"
    # A note on each file that was written, or on a picture of its name that was read, is no complaint.
    sed -i -E "/^wrinkle: note: $name-[a-z]*\\.(jpg|png): /d" ../err
    while read -r file; do
        sed -i "\|^wrinkle: note: $file: |d" ../err
    done <"$folder.named"
    # Nor is what is told of a mesh's file, of a projection, of masks or of baking.
    sed -i -E '/^wrinkle: note: (projection=|masks leave )/d' ../err
    while read -r file; do
        sed -i "\\|^wrinkle: note: [^:]*$file: |d" ../err
    done < <(sed -nE 's/^surface .*file=([^ ]+).*/\1/p; s/^bake ([^ ]+).*/\1/p' "$script")
    [[ ! -s ../err ]] || fail "run complained: $(cat ../err)"
    find . -type f -printf '%P\n' | LC_ALL=C sort | cmp -s - "$folder.named" || fail "run wrote $(ls -A)"
    while read -r file; do
        [[ -s $file ]] || fail "$file is empty"
    done <"$folder.named"
    cd .. && rm out err
}
# Pictures that the sample reads, where a script of its name makes them: the same, as far as JPEG says the same.
if [[ -f ${script%.wrinkle}.sh ]]; then
    mkdir made && bash "${script%.wrinkle}.sh" "$program" made 2>err || fail "${script%.wrinkle}.sh failed: $(cat err)"
    for file in made/*; do
        different=$(compare -metric RMSE "$file" "$(dirname "$script")/$(basename "$file")" null: 2>&1)
        awk -F '[()]' '{ exit !($2 < 0.01) }' <<<"$different" || fail "$(basename "$file") is not what is made: $different"
    done
    rm -r made err
fi
run 1
if [[ -s $folder.named ]]; then
    run 3
    diff -r 1 3 || fail "not the same files on 1 and 3 threads"
fi
while read -r file; do
    kept "1/$file"
done <"$folder.named"
if [[ -f $figures/$name.png ]]; then
    size=$(identify -format %wx%h "$figures/$name.png") || fail "$figures/$name.png cannot be read"
    "$program" render "$script" -o "$name.png" --size "$size" 2>err || fail "render failed: $(cat err)"
    kept "$name.png"
fi
rm -rf 1 3
for threads in 1 2 7; do
    "$program" inspect "$script" --threads "$threads" >"$threads" 2>err || fail "inspect failed: $(cat err)"
done
[[ -s 1 ]] || fail "inspect printed nothing"
cmp -s 1 2 && cmp -s 1 7 || fail "not the same document on 1, 2 and 7 threads"
