# SPDX-License-Identifier: MIT
"""Gyros, as device files describe them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Optional, Union

from beamgyro import _checks, _core, _toml
from beamgyro._checks import Path as Path
from beamgyro._native import Native, Wrapper

if TYPE_CHECKING:
    from beamgyro._gyro import Gyro

Keys = Mapping[str, Any]
DeviceLike = Union["Device", Path, Keys]


class Device(Wrapper):
    """A gyro: what a device file says, read and checked.

    It does not change. Two devices are equal when their texts and their
    replaced keys are; a device pickles as these.

    Args:
        source: a device file, or its contents as a nested mapping.
        set: keys to replace, dotted or nested:
            ``{"beam.length_m": 0.041}``.

    Raises:
        ValueError: with file, line and key, what is wrong.
    """

    __slots__ = ()

    _native: _core.Device

    def __init__(self, source: DeviceLike,
                 set: Optional[Keys] = None) -> None:
        overrides = _toml.overrides(set)
        if isinstance(source, Device):
            self._native = (source._native.with_(overrides) if overrides
                          else source._native)
        elif _checks.is_table(source):
            self._native = _core.Device.parse(_toml.text(source), "device",
                                              overrides)
        else:
            self._native = _core.Device.read(
                _checks.file(source, "device", "a device file",
                             _checks.MAPPING),
                overrides)

    @classmethod
    def parse(cls, text: str, name: str = "device",
              set: Optional[Keys] = None) -> Device:
        """Read the text of a device file, called `name` in messages."""
        return cls._parsed(_checks.text(text, "text"),
                           _checks.text(name, "name"), _toml.overrides(set))

    def with_(self, keys: Optional[Keys] = None, /, **more: Any) -> Device:
        """Return the device with further keys replaced.

        >>> device.with_({"beam.length_m": 0.041})
        >>> device.with_(beam={"length_m": 0.041})
        """
        return Device._of(
            self._native.with_(_toml.overrides(_toml.merged(keys, more))))

    def start(self, *, seed: int = 0,
              temperature_degC: Optional[float] = None, noise: bool = True,
              noise_rate_Hz: float = 0.0, fidelity: str = "quasistatic",
              **others: Any) -> Gyro:
        """Start the gyro, to be stepped inside another simulation.

        >>> gyro = device.start(seed=1)
        >>> gyro.step(rate=10.0, ambient=25.0, dt=0.01).rate

        Args:
            seed: the seed of everything random.
            temperature_degC: of every part of the gyro at the start [degC];
                without, that of the ambient.
            noise: whether there is noise.
            noise_rate_Hz: the noise changes at this rate [Hz] and holds in
                between, so steps may be cut anywhere; at the output rate of a
                scenario it is that of its run. 0: one over the first ``dt``.
            fidelity: "quasistatic", the only one so far.
            **others: ``stirred``, whether a fan moves the air; ``age_hours``
                since the factory trim; ``history`` of a gyro that remembers,
                pairs of time [s], up to 0, and temperature [degC]; and what
                acts at the start, and has for long, under the names of
                `Gyro.step`.

        Raises:
            ValueError: a value is out of range.
            RuntimeError: the drive loop of this gyro cannot lock.
        """
        from beamgyro._gyro import start_gyro
        return start_gyro(self, seed=seed, temperature_degC=temperature_degC,
                          noise=noise, noise_rate_Hz=noise_rate_Hz,
                          fidelity=fidelity, **others)

    text = Native(str, "The text of the device file.")
    name = Native(str, "The name of the file, as messages give it.")
    overrides = Native(list[str], "The keys that were replaced, as KEY=VALUE.")

    def _identity(self) -> Any:
        return self.text, tuple(self.overrides)

    def __repr__(self) -> str:
        changes = "".join(f", {text}" for text in self.overrides)
        return f"<beamgyro.Device {self.name}{changes}>"

    def _rows(self) -> list[tuple[str, str]]:
        rows = [("name", self.name),
                ("replaced keys", ", ".join(self.overrides) or "none")]
        try:
            found = _core.characterise(self._native, [25.0])["columns"]
        except RuntimeError as error:  # the drive loop does not lock
            return [*rows, ("at 25 degC", str(error))]
        return rows + [(f"{words} at 25 degC",
                        f"{found[name][0][0]:.6g} {unit}".strip())
                       for name, words, unit in (
                           ("drive_frequency", "drive frequency", "Hz"),
                           ("split", "sense less drive mode", "Hz"),
                           ("q_drive", "quality factor", ""),
                           ("bias", "bias", "deg/s"))]

    def __reduce__(self) -> tuple[Any, ...]:
        return Device._parsed, (self.text, self.name, self.overrides)


def device_of(source: DeviceLike) -> Device:
    """Return a device of anything that tells one."""
    return source if isinstance(source, Device) else Device(source)
