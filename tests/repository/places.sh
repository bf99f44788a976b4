#!/usr/bin/env bash
# Ways of installing in bare systems: the folder that runs anywhere (package.sh --tarball), by root in /opt and by a user without
# rights at home, packages, where some were made for that release, and with --source this checkout, built by ui/run.sh. Each is used for a
# first picture and a window, moved (the folder), and removed; it fails if anything is left. Prints a table with seconds and megabytes.
# Needs root and a mirror.
#   places.sh [--source] TARBALL SUITE[=FOLDER of its packages]...    e.g. places.sh wrinkle-1.0.0-x86_64.tar.xz bookworm trixie noble
set -uo pipefail
source=
[[ ${1:-} != --source ]] || { source=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd -P) && shift; }
tarball=$1
shift
folder=$(mktemp -d) || exit 1
trap 'rm -rf --one-file-system "$folder"' EXIT
cd "$folder" || exit 1

fail() {
    printf 'places: %s\n' "$*"
    exit 1
}

[[ $(id -u) -eq 0 ]] || { printf 'places: must be run by root, who can make systems\n'; exit 77; }
command -v mmdebstrap >/dev/null || fail "mmdebstrap is missing: apt-get install mmdebstrap"
[[ -s $tarball ]] || fail "$tarball is no file; bash ui/desktop/package.sh --tarball makes it"

# inside USER COMMAND...: in the system, with processes of its own.
inside() {
    unshare --mount --pid --fork bash -c '
        mount -t proc proc "$0/proc" &&
            exec chroot --userspec="$1" "$0" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/home/painter LC_ALL=C.UTF-8 \
                DEBIAN_FRONTEND=noninteractive "${@:2}"' "$system" "$@" </dev/null
}

# A document and its picture; the window without a display.
cat >use.sh <<'END_OF_USE'
# use.sh PROGRAM
set -eu
cd
printf 'table 256x256\npattern bricks across=4 rows=6\nstroke preset=rope radius=14 strength=0.6 points=0.1,0.2;0.9,0.3\nsave mine.exr\n' >mine.wrinkle
"$1" run mine.wrinkle
"$1" render mine.exr -o picture.png --size 512x512
rm -rf .config
SDL_VIDEODRIVER=dummy "$1" paint mine.exr 2>window.log &
window=$!
until [ -e .config/wrinkle/window.lock ]; do
    kill -0 $window || { cat window.log; exit 1; }
    sleep 0.05
done
while kill -INT $window 2>/dev/null; do sleep 0.1; done
[ -z "$(grep -v interrupted window.log)" ] || { cat window.log; exit 1; }
[ "$(find / -xdev -newer mine.wrinkle -type f -not -path '/proc/*' -not -path '/home/*' -not -path '/tmp/*' 2>/dev/null)" = '' ] ||
    { echo "files outside the home folder were written"; exit 1; }
END_OF_USE

# Files and packages of the system, without caches and records of the package tools.
census() {
    find "$system" -xdev \( -path "$system/var/cache" -o -path "$system/var/lib/apt" -o -path "$system/var/lib/dpkg" -o -path "$system/var/log" \
        -o -path "$system/home" -o -path "$system/proc" -o -path "$system/tmp" -o -path "$system/given" \) -prune -o -type f -printf '/%P\n' | sort
}

megabytes() { du -sm --exclude=proc "$system" | cut -f 1; }

# row WAY WHO USER INSTALL REMOVE PROGRAM: a line of the table.
row() {
    local way=$1 who=$2 user=$3 install=$4 remove=$5 program=$6 begin size_before size left
    census >before
    size_before=$(megabytes)
    begin=$EPOCHREALTIME
    inside "$user" sh -c "$install" >log 2>&1 || fail "$suite, $way: $(tail -n 20 log)"
    local seconds=$((${EPOCHREALTIME/./} - ${begin/./}))
    size=$(($(megabytes) - size_before))
    inside 1000:1000 sh /given/use.sh "$program" >log 2>&1 || fail "$suite, $way: $(tail -n 20 log)"
    begin=$EPOCHREALTIME
    inside 1000:1000 sh -c "cd && '$program' render mine.exr -o picture.png --size 512x512" >log 2>&1 || fail "$suite, $way: $(cat log)"
    local picture=$((${EPOCHREALTIME/./} - ${begin/./}))
    inside "$user" sh -c "$remove" >log 2>&1 || fail "$suite, $way: $(tail -n 20 log)"
    census >after
    # Other packages leave settings, caches and lists of users; nothing of ours may stay, and nothing at all of the folder.
    left=$(comm -13 before after | if [[ $way != folder ]]; then grep -i wrinkle; else cat; fi | head -n 5)
    left+=$(find "$system/home/painter" -mindepth 1 -maxdepth 1 -not -name '.*' -not -name 'mine.*' -not -name picture.png -not -name window.log)
    [[ -z $left ]] || fail "$suite, $way: after the removal these are left: $left"
    printf '| %s | %s | %s | %d.%d s | %d MB | %d.%02d s |\n' "$suite" "$way" "$who" $((seconds / 1000000)) $((seconds / 100000 % 10)) "$size" \
        $((picture / 1000000)) $((picture / 10000 % 100))
}

printf '| system | way | by | installing | size | first picture, 512 x 512 |\n| --- | --- | --- | --- | --- | --- |\n'
for place; do
    suite=${place%%=*} system=$folder/system
    case $suite in
    # Debian has no keys of Ubuntu: what is tried here is thrown away.
    noble | jammy) mirror=("deb [trusted=yes] http://archive.ubuntu.com/ubuntu $suite main universe") ;;
    *) mirror=() ;;
    esac
    mmdebstrap --quiet --variant=apt --include=xz-utils,fontconfig,fonts-dejavu-core "$suite" "$system" "${mirror[@]}" 2>log ||
        fail "mmdebstrap $suite: $(cat log)"
    cp /etc/resolv.conf "$system/etc/"
    mkdir -p "$system/given" "$system/home/painter"
    chown 1000:1000 "$system/home/painter"
    cp use.sh "$system/given/"
    cp "$tarball" "$system/given/wrinkle.tar.xz"
    row folder 'a user' 1000:1000 'cd && mkdir there && tar -C there --strip-components=1 -xf /given/wrinkle.tar.xz && mv there moved' 'cd && rm -rf moved' \
        /home/painter/moved/bin/wrinkle
    row folder root 0:0 'mkdir /opt/wrinkle && tar -C /opt/wrinkle --strip-components=1 -xf /given/wrinkle.tar.xz' 'rm -rf /opt/wrinkle' \
        /opt/wrinkle/bin/wrinkle
    if [[ $place == *=* ]]; then
        cp "${place#*=}"/*.deb "$system/given/"
        row 'packages' root 0:0 'apt-get -q update && apt-get -q -y install --no-install-recommends /given/wrinkle_*.deb' \
            'apt-get -q -y purge --autoremove wrinkle' wrinkle
        row 'packages, with recommended ones' root 0:0 'apt-get -q -y install /given/wrinkle_*.deb /given/wrinkle-doc_*.deb' \
            'apt-get -q -y purge --autoremove wrinkle wrinkle-doc' wrinkle
    fi
    if [[ $source ]]; then
        mkdir "$system/opt/source"
        (cd "$source" && find . -path './build*' -prune -o -path ./.git -prune -o -type f -print0 | tar --null --files-from=- -cf -) |
            tar -C "$system/opt/source" -xf - || fail "the checkout was not copied"
        # A user who may not install packages is told which are missing.
        inside 1000:1000 sh -c 'cd && cp -r /opt/source mine.source && bash mine.source/ui/run.sh --version; code=$?; rm -rf mine.source; exit $code' >log 2>&1 &&
            fail "$suite: a user without rights built it, although packages are missing"
        grep -q 'no sudo to install them: apt-get install .*libsdl2-dev' log || fail "$suite: a user without rights is told: $(cat log)"
        row 'checkout, built by `ui/run.sh`' root 0:0 \
            'apt-mark showmanual | sort >/given/had && bash /opt/source/ui/run.sh --version' \
            'rm -rf /opt/source && apt-mark showmanual | sort | comm -13 /given/had - | xargs apt-get -q -y purge --autoremove' /opt/source/build/wrinkle
    fi
    rm -rf --one-file-system "$system"
done
