# SPDX-License-Identifier: MIT
"""Files of HDF5 whose metadata is changed and whose checksums are mended, read
by the program and by Python.

Nothing of it may end by a signal, take more than 500 MB or 10 s. The deep test
takes BEAMGYRO_MENDED files of each kind in place of 5000.
"""

import concurrent.futures
import ctypes
import os
import random
import shutil
import subprocess

import pytest

from program import PATIENCE, PROGRAM, ROOT, SCENARIO, ProgramTest, class_folder, said
from sets import write_campaign

MOST_KIB = 500 * 1024
MOST_SECONDS = 10  # of processor time
AT_A_TIME = 250  # files that one process of Python reads
SHARD = "ramp_00000.h5"
PATIENT = ["timeout", "-s", "KILL", str(4 * PATIENCE)]

# Reads each file that standard input names, and prints its name before.
READ_RECORDINGS = """\
import sys
import beamgyro
for line in sys.stdin:
    print(line.strip(), flush=True)
    try:
        beamgyro.open_recording(line.strip())
    except ValueError:
        pass
"""

# The same as the file FILE of the set SET, whose manifest says that it is so.
READ_SHARDS = """\
import hashlib, json, pathlib, sys
sys.path.append(sys.argv[1])
import beamgyro
from sets import manifest_line
place, name = pathlib.Path(sys.argv[2]), sys.argv[3]
records = [*map(json.loads, (place / "manifest.jsonl").open())]
for line in sys.stdin:
    print(line.strip(), flush=True)
    data = pathlib.Path(line.strip()).read_bytes()
    (place / name).write_bytes(data)
    text = b""
    for record in records:
        if record.get("file") == name:
            record |= {"bytes": len(data),
                       "sha256": hashlib.sha256(data).hexdigest()}
        elif "sha256_before" in record:
            record["sha256_before"] = hashlib.sha256(text).hexdigest()
        text += manifest_line(record)
    (place / "manifest.jsonl").write_bytes(text)
    found = beamgyro.open_set(place)
    for device in (0, 1):
        for read in (found.recording, found.slow_recording):
            try:
                read("ramp", device)
            except ValueError:
                pass
"""


class Sum(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in ("begin", "end", "place")]


class Seed:
    """A valid file that is changed."""

    def __init__(self, library, whole):
        self.library = library
        end = whole.rfind(b"\nSHA-256 of all bytes before: ")
        self.whole = whole if end < 0 else whole[:end]
        room = (Sum * 4096)()
        library.find_metadata_sums.restype = ctypes.c_size_t
        count = library.find_metadata_sums(
            self.whole, ctypes.c_size_t(len(self.whole)), room,
            ctypes.c_size_t(len(room)))
        self.sums = (Sum * count)(*room[:count])

    def mended(self, data):
        buffer = ctypes.create_string_buffer(bytes(data), len(data))
        self.library.mend_metadata_sums(
            buffer, ctypes.c_size_t(len(data)), self.sums,
            ctypes.c_size_t(len(self.sums)))
        return buffer.raw

    def changed(self, number):
        """The file with one or two other bytes, most of them under a sum."""
        draw = random.Random(number)
        data = bytearray(self.whole)
        for _ in range(draw.choice([1, 1, 2])):
            place = draw.randrange(len(data))
            if draw.random() < 0.8:
                among = draw.choice(self.sums)
                place = draw.randrange(among.begin, among.end)
            data[place] = draw.choice([
                0, 255, draw.randrange(256),
                data[place] ^ 1 << draw.randrange(8)])
        return self.mended(data)


class Mended(ProgramTest):
    environment = os.environ | {"PYTHONPATH": str(PROGRAM.parent / "python")}

    def prepare(self):
        super().prepare()
        self.run_scenario("run", text=SCENARIO.replace("= 600", "= 20"))
        write_campaign(self, devices=2)
        self.ok("generate", "campaign.toml", "-o", "set")
        shutil.copy(self.dir / "set" / SHARD, self.dir / "shard.h5")

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        library = class_folder(cls) / "mended_hdf5.so"
        said("c++", "-std=c++20", "-O2", "-shared", "-fPIC", f"-I{ROOT}",
             ROOT / "tests/fuzz/mended_hdf5.cpp", "-o", library)
        library = ctypes.CDLL(str(library))
        cls.seeds = {kind: Seed(library, (cls.kept / f"{kind}.h5").read_bytes())
                     for kind in ("run", "shard")}

    def write_changed(self, kind, numbers):
        for k in numbers:
            yield self.write(f"{kind}_{k}.h5", self.seeds[kind].changed(k))

    def ends_well(self, name, process):
        """How a process ended, and what it took: no signal, no gigabytes."""
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertIn(process.returncode, (0, 2), name)
        self.assertLess(used.ru_maxrss, MOST_KIB, name)
        return used.ru_utime + used.ru_stime, used.ru_maxrss

    def by_command(self, kind, numbers):
        refused, worst_seconds, worst_memory = 0, 0.0, 0
        for name in self.write_changed(kind, numbers):
            with subprocess.Popen(
                    [*PATIENT, str(PROGRAM), "info", name], cwd=self.dir,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL) as process:
                seconds, memory = self.ends_well(name, process)
            self.assertLess(seconds, MOST_SECONDS, name)
            refused += process.returncode == 2
            worst_seconds = max(worst_seconds, seconds)
            worst_memory = max(worst_memory, memory)
            (self.dir / name).unlink()
        return refused, worst_seconds, worst_memory

    def by_python(self, kind, numbers):
        names = list(self.write_changed(kind, numbers))
        words = [READ_RECORDINGS]
        if kind == "shard":
            place = self.dir / f"set_{numbers[0]}"
            shutil.copytree(self.dir / "set", place)
            words = [READ_SHARDS, ROOT / "tests/program", place, SHARD]
        given = self.dir / f"{kind}_{numbers[0]}.txt"
        given.write_text("\n".join(names))
        said_file = given.with_suffix(".err")
        with (given.open() as lines, said_file.open("w") as errors,
              subprocess.Popen([*PATIENT, "/usr/bin/python3", "-c",
                                *map(str, words)], cwd=self.dir, text=True,
                               stdin=lines, stdout=subprocess.PIPE,
                               stderr=errors,
                               env=self.environment) as process):
            read = process.stdout.read().split()
            seconds, memory = self.ends_well(read[-1:], process)
        self.assertEqual(process.returncode, 0, said_file.read_text()[-2000:])
        self.assertEqual(read, names)
        for name in names:
            (self.dir / name).unlink()
        # A mean: what no file may take alone would take its process as long.
        return 0, seconds / len(names), memory

    def survive(self, count):
        """Lets the program and Python read so many changed files of each kind,
        and prints the worst of each."""
        ways = {"info": self.by_command, "Python": self.by_python}
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for kind in self.seeds:
                self.assertGreater(len(self.seeds[kind].sums), 30)
                for way, read in ways.items():
                    parts = [range(k, min(k + AT_A_TIME, count))
                             for k in range(0, count, AT_A_TIME)]
                    found = list(pool.map(read, [kind] * len(parts), parts))
                    print(f"{count} of {kind} by {way}: "
                          f"{sum(part[0] for part in found)} refused, at most "
                          f"{max(part[1] for part in found):.2f} s and "
                          f"{max(part[2] for part in found) // 1024} MB")
                    if read == self.by_command:
                        refused = sum(part[0] for part in found)
                        self.assertGreater(refused, count / 5)
                        self.assertLess(refused, count * 4 / 5)

    def test_changes_under_mended_sums_are_read_or_refused(self):
        self.survive(60)

    @pytest.mark.deep  # more draws of the same
    def test_thousands_of_changes_are_read_or_refused(self):
        self.survive(int(os.environ.get("BEAMGYRO_MENDED", "5000")))
