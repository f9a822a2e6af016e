# SPDX-License-Identifier: MIT
"""The figures of the dynamics, from the shipped scenarios."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

from program import PROGRAM, ROOT


class DynamicsFigures(unittest.TestCase):
    def test_are_drawn(self):
        with tempfile.TemporaryDirectory(prefix="some figures ") as folder:
            subprocess.run(
                [sys.executable, ROOT / "scripts/dynamics_figures.py",
                 "--program", PROGRAM, "--out", folder],
                cwd=folder, capture_output=True, check=True)
            for name in ["start_up", "rate_step", "frequency_response",
                         "fidelities"]:
                for suffix in ["png", "svg"]:
                    picture = pathlib.Path(folder) / f"{name}.{suffix}"
                    self.assertGreater(picture.stat().st_size, 10000)
