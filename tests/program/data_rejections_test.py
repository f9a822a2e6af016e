# SPDX-License-Identifier: MIT
"""Recordings, models and compensators that are refused."""

import unittest

import h5py

from bench_log import BENCH, bench_rows, table
from program import CUBIC, NETWORK, SCENARIO, SCENARIOS, ramp
from rejections import Rejections, row
from sets import CAMPAIGN
from sets import SCENARIO as REST

TRAIN = "train run.h5 --model m.toml --held-out run.h5 -o o.json"
BLIND = "blind.h5", "'true_rate'"
LESS = "quadrature", "less.h5"


def model(old, new, says, text=CUBIC):
    assert old in text, old
    return row(TRAIN, says, files={"m.toml": text.replace(old, new)}, name=new)


class Data(Rejections):
    table = [
        *[row(f"{words} {name}{rest}", name)
          for name in ["text.h5", "other.h5", "half.h5", "empty.h5", "gone.h5"]
          for words, rest in [("info", ""), ("allan", ""),
                              ("train", " --model cubic.toml -o o.json")]],
        row("train log.csv --model cubic.toml -o o.json", "log.csv:1", "no column 'time'",
            "import", files={"log.csv": "t,w\n0,1\n"}),
        # Models
        row(TRAIN, "cubist", files={"m.toml": 'kind = "cubist"\n'}, name="cubist"),
        model("temperature", "temprature", "temprature"),
        model("temperature", "true_bias", "true_bias"),
        model("degree = 3", "degree = -1", "degree"),
        model("degree", "degre", "degre"),
        model('["temperature"]', "[]", "inputs"),
        model("[2]", "[0]", "hidden", NETWORK),
        model("levenberg_marquardt", "magic", "magic", NETWORK),
        row("train run.h5 --model bp.toml -o o.json", "--held-out", "--cv run|cycle|leg"),
        # Recordings without what is needed of them
        row("train less.h5 --model two.toml --held-out other_run.h5 -o o.json", *LESS),
        row("compensate bp.json less.h5 -o o.h5", *LESS),
        row("validate bp.json less.h5", *LESS),
        row("train blind.h5 --model cubic.toml -o o.json", *BLIND),
        row("validate c.json blind.h5", *BLIND),
        row("train log.h5 --held-out other_log.h5 --model output.toml -o o.json",
            "log.h5", "output"),
        # Compensators
        *[row(f"{words} {name} run.h5{rest}", name)
          for name in ["half.json", "empty.json", "other.json", "kind.json"]
          for words, rest in [("compensate", " -o o.h5"), ("validate", "")]],
        row("compensate c.json run.h5 -o nowhere/o.h5", "nowhere"),
        # Series
        row("allan run.h5 --dataset rte", "rte", "rate"),
        *[row("allan s.csv --rate-Hz 10", "s.csv", files={"s.csv": text}, name=text)
          for text in ["", "rate\n", "1\nx\n3\n", "1\nnan\n3\n"]],
    ]

    def prepare(self):
        super().prepare()
        for name, text in [("text.h5", "not HDF5\n"), ("empty.h5", ""),
                           ("empty.json", ""), ("other.json", "{}"),
                           ("cubic.toml", CUBIC), ("bp.toml", NETWORK),
                           ("two.toml", NETWORK.replace(
                               '["temperature"]', '["temperature", "quadrature"]')),
                           ("output.toml", NETWORK.replace(
                               '["temperature"]', '["output", "temperature"]')),
                           ("map.toml", BENCH),
                           ("blind.toml", BENCH.split("[true_rate]")[0])]:
            self.write(name, text)
        with h5py.File(self.dir / "other.h5", "w") as file:
            file["x"] = [1.0]
        whole = self.run_scenario("run", text=ramp()).read_bytes()
        self.write("half.h5", whole[:len(whole) // 2])
        self.write("less.h5", whole)
        with h5py.File(self.dir / "less.h5", "a") as file:
            del file["quadrature"]
        self.run_scenario("other_run", text=ramp(seed=9))
        self.ok("train", "run.h5", "--model", "two.toml", "--held-out", "other_run.h5",
                "-o", "bp.json")
        for name, samples, log_map in [("log", 2400, "map"), ("other_log", 2460, "map"),
                                       ("blind", 2400, "blind")]:
            self.write("samples.csv", table("t,w,T", bench_rows(samples)))
            self.ok("import", "samples.csv", "--map", f"{log_map}.toml", "-o",
                    f"{name}.h5")
        self.ok("train", "log.h5", "--model", "cubic.toml", "-o", "c.json")
        whole = (self.dir / "c.json").read_bytes()
        self.write("half.json", whole[:len(whole) // 2])
        self.write("kind.json", whole.replace(b"beamgyro-compensator",
                                              b"beamgyro-recording"))

    def test_a_recording_without_a_true_rate_is_compensated(self):
        self.ok("compensate", "c.json", "blind.h5", "-o", "out.h5")
        self.ok("allan", "blind.h5")


KINDS = {"device.toml": ("a device file", "beamgyro characterise"),
         "scenario.toml": ("a scenario", "beamgyro run"),
         "campaign.toml": ("a campaign", "beamgyro generate"),
         "model.toml": ("a model file", "beamgyro train --model"),
         "map.toml": ("a log map", "beamgyro import --map"),
         "run.h5": ("a recording", "beamgyro info"),
         "run.csv": ("a recording as CSV", "beamgyro info"),
         "set": ("the directory of a set", "beamgyro info"),
         "set/rest_00000.h5": ("a file of a set", "beamgyro info"),
         "c.json": ("a compensator", "beamgyro compensate"),
         "table.csv": ("a table that characterise wrote", "")}

# With the files that each command takes.
TAKES = [("run FILE -o o.h5", "scenario.toml"),
         ("characterise FILE -o o.csv", "device.toml"),
         ("generate FILE -o o", "campaign.toml"),
         ("train run.h5 --model FILE -o o.json", "model.toml"),
         ("train FILE --model model.toml -o o.json", "run.h5 run.csv set"),
         ("import FILE --map map.toml -o o.h5", "run.csv table.csv"),
         ("import table.csv --map FILE -o o.h5", "map.toml"),
         ("compensate FILE run.h5 -o o.h5", "c.json"),
         ("compensate c.json FILE -o o.h5", "run.h5 run.csv"),
         ("validate c.json FILE", "run.h5 run.csv set"),
         ("export FILE --format c -o o", "c.json"),
         ("allan FILE", "run.h5 run.csv table.csv"),
         ("info FILE", "run.h5 run.csv set set/rest_00000.h5"),
         ("verify FILE", "set")]


class Kinds(Rejections):
    """Files of another kind, which are named with the command that takes them."""
    table = [row(words.replace("FILE", file), f"{file}: is ", *says)
             for words, taken in TAKES for file, says in KINDS.items()
             if file not in taken.split()]

    def prepare(self):
        super().prepare()
        for name, text in [("scenario", SCENARIO), ("model", CUBIC), ("campaign", CAMPAIGN),
                           ("map", (SCENARIOS / "maps/example.toml").read_text()),
                           *[(name, REST.format(name=name, ambient="constant_degC = 25"))
                             for name in ("rest", "ramp")]]:
            self.write(f"{name}.toml", text)
        self.ok("run", "scenario.toml", "-o", "run.csv")
        self.run_scenario("run", text=ramp())
        self.ok("train", "run.h5", "--model", "model.toml", "-o", "c.json")
        self.ok("generate", "campaign.toml", "-o", "set", "--devices", 2)
        self.ok("characterise", "device.toml", "-o", "table.csv",
                "--beam-temperature", "0:1:1")


if __name__ == "__main__":
    unittest.main()
