#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Measures the Python package: PYTHONPATH=BUILD/python bench/python_api.py

Time of `import beamgyro`, overhead of a run, many variants of a run, two
threads against one, and the memory of 10,000 runs in one process.
"""

from __future__ import annotations

import os
import pathlib
import subprocess
import sys
import threading
import time
from collections.abc import Callable

import beamgyro as bg

SCENARIOS = pathlib.Path(__file__).resolve().parents[1] / "scenarios"


def seconds(work: Callable[[], object], count: int) -> float:
    """The shortest time of a call in five rounds."""
    best = float("inf")
    for _ in range(5):
        start = time.perf_counter()
        for _ in range(count):
            work()
        best = min(best, (time.perf_counter() - start) / count)
    return best


def import_time() -> float:
    """Processor time of an import in a process of its own, less Python's;
    the shortest of ten."""
    def of(code: str) -> float:
        best = float("inf")
        for _ in range(10):
            before = os.times()
            subprocess.run([sys.executable, "-c", code], check=True)
            after = os.times()
            best = min(best, after.children_user + after.children_system
                       - before.children_user - before.children_system)
        return best
    return of("import beamgyro") - of("pass")


def resident_MB() -> float:
    """Memory of this process."""
    status = pathlib.Path("/proc/self/status").read_text(encoding="ascii")
    line = next(line for line in status.splitlines()
                if line.startswith("VmRSS"))
    return int(line.split()[1]) / 1024


def two_threads(scenario: bg.Scenario) -> float:
    """How much faster two threads do the work of one."""
    def runs(count: int) -> None:
        for _ in range(count):
            bg.run(scenario, output="arrays")

    def together() -> None:
        threads = [threading.Thread(target=runs, args=(4,))
                   for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    return seconds(lambda: runs(8), 1) / seconds(together, 1)


def many_runs(scenario: bg.Scenario) -> float:
    """Variants with another device each, a second of wall time."""
    lengths = [0.04 + 1e-6 * k for k in range(1000)]
    return 1000 / seconds(lambda: bg.run_many(
        scenario, {"beam.length_m": lengths}), 1)


def main() -> None:
    """Measure and print."""
    print(f"import                    {1e3 * import_time():8.1f} ms")
    one = bg.Scenario(SCENARIOS / "warm_up.toml", set={"duration_s": 0.1})
    print("one sample, arrays        "
          f"{1e6 * seconds(lambda: bg.run(one, output='arrays'), 200):8.1f}"
          " us")
    print("one sample, dataset       "
          f"{1e6 * seconds(lambda: bg.run(one), 200):8.1f} us")
    print(f"variants of one sample    {many_runs(one):8.0f} runs/s")
    long = bg.Scenario(SCENARIOS / "warm_up.toml",
                       set={"duration_s": 10, "fidelity": "envelope"})
    print(f"two threads against one   {two_threads(long):8.2f}")
    minute = one.with_(duration_s=60)
    for _ in range(500):
        bg.run(minute, output="arrays")
    before = resident_MB()
    for _ in range(10000):
        bg.run(minute, output="arrays")
    print(f"memory after 10,500 runs  {resident_MB():8.1f} MB, of which the "
          f"last 10,000 took {resident_MB() - before:.2f} MB")


if __name__ == "__main__":
    main()
