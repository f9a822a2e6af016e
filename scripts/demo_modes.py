# SPDX-License-Identifier: MIT
"""The part of the demo on units with spurious modes.

Eight units of scenarios/campaigns/lifelike_with_modes.toml are drawn. What a
table over the temperature leaves is shown of one unit more,
scenarios/devices/lifelike_with_modes.toml: trained on two sweeps with a soak
every 5 K, scored at every kelvin, without noise.
"""

import h5py
import numpy as np

from demo_runs import MODES_SWEEPS, MODES_TEST, SCENARIOS

UNITS = 8
METHODS = ["cubic", "straight_lines", "bp"]
SETTLED = 30  # samples of 20 s for which the chamber has not moved


def soaks(file):
    """Chamber temperature and residual at the end of each soak."""
    chamber = file["true_ambient_temperature"][()]
    left = file["compensated_rate"][()] - file["true_rate"][()]
    held = np.abs(chamber[SETTLED:] - chamber[:-SETTLED]) < 1e-6
    chamber, left = chamber[SETTLED:][held].round(6), left[SETTLED:][held]
    temperatures = np.unique(chamber)
    # The end: the last quarter of the samples at this temperature.
    ends = [left[chamber == each] for each in temperatures]
    return temperatures, np.array([end[-len(end) // 4:].mean()
                                   for end in ends])


def study(demo):
    """Rows of the table, by method."""
    folder = demo.out / "modes"
    folder.mkdir(exist_ok=True)
    demo.simulate([*MODES_SWEEPS, MODES_TEST], [])
    name = MODES_TEST[0]
    demo.beamgyro("characterise", SCENARIOS / "campaigns/lifelike_with_modes.toml",
                  "--devices", UNITS, "--beam-temperature", "-40:50:0.25",
                  "-o", folder / "curves.csv")

    def row(method):
        demo.fit(method, MODES_SWEEPS[:2], MODES_SWEEPS[2:],
                 folder / f"{method}.json")
        copy = demo.recording(f"{name}_{method}")
        demo.beamgyro("compensate", folder / f"{method}.json",
                      demo.recording(name), "-o", copy)
        with h5py.File(copy) as file:
            temperatures, left = soaks(file)
        copy.unlink()
        return {"method": method, "temperatures_degC": list(temperatures),
                "residual_deg_per_s": list(left),
                "rms_deg_per_s": float(np.sqrt(np.mean(left ** 2))),
                "max_deg_per_s": float(np.max(np.abs(left)))}
    return demo.all(row, METHODS)


def table(rows, labels):
    lines = ["", "A unit with spurious modes, trained on soaks every 5 K, scored "
             "at every kelvin; deg/s.",
             f"{'method':26}|{'rms':>9}{'max':>8}",
             "-" * 26 + "+" + "-" * 17]
    lines += [f"{labels[r['method']]:26}|{r['rms_deg_per_s']:9.4f}"
              f"{r['max_deg_per_s']:8.3f}" for r in rows]
    return "\n".join(lines)
