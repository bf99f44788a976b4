#!/usr/bin/env bash
# Every global C symbol of ours starts with wr_. C++ names are mangled and so can clash with nobody's. Each global function of the
# window is used by another file: a panel without its row in the registry is not.
# symbols.sh BUILD-FOLDER
set -uo pipefail
cd "$1" || exit 1

sed -nE 's/^ *"command": .* -o ((src|ui|tests)\/[^ ]*\.o) .*/\1/p' compile_commands.json | sort -u |
    while IFS= read -r object; do [[ -f $object ]] && printf '%s\n' "$object"; done |
    xargs nm --print-file-name --extern-only --format=bsd |
    awk '
    $(NF - 1) ~ /^[Uvw]$/ { used[$NF] = 1; next }
    /^tests/ { next }
    # src/base/CMakeFiles/wr_base.dir/text.c.o:0000000000000120 T wr_text_add
    {
        object = $1
        sub(/:.*/, "", object)
        objects[object] = 1
        kind = $2
        symbol = $3
        if (object ~ /^ui/ && kind == "T") window[symbol] = object
        if (symbol ~ /^wr_/ || symbol == "main" || symbol ~ /^_Z/ || kind ~ /^[VWu]$/) next
        if (symbol ~ /^DW\.ref\./) next # what g++ puts there by itself
        printf "%s: global symbol %s (%s) does not start with wr_\n", object, symbol, kind
        bad = 1
    }
    END {
        for (symbol in window)
            if (!(symbol in used)) {
                printf "%s: no other file uses %s: make it static, or give it its row\n", window[symbol], symbol
                bad = 1
            }
        for (object in objects) count++
        if (count < 15) { printf "only %d object files found: was everything built with ninja?\n", count; bad = 1 }
        exit bad
    }'
