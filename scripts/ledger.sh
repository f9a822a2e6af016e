# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# What test.sh and sanitize.sh share, for `source`: steps, their outcomes, the
# total. Shows how long each step took.

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

# broken NAME MESSAGE: a step that could not even start counts as one failure.
broken() {
  echo "$2" >&2
  tally "$1" 0 1 0
}

# tally_report NAME FILE STATUS: tallies a JUnit report of a run that ended with
# a status. One that was interrupted has a report, too, without a failure.
tally_report() {
  local counts
  counts=$(/usr/bin/python3 scripts/count_tests.py "$2") ||
    { broken "$1" "$1: no report"; return; }
  # shellcheck disable=SC2086  # three numbers
  tally "$1" $counts
  if [ "$3" -ne 0 ] && [[ $counts == *" 0 "* ]]; then
    broken "$1" "$1: ended with status $3, and no test failed"
  fi
}

# unit_tests NAME PRESET [OPTION]...: an OPTION is given to ctest.
unit_tests() {
  local preset=$2 report=$PWD/build/$2/junit.xml status=0
  rm -f "$report"
  ctest --test-dir build/"$preset" -j "$(nproc)" --timeout 300 "${@:3}" \
    --output-on-failure --output-junit "$report" \
    >build/"$preset"/ctest.log 2>&1 || {
    status=$?
    grep -v -E '^ +Start|Passed +[0-9.]+ sec' build/"$preset"/ctest.log >&2
  }
  tally_report "$1" "$report" $status
}

# program_tests NAME PRESET [OPTION]...: tests that drive the program of a
# build; an OPTION is given to pytest.
program_tests() {
  local report=build/$2/program_tests.xml status=0
  rm -f "$report"
  BEAMGYRO=$PWD/build/$2/beamgyro \
    /usr/bin/python3 -m pytest --junit-xml="$report" "${@:3}" >&2 || status=$?
  tally_report "$1" "$report" $status
}

# build_release [OPTION]...: the program that ships, and its unit tests from the
# same objects. A warning of the compiler is a failure, also the next time: what
# was built with it goes.
build_release() {
  scripts/build.sh release -DBEAMGYRO_TESTS=ON "$@" || return
  if grep 'warning:' build/release.log >&2; then
    cmake --build --preset release --target clean >/dev/null
    return 1
  fi
}

# choose_parts KNOWN... -- NAMED...: sets `parts` to those named, or to all.
choose_parts() {
  local known=() name
  while [ "$1" != -- ]; do known+=("$1"); shift; done
  shift
  parts=("$@")
  [ $# -gt 0 ] || parts=("${known[@]}")
  for name in "${parts[@]}"; do
    [[ " ${known[*]} " == *" $name "* ]] || {
      echo "${0##*/}: no part $name; expected some of: ${known[*]}" >&2
      exit 2
    }
  done
}

wanted() { [[ " ${parts[*]} " == *" $1 "* ]]; }

# The last line is the total; the status says whether all passed.
finish() {
  [ ${#failures[@]} -eq 0 ] || printf 'failed step: %s\n' "${failures[@]}"
  local total="$passed passed, $failed failed"
  [ "$skipped" -eq 0 ] || total="$total, $skipped skipped"
  echo "$total"
  [ "$failed" -eq 0 ]
}
