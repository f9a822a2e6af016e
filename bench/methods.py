#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Every shipped model on the runs of the demo: what is left on unseen runs.

methods.py [--program FILE] [--out DIR] [--jobs N]; simulates the demo's runs
into DIR (out/methods) if they are not there, trains every file of
scenarios/models on the demo's sweeps (models of the temperature alone) or on
all its training runs, scores on its test runs with noise off and prints a
table; DIR/methods.json gets every figure.
"""

import json
import math
import pathlib
import resource
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))

import demo  # noqa: E402

MODELS = ROOT / "scenarios/models"
STATIC = {"temperature"}
RATE_TABLES = [name for name, *_ in demo.TEST if name.startswith("rate_table")]
TRAINING_RATES = [
    (f"rate_table_training_{t}", "rate_table", 170 + k,
     [f"ambient.constant_degC={t}"]) for k, t in enumerate(range(-45, 51, 5))]


def runs_of(text):
    """Names of the training and held-out runs of a model file."""
    model = tomllib.loads(text)
    rates = [name for name, *_ in TRAINING_RATES] if "scale_factor" in model \
        else []
    inputs = set(model.get("inputs", STATIC))
    if inputs <= STATIC | {"output"}:
        training, held_out = demo.SWEEPS, demo.SOAKS_HELD_OUT
    else:
        training, held_out = demo.TRAINING, demo.VALIDATION
    return [name for name, *_ in training] + rates, \
        [name for name, *_ in held_out]


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def parameters_of(compensator):
    """Numbers a compensator holds beside its scales."""
    def count(value):
        if isinstance(value, list):
            return sum(count(each) for each in value)
        return isinstance(value, float)
    return sum(count(value) for key, value in compensator["parameters"].items())


def study(job, name):
    text = (MODELS / f"{name}.toml").read_text()
    training, held_out = runs_of(text)
    file = job.out / f"{name}.json"
    start = cpu_seconds()
    job.beamgyro("train", *(job.recording(run) for run in training),
                 "--held-out", *(job.recording(run) for run in held_out),
                 "--model", MODELS / f"{name}.toml",
                 "--seed", demo.TRAINING_SEED, "-o", file)
    seconds = cpu_seconds() - start
    soak, motion, everything = job.judge_parts(file, demo.TEST, "", name)
    squares = [everything["runs"][run] ** 2 for run in RATE_TABLES]
    compensator = json.loads(file.read_text())
    return {
        "model": name,
        "method": compensator["training"]["method"],
        "percent_of_cubic": soak["percent_of_cubic"],
        "soak_sigma_deg_per_s": soak["after"]["residual_sigma_deg_per_s"],
        "motion_rms_deg_per_s": motion["after"]["residual_rms_deg_per_s"],
        "motion_max_deg_per_s": motion["after"]["residual_max_deg_per_s"],
        "rate_table_rms_deg_per_s": math.sqrt(sum(squares) / len(squares)),
        "parameters": parameters_of(compensator),
        "train_cpu_s": seconds,
        "verdict": everything["verdict"],
    }


def main():
    parser = demo.options("methods")
    parser.add_argument("models", nargs="*",
                        help="names of scenarios/models; all without")
    arguments = parser.parse_args()
    job = demo.Demo(arguments.program.resolve(), arguments.out.resolve(),
                    arguments.jobs)
    if not job.recording(TRAINING_RATES[-1][0]).exists():
        job.simulate(demo.TRAINING + TRAINING_RATES + demo.VALIDATION
                     + demo.REST, demo.TEST)
    names = arguments.models or sorted(file.stem
                                       for file in MODELS.glob("*.toml"))
    rows = []
    print(f"{'model':24}{'% of cubic':>11}{'sigma':>9}{'moving rms':>12}"
          f"{'max':>8}{'rates rms':>11}{'numbers':>9}{'train s':>9}  verdict")
    for name in names:  # one after the other: their times are compared
        row = study(job, name)
        rows.append(row)
        print(f"{name:24}{row['percent_of_cubic']:11.3g}"
              f"{row['soak_sigma_deg_per_s']:9.4f}"
              f"{row['motion_rms_deg_per_s']:12.4f}"
              f"{row['motion_max_deg_per_s']:8.3f}"
              f"{row['rate_table_rms_deg_per_s']:11.4f}"
              f"{row['parameters']:9}{row['train_cpu_s']:9.2f}  "
              f"{row['verdict']}", flush=True)
    (job.out / "methods.json").write_text(json.dumps(rows, indent=2) + "\n")


if __name__ == "__main__":
    main()
