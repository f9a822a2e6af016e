#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Takes the picture of a report for the documentation.

report_picture.py [--program FILE] [--out PICTURE.png]; PICTURE.png is
docs/pictures/report.png. Needs chromium.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/program"))
from browser import browser  # noqa: E402  (where it is comes first)

MODEL = ROOT / "scenarios/models/recommended.toml"
DEVICE = ROOT / "scenarios/devices/nominal.toml"
SPECIFICATION = ROOT / "specs/uav.toml"
WIDTH, HEIGHT = 1000, 1000  # [px]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", default=ROOT / "build/release/beamgyro")
    parser.add_argument("--out", type=pathlib.Path,
                        default=ROOT / "docs/pictures/report.png")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        answer = subprocess.run(
            [arguments.program, "validate", MODEL, "--device", DEVICE, "--spec",
             SPECIFICATION, "--report", folder],
            stdout=subprocess.DEVNULL, check=False)
        if answer.returncode not in (0, 3):
            return answer.returncode
        with browser() as tab:
            tab.open(folder / "index.html", WIDTH)
            tab.screenshot(arguments.out, height=HEIGHT)
    return 0


if __name__ == "__main__":
    sys.exit(main())
