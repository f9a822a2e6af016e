#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Feeds changed inputs to the readers until a time is over:
#
#   fuzz.sh MINUTES [TARGET...]
#
# The targets are the files tests/fuzz/TARGET_fuzz.cpp, all of them without a
# name; they share the time. Inputs start from tests/fuzz/corpus; those that
# reach new code are kept in build/fuzz/corpus and go on from there the next
# time. Prints the executions of each target. An input that is neither read nor
# refused ends its target, is kept in build/fuzz/findings and gives status 1:
# mend the cause and put the input, made small, into tests/fuzz/corpus.
# Wants clang and its sanitizers (Debian: clang libclang-rt-14-dev).
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
  fail "no clang++ here; install it: apt-get install clang libclang-rt-14-dev"
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

scripts/build.sh fuzz
mkdir -p build/fuzz/findings
seconds=$((minutes * 60 / ${#targets[@]}))
total=0 found=0
for target in "${targets[@]}"; do
  log=build/fuzz/$target.log
  mkdir -p "build/fuzz/corpus/$target"
  outcome=""
  "build/fuzz/tests/fuzz/${target}_fuzz" -max_total_time=$((seconds + 1)) \
    -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 -verbosity=1 \
    -artifact_prefix="build/fuzz/findings/$target-" \
    "build/fuzz/corpus/$target" "tests/fuzz/corpus/$target" >"$log" 2>&1 ||
    { found=$((found + 1)); outcome="; a finding, see $log"; }
  done=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  total=$((total + ${done:-0}))
  echo "$target: ${done:-0} executions$outcome"
done
echo "$total executions, $found findings"
[ "$found" -eq 0 ]
