#!/usr/bin/env bash
# Completions: bash completes subcommands, options, kinds and verbs; the scripts of zsh and fish are read by these shells where they
# are installed.  completion.sh PROGRAM
set -uo pipefail
program=$1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1

fail() {
    printf 'completion: %s\n' "$*"
    exit 1
}

for shell in bash zsh fish; do
    "$program" help --completion $shell >$shell 2>err || fail "$(cat err)"
    [[ $(wc -l <$shell) -ge 30 ]] || fail "$shell: the script is too short"
    command -v $shell >/dev/null || continue
    $shell -n ./$shell 2>err || fail "$shell: $(cat err)"
done
"$program" help --completion csh >out 2>err
[[ $? == 2 ]] || fail "csh is not refused"

# shellcheck source=/dev/null
source ./bash
# complete WORD... EXPECTED: the last word of the line is completed to these words.
completes() {
    local expected=${*: -1}
    COMP_WORDS=(wrinkle "${@:1:$#-1}")
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    COMPREPLY=()
    _wrinkle
    [[ ${COMPREPLY[*]} == "$expected" ]] || fail "${COMP_WORDS[*]}: ${COMPREPLY[*]}, not $expected"
}
touch document.exr
completes ren render
completes render --si --size
completes render --isa v4 v4
completes export --as norm "normal+y normal-y normal-object normal-baked"
completes export --as unr unreal
completes check --as norm ""
completes help gra grain
completes render docu document.exr
# Every option that a subcommand's help names is completed.
for subcommand in $("$program" --help | sed -nE '/^subcommands:/,/^$/s/^  ([a-z]+) .*/\1/p'); do
    for option in $("$program" "$subcommand" --help | grep -oE '^  (-o, )?--[a-z-]+' | grep -oE -- '--[a-z-]+'); do
        COMP_WORDS=(wrinkle "$subcommand" "$option") COMP_CWORD=2
        _wrinkle
        [[ " ${COMPREPLY[*]} " == *" $option "* ]] || fail "$subcommand $option is not completed"
    done
done
