#!/usr/bin/env bash
# Debian packages of this checkout, and a folder that runs without installation:
#
#   bash ui/desktop/package.sh [FOLDER]             six binary packages and the source package
#   bash ui/desktop/package.sh --tarball [FOLDER]   these, and wrinkle-VERSION-MACHINE.tar.xz made of them
#
# Copies the checkout (tracked and new files) with ui/desktop/debian in place into FOLDER (default: build-packages), and builds
# there. The last lines of the output are the files. DEBFULLNAME and DEBEMAIL in the environment name the packages' maintainer.
set -euo pipefail

root=$(CDPATH='' cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.." && pwd -P)
# shellcheck source=ui/setup.sh
source "$root/ui/setup.sh"
desktop=$root/ui/desktop

# The checkout's files, NUL-terminated, by paths from its folder.
files() {
    if git -C "$root" rev-parse --is-inside-work-tree >/dev/null 2>&1; then
        git -C "$root" ls-files -z --cached --others --exclude-standard
    else
        (cd "$root" && find . -path './build*' -prune -o -type f -printf '%P\0')
    fi
}

# ---- the tarball ----

# Sonames that every Debian has: the C and C++ libraries.
base='^(ld-linux.*|lib(c|m|dl|rt|pthread|resolv|gcc_s|stdc\+\+))\.so\.'

# The libraries of these files and their libraries, without the base: "SONAME PATH" a line.
libraries() {
    ldd "$@" | awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 }' | grep -vE "$base" | sort -u
}

# Packages as one folder with the libraries beside the program. The window's libraries are used only where the system lacks one
# of them: those of a desktop belong together.
make_tarball() {
    local name stage=$1 modules soname path file
    name=$(basename "$stage")
    for file in "$out"/{wrinkle,wrinkle-doc,blender-wrinkle}_"$version"_*.deb; do
        dpkg-deb -x "$file" "$stage"
    done
    mv "$stage"/usr/* "$stage/"
    mv "$stage/share/doc/wrinkle/copyright" "$stage/LICENSE"
    rm -rf "${stage:?}"/{usr,share/doc,share/blender,share/lintian}
    modules=$(dirname "$(find "$stage/lib" -name wrinkle-reader)")
    mkdir "$modules/own" "$modules/desktop"
    while read -r soname path; do
        cp -L "$path" "$modules/own/$soname"
    done < <(libraries "$stage/bin/wrinkle" "$modules/wrinkle-reader")
    while read -r soname path; do
        [[ -e $modules/own/$soname ]] || cp -L "$path" "$modules/desktop/$soname"
    done < <(libraries "$modules/wrinkle_window.so")
    mv "$stage/bin/wrinkle" "$stage/bin/wrinkle-program"
    # RPATH, which holds for the libraries' own libraries too
    patchelf --force-rpath --set-rpath "\$ORIGIN/../${modules#"$stage"/}/own" "$stage/bin/wrinkle-program"
    # shellcheck disable=SC2016 # for the dynamic linker
    patchelf --force-rpath --set-rpath '$ORIGIN/own' "$modules/wrinkle-reader"
    sed "s,@modules@,${modules#"$stage"/}," "$desktop/portable.sh" >"$stage/bin/wrinkle"
    chmod 755 "$stage/bin/wrinkle"
    tar -C "$(dirname "$stage")" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" -cf - "$name" |
        xz -T0 >"$out/$name.tar.xz"
}

tarball=no
if [[ ${1:-} == --tarball ]]; then
    tarball=yes
    wr_package_packages+=(patchelf)
    shift
fi
out=$(readlink -m -- "${1:-$root/build-packages}")
version=$(dpkg-parsechangelog -l "$desktop/debian/changelog" -S Version)
upstream=${version%-*}
tree=$out/wrinkle-$upstream
wr_install_packages "${wr_program_packages[@]}" "${wr_package_packages[@]}"
mkdir -p "$out"
rm -rf "$tree" "$out"/*wrinkle*_"$version"[_.]* "$out/wrinkle_$upstream.orig.tar.xz"
SOURCE_DATE_EPOCH=$(dpkg-parsechangelog -l "$desktop/debian/changelog" -S Timestamp)
export SOURCE_DATE_EPOCH

wr_say "packing the source"
files | sort -z | tar -C "$root" --null --files-from=- --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" \
    --transform="s,^,wrinkle-$upstream/," -cf - | xz -T0 >"$out/wrinkle_$upstream.orig.tar.xz"
tar -C "$out" -xf "$out/wrinkle_$upstream.orig.tar.xz"
cp -R "$desktop/debian" "$tree/debian"
sed -i "s/The Wrinkle authors <wrinkle@localhost>/${DEBFULLNAME:-The Wrinkle authors} <${DEBEMAIL:-wrinkle@localhost}>/" \
    "$tree"/debian/{control,changelog}

wr_say "building $tree"
cd "$tree"
if ! DEB_BUILD_OPTIONS=${DEB_BUILD_OPTIONS:-parallel=$(nproc)} dpkg-buildpackage -us -uc >"$out/build.log" 2>&1; then
    tail -n 40 "$out/build.log" >&2
    wr_say "building the packages failed; all of the output is in $out/build.log"
    exit 1
fi
cd "$out"
rm -rf "$tree"
ls "$out"/*_"$version"_*.deb "$out/wrinkle_$version.dsc"
if [[ $tarball == yes ]]; then
    stage=$out/wrinkle-$upstream-$(uname -m)
    rm -rf "$stage"
    make_tarball "$stage"
    rm -rf "$stage"
    ls "$stage.tar.xz"
fi
