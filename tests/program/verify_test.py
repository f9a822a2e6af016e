# SPDX-License-Identifier: MIT
"""verify and info on sets, and what sets survive."""

import os
import re
import signal
import socket
import subprocess
import time
import unittest

import h5py
import numpy as np

from program import PROGRAM, class_folder
from sets import CAMPAIGN, Set, set_faults


class Verify(Set):
    def setUp(self):
        super().setUp()
        self.generate("set")
        self.before = self.contents("set")

    def found(self, *names):
        answer = self.beamgyro("verify", "set")
        self.assertEqual(answer.returncode, 1, answer.stderr)
        for name in names:
            self.assertIn(name, answer.stdout)
        return answer.stdout

    def repaired(self):
        self.ok("verify", "set", "--repair")
        self.assertEqual(self.contents("set"), self.before)
        self.assertIn("whole", self.ok("verify", "set"))

    def test_a_missing_file_is_made_again(self):
        (self.dir / "set/ramp_00002.h5").unlink()
        self.assertIn("missing", self.found("ramp_00002.h5"))
        self.repaired()

    def test_swapped_files_name_each_other(self):
        one, other = (self.dir / f"set/rest_0000{k}.h5" for k in range(2))
        content = one.read_bytes()
        one.write_bytes(other.read_bytes())
        other.write_bytes(content)
        said = self.found(one.name, other.name)
        self.assertRegex(said, rf"{one.name}.*{other.name}")
        self.repaired()

    def test_a_damaged_view_is_made_again(self):
        (self.dir / "set/rest.nc").write_bytes(b"nothing")
        self.found("rest.nc")
        self.repaired()

    def test_a_damaged_manifest_is_made_again(self):
        manifest = self.dir / "set/manifest.jsonl"
        text = manifest.read_text()
        digest = re.search(r'"bytes":\d+,"sha256":"([0-9a-f]{64})"',
                           text).group(1)
        manifest.write_text(text.replace(digest, digest[::-1]))
        self.found("manifest.jsonl")
        self.repaired()

    def test_a_foreign_file_is_named_and_not_touched(self):
        foreign = self.dir / "set/foreign.h5"
        foreign.write_bytes(b"mine")
        self.found("foreign.h5")
        self.beamgyro("verify", "set", "--repair")
        self.assertEqual(foreign.read_bytes(), b"mine")

    def test_repair_needs_nothing_but_the_set(self):
        for name in ["campaign.toml", "rest.toml", "ramp.toml", "device.toml"]:
            (self.dir / name).unlink()
        (self.dir / "set/ramp_00000.h5").write_bytes(b"")
        self.repaired()

    def test_a_lost_manifest_is_made_again(self):
        (self.dir / "set/manifest.jsonl").unlink()
        self.found("manifest.jsonl", "rest_00000.h5")
        self.repaired()

    def test_a_lost_copy_of_the_first_line_is_made_again(self):
        (self.dir / "set/source/head.jsonl").unlink()
        self.found("source/head.jsonl")
        self.repaired()

    def test_lost_and_damaged_sources_come_from_the_files(self):
        for name in ["campaign.toml", "rest.toml", "ramp.toml", "device.toml"]:
            (self.dir / name).unlink()
        source = self.dir / "set/source"
        for name, text in [("campaign.toml", "x\n"), ("device.toml", None),
                           ("rest.toml", ""), ("ramp.toml", None)]:
            if text is None:
                (source / name).unlink()
            else:
                (source / name).write_text(text)
        (self.dir / "set/rest_00000.h5").unlink()
        self.found("source/campaign.toml", "source/device.toml",
                   "source/rest.toml", "source/ramp.toml")
        self.repaired()

    def test_everything_but_one_file_of_each_run_is_made_again(self):
        for path in (self.dir / "set").rglob("*"):
            if path.is_file() and path.name not in {
                    "rest_00001.h5", "ramp_00003.h5", "head.jsonl"}:
                path.unlink()
        self.repaired()

    def test_a_source_that_is_in_no_file_is_named(self):
        self.write("log.csv", "time_s,temperature_degC\n0,20\n60,30\n")
        self.write("rest.toml", (self.dir / "rest.toml").read_text().replace(
            "constant_degC = 25", 'file = "log.csv"'))
        self.generate("other")
        (self.dir / "other/source/log.csv").write_text("x\n")
        answer = self.beamgyro("verify", "other", "--repair")
        self.assertEqual(answer.returncode, 1)
        self.assertIn("source/log.csv", answer.stderr)
        self.assertIn("resume the generation", answer.stderr)
        self.generate("other", "--resume")
        self.assertIn("whole", self.ok("verify", "other"))

    def test_files_named_by_their_full_place_are_made_of_their_copies(self):
        elsewhere = self.dir / "devices"
        elsewhere.mkdir()
        (self.dir / "device.toml").rename(elsewhere / "unit.toml")
        for name in ["campaign.toml", "rest.toml", "ramp.toml"]:
            self.write(name, (self.dir / name).read_text().replace(
                "device.toml", str(elsewhere / "unit.toml")))
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
        self.assertEqual(self.contents("set"), self.before)


class Lost(Set):
    def test_a_file_that_vanishes_while_others_are_made_is_told(self):
        self.write("campaign.toml", CAMPAIGN.replace("devices = 7",
                                                     "devices = 400"))
        for arguments in [[], ["--shard", "1/1"]]:
            with self.subTest(arguments):
                folder = self.dir / f"set{len(arguments)}"
                with subprocess.Popen(
                        [str(PROGRAM), "generate", "campaign.toml", "-o",
                         folder.name, "--jobs", "1", *arguments],
                        cwd=self.dir, text=True, stdout=subprocess.PIPE,
                        stderr=subprocess.PIPE) as process:
                    while not (folder / "rest_00001.h5").exists():
                        time.sleep(0.01)
                    (folder / "rest_00000.h5").unlink()
                    said = process.communicate()[1]
                self.assertEqual(process.returncode, 1, said)
                self.assertIn("rest_00000.h5 has vanished", said)
                self.generate(folder.name, "--resume")
                self.assertIn("whole", self.ok("verify", folder.name))

    def test_nothing_that_the_dead_left_stays(self):
        self.generate("set", "--shard", "1/2")
        host = socket.gethostname()
        ended = subprocess.run(["sh", "-c", "echo $$"], capture_output=True,
                               check=True, text=True).stdout.strip()
        left = [f"rest_00000.h5.partial-{host}-{ended}-0",
                f"source/rest.toml.partial-{host}-{ended}-0",
                f"source/head.jsonl.partial-{host}-{ended}-3"]
        for name in left:
            (self.dir / "set" / name).write_bytes(b"half")
        self.generate("set", "--shard", "2/2")
        for name in left:
            self.assertFalse((self.dir / "set" / name).exists(), name)


class Info(Set):
    def test_a_set_is_summarised(self):
        self.generate("set")
        said = self.ok("info", "set")
        for part in ["campaign.toml", "7 devices", "rest", "ramp", "0 failed",
                     "patches_offset_m_0", "whole"]:
            self.assertIn(part, said)

    def test_a_set_that_is_not_whole_says_what_it_lacks(self):
        self.generate("set", "--shard", "1/2")
        self.assertIn("4 of 8 files", self.ok("info", "set"))

    def test_a_file_of_a_set_is_described(self):
        self.generate("set")
        said = self.ok("info", "set/rest_00003.h5")
        for part in ["devices 6 to 6", "rest", "output", "true_bias"]:
            self.assertIn(part, said)


    def test_a_device_is_made_again_by_run(self):
        self.generate("set")
        said = self.ok("info", "set", "--device", 3)
        drawn = re.search(r"(?s)campaign.toml\n(.*?)\n\n", said).group(1)
        settings = [word for line in drawn.splitlines()
                    for word in ["--set", line]]
        self.ok("run", "rest.toml", "-o", "run.h5", "--set",
                "noise.enabled=false", *settings)
        with h5py.File(self.dir / "set/rest_00001.h5") as device, \
                h5py.File(self.dir / "run.h5") as run:
            np.testing.assert_allclose(device["true_bias"][1],
                                       run["true_bias"], rtol=2e-7)
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
