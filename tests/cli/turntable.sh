#!/usr/bin/env bash
# A turntable is the same files however it is cut, by whom and how often it is begun anew; the scripts of samples/ that
# cut it, GNU parallel's where that is installed; and the guide's examples of them.  turntable.sh SOURCE-FOLDER PROGRAM
set -uo pipefail
source=$1 program=$2
folder=$(mktemp -d) || exit 1
work=''
cleanup() {
    [[ -z $work ]] || kill -KILL "$work" 2>/dev/null
    rm -rf "$folder"
}
trap cleanup EXIT
cd "$folder" || exit 1
export HOME=$folder WRINKLE_STATE=$folder/state XDG_CONFIG_HOME=$folder/config XDG_DATA_HOME=$folder/data
export WRINKLE_DATA=$source WRINKLE=$program
failures=0
complain() {
    printf '%s\n' "$*"
    failures=$((failures + 1))
}
printf 'table 64x64\npattern bricks\nsurface torus\nlight directional to=1,1,1\n' >s.wrinkle

# frames FOLDER ARGUMENTS...: those of the turn that the arguments name, into the folder.
frames() {
    local to=$1
    shift
    mkdir -p "$to"
    "$program" render s.wrinkle -o "$to/f##.png" --size 50x40 "$@" >out 2>err || complain "$*: $(cat err)"
}
# same FOLDER WHAT: all frames of `whole`, and no other file.
same() { diff -r whole "$1" >difference || complain "$2: $(head -n 3 difference)"; }

# ---- cuts ----
frames whole --frames 1-7
for cut in '1-7' '1-1 2-2 3-3 4-4 5-5 6-6 7-7' '5-7 1-4' '2-6 7-7 1-1'; do
    rm -rf cut
    for part in $cut; do frames cut --frames "$part" --of 7; done
    same cut "cut into $cut"
done
# At once, some of them twice.
rm -rf cut
for part in 1-4 3-5 5-7 1-7; do frames cut --frames "$part" --of 7 & done
wait
same cut 'cut into pieces that run at once'
cmp -s whole/f01.png whole/f02.png && complain 'the object does not turn'

rm -rf whole cut
frames whole --frames 1-7 --turn 33
for part in 6-7 1-5; do frames cut --frames "$part" --turn 33; done
same cut 'with --turn'
{ cat s.wrinkle && echo 'render one.png size=50x40 turn=66'; } >one.wrinkle
"$program" run one.wrinkle 2>err || complain "$(cat err)"
cmp one.png whole/f02.png || complain 'the command turns it otherwise'
rm one.png

# Dials are chosen for the whole turn, also by who makes but one frame of it.
rm -rf whole cut
frames whole --frames 1-7 --do 'tolerance rms=0.004'
for part in 7-7 2-6 1-1; do frames cut --frames "$part" --of 7 --do 'tolerance rms=0.004'; done
same cut 'under a tolerance'

# ---- what is there ----
stamps() { stat -c '%n %i %y' whole/*; }
before=$(stamps)
frames whole --frames 1-7 --missing --do 'tolerance rms=0.004'
[[ $(stamps) == "$before" ]] || complain 'whole frames were made again'
grep -q 'note: 7 of 7 frames already existed' err || complain "not told: $(cat err)"
rm -rf cut && cp -r whole cut
size=$(stat -c %s cut/f02.png)
truncate -s $((size - 20)) cut/f02.png # its end is missing
truncate -s $((size / 2)) cut/f03.png
: >cut/f04.png
printf 'no picture' >cut/f05.png
"$program" render s.wrinkle -o cut/f06.png --size 50x41 2>err || complain "$(cat err)" # another size
rm cut/f07.png
frames cut --frames 1-7 --missing --do 'tolerance rms=0.004'
same cut 'damaged frames'
grep -q 'note: 1 of 7 frames already existed' err || complain "not told: $(cat err)"
for ending in exr tif ppm jpg; do # each kind of file is known again
    for _ in 1 2; do
        "$program" render s.wrinkle -o "one.$ending" --size 50x40 --missing 2>err || complain "$(cat err)"
    done
    grep -q 'the picture was there' err || complain "one.$ending: $(cat err)"
    cp "one.$ending" two && truncate -s $(($(stat -c %s two) * 2 / 3)) "one.$ending"
    "$program" render s.wrinkle -o "one.$ending" --size 50x40 --missing 2>err || complain "$(cat err)"
    cmp "one.$ending" two || complain "one.$ending: two thirds are taken for all of it"
done
# A 16-bit picture is none of ours.
"$program" export s.wrinkle --as normal+y -o one.png >out 2>err
"$program" render s.wrinkle -o one.png --size 64x64 --missing 2>err || complain "$(cat err)"
grep -q 'was there' err && complain 'a 16-bit picture is taken for one that render wrote'

# ---- stopping ----
# halves: half-written files here.
halves() { find . -maxdepth 1 -name '.large*' | wc -l; }
# The picture would take minutes; its file is begun at once.
large=(render s.wrinkle -o 'large##.png' --size 8192x8192 --frames 1-9 --do 'dials aa=supersample samples=16')
for signal in INT TERM KILL; do
    "$program" "${large[@]}" >out 2>err &
    work=$!
    until [[ $(halves) == 1 ]] || ! kill -0 "$work" 2>/dev/null; do sleep 0.05; done
    kill -s "$signal" "$work"
    { wait "$work"; } 2>/dev/null
    status=$?
    work=''
    case $signal in
    KILL) [[ $(halves) == 1 ]] || complain 'the killed one had no file' ;;
    *) [[ $status == 130 && $(halves) == 0 ]] || complain "$signal: status $status, $(halves) files: $(cat err)" ;;
    esac
done
"$program" render s.wrinkle -o small.png --size 8x8 2>err || complain "$(cat err)"
[[ $(halves) == 0 ]] || complain 'what a kill left is not cleared away'
[[ ! -e large01.png ]] || complain 'a picture that was given up is there'

# ---- samples ----
rm -rf whole cut
frames whole --frames 1-7
# Slurm's part, without Slurm: the tasks of an array one after the other, in any order.
# array COUNT FIRST STEP
array() {
    local k
    rm -rf cut && mkdir cut
    for ((k = $1 - 1; k >= 0; k--)); do
        SLURM_ARRAY_TASK_COUNT=$1 SLURM_ARRAY_TASK_MIN=$2 SLURM_ARRAY_TASK_STEP=$3 SLURM_CPUS_PER_TASK=1 \
            SLURM_ARRAY_TASK_ID=$(($2 + k * $3)) \
            bash "$source/samples/turntable-slurm.sh" s.wrinkle 'cut/f##.png' 50x40 7 >out 2>err || complain "$(cat err)"
        grep -q 'were there' err && complain "array of $1: two tasks had the same frames"
    done
    same cut "an array of $1 tasks"
}
array 1 0 1
array 3 10 5
array 9 1 1
bash "$source/samples/turntable-slurm.sh" s.wrinkle cut/f.png 50x40 7 >out 2>err && complain 'a name without # is taken'
grep -q 'FRAMES  how many' err || complain "no usage: $(cat err)"
while read -r line; do # what sbatch reads
    [[ $line =~ ^'#SBATCH --'[a-z-]+(=[A-Za-z0-9-]+)?$ ]] || complain "turntable-slurm.sh: $line"
done < <(grep '^#SBATCH' "$source/samples/turntable-slurm.sh")

if command -v parallel >/dev/null; then
    rm -rf cut && mkdir cut
    PIECE=2 bash "$source/samples/turntable-parallel.sh" s.wrinkle 'cut/f##.png' 50x40 7 --jobs 3 >out 2>err ||
        complain "parallel: $(cat err)"
    same cut 'GNU parallel'
    rm cut/f03.png
    bash "$source/samples/turntable-parallel.sh" s.wrinkle 'cut/f##.png' 50x40 7 >out 2>err || complain "parallel: $(cat err)"
    same cut 'GNU parallel, begun again'
    mkdir 'a b' && bash "$source/samples/turntable-parallel.sh" s.wrinkle "a b/f##'s.png" 50x40 2 >out 2>err
    [[ -f "a b/f02's.png" ]] || complain "names with blanks and quotes: $(cat err)"
    bash "$source/samples/turntable-parallel.sh" none.wrinkle 'cut/f##.png' 50x40 7 >out 2>err && complain 'a failure is not told'
    # The guide's own lines, for a few small frames.
    count=0
    ln -s "$source/samples" samples && mkdir bin && ln -s "$program" bin/wrinkle
    while IFS= read -r line; do
        count=$((count + 1))
        line=${line//1024x1024/16x16} line=${line//720/3}
        PATH=$folder/bin:$PATH bash -c "$line" >out 2>err || complain "guide: $line: $(cat err)"
    done < <(sed -nE 's/^    (bash samples\/turntable-parallel\.sh [^|]*)$/\1/p' "$source/ui/guide/large.md" | grep -v sshlogin)
    [[ $count -ge 1 ]] || complain 'the guide shows no line for GNU parallel'
else
    printf 'GNU parallel is not installed (apt-get install parallel): its script was not run\n'
fi

[[ $failures == 0 ]] || { printf '%d failures\n' "$failures"; exit 1; }
