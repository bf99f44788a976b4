#!/usr/bin/env bash
# What `cmake --install` puts down runs from where it lies, with its own module and its own samples, and
# so does a staged copy (DESTDIR) moved elsewhere.  install.sh BUILD-FOLDER
set -uo pipefail
build=$1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1

fail() {
    printf 'install: %s\n' "$*"
    exit 1
}

# The program of an installed tree renders its own sample, and what it loads lies in that tree.
try() {
    local tree=$1 loaded
    "$tree/bin/wrinkle" render "$tree/share/wrinkle/samples/grid.wrinkle" -o grid.png --size 32x32 \
        >out 2>err || fail "the program in $tree failed: $(cat err)"
    [[ $(head -c 4 grid.png | tail -c 3) == PNG ]] || fail "$tree: grid.png is not a PNG file"
    LD_DEBUG=files "$tree/bin/wrinkle" render "$tree/share/wrinkle/samples/grid.wrinkle" -o grid.exr \
        --size 8x8 >out 2>trace || fail "the program in $tree failed the second time"
    loaded=$(sed -nE 's/.* (\/[^ ]*wrinkle_[a-z]+\.so).*/\1/p' trace | sort -u)
    [[ -n $loaded ]] || fail "$tree: no module was loaded"
    while IFS= read -r module; do
        [[ $(readlink -f "$module") == "$(readlink -f "$tree")"/* ]] ||
            fail "$tree: the module was loaded from $module"
    done <<<"$loaded"
    rm -f grid.png grid.exr out err trace
}

cmake --install "$build" --prefix "$folder/prefix" >log 2>&1 || fail "$(cat log)"
try "$folder/prefix"
DESTDIR=$folder/stage cmake --install "$build" --prefix /usr >log 2>&1 || fail "$(cat log)"
mv stage/usr moved
[[ -z $(find stage -type f) ]] || fail "files outside the prefix: $(find stage -type f)"
try "$folder/moved"

share=$folder/prefix/share
for file in applications/wrinkle.desktop metainfo/org.wrinkle.Wrinkle.metainfo.xml mime/packages/wrinkle.xml man/man1/wrinkle.1 \
    icons/hicolor/scalable/apps/wrinkle.svg icons/hicolor/16x16/apps/wrinkle.png icons/hicolor/48x48/apps/wrinkle.png icons/hicolor/256x256/apps/wrinkle.png \
    bash-completion/completions/wrinkle \
    wrinkle/samples/bricks.wrinkle wrinkle/samples/rivets.wrinkle wrinkle/samples/screenshot.png \
    wrinkle/brushes/chain.myb wrinkle/brushes/stamps/stamps.conf wrinkle/brushes/stamps/chain-link.png wrinkle/brushes/generators.wrinkle \
    wrinkle/samples/cells/moon-surface.wrinkle wrinkle/samples/cells/moon-surface.png \
    wrinkle/ui/guide/README.md wrinkle/ui/guide/window.md doc/wrinkle/README.md; do
    [[ -s $share/$file ]] || fail "share/$file is missing"
done
desktop-file-validate "$share/applications/wrinkle.desktop" || fail "the desktop entry is not valid"
problems=$(groff -man -Tutf8 -ww -z "$share/man/man1/wrinkle.1" 2>&1)
[[ -z $problems ]] || fail "the manual page: $problems"
# The manual page tells of each subcommand and each option that the program's own help tells of.
page=$(sed 's/\\-/-/g' "$share/man/man1/wrinkle.1")
wrinkle=$folder/prefix/bin/wrinkle
"$wrinkle" --help >help 2>&1 || fail "wrinkle --help failed"
subcommands=$(sed -nE '/^subcommands:/,/^$/s/^  ([a-z]+) .*/\1/p' help)
[[ $(wc -w <<<"$subcommands") -ge 7 ]] || fail "wrinkle --help tells only of $subcommands"
for subcommand in $subcommands; do
    grep -qx "\.B $subcommand" <<<"$page" || fail "the manual page lacks $subcommand"
    "$wrinkle" "$subcommand" --help >help 2>&1 || fail "wrinkle $subcommand --help failed"
    for option in $(grep -oE '^  (-[oj], )?--[a-z-]+' help | grep -oE -- '--[a-z-]+'); do
        grep -qE -- "^\.B.*[^-a-z]$option( |\$)" <<<"$page" || fail "the manual page lacks $option"
    done
done
