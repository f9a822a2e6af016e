#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes a set on a Slurm cluster, or continues one that is not complete:
#
#   slurm_generate.sh CAMPAIGN.toml DIR [--tasks N] [--at-once N] [--devices N]
#                     [--rounds N] [-- SBATCH_OPTION...]
#
# Submits those of N array tasks (16) that have work left in DIR, at most
# --at-once of them running (16). A job after them merges the manifest and
# verifies the set, or submits what is missing again, --rounds times in all (3).
# Options after -- go to every job, also to the one after the array:
# --cpus-per-task=4, --partition=..., --account=..., --time=... . A task uses as
# many threads as it has CPUs. On TERM (preemption, end of the time) it ends
# within seconds; the files that it published stay. The program is $BEAMGYRO,
# or build/release/beamgyro without it.
set -euo pipefail

fail() {
  echo "slurm_generate: $*" >&2
  exit "${status:-1}"
}

program_in() { echo "${BEAMGYRO:-$1/build/release/beamgyro}"; }

# What --output takes for the log of a job: % stands for itself when it is
# doubled. A \ never does; then the job opens its log itself.
log_of() {
  if [[ $1 == *\\* ]]; then echo /dev/null; else echo "${1//%/%%}/log/$2"; fi
}
open_log() {
  if [[ $1 == *\\* ]]; then exec >>"$1/log/$2" 2>&1; fi
}

# One task of the array; the shell becomes the program, so TERM reaches it.
task() {
  local program=$1 campaign=$2 dir=$3 tasks=$4 devices=$5
  exec "$program" generate "$campaign" -o "$dir" ${devices:+--devices "$devices"} \
    --shard "$SLURM_ARRAY_TASK_ID/$tasks" --jobs "${SLURM_CPUS_PER_TASK:-1}"
}

# With every file there. A task that was ended before it merged them is made up
# for by the first one, which has nothing else to do.
conclude() {
  local program=$1 campaign=$2 dir=$3 tasks=$4 devices=$5
  "$program" --quiet generate "$campaign" -o "$dir" ${devices:+--devices "$devices"} \
    --shard "1/$tasks"
  exec "$program" verify "$dir"
}

# Whole, or an array of what is lacking and this once more after it.
submit() {
  local self=$1 rounds=$2 program=$3 campaign=$4 dir=$5 tasks=$6 at_once=$7 devices=$8
  shift 8
  local lacking array end
  lacking=$("$program" generate "$campaign" -o "$dir" ${devices:+--devices "$devices"} \
    --lacking "$tasks")
  if [ -z "$lacking" ]; then
    echo "slurm_generate: nothing is lacking in $dir" >&2
    conclude "$program" "$campaign" "$dir" "$tasks" "$devices"
  fi
  [ "$rounds" -gt 0 ] ||
    fail "$dir: tasks $lacking of $tasks left work undone; submit again when" \
      "the reason is mended"
  mkdir -p "$dir/log"
  array=$(sbatch --parsable --job-name=beamgyro --requeue --open-mode=append \
    --signal=B:TERM@60 --output="$(log_of "$dir" task_%a.log)" "$@" \
    --array="$lacking%$at_once" "$self" task "$program" "$campaign" "$dir" \
    "$tasks" "$devices")
  end=$(sbatch --parsable --job-name=beamgyro-finish --open-mode=append \
    --output="$(log_of "$dir" finish.log)" "$@" --dependency="afterany:$array" \
    "$self" submit "$self" $((rounds - 1)) "$program" "$campaign" "$dir" "$tasks" \
    "$at_once" "$devices" "$@")
  echo "array $array: tasks $lacking of $tasks"
  echo "then $end: merge and verify, see $dir/log/finish.log"
}

case "${1:-}" in
  task | submit)
    step=$1
    shift
    if [ "$step" = task ]; then
      open_log "$3" "task_$SLURM_ARRAY_TASK_ID.log"
    else
      open_log "$5" finish.log
    fi
    "$step" "$@"
    exit
    ;;
  -h | --help)
    sed -n '3,17s/^# \{0,1\}//p' "$0"
    exit
    ;;
esac

status=2
usage="usage: slurm_generate.sh CAMPAIGN.toml DIR [--tasks N] [--at-once N] [--devices N] [--rounds N] [-- SBATCH_OPTION...]"
[ $# -ge 2 ] || fail "$usage"
campaign=$(realpath -- "$1") dir=$(realpath -m -- "$2")
shift 2
tasks=16 at_once=16 devices='' rounds=3
while [ $# -gt 0 ]; do
  case "$1" in
    --tasks | --at-once | --devices | --rounds)
      [[ "${2:-}" =~ ^[1-9][0-9]*$ ]] ||
        fail "$1 ${2:-}: expected a whole number above 0"
      declare "$(tr - _ <<<"${1#--}")=$2"
      shift 2
      ;;
    --)
      shift
      break
      ;;
    *) fail "unknown option $1; $usage" ;;
  esac
done
command -v sbatch >/dev/null || fail "no sbatch here: not a Slurm cluster"
sinfo --noheader >/dev/null 2>&1 ||
  fail "no controller answers sinfo; expected a Slurm cluster that runs"
self=$(realpath -- "${BASH_SOURCE[0]}")
program=$(realpath -- "$(program_in "$(dirname -- "$self")/..")")
[ -x "$program" ] || fail "$program is not there; build it with scripts/build.sh release"
submit "$self" "$rounds" "$program" "$campaign" "$dir" "$tasks" "$at_once" \
  "$devices" "$@"
