# SPDX-License-Identifier: MIT
"""A fault at the calls on the pipes to a compensator of the user's.

One call fails, as in fault_test.py: the command gives the right bytes, or one
error and no file. The first and the last call of each name are struck; with
BEAMGYRO_ALL_FAULTS=1 all are.
"""

import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import pytest

from faults import FaultTest
from program import PROGRAM, ROOT
from stream_faults_test import LIBRARY

COMMAND = """\
import sys
for line in sys.stdin:
    if line[0].isdigit():
        print(line.split(",")[1], flush=True)
"""
FAULTS = {"EIO": {"pipe", "spawn", "read", "write", "poll", "close"},
          "EINTR": {"read", "write", "poll"}, "short": {"read", "write"}}


@pytest.mark.early
class PipeFaults(FaultTest):
    def prepare(self):
        super().prepare()
        self.write("library.c", LIBRARY)
        subprocess.run(["cc", "-shared", "-fPIC", f"-I{ROOT}/include",
                        "library.c", "-o", "library.so"], cwd=self.dir,
                       check=True)
        self.write("command.py", COMMAND)
        self.run_scenario("run")

    def answer(self, place, arguments, given, **plan):
        with open(given or os.devnull, "rb") as source:
            return subprocess.run(
                [str(PROGRAM), *arguments], cwd=place, stdin=source,
                capture_output=True, timeout=600, check=False,
                env=self.shimmed(FAULT_PIPES="1", **plan))

    def struck(self, arguments, given, output, **plan):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder) / "struck"
            shutil.copytree(self.dir, place)
            answer = self.answer(place, arguments, given, **plan)
            file = place / output if output else None
            return answer, (answer.stdout if file is None else
                            file.read_bytes() if file.exists() else None)

    def calls(self, arguments, given, output):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "calls"
            answer, made = self.struck(arguments, given, output,
                                       FAULT_LOG=str(log))
            self.assertEqual(answer.returncode, 0, answer.stderr)
            found = {}
            for line in log.read_text().splitlines():
                number, name, _ = line.split(" ", 2)
                found.setdefault(name, []).append(int(number))
        if "BEAMGYRO_ALL_FAULTS" not in os.environ:
            found = {name: {numbers[0], numbers[-1]}
                     for name, numbers in found.items()}
        return [(name, number) for name, numbers in found.items()
                for number in numbers], made

    def strike(self, *arguments, given=None, output=None, partly=False):
        calls, right = self.calls(arguments, given, output)
        self.assertEqual({"pipe", "spawn", "read", "write", "poll", "close"},
                         {name for name, _ in calls})
        plan = [(fault, *call) for call in calls
                for fault, names in FAULTS.items() if call[0] in names]

        def complaint(task):
            fault, name, number = task
            answer, made = self.struck(
                arguments, given, output, FAULT_KIND=fault,
                FAULT_CALL=str(number))
            if answer.returncode == 0:
                return None if made == right else "other bytes"
            if answer.returncode != 1:
                return f"status {answer.returncode}: {answer.stderr}"
            if len(answer.stderr.strip().splitlines()) != 1:
                return f"not one message: {answer.stderr}"
            if made and not (partly and right.startswith(made)):
                return "an answer beside an error"
            return None
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            found = [f"{task}: {text}" for task, text in
                     zip(plan, pool.map(complaint, plan)) if text]
        self.assertFalse(found, f"{len(plan)} faults")

    def test_compensate_with_a_library(self):
        self.strike("compensate", "library.so", "run.h5", "-o", "out.h5",
                    output="out.h5")

    def test_compensate_with_a_command(self):
        self.strike("compensate", f"cmd:{sys.executable} command.py", "run.h5",
                    "-o", "out.h5", output="out.h5")

    def test_a_stream_through_a_library(self):
        self.write("samples.csv", "time,rate,temperature\n" + "".join(
            f"{k},{k % 7},25\n" for k in range(300)))
        self.strike("compensate", "library.so", "--stream",
                    given=self.dir / "samples.csv", partly=True)
