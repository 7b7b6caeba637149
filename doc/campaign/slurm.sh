#!/bin/sh
# A campaign as a Slurm array, a shard a task. From a folder that all nodes see:
#
#     sbatch --array=1-8 slurm.sh hoist.toml 10000
#
# A task that was killed goes on where it was when it is submitted again.
#SBATCH --job-name=campaign
#SBATCH --cpus-per-task=1
#SBATCH --requeue
set -eu
machine=$1
draws=$2
name=$(basename "$machine" .toml)
exec cargo-driveline campaign "$machine" --draws "$draws" --threads "${SLURM_CPUS_PER_TASK:-1}" \
    --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --results "$name-$SLURM_ARRAY_TASK_ID.draws"
