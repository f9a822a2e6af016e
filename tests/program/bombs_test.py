# SPDX-License-Identifier: MIT
"""Small files that ask for much, at every door that reads a file of a user.

Nothing may end by a signal, take more than 500 MB or 10 s of processor time.
Damage at random is in damage_test.py and mended_damage_test.py.
"""

import concurrent.futures
import os
import subprocess

from bombs import MOST_BYTES, make_all
from bench_log import BENCH
from program import CUBIC, PATIENCE, PROGRAM, ProgramTest
from sets import write_campaign

MOST_KIB = 500 * 1024
MOST_SECONDS = 10  # of processor time

# The doors of a file of each kind; the file stands for FILE. Others are met by
# files of another kind: every command says what it expected.
DOORS = {
    "h5": ["info FILE", "allan FILE", "compensate c.json FILE -o out.h5",
           "train FILE --model cubic.toml -o out.json",
           "validate c.json FILE"],
    "set": ["info FILE", "info FILE --device 1", "verify FILE",
            "train FILE --model cubic.toml -o out.json",
            "validate c.json FILE", "compensate c.json FILE -o out.h5"],
    "json": ["info FILE", "compensate FILE run.h5 -o out.h5",
             "validate FILE run.h5", "export FILE --format c -o out",
             "validate c.json run.h5 --baseline-result FILE",
             "plan FILE --soaks 2"],
    "toml": ["run FILE -o out.h5", "run ramp.toml --device FILE -o out.h5",
             "characterise FILE -o out.csv", "generate FILE -o out",
             "sensitivity FILE --samples 32",
             "train run.h5 --model FILE -o out.json",
             "validate c.json run.h5 --spec FILE",
             "validate c.json --device device.toml --qualification FILE",
             "import log.csv --map FILE -o out.h5"],
    "csv": ["import FILE --map map.toml -o out.h5", "allan FILE",
            "info FILE", "compensate c.json FILE -o out.h5"],
}
PLOTS = ["time_claims_chunks.h5", "inflates.h5", "driver.h5", "set_claims",
         "deep.json", "number.json", "list.json"]

# Opens each file by every function that takes one.
IN_PYTHON = """\
import sys
import beamgyro as bg
name = sys.argv[1]
doors = [lambda: bg.open_recording(name).load(),
         lambda: bg.open_set(name).recording("ramp", 1),
         lambda: bg.Compensator(name), lambda: bg.Device(name),
         lambda: bg.Scenario(name), lambda: bg.Campaign(name),
         lambda: bg.train(name, "cubic.toml"),
         lambda: bg.validate("c.json", [name])]
for door in doors:
    try:
        door()
    except (ValueError, RuntimeError):
        pass
"""


class Bombs(ProgramTest):
    def prepare(self):
        super().prepare()
        self.cubic_of_a_ramp("run")
        write_campaign(self, devices=2)
        self.ok("generate", "campaign.toml", "-o", "set")
        self.write("cubic.toml", CUBIC)
        self.write("log.csv", "t,w,T\n0,0,20\n1,0,21\n")
        self.write("map.toml", BENCH)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.bombs = make_all(cls.kept)

    def harmless(self, words, given=subprocess.DEVNULL, **options):
        """A process that ends by itself and took little; what it took."""
        told = self.dir / f"told_{abs(hash(tuple(words)))}"
        with told.open("w") as errors, subprocess.Popen(
                ["timeout", "-s", "KILL", str(PATIENCE), *words], cwd=self.dir,
                stdin=given, stdout=subprocess.DEVNULL, stderr=errors,
                **options) as process:
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        said = told.read_text(errors="replace")
        about = f"{words[1:]}: {said[-500:]}"
        self.assertIn(process.returncode, (0, 1, 2, 3), about)
        self.assertLess(used.ru_maxrss, MOST_KIB, about)
        seconds = used.ru_utime + used.ru_stime
        self.assertLess(seconds, MOST_SECONDS, about)
        self.assertLess(len(said), 10_000, about)  # nothing is quoted whole
        return seconds, used.ru_maxrss

    def doors(self, kind):
        """The words at each door for each file of a kind. Every one writes into
        a folder of its own."""
        for k, name in enumerate(self.bombs[kind]):
            for n, door in enumerate(DOORS[kind]):
                out = f"{kind}_{k}_{n}_"
                words = [name if word == "FILE" else
                         out + word if before == "-o" else word
                         for before, word in zip([""] + door.split(),
                                                 door.split())]
                yield [str(PROGRAM), *words]
            yield ["/usr/bin/python3", "-c", IN_PYTHON, name]

    def all_harmless(self, commands):
        """Prints what took most."""
        package = PROGRAM.parent / "python"
        environment = os.environ | {"PYTHONPATH": str(package)}
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            took = list(pool.map(
                lambda words: (*self.harmless(words, env=environment), words),
                commands))
        slow, large = max(took), max(took, key=lambda one: one[1])
        print(f"{len(took)} commands: at most {slow[0]:.2f} s "
              f"({' '.join(slow[2])[-80:]!r}) and {large[1] // 1024} MB "
              f"({' '.join(large[2])[-80:]!r})")

    def test_all_are_small(self):
        for kind, names in self.bombs.items():
            for path in (self.dir / name for name in names):
                for file in ([path] if path.is_file() else path.rglob("*")):
                    self.assertLessEqual(file.stat().st_size, MOST_BYTES, file)
            self.assertIn(kind, DOORS)

    def test_recordings(self):
        self.all_harmless(self.doors("h5"))

    def test_sets(self):
        self.all_harmless(self.doors("set"))

    def test_json(self):
        self.all_harmless(self.doors("json"))

    def test_toml(self):
        self.all_harmless(self.doors("toml"))

    def test_logs(self):
        self.all_harmless(self.doors("csv"))

    def test_pictures(self):
        self.all_harmless([str(PROGRAM), "plot", name, "-o", f"{name}.png"]
                          for name in PLOTS)

    def test_files_without_end(self):
        for endless in "/dev/zero", "/dev/urandom":
            self.all_harmless(
                [str(PROGRAM), *(endless if word == "FILE" else word
                                 for word in door.split())]
                for doors in DOORS.values() for door in doors)

    def test_streams(self):
        for name in self.bombs["csv"]:
            with (self.dir / name).open("rb") as given:
                self.harmless(
                    [str(PROGRAM), "compensate", "c.json", "--stream"], given)
