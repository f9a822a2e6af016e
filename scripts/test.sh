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

# tally_report NAME FILE: tallies a JUnit report.
tally_report() {
  local counts
  counts=$(/usr/bin/python3 scripts/count_tests.py "$2") ||
    { broken "$1" "$1: no report"; return; }
  # shellcheck disable=SC2086  # three numbers
  tally "$1" $counts
}

# The program that ships, its unit tests and its benchmarks from the same
# objects. A compiler's warning is a failure.
build_release() {
  scripts/build.sh release -DBEAMGYRO_TESTS=ON -DBEAMGYRO_BENCH=ON || return
  ! grep 'warning:' build/release.log >&2
}

# unit_tests PRESET [OPTION]...: an OPTION is given to ctest.
unit_tests() {
  local preset=$1 name="unit tests ($1)" report=$PWD/build/$1/junit.xml
  rm -f "$report"
  ctest --test-dir build/"$preset" -j "$(nproc)" --timeout 300 "${@:2}" \
    --output-on-failure --output-junit "$report" \
    >build/"$preset"/ctest.log 2>&1 ||
    grep -v -E '^ +Start|Passed +[0-9.]+ sec' build/"$preset"/ctest.log >&2
  tally_report "$name" "$report"
}

program_tests() {
  local report=build/program_tests.xml
  rm -f "$report"
  BEAMGYRO=$PWD/build/release/beamgyro \
    /usr/bin/python3 -m pytest -n "$(nproc)" --junit-xml="$report" >&2
  tally_report "tests of the program and the scripts" "$report"
}

# What the program does on several threads, under the thread sanitizer.
races() {
  local report=build/tsan/junit.xml
  rm -f "$report"
  BEAMGYRO=$PWD/build/tsan/beamgyro \
    /usr/bin/python3 -m pytest tests/program/thread_test.py \
    --junit-xml="$report" >&2
  tally_report "thread sanitizer" "$report"
}

sources() {
  find config parallel random dataset sim compensation planning validation sensitivity report api cli python include examples bench tests -name "$1" | sort
}

formatting() {
  local bad=0 all=0 file
  while read -r file; do
    all=$((all + 1))
    clang-format --dry-run -Werror "$file" >&2 || bad=$((bad + 1))
  done < <(sources '*.h'; sources '*.cpp')
  tally format $((all - bad)) "$bad" 0
}

# The files are read in the bundles of a unity build: most of the time goes to
# the headers of libraries. A bundle with findings counts as one failure.
tidy() {
  cmake --preset tidy >build/tidy_configure.log 2>&1 ||
    { broken tidy "tidy: see build/tidy_configure.log"; return; }
  local log=build/tidy.log all bad
  /usr/bin/python3 -c 'import json
for entry in json.load(open("build/tidy/compile_commands.json")):
    print(entry["file"])' | grep -v '/revision.cpp$' | sort -u >build/tidy_files
  all=$(wc -l <build/tidy_files)
  : >"$log"
  bad=$(xargs -d '\n' -P "$(nproc)" -I{} bash -c '
    said=$(clang-tidy --quiet -p build/tidy \
      --checks=-bugprone-suspicious-include \
      --extra-arg=-Wno-unknown-warning-option "$1" 2>&1) && exit
    printf "%s\n" "$said" >>"$2"
    echo "$1"' tidy {} "$log" <build/tidy_files | wc -l)
  [ "$bad" -eq 0 ] || cat "$log" >&2
  tally tidy $((all - bad)) "$bad" 0
}

scripts/setup.sh test || { broken set-up "set-up failed"; exit 1; }

formatting
if build_release; then
  unit_tests release --label-exclude deep
  program_tests
else
  broken "build (release)" "no build without warnings: see build/release.log"
fi
if scripts/build.sh asan; then
  unit_tests asan --label-exclude 'many_draws|deep'
else
  broken "build (asan)" "no build: see build/asan.log"
fi
if scripts/build.sh tsan; then
  races
else
  broken "build (tsan)" "no build: see build/tsan.log"
fi
tidy

[ ${#failures[@]} -eq 0 ] || printf 'failed step: %s\n' "${failures[@]}"
total="$passed passed, $failed failed"
[ "$skipped" -eq 0 ] || total="$total, $skipped skipped"
echo "$total"
[ "$failed" -eq 0 ]
