# SPDX-License-Identifier: MIT
"""Gyros inside another simulation, step by step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
import numpy.typing as npt

from beamgyro import _arguments, _checks, _core
from beamgyro._dataset import dataset_of
from beamgyro._device import Device
from beamgyro._progress import ProgressArgument, watched

if TYPE_CHECKING:
    import xarray as xr

Number = Union[float, int, "np.floating[Any]", "np.integer[Any]"]
# Held over a step, or its values at the begin and the end.
Input = Union[Number, tuple[Number, Number], list[Number], None]
Series = Union[Number, Sequence[Number], npt.NDArray[Any]]
Sample = _core.Sample
Truth = _core.Truth

_INPUTS = ("rate", "cross_rate_x", "cross_rate_y", "acceleration_x",
           "acceleration_y", "acceleration_z", "ambient", "powered")
# Those that an array of xarray has to state, if it states one.
_UNITS = {**dict.fromkeys(_INPUTS[:3], "degree/s"),
          **dict.fromkeys(_INPUTS[3:6], "m/s2")}


class Gyro:
    """One gyro that goes on step by step; `Device.start` makes it.

    It does not know what comes later. An input that is not given stays what
    it was. Whatever a call raises, the gyro is as it was before. A copy, by
    `copy.copy` or `copy.deepcopy`, is a snapshot; a gyro pickles, for the same
    version of the package.

    >>> gyro = bg.Device("scenarios/devices/nominal.toml").start(seed=1)
    >>> out = gyro.step(rate=20.0, dt=0.01)
    >>> out.rate, out.truth.true_bias
    """

    __slots__ = ("_native", "_start")

    _native: _core.Gyro
    _start: tuple[Device, dict[str, Any]]

    def now(self) -> Sample:
        """Return the sample at the end of the last step, or at the start."""
        return self._native.now()

    def step(self, *, dt: Number, rate: Input = None,
             cross_rate_x: Input = None, cross_rate_y: Input = None,
             acceleration_x: Input = None, acceleration_y: Input = None,
             acceleration_z: Input = None, ambient: Input = None,
             powered: Optional[bool] = None) -> Sample:
        """Advance by `dt` seconds and return the sample at the end.

        An input is a number, which is held over the step, or a pair of its
        values at the begin and the end with a straight line between them.

        Args:
            dt: the duration of the step [s], above 0 and at most 1e5.
            rate: about the input axis [degree/s].
            cross_rate_x, cross_rate_y: about the other axes [degree/s].
            acceleration_x, acceleration_y, acceleration_z: of the case [m/s2].
            ambient: the temperature around the gyro [degC].
            powered: whether it has power over the step.

        Returns:
            What the gyro shows, under the names and in the units of a
            recording, with ``status`` and ``time``; ``truth`` has what no
            gyro shows. NaN is what is measured without power, and in the
            truth what this gyro does not have.

        Raises:
            ValueError: a number is not finite or out of range.
            RuntimeError: the gyro cannot go on, with the time and why.
        """
        return self._native.step(dt, rate, cross_rate_x, cross_rate_y,
                                 acceleration_x, acceleration_y,
                                 acceleration_z, ambient, powered)

    def advance(self, inputs: Mapping[str, Series], dt: float, *,
                linear: bool = False,
                progress: ProgressArgument = False) -> xr.Dataset:
        """Take one step of `dt` seconds for each value of the inputs.

        >>> gyro.advance({"rate": [0.0, 10.0, 20.0], "ambient": 25.0}, dt=0.1)

        Args:
            inputs: arrays of one length, or numbers for all steps, under the
                names of `step`. At least one is an array.
            dt: the duration of each step [s].
            linear: each value is reached at the end of its step along a
                straight line, in place of being held over it.
            progress: True for a bar, or a function that is called with the
                share of the work that is done, from 0 to 1.

        Returns:
            The samples at the ends of the steps, as a recording. They are
            those of as many calls of `step`, to the last bit.

        Raises:
            ValueError, RuntimeError: as `step`, with the number of the step.
        """
        arrays = _arrays(inputs, None)
        count = {len(values) for values in arrays.values()}
        with watched(progress, "steps") as report:
            return dataset_of(self._native.advance(
                _arguments.number(dt, "dt"), count.pop(), arrays,
                bool(linear), report))

    def state(self) -> bytes:
        """Return the state, for `restore` in a gyro of this device and start.

        It has everything that what follows depends on, the random numbers too.
        """
        return self._native.state()

    def restore(self, state: bytes) -> None:
        """Go back to a `state` of this gyro or of one that began alike.

        Raises:
            ValueError: the bytes are none of this package, device and start.
        """
        if not isinstance(state, (bytes, bytearray)):
            raise ValueError(f"state {_checks.shown(state)}: expected bytes of "
                             "state()")
        self._native.restore(bytes(state))

    @property
    def device(self) -> Device:
        """The device that was started."""
        return self._start[0]

    def __copy__(self) -> Gyro:
        return _gyro_of(self._native.copy(), self._start)

    def __deepcopy__(self, memo: Any) -> Gyro:
        return self.__copy__()

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (*self._start, self.state())

    def __repr__(self) -> str:
        return f"<beamgyro.Gyro {self.device.name} at {self.now().time:g} s>"


def _gyro_of(native: _core.Gyro, start: tuple[Device, dict[str, Any]]) -> Gyro:
    made = Gyro.__new__(Gyro)
    made._native = native
    made._start = start
    return made


def _restored(device: Device, start: dict[str, Any], state: bytes) -> Gyro:
    made = start_gyro(device, **start)
    made.restore(state)
    return made


def start_gyro(device: Device, *, seed: int = 0,
               temperature_degC: Optional[float] = None, noise: bool = True,
               noise_rate_Hz: float = 0.0, fidelity: str = "quasistatic",
               stirred: bool = False, age_hours: Optional[float] = None,
               history: Sequence[tuple[float, float]] = (),
               rate: float = 0.0, cross_rate_x: float = 0.0,
               cross_rate_y: float = 0.0, acceleration_x: float = 0.0,
               acceleration_y: float = 0.0, acceleration_z: float = 0.0,
               ambient: Optional[float] = None,
               powered: bool = True) -> Gyro:
    """Return the gyro of a device; see `Device.start`."""
    number = _arguments.number
    given = {key: value for key, value in locals().items()
             if key not in ("device", "number")}
    own = (None if temperature_degC is None
           else number(temperature_degC, "temperature_degC"))
    if ambient is None:
        ambient = 25.0 if own is None else own
    motion = [number(value, name) for name, value in (
        ("rate", rate), ("cross_rate_x", cross_rate_x),
        ("cross_rate_y", cross_rate_y), ("acceleration_x", acceleration_x),
        ("acceleration_y", acceleration_y),
        ("acceleration_z", acceleration_z), ("ambient", ambient))]
    native = _core.Gyro.start(
        device._native, _checks.text(fidelity, "fidelity"),
        _arguments.seed(seed, _arguments.LARGEST_TOML_SEED), bool(noise),
        number(noise_rate_Hz, "noise_rate_Hz"), bool(stirred),
        own,
        None if age_hours is None else number(age_hours, "age_hours"),
        [(number(t, "history"), number(T, "history")) for t, T in history],
        motion, bool(powered))
    return _gyro_of(native, (device, given))


def _arrays(inputs: Mapping[str, Series], count: Optional[int]
            ) -> dict[str, npt.NDArray[np.float64]]:
    """Return inputs as arrays of one length: `count`, or that of the arrays."""
    arrays: dict[str, npt.NDArray[np.float64]] = {}
    for name, value in inputs.items():
        if name not in _INPUTS:
            raise ValueError(f"input {_checks.shown(name)}: is none; expected "
                             f"one of {', '.join(_INPUTS)}")
        if name in _UNITS:
            _arguments.require_unit(value, name, _UNITS[name])
        try:
            array = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise ValueError(f"{name}: {error}; expected numbers") from None
        if array.ndim > 1:
            raise ValueError(f"{name} has {array.ndim} dimensions; expected "
                             "one")
        arrays[name] = (_arguments.in_degC(array, value, name)
                        if name == "ambient" else array)
    lengths = {name: len(values) for name, values in arrays.items()
               if values.ndim == 1}
    if count is None:
        if not lengths:
            raise ValueError("no input is an array; expected one with a value "
                             "for each step")
        count = next(iter(lengths.values()))
    for name, length in lengths.items():
        if length != count or length == 0:
            raise ValueError(f"{name} has {length} values; expected "
                             f"{count or 'at least 1'}")
    return {name: np.broadcast_to(values, (count,))
            for name, values in arrays.items()}


def step_all(gyros: Sequence[Gyro], *, dt: float, jobs: int = 1,
             **inputs: Union[Series, tuple[Series, Series]]
             ) -> dict[str, npt.NDArray[Any]]:
    """Take one step of several gyros together.

    >>> gyros = [device.start(seed=k) for k in range(100)]
    >>> out = bg.step_all(gyros, rate=np.linspace(-50, 50, 100), dt=0.01)
    >>> out["rate"]

    All of them make the step, or, if one cannot, none.

    Args:
        gyros: different gyros.
        dt: the duration of the step [s].
        jobs: threads; 0: one for each core.
        **inputs: as of `Gyro.step`: a number for all gyros, or an array with
            one for each; a pair of these in a tuple for a straight line.

    Returns:
        Arrays with a value for each gyro: what they show, ``status``,
        ``time`` and the truth, under the names of recordings.

    Raises:
        ValueError, RuntimeError: as `Gyro.step`, with the number of the gyro.
    """
    natives = []
    for gyro in gyros:
        if not isinstance(gyro, Gyro):
            raise ValueError(f"gyros: {_checks.shown(gyro)} is none; expected "
                             "gyros that Device.start has made")
        natives.append(gyro._native)
    pairs = {name: value if isinstance(value, tuple) else (value, value)
             for name, value in inputs.items()}
    for name, pair in pairs.items():
        if len(pair) != 2:
            raise ValueError(f"{name} is a tuple of {len(pair)}; expected a "
                             "pair, of the begin and the end of the step")
    begin, end = (
        _arrays({name: pair[k] for name, pair in pairs.items()}, len(natives))
        for k in (0, 1))
    return _core.step_all(natives, _arguments.number(dt, "dt"), begin, end,
                          _arguments.jobs(jobs))
