#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What a set of virtual devices survives: kills, damage, full disks, rivals.

set_faults.py [--program FILE] [--kills N] [--damages N] [--sizes N]
              [--starts N] [--seed N]

Makes a reference set of scenarios/campaigns/small.toml without interruption in
a temporary directory, then does the worst to others and compares their files
with it, byte by byte. Prints one line of figures per kind of fault; exits 1
when a set did not come out the same.
"""

import argparse
import collections
import json
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
CAMPAIGN = ROOT / "scenarios/campaigns/small.toml"


class Fault(RuntimeError):
    """A set that is not what it has to be."""


def require(condition, message):
    if not condition:
        raise Fault(message)


def contents(folder):
    """Bytes of every published file by name."""
    return {path.name: path.read_bytes() for path in folder.iterdir()
            if path.suffix in {".h5", ".nc", ".jsonl"}}


def made(folder):
    """Names of the files that the manifest and its parts hold."""
    names = set()
    for manifest in folder.glob("manifest*.jsonl"):
        for line in manifest.read_bytes().split(b"\n")[:-1]:
            entry = json.loads(line)
            if "index" in entry:
                names.add(entry["file"])
    return names


class Faults:
    """A campaign, its set made without interruption, and a place to work."""

    def __init__(self, program, folder, seed=1, campaign=CAMPAIGN, devices=None):
        self.program, self.folder = pathlib.Path(program), pathlib.Path(folder)
        self.campaign, self.random = campaign, random.Random(seed)
        self.devices = ["--devices", str(devices)] if devices else []
        self.reference = self.folder / "reference"
        self.ran("generate", self.campaign, "-o", self.reference, "--jobs", "2",
                 *self.devices)
        self.expected = contents(self.reference)
        self.shards = sorted(name for name in self.expected
                             if name.endswith(".h5"))

    def command(self, *arguments):
        return [str(self.program), *map(str, arguments)]

    def start(self, *arguments):
        return subprocess.Popen(
            self.command(*arguments), stdin=subprocess.DEVNULL, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def run(self, *arguments):
        return subprocess.run(self.command(*arguments), text=True, check=False,
                              stdin=subprocess.DEVNULL, capture_output=True)

    def ran(self, *arguments):
        answer = self.run(*arguments)
        require(answer.returncode == 0,
                f"{arguments}: {answer.returncode}, {answer.stderr}")
        return answer.stdout

    def generate(self, folder, jobs=2):
        return ["generate", self.campaign, "-o", folder, "--resume", "--jobs",
                jobs, *self.devices]

    def require_valid(self, folder):
        """Every file that is published has the bytes of the reference."""
        for path in folder.glob("*.h5"):
            require(path.read_bytes() == self.expected[path.name],
                    f"{path.name}: published, and not as it must be")

    def require_same(self, folder):
        require(contents(folder) == self.expected,
                f"{folder}: differs from the reference")

    def fresh(self, name):
        folder = self.folder / name
        shutil.rmtree(folder, ignore_errors=True)
        return folder

    def kills(self, count, jobs=2, with_signal=signal.SIGKILL):
        """Kills the program at random times, going on each time; anew when the
        set is whole. Figures: kills, sets finished, files that were published
        but not in the manifest after a kill (made again), the most of them."""
        start = time.monotonic()
        self.ran(*self.generate(self.fresh("whole"), jobs))
        whole = time.monotonic() - start
        figures = collections.Counter()
        folder = self.fresh("killed")
        while figures["kills"] < count:
            process = self.start(*self.generate(folder, jobs))
            time.sleep(self.random.uniform(0, whole / 2))
            process.send_signal(with_signal)
            process.communicate()
            if process.returncode == 0:
                figures["sets"] += 1
                self.require_same(folder)
                folder = self.fresh("killed")
                continue
            figures["kills"] += 1
            if not folder.exists():
                continue
            self.require_valid(folder)
            again = {path.name for path in folder.glob("*.h5")} - made(folder)
            figures["made_again"] += len(again)
            figures["most_at_once"] = max(figures["most_at_once"], len(again))
            require(len(again) <= jobs, f"{len(again)} files made again")
        self.ran(*self.generate(folder, jobs))
        self.require_same(folder)
        figures["sets"] += 1
        return dict(figures)

    def flip(self, data):
        place = self.random.randrange(8 * len(data))
        data[place // 8] ^= 1 << place % 8
        return bytes(data)

    def truncate(self, data):
        return bytes(data[:self.random.randrange(len(data))])

    def zero_page(self, data):
        page = 4096 * self.random.randrange((len(data) + 4095) // 4096)
        size = len(data[page:page + 4096])
        return bytes(data[:page] + bytes(size) + data[page + size:])

    def damage(self, folder):
        """Damages one file, or swaps two; their names and what was done."""
        kind = self.random.choices(
            [self.flip, self.truncate, self.zero_page, None],
            [10, 2, 2, 2])[0]
        if kind is None:
            one, other = self.random.sample(self.shards, 2)
            (folder / one).write_bytes(self.expected[other])
            (folder / other).write_bytes(self.expected[one])
            return [one, other], "swap"
        name = self.random.choice(sorted(self.expected))
        data = self.expected[name]
        damaged = kind(bytearray(data))
        if damaged == data:  # the page was zero
            return self.damage(folder)
        (folder / name).write_bytes(damaged)
        return [name], kind.__name__

    def damages(self, count):
        """Damages a set again and again; verify has to name the file, with
        --repair to bring the same bytes back. Figures: damages by kind."""
        figures = collections.Counter()
        folder = self.fresh("damaged")
        shutil.copytree(self.reference, folder)
        for _ in range(count):
            names, kind = self.damage(folder)
            figures[kind] += 1
            found = self.run("verify", folder)
            require(found.returncode == 1,
                    f"{kind} of {names}: exit {found.returncode}")
            for name in names:
                require(name in found.stdout + found.stderr,
                        f"{kind} of {names}: not named")
            self.ran("verify", folder, "--repair")
            self.require_same(folder)
        self.ran("verify", folder)
        return dict(figures)

    def full_disk(self, mount, kilobytes):
        """Generates onto a disk that is too small, then goes on with space."""
        options = f"size={kilobytes}k"
        subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs",
                        str(mount)], check=True)
        try:
            folder = mount / "set"
            answer = self.run(*self.generate(folder))
            require(answer.returncode == 1,
                    f"{kilobytes} kB: exit {answer.returncode}")
            require(str(mount) in answer.stderr and "byte" in answer.stderr,
                    f"{kilobytes} kB: {answer.stderr}")
            if folder.exists():
                self.require_valid(folder)
            subprocess.run(["mount", "-o", "remount,size=1g", str(mount)],
                           check=True)
            self.ran(*self.generate(folder))
            self.require_same(folder)
        finally:
            subprocess.run(["umount", str(mount)], check=True)

    def full_disks(self, count):
        """A disk of every size from nearly nothing to nearly enough."""
        mount = self.fresh("disk")
        mount.mkdir()
        needed = sum(map(len, self.expected.values())) // 1024
        for k in range(count):
            self.full_disk(mount, max(4, needed * k // count))
        return {"sizes": count, "largest_kB": needed * (count - 1) // count}

    def starts(self, count):
        """As many processes at once on one directory: one winner."""
        folder = self.fresh("rivals")
        processes = [self.start("generate", self.campaign, "-o", folder,
                                *self.devices) for _ in range(count)]
        answers = [process.communicate() for process in processes]
        codes = [process.returncode for process in processes]
        require(codes.count(0) == 1, f"exit codes {codes}")
        self.require_same(folder)
        held = sum("in use by" in error for _, error in answers)
        return {"starts": count, "winners": 1, "named_who_holds_it": held}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--damages", type=int, default=1000)
    parser.add_argument("--sizes", type=int, default=20)
    parser.add_argument("--starts", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        faults = Faults(arguments.program.resolve(), folder, arguments.seed)
        for name, count in [("kills", arguments.kills),
                            ("damages", arguments.damages),
                            ("full_disks", arguments.sizes),
                            ("starts", arguments.starts)]:
            if count:
                print(f"{name}: {getattr(faults, name)(count)}", flush=True)


if __name__ == "__main__":
    try:
        main()
    except (Fault, OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"set_faults: {error}")
