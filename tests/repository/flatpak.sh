#!/usr/bin/env bash
# The Flatpak manifest has all that the build requires: each package of ui/setup.sh and each library that CMake looks for is a word
# of its lines "runtime:", or of the line "for:" above a module. Its names are those of the desktop's files.
# flatpak.sh SOURCE-FOLDER
set -uo pipefail
root=$1
# shellcheck source=ui/setup.sh
source "$root/ui/setup.sh"
cd "$root" || exit 1
manifest=ui/desktop/org.wrinkle.Wrinkle.yml
bad=0
complain() {
    printf '%s: %s\n' "$manifest" "$*"
    bad=1
}

# ---- libraries ----

# Arguments of the commands that look for libraries, without options, which are capitals.
libraries=$(find src ui \( -name CMakeLists.txt -o -name '*.cmake' \) -exec cat {} + |
    sed -nE 's/^ *(pkg_check_modules|find_library|find_path)\([A-Za-z0-9_]+ ([^)]*)\).*/\2/p' |
    sed 's/PATH_SUFFIXES.*//' | tr ' ' '\n' | grep '[a-z]' | sort -u)
[[ $(wc -w <<<"$libraries") -ge 25 ]] || complain "only these libraries were found in CMake's files: $libraries"
modules=$(sed -n 's/^  - name: //p' "$manifest")
[[ $(wc -w <<<"$modules") -ge 20 ]] || complain "only these modules were found: $modules"
words=$(sed -nE 's/^ *# (runtime|for): //p' "$manifest" | tr ' ' '\n')
required=$(printf '%s\n' "${wr_program_packages[@]}" "$libraries" "$modules")
while IFS= read -r word; do
    complain "no module is for $word, and the runtime has none by its lines"
done < <(printf '%s\n' "${wr_program_packages[@]}" "$libraries" | grep -vxF "$words")
while IFS= read -r word; do
    complain "nothing requires $word"
done < <(grep -vxF "$required" <<<"$words")

# ---- modules ----

# Each has a line above it that names what it is for, a library of another module before that module; each archive is that of a
# release and has a sum, or the mark for one.
problems=$(awk '
/^  - name: / {
    if (above !~ /^  # for: ./) print $3 ": no line \"for:\" above it"
    count = split(above, word, " ")
    for (i = 3; i <= count; i++) if (word[i] in built) print $3 ": " word[i] " is built before it"
    built[name = $3]
}
/^ +url: / {
    if (!/: https:.*[0-9]\.(zip|tar\.[gx]z)$/) print name ": no archive of a release: " $2
    getline
    if (!/^ +sha256: FILL-IN-AT-RELEASE$/ && !(/^ +sha256: [0-9a-f]+$/ && length($2) == 64)) print name ": no sum below its address"
}
{ above = $0 }' "$manifest")
[[ -z $problems ]] || complain "$problems"

# ---- names ----

value() { # KEY
    sed -nE "s/^$1: '?([^']*)'?\$/\1/p" "$manifest"
}
grep -q "<id>$(value id)</id>" "ui/desktop/$(value id).metainfo.xml" || complain "the metadata have no id $(value id)"
for name in "$(value rename-desktop-file)" "RENAME $(value rename-icon).svg" 'RENAME wrinkle.xml'; do
    grep -qF -- "$name" ui/desktop/install.cmake || complain "ui/desktop/install.cmake has no $name"
done
# Names within files that flatpak-builder leaves as they are: the commands that rename them find each.
icon=$(value rename-icon)
for place in "<launchable type=\"desktop-id\">$(value rename-desktop-file)<" "<icon type=\"stock\">$icon<" "<icon name=\"$icon\"/>"; do
    grep -qF -- "$place" ui/desktop/*.xml || complain "no file has $place"
    grep -qF -- "${place#*desktop-id\"}" "$manifest" || complain "nothing renames $place"
done
if python3 -c 'import yaml' 2>/dev/null; then
    python3 -c 'import sys, yaml; yaml.safe_load(open(sys.argv[1]))' "$manifest" || complain 'this is no YAML'
fi
exit $bad
