#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Scores methods on virtual devices drawn from manufacturing tolerances.

population.py [--program FILE] [--out DIR] [--devices N] [--jobs N]
              [--studies NAME...] [--quick]

DIR is out/population, N devices 40. Every device is the nominal one with the
keys of draw() changed by --set; it is trained on and scored on by itself. Each
finished device leaves one line in DIR/devices.jsonl and is not done again; its
recordings, up to 450 MB, are deleted. Ends with medians and worst devices in
DIR/table.txt and DIR/table.json. --quick: one pass of each training run, to
see that all works; its figures mean little and go to devices_quick.jsonl.
Remove the lines of devices after a change of studies, models or program.
"""

import collections
import csv
import json
import pathlib
import shutil
import subprocess
import sys
import threading
import time

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
sys.path.insert(0, str(ROOT / "bench"))
import demo  # noqa: E402  (its runs, seeds and way to call the program)
import automatic_study  # noqa: E402
import demo_runs  # noqa: E402
from demo import NOISE_OFF, SCENARIOS  # noqa: E402

DEVICES = 40
DEVICE_SEED = 20  # of the draws
RUN_SEEDS = 1000  # device k adds (k + 1) RUN_SEEDS to the demo's seeds
TRAINING_SEED = 1
NOMINAL = SCENARIOS / "devices/nominal.toml"

SOAK_METHODS = ["spline", "bp"]
SOAK_TEST = [run for run in demo.TEST if run[0] in demo.SOAKS]
DYNAMIC_TEST = [run for run in demo.TEST if run[0] in demo.MOTION]
# A campaign against slow noise, 15 days in the chamber where the demo takes 10:
# no sweeps, whose labels a day of random walk moves by 0.05 deg/s, but many
# ramps and power-ons. Only other runs and other turn-ons average theirs out.
CAMPAIGN = [
    (f"campaign_{name}", *rest) for name, *rest in [
        demo_runs.ramp(f"ramp_{rate}_{k}", rate, seed + k)
        for rate, passes, seed in [(0.5, 5, 500), (1, 10, 520), (2, 20, 540)]
        for k in range(passes)] + [
        demo_runs.at(f"warm_up_{t}_{k}", "warm_up_cycles", t, 600 + 10 * k + i)
        for k in range(3)
        for i, t in enumerate([-40, -30, -20, -10, 5, 10, 30, 50])]]
CAMPAIGN_HELD_OUT = [
    (f"campaign_{name}", *rest) for name, *rest in [
        demo_runs.ramp(f"ramp_1.2_{k}", 1.2, 700 + k) for k in range(6)] + [
        demo_runs.at(f"warm_up_{t}_{k}", "warm_up_cycles", t, 710 + 10 * k + i)
        for k in range(3) for i, t in enumerate([-15, 20, 45])]]
NOISE = [("", [NOISE_OFF]), ("_noise", [])]  # scored runs: suffix, settings
YEAR = ("_year", [NOISE_OFF, "age.hours=8766"])

# Bounds to count the devices within. Percent: what the paper's BP network left
# of the variance its least squares left.
BOUNDS = {
    "soak": {f"{method}_percent_of_cubic{suffix}": 7.28
             for method in SOAK_METHODS for suffix, _ in NOISE},
    "dynamic": {"recommended_rms_deg_per_s": 0.03,
                "with_drive_frequency_rms_deg_per_s": 0.01},
    "channels": {"with_drive_frequency_rms_deg_per_s": 0.01},
    "campaign": {"with_drive_frequency_rms_deg_per_s": 0.01},
    "automatic": {f"{case}_{model}_of_best": automatic_study.BOUND
                  for case, (_, _, models, _) in automatic_study.CASES.items()
                  for model in models},
}


def draw(device):
    """Keys and values of device number `device`, from a stream of its own.

    Spreads are 1 sigma. The trims and temperature coefficients the nominal unit
    has a value of are drawn about 0: either sign is as likely in a population.
    """
    random = np.random.Generator(np.random.Philox(key=[DEVICE_SEED, device]))
    normal, uniform = random.normal, random.uniform
    return {
        "patches.offset_m": normal(0, 10e-6, 4).tolist(),
        "bond.thickness_m": uniform(20e-6, 40e-6, 4).tolist(),
        "beam.side_difference": -uniform(0.0065, 0.0125),
        "readout.quadrature_trim_deg_per_s": normal(0, 50),
        "mount.axis_angle_deg": normal(0, 2.5),
        "mount.glass_transition_degC": normal(-48, 4),
        "bond.beta_1Hz_degC": normal(-60, 4),
        "bond.glass_transition_degC": normal(38, 4),
        "readout.phase_tc_rad_per_K": normal(0, 2e-4),
        "readout.feedthrough_F": normal(0, 0.02e-12),
        "readout.offset_tc_deg_per_s_per_K": normal(0, 0.012),
        "beam.modulus_tc1_per_K": normal(0, 4e-6),
        "mount.glassy_stiffness_share": 6e-4 * np.exp(normal(0, 0.35)),
    }


def draw_channels(device):
    """Errors of the electronics that measure the loops, likewise."""
    random = np.random.Generator(np.random.Philox(
        key=[DEVICE_SEED + 1, device]))
    normal, uniform = random.normal, random.uniform
    return {
        "loop_channels.clock_offset_ppm": uniform(-20, 20),
        "loop_channels.clock_tc2_ppm_per_K2": normal(-0.034, 0.003),
        "loop_channels.drive_voltage_gain_error": normal(0, 0.01),
        "loop_channels.drive_voltage_gain_tc_per_K": normal(0, 50e-6),
        "loop_channels.quadrature_offset_deg_per_s": normal(0, 0.3),
        "loop_channels.quadrature_offset_tc_deg_per_s_per_K": normal(0, 0.01),
        "loop_channels.clock_ageing_ppm_per_year": uniform(-3, 3),
    }


def overrides(values):
    """KEY=VALUE of each, as --set takes them."""
    def number(value):
        return repr(float(value))
    return [f"{key}=[{', '.join(map(number, value))}]"
            if isinstance(value, list) else f"{key}={number(value)}"
            for key, value in values.items()]


def with_arguments(settings):
    return [part for text in settings for part in ("--set", text)]


class Unit(demo.Demo):
    """One device, with recordings and compensators in a folder of its own."""

    def __init__(self, program, folder, device, quick):
        self.program, self.out, self.runs = program, folder, folder
        self.device, self.quick = device, quick
        self.settings = overrides(draw(device))
        folder.mkdir(parents=True)

    def few(self, runs):
        """With --quick the first pass of each kind of run only."""
        kinds = {scenario: run for run in reversed(runs)
                 for scenario in [run[1]]}
        return list(kinds.values()) if self.quick else runs

    def simulate(self, runs, suffix="", settings=()):
        """Recordings of demo-style runs; one that is there serves again."""
        for name, scenario, seed, changes in runs:
            file = self.recording(name + suffix)
            if not file.exists():
                self.beamgyro(
                    "run", SCENARIOS / f"{scenario}.toml", "--seed",
                    seed + RUN_SEEDS * (self.device + 1), *with_arguments(
                        [*self.settings, *changes, *settings]), "-o", file)

    def fit(self, method, training, held_out):
        """Trains DIR/METHOD.json on runs, others choosing when to stop."""
        training, held_out = self.few(training), self.few(held_out)
        self.simulate(training + held_out)
        self.beamgyro(
            "train", *(self.recording(name) for name, *_ in training),
            "--held-out", *(self.recording(name) for name, *_ in held_out),
            "--model", SCENARIOS / f"models/{method}.toml",
            "--seed", TRAINING_SEED, "-o", self.out / f"{method}.json")


def drift(unit):
    """How much there is to compensate: the bias over the beam's temperature."""
    table = unit.out / "map.csv"
    unit.beamgyro("characterise", NOMINAL, "--beam-temperature", "-40:50:0.5",
                  *with_arguments(unit.settings), "-o", table)
    rows = list(csv.DictReader(table.read_text().splitlines()))
    bias = np.array([float(row["bias_deg_per_s"]) for row in rows])
    hertz = np.array([float(row["drive_frequency_Hz"]) for row in rows])
    return {"bias_peak_to_peak_deg_per_s": np.ptp(bias).item(),
            "drive_frequency_peak_to_peak_Hz": np.ptp(hertz).item()}


def soak(unit):
    """The paper's: temperature alone, soaks off the training grid."""
    for method in SOAK_METHODS:
        unit.fit(method, demo.SWEEPS, demo.SOAKS_HELD_OUT)
    figures = {}
    for suffix, settings in NOISE:
        unit.simulate(SOAK_TEST, suffix, settings)
        for method in SOAK_METHODS:
            judged = unit.judge(unit.out / f"{method}.json",
                                [name + suffix for name, *_ in SOAK_TEST])
            sigma = judged["metrics"]["residual_sigma_deg_per_s"]
            figures |= {
                f"raw_peak_to_peak_deg_per_s{suffix}":
                    judged["metrics"]["residual_pp_deg_per_s"]["before"],
                f"cubic_sigma_deg_per_s{suffix}": sigma["cubic"],
                f"{method}_sigma_deg_per_s{suffix}": sigma["after"],
                f"{method}_percent_of_cubic{suffix}":
                    judged["percent_of_cubic"],
            }
    return figures


def ramps_and_warm_ups(unit, methods, training, held_out, scored=NOISE):
    """Figures of methods on the ramps and warm-ups that no training sees."""
    for method in methods:
        unit.fit(method, training, held_out)
    figures = {}
    for suffix, settings in scored:
        unit.simulate(DYNAMIC_TEST, suffix, settings)
        for method in methods:
            judged = unit.judge(unit.out / f"{method}.json",
                                [name + suffix for name, *_ in DYNAMIC_TEST])
            figures |= {f"{method}_{figure}_deg_per_s{suffix}":
                        judged["after"][f"residual_{figure}_deg_per_s"]
                        for figure in ["rms", "max"]}
            if not suffix:
                figures |= {f"{method}_rms_deg_per_s_{name}": rms
                            for name, rms in judged["runs"].items()}
    return figures


def dynamic(unit):
    """Networks that know the past, and one that knows the beam, on the runs
    of the demo."""
    return ramps_and_warm_ups(unit, ["recommended", "with_drive_frequency"],
                              demo.TRAINING, demo.VALIDATION)


def campaign(unit):
    """What the drive frequency is worth when the labels allow it."""
    return ramps_and_warm_ups(unit, ["with_drive_frequency"], CAMPAIGN,
                              CAMPAIGN_HELD_OUT)


def channels(unit):
    """The same as `dynamic`, where electronics measure the drive frequency,
    and a year after the training. The recommended network does not see them:
    its figures stay."""
    measured = Unit(unit.program, unit.out / "channels", unit.device,
                    unit.quick)
    measured.settings += ["loop_channels.noise=true",
                          *overrides(draw_channels(unit.device))]
    return ramps_and_warm_ups(measured, ["with_drive_frequency"],
                              demo.TRAINING, demo.VALIDATION, [*NOISE, YEAR])


# A study takes a unit and returns its figures by name, lower ones being better;
# a figure that is a text is counted. Another is a function here, with BOUNDS
# above if devices are to be counted.
STUDIES = {"drift": drift, "soak": soak, "dynamic": dynamic,
           "channels": channels, "campaign": campaign,
           "automatic": automatic_study.automatic}


def finished(file):
    """Studies done by device; a line broken off by an interruption is none."""
    done = {}
    for line in file.read_text().splitlines() if file.exists() else []:
        try:
            entry = json.loads(line)
        except json.JSONDecodeError:
            continue
        done.setdefault(entry["device"], {}).update(entry["studies"])
    return done


def summary(done, studies):
    """Spread of every figure over the devices."""
    result = {}
    for study in studies:
        of_device = [entry[study] for entry in done.values()]
        result[study] = {}
        for figure, first in of_device[0].items():
            if isinstance(first, str):
                counts = collections.Counter(
                    entry[figure] for entry in of_device)
                result[study][figure] = {"counts": dict(counts.most_common())}
                continue
            values = np.array([entry[figure] for entry in of_device])
            row = {"best": values.min(), "median": np.median(values),
                   "worst": values.max()}
            bound = BOUNDS.get(study, {}).get(figure)
            if bound is not None:
                row |= {"bound": bound, "within": int(sum(values <= bound))}
            result[study][figure] = row
    return result


def table(rows, devices):
    lines = [f"{devices} devices; tolerances and seeds in bench/population.py"]
    for study, figures in rows.items():
        lines += ["", f"{study + ':':54}{'best':>10}{'median':>10}"
                      f"{'worst':>10}  within"]
        for figure, row in figures.items():
            if "counts" in row:
                lines.append(f"  {figure:52}  " + ", ".join(
                    f"{text} {n}" for text, n in row["counts"].items()))
                continue
            count = (f"{row['within']} within {row['bound']:g}"
                     if "bound" in row else "")
            lines.append(f"  {figure:52}{row['best']:10.4g}"
                         f"{row['median']:10.4g}{row['worst']:10.4g}  {count}"
                         .rstrip())
    return "\n".join(lines)


class Population(demo.Demo):
    """All devices, each in a thread of its own."""

    def __init__(self, arguments):
        self.program = arguments.program.resolve()
        self.out, self.jobs = arguments.out.resolve(), arguments.jobs
        self.studies, self.quick = arguments.studies, arguments.quick
        self.suffix = "_quick" if self.quick else ""
        self.out.mkdir(parents=True, exist_ok=True)
        self.file = self.out / f"devices{self.suffix}.jsonl"
        self.lock = threading.Lock()

    def study(self, device, names):
        """The device's figures in `names`, as its line of the file."""
        folder, start = self.out / f"device_{device}", time.monotonic()
        shutil.rmtree(folder, ignore_errors=True)
        try:
            unit = Unit(self.program, folder, device, self.quick)
            studies = {name: STUDIES[name](unit) for name in names}
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        seconds = round(time.monotonic() - start, 1)
        with self.lock, self.file.open("a") as lines:
            lines.write("\n" * self.broken_off() + json.dumps({
                "device": device, "seconds": seconds, "studies": studies})
                + "\n")
        print(f"device {device} took {seconds} s", file=sys.stderr, flush=True)

    def broken_off(self):
        """Whether an interruption left half a line at the end."""
        text = self.file.read_bytes()
        return bool(text) and not text.endswith(b"\n")

    def score(self, devices):
        """Table of devices 0, 1, ..., after studying those not done yet."""
        done = finished(self.file)
        left = [(device, names) for device in range(devices)
                if (names := [name for name in self.studies
                              if name not in done.get(device, {})])]
        self.all(lambda item: self.study(*item), left)
        done = {device: studies for device, studies
                in finished(self.file).items() if device < devices}
        rows = summary(done, self.studies)
        text = table(rows, devices)
        (self.out / f"table{self.suffix}.txt").write_text(text + "\n")
        (self.out / f"table{self.suffix}.json").write_text(json.dumps(
            {"devices": devices, "device_seed": DEVICE_SEED,
             "training_seed": TRAINING_SEED, "studies": rows}, indent=2)
            + "\n")
        return text


def main():
    parser = demo.options("population")
    parser.add_argument("--devices", type=int, default=DEVICES)
    parser.add_argument("--studies", nargs="+", choices=STUDIES,
                        default=list(STUDIES))
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    print(Population(arguments).score(arguments.devices))


if __name__ == "__main__":
    try:
        main()
    except (RuntimeError, OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"population: {error}")
