# SPDX-License-Identifier: MIT
"""beamgyro: a vibrating-beam gyro, its drift, and compensators of it.

>>> import beamgyro as bg
>>> recording = bg.run("scenarios/warm_up.toml", set={"duration_s": 60})
>>> compensator = bg.train("scenarios/models/cubic.toml", ["train.h5"])
>>> print(bg.validate(compensator, ["test.h5"]))

Values and files are those of the program `beamgyro`, to the last bit. What
is wrong in an input raises ValueError with file and key, or the argument, the
value that was met and what would be right; work that failed raises
RuntimeError. Long calls leave the other threads of Python running and
end within a fraction of a second after Ctrl-C.

xarray, pandas and matplotlib are imported when they are first needed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from beamgyro._analysis import allan, plan, sensitivity
from beamgyro._campaign import Campaign
from beamgyro._compensation import Compensator, compensate
from beamgyro._core import Cancelled
from beamgyro._core import version as __version__
from beamgyro._curves import (HalfSplit, area_metric, characterise,
                              curve_figures, half_split)
from beamgyro._dataset import open_recording, save_recording
from beamgyro._design import DesignedDevice, DesignFigure, design_device
from beamgyro._device import Device
from beamgyro._estimator import Estimator, LegSplit, RunSplit
from beamgyro._export import export
from beamgyro._gyro import Gyro, Sample, Truth, step_all
from beamgyro._import import import_log
from beamgyro._many import run_many
from beamgyro._results import (AllanResult, CurveFiguresResult, PlanResult,
                               SensitivityResult)
from beamgyro._scenario import Scenario, run, run_to_file
from beamgyro._set import Set, generate, open_set
from beamgyro._training import features, train, training_rows
from beamgyro._validation import validate
from beamgyro._validation_result import ValidationResult
from beamgyro._warnings import BeamgyroWarning
from beamgyro._windows import Windows

__all__ = [
    "AllanResult", "BeamgyroWarning", "Campaign", "Cancelled",
    "Compensator", "CurveFiguresResult", "DesignFigure", "DesignedDevice",
    "Device", "Estimator", "Gyro", "HalfSplit", "LegSplit", "PlanResult",
    "RunSplit", "Sample", "Scenario", "SensitivityResult", "Set", "Truth",
    "ValidationResult", "Windows", "__version__", "allan", "area_metric",
    "characterise", "compensate", "curve_figures", "design_device",
    "export", "features", "generate", "half_split", "import_log",
    "open_recording", "open_set", "plan", "run", "run_many", "run_to_file",
    "save_recording", "sensitivity", "step_all", "train", "training_rows",
    "validate",
]


if TYPE_CHECKING:
    # A module-level __getattr__ would let every misspelt name pass.
    from beamgyro import plots as plots
else:
    def __getattr__(name):
        if name == "plots":
            from importlib import import_module
            return import_module("beamgyro.plots")
        raise AttributeError(f"module 'beamgyro' has no attribute {name!r}")

    def __dir__():
        return [*__all__, "plots"]
