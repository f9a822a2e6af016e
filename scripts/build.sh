#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Configures and builds one preset: build.sh dev|asan|tsan|release [OPTION]...
# An OPTION is given to cmake. Quiet while it goes well; a failure shows what
# the tools said.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=${1:?usage: build.sh PRESET [OPTION]...}
shift

mkdir -p build
log=build/$preset.log

fail() {
  grep -n -m 5 -E 'error|Error|FAILED' "$log" >&2 || true
  tail -n 40 "$log" >&2
  echo "build: $1 of preset '$preset' failed; the whole log is $log" >&2
  exit 1
}

[ -e "build/$preset/build.ninja" ] ||
  echo "build: preset '$preset', for the first time; takes some minutes" >&2
# Compilations seen before are taken from ccache where that is installed.
if [ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
cmake --preset "$preset" "$@" >"$log" 2>&1 || fail configuring
# With another compiler CMake drops the cache, and with it what the preset says.
if grep -q 'require your cache to be deleted' "$log"; then
  cmake --fresh --preset "$preset" "$@" >"$log" 2>&1 || fail configuring
fi
cmake --build --preset "$preset" --parallel "$(nproc)" >>"$log" 2>&1 ||
  fail building
