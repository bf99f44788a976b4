#!/usr/bin/env bash
# A file by its name alone opens by its type: a mesh is the object's surface, projected if it has no (u,v); a .myb file is the
# window's brush.  open_types.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1 source=$2
folder=$(mktemp -d) && cd "$folder" || exit 1
child=
trap '[[ -z $child ]] || kill -9 "$child" 2>/dev/null; rm -rf "$folder"' EXIT
export WRINKLE_STATE=$folder/state XDG_CONFIG_HOME=$folder/config XDG_DATA_HOME=$folder/data HOME=$folder
unset DISPLAY WAYLAND_DISPLAY
bad=0
complain() { printf 'open_types: %s\n' "$*"; bad=1; }

# One body in all formats: a relief on a sphere. As a surface it has the picture that the command for it gives.
printf 'table 16x16\nfill 0.1\nsurface sphere\n' >ball.wrinkle
"$program" export ball.wrinkle --as gltf -o ball.glb >out 2>&1 || complain "no glb: $(cat out)"
for kind in obj stl ply; do
    "$program" export ball.wrinkle --as $kind -o ball.$kind >out 2>&1 || complain "no $kind: $(cat out)"
done
cp "$source/tests/image/cases/mesh/m_move.gltf" ball.gltf
for kind in obj stl ply glb gltf; do
    "$program" render ball.$kind -o named.exr --size 48x48 >out 2>&1 || { complain "ball.$kind does not open: $(cat out)"; continue; }
    "$program" render --do "surface mesh file=ball.$kind" -o asked.exr --size 48x48 >out 2>&1 || complain "$(cat out)"
    # Flat, so that the projection changes nothing.
    cmp -s named.exr asked.exr || complain "ball.$kind: another picture than of surface mesh"
    covered=$(oiiotool --stats named.exr 2>/dev/null | awk '/Stats Avg/ { print $6 }')
    awk "BEGIN { exit !(${covered:-0} > 0.02 && ${covered:-0} < 0.9) }" || complain "ball.$kind covers ${covered:-nothing}"
done
# Without (u,v) painting has a place on it.
"$program" render ball.stl --do 'pattern bricks across=4' --do 'bump height=0.05' -o bumps.exr --size 48x48 >out 2>&1 || complain "$(cat out)"
"$program" render ball.stl -o smooth.exr --size 48x48 >out 2>&1
cmp -s bumps.exr smooth.exr && complain 'heights do not show on a mesh without (u,v)'
printf 'not a mesh\n' >wrong.stl
"$program" render wrong.stl -o w.png >out 2>&1 && complain 'a damaged mesh opens'
[[ $(grep -c '^wrinkle: ' out) == 1 ]] && grep -q 'wrong\.stl' out || complain "a damaged mesh: $(cat out)"

# window FILE: runs the window until its first picture, and ends it.
window() {
    : >err
    SDL_VIDEODRIVER=dummy WRINKLE_TIMING=1 "$program" "$1" >out 2>err </dev/null &
    child=$!
    until grep -q 'first picture' err || ! kill -0 "$child" 2>/dev/null; do sleep 0.05; done
    kill -TERM "$child" 2>/dev/null
    wait "$child" || complain "the window ends with an error for $1: $(cat err)"
    child=
    ! grep '^wrinkle: ' err || complain "messages for $1: $(cat err)"
}
if ! "$program" paint </dev/null 2>&1 | grep -q 'no window: try'; then
    window ball.obj
    window "$source/brushes/chain.myb"
    grep -qx "preset .*/brushes/chain.myb" config/wrinkle/window.conf || complain "the brush is $(grep '^preset' config/wrinkle/window.conf)"
fi
exit $bad
