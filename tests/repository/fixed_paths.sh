#!/usr/bin/env bash
# No string of the program's source names a place of one distribution: fonts are found by Fontconfig, files of other programs in
# XDG_DATA_DIRS, our own beside the program. Each path that stays has its reason here.  fixed_paths.sh SOURCE-FOLDER
set -uo pipefail
cd "$1" || exit 1

# FILE PATH: reason
allowed='
src/base/file.c /tmp: the default of TMPDIR, by POSIX
src/system/plain.c /tmp: the default of TMPDIR, by POSIX
src/base/file.c /usr/local/share:/usr/share: the default of XDG_DATA_DIRS, by its specification
src/cli/output.c /dev/stdout: a word for standard output, never opened
src/system/fd.c /dev/null: POSIX
src/system/plain.c /dev/fd/%d: an interface of Unix systems
src/system/plain.c /dev/urandom: an interface of Unix systems
src/system/linux.c /dev/dri/renderD128: an interface of Linux
src/system/linux.c /proc/self/statm: an interface of Linux
src/system/linux.c /proc/self/exe: an interface of Linux
src/system/linux.c /proc/self/task: an interface of Linux
src/system/linux.c /proc/self/task/%.20s/stat: an interface of Linux
src/system/linux.c /proc/self/fd/%d: an interface of Linux
src/system/linux.c /proc/self/status: an interface of Linux
src/system/linux.c /proc/meminfo: an interface of Linux
'
bad=0
complain() {
    printf '%s\n' "$*"
    bad=1
}

# Strings that begin with a folder of the system, as "FILE PATH"; not in comments.
places='usr|etc|opt|var|home|root|lib(32|64)?|bin|sbin|proc|sys|dev|tmp|run|mnt|media|srv|nix|Library|Applications'
found=$(find src ui \( -name '*.[ch]' -o -name '*.cpp' -o -name '*.hpp' -o -name '*.py' \) -print0 | sort -z |
    xargs -0 awk -v places="^/($places)(/|\$)" '
        FNR == 1 { comment = 0 }
        {
            line = $0
            if (comment && !sub(/^.*\*\//, "", line)) next
            gsub(/\/\*([^*]|\*[^\/])*\*\//, "", line)
            comment = sub(/\/\*.*$/, "", line)
            count = split(line, part, "\"")
            for (i = 2; i <= count; i += 2) if (part[i] ~ places) print FILENAME, part[i]
        }' | sort -u)
[[ $(wc -l <<<"$found") -ge 10 ]] || complain "only these paths were found: is this the right folder? $found"
while IFS= read -r line; do
    grep -qF "$line: " <<<"$allowed" || complain "${line%% *}: fixed path ${line#* }: ask Fontconfig (wr_font_file), wr_shared_find or wr_data_find"
done <<<"$found"
while IFS= read -r line; do
    [[ -z $line ]] || grep -qxF "${line%%: *}" <<<"$found" || complain "tests/repository/fixed_paths.sh: ${line%%: *} is no longer there"
done <<<"$allowed"
exit $bad
