#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the image of the Dockerfile without a registry and runs it:
# try_image.sh [--whole] [PACKAGES [PLACE]]
# The base is a bare Debian 12 in PLACE (build/debian12), made once. PACKAGES
# (build/packages) stand for the first stage, which compiles them; with --whole
# it runs, too. A scenario must have the same bytes inside and outside.
# Needs root, debootstrap, buildah and a network.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
whole=no
if [ "${1:-}" = --whole ]; then whole=yes; shift; fi
packages=$(realpath -m "${1:-$root/build/packages}")
place=$(realpath -m "${2:-$root/build/debian12}")
log=$place/image.log

fail() {
  echo "try_image: $*" >&2
  exit 1
}

command -v buildah >/dev/null || fail "apt-get install buildah"
"$root/scripts/bare_debian.sh" "$place"
store=$place/images
rm -rf "$store"
builder() { buildah --root "$store/root" --runroot "$store/run" --storage-driver vfs "$@"; }
trap 'rm -rf "$store"' EXIT

# A group on the left of || would go on after a failure.
image() (
  set -e
  container=$(builder from scratch)
  builder add -q "$container" "$place/bare" /
  base=$(builder commit -q "$container" localhost/bare)
  builder tag "$base" docker.io/library/debian:12 docker.io/library/debian:12-slim
  first_stage=()
  if [ $whole = no ]; then
    mkdir -p "$store/first/src/build/packages"
    cp "$packages"/*.deb "$store/first/src/build/packages/"
    first_stage=(--build-context "build=$store/first")
  fi
  builder build --isolation chroot --pull=never "${first_stage[@]}" \
    -t localhost/beamgyro "$root"
)
set +e
image >"$log" 2>&1
made=$?
set -e
[ $made -eq 0 ] || { tail -n 20 "$log" >&2; fail "no image; see $log"; }

container=$(builder from --pull=never localhost/beamgyro)
mkdir "$store/data"
scenario=ten_minutes.toml
entry=$(builder inspect --format '{{index .OCIv1.Config.Entrypoint 0}}' "$container")
inside() {
  builder run --isolation chroot -v "$store/data:/data" "$container" -- "$@"
}
inside "$entry" run "/usr/share/beamgyro/scenarios/$scenario" -o /data/inside.h5
inside python3 -c 'import beamgyro; print(beamgyro.__file__)'
program=$root/build/release/beamgyro
[ $whole = no ] || [ -x "$program" ] || { echo "built and ran"; exit 0; }
"$program" run "$root/scenarios/$scenario" -o "$store/data/outside.h5"
cmp "$store/data/inside.h5" "$store/data/outside.h5" ||
  fail "the image writes other bytes than $program"
echo "built, ran and wrote the bytes of the program outside: the image"
