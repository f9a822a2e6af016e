# SPDX-License-Identifier: MIT
"""Help, version, exit statuses and where the program prints."""

import signal
import subprocess
import time
import unittest

from program import CUBIC, PROGRAM, SCENARIO, ProgramTest, ramp

COMMANDS = ["characterise", "run", "import", "train", "compensate", "validate",
            "allan", "info"]


class CommandLine(ProgramTest):
    def test_help_at_every_level(self):
        overview = self.ok("--help")
        self.assertEqual(overview, self.ok("-h"))
        for command in COMMANDS:
            with self.subTest(command):
                self.assertIn(command, overview)
                text = self.ok(command, "--help")
                self.assertIn(command, text)
                self.assertGreater(len(text.splitlines()), 4)

    def test_help_names_no_command_that_does_not_exist(self):
        overview = self.ok("--help")
        for command in ["generate", "import", "export", "verify"]:
            with self.subTest(command):
                exists = self.beamgyro(command, "--help").returncode == 0
                named = any(line.split()[:1] == [command]
                            for line in overview.splitlines())
                self.assertEqual(named, exists)

    def test_version_names_revision_and_libraries(self):
        text = self.ok("--version").lower()
        for part in ["beamgyro 0.1.0", "sundials", "hdf5", "eigen"]:
            self.assertIn(part, text)

    def test_unknown_command_is_answered_with_the_nearest(self):
        self.rejected("trian", says=["trian", "train"])

    def test_no_command_unknown_option_missing_argument(self):
        self.rejected()
        self.write("s.toml", SCENARIO)
        self.rejected("run", "s.toml", "-o", "a.h5", "--frobnicate",
                      says="--frobnicate")
        self.rejected("run", "s.toml")
        self.rejected("run", "s.toml", "-o", "a.h5", "--seed", "many",
                      says="many")

    def test_a_name_that_is_empty_is_refused(self):
        """As a script gives it whose variable is not set."""
        self.run_scenario("rest")
        for words, says in [
                (("plot", "rest.h5", "-o", ""), '--output "": is empty'),
                (("run", "rest.toml", "-o", ""), '--output "": is empty'),
                (("allan", "rest.h5", "--json", ""), '--json "": is empty'),
                (("plan", "p.json", "--picture", ""),
                 '--picture "": is empty'),
                (("info", ""), "is empty"),
                (("plot", "rest.h5", "", "-o", "p.png"), "is empty")]:
            with self.subTest(words):
                self.rejected(*words, says=says)

    def test_progress_and_messages_never_reach_stdout(self):
        self.write("s.toml", SCENARIO)
        answer = self.beamgyro("run", "s.toml", "-o", "a.h5")
        self.assertEqual((answer.returncode, answer.stdout), (0, ""))
        self.assertNotIn("\x1b", answer.stderr)

    def test_no_control_character_reaches_the_terminal(self):
        evil = "\x1b]0;x\x07\x1b[2J\r\x08\x9b\u202fé"
        for command in [["info", evil], ["run", evil, "-o", "a.h5"],
                        ["verify", evil], [evil]]:
            with self.subTest(command):
                said = self.rejected(*command)
                self.assertIn("\\x1b]0;x\\x07", said)
                self.assertIn("\u202fé", said)
                self.assertFalse(set(said) & set("\x1b\x07\r\x08\x9b"))
        self.write("series.csv", "a,\x1b[31mb\n1,2\n3,4\n")
        said = self.rejected("allan", "series.csv", "--rate-Hz", "1",
                             "--dataset", "c", says="\\x1b[31mb")
        self.assertNotIn("\x1b", said)

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
        self.write("s.toml", SCENARIO)
        for name in ["a.h5", "a.csv"]:
            self.write(name, "old")
            (self.dir / name).chmod(0o640)
            self.ok("run", "s.toml", "-o", name)
            self.assertEqual((self.dir / name).stat().st_mode & 0o777, 0o640)

    def test_what_a_killed_run_left_is_removed_by_the_next_of_its_name(self):
        self.write("s.toml", SCENARIO)
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
        self.write("s.toml", SCENARIO)
        answer = self.beamgyro("run", "s.toml", "-o", "a.h5", "--quiet")
        self.assertEqual((answer.returncode, answer.stdout, answer.stderr),
                         (0, "", ""))
        self.rejected("run", "missing.toml", "-o", "b.h5", "--quiet",
                      says="missing.toml")

    def test_no_command_writes_over_a_file_it_reads(self):
        self.run_scenario("run", text=ramp())
        self.write("m.toml", CUBIC)
        self.ok("train", "run.h5", "--model", "m.toml", "-o", "c.json")
        (self.dir / "link.h5").symlink_to("run.h5")
        for arguments in [
                ("run", "run.toml", "-o", "run.toml"),
                ("characterise", "device.toml", "-o", "device.toml"),
                ("train", "run.h5", "--model", "m.toml", "-o", "run.h5"),
                ("train", "run.h5", "--model", "m.toml", "-o", "m.toml"),
                ("compensate", "c.json", "run.h5", "-o", "link.h5"),
                ("validate", "c.json", "run.h5", "--json", "c.json"),
                ("allan", "run.h5", "--json", "run.h5")]:
            with self.subTest(arguments):
                if arguments[0] == "run":
                    # An ending of its own error comes first.
                    self.rejected(*arguments, says="run.toml")
                else:
                    self.rejected(*arguments, says="is read by this command")

    def test_a_limit_on_the_size_of_files_fails_like_a_full_disk(self):
        self.write("s.toml", SCENARIO)
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

    def test_a_seed_below_zero_is_refused(self):
        self.write("s.toml", SCENARIO)
        self.rejected("run", "s.toml", "-o", "a.h5", "--seed=-1", says="seed")

    def test_validate_says_when_it_scores_training_data(self):
        self.run_scenario("run", text=ramp())
        self.write("m.toml", CUBIC)
        self.ok("train", "run.h5", "--model", "m.toml", "-o", "c.json")
        answer = self.beamgyro("validate", "c.json", "run.h5")
        self.assertIn("used in training", answer.stderr)

    def test_allan_of_a_constant_has_a_curve_and_no_coefficients(self):
        self.write("series.csv", "5\n" * 500)
        text = self.ok("allan", "series.csv", "--rate-Hz", 10, "--json",
                       "a.json")
        self.assertIn("oadev deg/s", text)
        self.assertNotIn("random walk", text)

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
                said = process.communicate(timeout=30)[1].decode()
                self.assertEqual(process.returncode, -name)
                self.assertIn("interrupted; old.h5 is as it was before", said)
                self.assertEqual(self.files(), before)


if __name__ == "__main__":
    unittest.main()
