# SPDX-License-Identifier: MIT
"""The kinds of files that have a picture, told by what is in a file."""

from __future__ import annotations

import json
import os
import pathlib
from dataclasses import dataclass
from typing import Any, Callable, Iterator, Sequence

from matplotlib.figure import Figure

from . import (allan, compensator, device_set, plan, recording, scores,
               sensitivity, style, table, validation)
from .errors import PlotError

Source = Any  # what a kind reads from a file


@dataclass(frozen=True)
class Kind:
    """How the files of a kind are read and drawn."""

    name: str
    read: Callable[[pathlib.Path], Source]
    draw: Callable[[Figure, Any], None]
    height: Callable[[Any], float]
    compares: bool = False  # draw() and height() take a list
    each: Callable[[Source], Iterator[tuple[str, Figure]]] | None = None


def _read_json(path: pathlib.Path) -> dict[str, Any]:
    try:
        data = json.loads(path.read_text())
    except (ValueError, RecursionError) as error:
        raise PlotError(f"{path}: no JSON: {error}") from None
    if not isinstance(data, dict):
        raise PlotError(f"{path}: no JSON object; expected what a command "
                        "wrote to --json")
    data["name"] = path.name
    return data


def _draw_recordings(figure: Figure, runs: Sequence[recording.Run]) -> None:
    recording.draw(figure, runs[0] if len(runs) == 1 else runs)


def _height_of_recordings(runs: Sequence[recording.Run]) -> float:
    return recording.height(runs[0] if len(runs) == 1 else runs)


KINDS = {
    "recording": Kind("recording", recording.read, _draw_recordings,
                      _height_of_recordings, True),
    "table": Kind("table of characterise", table.read, table.draw,
                  lambda _: table.HEIGHT, True),
    "allan": Kind("Allan deviation", _read_json, allan.draw,
                  lambda _: allan.HEIGHT, True),
    "compensator": Kind("compensator", _read_json, compensator.draw,
                        compensator.height, True),
    "set": Kind("set", device_set.read, device_set.draw, device_set.height),
    "validation": Kind("validation", _read_json, validation.draw,
                       validation.height, each=validation.each),
    "scores": Kind("scores", _read_json, scores.draw, scores.height),
    "plan": Kind("plan", _read_json, plan.draw, lambda _: plan.HEIGHT),
    "sensitivity": Kind("sensitivity", _read_json, sensitivity.draw,
                        sensitivity.height, each=sensitivity.each),
}

EXPECTED = ("a recording (.h5, .csv), a table of characterise, a compensator, "
            "a set, or the --json of allan, validate, plan or sensitivity")


def kind_of(path: str | os.PathLike[str]) -> str:
    """The key in KINDS of a file or directory. Raises PlotError when it has
    no picture."""
    path = pathlib.Path(path)
    if path.is_dir():
        if (path / "manifest.jsonl").exists():
            return "set"
        raise PlotError(f"{path}: a directory without manifest.jsonl; "
                        "expected that of a whole set")
    try:
        with open(path, "rb") as file:
            head = file.read(65536)
    except OSError as error:
        raise PlotError(f"{path}: {error.strerror}") from None
    kind = _kind_of_head(path, head)
    if kind is None:
        raise PlotError(f"{path}: has no picture; expected {EXPECTED}")
    return kind


def _kind_of_head(path: pathlib.Path, head: bytes) -> str | None:
    if head.startswith(b"\x89HDF"):
        return _kind_of_hdf5(path)
    if head.lstrip().startswith(b"{"):
        return _kind_of_json(_read_json(path))
    names = [name.partition(b"[")[0].strip() for name in
             head.removeprefix(b"\xef\xbb\xbf").split(b"\n")[0].split(b",")]
    if names[:2] == [b"temperature_degC", b"bias_deg_per_s"]:
        return "table"
    return "recording" if {b"time", b"status"} <= set(names) else None


def _kind_of_hdf5(path: pathlib.Path) -> str | None:
    import h5py
    try:
        with h5py.File(path) as file:
            filetype = file.attrs.get("filetype", b"")
    except OSError as error:
        raise PlotError(f"{path}: HDF5 cannot read it: {error}") from None
    if isinstance(filetype, bytes):
        filetype = filetype.decode(errors="replace")
    return {"beamgyro-recording": "recording", "beamgyro-set": "set"}.get(
        str(filetype))


def _kind_of_json(data: dict[str, Any]) -> str | None:
    filetypes = {"beamgyro-compensator": "compensator",
                 "beamgyro-validation": "validation"}
    if data.get("filetype") in filetypes:
        return filetypes[data["filetype"]]
    members = {"plan": {"schedule", "trade_off"},
               "sensitivity": {"figures", "campaign", "temperatures"},
               "allan": {"series", "noise"}}
    for kind, names in members.items():
        if names <= data.keys():
            return kind
    if any(data.get(name) for name in allan.KINDS):
        return "allan"
    if {"runs", "overall", "method"} <= data.keys() or \
            {"devices", "set", "manifest_sha256"} <= data.keys():
        return "scores"
    return None


def figure_of(kind: str, sources: Sequence[Source]) -> Figure:
    """The picture of one source, or of several over each other."""
    known = KINDS[kind]
    data = list(sources) if known.compares else sources[0]
    figure = style.new_figure(known.height(data))
    known.draw(figure, data)
    return figure
