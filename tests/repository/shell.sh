#!/usr/bin/env bash
# The shell scripts, under shellcheck.  shell.sh SOURCE-FOLDER
set -uo pipefail
cd "$1" || exit 1
if ! command -v shellcheck >/dev/null; then
    printf 'shellcheck is missing: apt-get install shellcheck\n'
    exit 1
fi
# Those that are sourced have no first line of their own and are read where they are used.
{
    find ui tests -name '*.sh' -exec grep -l '^#!' {} +
    ls samples/*.sh
    printf '.ci/run\n'
} | sort | xargs shellcheck --severity=warning --shell=bash --external-sources --check-sourced
