#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Looks deeper than scripts/test.sh, from a bare machine: sanitize.sh [PART]...
#
#   address   the unit tests with the address, undefined-behaviour and leak
#             sanitizers where bytes are parsed, memory is owned or threads run,
#             with the assertions of Eigen and of the standard library everywhere
#   threads   what the program does on several threads, thread sanitizer
#   tidy      clang-tidy on every source
#   deep      the tests marked `deep`: installation, packages, the site of the
#             pages, a browser, Slurm, Octave, an emulated Cortex-M4, more draws
#   packages  the Debian packages in a bare Debian 12: installed, run, removed
#   image     the container image on that Debian, built and run
#
# Without a PART all of them. The last line is the total.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
# shellcheck source=scripts/ledger.sh
source scripts/ledger.sh
choose_parts address threads tidy deep packages image -- "$@"

# script NAME COMMAND...: a step that is one script, whose last line is shown.
script() {
  local name=$1 log=build/$1.log
  shift
  if "$@" >"$log" 2>&1; then
    tail -n 1 "$log"
    tally "$name" 1 0 0
  else
    tail -n 20 "$log" >&2
    broken "$name" "$name: see $log"
  fi
}

# as_root NAME COMMAND...: such a step, which only root can take.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    script "$@"
  else
    echo "skipped: $1: needs root" >&2
    tally "$1" 0 0 1
  fi
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

scripts/setup.sh sanitize || { broken set-up "set-up failed"; finish; exit; }
mkdir -p build

if wanted address; then
  if scripts/build.sh asan; then
    unit_tests "unit tests with sanitizers" asan --label-exclude 'many_draws|deep'
  else
    broken "build (asan)" "no build: see build/asan.log"
  fi
fi
if wanted threads; then
  if scripts/build.sh tsan; then
    program_tests "thread sanitizer" tsan tests/program/thread_test.py
  else
    broken "build (tsan)" "no build: see build/tsan.log"
  fi
fi
wanted tidy && tidy
if wanted deep || wanted packages || wanted image; then
  if build_release; then
    if wanted deep; then
      unit_tests "deep unit tests" release --label-regex deep
      program_tests "deep tests of the program" release -n "$(nproc)" -m deep
    fi
    if wanted packages || wanted image; then
      script "building the packages" scripts/package.sh build/release
    fi
    wanted packages && as_root "packages in a bare Debian" scripts/try_packages.sh
    wanted image && as_root "image" scripts/try_image.sh
  else
    broken "build (release)" "no build without warnings: see build/release.log"
  fi
fi
finish
