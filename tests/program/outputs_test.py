# SPDX-License-Identifier: MIT
"""What the program prints beside its results, and what it leaves of files when
it is interrupted, killed or out of space."""

import signal
import subprocess
import time

from program import PATIENCE, PROGRAM, SCENARIO, ProgramTest


class Outputs(ProgramTest):
    def setUp(self):
        super().setUp()
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
        for command in [["info", "set"], ["info", "set", "--device", 0]]:
            said = self.ok(*command)
            self.assertIn("campaign\\x1b[2J.toml", said)
            self.assertNotIn("\x1b", said)

    def test_a_file_that_is_replaced_hands_on_its_mode(self):
        for name in ["a.h5", "a.csv"]:
            self.write(name, "old")
            (self.dir / name).chmod(0o640)
            self.ok("run", "s.toml", "-o", name)
            self.assertEqual((self.dir / name).stat().st_mode & 0o777, 0o640)

    def test_what_a_killed_run_left_is_removed_by_the_next_of_its_name(self):
        self.write("long.toml", SCENARIO.replace("600", "600000"))
        with subprocess.Popen([str(PROGRAM), "run", "long.toml", "-o", "a.h5"],
                              cwd=self.dir, stdin=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as process:
            while not list(self.dir.glob("a.h5.partial*")):
                self.assertIsNone(process.poll())
                time.sleep(0.01)
            process.send_signal(signal.SIGKILL)
        self.assertTrue(list(self.dir.glob("a.h5.partial*")))
        self.ok("run", "s.toml", "-o", "b.h5")
        self.assertTrue(list(self.dir.glob("a.h5.partial*")))
        self.ok("run", "s.toml", "-o", "a.h5")
        self.assertFalse(list(self.dir.glob("*.partial*")))

    def test_quiet_is_silent_but_for_errors(self):
        answer = self.beamgyro("run", "s.toml", "-o", "a.h5", "--quiet")
        self.assertEqual((answer.returncode, answer.stdout, answer.stderr),
                         (0, "", ""))
        self.rejected("run", "missing.toml", "-o", "b.h5", "--quiet",
                      says="missing.toml")

    def test_a_limit_on_the_size_of_files_fails_like_a_full_disk(self):
        before = self.files()
        answer = subprocess.run(
            ["/bin/bash", "-c", 'ulimit -f 10; exec "$0" run s.toml -o big.h5',
             str(PROGRAM)], cwd=self.dir, capture_output=True, text=True,
            check=False)
        self.assertEqual(answer.returncode, 1, answer.stderr)
        self.assertEqual(len(answer.stderr.strip().splitlines()), 1,
                         answer.stderr)
        self.assertIn("File too large", answer.stderr)
        self.assertEqual(self.files(), before)

    def test_interrupted_run_leaves_no_file_and_keeps_the_old_one(self):
        long = SCENARIO.replace("duration_s = 600", "duration_s = 45000") \
            .replace("output_rate_Hz = 2", "output_rate_Hz = 200")
        self.write("long.toml", long)
        self.write("old.h5", "precious")
        before = self.files()
        for name in [signal.SIGINT, signal.SIGTERM]:
            with self.subTest(name.name):
                process = subprocess.Popen(
                    [PROGRAM, "run", "long.toml", "-o", "old.h5"], cwd=self.dir,
                    stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                time.sleep(0.4)
                process.send_signal(name)
                said = process.communicate(timeout=PATIENCE)[1].decode()
                self.assertEqual(process.returncode, -name)
                self.assertIn("interrupted; old.h5 is as it was before", said)
                self.assertEqual(self.files(), before)
