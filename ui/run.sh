#!/usr/bin/env bash
# Bring Wrinkle up to date and start it: bash ui/run.sh [arguments of wrinkle]
#
# Installs the Debian packages that are missing, builds an optimised program for this processor in build/
# if anything changed, and becomes the program: output and exit status are the program's own, and the current
# folder stays the caller's. A build folder with other options (tests, all instruction sets) keeps them. Whatever this script itself has to say goes to standard error.
set -euo pipefail

root=$(CDPATH='' cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd -P)
build=${WRINKLE_BUILD:-$root/build}
# shellcheck source=ui/setup.sh
source "$root/ui/setup.sh"

wr_install_packages "${wr_program_packages[@]}"
wr_build "$build" wrinkle '?CMAKE_BUILD_TYPE=Release' WR_SANITIZE= '?WR_TESTS=OFF' '?WR_KERNELS=native'

# A window needs a display (or SDL told to do without one).
if [[ -z ${DISPLAY:-}${WAYLAND_DISPLAY:-}${SDL_VIDEODRIVER:-} && ( $# -eq 0 || $1 == paint ) && $# -le 2 ]]; then
    file=${2:-$root/samples/bricks.wrinkle}
    picture=$build/starter.png
    wr_say "no display for the window (DISPLAY and WAYLAND_DISPLAY are not set); rendering $file to $picture instead"
    set -- render "$file" -o "$picture" --size 1024x1024
fi
exec "$build/wrinkle" "$@"
