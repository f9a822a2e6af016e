# SPDX-License-Identifier: MIT
"""Validation of compensators."""

from __future__ import annotations

import inspect
import os
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

from beamgyro import _arguments, _checks, _core, _shipped, _toml
from beamgyro._campaign import with_written_scenarios
from beamgyro._compensation import Compensator, compensator_of
from beamgyro._dataset import Path, recording_of
from beamgyro._device import DeviceLike, device_of
from beamgyro._own_metrics import own_metrics
from beamgyro._progress import ProgressArgument, watched
from beamgyro._set import Set
from beamgyro._training import Runs, model_of, named_runs
from beamgyro._validation_result import ValidationResult
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import xarray as xr


class _Files:
    """Files of what is in memory, for the duration of a call."""

    def __init__(self) -> None:
        self._directory: Optional[tempfile.TemporaryDirectory[str]] = None

    def __enter__(self) -> _Files:
        return self

    def __exit__(self, kind: object, error: Optional[BaseException],
                 traceback: object) -> None:
        if self._directory is None:
            return
        self._directory.cleanup()
        if isinstance(error, (ValueError, RuntimeError)):
            error.args = tuple(self._named(one) for one in error.args)
        notes = getattr(error, "__notes__", [])
        notes[:] = [self._named(note) for note in notes]

    def _named(self, message: Any) -> Any:
        """Return a message that calls what was in memory by its name."""
        if self._directory is None or not isinstance(message, str):
            return message
        return message.replace(self._directory.name + os.sep, "")

    def _path(self, name: str) -> str:
        if self._directory is None:
            try:
                self._directory = tempfile.TemporaryDirectory(
                    prefix="beamgyro-")
            except OSError as error:
                raise RuntimeError("cannot make a temporary directory: "
                                   f"{error.strerror}") from None
        return os.path.join(self._directory.name, name)

    def of_run(self, name: str, run: Union[xr.Dataset, Path]) -> str:
        """Return the file of a recording."""
        if isinstance(run, (str, os.PathLike)):
            return _checks.file(run, "runs", "a recording")
        # Never as CSV, which has no place for the text of the device.
        path = self._path(name if name.endswith(".h5") else f"{name}.h5")
        if os.path.exists(path):
            raise ValueError(f"{os.path.basename(path)}: is the name of two "
                             "runs; expected a name of its own for each")
        recording_of(run, name).write(path)
        return path

    def of_text(self, name: str, text: str) -> str:
        """Return a TOML file with a text."""
        path = self._path(name if name.endswith(".toml") else f"{name}.toml")
        try:
            FilePath(path).write_text(text, encoding="utf-8")
        except OSError as error:
            raise RuntimeError(f"{path}: cannot write: {error.strerror}"
                               ) from None
        return path

    def of_qualification(self, name: str,
                         table: Union[Path, Mapping[str, Any]],
                         kind: str) -> str:
        """Return the file of a nested mapping, whose scenarios are files named
        from the current directory, mappings or objects; or of a kind."""
        if not _checks.is_table(table):
            return self.of_table(name, table, kind)
        folder = os.path.dirname(self._path(name))
        return self.of_text(name, _toml.text({
            **table, **{part: with_written_scenarios(table[part], folder,
                                                     part, name)
                        for part in ("run", "training") if part in table}}))

    def of_specification(self, name: str,
                         table: Union[Path, Mapping[str, Any]],
                         kind: str) -> str:
        """Return the file of a nested mapping, which needs no name and no
        source of its limits; or of a kind."""
        if not _checks.is_table(table):
            return self.of_table(name, table, kind)
        return self.of_table(
            name, {"name": "mine", **_with_sources(table)}, kind)

    def of_table(self, name: str, table: Union[Path, Mapping[str, Any]],
                 kind: str) -> str:
        """Return the file of a nested mapping, or of a kind."""
        if _checks.is_table(table):
            return self.of_text(name, _toml.text(table))
        return _checks.file(table, name, kind, _checks.MAPPING)


def validate(compensator: Any, runs: Optional[Runs] = None, *,
             set: Union[Set, Path, None] = None,
             device: Optional[DeviceLike] = None, jobs: int = 0,
             progress: ProgressArgument = False,
             **options: Any) -> ValidationResult:
    """Judge a compensator by every metric, check and limit.

    Give recordings, or a set, or a device that is simulated. The verdict is
    that of ``beamgyro validate`` with the same inputs. Compensators of Python
    are called by one thread at a time, with measured signals only.

    Args:
        compensator: a `Compensator`, or what makes one; with `device` also a
            model file or a mapping with its contents, which is trained first.
        runs: recordings that training has not seen.
        set: a set, whose test devices are judged.
        device: the device that a qualification is simulated with.
        jobs: threads; 0: one for each core.
        progress: True for a bar on standard error, or a function that is
            called with the share of the work that is done, from 0 to 1.
        options: further options, below. A specification or a
            qualification may also be a mapping with its contents.

    Returns:
        The result, which prints as a table; ``passed`` tells the verdict.

    Raises:
        ValueError: something is wrong in the input.
        RuntimeError: a simulation or the compensator cannot go on.
    """
    if sum(one is not None for one in (runs, set, device)) != 1:
        raise ValueError("nothing to validate on, or too much; expected one "
                         "of runs, set= and device=")
    if isinstance(runs, Set):
        raise _checks.wrong(runs, "runs", "recordings; a set is given as set=")
    with _Files() as files, watched(progress, "validating") as function:
        given: dict[str, Any] = {"jobs": _arguments.jobs(jobs)}
        for keyword, value in options.items():
            if keyword not in _OPTIONS:
                raise TypeError("validate() got an unexpected keyword "
                                f"argument '{keyword}'")
            option = _OPTIONS[keyword]
            if value is not None:
                given[option.member] = option.read(files, value)
        if runs is not None:
            given["recordings"] = [files.of_run(name, run)
                                   for name, run in named_runs(runs)]
        elif set is not None:
            given["set"] = (set if isinstance(set, Set) else Set(set))._native
        else:
            assert device is not None
            given["device"] = device_of(device)._native
            given.setdefault("qualification", _shipped.file(
                "scenarios/qualification.toml"))
        found = _judged(compensator, given, function)
    text, json_text, warnings, page, junit, trained = found
    warn(warnings)
    return ValidationResult(
        text, json_text, warnings, page, junit,
        Compensator.parse(trained, "trained.json") if trained else None)


def _with_sources(table: Mapping[str, Any]) -> dict[str, Any]:
    """A specification whose limits state where they come from."""
    def sourced(part: Any) -> Any:
        if not isinstance(part, Mapping):
            return part
        if "min" in part or "max" in part:
            return {**part, "source": part.get("source", "not stated")}
        return {name: sourced(inner) for name, inner in part.items()}

    return {name: sourced(part) if name.startswith("limits") else part
            for name, part in table.items()}


class _Option(NamedTuple):
    """An option of `validate`, from the table of the compiled part."""

    keyword: str
    member: str
    type: str
    kind: str
    subjects: list[str]
    words: str

    def read(self, files: _Files, value: Any) -> Any:
        """Return a value of its type."""
        if self.type == "file":
            if self.kind == "a specification":
                return files.of_specification(self.keyword, value, self.kind)
            if self.kind == "a qualification":
                return files.of_qualification(self.keyword, value, self.kind)
            if not self.kind:
                return _checks.path(value, self.keyword)
            return _checks.file(value, self.keyword, self.kind)
        if self.type == "functions":
            return own_metrics(value, self.keyword)
        if self.type == "files":
            return _checks.paths(value, self.keyword)
        if self.type == "number":
            return _arguments.number(value, self.keyword, above=0)
        if self.type == "seed":
            if isinstance(value, str) and value == "random":
                return _core.random_seed()
            if isinstance(value, str):
                raise _checks.wrong(value, self.keyword,
                                    'a whole number, or "random"')
            return _arguments.seed(value, _arguments.LARGEST_JSON_SEED)
        if self.type == "whole":
            return _arguments.count(value, self.keyword)
        if self.type == "flag":
            return _checks.flag(value, self.keyword)
        return (_checks.texts if self.type == "texts"
                else _checks.wholes)(value, self.keyword)

    def parameter(self) -> inspect.Parameter:
        """Return it as a part of a signature."""
        types = {"file": Union[Path, Mapping[str, Any], None]
                 if self.kind == "a specification" else Optional[Path],
                 "number": Optional[float], "whole": Optional[int],
                 "seed": Union[int, str, None], "texts": Iterable[str],
                 "wholes": Iterable[int], "files": Iterable[Path],
                 "flag": bool,
                 "functions": Optional[Mapping[str, Any]]}
        return inspect.Parameter(
            self.keyword, inspect.Parameter.KEYWORD_ONLY,
            default=False if self.type == "flag" else
            () if self.type in ("texts", "wholes", "files") else None,
            annotation=types[self.type])


_OPTIONS = {row[0]: _Option(*row) for row in _core.validation_members()}


def _describe_options() -> None:
    """Show the options of `validate` in its help and its signature."""
    signature = inspect.signature(validate)
    named = [one for one in signature.parameters.values()
             if one.kind is not inspect.Parameter.VAR_KEYWORD]
    setattr(validate, "__signature__", signature.replace(
        parameters=named + [one.parameter() for one in _OPTIONS.values()]))
    lines = [f"        {one.keyword}: {one.words[:1].lower()}{one.words[1:]}; "
             f"with {' or '.join(one.subjects)}." for one in _OPTIONS.values()]
    text = validate.__doc__ or ""
    validate.__doc__ = text.replace(
        "\n    Returns:", "\n    Options:\n" + "\n".join(lines)
        + "\n\n    Returns:", 1)


_describe_options()


def _judged(compensator: Any, options: dict[str, Any],
            function: Any) -> tuple[str, str, list[str], str, str, str]:
    is_model = _checks.is_table(compensator) or (
        isinstance(compensator, (str, os.PathLike))
        and _core.source_kind(os.fsdecode(compensator)) == "model")
    if is_model:
        return _core.validate_model(model_of(compensator), options, function)
    if isinstance(compensator, (str, os.PathLike)):
        compensator = Compensator(
            compensator, plugin_files=options.get("plugin_files", ()),
            require_isolation=options.get("require_isolation", False))
    return _core.validate(compensator_of(compensator)._native, options,
                          function)
