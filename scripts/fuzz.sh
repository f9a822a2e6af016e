#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Feeds changed inputs to the readers until a time is over:
#
#   fuzz.sh MINUTES [TARGET...]
#
# The targets are the files tests/fuzz/TARGET_fuzz.cpp, all of them without a
# name; they share the time, as many at once as there are processors. Inputs
# start from tests/fuzz/corpus; those that reach new code are kept in
# build/fuzz/corpus and go on from there the next time. Prints the executions of
# each target. An input that is neither read nor refused ends its target, is
# kept in build/fuzz/findings and gives status 1: mend the cause and put the
# input, made small, into tests/fuzz/corpus.
# Wants clang and its sanitizers (Debian: clang lld libclang-rt-14-dev).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
  echo "fuzz: $*" >&2
  exit "${status:-1}"
}

[[ "${1:-}" =~ ^[1-9][0-9]*$ ]] ||
  status=2 fail "usage: scripts/fuzz.sh MINUTES [TARGET...]"
minutes=$1
shift
command -v clang++ >/dev/null ||
  fail "no clang++ here; install it: apt-get install clang lld libclang-rt-14-dev"
targets=("$@")
if [ $# -eq 0 ]; then
  for file in tests/fuzz/*_fuzz.cpp; do
    targets+=("$(basename "$file" _fuzz.cpp)")
  done
fi
for target in "${targets[@]}"; do
  [ -e "tests/fuzz/${target}_fuzz.cpp" ] ||
    status=2 fail "no target $target; expected one of" tests/fuzz/*_fuzz.cpp
done

scripts/build.sh asan
mkdir -p build/fuzz/findings
jobs=$(($(nproc) < ${#targets[@]} ? $(nproc) : ${#targets[@]}))
seconds=$((minutes * 60 * jobs / ${#targets[@]}))

# fuzz TARGET: prints its executions. A finding gives status 1.
# shellcheck disable=SC2317  # xargs calls it
fuzz() {
  local target=$1 log=build/fuzz/$1.log status=0 more=() outcome="" count
  mkdir -p "build/fuzz/corpus/$target"
  # HDF5 keeps what it has to the end, and to tell that from a leak takes longer
  # than to read. The unit tests look for leaks.
  grep -q hdf5_seeds "tests/fuzz/${target}_fuzz.cpp" && more+=(-detect_leaks=0)
  "build/asan/tests/fuzz/${target}_fuzz" -max_total_time=$((seconds + 1)) \
    -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 -verbosity=1 "${more[@]}" \
    -artifact_prefix="build/fuzz/findings/$target-" \
    "build/fuzz/corpus/$target" "tests/fuzz/corpus/$target" >"$log" 2>&1 ||
    { status=1; outcome="; a finding, see $log"; }
  count=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  echo "$target: ${count:-0} executions$outcome"
  return "$status"
}
export -f fuzz
export seconds

status=0
printf '%s\n' "${targets[@]}" |
  xargs -d '\n' -P "$jobs" -I{} bash -c 'fuzz {} || exit 1' |
  tee build/fuzz/executions.txt || status=1
awk '{ total += $2 } END { print total + 0 " executions" }' build/fuzz/executions.txt
exit "$status"
