#!/usr/bin/env bash
# The C programs of the guide's page on the library, compiled and run against an installed copy; the header in C and C++; and the
# library's interface: names, sizes of structs, version.  guide_programs.sh BUILD-FOLDER SOURCE-FOLDER
set -uo pipefail
build=$1 source=$2
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1

fail() {
    printf 'library: %s\n' "$*"
    exit 1
}

cmake --install "$build" --prefix "$folder/prefix" >log 2>&1 || fail "$(cat log)"
mv prefix moved # the library finds its files where it lies
lib=$(dirname "$(find moved -name 'libwrinkle.so')")
sed -i "s|^prefix=.*|prefix=$folder/moved|" "$lib/pkgconfig/wrinkle.pc"
export PKG_CONFIG_PATH=$lib/pkgconfig LD_LIBRARY_PATH=$PWD/$lib
read -ra flags < <(pkg-config --cflags --libs wrinkle) || fail "pkg-config does not find wrinkle"
mapfile -t sanitize < <(grep -oE '^WR_SANITIZE:[A-Z]+=.+' "$build/CMakeCache.txt" | sed 's/.*=/-fsanitize=/')
export ASAN_OPTIONS=${ASAN_OPTIONS:-}:verify_asan_link_order=0

# ---- the programs ----
awk '/^```c$/ { n++; on = 1; next } /^```$/ { on = 0 } on { print > ("program" n ".c") }' "$source/ui/guide/library.md"
expected=("300 x 200 normals" "F 0.294, dF/du 7.62; a solid; after undo 512 x 512 texels" $'rendered\ncancelled')
for i in 1 2 3; do
    cc -std=c17 -Wall -Wextra -Werror "${sanitize[@]}" -o "program$i" "program$i.c" "${flags[@]}" -lm -lpthread 2>log ||
        fail "program $i is not compiled: $(cat log)"
    said=$("./program$i" 2>&1) || fail "program $i: $said"
    [[ $said == "${expected[i - 1]}" ]] || fail "program $i printed '$said', not '${expected[i - 1]}'"
done
[[ ! -f program4.c ]] || fail "the page has a fourth program: add what it prints here"

# The map of the first program has the codes of a file by the program.
printf 'table 300x200\npattern bricks across=6 rows=8\ncell 3,2\nexport normal+y n.png depth=16\n' >n.wrinkle
moved/bin/wrinkle run n.wrinkle 2>log || fail "$(cat log)"
[[ $(compare -metric AE n.png normals.ppm null: 2>&1) == 0 ]] || fail "normals.ppm and n.png differ"

# ---- the places of files ----
# A library in lib/TRIPLET has the modules' folder `wrinkle` beside it; program, reader and data are found by its path to bin.
mkdir -p deep/lib/wrinkle
cp "$lib/libwrinkle.so.0" deep/lib/
ln -s ../moved/bin deep/bin
LD_LIBRARY_PATH=$PWD/deep/lib ./program2 >said 2>&1 || fail "with the library in another folder: $(cat said)"

# ---- the interface ----
printf '#include <wrinkle.h>\nint main() { return wr_doc_version() == nullptr; }\n' >header.cpp
c++ -std=c++17 -Wall -Wextra -Werror "${sanitize[@]}" header.cpp -o header "${flags[@]}" 2>log || fail "in C++: $(cat log)"
nm -D --defined-only "$lib/libwrinkle.so" | awk '$2 == "T" { sub(/@.*/, "", $3); print $3 }' | sort >names
grep -oE '\bwr_doc_[a-z_]+\(' "$source/src/api/wrinkle.h" | tr -d '(' | sort -u >declared
diff names declared >log || fail "exported and declared names differ: $(cat log)"
strangers=$(nm -D --defined-only "$lib/libwrinkle.so" | awk '$2 ~ /[A-Z]/ && $2 != "A"' | grep -cv ' wr_doc_')
[[ $strangers == 0 ]] || fail "$strangers other names are visible"
[[ $(wc -l <names) -le 40 ]] || fail "more than 40 functions"
[[ $(readelf -d "$lib/libwrinkle.so" | grep -oE 'libwrinkle\.so\.[0-9]+') == libwrinkle.so.0 ]] || fail "another SONAME"
# Sizes of version 0 on 64-bit systems; another size is another SONAME. (WrDocOptions may grow: it states its size.)
cat >sizes.c <<'C'
#include <stdio.h>
#include <wrinkle.h>
int main(void)
{
    printf("%zu %zu %zu %zu %zu %zu %zu\n", sizeof(WrDocError), sizeof(WrDocOptions), sizeof(WrDocInfo), sizeof(WrDocLayer),
           sizeof(WrDocArray), sizeof(WrDocMap), sizeof(WrDocSample));
}
C
cc "${sanitize[@]}" -o sizes sizes.c "${flags[@]}" || fail "sizes.c is not compiled"
[[ $(./sizes) == "516 56 64 288 40 544 48" ]] || fail "sizes of structs: $(./sizes)"
