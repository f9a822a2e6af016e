# SPDX-License-Identifier: MIT
"""What the tests of the shipped program share: the program and small inputs."""

import contextlib
import ctypes
import errno
import importlib.util
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest

import h5py

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

# A compensator that changes nothing, for `cmd:/usr/bin/python3`.
IDENTITY = """\
import sys
rate = sys.stdin.readline().strip().split(",").index("rate")
for line in sys.stdin:
    print(line.split(",")[rate])
"""


def limits(**most):
    """A specification of the largest values of metrics."""
    return 'name = "s"\n[limits]\n' + "".join(
        f'{metric} = {{ max = {value}, source = "a test" }}\n'
        for metric, value in most.items())


def processes(word):
    """Ids of processes whose command line contains the word."""
    found = []
    for entry in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if word.encode() in entry.read_bytes():
                found.append(int(entry.parent.name))
        except OSError:
            pass
    return found


def become_lonely():
    """What a process of root does first that must be the only one of its user:
    it becomes a user of its own number, whom no other process has."""
    if os.geteuid() == 0:
        user = 1_000_000_000 + os.getpid()
        os.setgid(user)
        os.setuid(user)


def class_folder(case, prefix=""):
    """A directory that is there while the tests of a class run."""
    return pathlib.Path(case.enterClassContext(
        tempfile.TemporaryDirectory(prefix=prefix)))


def ended(*command, allowed=(0,), timeout=4 * PATIENCE, **options):
    """How a command ended that must end so; a failure shows all it printed."""
    answer = subprocess.run([str(part) for part in command], text=True,
                            capture_output=True, check=False, timeout=timeout,
                            **options)
    if answer.returncode not in allowed:
        raise AssertionError(f"{command}: status {answer.returncode}\n"
                             f"{answer.stdout}{answer.stderr}")
    return answer


def said(*command, **options):
    """What a command prints that must succeed."""
    return ended(*command, **options).stdout


def by_octave(code, folder):
    """The lines that Octave prints, with its package netcdf."""
    if not shutil.which("octave-cli"):
        raise unittest.SkipTest("octave is not installed")
    answer = ended("octave-cli", "--no-gui", "--eval", "pkg load netcdf\n" + code,
                   cwd=folder, allowed=(0, 1))
    if "netcdf is not installed" in answer.stderr:
        raise unittest.SkipTest("no octave-netcdf here")
    if answer.returncode:
        raise AssertionError(answer.stderr)
    return answer.stdout.splitlines()


def limit(kind, size):
    """What a process does first that must not exceed a limit of `resource`."""
    return lambda: resource.setrlimit(kind, (size, size))


class _Filter(ctypes.Structure):
    _fields_ = [("count", ctypes.c_ushort), ("code", ctypes.c_char_p)]


_LIBC = ctypes.CDLL(None)
# A filter of seccomp: calls 444 to 446, those of Landlock, fail with ENOSYS.
_NO_LANDLOCK = b"".join(struct.pack("HBBI", *line) for line in [
    (0x20, 0, 0, 0), (0x35, 0, 2, 444), (0x25, 1, 0, 446),
    (0x06, 0, 0, 0x50000 | errno.ENOSYS), (0x06, 0, 0, 0x7fff0000)])
_FILTER = _Filter(len(_NO_LANDLOCK) // 8, _NO_LANDLOCK)


def without_landlock():
    """What a process does first that finds a kernel without Landlock, so that
    the commands of the program are not isolated."""
    no_new_rights, filter_calls, by_filter = 38, 22, 2
    _LIBC.prctl(no_new_rights, 1, 0, 0, 0)
    _LIBC.prctl(filter_calls, by_filter, ctypes.byref(_FILTER))


def script(path):
    """The module of a script of the project."""
    specification = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def by_name(rows):
    """Rows of a result by their names."""
    return {row["name"]: row for row in rows}


def failed(result):
    """The checks that a validation did not pass."""
    return [check["name"] for check in result["checks"]
            if check["passed"] is False]


def commands():
    """Names of all commands."""
    return re.findall(r"^  ([a-z]+)  ", said(PROGRAM, "--help"), re.MULTILINE)


class ProgramTest(unittest.TestCase):
    """A test in a copy of the folder that prepare() fills once for its class."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.kept = class_folder(cls)
        case = cls()
        case.dir = cls.kept
        case.prepare()

    def setUp(self):
        self.dir = pathlib.Path(
            self.enterContext(tempfile.TemporaryDirectory()))
        shutil.copytree(self.kept, self.dir, symlinks=True, dirs_exist_ok=True)

    def prepare(self):
        """Fills the directory."""
        shutil.copy(SCENARIOS / "devices/nominal.toml", self.dir / "device.toml")

    def write(self, name, text):
        data = text if isinstance(text, bytes) else text.encode()
        (self.dir / name).write_bytes(data)
        return name

    def text(self, name):
        return (self.dir / name).read_text()

    def json(self, name):
        return json.loads(self.text(name))

    def signals(self, name):
        """The values of a recording, of a file of a set or of a view, by the
        names of their variables."""
        with h5py.File(self.dir / name) as file:
            return {key: file[key][()] for key in file if key != "meta"}

    def change(self, name, pattern, new, to=None):
        """Writes a file, or another one, with other lines; it has such lines."""
        text, count = re.subn(f"(?m){pattern}", new, self.text(name))
        self.assertGreater(count, 0, f"{name}: {pattern}")
        self.write(to or name, text)

    def flip(self, name):
        """Turns one bit in the middle of a file."""
        data = bytearray((self.dir / name).read_bytes())
        data[len(data) // 2] ^= 1
        self.write(name, bytes(data))

    def assertSameBytes(self, *names):
        first, *others = [(self.dir / name).read_bytes() for name in names]
        for name, other in zip(names[1:], others):
            self.assertEqual(other, first, f"{names[0]} and {name}")

    def beamgyro(self, *arguments, program=PROGRAM, given=None, **options):
        return subprocess.run(
            [str(program), *map(str, arguments)], text=True, input=given,
            stdin=subprocess.DEVNULL if given is None else None,
            capture_output=True, check=False,
            **{"cwd": self.dir, "timeout": PATIENCE} | options)

    def ended(self, *arguments, allowed=(0,), **options):
        """How a command ended, which must be so."""
        answer = self.beamgyro(*arguments, **options)
        self.assertIn(answer.returncode, allowed,
                      f"{arguments}: {answer.stderr}{answer.stdout}")
        return answer

    def ok(self, *arguments, **options):
        """Output of a command that must succeed."""
        return self.ended(*arguments, **options).stdout

    def warned(self, *arguments, **options):
        """What a command that succeeds says beside its output."""
        return self.ended(*arguments, **options).stderr

    def validated(self, *arguments, allowed=(0, 3), **options):
        """The result in the file of a validation, and how it ended."""
        answer = self.ended("validate", *arguments, "--json", "v.json",
                            allowed=allowed, **options)
        return self.json("v.json"), answer

    def alone(self, *arguments):
        """Output of a command that must succeed as the only process of its
        user, who may have no other and no second thread."""
        self.dir.chmod(0o777)
        program = self.dir / "program"  # where another user may run it
        shutil.copy(PROGRAM, program)

        def restrict():
            resource.setrlimit(resource.RLIMIT_NPROC, (1, 1))
            become_lonely()  # no limit holds root

        return self.ok(*arguments, program=program, preexec_fn=restrict)

    @contextlib.contextmanager
    def working(self, *arguments, until, **options):
        """The process of a command, from when there is a file of a pattern."""
        with subprocess.Popen(
                [str(PROGRAM), *map(str, arguments)], cwd=self.dir, text=True,
                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                stderr=subprocess.PIPE, **options) as process:
            while not list(self.dir.glob(until)):
                self.assertIsNone(process.poll())
                time.sleep(0.01)
            yield process

    def interrupted(self, *arguments, until, by=signal.SIGTERM, **options):
        """What a command says that a signal ends while it works."""
        with self.working(*arguments, until=until, **options) as process:
            process.send_signal(by)
            output, words = process.communicate(timeout=PATIENCE)
        self.assertEqual((process.returncode, output), (-by, ""), words)
        return words

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

    def rejected(self, *arguments, says=(), status=2, **options):
        """The one message of a command refused with an exit status, after which
        every file is as it was and no other file or directory has come."""
        before = self.files(), {*self.dir.rglob("*")}
        answer = self.ended(*arguments, allowed=(status,), **options)
        self.assertEqual(answer.stdout, "")
        self.assertEqual(len(answer.stderr.strip().splitlines()), 1,
                         answer.stderr)
        self.assertSays(answer.stderr, says)
        self.assertEqual((self.files(), {*self.dir.rglob("*")}), before)
        return answer.stderr

    def fails_as_seen(self, compensator, run):
        """All that a validation holds against a compensator is that training
        saw the run."""
        answer = self.ended("validate", compensator, run, allowed=(3,))
        self.assertIn("\nFAIL: Not met: hold_out. Training saw 1 of the 1 runs",
                      answer.stdout)

    def run_scenario(self, name, *arguments, text=SCENARIO):
        """Recording NAME.h5 of a scenario text."""
        scenario = self.write(f"{name}.toml", text)
        self.ok("run", scenario, "-o", f"{name}.h5", *arguments)
        return self.dir / f"{name}.h5"

    def train_on(self, *runs, model=CUBIC, to="c.json"):
        """What the file TO says of a compensator of the text of a model."""
        self.ok("train", *runs, "--model", self.write("model.toml", model),
                "-o", to)
        return self.json(to)

    def cubic_of_a_ramp(self, name):
        """Recording NAME.h5 of a ramp, and a cubic trained on it in c.json."""
        self.run_scenario(name, text=ramp())
        self.train_on(f"{name}.h5")


def ramp(seconds=4000, low=-30, high=40, rate_Hz=1, seed=3):
    """Scenario text of a temperature ramp long enough to fit a curve to."""
    return SCENARIO.replace("duration_s = 600", f"duration_s = {seconds}") \
        .replace("output_rate_Hz = 2", f"output_rate_Hz = {rate_Hz}") \
        .replace("seed = 7", f"seed = {seed}") \
        .replace("constant_degC = 25",
                 f"points = [[0, {low}], [{seconds}, {high}]]")
