#!/usr/bin/env bash
# ui/run.sh, on a toy checkout whose program says what it was given: builds when it must, adds nothing to
# the program's output, passes its exit status on, keeps the caller's folder.  start.sh SOURCE-FOLDER
set -uo pipefail
source=$1
folder=$(readlink -f "$(mktemp -d)") || exit 1
trap 'rm -rf "$folder"' EXIT
unset DISPLAY WAYLAND_DISPLAY SDL_VIDEODRIVER WRINKLE_BUILD
toy="$folder/a checkout"
mkdir -p "$toy"/{src,ui,tests,samples} "$folder/elsewhere"
cp "$source/ui/run.sh" "$source/ui/setup.sh" "$toy/ui/"
cat >"$toy/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(toy C)
set(WR_SANITIZE "" CACHE STRING "")
option(WR_TESTS "" ON)
add_executable(wrinkle src/main.c)
set_target_properties(wrinkle PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
END
cat >"$toy/src/main.c" <<'END'
#include <stdio.h>
#include <unistd.h>
int main(int count, char **argument)
{
    char folder[4096];
    printf("in %s\n", getcwd(folder, sizeof folder));
    for (int i = 1; i < count; i++) printf("<%s>\n", argument[i]);
    return 7;
}
END
cd "$folder/elsewhere" || exit 1

bad=0
fail() {
    printf 'ui/run.sh: %s\n' "$*"
    [[ -s err ]] && sed 's/^/    /' err
    bad=1
}
# start ARGUMENT...: run it; its output in out, err, its exit status in status; milliseconds of processors in spent, which
# other work on the machine hardly changes.
start() {
    local TIMEFORMAT='%U %S'
    { time bash "$toy/ui/run.sh" "$@" >out 2>err; } 2>spent.txt
    status=$?
    spent=$(awk '{ printf "%d", 1000 * ($1 + $2) }' spent.txt)
}
expect() {
    [[ $status -eq 7 ]] || fail "$1: exit status $status instead of 7"
    [[ $(cat out) == "$2" ]] || fail "$1: output is $(cat out)"
}
here=$folder/elsewhere

start a 'b  c' --d=''
expect "first start" "in $here"$'\n<a>\n<b  c>\n<--d=>'
[[ -s err ]] || fail "the first start builds and says nothing"
built=$spent

start again
expect "second start" "in $here"$'\n<again>'
[[ ! -s err ]] || fail "the second start is not quiet"
[[ $((3 * spent)) -lt $built ]] || fail "the second start took $spent ms of processors, the first one $built"

# A folder that was configured for the tests stays so when it is configured anew.
cmake -S "$toy" -B "$toy/build" -DWR_TESTS=ON >/dev/null
touch -d '+2 seconds' "$toy/CMakeLists.txt"
start again
expect "configured anew" "in $here"$'\n<again>'
grep -q '^WR_TESTS:[A-Z]*=ON$' "$toy/build/CMakeCache.txt" || fail "an option of the folder is lost: $(grep WR_TESTS "$toy/build/CMakeCache.txt")"
touch "$toy/CMakeLists.txt"

ln -s "$toy/ui/run.sh" link
bash link x >out 2>err
status=$?
expect "through a link" "in $here"$'\n<x>'
cd "$toy" || exit 1
bash ui/run.sh y >"$here/out" 2>"$here/err"
status=$?
cd "$here" || exit 1
expect "from the checkout" "in $toy"$'\n<y>'

for arguments in '' paint; do
    # shellcheck disable=SC2086
    start $arguments
    expect "without a display" "in $here"$'\n'"<render>
<$toy/samples/bricks.wrinkle>
<-o>
<$toy/build/starter.png>
<--size>
<1024x1024>"
    [[ $(wc -l <err) -eq 1 ]] && grep -qF "$toy/build/starter.png" err || fail "no display: not one line with the file"
done
DISPLAY=:99 start paint
expect "with a display" "in $here"$'\n<paint>'

sed -i 's/return 7/return 8/' "$toy/src/main.c"
for i in 1 2 3; do
    bash "$toy/ui/run.sh" >"out$i" 2>"err$i" together &
done
for i in 1 2 3; do
    wait -n
    [[ $? -eq 8 ]] || fail "three at once: one did not end with the program's status"
done
[[ $(cat out1 out2 out3) == $(printf "in $here\n<together>\n%.0s" 1 2 3) ]] || fail "three at once: $(cat out?)"

printf 'int broken(\n' >>"$toy/src/main.c"
start z
[[ $status -ne 0 && $status -ne 8 && ! -s out ]] || fail "a broken build: exit status $status"
grep -q 'main.c:' err || fail "a broken build does not show the compiler's message"
exit $bad
