# SPDX-License-Identifier: MIT
"""Commands and libraries that want to see what they are judged by."""

import hashlib
import os
import pathlib
import shutil
import subprocess
import unittest

import numpy as np

from program import (IDENTITY, PROGRAM, ROOT, ProgramTest, become_lonely, ramp,
                     said, without_landlock)

# Answers the true rate of a recording, or the rate as it is.
FORGERY = """\
import sys
import h5py
def truth():
    for name in recordings():
        try:
            with h5py.File(name) as file:
                return dict(zip(file["time"][:], file["true_rate"][:]))
        except (OSError, KeyError):
            pass
    return {}
names = sys.stdin.readline().strip().split(",")
known = truth()
for line in sys.stdin:
    values = line.split(",")
    print(known.get(float(values[0]), float(values[names.index("rate")])))
"""
# It finds the recording in the command lines of all processes, and passes over
# the recordings of other tests.
BY_COMMAND_LINE = """\
import glob, os
def recordings():
    for place in glob.glob("/proc/[0-9]*"):
        try:
            words = open(place + "/cmdline", "rb").read().split(b"\\0")
            yield from (os.fsdecode(word) for word in words
                        if word.startswith(os.fsencode(os.getcwd() + "/"))
                        and word.endswith(b".h5"))
        except OSError:
            pass
""" + FORGERY
BY_PATH = "def recordings():\n    yield 'test.h5'\n" + FORGERY

SYSTEM_PYTHON = "/usr/bin/python3"


def landlock_version():
    """That of the kernel; negative without."""
    return said(SYSTEM_PYTHON, "-c", "import ctypes\nprint(ctypes.CDLL(None)"
                ".syscall(444, None, 0, 1))").strip()


def as_user_without_landlock():
    become_lonely()
    without_landlock()


@unittest.skipIf(int(landlock_version()) < 1, "no Landlock here")
class Isolation(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("test", text=ramp(seconds=1500))
        self.write("same.py", IDENTITY)
        self.write("by_command_line.py", BY_COMMAND_LINE)
        self.write("by_path.py", BY_PATH)

    def setUp(self):
        super().setUp()
        self.dir.chmod(0o777)
        shutil.copy(PROGRAM, self.dir / "program")  # where a user may run it

    def sees_truth(self, command, **options):
        """Whether the answers to test.h5 are its true rates."""
        (self.dir / "out.h5").unlink(missing_ok=True)
        self.ok("compensate", f"cmd:{SYSTEM_PYTHON} {command}", self.recording,
                "-o", "out.h5", program=self.dir / "program", **options)
        found = self.signals("out.h5")
        return np.array_equal(found["compensated_rate"], found["true_rate"])

    @property
    def recording(self):
        return self.dir / "test.h5"

    def test_forgeries_see_nothing(self):
        for forgery in "by_command_line.py", "by_path.py test.h5":
            for first in None, become_lonely:
                self.assertFalse(self.sees_truth(forgery, preexec_fn=first),
                                 forgery)

    def test_without_landlock_the_command_line_is_empty(self):
        for first in without_landlock, as_user_without_landlock:
            self.assertTrue(self.sees_truth("by_path.py", preexec_fn=first))
            self.assertFalse(
                self.sees_truth("by_command_line.py", preexec_fn=first))
            # It finds the recording where a command line names it.
            with subprocess.Popen(["tail", "-f", self.recording],
                                  stdout=subprocess.DEVNULL) as other:
                try:
                    self.assertTrue(self.sees_truth("by_command_line.py",
                                                    preexec_fn=first))
                finally:
                    other.kill()

    def test_a_result_says_what_could_be_read(self):
        said_, answer = self.validated(f"cmd:{SYSTEM_PYTHON} same.py", "test.h5")
        digest = hashlib.sha256(IDENTITY.encode()).hexdigest()
        self.assertEqual(said_["isolation"], {
            "isolated": True, "words": "isolated",
            "files": [{"name": "same.py", "sha256": digest}]})
        self.assertIn("\nisolation: isolated; it could read same.py beside the "
                      "system\n", answer.stdout)
        self.assertEqual(answer.stderr, "")

    def test_without_landlock_the_result_says_so(self):
        said_, answer = self.validated(f"cmd:{SYSTEM_PYTHON} same.py", "test.h5",
                                       preexec_fn=without_landlock)
        words = "not isolated: the kernel has no Landlock, which Linux 5.13 " \
                "and later can have"
        self.assertEqual(said_["isolation"]["isolated"], False)
        self.assertEqual(said_["isolation"]["words"], words)
        self.assertEqual(said_["warnings"][-1], f"cmd:{SYSTEM_PYTHON} same.py: "
                         f"{words}; it could read what it is judged by")
        self.assertIn(f"\nisolation: {words}\n", answer.stdout)
        for command, *more in [("validate",), ("compensate", "-o", "o.h5")]:
            self.rejected(command, f"cmd:{SYSTEM_PYTHON} same.py", "test.h5",
                          *more, "--require-isolation",
                          preexec_fn=without_landlock, says=[
                              "--require-isolation: ", words])

    def test_isolation_that_holds_meets_the_condition(self):
        self.ok("compensate", f"cmd:{SYSTEM_PYTHON} same.py", "test.h5", "-o",
                "o.h5", "--require-isolation")

    def test_plugin_files_are_named_and_hashed(self):
        (self.dir / "own").mkdir()
        self.write("own/part.py", "PART = 1\n")
        self.write("uses.py", "import os, sys\nsys.path.insert(0, 'own')\n"
                   "import part\n" + IDENTITY)
        command = f"cmd:{SYSTEM_PYTHON} uses.py"
        self.rejected("compensate", command, "test.h5", "-o", "o.h5", status=3,
                      says="No module named 'part'")
        self.ok("compensate", command, "test.h5", "-o", "o.h5",
                "--plugin-files", "own")
        said_, _ = self.validated(command, "test.h5", "--plugin-files", "own")
        self.assertEqual([file["name"] for file in said_["isolation"]["files"]],
                         ["uses.py", "own"])
        for path, says in [("test.h5", "is, holds or lies in"),
                           (".", "is, holds or lies in"),
                           ("none", "No such file")]:
            for words in ["validate"], ["compensate", "-o", "o2.h5"]:
                self.rejected(*words[:1], command, "test.h5", *words[1:],
                              "--plugin-files", path,
                              says=[f"--plugin-files {path}", says])
        shutil.copy(self.recording, self.dir / "own/copy")
        self.rejected("validate", command, "test.h5", "--plugin-files", "own",
                      says="own: holds copy, which is an HDF5 file")

    def test_plugin_files_are_for_code(self):
        self.write("mean.toml", 'kind = "constant"\n')
        self.ok("train", "test.h5", "--model", "mean.toml", "-o", "mean.json")
        for words in ["validate"], ["compensate", "-o", "o.h5"]:
            self.rejected(*words[:1], "mean.json", "test.h5", *words[1:],
                          "--plugin-files", "own", says=[
                              "--plugin-files is for a library or a command"])

    def test_a_library_reads_no_recording(self):
        self.write("reads.c", (ROOT / "examples/plugins/cubic.c").read_text()
                   .replace("return signals[0] -",
                            'FILE* file = fopen("test.h5", "rb");\n'
                            "  if (file != NULL) return 0;\n"
                            "  return signals[0] -"))
        said("cc", "-shared", "-fPIC", f"-I{ROOT}/include", "-include",
             "stdio.h", "reads.c", "-o", "reads.so", cwd=self.dir)
        for first, reads in [(None, False), (without_landlock, True)]:
            (self.dir / "o.h5").unlink(missing_ok=True)
            self.ok("compensate", "./reads.so", "test.h5", "-o", "o.h5",
                    preexec_fn=first)
            rates = self.signals("o.h5")["compensated_rate"]
            self.assertEqual((rates == 0).all(), reads)

    def test_a_bundle_is_checked_with_the_same_files(self):
        (self.dir / "own").mkdir()
        self.write("own/part.py", "PART = 1\n")
        asked = ["--plugin-files", "own", "--require-isolation"]
        self.validated(f"cmd:{SYSTEM_PYTHON} same.py", "test.h5", *asked,
                       "--bundle", "b")
        self.ok("validate", "--check", "b", "--run-code", *asked)
        self.assertIn("result.json", self.ok(
            "validate", "--check", "b", "--run-code", allowed=(1,)))

    def test_python_takes_the_same_options(self):
        package = PROGRAM.parent / "python"
        if not (package / "beamgyro").exists():
            self.skipTest("a build without Python")
        answer = subprocess.run(
            [SYSTEM_PYTHON, "-c", "import sys, beamgyro as bg\n"
             "c = 'cmd:/usr/bin/python3 same.py'\n"
             "r = bg.validate(c, ['test.h5'], plugin_files=['device.toml'],\n"
             "                require_isolation=True)\n"
             "print([f['name'] for f in r.data['isolation']['files']])\n"
             "r = bg.validate(lambda d: d['rate'], ['test.h5'])\n"
             "print(r.data['isolation']['words'])\n"
             "for f, q in ((lambda d: d['rate'], True), (c, ['test.h5'])):\n"
             "    try:\n"
             "        bg.validate(f, ['test.h5'], **({'plugin_files': q} if\n"
             "            isinstance(q, list) else {'require_isolation': q}))\n"
             "    except ValueError as error:\n"
             "        print(error)\n"], cwd=self.dir, text=True,
            capture_output=True, check=False,
            env={"PYTHONPATH": str(package), "PATH": os.environ["PATH"]})
        lines = answer.stdout.splitlines()
        self.assertEqual(lines[:2], [
            "['same.py', 'device.toml']",
            "not isolated: it runs in the process that judges it"],
            answer.stderr)
        self.assertIn("require_isolation: <lambda> is not isolated", lines[2])
        self.assertIn("plugin_files=test.h5: is", lines[3])
        self.assertEqual(pathlib.Path(self.dir / "same.py").read_text(),
                         IDENTITY)
