# SPDX-License-Identifier: MIT
"""A population of few devices to plan for."""

from program import PROGRAM, SCENARIOS, said


def population_of(folder, devices=60):
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
    said(PROGRAM, "generate", "campaigns/sweep.toml", "-o", "set", "--devices",
         devices, cwd=folder)
    said(PROGRAM, "train", "set", "--model",
         SCENARIOS / "population/population.toml", "-o", "population.json",
         cwd=folder)
    return folder / "population.json"
