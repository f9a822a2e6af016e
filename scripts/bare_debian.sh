#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes a bare Debian 12 in PLACE/bare, unless it is there: bare_debian.sh PLACE
# Needs root, debootstrap and a network.
set -euo pipefail
place=${1:?usage: bare_debian.sh PLACE}

fail() {
  echo "bare_debian: $*" >&2
  exit 1
}

[ ! -e "$place/bare/etc/debian_version" ] || exit 0
[ "$(id -u)" -eq 0 ] || fail "needs root, for debootstrap"
command -v debootstrap >/dev/null || fail "apt-get install debootstrap"
# That of this machine.
mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' \
  'Origin: Debian' 'Codename: bookworm' | sort -u | sed -n 1p)
[ -n "$mirror" ] || fail "apt names no mirror of Debian"
mkdir -p "$place"
rm -rf "$place/bare.new"
debootstrap --variant=minbase bookworm "$place/bare.new" "$mirror" \
  >"$place/debootstrap.log" 2>&1 || fail "see $place/debootstrap.log"
rm -rf "$place/bare"
mv "$place/bare.new" "$place/bare"
