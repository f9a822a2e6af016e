# SPDX-License-Identifier: MIT
"""The libraries of tests/faults/ that change what the program meets."""

import os
import pathlib
import tempfile

from program import ROOT, ProgramTest, class_folder, said


class ShimTest(ProgramTest):
    """A test that loads the library SHIM before the program."""

    SHIM = None

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.shim = class_folder(cls) / f"{cls.SHIM}.so"
        said("cc", "-std=c11", "-O1", "-shared", "-fPIC",
             ROOT / f"tests/faults/{cls.SHIM}.c", "-o", cls.shim, "-ldl")

    def shimmed(self, **variables):
        """The environment of a program with the library."""
        return os.environ | {"LD_PRELOAD": str(self.shim), **variables}


class FaultTest(ShimTest):
    """One file-system call fails."""

    SHIM = "fault_shim"

    def faulty(self, place, arguments, **plan):
        """The answer of a command in a folder, all of whose calls on files
        below that folder are numbered; `plan` is as the shim has it."""
        return self.beamgyro(
            *arguments, cwd=place, timeout=600,
            env=self.shimmed(FAULT_PREFIX=str(place), **plan))

    def calls(self, place, arguments, status=0):
        """Number, name and file of the calls of a command in peace, where it
        ends with a status."""
        with tempfile.TemporaryDirectory() as name:
            log = pathlib.Path(name) / "calls"
            answer = self.faulty(place, arguments, FAULT_LOG=str(log))
            self.assertEqual(answer.returncode, status, answer.stderr)
            lines = [line.split(" ", 2) for line in log.read_text().splitlines()]
        return [(int(number), name, path.removeprefix(f"{place}/"))
                for number, name, path in lines]
