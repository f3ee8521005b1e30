#!/usr/bin/env bash
# A study as an array of jobs under SLURM: every job runs its share of the parts, and `collect` puts them together.
#
#   gudgeon study new STUDY cases/studies/diesel-speed-gap.toml
#   sbatch --array=1-8 cases/studies/slurm-array.sh STUDY
#   gudgeon study status STUDY
#   gudgeon study collect STUDY
#
# A job that was killed is submitted again: parts that are there are not run again. The folder lies where all nodes see it.
#SBATCH --job-name=gudgeon
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=4
#SBATCH --time=04:00:00
set -euo pipefail
study=${1:?folder of the study}
gudgeon=${GUDGEON:-gudgeon}

# Rows that failed end a run with 1; they are results, and `status` counts them.
"$gudgeon" study run "$study" --part "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --threads "${SLURM_CPUS_PER_TASK:-0}" --quiet ||
    [ $? -eq 1 ]
