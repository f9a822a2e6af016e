# SPDX-License-Identifier: MIT
"""The figures of the dynamics, from the shipped scenarios."""

import pathlib
import sys
import tempfile
import unittest

from program import PROGRAM, ROOT, said


class DynamicsFigures(unittest.TestCase):
    def test_are_drawn(self):
        with tempfile.TemporaryDirectory(prefix="some figures ") as folder:
            said(sys.executable, ROOT / "scripts/dynamics_figures.py",
                 "--program", PROGRAM, "--out", folder, cwd=folder)
            for name in ["start_up", "rate_step", "frequency_response",
                         "fidelities"]:
                for suffix in ["png", "svg"]:
                    picture = pathlib.Path(folder) / f"{name}.{suffix}"
                    self.assertGreater(picture.stat().st_size, 10000)
