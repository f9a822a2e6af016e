#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Everything there is to check, from a bare machine; the last line is the total.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1

passed=0 failed=0 skipped=0
failures=()
started=$SECONDS

# tally NAME PASSED FAILED SKIPPED: adds the outcome of one step to the total.
tally() {
  passed=$((passed + $2)) failed=$((failed + $3)) skipped=$((skipped + $4))
  [ "$3" -eq 0 ] || failures+=("$1")
  printf -- '-- %s: %d passed, %d failed, %d skipped (%d s so far)\n' \
    "$1" "$2" "$3" "$4" $((SECONDS - started))
}

# A step that could not even start counts as one failure.
broken() {
  echo "$2" >&2
  tally "$1" 0 1 0
}

unit_tests() {
  local preset=$1 name="unit tests ($1)" report=$PWD/build/$1/junit.xml counts
  scripts/build.sh "$preset" || { broken "$name" "$name: no build"; return; }
  rm -f "$report"
  ctest --preset "$preset" -j "$(nproc)" --timeout 300 \
    --output-junit "$report" >build/"$preset"/ctest.log 2>&1 ||
    grep -v -E '^ +Start|Passed +[0-9.]+ sec' build/"$preset"/ctest.log >&2
  counts=$(/usr/bin/python3 scripts/count_tests.py "$report") ||
    { broken "$name" "$name: ctest left no report"; return; }
  # shellcheck disable=SC2086  # three numbers
  tally "$name" $counts
}

program_tests() {
  local name="tests of the program and the scripts" report=build/program_tests.xml
  local counts
  scripts/build.sh release || { broken "$name" "$name: no build"; return; }
  rm -f "$report"
  BEAMGYRO=$PWD/build/release/beamgyro \
    /usr/bin/python3 tests/run.py --junit "$report"
  counts=$(/usr/bin/python3 scripts/count_tests.py "$report") ||
    { broken "$name" "$name: no report"; return; }
  # shellcheck disable=SC2086  # three numbers
  tally "$name" $counts
}

sources() {
  find config dataset sim compensation cli bench tests -name "$1" | sort
}

formatting() {
  local bad=0 all=0 file
  while read -r file; do
    all=$((all + 1))
    clang-format --dry-run -Werror "$file" >&2 || bad=$((bad + 1))
  done < <(sources '*.h'; sources '*.cpp')
  tally format $((all - bad)) "$bad" 0
}

# One file at a time on each core; a file with findings is named by them.
tidy() {
  [ -e build/dev/compile_commands.json ] ||
    { broken tidy "tidy: preset dev is not configured"; return; }
  local log=build/tidy.log all bad
  all=$(sources '*.cpp' | wc -l)
  : >"$log"
  bad=$(sources '*.cpp' | xargs -P "$(nproc)" -I{} bash -c '
    said=$(clang-tidy --quiet -p build/dev "$1" 2>&1) && exit
    printf "%s\n" "$said" >>"$2"
    echo "$1"' tidy {} "$log" | wc -l)
  [ "$bad" -eq 0 ] || cat "$log" >&2
  tally tidy $((all - bad)) "$bad" 0
}

scripts/setup.sh test || { broken set-up "set-up failed"; exit 1; }

formatting
program_tests
unit_tests dev
unit_tests asan
tidy

[ ${#failures[@]} -eq 0 ] || printf 'failed step: %s\n' "${failures[@]}"
total="$passed passed, $failed failed"
[ "$skipped" -eq 0 ] || total="$total, $skipped skipped"
echo "$total"
[ "$failed" -eq 0 ]
