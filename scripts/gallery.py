#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws the pictures of docs/guide/plots.md: gallery.py [--program FILE]

They go to docs/pictures/plot_*.png, in few colours to keep them small.
"""

import argparse
import pathlib
import subprocess
import tempfile

from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs/pictures"
WIDTH = 800  # [px]
COLORS = 20
LARGEST = 60_000  # [bytes]

COMMANDS = """\
run scenarios/warm_up.toml -o {0}/warm_up.h5
run scenarios/rest.toml -o {0}/rest.h5
run scenarios/soak_sweep_train.toml -o {0}/train.h5
run scenarios/soak_sweep_validation.toml -o {0}/held_out.h5
train {0}/train.h5 --held-out {0}/held_out.h5 \
--model scenarios/models/spline.toml -o {0}/spline.json
compensate {0}/spline.json {0}/warm_up.h5 -o {0}/compensated.h5
characterise scenarios/devices/nominal.toml -o {0}/nominal.csv
allan {0}/rest.h5 --json {0}/allan.json
plot {0}/compensated.h5 -o {0}/plot_recording.png
plot {0}/nominal.csv -o {0}/plot_table.png
plot {0}/spline.json -o {0}/plot_compensator.png
plot {0}/allan.json -o {0}/plot_allan.png
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    program = parser.parse_args().program.resolve()
    with tempfile.TemporaryDirectory() as folder:
        for line in COMMANDS.splitlines():
            words = [word.format(folder) for word in line.split()]
            subprocess.run([program, *words], cwd=ROOT, check=True,
                           stdout=subprocess.DEVNULL)
        for path in sorted(pathlib.Path(folder).glob("plot_*.png")):
            picture = Image.open(path).convert("RGB")
            picture.thumbnail((WIDTH, 4 * WIDTH), Image.LANCZOS)
            target = PICTURES / path.name
            picture.quantize(COLORS).save(target, optimize=True)
            print(f"{target.name}: {target.stat().st_size} bytes")
            if target.stat().st_size > LARGEST:
                raise SystemExit(f"{target}: larger than {LARGEST} bytes")


if __name__ == "__main__":
    main()
