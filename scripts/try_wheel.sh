#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the wheel of scripts/wheel.sh in a bare Debian 12 that has Python,
# NumPy, pip and venv alone, and runs it there: try_wheel.sh [WHEELS [PLACE]]
# Needs root, debootstrap and a network; the installation itself has none.
# PLACE (build/debian12) keeps the bare system for the next time.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
wheels=$(realpath "${1:-$root/build/wheels}")
place=$(realpath -m "${2:-$root/build/debian12}")
system=$place/python

fail() {
  echo "try_wheel: $*" >&2
  exit 1
}

[ "$(id -u)" -eq 0 ] || fail "needs root, for chroot"
ls "$wheels"/beamgyro-*.whl >/dev/null || fail "no wheel in $wheels"
"$root/scripts/bare_debian.sh" "$place"

# inside OPTION COMMANDS: in the system, with what the OPTION of unshare keeps
# from it. The program finds its libraries by /proc/self/exe.
inside() {
  unshare --mount "$1" bash -c 'mount -t proc proc "$0/proc"
    exec chroot "$0" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
      LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
      bash -euo pipefail -c "$1"' "$system" "$2"
}

if [ ! -e "$system/ready" ]; then
  rm -rf "$system"
  cp -a "$place/bare" "$system"
  cp /etc/resolv.conf "$system/etc/resolv.conf"
  inside --uts 'apt-get update
    apt-get install -y --no-install-recommends \
      python3 python3-numpy python3-pip python3-venv' >"$place/apt.log" 2>&1 ||
    fail "see $place/apt.log"
  touch "$system/ready"
fi
rm -rf "$system/tmp/wheel"
mkdir "$system/tmp/wheel"
cp "$wheels"/beamgyro-*.whl "$system/tmp/wheel/"

start=$SECONDS
inside --net 'cd /tmp/wheel
  python3 -m venv --system-site-packages here
  here/bin/pip install --no-index --disable-pip-version-check -q beamgyro-*.whl
  here/bin/python -W ignore -c "
import beamgyro as bg
scenarios = \"here/share/beamgyro/scenarios/\"
run = bg.run(scenarios + \"ten_minutes.toml\", output=\"arrays\")
print(bg.__version__, len(run[\"rate\"]), run[\"rate\"].mean())
bg.run_to_file(scenarios + \"ten_minutes.toml\", \"python.h5\")
bg.run_to_file(scenarios + \"ramp.toml\", \"ramp.h5\")
bg.train(scenarios + \"models/cubic.toml\", [\"ramp.h5\"]).save(\"cubic.json\")"
  here/bin/beamgyro compensate cubic.json python.h5 -o compensated.h5
  here/bin/beamgyro info compensated.h5 | head -n 1
  here/bin/beamgyro run here/share/beamgyro/scenarios/ten_minutes.toml -o run.h5
  cmp run.h5 python.h5
  cp -r here/lib/python3*/site-packages/beamgyro-*.dist-info/licenses .
  here/bin/pip uninstall -y -q beamgyro
  left=$(find here -type f -path "*beamgyro*")
  [ -z "$left" ] || { echo "left by the removal: $left"; exit 1; }' ||
  fail "the wheel does not work in $system"
echo "installed and ran in $((SECONDS - start)) s: $(basename "$wheels"/*.whl)"
