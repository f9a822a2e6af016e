#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# After a small change: builds the tests of the rooms that changed since the
# last commit, or of those named, and runs them: check.sh [ROOM]...
# A ROOM is a folder of tests/ with a CMakeLists.txt: config, dataset, set,
# thermal, compensation, ...
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# room_of FILE: the nearest folder above it whose mirror in tests/ has tests.
room_of() {
  local folder=${1#tests/}
  while [[ $folder == */* ]]; do
    folder=${folder%/*}
    if [ -e "tests/$folder/CMakeLists.txt" ]; then
      basename "$folder"
      return
    fi
  done
}

rooms=("$@")
if [ ${#rooms[@]} -eq 0 ]; then
  changed=$(git status --porcelain -uall)
  mapfile -t rooms < <(cut -c4- <<<"$changed" | sed 's,^.* -> ,,' |
    while read -r file; do room_of "$file"; done | sort -u)
fi
[ ${#rooms[@]} -gt 0 ] || { echo "check: no room with unit tests changed" >&2; exit 0; }

mkdir -p build
[ -e build/dev/build.ninja ] || cmake --preset dev >build/dev.log
cmake --build --preset dev --target "${rooms[@]/%/_test}" >build/dev.log ||
  { tail -n 40 build/dev.log >&2; exit 1; }
for room in "${rooms[@]}"; do
  folder=$(find build/dev/tests -name CMakeFiles -prune -o -type d -name "$room" -print | head -n 1)
  ctest --test-dir "$folder" -j "$(nproc)" --timeout 300 --no-tests=error --output-on-failure |
    grep -v -E '^ +Start|Passed +[0-9.]+ sec|^$'
done
