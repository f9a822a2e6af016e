#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the site of the documentation, build/docs/html/index.html, without a
# network; a warning is a failure: docs.sh [BUILD [OUTPUT]]
# BUILD (build/release) has the Python package, OUTPUT is build/docs.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${1:-$root/build/release}")
output=$(realpath -m "${2:-$root/build/docs}")

fail() {
  [ ! -s "$output/log" ] || tail -n 40 "$output/log" >&2
  echo "docs: $*" >&2
  exit 1
}

mkdir -p "$output"
: >"$output/log"
command -v doxygen >/dev/null || fail "no doxygen here: scripts/setup.sh test"
[ -e "$build/python/beamgyro/__init__.py" ] ||
  fail "no Python package in $build: scripts/build.sh release"

export BEAMGYRO_DOXYGEN=$output/doxygen/xml
export BEAMGYRO_PYTHON_PACKAGE=$build/python
BEAMGYRO_VERSION=$(sed -n 's/^#define BEAMGYRO_VERSION_[A-Z]* //p' \
  "$root/include/beamgyro/version.h" | paste -sd.)
export BEAMGYRO_VERSION
rm -rf "$output/doxygen" "$output/html"
mkdir "$output/doxygen"
doxygen - <<SETTINGS >>"$output/log" 2>&1 || fail "doxygen found faults"
PROJECT_NAME = beamgyro
INPUT = "$root/include/beamgyro"
OUTPUT_DIRECTORY = "$output/doxygen"
STRIP_FROM_PATH = "$root/include"
STRIP_FROM_INC_PATH = "$root/include"
GENERATE_XML = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
EXTRACT_ALL = YES
MACRO_EXPANSION = YES
EXPAND_ONLY_PREDEF = YES
PREDEFINED = __cplusplus BEAMGYRO_PLUGIN_EXPORT=
QUIET = YES
WARN_AS_ERROR = FAIL_ON_WARNINGS
SETTINGS
/usr/bin/python3 "$root/docs/site/pages.py" "$output/doxygen/xml" \
  "$output/source" 2>>"$output/log" || fail "the pages cannot be laid out"

PYTHONPATH=$build/python /usr/bin/python3 "$root/docs/site/notebooks.py" \
  "$output/source/notebooks" >>"$output/log" 2>&1 || fail "a notebook does not run"

/usr/bin/python3 -m sphinx -W --keep-going -q -b html -d "$output/doctrees" \
  "$output/source" "$output/html" >>"$output/log" 2>&1 ||
  fail "sphinx found faults"
echo "$output/html/index.html"
