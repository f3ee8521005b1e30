#!/usr/bin/env bash
# A study as an array of tasks under HyperQueue (hq), inside one allocation or over several.
#
#   gudgeon study new STUDY cases/studies/diesel-speed-gap.toml
#   cases/studies/hyperqueue.sh STUDY 64
#   gudgeon study collect STUDY
#
# Parts that are there are not run again: the same command goes on where an allocation ended.
set -euo pipefail
study=${1:?folder of the study}
tasks=${2:?number of tasks}
hq=${HQ:-hq}
gudgeon=${GUDGEON:-gudgeon}

# HyperQueue sets HQ_TASK_ID to 1, 2, … in every task.
"$hq" submit --wait --array "1-$tasks" --cpus 1 --crash-limit 3 -- \
    bash -c '"$1" study run "$2" --part "$HQ_TASK_ID/$3" --threads 1 --quiet || [ $? -eq 1 ]' task "$gudgeon" "$study" "$tasks"
