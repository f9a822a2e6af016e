# SPDX-License-Identifier: MIT
"""A read that fails is an error: nothing counts as absent because of it."""

import os
import pathlib
import subprocess
import tempfile
import unittest

from program import CUBIC, ProgramTest, ramp
from sets import Set

SHIM = pathlib.Path(__file__).with_name("failing_reads.c")


class FailingReads:
    """Runs a command again and again, each time with another failing read."""

    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.shim = pathlib.Path(cls.holder.name) / "failing_reads.so"
        subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", cls.shim, SHIM,
                        "-ldl"], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()

    def with_failing_read(self, number, *arguments):
        environment = {**os.environ, "LD_PRELOAD": str(self.shim),
                       "READ_FAILS": str(number)}
        return self.beamgyro(*arguments, env=environment)


class Recordings(FailingReads, ProgramTest):
    def strip(self, name):
        """Takes the checksum: reading it is no longer what fails first."""
        path = self.dir / name
        path.write_bytes(path.read_bytes().rpartition(b"\nSHA-256 of")[0])

    def test_no_read_of_a_recording_fails_in_silence(self):
        self.run_scenario("run", "--set", "beam.length_m=0.0401",
                          text=ramp(seconds=400))
        self.write("cubic.toml", CUBIC)
        self.ok("train", "run.h5", "--model", "cubic.toml", "-o", "c.json")
        for stripped in [False, True]:
            if stripped:
                self.strip("run.h5")
            compensate = ["compensate", "c.json", "run.h5", "-o", "out.h5"]
            self.ok(*compensate)
            whole = (self.dir / "out.h5").read_bytes()
            failures = 0
            for number in range(1, 1000):
                (self.dir / "out.h5").unlink()
                answer = self.with_failing_read(number, *compensate)
                if answer.returncode == 0:
                    self.assertEqual((self.dir / "out.h5").read_bytes(), whole,
                                     f"read {number}")
                    break
                failures += 1
                self.assertEqual(answer.returncode, 1, answer.stderr)
                self.assertIn("run.h5: ", answer.stderr)
                self.assertIn("Input/output error", answer.stderr)
                self.assertFalse((self.dir / "out.h5").exists())
                (self.dir / "out.h5").touch()
            self.assertGreater(failures, 20 if stripped else 2)

    def test_info_tells_an_error_from_another_kind_of_file(self):
        self.run_scenario("run")
        self.strip("run.h5")
        for number in range(1, 12):
            answer = self.with_failing_read(number, "info", "run.h5")
            self.assertEqual(answer.returncode, 1, answer.stderr)
            self.assertIn("Input/output error", answer.stderr)


class Sets(FailingReads, Set):
    def test_a_view_is_right_or_not_there(self):
        self.generate("whole")
        whole = self.contents("whole")
        failures = 0
        for number in range(1, 400):
            name = f"set{number}"
            answer = self.with_failing_read(number, "generate", "campaign.toml",
                                            "-o", name, "--jobs", "1")
            if answer.returncode == 0:
                self.assertEqual(self.contents(name), whole, f"read {number}")
                break
            failures += 1
            self.assertEqual(answer.returncode, 1, answer.stderr)
            if number % 7 == 0:
                self.generate(name, "--resume")
                self.assertEqual(self.contents(name), whole, f"read {number}")
        self.assertGreater(failures, 20)


if __name__ == "__main__":
    unittest.main()
