# SPDX-License-Identifier: MIT
"""Many variants of one run, in one dataset."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional

from beamgyro import _arguments, _checks, _core, _lazy, _toml
from beamgyro._device import DeviceLike, Keys
from beamgyro._progress import ProgressArgument, watched
from beamgyro._scenario import Fidelity, Scenario, ScenarioLike
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import xarray as xr


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
    texts = [[_toml.overrides({name: value}) for value in values]
             for name, values in axes.items()]
    threads = _arguments.jobs(jobs or 0)
    with watched(progress, "simulating") as function:
        recording, warnings = _core.simulate_variants(
            base._native, texts, kept, threads, function)
    shape = tuple(map(len, axes.values()))
    warn(f"{base.name}: {text} (in {count} of {math.prod(shape)} runs)"
         for text, count in warnings)
    return _dataset(recording, axes, shape, kept)


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


def _dataset(recording: _core.Recording, axes: Mapping[str, Sequence[Any]],
             shape: tuple[int, ...], kept: Sequence[str]) -> xr.Dataset:
    """The values of all runs, of which none is copied."""
    arrays = recording.arrays()
    attributes = recording.variable_attributes()
    time = arrays.pop("time")
    if kept and "status" not in kept:
        del arrays["status"]
    dimensions = (*axes, "time")
    places: dict[str, Any] = {
        **axes, "time": ("time", time, attributes["time"])}
    made: xr.Dataset = _lazy.xarray().Dataset(
        {name: (dimensions, values.reshape(*shape, time.size),
                attributes[name]) for name, values in arrays.items()}, places)
    return made
