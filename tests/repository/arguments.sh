#!/usr/bin/env bash
# Every argument that a command's handler asks for by name is in a row of the same file, or among those of the brush or
# of the scene:
# what is not there would be read as nothing. And no file recognises a command by its handler, its row's address or its
# name: what the session does otherwise for a command is a column of its row.  arguments.sh SOURCE-FOLDER
set -uo pipefail
cd "$1/src/command" || exit 1
bad=0 seen=0
for file in *_command.c *_commands.c; do
    rows=$(grep -ohE '\.name = "[^"]+"|\b[A-Z_]+\("[^"]+"' "$file" args.h |
        sed -E 's/.*"([^"]+)".*/\1/'; grep -ohE '"[a-z]+", ("[a-z]+"|NULL), "[^"]+"' ../scene/param.c |
        sed -E 's/.*"([^"]+)"$/\1/')
    while read -r name; do
        seen=$((seen + 1))
        grep -qxF -- "$name" <<<"$rows" && continue
        printf '%s: asks for the argument "%s", which no row of it has\n' "$file" "$name"
        bad=1
    done < <(grep -ohE 'wr_call_[a-z0-9_]+\((call|line|[a-z]+->call), "[^"]+"' "$file" | sed -E 's/.*"([^"]+)"/\1/' | sort -u)
done
if grep -nE '[!=]= *&?wr_(run_|command_[a-z]+\b)|(command|call)->run *[!=]=|strcmp\([a-z>.-]*command->name,' -r --include='*.c' . ../../ui; then
    printf 'a command is recognised by its handler, address or name: make it a column of WrCommand\n'
    bad=1
fi
((seen > 40)) || { printf 'only %d arguments found: is this the right folder?\n' "$seen"; bad=1; }
exit $bad
