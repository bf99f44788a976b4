#!/usr/bin/env bash
# Brushes and tools in the window, under an X server of its own: what the hand does becomes the command that
# it should, and the saved heights are those that the command means.  window_tools.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
program=$1
source=$2
folder=$(mktemp -d) || exit 1
# shellcheck source=tests/window/window_help.sh
source "$source/tests/window/window_help.sh"

command -v xclip >/dev/null || { echo "xclip is missing: apt-get install xclip"; exit 1; }
serve
printf 'table 512x512\nbump height=1\n' >flat.wrinkle

# configure LINE...: what the window remembers from the last time.
configure() {
    printf '%s\n' 'width 1200' 'height 800' 'turning 0' 'ants 0' 'range_follows 0' 'radius 16' 'hardness 1' 'strength 0.5' 'tab 0' \
        'lower 0.42' "$@" >config/wrinkle/window.conf
}

press() { xdotool mousemove $((X + $1)) $((Y + $2)) mousedown 1; }
# height FILE U V: of the saved table.
height() { "$program" inspect "$1" --at "$2,$3" --json | jq -r .F; }
# near A B: the same to 1e-4.
near() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a - b < 1e-4 && b - a < 1e-4) }'; }
save_as() { answer_file "$1" ctrl+shift+s; }

# The cell's middle lies about here at this size of the window.
cx=270 cy=420

# ---- an area is filled by a click: all of a level table is one ----
configure 'mode 0'
start flat.wrinkle
key g
click $cx $cy
becomes 'flood *mode=raise*' "a fill by a click"
home
save_as filled.exr
for at in '0.1 0.1' '0.9 0.4'; do
    # shellcheck disable=SC2086
    near "$(height filled.exr $at)" 0.5 || complain "filled with 0.5, the height at $at is $(height filled.exr $at)"
done

# ---- an ellipse's outline is painted: its rim is raised, its middle is not ----
key q
press $((cx - 60)) $((cy - 60))
xdotool mousemove $((X + cx)) $((Y + cy))
rest
xdotool mousemove $((X + cx + 60)) $((Y + cy + 60))
rest
xdotool mouseup 1
becomes 'shape ellipse at=*radii=*paint=outline*' "an ellipse by a drag"
read -r u v rim < <(newest | sed -E 's/.*at=([0-9.]+),([0-9.]+) radii=([0-9.]+),.*/\1 \2 \3/')
home
save_as ellipse.exr
near "$(height ellipse.exr "$u" "$v")" 0.5 || complain "an outline changes the ellipse's middle"
at=$(awk -v u="$u" -v r="$rim" 'BEGIN { print u + r }')
near "$(height ellipse.exr "$at" "$v")" 1 || complain "on the ellipse the height is $(height ellipse.exr "$at" "$v")"

# ---- a ramp by a drag; Escape gives a shape up ----
key shift+g
drag $((cx - 80)) $cy 4 0 40
becomes 'ramp linear from=*low=0 high=1' "a ramp by a drag"
# In a mirror what the hand draws to the right goes to the left, and what is seen is the mirror's.
from_to() { newest | sed -E 's/.* from=([0-9.]+),.* to=([0-9.]+),.*/\1 \2/'; }
awk -v line="$(from_to)" 'BEGIN { split(line, u, " "); exit !(u[2] > u[1]) }' || complain "a drag to the right is $(newest)"
shot plain
key m
shot mirrored
changed=$(differs plain mirrored 400x400+70+200)
[[ ${changed%.*} -gt 50 ]] || complain "the mirrored table differs by only $changed pixels"
drag $((cx - 80)) $cy 4 0 40
to_the_left() { awk -v line="$(from_to)" 'BEGIN { split(line, u, " "); exit !(u[2] < u[1]) }'; }
until_true 60 "a ramp to the left in the mirror; $(newest)" to_the_left
key m
key r
press $((cx - 40)) $cy
xdotool mousemove $((X + cx + 40)) $((Y + cy + 40))
rest
key Escape
xdotool mouseup 1
rest
becomes 'ramp linear*' "no rectangle after Escape"

# ---- a polygon by clicks, ended by Enter ----
key shift+q
for at in '-70 0' '0 -80' '70 10'; do
    # shellcheck disable=SC2086
    set -- $at
    click $((cx + $1)) $((cy + $2))
    rest
done
key Return
becomes 'shape polygon points=*,*;*,*;*,* paint=outline*' "a polygon by clicks"

# ---- a Bezier path: a drag pulls its arms ----
key n
drag $((cx - 60)) $((cy + 50)) 4 -4 8
rest
drag $((cx + 60)) $((cy + 50)) 4 4 8
rest
key Return
becomes 'shape path points=*;*;*;* paint=outline*' "a path by drags"
key b
xdotool key ctrl+q
settle
xdotool key d
ends 0

# ---- a stamp shows itself under the pointer, on a snapshot, and its drag turns and sizes it ----
configure 'mode 0'
start flat.wrinkle
shot before
key shift+s
xdotool mousemove $((X + cx)) $((Y + cy))
settle
shot ghost
changed=$(differs before ghost 500x500+480+150)
[[ ${changed%.*} -gt 50 ]] || complain "the patch shows a stamp before it is put by only $changed pixels"
title_is 'untitled' || complain "a stamp that is only shown makes unsaved work"
press $cx $cy
for i in 8 16 24 32 40; do xdotool mousemove $((X + cx)) $((Y + cy + i)); done
rest
xdotool mouseup 1
becomes 'dab *radius=* angle=-90*' "a stamp, turned by its drag"
read -r u v < <(newest | sed -E 's/dab ([0-9.]+),([0-9.]+) .*/\1 \2/')
home
save_as stamped.exr
near "$(height stamped.exr "$u" "$v")" 0.5 || complain "the stamp's middle is at $(height stamped.exr "$u" "$v")"

# ---- E erases with the same brush, and goes back ----
key b
key e
drag $((cx - 50)) $((cy - 60)) 5 0 20
becomes 'stroke *mode=erase*' "a stroke that erases"
key e
drag $((cx - 50)) $((cy - 60)) 5 0 20
becomes 'stroke *mode=raise*' "a stroke that raises again"

# ---- smoothing has a tool of its own, which leaves the brush its mode ----
key shift+u
drag $((cx - 50)) $((cy - 60)) 5 0 20
becomes 'stroke *mode=smooth*' "a stroke that smooths"
key b
drag $((cx - 50)) $((cy - 60)) 5 0 20
becomes 'stroke *mode=raise*' "the brush as it was"

# ---- cloning: Ctrl and a click first says from where ----
key c
xdotool mousemove $((X + cx - 60)) $((Y + cy))
rest
xdotool keydown ctrl click 1 keyup ctrl
rest
drag $((cx + 20)) $cy 4 0 10
becomes 'stroke *mode=clone*source=-*,*' "a stroke that clones"
xdotool key ctrl+q
settle
xdotool key d
ends 0

# ---- symmetry: what is painted at the left is painted at the right ----
configure 'mode 0'
start flat.wrinkle
key u
drag $((cx - 60)) $((cy - 90)) 1 2 20
becomes 'stroke *mirror=u*' "a stroke with a mirror"
read -r u v < <(sed -nE 's/^[0-9a-f]+ [0-9]+ s ([0-9.]+),([0-9.]+).*/\1 \2/p' state/wrinkle/journals/*.wj | head -n 1)
home
save_as mirrored.exr
other=$(awk -v u="$u" 'BEGIN { print 1 - u }')
left=$(height mirrored.exr "$u" "$v") right=$(height mirrored.exr "$other" "$v")
near "$left" 0.5 || complain "the height at the stroke is $left"
near "$left" "$right" || complain "at the left the height is $left, at the right $right"
key u

# ---- a preset is found by its name, chosen by a click, and named in the stroke ----
click 1000 218
xdotool type --delay 30 rivet
rest
click 987 289
xdotool mousemove $((X + cx)) $((Y + cy))
rest
drag $((cx - 80)) $((cy + 30)) 5 0 30
becomes 'stroke *preset=*rivet*' "a stroke with a preset that was searched for"
# ... its curves are drawn by hand: a point in the middle is pulled down; undo takes it back, and it is drawn again.
search 'curves of the brush'
settle
drag 1075 270 0 8 5
rest
key ctrl+z
drag 1075 270 0 9 5
rest
key Escape
drag $((cx - 80)) $((cy + 60)) 5 0 30
becomes 'stroke *preset=*rivet*set="opaque_multiply:pressure=*,*|*,*|*,*"*' "a stroke by a curve that was drawn"
[[ $(newest) =~ \|0\.5,0\.1[0-9]*\| ]] || complain "the curve that was drawn is $(newest)"
# ... and / goes back to the brush before.
key slash
drag $((cx - 80)) $((cy - 30)) 5 0 10
until_true 120 "a stroke of the brush before" eval '! newest_is "*preset=*"'
xdotool key ctrl+q
settle
xdotool key d
ends 0

# ---- the sculptors' keys: Ctrl turns the brush round, Shift smooths ----
configure 'mode 0' 'key_map 1'
start flat.wrinkle
xdotool keydown ctrl
drag $((cx - 80)) $cy 4 0 20
xdotool keyup ctrl
becomes 'stroke *mode=lower*' "a stroke with Ctrl, for sculptors"
xdotool keydown shift
drag $((cx - 80)) $cy 4 0 20
xdotool keyup shift
becomes 'stroke *mode=smooth*' "a stroke with Shift, for sculptors"
xdotool key ctrl+q
settle
xdotool key d
ends 0

# ---- Shift and a click: a straight line from the last stroke, the long way where it is drawn so ----
configure 'mode 0'
start flat.wrinkle
drag $((cx - 100)) $((cy - 50)) 0 2 5
becomes 'stroke *mode=raise*' "a stroke to begin a line at"
rest
xdotool keydown shift
click $((cx + 100)) $((cy - 40))
xdotool keyup shift
rest
samples=$(sed -nE 's/^[0-9a-f]+ [0-9]+ ([bs]) /\1 /p' state/wrinkle/journals/*.wj |
    awk '$1 == "b" { n++ } $1 == "s" && n == 2 { for (i = 2; i <= NF; i++) print $i }' | tr ';' '\n')
read -r u0 v0 < <(head -n 1 <<<"$samples" | tr ',' ' ')
read -r u1 v1 < <(tail -n 1 <<<"$samples" | tr ',' ' ')
home
save_as lined.exr
awk -v a="${u0:-0}" -v b="${u1:-0}" 'BEGIN { exit !(b - a > 0.5 && b - a < 1) }' ||
    complain "the line is not over half of the table: $samples"
for k in 0.25 0.5 0.75; do
    read -r u v < <(awk -v a="$u0" -v b="$u1" -v c="$v0" -v d="$v1" -v k="$k" \
        'BEGIN { print a + k * (b - a), c + k * (d - c) }')
    near "$(height lined.exr "$u" "$v")" 0.5 || complain "on the line the height is $(height lined.exr "$u" "$v")"
done
beyond=$(awk -v a="$u0" -v b="$u1" 'BEGIN { u = (a + b) / 2 + 0.5; print u - int(u) }')
near "$(height lined.exr "$beyond" "$v0")" 0 || complain "the line also goes the short way, over the edge"

# ---- the tablet tester says why there is nothing to test ----
shot untested
xdotool key ctrl+shift+t
settle
shot tested
changed=$(differs untested tested 500x300+350+200)
[[ ${changed%.*} -gt 20000 ]] || complain "the tablet tester changes only $changed pixels"
xdotool key Escape
settle
xdotool key ctrl+q
ends 0

# ---- strokes go to the mask; what is selected is moved by hand, copied and pasted ----
cat >masked.wrinkle <<'END'
table 512x512
bump height=1
fill 1
layer add top
fill 1
layer mask 2 from=black
select rect from=0.25,0.25 to=0.75,0.75
END
configure 'mode 0'
start masked.wrinkle
key alt+m
rest
drag $((cx - 50)) $((cy - 60)) 5 0 20
becomes 'stroke *mode=raise*' "a stroke on the mask"
key alt+m
key ctrl+t
drag $cx $cy 5 0 8
rest
key Return
becomes 'transform move=*,0' "a piece moved by a drag"
moved=$(newest | sed -E 's/.*move=([0-9]+),0/\1/')
[[ ${moved:-0} -gt 10 ]] || complain "a drag of 40 pixels moves by ${moved:-nothing}"
# ... the grid of eighths, 64 texels apart, holds it where an edge comes near; another tool keeps what was made
left=$((128 + moved)) before=$(newest)
key alt+g
drag $cx $cy 3 0 10
rest
key b
is_another() { [[ $(newest) != "$before" ]]; }
until_true 120 "what was moved is kept by another tool" is_another
becomes 'transform move=*,0' "a piece moved along the grid"
moved=$(newest | sed -E 's/.*move=(-?[0-9]+),0/\1/')
[[ $(((left + moved) % 64)) == 0 && $moved != 0 ]] || complain "on the grid an edge at $left is moved by $moved"
key alt+g
key ctrl+c
has_copied() { compgen -G 'state/wrinkle/clipboard/copy-*.exr' >/dev/null; }
until_true 120 "the copy" has_copied
rest
key ctrl+v
becomes 'layer paste *clipboard/copy-*-at-*_0.5.exr at=*,0.5*' "what was copied is pasted as a layer in its place"
home
save_as pasted.exr
near "$(height pasted.exr 0.1 0.1)" 1 || complain "beside what was pasted is $(height pasted.exr 0.1 0.1)"
key ctrl+z
# ... what is cut out of the lower layer is gone, and a picture of another program is pasted
key ctrl+x
becomes 'layer clear*' "what is cut is cleared"
copies() { compgen -G "state/wrinkle/clipboard/copy-*.$1" | wc -l; }
[[ $(copies exr) == 2 ]] || complain "$(copies exr) copies, not the one before and what was cut"
convert -size 48x32 gradient:black-white picture.png
xclip -selection clipboard -t image/png -i picture.png
key ctrl+v
becomes 'layer paste *clipboard/copy-*.png at=*' "a picture of another program is pasted"
# ... also where it offers no PNG
for kind in tiff:tif bmp:bmp jpeg:jpg; do
    convert -size 40x24 gradient:black-white "picture.${kind#*:}"
    xclip -selection clipboard -t "image/${kind%:*}" -i "picture.${kind#*:}"
    key ctrl+v
    becomes "layer paste *clipboard/copy-*.${kind#*:} at=*" "a picture offered as ${kind%:*} is pasted"
done
# drawings: of another program, as a text of one path, as a file's name
drawing='<svg xmlns="http://www.w3.org/2000/svg" width="9" height="5"><rect width="3" height="2"/></svg>'
printf '%s' "$drawing" | xclip -selection clipboard -t image/svg+xml
key ctrl+v
becomes 'picture svg *clipboard/drawing-*.svg*' "a drawing of another program is pasted"
printf '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0,0 5,1 2,7Z"/></svg>' | xclip -selection clipboard
key ctrl+v
becomes 'picture path "M0,0 5,1 2,7Z"*' "one path is kept in its layer's line"
printf '%s' "$drawing" >'a logo.svg'
printf 'file://%s/a%%20logo.svg\r\n' "$PWD" | xclip -selection clipboard -t text/uri-list
key ctrl+v
becomes 'picture svg *a logo.svg*' "a copied file is pasted"
xdotool key ctrl+q
settle
xdotool key d
ends 0

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
