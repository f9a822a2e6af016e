#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# After a small change: builds the tests of the rooms that changed since the
# last commit, or of those named, and runs them: check.sh [ROOM]...
# Rooms: config, linear_algebra, random, parallel, dataset, set, numerics,
# thermal, signal, device, dynamics, scenario, campaign, compensation,
# validation, report.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

rooms=("$@")
if [ ${#rooms[@]} -eq 0 ]; then
  mapfile -t rooms < <(git status --porcelain | cut -c4- | sed -n -E \
    -e 's,^.* -> ,,' -e 's,^tests/,,' -e 's,^dataset/set/.*,set,p' \
    -e 's,^sim/([a-z]+)/.*,\1,p' \
    -e 's,^(config|linear_algebra|random|parallel|dataset|compensation|validation|report)/.*,\1,p' |
    sort -u)
fi
[ ${#rooms[@]} -gt 0 ] || { echo "check: no room changed" >&2; exit 0; }

mkdir -p build
[ -e build/dev/build.ninja ] || cmake --preset dev >build/dev.log
cmake --build --preset dev --target "${rooms[@]/%/_test}" >build/dev.log ||
  { tail -n 40 build/dev.log >&2; exit 1; }
for room in "${rooms[@]}"; do
  folder=$(find build/dev/tests -name CMakeFiles -prune -o -type d -name "$room" -print | head -n 1)
  ctest --test-dir "$folder" -j "$(nproc)" --timeout 300 --output-on-failure |
    grep -v -E '^ +Start|Passed +[0-9.]+ sec|^$'
done
