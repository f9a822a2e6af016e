# SPDX-License-Identifier: MIT
"""Recordings, models, compensators and campaigns that are refused."""

import re
import shutil

import h5py

from bench_log import BENCH, bench_rows, table
from program import CUBIC, NETWORK, SCENARIO, SCENARIOS, ramp
from rejections import Rejections, row
from sets import CAMPAIGN, Set

TRAIN = "train run.h5 --model m.toml --held-out other_run.h5 -o o.json"
BLIND = "blind.h5", "'true_rate'"
BIG = ["rate", "temperature", "output"]
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
        row("info half.h5", re.compile(r"half.h5: \d+ of \d+ bytes are there; expected a whole "
                                       "copy"), name="cut off"),
        row("info copy.h5", "filetype of the file is text of variable length",
            'engine="netcdf4"', "CSV"),
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
        *[row(f"train run.h5 --model bp.toml --cv {by} -o o.json",
              f"needs two {by}s or more; the recordings have 1")
          for by in ["run", "cycle", "leg"]],
        *[row(f"train run.h5 --model {name}.toml --cv run -o o.json", "needs two runs or more")
          for name in ["auto", "cubic"]],
        *[row(TRAIN, "1 rows", "100000 s", "rows.seconds", name=text[:20],
              files={"m.toml": text + "[rows]\nseconds = 100000\n"})
          for text in [CUBIC, NETWORK]],
        row(TRAIN, "hidden = [1000]", "3001 weights", "250 training rows", name="large",
            files={"m.toml": NETWORK.replace("[2]", "[1000]") + "[rows]\nseconds = 16\n"}),
        # Recordings without what is needed of them
        row("train less.h5 --model two.toml --held-out other_run.h5 -o o.json", *LESS),
        row("compensate bp.json less.h5 -o o.h5", *LESS),
        row("validate bp.json less.h5", *LESS),
        row("train blind.h5 --model cubic.toml -o o.json", *BLIND),
        row("validate c.json blind.h5", *BLIND),
        row("train log.h5 --held-out other_log.h5 --model output.toml -o o.json",
            "log.h5", "output"),
        *[row(words.replace("FILE", f"big_{name}.h5"), f"big_{name}.h5",
              f"{name}: sample 50 is 1e+300")
          for name in BIG for words in [
              "train FILE --model cubic.toml -o o.json", "compensate c.json FILE -o o.h5",
              "validate c.json FILE", "allan FILE", "info FILE"]],
        # Compensators
        *[row(f"{words} {name} run.h5{rest}", name)
          for name in ["half.json", "empty.json", "other.json", "kind.json"]
          for words, rest in [("compensate", " -o o.h5"), ("validate", "")]],
        row("compensate c.json run.h5 -o nowhere/o.h5", "nowhere"),
        # Names that do not say what is written
        *[row(f"{words} -o x.{name}", f"-o x.{name}", ending) for words, name, ending in [
            ("run run.toml", "json", ".h5 or .csv"), ("characterise device.toml", "h5", ".csv"),
            ("train run.h5 --model cubic.toml", "h5", ".json"),
            ("compensate c.json run.h5", "json", ".h5 or .csv"),
            ("export c.json --format c", "c", "directory"),
            ("generate campaign.toml", "h5", "directory")]],
        # Series
        row("allan run.h5 --dataset rte", "rte", "rate"),
        *[row("allan s.csv --rate-Hz 10", "s.csv", files={"s.csv": text}, name=text)
          for text in ["", "rate\n", "1\nx\n3\n", "1\nnan\n3\n"]],
        row("allan s.csv", "s.csv:4", "increase", name="a time that stands still",
            files={"s.csv": "time,rate\n0,1\n1,2\n1,3\n"}),
        *[row("allan s.csv", f"s.csv:1: time: the unit '{unit}' is not known; expected s, ms, "
              "us, ns, min, h", name=unit,
              files={"s.csv": f"time [{unit}],rate [deg/h]\n0,1\n1,2\n2,1\n"})
          for unit in ["furlong", "deg/s"]],
        row("allan run.h5 --from 300 --to 100", "--from 300 --to 100"),
        row("allan run.h5 --from 1e6", "from 1e+06"),
        row("allan run.h5 --unit V", "states its unit, deg/s"),
        *[row(f"allan run.h5 {option} {word}", option, "not known; expected",
              f'did you mean "{meant}"?')
          for option, word, meant in [("--kind", "oadv", "oadev"),
                                      ("--kind", "adev,mdv", "mdev"),
                                      ("--taus", "octaves", "octave")]],
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
        # As h5netcdf and h5py write texts.
        self.write("copy.h5", whole)
        with h5py.File(self.dir / "copy.h5", "a") as file:
            file.attrs["filetype"] = file.attrs["filetype"].decode()
        with h5py.File(self.dir / "less.h5", "a") as file:
            del file["quadrature"]
        for name in BIG:
            self.write(f"big_{name}.h5", whole)
            with h5py.File(self.dir / f"big_{name}.h5", "a") as file:
                file[name][50] = 1e300
        shutil.copy(SCENARIOS / "models/auto.toml", self.dir)
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


class Sets(Rejections, Set):
    table = [
        *[row(f"generate campaign.toml -o set {words}", says) for words, says in [
            ("--shard 0/3", "--shard"), ("--shard 4/3", "--shard"), ("--shard 1", "--shard"),
            ("--shard 1/3x", "--shard"), ("--devices 0", "devices"), ("--jobs 0", "jobs"),
            ("--devices many", "devices")]],
        *[row(f"generate campaign.toml -o {name}", says) for name, says in [
            ("file", "file"), ("no/where/set", "no/where"), ("/proc/set", "/proc")]],
        *[row("generate campaign.toml -o set", "campaign.toml:21:", says, name=text,
              files={"campaign.toml": f"{CAMPAIGN}\n[output]\n{text}\n"})
          for text, says in [('variables = ["outputs"]', "outputs"),
                             ("truth_rate_Hz = 0.7", "truth_rate_Hz")]],
        row("generate campaign.toml -o set", "campaign.toml:4:", "4000000000 files",
            name="4000000000 devices", files={
                "campaign.toml": CAMPAIGN.replace("devices = 7", "devices = 4000000000")}),
        *[row(f"{command} {name}", name) for command in ["verify", "info"]
          for name in ["empty", "nowhere"]],
    ]

    def prepare(self):
        super().prepare()
        (self.dir / "empty").mkdir()
        self.write("file", "x")


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
         "table.csv": ("a table that characterise wrote", ""),
         "curves.h5": ("the curves of a population", "beamgyro plot")}

# With the files that each command takes.
TAKES = [("run FILE -o o.h5", "scenario.toml"),
         ("characterise FILE -o o.csv", "device.toml campaign.toml"),
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
         ("verify FILE", "set"),
         ("validate c.json --device FILE --qualification q.toml", "device.toml")]


class Kinds(Rejections, Set):
    """Files of another kind, which are named with the command that takes them."""
    table = [row(words.replace("FILE", file), f"{file}: is ", *says)
             for words, taken in TAKES for file, says in KINDS.items()
             if file not in taken.split()]

    def prepare(self):
        super().prepare()
        self.write("scenario.toml", SCENARIO)
        shutil.copy(SCENARIOS / "maps/example.toml", self.dir / "map.toml")
        self.ok("run", "scenario.toml", "-o", "run.csv")
        self.cubic_of_a_ramp("run")
        self.ok("generate", "campaign.toml", "-o", "set", "--devices", 2)
        for file, table in [("device.toml", "table.csv"),
                            ("campaign.toml", "curves.h5")]:
            self.ok("characterise", file, "-o", table, "--beam-temperature",
                    "0:1:1")
