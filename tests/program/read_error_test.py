# SPDX-License-Identifier: MIT
"""A read that fails is an error: nothing counts as absent because of it."""

import pathlib
import shutil
import tempfile

from faults import FaultTest
from program import ramp
from sets import Set


class FailingReads(FaultTest):
    def reads_of_hdf5(self, place, arguments):
        return [number for number, name, path in self.calls(place, arguments)
                if name == "read" and ".h5" in path]

    def failed(self, place, arguments, number):
        """The message of a command whose call `number` failed."""
        answer = self.faulty(place, arguments, FAULT_KIND="EIO",
                             FAULT_CALL=str(number))
        self.assertEqual(answer.returncode, 1, answer.stderr)
        self.assertIn("Input/output error", answer.stderr)
        return answer.stderr


class Recordings(FailingReads):
    def strip(self, name):
        """Takes the checksum: reading it is no longer what fails first."""
        path = self.dir / name
        path.write_bytes(path.read_bytes().rpartition(b"\nSHA-256 of")[0])

    def test_no_read_of_a_recording_fails_in_silence(self):
        self.run_scenario("run", "--set", "beam.length_m=0.0401",
                          text=ramp(seconds=400))
        self.train_on("run.h5")
        compensate = ["compensate", "c.json", "run.h5", "-o", "out.h5"]
        for stripped in [False, True]:
            if stripped:
                self.strip("run.h5")
            reads = self.reads_of_hdf5(self.dir, compensate)
            self.assertGreater(len(reads), 20)
            for number in reads:
                (self.dir / "out.h5").unlink(missing_ok=True)
                self.failed(self.dir, compensate, number)
                self.assertFalse((self.dir / "out.h5").exists())

    def test_info_tells_an_error_from_another_kind_of_file(self):
        self.run_scenario("run")
        self.strip("run.h5")
        for number in self.reads_of_hdf5(self.dir, ["info", "run.h5"]):
            self.assertIn("run.h5: ",
                          self.failed(self.dir, ["info", "run.h5"], number))


class Sets(FailingReads, Set):
    def test_a_view_is_right_or_not_there(self):
        self.generate("whole")
        whole = self.contents("whole")
        generate = ["generate", "campaign.toml", "-o", "set", "--jobs", "1"]
        reads = self.reads_of_hdf5(self.dir, generate)
        self.assertGreater(len(reads), 20)
        for number in reads[::12]:
            with tempfile.TemporaryDirectory() as folder:
                place = pathlib.Path(folder) / "place"
                shutil.copytree(self.dir, place,
                                ignore=shutil.ignore_patterns("set", "whole"))
                self.failed(place, generate, number)
                self.ok(*generate[:2], "-o", place / "set", "--resume")
                self.assertEqual(self.contents(place / "set"), whole,
                                 f"read {number}")
