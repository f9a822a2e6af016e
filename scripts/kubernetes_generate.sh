#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Prints an indexed Job of Kubernetes that makes a set:
#
#   kubernetes_generate.sh CAMPAIGN.toml DIR --image IMAGE --claim CLAIM
#       [--tasks N] [--at-once N] [--cpus N] [--devices N] [--name NAME]
#     | kubectl apply -f -
#
# CAMPAIGN.toml and DIR are paths in the persistent volume claim CLAIM, which
# every pod mounts at /data; it must be one that several hosts may write to
# (ReadWriteMany). N pods (16) make the files of one task each, at most
# --at-once of them (16) at a time, with --cpus threads (1) each. A pod that is
# ended goes on where it was: finished files stay. When the Job is complete,
# `beamgyro verify DIR` says whether the set is whole; a pod that was ended
# before it could merge the manifest leaves that to another
# `beamgyro generate ... --shard 1/N`. IMAGE has the program beamgyro, as the
# Dockerfile makes it.
set -euo pipefail

fail() {
  echo "kubernetes_generate: $*" >&2
  exit 2
}

usage="usage: kubernetes_generate.sh CAMPAIGN.toml DIR --image IMAGE --claim CLAIM [--tasks N] [--at-once N] [--cpus N] [--devices N] [--name NAME]"
case "${1:-}" in
  -h | --help)
    sed -n '3,19s/^# \{0,1\}//p' "$0"
    exit
    ;;
esac
[ $# -ge 2 ] || fail "$usage"
campaign=$1 dir=$2
shift 2
tasks=16 at_once=16 cpus=1 devices='' image='' claim='' name=beamgyro
while [ $# -gt 0 ]; do
  case "$1" in
    --tasks | --at-once | --cpus | --devices)
      [[ "${2:-}" =~ ^[1-9][0-9]*$ ]] ||
        fail "$1 ${2:-}: expected a whole number above 0"
      ;;
    --image)
      [[ "${2:-}" =~ ^[A-Za-z0-9][A-Za-z0-9._:/@-]*$ ]] ||
        fail "$1 ${2:-}: expected the name of an image"
      ;;
    --claim | --name)
      [[ "${2:-}" =~ ^[a-z0-9]([a-z0-9-]*[a-z0-9])?$ ]] ||
        fail "$1 ${2:-}: expected small letters, digits and -"
      ;;
    *) fail "unknown option $1; $usage" ;;
  esac
  option=${1#--}
  declare "${option//-/_}=$2"
  shift 2
done
[ -n "$image" ] || fail "--image is missing; $usage"
[ -n "$claim" ] || fail "--claim is missing; $usage"
for path in "$campaign" "$dir"; do
  [[ "$path" =~ ^[A-Za-z0-9._/-]+$ ]] && [[ "$path" != /* ]] &&
    [[ "/$path/" != */../* ]] ||
    fail "$path: expected a path in the volume, of letters, digits, '.', '_', '-' and '/'"
done

cat <<END
apiVersion: batch/v1
kind: Job
metadata:
  name: $name
spec:
  completionMode: Indexed
  completions: $tasks
  parallelism: $at_once
  backoffLimit: $((3 * tasks))
  template:
    spec:
      restartPolicy: OnFailure
      terminationGracePeriodSeconds: 60
      containers:
      - name: task
        image: $image
        workingDir: /data
        command:
        - /bin/sh
        - -c
        - mkdir -p $dir && exec beamgyro generate $campaign -o $dir${devices:+ --devices $devices} --shard \$((JOB_COMPLETION_INDEX + 1))/$tasks --jobs $cpus
        resources:
          requests:
            cpu: "$cpus"
        volumeMounts:
        - name: data
          mountPath: /data
      volumes:
      - name: data
        persistentVolumeClaim:
          claimName: $claim
END
