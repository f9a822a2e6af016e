# SPDX-License-Identifier: MIT
"""Spurious modes in the runs of the program."""

import h5py

from program import SCENARIOS, ProgramTest

IDLE = {"detuning": -4.720732e-3, "detuning_tc_per_K": -2.5e-4,
        "loss_factor": 1e-3, "coupling_drive": 0, "coupling_sense": 0}
LASTS = {"quasistatic": 1800, "envelope": 2, "carrier": 0.5}


def columns(path):
    """Bytes of every signal of a recording; meta/ holds what was typed."""
    found = {}

    def take(name, item):
        if isinstance(item, h5py.Dataset) and not name.startswith("meta/"):
            found[name] = item[()].tobytes()
    with h5py.File(path) as file:
        file.visititems(take)
    return found


def others(one, other):
    """Names of the signals of one run that are not the same in the other."""
    return [name for name in one if one[name] != other.get(name)]


class SpuriousMode(ProgramTest):
    def record(self, fidelity, *keys):
        (self.dir / "out.h5").unlink(missing_ok=True)
        self.ok("run", SCENARIOS / "warm_up.toml", "--set",
                f'fidelity="{fidelity}"', "--set",
                f"duration_s={LASTS[fidelity]}", *(
                    x for key in keys for x in ("--set", key)),
                "-o", "out.h5")
        return columns(self.dir / "out.h5")

    def test_v59_a_mode_without_coupling_leaves_all_bytes_as_they_are(self):
        idle = [f"spurious_mode.wire.{key}={value}"
                for key, value in IDLE.items()]
        coupled = [*idle[:3], "spurious_mode.wire.coupling_drive=2e-5",
                   "spurious_mode.wire.coupling_sense=2e-5"]
        for fidelity in LASTS:
            with self.subTest(fidelity):
                none = self.record(fidelity)
                self.assertEqual(others(none, self.record(fidelity, *idle)), [])
                self.assertIn("output",
                              others(none, self.record(fidelity, *coupled)))
