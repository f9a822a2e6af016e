# SPDX-License-Identifier: MIT
"""What the tests of the shipped program share: the program and small inputs."""

import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = ROOT / "scenarios"
# A script that runs the tests in its background ignores SIGINT, which every
# program that is started would inherit.
signal.signal(signal.SIGINT, signal.default_int_handler)

PROGRAM = pathlib.Path(
    os.environ.get("BEAMGYRO", ROOT / "build/release/beamgyro")).resolve()

# What is no scenario among the files there.
SHIPPED_SCENARIOS = sorted(
    path for pattern in ("*.toml", "qualification/*.toml")
    for path in SCENARIOS.glob(pattern) if path.name != "qualification.toml")

LONELY_USER = 54321  # of no one else
PATIENCE = 300  # [s], after which something hangs; no promise of speed

SCENARIO = """\
name = "short"
description = "ten minutes at rest"
device = "device.toml"
fidelity = "quasistatic"
duration_s = 600
output_rate_Hz = 2
seed = 7

[ambient]
constant_degC = 25
"""

CUBIC = """\
kind = "polynomial"
inputs = ["temperature"]

[polynomial]
degree = 3
"""

NETWORK = """\
kind = "bp"
inputs = ["temperature"]

[bp]
hidden = [2]
trainer = "levenberg_marquardt"
restarts = 1
max_epochs = 30
"""


def class_folder(case, prefix=""):
    """A directory that is there while the tests of a class run."""
    return pathlib.Path(case.enterClassContext(
        tempfile.TemporaryDirectory(prefix=prefix)))


def said(*command, **options):
    """What a command prints that must succeed; a failure shows all of it."""
    answer = subprocess.run([str(part) for part in command], text=True,
                            capture_output=True, check=False, **options)
    if answer.returncode != 0:
        raise AssertionError(answer.stdout + answer.stderr)
    return answer.stdout


def processor_time_of_children():
    """Seconds that all ended children took, in the program and in the kernel;
    other processes of the machine do not lengthen them."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def commands():
    """Names of all commands."""
    return re.findall(r"^  ([a-z]+)  ", said(PROGRAM, "--help"), re.MULTILINE)


class ProgramTest(unittest.TestCase):
    """A test in a directory of its own that holds the nominal device."""

    def setUp(self):
        self.dir = pathlib.Path(
            self.enterContext(tempfile.TemporaryDirectory()))
        self.prepare()

    def prepare(self):
        """Fills the directory."""
        shutil.copy(SCENARIOS / "devices/nominal.toml", self.dir / "device.toml")

    def write(self, name, text):
        data = text if isinstance(text, bytes) else text.encode()
        (self.dir / name).write_bytes(data)
        return name

    def beamgyro(self, *arguments, **options):
        return subprocess.run(
            [str(PROGRAM), *map(str, arguments)], cwd=self.dir, text=True,
            stdin=subprocess.DEVNULL, capture_output=True, check=False,
            timeout=PATIENCE, **options)

    def ok(self, *arguments):
        """Output of a command that must succeed."""
        answer = self.beamgyro(*arguments)
        self.assertEqual(answer.returncode, 0,
                         f"{arguments}: {answer.stderr}{answer.stdout}")
        return answer.stdout

    def alone(self, *arguments):
        """Output of a command that must succeed as the only process of its
        user, who may have no other and no second thread."""
        self.dir.chmod(0o777)
        program = self.dir / "program"  # where another user may run it
        shutil.copy(PROGRAM, program)

        def restrict():
            resource.setrlimit(resource.RLIMIT_NPROC, (1, 1))
            if os.geteuid() == 0:  # which no limit holds
                os.setgid(LONELY_USER)
                os.setuid(LONELY_USER)

        answer = subprocess.run(
            [str(program), *map(str, arguments)], cwd=self.dir, text=True,
            stdin=subprocess.DEVNULL, capture_output=True, check=False,
            timeout=PATIENCE, preexec_fn=restrict)
        self.assertEqual(answer.returncode, 0,
                         f"{arguments}: {answer.stderr}{answer.stdout}")
        return answer.stdout

    def files(self):
        return {path.relative_to(self.dir): path.read_bytes()
                for path in self.dir.rglob("*") if path.is_file()}

    def assertSays(self, text, parts):
        """The text holds each part, of which some may be patterns."""
        for part in [parts] if isinstance(parts, (str, re.Pattern)) else parts:
            if isinstance(part, str):
                self.assertIn(part, text)
            else:
                self.assertRegex(text, part)

    def rejected(self, *arguments, says=(), status=2):
        """The one message of a command refused with an exit status, after which
        every file is as it was and no other file or directory has come."""
        before = self.files(), {*self.dir.rglob("*")}
        answer = self.beamgyro(*arguments)
        self.assertEqual(answer.returncode, status,
                         f"{arguments}: {answer.stderr}{answer.stdout}")
        self.assertEqual(answer.stdout, "")
        self.assertEqual(len(answer.stderr.strip().splitlines()), 1,
                         answer.stderr)
        self.assertSays(answer.stderr, says)
        self.assertEqual((self.files(), {*self.dir.rglob("*")}), before)
        return answer.stderr

    def fails_as_seen(self, compensator, run):
        """All that a validation holds against a compensator is that training
        saw the run."""
        answer = self.beamgyro("validate", compensator, run)
        self.assertEqual(answer.returncode, 3, answer.stderr)
        self.assertIn("\nFAIL: Not met: hold_out. Training saw 1 of the 1 runs",
                      answer.stdout)

    def run_scenario(self, name, *arguments, text=SCENARIO):
        """Recording NAME.h5 of a scenario text."""
        scenario = self.write(f"{name}.toml", text)
        self.ok("run", scenario, "-o", f"{name}.h5", *arguments)
        return self.dir / f"{name}.h5"

    def cubic_of_a_ramp(self, name):
        """Recording NAME.h5 of a ramp, and a cubic trained on it in c.json."""
        self.run_scenario(name, text=ramp())
        self.ok("train", f"{name}.h5", "--model",
                self.write("model.toml", CUBIC), "-o", "c.json")


def ramp(seconds=4000, low=-30, high=40, rate_Hz=1, seed=3):
    """Scenario text of a temperature ramp long enough to fit a curve to."""
    return SCENARIO.replace("duration_s = 600", f"duration_s = {seconds}") \
        .replace("output_rate_Hz = 2", f"output_rate_Hz = {rate_Hz}") \
        .replace("seed = 7", f"seed = {seed}") \
        .replace("constant_degC = 25",
                 f"points = [[0, {low}], [{seconds}, {high}]]")
