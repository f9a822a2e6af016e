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
allan {0}/rest.h5 --json {0}/allan.json
generate scenarios/campaigns/small.toml -o {0}/small
sensitivity scenarios/campaigns/small.toml --samples 256 \
--figure bias_pp_deg_per_s --json {0}/sensitivity.json
generate scenarios/campaigns/population.toml --devices 80 -o {0}/set
train {0}/set --run sweep --model scenarios/population/population.toml \
-o {0}/population.json
plan {0}/population.json --soaks 3 --json {0}/plan.json
validate {0}/spline.json {0}/warm_up.h5 {0}/held_out.h5 {0}/rest.h5 \
--json {0}/scores.json
validate scenarios/models/cubic.toml --spec specs/uav.toml \
--device scenarios/devices/nominal.toml --json {0}/validation.json
plot {0}/compensated.h5 -o {0}/plot_recording.png
plot {0}/nominal.csv -o {0}/plot_table.png
plot {0}/spline.json -o {0}/plot_compensator.png
plot {0}/allan.json -o {0}/plot_allan.png
plot {0}/small -o {0}/plot_set.png
plot {0}/sensitivity.json -o {0}/plot_sensitivity.png
plot {0}/population.json -o {0}/plot_population.png
plot {0}/plan.json -o {0}/plot_plan.png
plot {0}/scores.json -o {0}/plot_scores.png
plot {0}/validation.json -o {0}/plot_validation.png
"""


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
        for path in sorted(pathlib.Path(folder).glob("plot_*.png")):
            picture = Image.open(path).convert("RGB")
            picture.thumbnail((WIDTH, 4 * WIDTH), Image.LANCZOS)
            target = PICTURES / path.name
            for colors in COLORS:
                picture.quantize(colors, Image.MAXCOVERAGE).save(
                    target, optimize=True)
                if target.stat().st_size <= LARGEST:
                    break
            print(f"{target.name}: {target.stat().st_size} bytes")


if __name__ == "__main__":
    main()
