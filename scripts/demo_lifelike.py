# SPDX-License-Identifier: MIT
"""The part of the demo on a unit that remembers.

scenarios/devices/lifelike.toml is the demo's unit with memory. Every method is
trained on runs of it and scored on unseen ones, on the first and the tenth of
ten thermal cycles, and before and after 1,000 h in a store.
"""

import h5py
import numpy as np

from demo_runs import (AFTER_S, BEFORE_S, CYCLE_S, CYCLES, LIFELIKE_SWEEPS,
                       LIFELIKE_TEST, LIFELIKE_TRAINING, LIFELIKE_VALIDATION,
                       STORE)

METHODS = ["cubic", "spline", "bp", "output_and_temperature", "recommended",
           "recommended_with_play"]
MOVING = {"recommended", "recommended_with_play"}
RUNS = LIFELIKE_TRAINING + LIFELIKE_VALIDATION + LIFELIKE_TEST + [CYCLES, STORE]
BLOCK = 60.0  # [s], what scores are averaged over, too
TURN_ON = 600.0  # [s] at rest, whose mean re-zeroing subtracts


def residual_blocks(file, first, last):
    """Means over blocks of 60 s of the powered samples from first to last."""
    time, powered = file["time"][()], (file["status"][()] & 1) == 0
    taken = powered & (time >= first) & (time < last)
    error = (file["compensated_rate"][()] - file["true_rate"][()])[taken]
    block = ((time[taken] - first) // BLOCK).astype(int)
    size = np.bincount(block)
    return (np.bincount(block, error) / np.maximum(size, 1))[size > 0]


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def parts(study, method, suffix):
    """Rms residual of cycles, and of the days before and after the store."""
    def compensated(name):
        copy = study.recording(f"{name}{suffix}_{method}")
        study.beamgyro("compensate", study.out / f"lifelike/{method}.json",
                       study.recording(name + suffix), "-o", copy)
        return copy
    result = {}
    with h5py.File(copy := compensated(CYCLES[0])) as file:
        for number, span in CYCLE_S.items():
            result[f"cycle_{number}"] = rms(residual_blocks(file, *span))
    copy.unlink()
    with h5py.File(copy := compensated(STORE[0])) as file:
        result["before_store"] = rms(residual_blocks(file, *BEFORE_S))
        after = residual_blocks(file, *AFTER_S)
        zero = after[:int(TURN_ON / BLOCK)].mean()
        result["after_store"] = rms(after)
        result["after_store_rezeroed"] = rms(after - zero)
    copy.unlink()
    return {f"{key}_rms_deg_per_s": value for key, value in result.items()}


def score(study, method, suffix):
    soak, motion, everything = study.judge_parts(
        study.out / f"lifelike/{method}.json", LIFELIKE_TEST, suffix,
        f"lifelike_{method}")
    return {"method": method, "noise": bool(suffix),
            "soaks_rms_deg_per_s": soak["after"]["residual_rms_deg_per_s"],
            "percent_of_cubic": soak["percent_of_cubic"],
            "ramps_and_warm_ups_rms_deg_per_s":
                motion["after"]["residual_rms_deg_per_s"],
            **parts(study, method, suffix), "verdict": everything["verdict"]}


def study(demo):
    """Rows of the table, by method and by noise."""
    (demo.out / "lifelike").mkdir(exist_ok=True)
    demo.simulate(LIFELIKE_TRAINING + LIFELIKE_VALIDATION,
                  [*LIFELIKE_TEST, CYCLES, STORE])

    def fit(method):
        training = LIFELIKE_TRAINING if method in MOVING else LIFELIKE_SWEEPS
        held_out = LIFELIKE_VALIDATION[:None if method in MOVING else 1]
        demo.fit(method, training, held_out,
                 demo.out / f"lifelike/{method}.json")
    demo.all(fit, reversed(METHODS))
    return demo.all(lambda item: score(demo, *item),
                    [(method, suffix) for suffix in ("", "_noise")
                     for method in METHODS])


def table(rows, labels):
    head = (f"{'':26}|{'off-grid soaks':^19}|{'ramps,':>9}|"
            f"{'cycles':^16}|{'store, 1,000 h at 40 degC':^28}|\n"
            f"{'method':26}|{'rms':>8}{'% of cubic':>11}|{'warm-ups':>9}|"
            f"{'first':>8}{'tenth':>8}|{'before':>8}{'after':>8}"
            f"{'re-zeroed':>12}| verdict")
    lines = ["", "A unit that remembers, calibrated once; rms in deg/s, "
             "about zero.",
             f"Re-zeroed: less the mean of the first {TURN_ON / 60:.0f} min "
             "at rest after turn-on."]
    for noise, title in [(False, "noise off"), (True, "noise on")]:
        lines += ["", f"Scored with {title}", head,
                  "-" * 26 + "+" + "-" * 19 + "+" + "-" * 9 + "+" + "-" * 16
                  + "+" + "-" * 28 + "+" + "-" * 24]
        for r in rows:
            if r["noise"] == noise:
                figures = {key[:-14]: value for key, value in r.items()
                           if key.endswith("_rms_deg_per_s")}
                lines.append(
                    f"{labels[r['method']]:26}|"
                    f"{figures['soaks']:8.4f}"
                    f"{r['percent_of_cubic']:11.3g}|"
                    f"{figures['ramps_and_warm_ups']:9.4f}|"
                    f"{figures['cycle_1']:8.4f}{figures['cycle_10']:8.4f}|"
                    f"{figures['before_store']:8.4f}"
                    f"{figures['after_store']:8.4f}"
                    f"{figures['after_store_rezeroed']:12.4f}| {r['verdict']}")
    return "\n".join(lines)
