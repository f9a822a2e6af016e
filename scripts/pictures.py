#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes every picture of the pages whose sources have changed since.

pictures.py [--program FILE] [--all] [--only NAME]

docs/pictures/sources.json says of which sources each was made. A source counts
by what it says, not by its comments. The physics in C++ does not count: it
changes with almost every commit, and pictures hardly. Needs chromium for the
picture of a report.
"""

import argparse
import ast
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs/pictures"
RECORD = PICTURES / "sources.json"
PYTHON = "/usr/bin/python3"

# Each maker: its command, what it makes, and what that is made of.
MAKERS = {
    "diagrams": ("scripts/diagrams.py", ["gyro.svg", "heat_flow.svg",
                                         "data_flow.svg"],
                 ["scripts/diagrams.py"]),
    "gallery": ("scripts/gallery.py", ["plot_*.png"],
                ["scripts/gallery.py", "python/beamgyro/plots/*.py",
                 "scenarios/devices/nominal.toml", "scenarios/warm_up.toml",
                 "scenarios/rest.toml", "scenarios/soak_sweep_*.toml",
                 "scenarios/models/spline.toml", "scenarios/models/cubic.toml",
                 "scenarios/campaigns/population.toml",
                 "scenarios/campaigns/small.toml",
                 "scenarios/population/population.toml",
                 "scenarios/qualification.toml", "specs/uav.toml"]),
    "report": ("scripts/report_picture.py", ["report.png"],
               ["scripts/report_picture.py", "validation/page/page.html",
                "scenarios/models/recommended.toml",
                "scenarios/devices/nominal.toml",
                "scenarios/qualification.toml", "specs/uav.toml"]),
    "closed_loop": ("examples/python/stabilised_platform.py",
                    ["closed_loop.png"],
                    ["examples/python/stabilised_platform.py",
                     "scenarios/devices/nominal.toml",
                     "scenarios/soak_sweep_train.toml",
                     "scenarios/models/cubic.toml"]),
    "demo": ("scripts/demo.py", ["drift.png", "spurious_modes.png"],
             ["scripts/figures.py", "scripts/demo.py", "scripts/demo_modes.py",
              "scripts/demo_runs.py", "python/beamgyro/plots/style.py",
              "scenarios/devices/nominal.toml", "scenarios/models/bp.toml"]),
}
# What the demo calls them.
OF_THE_DEMO = {"drift.png": "figure_7_bp.png",
               "spurious_modes.png": "spurious_modes.png"}


def meaning(path):
    """What a source says, without comments and layout where that is known."""
    text = path.read_text()
    if path.suffix == ".py":
        return ast.dump(ast.parse(text))
    if path.suffix == ".toml":
        return json.dumps(tomllib.loads(text), default=str, sort_keys=True)
    return re.sub(r"\s+", " ", text)


def matching(patterns, folder):
    """The files that patterns name; each has to name one or more."""
    found = set()
    for pattern in patterns:
        files = sorted(folder.glob(pattern))
        if not files:
            raise SystemExit(f"pictures: {pattern}: no such file in {folder}")
        found |= set(files)
    return sorted(found)


def state(maker):
    """Digests of the sources of a maker, and of its pictures."""
    _, pictures, sources = MAKERS[maker]
    digest = hashlib.sha256()
    for path in matching(sources, ROOT):
        digest.update(f"{path.relative_to(ROOT)}\n{meaning(path)}\n".encode())
    return {"sources": digest.hexdigest(), "pictures": {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in matching(pictures, PICTURES)}}


def old():
    """The makers whose pictures are not those that the record tells of."""
    known = json.loads(RECORD.read_text()) if RECORD.exists() else {}
    return [maker for maker in MAKERS if known.get(maker) != state(maker)]


def make(maker, program):
    """Makes the pictures of a maker anew."""
    command = [PYTHON, ROOT / MAKERS[maker][0]]
    if maker == "diagrams":
        command.append(PICTURES)
    elif maker == "closed_loop":
        command += ["scenarios/devices/nominal.toml",
                    "scenarios/soak_sweep_train.toml",
                    "scenarios/models/cubic.toml",
                    PICTURES / "closed_loop.png"]
    else:
        command += ["--program", program]
    subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "PYTHONPATH": str(program.parent / "python")})
    if maker == "demo":
        for name, drawn in OF_THE_DEMO.items():
            shutil.copy(ROOT / "out/demo" / drawn, PICTURES / name)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    parser.add_argument("--all", action="store_true",
                        help="also those whose sources are the same")
    parser.add_argument("--only", choices=MAKERS, action="append")
    given = parser.parse_args()
    known = json.loads(RECORD.read_text()) if RECORD.exists() else {}
    for maker in given.only or (MAKERS if given.all else old()):
        print(f"pictures: {maker}", flush=True)
        make(maker, given.program.resolve())
        known[maker] = state(maker)
        RECORD.write_text(json.dumps(known, indent=1, sort_keys=True) + "\n")


if __name__ == "__main__":
    sys.exit(main())
