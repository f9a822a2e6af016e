# SPDX-License-Identifier: MIT
"""Compensators: trained ones, programs, and those of Python."""

from __future__ import annotations

import functools
import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

from beamgyro import _adapters, _arguments, _checks, _core
from beamgyro._dataset import Path, core_recording, dataset_of
from beamgyro._native import Native, Wrapper
from beamgyro._shipped import program
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import xarray as xr


class Compensator(Wrapper):
    """What makes a rate without drift of the measured signals of a gyro.

    Args:
        source: one of

            - a compensator file (.json), as `train` writes it;
            - a shared library (.so) with the functions of beamgyro/plugin.h,
              or a command, ``"cmd:PROGRAM ARGS"``;
            - a function that takes the measured signals of a stretch from a
              power-on to the next loss of power (a dataset, or with `arrays`
              a dictionary of arrays) and returns the compensated rate of
              each sample [degree/s], or (rates, sigmas);
            - an estimator of scikit-learn that predicts the bias [degree/s]
              from `inputs`, a column each;
            - a torch module that computes the bias from a tensor of them.
              It answers in eval mode; the mode of each of its modules is then
              as before.

            A function, an estimator or a network owns what it is given and
            may write into it. Validation calls it many times, also with
            changed signals and with parts of a run: it must keep nothing from
            one call to the next.
        inputs: of an estimator or a network: its features, as model files
            name them ("temperature", "temperature_lowpass(100)",
            "since_power_on(300)", ...); by default its attribute
            ``beamgyro_inputs``, the names that it was fitted to, or the
            temperature. Of a function: the measured variables that it is
            given, by default all.
        arrays: whether a function takes arrays in place of a dataset.
        name: for reports.
        stall_s: how long a program may take to answer [s].
        plugin_files: files and folders that a program may read beside those
            of the system and the scripts that it names.
        require_isolation: whether a program that cannot be isolated is
            refused.

    A command is isolated, and ends with this process however that ends, where
    the program `beamgyro` is beside the package or on PATH. Without it a
    command runs on when this process is killed by SIGKILL.

    Raises:
        ValueError: `source` is none of these, or cannot be read.
    """

    __slots__ = ("_source",)

    _native: _core.RateCompensator

    def __init__(self, source: Any, *,
                 inputs: Optional[Sequence[str]] = None,
                 arrays: bool = False, name: Optional[str] = None,
                 stall_s: float = 10.0, plugin_files: Iterable[Path] = (),
                 require_isolation: bool = False) -> None:
        stall_s = _arguments.number(stall_s, "stall_s", above=0)
        files = _checks.paths(plugin_files, "plugin_files")
        self._source: dict[str, Any] = {
            "source": source, "inputs": inputs, "arrays": arrays,
            "name": name, "stall_s": stall_s, "plugin_files": files,
            "require_isolation": require_isolation}
        if not isinstance(source, (Compensator, str, os.PathLike)):
            self._native = _of_python(source, inputs, arrays, name)
            return
        _checks.refuse("for a function, an estimator or a network",
                       inputs=inputs, arrays=arrays or None, name=name)
        if isinstance(source, Compensator):
            self._native = source._native
            self._source = getattr(source, "_source", {})
        else:
            self._native = _opened(source, stall_s, files,
                                   bool(require_isolation))

    @classmethod
    def parse(cls, text: str,
              name: str = "compensator.json") -> Compensator:
        """Read the text of a compensator file, called `name` in messages."""
        return cls._parsed(_checks.text(text, "text"),
                           _checks.text(name, "name"))

    def _trained(self, what: str) -> _core.Compensator:
        if isinstance(self._native, _core.Compensator):
            return self._native
        raise ValueError(
            f"{self.name}: has no {what}; expected a trained compensator")

    name = Native(str, "The name that reports give it.")
    inputs = Native(list[str],
                 "The measured variables that it reads; none: all there are.")

    @property
    def text(self) -> str:
        """The text of the file of a trained compensator."""
        return self._trained("text").text

    @property
    def method(self) -> str:
        """How a trained compensator was fitted."""
        return self._trained("method").method

    @property
    def temperature_range(self) -> tuple[float, float]:
        """The temperatures that its training saw [degC]."""
        core = self._trained("range")
        return core.lowest_temperature, core.highest_temperature

    def save(self, path: Path) -> None:
        """Write the file of a trained compensator.

        From then on it has the name of the file, as if it had been read from
        there: reports, pictures and exported sources call it so.

        Raises:
            ValueError: it was not trained, or the name cannot be written.
            RuntimeError: writing failed.
        """
        core = self._trained("file")
        file = _checks.path(path, "path")
        core.write(file)
        self._native = _core.Compensator.parse(core.text,
                                               os.path.basename(file))

    def _identity(self) -> Any:
        core = self._native
        return core.text if isinstance(core, _core.Compensator) else id(core)

    def __repr__(self) -> str:
        method = (f", {self._native.method}"
                  if isinstance(self._native, _core.Compensator) else "")
        return f"<beamgyro.Compensator {self.name}{method}>"

    def _rows(self) -> list[tuple[str, str]]:
        rows = [("name", self.name),
                ("inputs", ", ".join(self.inputs) or "all that are measured")]
        if not isinstance(self._native, _core.Compensator):
            return rows
        low, high = self.temperature_range
        return rows + [
            ("method", self.method),
            ("temperatures of its training", f"{low:.4g} to {high:.4g} degC"),
            ("warnings", "; ".join(self._native.warnings) or "none")]

    def __reduce__(self) -> tuple[Any, ...]:
        if isinstance(self._native, _core.Compensator):
            return Compensator.parse, (self._native.text, self.name)
        if isinstance(self._source["source"], (str, os.PathLike)):
            return Compensator._unopened, (self._source,)
        return functools.partial(Compensator, **self._source), ()

    @classmethod
    def _unopened(cls, source: dict[str, Any]) -> Compensator:
        """Return a library or a command that runs when it is first used, and
        not when it is unpickled."""
        made = cls.__new__(cls)
        made._source = source
        return made

    def __getattr__(self, name: str) -> Any:
        if name != "_native":
            raise AttributeError(
                f"{type(self).__name__!r} object has no attribute {name!r}")
        source = self._source
        self._native = _opened(source["source"], source["stall_s"],
                               source["plugin_files"],
                               source["require_isolation"])
        return self._native


def _opened(source: Path, stall_s: float, plugin_files: list[str],
            require_isolation: bool) -> _core.RateCompensator:
    text = os.fspath(source)
    argument = (_checks.command(text, "compensator")
                if isinstance(text, str) and text.startswith("cmd:")
                else _checks.file(source, "compensator", "a compensator"))
    return _core.open_compensator(argument, program(), stall_s, plugin_files,
                                  require_isolation)


def _of_python(source: Any, inputs: Optional[Sequence[str]], arrays: bool,
               name: Optional[str]) -> _core.RateCompensator:
    if isinstance(source, type):
        raise ValueError(
            f"compensator {_checks.shown(source)}: is a class; expected an "
            f"instance of it, such as {source.__name__}()")
    called = (_checks.text(name, "name") if name is not None else
              str(getattr(source, "__name__", type(source).__name__)))
    if _adapters.is_torch_module(source) or _adapters.is_estimator(source):
        features = _adapters.inputs_of(source, inputs)
        make = (_adapters.answering_network
                if _adapters.is_torch_module(source)
                else _adapters.answering_estimator)
        return _core.function_compensator(
            called, _adapters.measured_columns(features),
            make(source, features, called))
    if callable(source):
        return _core.function_compensator(
            called, [] if inputs is None else _checks.texts(inputs, "inputs"),
            _adapters.answering_function(source, arrays, called))
    raise ValueError(
        f"compensator {_checks.shown(source)}: is no compensator; expected a "
        "file, a function, an estimator with predict() or a torch module")


def compensator_of(source: Any) -> Compensator:
    """Return anything that compensates as a Compensator."""
    return source if isinstance(source, Compensator) else Compensator(source)


def compensate(compensator: Any, recording: Union[xr.Dataset, Path]
               ) -> xr.Dataset:
    """Add what a compensator answers to a recording.

    Args:
        compensator: a `Compensator`, or what makes one.
        recording: a dataset of `run` or `open_recording`, or a file.

    Returns:
        The recording with ``compensated_rate`` and, where the compensator
        states it, ``compensated_rate_sigma`` (degree/s).

    Raises:
        ValueError: the recording lacks an input, or was compensated already.
        RuntimeError: the compensator did not answer as it should.
    """
    core, warnings = _core.compensate(compensator_of(compensator)._native,
                                      core_recording(recording))
    warn(warnings)
    return dataset_of(core)
