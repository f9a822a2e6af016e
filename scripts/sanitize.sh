#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Looks deeper than scripts/test.sh, from a bare machine: sanitize.sh [PART]...
#
#   address   the unit tests with the address, undefined-behaviour and leak
#             sanitizers where bytes are parsed, memory is owned or threads run,
#             with the assertions of Eigen and of the standard library
#   threads   what the program does on several threads, thread sanitizer
#   fuzz      every reader of files, a minute of changed inputs each
#   tidy      clang-tidy on every source
#
# and, for what will be released,
#
#   deep      the benchmarks, compiled; the tests marked `deep`: packages, the site
#             of the pages, a browser, Slurm, Octave, an emulated Cortex-M4, more
#             draws
#   faults    a fault at every call on files and pipes
#   packages  the Debian packages and the wheel in a bare Debian 12: installed,
#             run, removed
#   image     the container image on that Debian, built and run
#
# Without a PART the first four; `sanitize.sh all` is all of them. The last line
# is the total.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
# shellcheck source=scripts/ledger.sh
source scripts/ledger.sh
of_each_change=(address threads fuzz tidy) of_a_release=(deep faults packages image)
[ $# -gt 0 ] || set -- "${of_each_change[@]}"
[ "$*" != all ] || set --
choose_parts "${of_each_change[@]}" "${of_a_release[@]}" -- "$@"

# script NAME COMMAND...: a step that is one script, whose last line is shown.
# Returns whether it succeeded.
script() {
  local name=$1 log=build/$1.log
  shift
  if "$@" >"$log" 2>&1; then
    tail -n 1 "$log"
    tally "$name" 1 0 0
  else
    tail -n 20 "$log" >&2
    broken "$name" "$name: see $log"
    return 1
  fi
}

# as_root NAME COMMAND...: such a step, which only root can take.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    script "$@"
  else
    broken "$1" "$1: needs root"
  fi
}

# sanitized PRESET SANITIZER: builds a preset, which must have the sanitizer.
sanitized() {
  scripts/build.sh "$1" &&
    grep -q "^BEAMGYRO_SANITIZE:.*=$2" "build/$1/CMakeCache.txt"
}

# The files are read in bundles: most of the time goes to the headers of
# libraries. A bundle with findings counts as one failure.
tidy() {
  cmake --preset tidy >build/tidy_configure.log 2>&1 ||
    { broken tidy "tidy: see build/tidy_configure.log"; return; }
  local log=build/tidy.log all bad
  scripts/tidy_bundles.py build/tidy 8000 >build/tidy_files
  all=$(wc -l <build/tidy_files)
  [ "$all" -gt 0 ] || { broken tidy "tidy: no sources"; return; }
  : >"$log"
  bad=$(xargs -d '\n' -P "$(nproc)" -I{} bash -c '
    said=$(clang-tidy --quiet -p build/tidy/bundles \
      --checks=-bugprone-suspicious-include \
      --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-shadow \
      "$1" 2>&1) && exit
    printf "%s\n" "$said" >>"$2"
    echo "$1"' tidy {} "$log" <build/tidy_files | wc -l)
  [ "$bad" -eq 0 ] || cat "$log" >&2
  tally tidy $((all - bad)) "$bad" 0
}

groups=(test)
if wanted address || wanted threads || wanted fuzz; then groups+=(sanitizers); fi
if wanted deep; then groups+=(deep); fi
if wanted packages || wanted image; then groups+=(bare); fi
scripts/setup.sh "${groups[@]}" || { broken set-up "set-up failed"; finish; exit; }
mkdir -p build

if wanted address; then
  # Left out: what follows a loop through millions of its periods, finds the noise
  # of as many samples, draws whole populations, scores whole qualifications, or
  # trains every kind of compensator. The parts of these have tests of their own.
  computing=(ReplayOfLoops RebalanceStability LoopChannelRun V55DriveFrequency
             NoiseCoefficients UndecidableLimits AdaptationSigma HysteresisRms
             PopulationMembership PopulationOwnParts SpuriousPopulation
             DeclaredResponse PlantedFaults ExportedC)
  if sanitized asan address; then
    unit_tests "unit tests with sanitizers" asan --label-exclude 'many_draws|deep' \
      --exclude-regex "$(IFS='|'; echo "${computing[*]}")"
  else
    broken "build (asan)" "no build with sanitizers: see build/asan.log"
  fi
fi
if wanted threads; then
  if sanitized tsan thread; then
    program_tests "thread sanitizer" tsan tests/program/thread_test.py
  else
    broken "build (tsan)" "no build with the sanitizer: see build/tsan.log"
  fi
fi
if wanted fuzz; then
  readers=(tests/fuzz/*_fuzz.cpp)
  script fuzz scripts/fuzz.sh $(((${#readers[@]} + $(nproc) - 1) / $(nproc)))
fi
wanted tidy && tidy
# The benchmarks, too, which nothing else links.
if wanted deep || wanted faults || wanted packages || wanted image; then
  if build_release -DBEAMGYRO_BENCH=ON; then
    if wanted deep; then
      unit_tests "deep unit tests" release --label-regex deep --timeout 900
      program_tests "deep tests of the program" release -n "$(nproc)" -m deep
    fi
    if wanted faults; then
      BEAMGYRO_ALL_FAULTS=1 program_tests "faults at every call" release \
        -n "$(nproc)" tests/program/fault_test.py tests/program/pipe_faults_test.py
    fi
    if wanted packages || wanted image; then
      rm -rf build/packages
      if script "building the packages" scripts/package.sh build/release; then
        wanted packages && as_root "packages in a bare Debian" scripts/try_packages.sh
        if wanted packages && script "building the wheel" scripts/wheel.sh build/release; then
          as_root "wheel in a bare Debian" scripts/try_wheel.sh
        fi
        wanted image && as_root "image" scripts/try_image.sh
      fi
    fi
  else
    broken "build (release)" "no build without warnings: see build/release.log"
  fi
fi
finish
