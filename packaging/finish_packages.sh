#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What Debian asks of a package beyond the installed files.
# finish_packages.sh STAGE VERSION CONTACT: STAGE has a directory of each
# component. Time stamps become those of SOURCE_DATE_EPOCH [s].
set -euo pipefail
stage=$1 version=$2 contact=$3
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
epoch=${SOURCE_DATE_EPOCH:-$(git -C "$source" log -1 --format=%ct)}

# changelog PACKAGE: the changelog in Debian's form.
changelog() {
  cat <<TEXT
beamgyro ($version) unstable; urgency=medium

  * Built from the sources of beamgyro ${version%-*}; its own changelog is
    /usr/share/doc/$1/changelog.gz.

 -- $contact  $(LC_ALL=C date -u -d "@$epoch" -R)
TEXT
}

for pair in runtime=beamgyro "debian_lib=libbeamgyro${version%.*}" \
  debian_dev=libbeamgyro-dev python=python3-beamgyro; do
  root=$stage/${pair%=*} package=${pair#*=}
  [ -d "$root" ] || continue
  documents=$root/usr/share/doc/$package
  install -d -m 755 "$documents"
  install -m 644 "$source/packaging/debian/copyright" "$documents"
  # Pages link to it; Debian has a licence once.
  [ ! -e "$documents/LICENSE" ] || ln -sf copyright "$documents/LICENSE"
  gzip -9n <"$source/CHANGELOG.md" >"$documents/changelog.gz"
  changelog "$package" | gzip -9n >"$documents/changelog.Debian.gz"
  find "$root" -name '*.a' -exec strip --strip-debug \
    --remove-section=.comment --remove-section=.note \
    --enable-deterministic-archives {} +
  find "$root" -name __pycache__ -prune -exec rm -r {} +
  chmod -R u+w,go-w,a+rX "$root"
  find "$root" -exec touch -h -d "@$epoch" {} +
done
