#!/bin/sh
# Starts the program of a folder that was not installed (package.sh --tarball). The folder's libraries for windows are used where
# the system lacks one of them.
here=$(dirname "$(readlink -f "$0")")
modules=$here/../@modules@
known=$(/sbin/ldconfig -p 2>/dev/null)
for file in "$modules"/desktop/*; do
    case $known in
    *"${file##*/} "*) ;;
    *)
        export LD_LIBRARY_PATH="$modules/desktop${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
        break
        ;;
    esac
done
exec "$here/wrinkle-program" "$@"
