#!/usr/bin/env bash
# A help text that explains the choices of an argument, "fbm: round hills; billow: lumps", names choices that exist.
# help_words.sh PROGRAM
set -uo pipefail
unknown=$("$1" help --json | jq -r '
    .. | objects | select(.choices? and .help?)
    | . as $arg
    | [.help | match("(?:^|[.;] )([a-z][a-z0-9-]*(?:, [a-z][a-z0-9-]*)*):(?= )"; "g").captures[0].string | split(", ")[]]
    | map(select(. as $word | $arg.choices | index($word) | not))[]
    | "\($arg.name)=: \(.) is not one of \($arg.choices | join(", "))"') || exit 1
explained=$("$1" help --json | jq '[.. | objects | select(.choices? and .help?) | select(.help | test("(^|[.;] )[a-z][a-z0-9-]*: "))] | length')
[[ $explained -ge 40 ]] || { echo "help_words: only $explained arguments explain their choices"; exit 1; }
[[ -z $unknown ]] || { printf 'help_words: %s\n' "$unknown"; exit 1; }
