# SPDX-License-Identifier: MIT
"""Many variants of one run, in one dataset."""

from __future__ import annotations

import collections
import itertools
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from beamgyro import _arguments, _checks, _core, _lazy
from beamgyro._device import DeviceLike, Keys
from beamgyro._progress import ProgressArgument, watched
from beamgyro._scenario import Fidelity, Scenario, ScenarioLike
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import xarray as xr

_BATCH = 64  # variants that wait for a thread at once, for each thread


def run_many(scenario: ScenarioLike,
             keys: Optional[Mapping[str, Sequence[Any]]] = None, *,
             seeds: Iterable[int] = (), variables: Iterable[str] = (),
             device: Optional[DeviceLike] = None, set: Optional[Keys] = None,
             fidelity: Optional[Fidelity] = None, jobs: Optional[int] = None,
             progress: ProgressArgument = False) -> xr.Dataset:
    """Simulate every combination of values of some keys, on all cores.

    >>> bg.run_many("scenarios/warm_up.toml",
    ...             {"beam.length_m": [0.039, 0.04]}, seeds=range(3))

    Each run has the values that `run` gives with the same keys.

    Args:
        scenario: a scenario, its file, or a mapping.
        keys: the values of each key of the scenario or its device.
        seeds: the seeds of everything random; without, that of the scenario.
        variables: what to keep; without, all that runs have.
        device: the device, in place of the one that the scenario names.
        set: keys that are the same in all runs.
        fidelity: "quasistatic", "envelope" or "carrier".
        jobs: threads; 0 and None: one for each core.
        progress: True for a bar, or a function that is called with the share
            of the runs that are done, from 0 to 1.

    Returns:
        A dataset with a dimension for each key, called as the key, ``seed``
        where there are seeds, and ``time``.

    Raises:
        ValueError: something is wrong in the input; the message names the
            values of the run. Also where runs differ in their times.
        RuntimeError: a run cannot go on.
    """
    axes = _axes(keys, seeds)
    kept = _checks.texts(variables, "variables")
    base = Scenario(scenario, device=device, set={
        **(set or {}), **({"fidelity": fidelity} if fidelity else {})})
    shape = tuple(map(len, axes.values()))
    variants = [dict(zip(axes, values))
                for values in itertools.product(*axes.values())]
    threads = _arguments.jobs(jobs or 0) or len(os.sched_getaffinity(0))
    said: collections.Counter[str] = collections.Counter()
    table: Optional[_Table] = None
    with watched(progress, "simulating") as function:
        for done, (variant, (recording, warnings)) in enumerate(zip(
                variants, _simulated(base, variants, threads))):
            if table is None:
                table = _Table(recording, len(variants), kept)
            table.add(done, recording, _words(variant))
            said.update(warnings)
            if function is not None:
                function((done + 1) / len(variants))
    warn(f"{base.name}: {text} (in {count} of {len(variants)} runs)"
         for text, count in said.items())
    assert table is not None  # there is one variant at least
    return table.dataset(axes, shape)


def _axes(keys: Optional[Mapping[str, Sequence[Any]]], seeds: Iterable[int]
          ) -> dict[str, list[Any]]:
    """The values along each dimension."""
    if keys is not None and not _checks.is_table(keys):
        raise _checks.wrong(keys, "keys", "a mapping of keys to their values")
    axes: dict[str, list[Any]] = {}
    for name, values in (keys or {}).items():
        if isinstance(values, (str, bytes, Mapping)) or not isinstance(
                values, Iterable):
            raise _checks.wrong(values, f"keys: {name}", "a sequence of values")
        axes[name] = list(values)
    seeded = [_arguments.seed(one, _arguments.LARGEST_TOML_SEED)
              for one in _checks.wholes(seeds, "seeds")]
    if seeded:
        axes["seed"] = seeded
    for name, values in axes.items():
        _arguments.not_empty(values, name)
    return axes


def _words(variant: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} = {value}" for name, value in variant.items())


def _simulated(base: Scenario, variants: Sequence[Mapping[str, Any]],
               threads: int
               ) -> Iterator[tuple[_core.Recording, list[str]]]:
    """The runs in the order of their variants, some of them ahead."""
    def one(variant: Mapping[str, Any]) -> Any:
        try:
            core = Scenario(base, set=variant)._native if variant \
                else base._native
            return _core.simulate(core, False, None)
        except (ValueError, RuntimeError) as error:
            raise type(error)(f"{_words(variant)}: {error}") from None

    with ThreadPoolExecutor(threads) as pool:
        try:
            for first in range(0, len(variants), _BATCH * threads):
                yield from pool.map(one, variants[first:first
                                                  + _BATCH * threads])
        finally:
            pool.shutdown(cancel_futures=True)


class _Table:
    """The values of all runs, a row for each."""

    def __init__(self, recording: _core.Recording, count: int,
                 kept: Sequence[str]) -> None:
        arrays = recording.arrays()
        unknown = [name for name in kept if name not in arrays]
        if unknown:
            raise ValueError(f"variables: {unknown[0]!r}: the runs have none; "
                             f"expected some of {', '.join(arrays)}")
        self._time = arrays["time"]
        self._attributes = recording.variable_attributes()
        self._rows = {name: np.empty((count, *values.shape), values.dtype)
                      for name, values in arrays.items()
                      if name != "time" and (not kept or name in kept)}

    def add(self, number: int, recording: _core.Recording,
            words: str) -> None:
        """Copies the values of a run to its row."""
        arrays = recording.arrays()
        if not np.array_equal(arrays["time"], self._time):
            raise ValueError(f"{words}: has other times than the first run; "
                             "expected runs of one duration and rate")
        for name, rows in self._rows.items():
            rows[number] = arrays[name]

    def dataset(self, axes: Mapping[str, Sequence[Any]],
                shape: tuple[int, ...]) -> xr.Dataset:
        """Return all of it."""
        dimensions = (*axes, "time")
        places: dict[str, Any] = {
            **axes, "time": ("time", self._time, self._attributes["time"])}
        made: xr.Dataset = _lazy.xarray().Dataset(
            {name: (dimensions, rows.reshape(*shape, -1),
                    self._attributes[name])
             for name, rows in self._rows.items()}, places)
        return made
