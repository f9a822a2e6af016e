#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes a wheel that holds the libraries it needs: wheel.sh [BUILD [OUTPUT]]
# Without BUILD the program is built first, in build/release. The wheel goes to
# OUTPUT, or build/wheels. The same commit gives the same bytes.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${1:-$root/build/release}")
output=$(realpath -m "${2:-$root/build/wheels}")

fail() {
  echo "wheel: $*" >&2
  exit 1
}

for tool in cc cmake patchelf readelf strip; do
  command -v "$tool" >/dev/null || fail "no $tool here: scripts/setup.sh wheel"
done
[ $# -gt 0 ] || "$root/scripts/build.sh" release
# A release without the sources' history states its own time.
if [ -z "${SOURCE_DATE_EPOCH:-}" ]; then
  SOURCE_DATE_EPOCH=$(git -C "$root" log -1 --format=%ct) ||
    fail "no git history here: set SOURCE_DATE_EPOCH"
fi
export SOURCE_DATE_EPOCH LC_ALL=C TZ=UTC
umask 022
mkdir -p "$output"
rm -f "$output"/beamgyro-*.whl
/usr/bin/python3 -B "$root/packaging/wheel_backend.py" "$build" "$output"
