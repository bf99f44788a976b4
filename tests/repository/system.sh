#!/usr/bin/env bash
# What belongs to one system stands in src/system, and all else compiles with C17 and the libraries alone:
#   - no file outside includes a header that neither C17, C++17 nor a library has;
#   - the build gives nobody but src/system more names than those;
#   - in src/system, what only Linux has is in linux.c or NAME_linux.c, with plain.c or NAME_plain.c beside it; all other files are content with
#     what POSIX says, and the plain ones have the same functions.
# There is no list of exceptions.  system.sh SOURCE-FOLDER BUILD-FOLDER
set -uo pipefail
build=$(cd "$2" && pwd) || exit 1
cd "$1" || exit 1
bad=0
complain() {
    printf '%s\n' "$*"
    bad=1
}

# Headers of C17 and C++17 that we use or may, and how those of libraries begin (tests/repository/rooms.sh says who may have which).
c17='assert|complex|ctype|errno|fenv|float|inttypes|iso646|limits|locale|math|setjmp|signal|stdalign|stdarg|stdatomic|stdbool|stddef|stdint|stdio|stdlib|stdnoreturn|string|tgmath|time|uchar|wchar|wctype'
cpp='c[a-z]+|[a-z_]+'
libraries='SDL|imgui|X11/|wayland|tablet-unstable|OpenImageIO/|openexr|libdeflate|png\.h|assimp/|librsvg/|ft2build|freetype/|hb|fribidi|fontconfig/|dbus/|zlib|zip\.h|expat|sleef|xxhash|sha256|libmypaint|mypaint|json-c/|md4c|cpuid|immintrin'

# Lines of the files named that include another system's header.
strangers() {
    grep -nHE '^[[:space:]]*#[[:space:]]*include[[:space:]]*<' "$@" |
        grep -vE "<($c17)\.h>|<($libraries)" | grep -vE "\.(cpp|hpp):.*<($cpp)>"
}

mapfile -t outside < <(find src ui -path src/system -prune -o \( -name '*.c' -o -name '*.h' -o -name '*.cpp' -o -name '*.hpp' \) -print | sort)
[[ ${#outside[@]} -ge 300 ]] || complain "only ${#outside[@]} files found: is this the right folder?"
if strangers "${outside[@]}"; then complain 'these headers belong to one system: src/system has what stands for them (src/README.md)'; fi

# Names that a library's header brings along count as well: without these no such name is declared in a C file.
if [[ -f $build/compile_commands.json ]]; then
    if grep -E '^ *"command": ' "$build/compile_commands.json" | grep -E -- ' -c [^ ]*/(src|ui)/[^ ]*\.c"?' |
        grep -vE -- ' -c [^ ]*/(src/system|tests)/' |
        grep -E -- '-D_(GNU|POSIX(_C)?|XOPEN|DEFAULT|BSD)_?SOURCE|-std=gnu' | cut -c -200; then
        complain 'the build gives these more names than C17 and the libraries have'
    fi
fi

# ---- the room itself ----

trial=$(mktemp -d) || exit 1
trap 'rm -rf "$trial"' EXIT

# compiled FILE NAMES...: as it would be with these names declared; its own global functions.
compiled() {
    local file=$1
    shift
    "${CC:-cc}" -std=c17 "$@" -DWR_PLAIN_SYSTEM=1 -Isrc -c -o "$trial/one.o" -Wall -Wextra -Werror=implicit-function-declaration "$file" &&
        nm --extern-only --defined-only "$trial/one.o" | awk '$2 == "T" && $3 ~ /^wr_/ { print $3 }' | sort
}

posix=(-D_POSIX_C_SOURCE=200809L -D_XOPEN_SOURCE=700)
for file in src/system/*.c; do
    [[ $file != *linux.c ]] || continue
    compiled "$file" "${posix[@]}" >"$trial/plain" || complain "$file: wants more than POSIX says"
    [[ $file == *plain.c ]] || continue
    other=${file/plain.c/linux.c}
    [[ -f $other ]] || { complain "$file: has no $other beside it"; continue; }
    compiled "$other" -D_GNU_SOURCE >"$trial/linux" || complain "$other: is not for this system"
    diff "$trial/linux" "$trial/plain" || complain "$file: has not the functions of $other"
done
for file in src/system/*linux.c; do
    [[ -f ${file/linux.c/plain.c} ]] || complain "$file: has no plain form beside it"
done
for file in src/system/*.h; do
    grep -q 'Belongs to one system' "$file" || complain "$file: does not say that it belongs to one system"
done

# ---- would it tell? ----

for header in unistd.h sys/stat.h pthread.h linux/landlock.h windows.h; do
    printf '#include <string.h>\n#  include <%s>\n' "$header" >"$trial/one.c"
    strangers "$trial/one.c" >/dev/null || complain "this check does not notice <$header>"
done
exit $bad
