# SPDX-License-Identifier: MIT
"""What the program prints beside its results, and what it leaves of files when
it is interrupted, killed or out of space."""

import os
import resource
import signal
import subprocess

from program import PATIENCE, PROGRAM, SCENARIO, ProgramTest, limit


class Outputs(ProgramTest):
    def prepare(self):
        super().prepare()
        self.write("s.toml", SCENARIO)

    def test_progress_and_messages_never_reach_stdout(self):
        answer = self.beamgyro("run", "s.toml", "-o", "a.h5")
        self.assertEqual((answer.returncode, answer.stdout), (0, ""))
        self.assertNotIn("\x1b", answer.stderr)

    def test_results_hold_no_control_character_of_a_file(self):
        name = "\x1b[31ms.toml"
        self.write(name, SCENARIO.replace("600", "60"))
        self.write("campaign\x1b[2J.toml", """\
name = "x"
device = "device.toml"
devices = 1
seed = 1
[[run]]
name = "rest"
scenario = "\\u001b[31ms.toml"
""")
        self.ok("generate", "campaign\x1b[2J.toml", "-o", "set")
        for device in [], ["--device", 0]:
            said = self.ok("info", "set", *device)
            self.assertIn("campaign\\x1b[2J.toml", said)
            self.assertNotIn("\x1b", said)

    def test_endings_in_capitals_are_those_in_small_letters(self):
        for name, ending in [("a", "H5"), ("b", "h5"), ("a", "CSV"),
                             ("b", "csv")]:
            self.ok("run", "s.toml", "-o", f"{name}.{ending}")
        for ending in "h5", "csv":
            self.assertEqual(
                (self.dir / f"a.{ending.upper()}").read_bytes(),
                (self.dir / f"b.{ending}").read_bytes())
            self.assertIn("recording",
                          self.ok("info", f"a.{ending.upper()}"))
        self.rejected("run", "s.toml", "-o", "a.MAT",
                      says="expected a name that ends in .h5 or .csv")

    def test_a_file_that_is_replaced_hands_on_its_mode(self):
        for name in ["a.h5", "a.csv"]:
            self.write(name, "old")
            (self.dir / name).chmod(0o640)
            self.ok("run", "s.toml", "-o", name)
            self.assertEqual((self.dir / name).stat().st_mode & 0o777, 0o640)

    def test_what_a_killed_run_left_is_removed_by_the_next_of_its_name(self):
        self.write("long.toml", SCENARIO.replace("600", "600000"))
        self.interrupted("run", "long.toml", "-o", "a.h5", by=signal.SIGKILL,
                         until="a.h5.partial*")
        self.assertTrue(list(self.dir.glob("a.h5.partial*")))
        self.ok("run", "s.toml", "-o", "b.h5")
        self.assertTrue(list(self.dir.glob("a.h5.partial*")))
        self.ok("run", "s.toml", "-o", "a.h5")
        self.assertFalse(list(self.dir.glob("*.partial*")))

    def test_quiet_is_silent_but_for_errors(self):
        answer = self.ended("run", "s.toml", "-o", "a.h5", "--quiet")
        self.assertEqual((answer.stdout, answer.stderr), ("", ""))
        self.rejected("run", "missing.toml", "-o", "b.h5", "--quiet",
                      says="missing.toml")

    def test_a_reader_that_has_enough_is_no_error(self):
        read, write = os.pipe()
        os.close(read)
        with os.fdopen(write, "wb") as closed:
            answer = subprocess.run(
                [PROGRAM, "validate", "--list-metrics"], stdout=closed,
                stderr=subprocess.PIPE, check=False, timeout=PATIENCE)
        self.assertEqual((answer.returncode, answer.stderr), (0, b""))
        with open("/dev/full", "wb") as full:
            answer = subprocess.run(
                [PROGRAM, "validate", "--list-metrics"], stdout=full,
                stderr=subprocess.PIPE, check=False, timeout=PATIENCE)
        self.assertEqual(answer.returncode, 1)
        self.assertIn(b"cannot write to standard output", answer.stderr)

    def test_a_limit_on_the_size_of_files_fails_like_a_full_disk(self):
        self.rejected("run", "s.toml", "-o", "big.h5", says="File too large",
                      status=1, preexec_fn=limit(resource.RLIMIT_FSIZE, 10240))

    def test_interrupted_run_leaves_no_file_and_keeps_the_old_one(self):
        long = SCENARIO.replace("duration_s = 600", "duration_s = 45000") \
            .replace("output_rate_Hz = 2", "output_rate_Hz = 200")
        self.write("long.toml", long)
        self.write("old.h5", "precious")
        before = self.files()
        for number in [signal.SIGINT, signal.SIGTERM]:
            said = self.interrupted("run", "long.toml", "-o", "old.h5",
                                    until="*partial*", by=number)
            self.assertIn("interrupted; old.h5 is as it was before", said)
            self.assertEqual(self.files(), before)
