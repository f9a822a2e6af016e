#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# From a clone to `import beamgyro`: packages, build, and a Python that has the
# module and the command, in DIR (build/venv): python.sh [DIR]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
place=$(realpath -m "${1:-build/venv}")

scripts/setup.sh demo
# NumPy, xarray and matplotlib are those of the system.
/usr/bin/python3 -m venv --system-site-packages "$place"
"$place/bin/pip" install --no-index --disable-pip-version-check -q .
echo "$place/bin/python: has beamgyro" \
  "$("$place/bin/python" -c 'import beamgyro; print(beamgyro.__version__)')"
