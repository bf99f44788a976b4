#!/usr/bin/env bash
#SBATCH --job-name=turntable
#SBATCH --array=0-7
#SBATCH --cpus-per-task=2
#SBATCH --mem=1G
#SBATCH --requeue
# A turntable, cut into the tasks of a Slurm array; all nodes see the folder that it is submitted from.
#
#   sbatch [--array=0-N] turntable-slurm.sh FILE OUT WxH FRAMES
#
# FILE    a document or script
# OUT     the frames' names, with #### for the number
# FRAMES  how many there are in the turn
#
# WRINKLE the program, in the environment, where it is not in the PATH
#
# However many tasks there are, the frames are the same files. A frame that is there already and whole is left out: a
# task that was stopped and put back goes on where it was, and so does the whole when it is submitted again.
set -euo pipefail
[[ $# == 4 && $2 == *'#'* && $4 =~ ^[1-9][0-9]*$ ]] || { sed -n '7,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0" >&2; exit 2; }
file=$1 out=$2 size=$3 frames=$4
task=$((${SLURM_ARRAY_TASK_ID:-0} - ${SLURM_ARRAY_TASK_MIN:-0})) tasks=${SLURM_ARRAY_TASK_COUNT:-1}
step=${SLURM_ARRAY_TASK_STEP:-1}
[[ $step == 0 ]] || task=$((task / step))
first=$((frames * task / tasks + 1)) last=$((frames * (task + 1) / tasks))
[[ $first -le $last ]] || exit 0 # more tasks than frames

# In the place of the shell, so that Slurm's signal reaches it.
exec "${WRINKLE:-wrinkle}" render "$file" -o "$out" --size "$size" --frames "$first-$last" --of "$frames" \
    --threads "${SLURM_CPUS_PER_TASK:-1}" --missing
