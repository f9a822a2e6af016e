#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the packages in a bare Debian 12 of its own, runs them, removes them
# and compares the files before and after: try_packages.sh [PACKAGES [PLACE]]
# Needs root, debootstrap and a network. PLACE (build/debian12) keeps the bare
# system for the next time; this one itself is left alone.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
packages=$(realpath "${1:-$root/build/packages}")
place=$(realpath -m "${2:-$root/build/debian12}")
bare=$place/bare system=$place/system

fail() {
  echo "try_packages: $*" >&2
  exit 1
}

[ "$(id -u)" -eq 0 ] || fail "needs root, for chroot"
ls "$packages"/*.deb >/dev/null || fail "no packages in $packages"

"$root/scripts/bare_debian.sh" "$place"
rm -rf "$system"
cp -a "$bare" "$system"
cp /etc/resolv.conf "$system/etc/resolv.conf"
mount -t proc proc "$system/proc"
trap 'umount "$system/proc"' EXIT

inside() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive chroot "$system" bash -euo pipefail -c "$1"
}

# What the machine holds, less what apt and dpkg keep for themselves.
state() {
  inside 'dpkg-query -W -f "\${Package} \${Status}\n"
    find / -xdev \( -path /proc -o -path /sys -o -path /tmp -o -path /dev \
      -o -path /var/lib/apt -o -path /var/cache -o -path /var/log \
      -o -path /var/lib/dpkg \) -prune -o -print' | sort
}

cp "$packages"/*.deb "$system/tmp/"
# What they depend on, but for each other, stays: to remove that is the business
# of apt.
inside 'apt-get update
  apt-get install -y --no-install-recommends man-db
  for file in /tmp/*.deb; do
    apt-get satisfy -y --no-install-recommends \
      "$(dpkg-deb -f "$file" Depends | sed "s/libbeamgyro[^,]*, //")"
  done' >"$place/apt.log" 2>&1 || fail "see $place/apt.log"
state >"$place/before"
inside 'apt-get install -y --no-install-recommends /tmp/*.deb' \
  >>"$place/apt.log" 2>&1 || fail "installation failed, see $place/apt.log"

inside 'cd /tmp
  beamgyro --version
  beamgyro run /usr/share/beamgyro/scenarios/ten_minutes.toml -o run.h5
  beamgyro info run.h5 | head -n 3
  beamgyro validate --list-metrics | wc -l
  library=$(ldconfig -p | sed -n "s/.*libbeamgyro.so.0.1 .*=> //p")
  for file in /usr/bin/beamgyro "${library:?}"; do
    if ldd "$file" | grep "not found"; then exit 1; fi
  done
  man beamgyro | grep -c "beamgyro"
  man beamgyro-run | grep -- "--fidelity"
  . /usr/share/bash-completion/completions/beamgyro
  COMP_WORDS=(beamgyro al) COMP_CWORD=1; _beamgyro; echo "${COMPREPLY[@]:?}"
  if [ -d /usr/lib/python3/dist-packages/beamgyro ]; then
    python3 -c "import beamgyro
run = beamgyro.run(\"/usr/share/beamgyro/scenarios/ten_minutes.toml\")
print(run.rate.mean().item())"
  fi'

inside 'names=$(for file in /tmp/*.deb; do dpkg-deb -f "$file" Package; done)
  apt-get purge -y $names' >>"$place/apt.log" 2>&1 ||
  fail "removal failed, see $place/apt.log"
state >"$place/after"
diff "$place/before" "$place/after" ||
  fail "the removal left or took something, see above"
echo "installed, ran and removed: $packages"
