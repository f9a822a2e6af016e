# SPDX-License-Identifier: MIT
"""No command writes over a file that it reads, under whatever name."""

import os
import shutil

from bench_log import BENCH
from program import CUBIC, SCENARIO, ramp
from rejections import Rejections, row
from sets import Set, write_campaign

POPULATION = """\
kind = "population"
inputs = ["temperature", "quadrature"]

[population]
grid_K = 5
"""

READ = "is read by this command"


def link(make, name):
    return lambda path: make(path.parent / name, path)


def guarded(words, files, ending=".h5"):
    """Rows of a command whose output OUT is a link to a file that it reads, or
    where its name is one of an output, that file."""
    for name in files.split():
        for make in [os.symlink, os.link]:
            yield row(words.replace("OUT", f"out{ending}"), READ,
                      files={f"out{ending}": link(make, name)},
                      name=f"{make.__name__} {name}")
        if name.endswith(ending):
            yield row(words.replace("OUT", name), READ)


class Outputs(Rejections):
    table = [
        *guarded("run profiles.toml -o OUT", "profiles.toml device.toml profile.csv ambient.csv",
                 ".csv"),
        *guarded("run s.toml --set rate.file=\\\"profile.csv\\\" -o OUT", "profile.csv", ".csv"),
        row("run s.toml -o s.toml", "s.toml"),  # its ending is refused first
        *guarded("characterise device.toml -o OUT", "device.toml", ".toml"),
        *guarded("characterise campaign.toml -o OUT", "campaign.toml device.toml"),
        *guarded("import log.csv --map map.toml -o OUT", "map.toml log.csv", ".csv"),
        *guarded("train a.h5 --held-out b.h5 --model model.toml -o OUT", "a.h5 b.h5 model.toml"),
        row("train a.h5 --model model.toml -o model.toml", READ),
        *guarded("compensate c.json a.h5 -o OUT", "c.json a.h5"),
        *guarded("validate c.json a.h5 b.h5 --json OUT", "a.h5 b.h5"),
        *guarded("validate c.json a.h5 b.h5 --json OUT", "c.json", ".json"),
        *guarded("allan a.h5 --json OUT", "a.h5"),
        *[row("export c.json --format c -o c", name, READ, name=name,
              files={f"c/{name}": link(os.link, "../c.json")})
          for name in ["c.h", "c.c", "c_selftest.c", "c_plugin.c"]],
        *guarded("train set --device 3 --model adapted.toml -o OUT",
                 "population.json adapted.toml", ".json"),
        *guarded("validate set.json set --json OUT", "set/manifest.jsonl set/rest_00000.h5 "
                 "set/source/head.jsonl set.json", ".jsonl"),
    ]

    def prepare(self):
        super().prepare()
        (self.dir / "c").mkdir()
        for name, text in [
                ("s.toml", SCENARIO), ("map.toml", BENCH), ("model.toml", CUBIC),
                ("profile.csv", "time_s,rate_deg_per_s\n0,0\n600,1\n"),
                ("ambient.csv", "time_s,temperature_degC\n0,20\n600,30\n"),
                ("profiles.toml", SCENARIO.replace("constant_degC = 25",
                                                   'file = "ambient.csv"') +
                 '\n[rate]\nfile = "profile.csv"\n'),
                ("log.csv", "t,w,T\n" + "".join(
                    f"{1000 * k},0.1,{20 + k % 3}\n" for k in range(100))),
                ("population.toml", POPULATION),
                ("adapted.toml", 'kind = "adapted"\npopulation = "population.json"\n')]:
            self.write(name, text)
        sweep = "points = [[0, -30], [3000, 40]]"
        write_campaign(self, 12, 3000, 0.1, rest=sweep, ramp=sweep)
        self.write("campaign.toml", self.text("campaign.toml") +
                   "[split]\ntrain = 0.7\nvalidation = 0.15\ntest = 0.15\n")
        for seed, name in enumerate(["a", "b"]):
            self.run_scenario(name, text=ramp(seed=seed))
        self.ok("train", "a.h5", "--held-out", "b.h5", "--model", "model.toml", "-o", "c.json")
        self.ok("generate", "campaign.toml", "-o", "set")
        self.ok("train", "set", "--model", "model.toml", "-o", "set.json")
        self.ok("train", "set", "--model", "population.toml", "-o", "population.json")

    def test_every_file_of_a_set_that_is_trained_on(self):
        files = [str(path.relative_to(self.dir)) for path in sorted(
            (self.dir / "set").rglob("*")) if path.is_file()]
        for name in ["set/manifest.jsonl", "set/source/device.toml"]:
            self.assertIn(name, files)
        for one in guarded("train set --model model.toml -o OUT", " ".join(files)):
            self.refuse(one)


class Sets(Set):
    def test_a_campaign_that_lies_in_the_directory_of_its_own_set(self):
        (self.dir / "set").mkdir()
        for name in ["set/rest.nc", "set/rest_00000.h5", "set/manifest.jsonl",
                     "set/set.lock"]:
            os.link(self.dir / "device.toml", self.dir / name)
            self.rejected("generate", "campaign.toml", "-o", "set",
                          "--resume", says=READ)
            (self.dir / name).unlink()
        for name in ["campaign.toml", "rest.toml", "ramp.toml", "device.toml"]:
            shutil.copy(self.dir / name, self.dir / "set" / name)
        self.ok("generate", "set/campaign.toml", "-o", "set")
        self.ok("generate", "set/source/campaign.toml", "-o", "set",
                "--resume")
