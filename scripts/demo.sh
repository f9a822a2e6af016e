#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The main job end to end: packages, build, simulate, train, score, draw.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh demo
scripts/build.sh release
exec /usr/bin/python3 scripts/demo.py
