#!/usr/bin/env bash
# The Debian packages (ui/desktop/package.sh): made, examined by lintian, installed in bare systems once with their dependencies
# alone and once with all that they recommend, used there by a user without rights, and removed without a trace; and the folder that
# runs anywhere, in each release (places.sh).
# Needs root and a Debian mirror.  packages.sh SOURCE-FOLDER PROGRAM [FOLDER of packages that are made already]
set -uo pipefail
source=$1 program=$2
folder=$(mktemp -d) || exit 1
trap 'rm -rf --one-file-system "$folder"' EXIT
cd "$folder" || exit 1
begin=$SECONDS

fail() {
    printf 'packages: %s\n' "$*"
    exit 1
}

say() {
    printf '%4d s  %s\n' $((SECONDS - begin)) "$*"
}

[[ $(id -u) -eq 0 ]] || { printf 'packages: must be run by root, who can make systems\n'; exit 77; }
for tool in mmdebstrap lintian dpkg-buildpackage; do
    command -v $tool >/dev/null || fail "$tool is missing: apt-get install mmdebstrap lintian dpkg-dev"
done
suite=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)

# ---- the packages ----
made=${3:-$folder/made}
[[ $# -ge 3 ]] || DEBFULLNAME='Package test' DEBEMAIL=test@debian.org bash "$source/ui/desktop/package.sh" --tarball "$made" >log 2>&1 ||
    fail "$(tail -n 30 log)"
names=(blender-wrinkle libwrinkle-dev libwrinkle0 python3-wrinkle wrinkle wrinkle-doc)
found=$(find "$made" -maxdepth 1 -name '*.deb' -printf '%f\n' | sed 's/_.*//' | sort | tr '\n' ' ')
[[ $found == "${names[*]} " ]] || fail "these packages were made: $found"
# (They close no request for packaging, since they are not uploaded to Debian, and the project has no home page.)
# Only later releases know the second tag.
known=$(lintian-explain-tags appstream-metadata-validation-failed >/dev/null 2>&1 && echo ,appstream-metadata-validation-failed)
lintian --allow-root --fail-on=error,warning --suppress-tags=initial-upload-closes-no-bugs"$known" "$made"/*.changes >log 2>&1 || fail "lintian: $(cat log)"
say "packages made: $(du -ch "$made"/*.deb | tail -n 1 | cut -f 1)"

# ---- bare systems ----
mmdebstrap --quiet --variant=apt "$suite" bare.tar 2>log || fail "mmdebstrap: $(cat log)"

# new_system NAME: a bare system with the packages and the files of the checks, and a user without rights.
new_system() {
    system=$folder/$1
    mkdir "$system" && tar -C "$system" -xf bare.tar --numeric-owner || fail "no system $1"
    cp /etc/resolv.conf "$system/etc/"
    mkdir -p "$system/given" "$system/home/painter"
    cp "$made"/*.deb "$source/samples/wood-diffuse.jpg" "$source/ui/icon.svg" check.sh check.c check.dae "$system/given/"
    chown 1000:1000 "$system/home/painter"
}

# inside USER COMMAND...: in the system, with processes of its own.
inside() {
    unshare --mount --pid --fork bash -c '
        mount -t proc proc "$0/proc" &&
            exec chroot --userspec="$1" "$0" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/home/painter LC_ALL=C.UTF-8 \
                DEBIAN_FRONTEND=noninteractive "${@:2}"' "$system" "$@" </dev/null
}

# install TITLE ARGUMENT...: apt-get install, with the bytes and seconds of it.
install() {
    local title=$1 before=$SECONDS
    shift
    inside 0:0 apt-get -q update >log 2>&1 || fail "apt-get update: $(tail -n 5 log)"
    inside 0:0 apt-get -q -y "$@" >log 2>&1 || fail "apt-get $*: $(tail -n 20 log)"
    say "$title: $((SECONDS - before)) s; $(sed -nE 's/^Need to get (.*) of archives.*/\1/p; s/^After this operation, (.*) of add.*/, \1 installed/p' log |
        tr -d '\n')"
}

# ---- the checks ----
cat >check.sh <<'END'
# check.sh bare|full VERSION
set -eu
mode=$1
cd
fail() { printf '%s\n' "$*"; exit 1; }
[ "$(wrinkle --version)" = "wrinkle $2" ] || fail "wrinkle --version: $(wrinkle --version)"
cat >mine.wrinkle <<'W'
table 256x256
pattern bricks across=4 rows=6
stroke preset=rope radius=14 strength=0.6 points=0.1,0.2,0.3;0.5,0.3,0.7;0.9,0.1,1
dab 0.5,0.5 tip=/usr/share/wrinkle/brushes/star.png radius=50 strength=1
text Hello size=40 at=0.5,0.8
bump height=0.08
save mine.exr
export height mine.png
W
wrinkle run mine.wrinkle
wrinkle render mine.exr -o picture.png --size 160x120
wrinkle render mine.png -o again.png --size 160x120

# The window's module and its libraries, without a display. (An interrupt before SDL handles it ends the program at once.)
rm -rf .config
SDL_VIDEODRIVER=dummy wrinkle paint mine.exr 2>window.log &
window=$!
until [ -e .config/wrinkle/window.lock ]; do
    kill -0 $window || fail "the window did not begin: $(cat window.log)"
    sleep 0.1
done
grep -q wrinkle_window.so /proc/$window/maps || fail "the window's module is not loaded"
while kill -INT $window 2>/dev/null; do sleep 0.1; done
[ -z "$(grep -v interrupted window.log)" ] || fail "the window printed: $(cat window.log)"

# refused WORDS COMMAND...: fails, with these words in its error.
refused() {
    words=$1
    shift
    if "$@" >said 2>&1; then fail "$* succeeded without its library"; fi
    grep -qF -- "$words" said || fail "$* printed: $(cat said)"
}
reads() { wrinkle render "$1" -o read.png --size 32x32; }
mesh() { wrinkle render --do 'surface mesh file=/given/check.dae' -o read.png --size 32x32; }
svg() { wrinkle render --do 'picture svg /given/icon.svg' -o read.png --size 32x32; }
tiff() { wrinkle export mine.exr --as height -o mine.tif; }
if [ "$mode" = bare ]; then
    refused 'cannot open shared object file: No such file or directory (on Debian: apt install libopenimageio' reads /given/wood-diffuse.jpg
    refused '(on Debian: apt install libopenimageio' tiff
    refused '(on Debian: apt install libassimp' mesh
    refused '(on Debian: apt install librsvg2' svg
else
    reads /given/wood-diffuse.jpg
    rm -f mine.tif
    tiff
    reads mine.tif
    mesh
    svg
fi
END
cat >check.c <<'END'
#include <stdio.h>
#include <wrinkle.h>
int main(void)
{
    WrDocError error;
    WrDoc *doc = wr_doc_new(NULL, &error);
    if (!doc || !wr_doc_open(doc, "mine.exr", &error) ||
        !wr_doc_run(doc, "stroke preset=rope radius=9 strength=0.5 points=0.1,0.2;0.5,0.3", &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    printf("%d\n", wr_doc_info(doc).width);
    wr_doc_free(doc);
    return 0;
}
END
cat >check.dae <<'END'
<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
END
upstream=$(dpkg-parsechangelog -l "$source/ui/desktop/debian/changelog" -S Version)
upstream=${upstream%-*}
given() { (cd "$made" && for name; do printf '/given/%s\n' "$name"_*.deb; done); }

# Dependencies alone, all packages.
new_system bare
mapfile -t all < <(given "${names[@]}")
install "all packages, without recommendations" install --no-install-recommends "${all[@]}"
[[ ! -e $(echo "$system"/usr/lib/*/libOpenImageIO.so.*) ]] || fail "OpenImageIO was installed"
inside 1000:1000 sh /given/check.sh bare "$upstream" >log 2>&1 || fail "without recommendations: $(cat log)"
say "checks passed"

# The same script by the program of the build folder gives the same bits.
sed "s,/usr/share/wrinkle,$source," "$system/home/painter/mine.wrinkle" >mine.wrinkle
WRINKLE_STATE=$folder/state "$program" run mine.wrinkle 2>log || fail "$(cat log)"
cmp -s mine.png "$system/home/painter/mine.png" || fail "the packages' program computes other heights than $program"

# Python and C.
inside 1000:1000 sh -c 'cd && python3 -c "
import wrinkle
doc = wrinkle.open(\"mine.exr\")
doc.stroke(preset=\"rope\", points=[(0.1, 0.5), (0.9, 0.5)], radius=16)
print(wrinkle.version(), doc.heights.shape, doc.render(40, 30).shape)"' >said 2>&1
[[ $(cat said) == "$upstream (256, 256) (30, 40, 4)" ]] || fail "in Python: $(cat said)"
inside 0:0 apt-get -q -y install --no-install-recommends gcc libc6-dev pkg-config >log 2>&1 || fail "gcc: $(tail log)"
# shellcheck disable=SC2016 # for the shell inside
inside 1000:1000 sh -c 'cd && gcc -o check /given/check.c $(pkg-config --cflags --libs wrinkle) && ./check' >said 2>&1
[[ $(cat said) == 256 ]] || fail "the C program: $(cat said)"
say "Python and C passed"

# Nothing remains.
inside 0:0 apt-get -q -y purge "${names[@]}" >log 2>&1 || fail "purge: $(tail log)"
left=$(find "$system" -xdev -iname '*wrinkle*' -not -path "$system/given/*" -not -path "$system/home/*" -not -path "$system/var/lib/apt/*")
[[ -z $left ]] || fail "after a purge these remain: $left"
rm -rf --one-file-system "$system"

# ---- with recommendations ----
new_system full
mapfile -t some < <(given wrinkle wrinkle-doc)
install "wrinkle with its recommendations" install "${some[@]}"
inside 1000:1000 sh /given/check.sh full "$upstream" >log 2>&1 || fail "with recommendations: $(cat log)"
inside 1000:1000 wrinkle render /usr/share/wrinkle/samples/bricks.wrinkle -o /home/painter/bricks.png >log 2>&1 || fail "bricks: $(cat log)"
rm -rf --one-file-system "$system"

# ---- the folder that runs anywhere: in this release, and in later ones ----
later=()
[[ $suite != bookworm ]] || later=(trixie noble)
bash "$source/tests/repository/places.sh" "$made"/wrinkle-*.tar.xz "$suite" "${later[@]}" || fail 'the folder does not run everywhere'
say "all passed"
