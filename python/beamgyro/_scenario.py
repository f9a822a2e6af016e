# SPDX-License-Identifier: MIT
"""Scenarios and their simulation."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Literal, Optional, Union, overload

import numpy as np

from beamgyro import _arguments, _checks, _core, _toml
from beamgyro._dataset import dataset_of, recording_name
from beamgyro._device import Device, DeviceLike, Keys, Path, device_of
from beamgyro._native import Native, Wrapper
from beamgyro._progress import ProgressArgument, watched
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import xarray as xr

Fidelity = Literal["quasistatic", "envelope", "carrier"]
ScenarioLike = Union["Scenario", Path, Keys]
Arrays = dict[str, "np.ndarray[Any, Any]"]


class Scenario(Wrapper):
    """What happens to a gyro over time, and the gyro that it happens to.

    It does not change, even where a file that it was read from does. Two
    scenarios are equal when their texts, devices, replaced keys and profiles
    are; a scenario pickles as these.

    Args:
        source: a scenario file, or its contents as a nested mapping. In a
            mapping, files are named relative to the working directory.
        device: the device, in place of the one that the scenario names.
        set: keys of the scenario or of its device to replace, dotted or
            nested: ``{"duration_s": 60, "beam.length_m": 0.041}``.

    Raises:
        ValueError: with file, line and key, what is wrong.
    """

    __slots__ = ()

    _native: _core.Scenario

    def __init__(self, source: ScenarioLike, *,
                 device: Optional[DeviceLike] = None,
                 set: Optional[Keys] = None) -> None:
        overrides = _toml.overrides(set)
        if _checks.is_table(source):
            self._native = _scenario_of_keys(source, device, overrides)
            return
        if isinstance(source, Scenario):
            core = source._native
            if device is not None:
                core = core.with_device(device_of(device)._native)
            self._native = core.with_(overrides) if overrides else core
            return
        file = _checks.file(source, "scenario", "a scenario",
                            _checks.MAPPING)
        self._native = (
            _core.Scenario.read(file, overrides) if device is None
            else _core.Scenario.read_with(file, device_of(device)._native,
                                          overrides))

    @classmethod
    def parse(cls, text: str, device: DeviceLike, name: str = "scenario",
              set: Optional[Keys] = None) -> Scenario:
        """Read the text of a scenario file, called `name` in messages.

        Profiles that it names are relative to the folder of `name`.
        """
        return cls._parsed(
            _checks.text(text, "text"), device_of(device)._native,
            _toml.overrides(set), _checks.text(name, "name"), [])

    def with_(self, keys: Optional[Keys] = None, /, *,
              device: Optional[DeviceLike] = None, **more: Any) -> Scenario:
        """Return the scenario with keys of it or its device replaced.

        >>> scenario.with_(seed=2, fidelity="envelope")
        >>> scenario.with_({"ambient.constant_degC": 40.0})
        >>> scenario.with_(device="other.toml")
        """
        return Scenario(self, device=device, set=_toml.merged(keys, more))

    text = Native(str, "The text of the scenario file.")
    name = Native(str, "The name of the file, as messages give it.")

    @property
    def device(self) -> Device:
        """The device, without the keys that the scenario replaces."""
        return Device._of(self._native.device)

    overrides = Native(list[str], "The keys that were replaced, as KEY=VALUE.")
    title = Native(str, "The name and the description in the file.")
    duration_s = Native(float, "How long it lasts [s].", "duration")
    output_rate_Hz = Native(float, "Samples in a second [Hz].", "output_rate")
    samples = Native(int, "The number of samples of its recording.")
    fidelity = Native(str, "How much of the physics is simulated.")
    seed = Native(int, "The seed of everything random.")

    def _identity(self) -> Any:
        return (self.text, tuple(self.overrides), self.device,
                tuple(self._native.profiles))

    def __repr__(self) -> str:
        changes = "".join(f", {text}" for text in self.overrides)
        return (f"<beamgyro.Scenario {self.name}: {self.title} "
                f"({self.duration_s:g} s at {self.output_rate_Hz:g} Hz, "
                f"{self.fidelity}, seed {self.seed}; device "
                f"{self.device.name}{changes})>")

    def _rows(self) -> list[tuple[str, str]]:
        return [("name", self.name), ("title", self.title),
                ("device", self.device.name),
                ("replaced keys", ", ".join(self.overrides) or "none"),
                ("duration", f"{self.duration_s:g} s, {self.samples} samples "
                 f"at {self.output_rate_Hz:g} Hz"),
                ("fidelity", self.fidelity), ("seed", str(self.seed))]

    def __reduce__(self) -> tuple[Any, ...]:
        return _scenario_of, (self.text, self.device, self.overrides,
                              self.name, self._native.profiles)


def _scenario_of(text: str, device: Device, *others: Any) -> Scenario:
    return Scenario._parsed(text, device._native, *others)


def _scenario_of_keys(keys: Keys, device: Optional[DeviceLike],
                      overrides: list[str]) -> _core.Scenario:
    named = keys.get("device")
    if device is None and named is None:
        raise ValueError(
            "scenario: device: is missing; expected the key \"device\" or the "
            "argument device=")
    wanted: Any = named if device is None else device
    unit = device_of(wanted)
    is_path = isinstance(named, (str, os.PathLike))
    written = {**keys, "device": named if is_path else unit.name}
    return _core.Scenario.parse(_toml.text(written), unit._native, overrides,
                                "scenario", [])


def _simulated(source: ScenarioLike, device: Optional[DeviceLike],
               set: Optional[Keys], seed: Optional[int],
               fidelity: Optional[Fidelity]) -> _core.Scenario:
    keys = _toml.merged(set, {}, "set")
    for name, value in (("seed", seed), ("fidelity", fidelity)):
        if name == "seed" and value is not None:
            value = _arguments.seed(value, _arguments.LARGEST_TOML_SEED)
        if value is not None:
            keys.pop(name, None)
            keys[name] = value
    if isinstance(source, Scenario) and device is None and not keys:
        return source._native
    return Scenario(source, device=device, set=keys)._native


@overload
def run(scenario: ScenarioLike, *, device: Optional[DeviceLike] = ...,
        set: Optional[Keys] = ..., seed: Optional[int] = ...,
        fidelity: Optional[Fidelity] = ...,
        output: Literal["dataset"] = ..., stop_on_unlock: bool = ...,
        progress: ProgressArgument = ...) -> xr.Dataset: ...


@overload
def run(scenario: ScenarioLike, *, device: Optional[DeviceLike] = ...,
        set: Optional[Keys] = ..., seed: Optional[int] = ...,
        fidelity: Optional[Fidelity] = ...,
        output: Literal["arrays"], stop_on_unlock: bool = ...,
        progress: ProgressArgument = ...) -> Arrays: ...


def run(scenario: ScenarioLike, *, device: Optional[DeviceLike] = None,
        set: Optional[Keys] = None, seed: Optional[int] = None,
        fidelity: Optional[Fidelity] = None,
        output: Literal["dataset", "arrays"] = "dataset",
        stop_on_unlock: bool = False,
        progress: ProgressArgument = False) -> Union[xr.Dataset, Arrays]:
    """Simulate one gyro in one scenario.

    The values, and with `save_recording` the bytes of the file, are those of
    ``beamgyro run`` with the same arguments.

    Args:
        scenario: a scenario, its file, or a mapping.
        device: the device, in place of the one that the scenario names.
        set: keys of the scenario or of its device to replace:
            ``{"duration_s": 60, "beam.length_m": 0.041}``.
        seed: the seed of everything random.
        fidelity: "quasistatic", "envelope" or "carrier".
        output: "dataset", or "arrays" for a dictionary of NumPy arrays,
            which takes less time.
        stop_on_unlock: fail where the drive loop is not locked one second
            after a power-on or later.
        progress: True for a bar on standard error, or a function that is
            called with the share of the work that is done, from 0 to 1.

    Returns:
        The recording, with the variables and attributes of its file. No
        array is copied.

    Raises:
        ValueError: with file, line and key, what is wrong in the input.
        RuntimeError: the run cannot go on.
    """
    if output not in ("dataset", "arrays"):
        raise _checks.wrong(output, "output", "\"dataset\" or \"arrays\"")
    core = _simulated(scenario, device, set, seed, fidelity)
    with watched(progress, "simulating") as function:
        recording, warnings = _core.simulate(
            core, _checks.flag(stop_on_unlock, "stop_on_unlock"), function)
    warn(f"{core.name}: {text}" for text in warnings)
    return (recording.arrays() if output == "arrays"
            else dataset_of(recording))


def run_to_file(scenario: ScenarioLike, path: Path, *,
                device: Optional[DeviceLike] = None,
                set: Optional[Keys] = None, seed: Optional[int] = None,
                fidelity: Optional[Fidelity] = None,
                stop_on_unlock: bool = False,
                progress: ProgressArgument = False) -> None:
    """Simulate into a file, .h5 or .csv, as ``beamgyro run`` does.

    Memory does not grow with the run. Arguments and errors as of `run`.
    """
    core = _simulated(scenario, device, set, seed, fidelity)
    file = recording_name(path)
    with watched(progress, "simulating") as function:
        warnings = _core.simulate_to_file(
            core, file, _checks.flag(stop_on_unlock, "stop_on_unlock"),
            function)
    warn(f"{core.name}: {text}" for text in warnings)
