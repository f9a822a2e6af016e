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
COLORS = (128, 64, 40, 20, 12)  # fewer where a picture is larger than LARGEST
LARGEST = 60_000  # [bytes]
NOT_PASSED = 3  # of a validation

COMMANDS = """\
run scenarios/warm_up.toml -o {0}/warm_up.h5
run scenarios/rest.toml -o {0}/rest.h5
run scenarios/soak_sweep_train.toml -o {0}/train.h5
run scenarios/soak_sweep_validation.toml -o {0}/held_out.h5
train {0}/train.h5 --held-out {0}/held_out.h5 \
--model scenarios/models/spline.toml -o {0}/spline.json
compensate {0}/spline.json {0}/warm_up.h5 -o {0}/compensated.h5
characterise scenarios/devices/nominal.toml -o {0}/nominal.csv
characterise scenarios/campaigns/population.toml --devices 60 -o {0}/population.h5
allan {0}/rest.h5 --json {0}/allan.json
generate scenarios/campaigns/small.toml -o {0}/small
sensitivity scenarios/campaigns/small.toml --samples 256 \
--figure bias_pp_deg_per_s --json {0}/sensitivity.json
generate scenarios/campaigns/population.toml --devices 80 -o {0}/set
train {0}/set --run sweep --model scenarios/population/population.toml \
-o {0}/population.json
plan {0}/population.json --soaks 3 --json {0}/plan.json
validate scenarios/models/cubic.toml --spec specs/uav.toml \
--device scenarios/devices/nominal.toml --json {0}/validation.json
"""
# Each picture, and the file that it shows.
DRAWN = {
    "recording": "compensated.h5",
    "table": "nominal.csv",
    "curves": "population.h5",
    "compensator": "spline.json",
    "allan": "allan.json",
    "set": "small",
    "sensitivity": "sensitivity.json",
    "population": "population.json",
    "plan": "plan.json",
    "validation": "validation.json",
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    program = parser.parse_args().program.resolve()
    with tempfile.TemporaryDirectory() as folder:
        for line in COMMANDS.splitlines():
            words = [word.format(folder) for word in line.split()]
            status = subprocess.run([program, *words], cwd=ROOT, check=False,
                                    stdout=subprocess.DEVNULL).returncode
            if status not in (0, NOT_PASSED):
                raise SystemExit(f"{line}: ended with status {status}")
        for name, file in DRAWN.items():
            drawn = pathlib.Path(folder) / f"{name}.png"
            subprocess.run([program, "plot", pathlib.Path(folder) / file, "-o",
                            drawn], check=True)
            picture = Image.open(drawn).convert("RGB")
            picture.thumbnail((WIDTH, 4 * WIDTH), Image.LANCZOS)
            target = PICTURES / f"plot_{name}.png"
            for colors in COLORS:
                picture.quantize(colors, Image.MAXCOVERAGE).save(
                    target, optimize=True)
                if target.stat().st_size <= LARGEST:
                    break
            print(f"{target.name}: {target.stat().st_size} bytes")


if __name__ == "__main__":
    main()
