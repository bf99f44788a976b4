#!/usr/bin/env bash
# What is installed is built so that damage by a hostile file is hard to use: position-independent, tables of
# addresses read-only from the start, stacks that notice and cannot be run, checked copies.
# hardened.sh BUILD-FOLDER FORTIFIED(1|0)
set -uo pipefail
cd "$1" || exit 1
fortified=$2
failures=0

complain() {
    printf '%s\n' "$*"
    failures=$((failures + 1))
}

for file in wrinkle wrinkle-reader wrinkle_oiio.so wrinkle_assimp.so wrinkle_librsvg.so wrinkle_window.so; do
    [[ -f $file ]] || { complain "$file is not built"; continue; }
    header=$(readelf -hW "$file") segments=$(readelf -lW "$file") dynamic=$(readelf -dW "$file")
    symbols=$(readelf --dyn-syms -W "$file")
    [[ $header =~ Type:\ +DYN ]] || complain "$file: has fixed addresses"
    [[ $file == *.so || $dynamic =~ FLAGS_1.*PIE ]] || complain "$file: is no position-independent program"
    [[ $segments == *GNU_RELRO* ]] || complain "$file: its tables of addresses can be written"
    [[ $dynamic =~ FLAGS.*NOW ]] || complain "$file: resolves addresses late, so that the tables stay open"
    grep -qE 'GNU_STACK.* RW ' <<<"$segments" || complain "$file: its stack can be run, or is not said not to"
    [[ $symbols == *__stack_chk_fail* ]] || complain "$file: its stacks notice nothing"
    [[ $dynamic != *TEXTREL* ]] || complain "$file: writes to its own code"
    while read -r flags; do
        [[ $flags != *W*E* ]] || complain "$file: a segment can be written and run"
    done < <(awk '$1 == "LOAD" { print $7 $8 $9 }' <<<"$segments")
done

# Checked copies leave no trace where no size is known: the compiler was asked for them.
seen=0
while read -r commands; do
    seen=$((seen + 1)) source=${commands##* }
    [[ $commands == *-fstack-protector-strong* ]] || complain "$source is built without stacks that notice"
    [[ $fortified == 0 || $commands == *-D_FORTIFY_SOURCE=2* ]] || complain "$source is built without checked copies"
done < <(grep -E '"command": .*/(src|ui)/[^ ]*"' compile_commands.json | grep -v ' -o tests/')
((seen > 300)) || complain "only $seen files were looked at"

((failures == 0)) || exit 1
