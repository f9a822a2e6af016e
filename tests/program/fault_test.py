# SPDX-License-Identifier: MIT
"""A fault at the file-system calls of the commands that write.

tests/faults/fault_shim.c lets one call of a process fail. Each command runs
once in peace, then once for every chosen call and every fault that can strike
it. Each folder that a fault left is given to the command once more in peace;
folders of equal files are one, because no clock and no chance decides what the
command makes of them. A call is chosen when it is the first or the last of its
name on a kind of file; with BEAMGYRO_ALL_FAULTS=1 all are.
"""

import concurrent.futures
import os
import pathlib
import re
import shutil
import tempfile
import threading

import pytest

from faults import FaultTest
from sets import CAMPAIGN, SCENARIO

CHANGES = {"write", "fsync", "rename", "link", "mkdir", "ftruncate"}
FAULTS = {  # and the calls that they can strike, None for all
    "EIO": None,
    "ENOSPC": CHANGES | {"open"},
    "EINTR": {"open", "read", "write", "close", "fsync", "flock", "ftruncate"},
    "short": {"read", "write"},
    "torn": {"write"},
    "kill": None,
}
PARTIAL = re.compile(r"\.partial-.*")

def files_in(folder):
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in folder.rglob("*") if path.is_file()}


def state_of(folder):
    """All that a command finds in a folder, for comparison, without the numbers
    of processes: in names of files in progress and in locks of the dead."""
    def content(path):
        if not path.is_file():
            return b""
        found = path.read_bytes()
        return re.sub(rb"\d+", b"0", found) if path.suffix == ".lock" else found

    return tuple(sorted(
        (PARTIAL.sub(".partial", str(path.relative_to(folder))),
         path.stat().st_mode, content(path)) for path in folder.rglob("*")))


class Command:
    """A command in a folder, and what its files are after it ran in peace and
    ended with a status. It refuses to replace a file `once`, if there is one."""

    def __init__(self, test, arguments, again, status, once):
        self.test, self.folder, self.status = test, test.dir, status
        self.arguments, self.again, self.once = arguments, again, once
        self.lock, self.seen = threading.Lock(), set()
        self.before = files_in(self.folder)
        with tempfile.TemporaryDirectory() as name:
            place = pathlib.Path(name) / "peace"
            shutil.copytree(self.folder, place)
            self.calls = test.calls(place, arguments, status)
            self.after = files_in(place)

    def is_new(self, state):
        """Whether no fault before has left this state."""
        with self.lock:
            new = state not in self.seen
            self.seen.add(state)
        return new

    def chosen(self):
        """Number, name and kind of file of the calls to strike."""
        kinds = {}
        for number, name, path in self.calls:
            kind = re.sub(r"[^/]+?(?=\.)", "*", PARTIAL.sub(".partial", path),
                          1)
            kinds.setdefault((name, kind), []).append(number)
        for (name, kind), numbers in kinds.items():
            if "BEAMGYRO_ALL_FAULTS" not in os.environ:
                numbers = {numbers[0], numbers[-1]}
            for number in numbers:
                yield number, name, kind

    def complaints(self, fault, number, name):
        """What a fault did that it must not do."""
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder) / "struck"
            shutil.copytree(self.folder, place)
            answer = self.test.faulty(place, self.arguments,
                                      FAULT_KIND=fault,
                                      FAULT_CALL=str(number))
            files = files_in(place)
            may_leave = r"\.lock$"  # the kernel has let go of it
            if name == "unlink" or fault in ("kill", "torn"):
                may_leave += r"|\.partial-"
            files = {file: content for file, content in files.items()
                     if not re.search(may_leave, file)}
            yield from self.wrong_status(fault, answer, files)
            yield from self.wrong_files(files)
            if self.once in files or not self.is_new(state_of(place)):
                return
            answer = self.test.beamgyro(*self.again, cwd=place, timeout=600)
            if answer.returncode != self.status:
                yield f"once more: status {answer.returncode}: {answer.stderr}"
            elif files_in(place) != self.after:
                yield "once more: " + self.differences(files_in(place))

    def wrong_status(self, fault, answer, files):
        status = answer.returncode
        if fault in ("kill", "torn"):
            expected = [-9]
        elif fault in ("EINTR", "short"):
            expected = [self.status]
        else:
            expected = [self.status, 1]
        if status not in expected:
            yield f"status {status}: {answer.stderr.strip()}"
        elif status == self.status and files != self.after:
            yield f"status {status}: " + self.differences(files)
        elif status == 1 and len(answer.stderr.strip().splitlines()) != 1:
            yield f"not one message: {answer.stderr!r}"

    def wrong_files(self, files):
        """Whole or as before under every name. The manifest of a set grows."""
        for file, content in self.before.items():
            if file not in files:
                yield f"{file} is gone"
            elif files[file] not in (content, self.after[file]):
                yield f"{file} is damaged"
        for file, content in files.items():
            if (file not in self.before and content != self.after.get(file)
                    and not file.endswith("manifest.jsonl")):
                yield f"{file} should not be there with {len(content)} bytes"

    def differences(self, files):
        names = sorted(set(files) | set(self.after))
        return "other files than in peace: " + ", ".join(
            name for name in names if files.get(name) != self.after.get(name))


class Struck(FaultTest):
    def prepare(self):
        super().prepare()
        self.write("ramp.toml", SCENARIO.format(
            name="ramp", ambient="points = [[0, 0], [60, 60]]"))

    def strike(self, *arguments, again=None, status=0, once=None,
               fewest_calls):
        command = Command(self, arguments, again or arguments, status, once)
        self.assertGreaterEqual(len(command.calls), fewest_calls)
        plan = [(fault, call) for call in command.chosen()
                for fault, struck in FAULTS.items()
                if struck is None or call[1] in struck]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            complaints = pool.map(
                lambda task: [f"{task[0]} at {task[1]}: {complaint}"
                              for complaint in command.complaints(
                                  task[0], task[1][0], task[1][1])], plan)
            found = [line for lines in complaints for line in lines]
        if found:
            self.fail(f"{len(plan)} faults, {len(found)} complaints\n"
                      + "\n".join(found))

    def recorded(self, *arguments):
        self.ok("run", "ramp.toml", "-o", "run.h5")
        self.write("mean.toml", 'kind = "constant"\n')
        if arguments:
            self.ok("train", "run.h5", "--model", "mean.toml", *arguments)


class OneFile(Struck):
    def test_run(self):
        self.strike("run", "ramp.toml", "-o", "run.h5", fewest_calls=20)

    def test_run_over_an_old_file(self):
        self.write("run.csv", "time\n")
        self.strike("run", "ramp.toml", "-o", "run.csv", fewest_calls=20)

    def test_train(self):
        self.recorded()
        self.strike("train", "run.h5", "--model", "mean.toml", "-o", "mean.json",
                    fewest_calls=20)

    def test_compensate_over_an_old_file(self):
        self.recorded("-o", "mean.json")
        self.write("out.h5", "old")
        self.strike("compensate", "mean.json", "run.h5", "-o", "out.h5",
                    fewest_calls=20)


@pytest.mark.early
class Validation(Struck):
    def test_validate(self):
        self.recorded("-o", "mean.json")
        self.ok("run", "ramp.toml", "--seed", 99, "-o", "other.h5")
        # A minute tells too little for a verdict: 3.
        self.strike("validate", "mean.json", "other.h5", "--json", "v.json",
                    "--report", "page", "--bundle", "deep/bundle", "--jobs", 1,
                    status=3, once="deep/bundle/bundle.json",
                    fewest_calls=100)


@pytest.mark.early
class Sets(Struck):
    def prepare(self):
        super().prepare()
        one_run, _, _ = CAMPAIGN.partition("[[run]]\nname = \"ramp\"")
        self.write("campaign.toml", one_run.replace("rest", "ramp").replace(
            "devices = 7", "devices = 3"))  # two in the first file

    def test_generate(self):
        generate = ["generate", "campaign.toml", "-o", "set", "--jobs", 1]
        self.strike(*generate, again=[*generate, "--resume"], fewest_calls=100)

    def test_verify(self):
        self.ok("generate", "campaign.toml", "-o", "set")
        self.strike("verify", "set", fewest_calls=30)
