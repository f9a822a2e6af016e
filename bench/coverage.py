#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""How often the stated sigma of a compensator holds, class by class.

coverage.py [--program FILE] [--out DIR] [--devices N] [--units N]
            [--recommended N] [--jobs N] [CLASS...]

Classes are population, with_modes (population with spurious modes), lifelike
and trimmed. A population is learned from the sweeps of --devices units, of
lifelike ones up and down. Of --units further ones, of another seed, each is

- adapted from 3, 5 and 7 soaks, as they are shipped and as `plan` plans them;
- trained alone: a cubic and a spline of a sweep, a ramp up and down and a
  warm-up. Of a sweep alone they state no sigma.

Scored are other runs of the unit with all noise, after another power-on: the
soaks of a sweep once they have settled and before, the ramps of a run up and
down, the first 15 min of a warm-up, and the settled soaks a year later, by rows
of 60 s within the temperatures of training. The sweep rises; units that
remember have one that falls as well, and both count: sigma does not know the
way. Units that `train` names foreign to their population, of which sigma does
not hold, are counted and left out. Printed are the share within the interval of
90 % and the mean square of residual over sigma, units of equal weight, and the
medians of the rms left and of that of sigma.

The recommended network of --recommended units is trained on the three runs with
--cv run. Of it the shares of soaks and ramps and the normalised innovations
that `validate --json` states are printed, means over units.

DIR/table.json has all; DIR is out/coverage.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "bench"))
import foreign_units  # noqa: E402
import uncertainty  # noqa: E402

SCENARIOS = ROOT / "scenarios"
SHIPPED = {3: [-36, -12, 36], 5: [-36, -18, 0, 18, 36],
           7: [-36, -24, -12, 0, 12, 24, 36]}
CLASSES = {"population": ("population", False),
           "with_modes": ("population", True),
           "lifelike": ("lifelike_population", False),
           "trimmed": ("trimmed", False)}
LOWEST = {"trimmed": -15}  # [degC], below which a sensor shows no rate
YEAR = 8766  # [h]
MINUTE = 60.0  # [s], of a row
NORMAL_90 = 1.6449
WARM_UP, RAMP = uncertainty.WARM_UP, uncertainty.RAMP
SETTLED = 0.01 / 60  # [K/s], below which a soak has settled
SOAKS = """\
name = "soaks"
device = "{device}"
fidelity = "quasistatic"
duration_s = {duration}
output_rate_Hz = 0.1
seed = {seed}

[ambient.soaks]
temperatures_degC = {soaks}
hold_s = {hold}
ramp_K_per_min = {ramp}

[chamber]
stirred = true
"""
WARM = """\
name = "warm_up"
device = "{device}"
fidelity = "quasistatic"
duration_s = 3600
output_rate_Hz = 0.1
seed = {seed}

[ambient]
constant_degC = {ambient}
"""


class Study(foreign_units.Study):
    def __init__(self, name, arguments):
        super().__init__(arguments)
        self.name, self.devices = name, arguments.devices
        self.recommended = arguments.recommended
        self.kind, self.with_modes = CLASSES[name]
        self.planned = {}

    def scenario(self, kind, run):
        if run in self.planned:
            return self.planned[run]
        if run == "sweep":
            return SCENARIOS / "soak_sweep_sparse.toml"
        device = SCENARIOS / "devices/nominal.toml"
        sweep = list(range(-37, 48, 12))
        text = {
            "down": SOAKS.format(device=device, seed=810,
                                 soaks=list(range(50, -45, -5)), hold=2700,
                                 ramp=0.2, duration=78300),
            "again": SOAKS.format(device=device, seed=811, soaks=sweep,
                                  hold=2700, ramp=1, duration=26900),
            "again_down": SOAKS.format(device=device, seed=818,
                                       soaks=sweep[::-1], hold=2700, ramp=1,
                                       duration=26900),
            "year": SOAKS.format(device=device, seed=812, soaks=sweep,
                                 hold=2700, ramp=1, duration=26900)
            + f"\n[age]\nhours = {YEAR}\n",
            "ramp": SOAKS.format(device=device, seed=813, soaks=[-38, 48, -38],
                                 hold=1800, ramp=1, duration=15700),
            "other_ramp": SOAKS.format(
                device=device, seed=814, soaks=[-38, 48, -38], hold=1800,
                ramp=1.5, duration=12300),
            "warm": WARM.format(device=device, seed=815, ambient=20),
            "other_warm": WARM.format(device=device, seed=816, ambient=10),
        }.get(run)
        if text is None:
            soaks = SHIPPED[int(run.removeprefix("soaks_"))]
            text = SOAKS.format(
                device=device, seed=817, soaks=soaks, hold=2700, ramp=0.2,
                duration=2700 * len(soaks) + 300 * (max(soaks) - min(soaks)))
        file = self.out / f"{run}.toml"
        file.write_text(text)
        return file

    def population_file(self):
        sweeps = ["sweep", "down"] if self.name == "lifelike" else ["sweep"]
        folder = self.set(f"set_{self.name}", self.kind, self.with_modes,
                          sweeps, 7001, self.devices)
        file = self.out / f"{self.name}.json"
        if not file.exists():
            words = [word for run in sweeps for word in ("--run", run)]
            self.call("train", folder, *words, "--model",
                      SCENARIOS / "population/population.toml", "-o", file)
        return file

    def plan(self, population):
        for count in SHIPPED:
            file = self.out / f"planned_{count}_{self.name}.toml"
            self.call("plan", population, "--soaks", count, "--device",
                      SCENARIOS / "devices/nominal.toml", "-o", file)
            self.planned[f"planned_{count}"] = file

    def runs(self):
        runs = ["sweep", "again", "ramp", "other_ramp", "warm", "other_warm"]
        if self.name == "lifelike":
            runs += ["again_down", "year"]
        return runs + [f"soaks_{n}" for n in SHIPPED] + list(self.planned)

    def train(self, folder, device, model, runs, extra=()):
        file = self.out / f"{model.stem}_{folder.name}_{device}.json"
        words = [word for run in runs for word in ("--run", run)]
        self.call("train", folder, *words, "--device", device, "--model",
                  model, *extra, "-o", file)
        stored = json.loads(file.read_text())
        file.unlink()
        return stored

    def methods(self, population):
        """Name, model file, runs and options of each compensator."""
        alone = ["sweep", "ramp", "warm"]
        for name, kind in [("cubic", "polynomial"), ("spline", "spline")]:
            (self.out / f"{name}.toml").write_text(f'kind = "{kind}"\n')
        model = self.out / f"adapted_{self.name}.toml"
        model.write_text(
            (SCENARIOS / "population/adapted.toml").read_text().replace(
                "population.json", str(population)))
        for run in self.runs():
            if run.startswith(("soaks_", "planned_")):
                yield f"adapted, {run}", model, [run]
        for name in ["cubic", "spline"]:
            yield f"{name}, three runs", self.out / f"{name}.toml", alone

    def measure(self):
        population = self.population_file()
        self.plan(population)
        folder = self.set(f"units_{self.name}", self.kind, self.with_modes,
                          self.runs(), 9107, self.units)
        rows = {run: rows_of(folder, run) for run in self.runs()}
        table = {}
        for name, model, runs in self.methods(population):
            with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
                found = list(pool.map(
                    lambda device: self.score(
                        self.train(folder, device, model, runs), rows,
                        device), sorted(rows["sweep"])))
            known = [score for score in found if score is not None]
            if len(known) < len(found):
                print(f"{self.name:11}{name:24}named foreign and left out: "
                      f"{len(found) - len(known)} units")
            table[name] = means(known)
            print("\n".join(lines(self.name, name, table[name])), flush=True)
        if self.recommended:
            with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
                found = list(pool.map(
                    lambda device: self.recommended_of(folder, device),
                    sorted(rows["sweep"])[:self.recommended]))
            shares = np.mean(found, axis=0)
            table["recommended"] = list(shares)
            print(f"{self.name:11}recommended, three runs {len(found)} units: "
                  f"soaks {100 * shares[0]:.1f} %, ramps "
                  f"{100 * shares[1]:.1f} %, nis {shares[2]:.2f}", flush=True)
        return table

    def recommended_of(self, folder, device):
        """Shares within 90 % of soaks and ramps, and NIS, of `validate`."""
        file = self.out / f"recommended_{device}.json"
        scores = self.out / f"scores_{device}.json"
        self.call("train", folder, "--run", "sweep", "--run", "ramp", "--run",
                  "warm", "--device", device, "--model",
                  SCENARIOS / "models/recommended.toml", "--cv", "run", "-o",
                  file)
        subprocess.run(
            [self.program, "validate", file, folder, "--run", "again", "--run",
             "other_ramp", "--run", "other_warm", "--device", str(device),
             "--json", scores], capture_output=True, check=False)
        sigma = json.loads(scores.read_text())["sigma"]
        file.unlink()
        scores.unlink()
        return [*(sigma[place]["coverage"][1]["share"]["value"]
                  for place in ["soaks", "ramps"]),
                sigma["bias_filter"]["nis"]["value"]]

    def score(self, stored, rows, device):
        found = {}
        if foreign_units.is_foreign(stored):
            return None
        if "sigma" not in stored:
            return found
        sweeps = ["again", "again_down"]
        for place, runs in [("soaks", sweeps), ("settling", sweeps),
                            ("ramps", ["other_ramp"]),
                            ("warm-up", ["other_warm"]), ("a year", ["year"])]:
            error, sigma = np.hstack([
                self.errors(stored, place, *rows[run][device])
                for run in runs if run in rows] or [np.empty((2, 0))])
            if error.size:
                found[place] = [np.mean(abs(error) <= NORMAL_90 * sigma),
                                np.mean((error / sigma) ** 2),
                                np.sqrt(np.mean(error ** 2)),
                                np.sqrt(np.mean(sigma ** 2))]
        return found

    def errors(self, stored, place, time, T, bias):
        """Error and sigma of the rows of a place in a run."""
        rate = uncertainty.temperature_rate(time, T, 300)
        late = time - time[0] >= WARM_UP
        moving, settled = abs(rate) >= RAMP, abs(rate) < SETTLED
        lowest, highest = stored["temperature_range_degC"]
        lowest = max(lowest, LOWEST.get(self.name, lowest))
        own = (T >= lowest) & (T <= highest) & {
            "soaks": settled & late, "ramps": moving & late,
            "settling": ~moving & ~settled & late,
            "warm-up": ~late, "a year": settled & late}[place]
        return np.array([(bias - curve_of(stored, T))[own],
                         uncertainty.sigma_of(stored["sigma"], time, T)[own]])


def curve_of(stored, T):
    T = np.clip(T, *stored["temperature_range_degC"])
    if stored["kind"] == "spline":
        return uncertainty.spline_of(stored["parameters"])(T)
    scale, bias = stored["input_scales"][0], stored["bias_scale"]
    x = (T - scale["centre"]) / scale["half_width"]
    return bias["centre"] + bias["half_width"] * np.polynomial.Polynomial(
        stored["parameters"]["coefficients"])(x)


def rows_of(folder, run):
    """Time, temperature and bias of rows of a minute, of each good unit."""
    found = {}
    for path in sorted(folder.glob(f"{run}_[0-9]*.h5")):
        with h5py.File(path) as file:
            time = file["time"][()]
            T = foreign_units.values(file, "temperature")
            bias = foreign_units.values(file, "rate") \
                - foreign_units.values(file, "true_rate")
            numbers = file["device"][()]
        block = max(1, round(MINUTE / np.median(np.diff(time))))
        count = len(time) // block * block

        def mean(x):
            return x[:count].reshape(-1, block).mean(1)
        for number, own_T, own in zip(numbers, T, bias):
            if np.isfinite(own).all():
                found[int(number)] = mean(time), mean(own_T), mean(own)
    return found


def means(scores):
    table = {}
    for place in ["soaks", "settling", "ramps", "warm-up", "a year"]:
        rows = np.array([score[place] for score in scores if place in score])
        if len(rows):
            table[place] = [len(rows), *rows[:, :2].mean(0),
                            *np.median(rows[:, 2:], axis=0)]
    return table


def lines(kind, method, table):
    for place, (count, within, square, left, sigma) in table.items():
        yield (f"{kind:11}{method:24}{place:9}{count:4} units "
               f"{100 * within:6.1f} %  z^2 {square:6.2f}  left {left:.4f}  "
               f"sigma {sigma:.4f} deg/s")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    parser.add_argument("--out", type=pathlib.Path,
                        default=ROOT / "out/coverage")
    parser.add_argument("--devices", type=int, default=300)
    parser.add_argument("--units", type=int, default=300)
    parser.add_argument("--recommended", type=int, default=0)
    parser.add_argument("--jobs", type=int,
                        default=len(os.sched_getaffinity(0)))
    parser.add_argument("classes", nargs="*", default=list(CLASSES))
    arguments = parser.parse_args()
    table = {name: Study(name, arguments).measure()
             for name in arguments.classes}
    (arguments.out / "table.json").write_text(json.dumps(table, indent=1))


if __name__ == "__main__":
    try:
        main()
    except (RuntimeError, OSError, subprocess.SubprocessError) as error:
        sys.exit(f"coverage: {error}")
