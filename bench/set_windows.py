#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Measures windows of a set: PYTHONPATH=BUILD/python bench/set_windows.py

MB of decoded values that a loader of torch with two workers gives in a second
of wall time, once they are warm, and in one of processor time.
"""

from __future__ import annotations

import os
import pathlib
import tempfile
import time
import warnings

import torch
from torch.utils.data import DataLoader

import beamgyro as bg

SCENARIOS = pathlib.Path(__file__).resolve().parents[1] / "scenarios"
SIGNALS = ["rate", "temperature", "drive_frequency", "quadrature"]
EPOCHS = 6


def used() -> float:
    """Processor time of this process and of its workers that ended [s]."""
    times = os.times()
    return (times.user + times.system + times.children_user
            + times.children_system)


def read(windows: bg.Windows, epochs: int) -> tuple[float, list[float]]:
    """Decoded MB of an epoch, and the time of each epoch [s]."""
    loader = DataLoader(
        windows,  # type: ignore[arg-type]
        num_workers=2, persistent_workers=True,
        batch_sampler=windows.batches(64, workers=2))
    spent, size = [], 0
    for _ in range(epochs):
        begin = time.perf_counter()
        size = sum(one.numel() * one.element_size()
                   for batch in loader for one in batch)
        spent.append(time.perf_counter() - begin)
    return size / 1e6, spent


def main() -> None:
    """Measure and print."""
    warnings.simplefilter("ignore")
    torch.set_num_threads(1)
    with tempfile.TemporaryDirectory() as folder:
        made = bg.generate(SCENARIOS / "campaigns/warm_up.toml",
                           pathlib.Path(folder) / "set", devices=60,
                           progress=False)
        windows = made.torch(SIGNALS, window=600, part=None)
        begin = used()
        read(windows, 1)
        once = used() - begin
        begin = used()
        size, spent = read(windows, EPOCHS)
        each = (used() - begin - once) / (EPOCHS - 1)
    print(f"{len(windows)} windows, {size:.0f} MB an epoch, load "
          f"{os.getloadavg()[0]:.1f}")
    print(f"warm epochs: {size / min(spent[1:]):.0f} MB/s at best, "
          f"{size / each:.0f} MB a second of processor time")


if __name__ == "__main__":
    main()
