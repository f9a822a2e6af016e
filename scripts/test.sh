#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Proves that the program works, from a bare machine: test.sh [PART]...
#
#   format    clang-format on every source
#   units     the release build without warnings, all unit tests
#   program   the same build, all tests of the program, of Python and of the
#             scripts
#
# Without a PART all of them. The last line is the total. What takes longer and
# looks deeper is in scripts/sanitize.sh.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
# shellcheck source=scripts/ledger.sh
source scripts/ledger.sh
choose_parts format units program -- "$@"

# A file with a finding counts as one failure.
formatting() {
  local all bad outcome log=build/format.log
  mkdir -p build
  find . \( -path ./build -o -path ./out -o -name '.?*' \) -prune -o \
    \( -name '*.h' -o -name '*.cpp' \) -print | sort >build/format_files
  all=$(wc -l <build/format_files)
  xargs -d '\n' clang-format --dry-run -Werror <build/format_files >"$log" 2>&1
  outcome=$?
  bad=$(sed -n 's/^\([^: ]*\):[0-9]*:.*/\1/p' "$log" | sort -u | wc -l)
  cat "$log" >&2
  if [ "$outcome" -ne 0 ] && [ "$bad" -eq 0 ]; then bad=1; fi
  [ "$all" -gt 0 ] || bad=1 all=1
  tally format $((all - bad)) "$bad" 0
}

scripts/setup.sh test || { broken set-up "set-up failed"; finish; exit; }

wanted format && formatting
if wanted units || wanted program; then
  if build_release -DBEAMGYRO_BENCH=OFF; then
    wanted units && unit_tests "unit tests" release --label-exclude deep
    wanted program && program_tests "tests of the program and the scripts" \
      release -n "$(nproc)" -m "not deep"
  else
    broken "build (release)" "no build without warnings: see build/release.log"
  fi
fi

echo "scripts/sanitize.sh checks the rest: memory and undefined behaviour," \
  "races between threads, readers of files with changed inputs, clang-tidy;" \
  "scripts/sanitize.sh all also what is for a release"
finish
