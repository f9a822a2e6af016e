# SPDX-License-Identifier: MIT
"""The package that was built beside the program that is tested."""

import os
import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "program"))

from program import PROGRAM, SCENARIOS  # noqa: E402

PACKAGE = PROGRAM.parent / "python"
sys.path.insert(0, str(PACKAGE))
os.environ["PYTHONPATH"] = os.pathsep.join(
    filter(None, [str(PACKAGE), os.environ.get("PYTHONPATH")]))


def pytest_collection_modifyitems(items):
    """Leave warnings to the tests that expect them.

    A process that collects the reports of several workers would have to know
    the class, whose package it has not.
    """
    for item in items:
        if item.path.is_relative_to(pathlib.Path(__file__).parent):
            item.add_marker(pytest.mark.filterwarnings(
                "ignore::beamgyro.BeamgyroWarning"))


# Soaks of twenty minutes from -30 to 40 degC, a sample a second.
SWEEP = {
    "name": "sweep", "description": "short soaks", "fidelity": "quasistatic",
    "device": str(SCENARIOS / "devices/nominal.toml"), "duration_s": 12000,
    "output_rate_Hz": 1, "seed": 3,
    "ambient": {"points": [[0, -30], [12000, 40]]},
}


@pytest.fixture(scope="session")
def sweep_keys():
    """A ramp of the temperature as a mapping."""
    return SWEEP


@pytest.fixture(scope="session")
def sweeps():
    """Three recordings over the temperatures, with other noise each."""
    import beamgyro as bg
    return [bg.run(SWEEP, seed=seed) for seed in (3, 4, 5)]
