#!/usr/bin/env bash
# ui/desktop/debian agrees with the checkout: version, licence, the packages that a build needs.  packages_source.sh SOURCE-FOLDER
set -uo pipefail
root=$1
# shellcheck source=ui/setup.sh
source "$root/ui/setup.sh"
cd "$root/ui/desktop/debian" || exit 1
bad=0
complain() {
    printf 'packages: %s\n' "$*"
    bad=1
}

version=$(sed -nE 's/^project\(wrinkle VERSION ([0-9.]+) .*/\1/p' "$root/CMakeLists.txt")
changed=$(sed -nE '1s/^wrinkle \((.*)-[0-9]+\) .*/\1/p' changelog)
[[ -n $version && $version == "$changed" ]] || complain "CMakeLists.txt is of version '$version', debian/changelog of '$changed'"
diff <(sed '1,/^Permission/{/^Permission/!d}' "$root/LICENSE") <(sed -n '/^ Permission/,$p' copyright | sed 's/^ //; s/^\.$//') ||
    complain "LICENSE and debian/copyright differ"

# Fonts and presets are needed by the program alone.
listed=$(sed -nE 's/^ ([a-z0-9.+-]+)( \(.*\))?,$/\1/p' control)
for package in "${wr_program_packages[@]}"; do
    [[ $package == build-essential || $'\n'$listed$'\n' == *$'\n'"$package"$'\n'* ]] ||
        complain "ui/setup.sh installs $package, which is not in debian/control"
done
[[ $(wc -l <<<"$listed") -gt 30 ]] || complain "debian/control was not read: $listed"
exit $bad
