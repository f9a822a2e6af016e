#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Holds our populations against published figures of a real gyro.

PYTHONPATH=BUILD/python bench/hardware.py [--devices 300]; prints three tables in
Markdown. Curves are treated as those of the drawing were: the same range, zero
and step.
"""

import argparse
import pathlib
import tomllib

import numpy as np

import beamgyro as bg

ROOT = pathlib.Path(__file__).resolve().parent.parent
CAMPAIGNS = ["trimmed", "population", "lifelike", "lifelike_with_modes"]
STEP = 0.5  # [K]
ENDS = (0.05, 0.95)
FIGURES = {"pp_deg_per_s": "p-p, deg/s", "left_by_line": "line",
           "left_by_cubic": "cubic",
           "left_by_quintic": "quintic", "kink": "kink"}
LOGARITHMS = {"pp_deg_per_s", "left_by_cubic"}  # what half_split is stated of
METRICS = {"pp_deg_per_s": "log10_pp", "left_by_cubic": "log10_left_by_cubic",
           "kink": "kink"}


def described(curves, published):
    return bg.curve_figures(
        curves, range_degC=published["range_degC"],
        zero_at_degC=published["zero_at_degC"],
        round_deg_per_s=published["round_deg_per_s"])


def curves_of(campaign, devices, published):
    low, high = published["range_degC"]
    return bg.characterise(ROOT / f"scenarios/campaigns/{campaign}.toml",
                           slice(low, high, STEP), devices=devices)


def nominal(published):
    low, high = published["range_degC"]
    one = bg.characterise(ROOT / "scenarios/devices/nominal.toml",
                          slice(low, high, STEP))
    return described(one.expand_dims(device=[0]), published)


def quantile(published, name, share):
    table = published["quantiles"]
    return float(np.interp(share, table["shares"], table[name]))


def sample_quantiles(figures, share):
    return [np.quantile(np.array(figures.figures[name], dtype=float), share)
            for name in FIGURES]


def spread_of(data):
    shares = ", ".join(f"{100 * one:.0f}" for one in data["component_shares"])
    return (f"{data['pp_log10_sigma']:.2f}", shares,
            f"{100 * data['mean_curve_share']:.0f}")


def print_table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|---" * len(head) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def digits(values):
    return [f"{value:.3g}" for value in values]


def areas(found, published):
    """The area metric of each figure from the table."""
    table = published["quantiles"]
    for name in METRICS:
        scale = np.log10 if name in LOGARITHMS else np.asarray
        yield bg.area_metric(
            scale(np.array(found.figures[name], dtype=float)),
            scale(np.array(table[name])), shares=table["shares"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--devices", type=int, default=300)
    parser.add_argument("--hardware", type=pathlib.Path,
                        default=ROOT / "docs/hardware/xv7081bb.toml")
    parser.add_argument("--campaigns", nargs="+", default=CAMPAIGNS)
    arguments = parser.parse_args()
    hardware = tomllib.loads(arguments.hardware.read_text())
    published = hardware["curves"]
    found = {name: described(curves_of(name, arguments.devices, published),
                             published) for name in arguments.campaigns}
    units = f"{published['units']} {hardware['name']}"
    print_table(
        ["median", *FIGURES.values(), "sigma log10 p-p", "components, %",
         "mean, %"],
        [[units, *digits(quantile(published, name, 0.5) for name in FIGURES),
          *spread_of(published)],
         ["nominal", *digits(sample_quantiles(nominal(published), 0.5)),
          "-", "-", "-"],
         *([name, *digits(sample_quantiles(one, 0.5)), *spread_of(one.data)]
           for name, one in found.items())])
    print_table(
        ["5 and 95 %", *FIGURES.values()],
        [[units, *(" ".join(digits(quantile(published, name, share)
                                   for share in ENDS)) for name in FIGURES)],
         *([name, *(" ".join(digits(ends)) for ends in zip(
             *(sample_quantiles(one, share) for share in ENDS)))]
           for name, one in found.items())])
    halves = [published["half_split"][name] for name in METRICS.values()]
    print_table(
        ["area metric", *METRICS.values()],
        [["two halves: median (95 %)",
          *(f"{one['median']:.2f} ({one['p95']:.2f})" for one in halves)],
         *([name, *(f"{area:.2f}" for area in areas(one, published))]
           for name, one in found.items())])


if __name__ == "__main__":
    main()
