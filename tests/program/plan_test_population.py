# SPDX-License-Identifier: MIT
"""A population of few devices to plan for."""

import subprocess

from program import PROGRAM, SCENARIOS

DEVICES = 60


def population_of(folder):
    """FOLDER/population.json, learned from the sweeps of some devices."""
    campaign = (SCENARIOS / "campaigns/population.toml").read_text()
    first, *_ = campaign.split("[[run]]")
    (folder / "campaigns").mkdir()
    (folder / "campaigns/sweep.toml").write_text(
        first.replace("../", f"{SCENARIOS}/") +
        f'[[run]]\nname = "sweep"\n'
        f'scenario = "{SCENARIOS}/soak_sweep_sparse.toml"\n'
        '[output]\nvariables = ["rate", "temperature", "quadrature", '
        '"true_rate"]\n')

    def beamgyro(*words):
        subprocess.run([PROGRAM, *words], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
    beamgyro("generate", "campaigns/sweep.toml", "-o", "set", "--devices",
             str(DEVICES))
    beamgyro("train", "set", "--model",
             SCENARIOS / "population/population.toml", "-o", "population.json")
    return folder / "population.json"
