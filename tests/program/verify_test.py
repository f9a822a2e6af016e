# SPDX-License-Identifier: MIT
"""verify and info on sets, and what sets survive."""

import os
import re
import shutil
import signal
import socket
import subprocess
import unittest

import numpy as np

from program import PROGRAM, class_folder, said
from sets import Set, set_faults


class Verify(Set):
    def prepare(self):
        super().prepare()
        self.generate("set")
        shutil.copytree(self.dir / "set", self.dir / "before")

    def lose(self, name, text=None):
        """Takes a file of the set away, or puts a text in its place."""
        (self.dir / "set" / name).unlink()
        if text is not None:
            self.write(f"set/{name}", text)

    def mended(self, *says):
        """A damaged set is found to be so, and is made again."""
        if says:
            self.assertSays(self.ok("verify", "set", allowed=(1,)), says)
        self.ok("verify", "set", "--repair")
        self.assertEqual(self.contents("set"), self.contents("before"))
        self.assertIn("whole", self.ok("verify", "set"))

    def test_lost_and_damaged_files_are_made_again(self):
        for name, text, *says in [
                ("ramp_00002.h5", None, "missing"), ("rest.nc", "nothing"),
                ("manifest.jsonl", None, "rest_00000.h5"),
                ("source/head.jsonl", None)]:
            self.lose(name, text)
            self.mended(name, *says)

    def test_swapped_files_name_each_other(self):
        one, other = (self.dir / f"set/rest_0000{k}.h5" for k in range(2))
        content = one.read_bytes()
        one.write_bytes(other.read_bytes())
        other.write_bytes(content)
        self.mended(re.compile(rf"{one.name}.*{other.name}"))

    def test_a_damaged_manifest_is_made_again(self):
        digest = re.search(r'"bytes":\d+,"sha256":"([0-9a-f]{64})"',
                           self.text("set/manifest.jsonl"))[1]
        self.change("set/manifest.jsonl", digest, digest[::-1])
        self.mended("manifest.jsonl")

    def test_a_foreign_file_is_named_and_not_touched(self):
        self.write("set/foreign.h5", "mine")
        self.assertIn("foreign.h5", self.ok("verify", "set", allowed=(1,)))
        self.beamgyro("verify", "set", "--repair")
        self.assertEqual(self.text("set/foreign.h5"), "mine")

    def test_repair_needs_nothing_but_the_set(self):
        """Lost and damaged sources come from the files."""
        sources = ["campaign.toml", "rest.toml", "ramp.toml", "device.toml"]
        for name in sources:
            (self.dir / name).unlink()
        self.lose("ramp_00000.h5", "")
        self.mended()
        for name, text in zip(sources, ["x\n", "", None, None]):
            self.lose(f"source/{name}", text)
        self.lose("rest_00000.h5")
        self.mended(*[f"source/{name}" for name in sources])

    def test_everything_but_one_file_of_each_run_is_made_again(self):
        for path in (self.dir / "set").rglob("*"):
            if path.is_file() and path.name not in {
                    "rest_00001.h5", "ramp_00003.h5", "head.jsonl"}:
                path.unlink()
        self.mended()

    def test_a_source_that_is_in_no_file_is_named(self):
        self.write("log.csv", "time_s,temperature_degC\n0,20\n60,30\n")
        self.change("rest.toml", "constant_degC = 25", 'file = "log.csv"')
        self.generate("other")
        self.write("other/source/log.csv", "x\n")
        self.assertSays(self.warned("verify", "other", "--repair", allowed=(1,)),
                        ["source/log.csv", "resume the generation"])
        self.generate("other", "--resume")
        self.assertIn("whole", self.ok("verify", "other"))

    def test_files_named_by_their_full_place_are_made_of_their_copies(self):
        elsewhere = self.dir / "devices"
        elsewhere.mkdir()
        (self.dir / "device.toml").rename(elsewhere / "unit.toml")
        for name in ["campaign.toml", "rest.toml", "ramp.toml"]:
            self.change(name, "device.toml", str(elsewhere / "unit.toml"))
        self.generate("other")
        before = self.contents("other")
        (elsewhere / "unit.toml").unlink()
        (self.dir / "other/rest_00002.h5").unlink()
        self.ok("verify", "other", "--repair")
        self.assertEqual(self.contents("other"), before)

    def test_a_clock_that_jumps_changes_nothing(self):
        for path in (self.dir / "set").iterdir():
            os.utime(path, (4e9, 4e9))
        self.assertIn("whole", self.ok("verify", "set"))
        self.generate("set", "--resume")
        self.assertEqual(self.contents("set"), self.contents("before"))


class Lost(Set):
    def test_a_file_that_vanishes_while_others_are_made_is_told(self):
        self.change("campaign.toml", "devices = 7", "devices = 400")
        for name, *arguments in ["one"], ["other", "--shard", "1/1"]:
            with self.working("generate", "campaign.toml", "-o", name, "--jobs",
                              1, *arguments, until=f"{name}/rest_00001.h5"
                              ) as process:
                (self.dir / name / "rest_00000.h5").unlink()
                said = process.communicate()[1]
            self.assertEqual(process.returncode, 1, said)
            self.assertIn("rest_00000.h5 has vanished", said)
            self.generate(name, "--resume")
            self.assertIn("whole", self.ok("verify", name))

    def test_nothing_that_the_dead_left_stays(self):
        self.generate("set", "--shard", "1/2")
        dead = f"{socket.gethostname()}-{said('sh', '-c', 'echo $$').strip()}"
        left = [self.write(f"set/{name}.partial-{dead}-{number}", "half")
                for name, number in [("rest_00000.h5", 0),
                                     ("source/rest.toml", 0),
                                     ("source/head.jsonl", 3)]]
        self.generate("set", "--shard", "2/2")
        for name in left:
            self.assertFalse((self.dir / name).exists(), name)


class Info(Set):
    def test_a_set_and_a_file_of_it_are_summarised(self):
        self.generate("set")
        self.assertSays(self.ok("info", "set"), [
            "campaign.toml", "7 devices", "rest", "ramp", "0 failed",
            "patches_offset_m_0", "whole"])
        self.assertSays(self.ok("info", "set/rest_00003.h5"), [
            "devices 6 to 6", "rest", "output", "true_bias"])

    def test_a_set_that_is_not_whole_says_what_it_lacks(self):
        self.generate("set", "--shard", "1/2")
        self.assertIn("4 of 8 files", self.ok("info", "set"))

    def test_a_device_is_made_again_by_run(self):
        self.generate("set")
        said = self.ok("info", "set", "--device", 3)
        drawn = re.search(r"(?s)campaign.toml\n(.*?)\n\n", said).group(1)
        settings = [word for line in drawn.splitlines()
                    for word in ["--set", line]]
        self.ok("run", "rest.toml", "-o", "run.h5", "--set",
                "noise.enabled=false", *settings)
        np.testing.assert_allclose(
            self.signals("set/rest_00001.h5")["true_bias"][1],
            self.signals("run.h5")["true_bias"], rtol=2e-7)
        self.rejected("info", "set", "--device", 7, says="devices 0 to 6")
        self.rejected("info", "run.h5", "--device", 0, says="run.h5")


class Faults(unittest.TestCase):
    """The short form of bench/set_faults.py."""

    @classmethod
    def setUpClass(cls):
        cls.faults = set_faults.Faults(PROGRAM, class_folder(cls))

    def test_twenty_kills_leave_the_bytes_of_an_uninterrupted_run(self):
        self.assertEqual(self.faults.kills(20)["kills"], 20)

    def test_terminations_do_too(self):
        self.assertEqual(
            self.faults.kills(10, with_signal=signal.SIGTERM)["kills"], 10)

    def test_every_damage_is_found_and_mended(self):
        self.assertEqual(sum(self.faults.damages(40).values()), 40)

    def test_twenty_starts_have_one_winner(self):
        self.assertEqual(self.faults.starts(20)["winners"], 1)

    def test_full_disks_end_in_an_error_and_are_recovered_from(self):
        if os.geteuid() != 0:
            self.skipTest("a disk that fills up needs root to mount one")
        try:
            figures = self.faults.full_disks(20)
        except subprocess.CalledProcessError:
            self.skipTest("mounting a small disk is not allowed here")
        self.assertEqual(figures["sizes"], 20)
