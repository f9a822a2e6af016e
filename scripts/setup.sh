#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the Debian packages that are missing: setup.sh GROUP...
# demo: what the program is built and the demo run with, which is in every group;
# wheel: scripts/wheel.sh; test: scripts/test.sh; sanitizers, deep, bare: parts of
# scripts/sanitize.sh.
# Asks apt only when something is missing, so it works offline afterwards.
set -euo pipefail

build=(g++ cmake ninja-build libeigen3-dev libsundials-dev libhdf5-dev
       libtomlplusplus-dev libcli11-dev libfmt-dev nlohmann-json3-dev
       librandom123-dev libboost-dev libdeflate-dev libssl-dev
       libjs-chart.js
       pybind11-dev python3-dev python3-numpy
       python3 python3-matplotlib python3-h5py python3-xarray
       python3-h5netcdf python3-pip python3-venv)
tests=(libgtest-dev libbenchmark-dev clang-format clang-tidy netcdf-bin
       pkg-config mypy
       xvfb python3-tk python3-pytest python3-pytest-xdist python3-sklearn python3-torch
       python3-netcdf4 python3-scipy
       dpkg-dev file lintian man-db doxygen python3-breathe python3-sphinx
       python3-sphinx-rtd-theme python3-myst-parser
       python3-ipykernel python3-nbclient python3-tqdm python3-rdflib python3-yaml)
wheel=(patchelf binutils)
# What scripts/sanitize.sh has beyond the tests.
sanitizers=(clang lld libclang-rt-14-dev)
deep=("${wheel[@]}" clang chromium slurm-wlm munge snakemake octave octave-netcdf git
      gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm)
bare=("${wheel[@]}" debootstrap buildah git)

usage="usage: $0 demo|wheel|test|sanitizers|deep|bare..."
[ $# -gt 0 ] || { echo "$usage" >&2; exit 2; }
wanted=("${build[@]}")
for group in "$@"; do
  case "$group" in
    demo) ;;
    wheel) wanted+=("${wheel[@]}") ;;
    test) wanted+=("${tests[@]}") ;;
    sanitizers) wanted+=("${sanitizers[@]}") ;;
    deep) wanted+=("${deep[@]}") ;;
    bare) wanted+=("${bare[@]}") ;;
    *) echo "$usage" >&2; exit 2 ;;
  esac
done

fail() {
  echo "setup: $*" >&2
  exit 1
}

for tool in dpkg-query apt-get; do
  command -v "$tool" >/dev/null || fail "no $tool here: this script knows" \
    "Debian 12 only; install the equivalents of: ${wanted[*]}"
done

missing=()
for package in "${wanted[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) || true
  [ "$status" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || fail "neither root nor sudo; as root, run:" \
    "apt-get install ${missing[*]}"
  as_root=(sudo)
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get -q -o Dpkg::Use-Pty=0 "$@" </dev/null >>"$log" 2>&1
}

echo "setup: installing ${#missing[@]} Debian packages: ${missing[*]}" >&2
# Stale lists may still serve, so only the installation decides.
apt update || echo "setup: apt-get update failed; trying the lists there are" >&2
if ! apt install -y --no-install-recommends "${missing[@]}"; then
  tail -n 20 "$log" >&2
  fail "apt-get could not install: ${missing[*]} (is there a network?)"
fi
