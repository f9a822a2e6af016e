#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the Debian packages: package.sh [BUILD [OUTPUT]]
# Without BUILD the program is built first, in build/release. The packages go
# to OUTPUT, or build/packages. The same commit gives the same bytes.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${1:-$root/build/release}")
output=$(realpath -m "${2:-$root/build/packages}")

fail() {
  echo "package: $*" >&2
  exit 1
}

for tool in cpack dpkg-shlibdeps file strip; do
  command -v "$tool" >/dev/null ||
    fail "no $tool here: apt-get install cmake dpkg-dev file"
done
[ $# -gt 0 ] || "$root/scripts/build.sh" release
[ -e "$build/CPackConfig.cmake" ] || fail "$build is no build of beamgyro"
# A release without the sources' history states its own time.
if [ -z "${SOURCE_DATE_EPOCH:-}" ]; then
  SOURCE_DATE_EPOCH=$(git -C "$root" log -1 --format=%ct) ||
    fail "no git history here: set SOURCE_DATE_EPOCH"
fi
export SOURCE_DATE_EPOCH LC_ALL=C TZ=UTC
umask 022

mkdir -p "$output"
log=$output/cpack.log
rm -f "$output"/*.deb
(cd "$build" && cpack --config CPackConfig.cmake -B "$output") >"$log" 2>&1 || {
  tail -n 20 "$log" >&2
  fail "cpack failed; the whole log is $log"
}
rm -rf "$output/_CPack_Packages"
ls "$output"/*.deb
