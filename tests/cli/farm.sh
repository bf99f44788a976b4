#!/usr/bin/env bash
# The guide's lines for farms, as they stand there: two processes with nothing in common but the folder stand for two
# machines, and the files are those of one process. GNU parallel and make where they are installed; a stand-in for
# sbatch; OpenCue's line with its frames filled in.  farm.sh SOURCE-FOLDER PROGRAM
set -uo pipefail
source=$1 program=$2
folder=$(mktemp -d) && cd "$folder" || exit 1
trap 'rm -rf "$folder"' EXIT
bad=0
complain() { printf 'farm: %s\n' "$*"; bad=1; }
mkdir samples bin home home/tmp
ln -s "$program" bin/wrinkle
export PATH=$folder/bin:$PATH HOME=$folder/home WRINKLE_STATE=$folder/home/state XDG_CONFIG_HOME=$folder/home/config
printf 'table 61x37\npattern bricks across=4 rows=4\nsurface torus\nlight directional to=1,1,1\n' >samples/bricks.wrinkle
printf 'table 43x29\ngrid cells=4x3\ndab 0.3,0.4 radius=8 strength=1\n' >samples/rivets.wrinkle
sed -n 's/^    //p' "$source/ui/guide/large.md" >lines
# line PATTERN: the guide's line, and only one.
line() {
    [[ $(grep -c -e "$1" lines) == 1 ]] || complain "the guide has $(grep -c -e "$1" lines) lines for $1"
    grep -e "$1" lines | head -n 1
}
run() { bash -c "$1" >out 2>err || complain "status $?: $1: $(head -c 300 err)"; }
same() { diff -r "$1" "$2" >difference || complain "$3: $(head -n 3 difference)"; }

# ---- the files of one process ----
mkdir -p one/unreal one/blender one/turn
for set in unreal blender; do
    wrinkle export samples/bricks.wrinkle samples/rivets.wrinkle --as $set -o one/$set >/dev/null 2>err || complain "$(cat err)"
done
wrinkle render samples/bricks.wrinkle -o 'one/turn/turn##.png' --size 64x64 --frames 1-8 2>err || complain "$(cat err)"
cmp -s one/turn/turn01.png one/turn/turn02.png && complain 'the object does not turn'

# ---- two machines: other users, settings, folders for temporary files, threads and instructions, the same folder ----
machine() { # NAME ARGUMENTS...
    local own=$folder/home/$1
    shift
    mkdir -p "$own/tmp"
    env -i PATH="$PATH" HOME="$own" TMPDIR="$own/tmp" wrinkle "$@" >"$own/out" 2>"$own/err" || complain "$*: $(cat "$own/err")"
}
mkdir -p two/unreal two/blender two/turn
{
    machine anna render samples/bricks.wrinkle -o 'two/turn/turn##.png' --size 64x64 --frames 1-5 --of 8 --missing --threads 1
    machine anna export samples/bricks.wrinkle samples/rivets.wrinkle --as unreal -o two/unreal --threads 1 --json
} &
{
    machine bert render samples/bricks.wrinkle -o 'two/turn/turn##.png' --size 64x64 --frames 4-8 --of 8 --missing --threads 3 --isa ref
    machine bert export samples/bricks.wrinkle samples/rivets.wrinkle --as blender -o two/blender --threads 2 -j 2 --json
} &
wait
same one two 'two machines'
for own in anna bert; do # their receipts have the sums of the files of one process
    [[ -s home/$own/out ]] || complain "$own has no receipts"
    sed 's/.*"file":"two\([^"]*\)".*"sha256":"\([0-9a-f]*\)".*/\2  one\1/' home/$own/out >sums
    sha256sum --quiet -c sums >out 2>err || complain "receipts of $own: $(cat out err)"
done

# ---- GNU parallel ----
if command -v parallel >/dev/null; then
    mkdir parallel && cd parallel && ln -s ../samples .
    ln -s ../lines .
    run "$(line '^seq 8 | parallel')"
    run "$(line '^mkdir -p unreal')"
    run "$(line '^parallel wrinkle export')"
    run "$(line '^parallel wrinkle render')"
    run "$(line '^convert band')"
    wrinkle render samples/bricks.wrinkle -o one.png --size 512x512
    [[ $(compare -metric AE one.png whole.png null: 2>&1) == 0 ]] || complain 'bands joined are not the whole picture'
    mkdir turn && mv turn??.png turn
    rm -f samples lines out err ./*.png
    cd ..
    same one parallel 'GNU parallel'
else
    printf 'GNU parallel is not installed (apt-get install parallel): its lines were not run\n'
fi

# ---- make ----
if command -v make >/dev/null; then
    cp "$source/samples/maps.mk" samples
    run "$(line '^make -f')"
    for set in unreal blender; do
        [[ $(find maps/$set -name '*.json' | wc -l) == 2 ]] || complain "make: no receipts of $set"
        mkdir -p made/$set && find maps/$set -type f ! -name '*.json' -exec cp {} made/$set \;
        same one/$set made/$set "make, $set"
    done
    [[ -s maps/bodies/bricks.stl && -s maps/bodies/rivets.stl ]] || complain "make: bodies: $(ls maps/bodies)"
    before=$(stat -c '%n %Y %i' maps/*/*)
    run "$(line '^make -f')"
    [[ $(stat -c '%n %Y %i' maps/*/*) == "$before" ]] || complain 'make exports again what is current'
    sleep 1 && touch samples/rivets.wrinkle
    run "$(line '^make -f')"
    grep -q bricks out && complain 'make exports an older document again'
    grep -q rivets out || complain 'make leaves a changed document as it was'
    echo nonsense >>samples/rivets.wrinkle
    bash -c "$(line '^make -f')" >out 2>err && complain 'make goes on after an error'
    [[ ! -e maps/unreal/rivets.json ]] || complain 'make keeps the receipt of a failed export'
    sed -i '$d' samples/rivets.wrinkle
fi

# ---- Slurm: every task of the array, the last one first ----
cat >bin/sbatch <<'SBATCH'
#!/usr/bin/env bash
[[ $1 =~ ^--array=([0-9]+)-([0-9]+)$ && $2 == --wrap && $# == 3 ]] || exit 2
for ((task = BASH_REMATCH[2]; task >= BASH_REMATCH[1]; task--)); do
    SLURM_ARRAY_TASK_ID=$task bash -c "$3" || exit 1
done
SBATCH
chmod +x bin/sbatch
mkdir unreal
run "$(line '^sbatch --array=0-1')"
same one/unreal unreal 'Slurm'

# ---- OpenCue ----
command=$(line '#IFRAME#')
command=${command#command: }
command=${command//1024x1024/64x64} command=${command//720/8} command=${command//turn####/turn##}
mkdir turn
for frame in 8 3 5 1 2 4 7 6; do (cd turn && ln -sfn ../samples samples && run "${command//#IFRAME#/$frame}"); done
rm -f turn/samples turn/out turn/err
same one/turn turn 'OpenCue'
rm unreal/*
run "$(line '^printf .wrinkle export')"
while IFS= read -r job; do run "$job"; done <jobs.txt
same one/unreal unreal 'the lines of cuecmd'
exit $bad
