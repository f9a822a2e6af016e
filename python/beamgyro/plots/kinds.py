# SPDX-License-Identifier: MIT
"""The kinds of files that have a picture, told by what is in a file."""

from __future__ import annotations

import csv
import os
import pathlib
from dataclasses import dataclass
from typing import Any, Callable, Iterator, Sequence

from matplotlib.figure import Figure

from . import (allan, compensator, curves, device_set, documents, hdf5, plan,
               recording, sensitivity, style, table, validation)
from .documents import PlotError

Source = Any  # what a kind reads from a file


@dataclass(frozen=True)
class Kind:
    """How the files of a kind are read and drawn."""

    name: str
    read: Callable[[pathlib.Path, str], Source]
    draw: Callable[[Figure, Any], None]
    height: Callable[[Any], float]
    compares: bool = False  # draw() and height() take a list
    shape: documents.Shape | None = None  # of a JSON document
    each: Callable[[Source], Iterator[tuple[str, Figure]]] | None = None
    completed: Callable[[Source, object], Source] | None = None

    def checked(self, source: Source, where: object) -> Source:
        """What is drawn of a source. Raises PlotError where it is wrong."""
        if self.shape is not None:
            documents.check(source, self.shape, where)
        return self.completed(source, where) if self.completed else source


KINDS = {
    "recording": Kind("recording", recording.read, recording.draw,
                      recording.height, True),
    "table": Kind("table of characterise", table.read, table.draw,
                  lambda _: table.HEIGHT, True),
    "curves": Kind("curves of a population", curves.read, curves.draw,
                   curves.height),
    "allan": Kind("Allan deviation", documents.read, allan.draw,
                  lambda _: allan.HEIGHT, True, allan.SHAPE),
    "compensator": Kind("compensator", documents.read, compensator.draw,
                        compensator.height, True,
                        completed=compensator.with_curve),
    "set": Kind("set", device_set.read, device_set.draw, device_set.height),
    "validation": Kind("validation", documents.read, validation.draw,
                       validation.height, False, validation.SHAPE,
                       validation.each),
    "plan": Kind("plan", documents.read, plan.draw, lambda _: plan.HEIGHT,
                 False, plan.SHAPE),
    "sensitivity": Kind("sensitivity", documents.read, sensitivity.draw,
                        sensitivity.height, False, sensitivity.SHAPE,
                        sensitivity.each),
}

EXPECTED = ("a recording (.h5, .csv), what characterise wrote, a compensator, a "
            "set, or the --json of allan, validate, plan or sensitivity")


def kind_of(path: str | os.PathLike[str]) -> str:
    """The key in KINDS of a file or directory. Raises PlotError when it has
    no picture."""
    path = pathlib.Path(path)
    if path.is_dir():
        if (path / device_set.MANIFEST).exists():
            return "set"
        raise PlotError(f"{path}: a directory without manifest.jsonl; "
                        "expected that of a whole set")
    try:
        if path.exists() and not path.is_file():  # a pipe would be waited for
            raise PlotError(f"{path}: is no file; expected {EXPECTED}")
        with open(path, "rb") as file:
            head = file.read(65536)
    except OSError as error:
        raise PlotError(f"{path}: {error.strerror}") from None
    kind = _kind_of_head(path, head)
    if kind is None:
        if path.suffix.lower() == ".csv":
            missing = [name for name in ("time", "status")
                       if name not in _columns(head)]
            raise PlotError(
                f"{path}: no column {' and none '.join(missing)}; expected a "
                "recording or a table of characterise as beamgyro writes "
                "them; beamgyro import makes a recording of another log")
        raise PlotError(f"{path}: has no picture; expected {EXPECTED}")
    return kind


def _kind_of_head(path: pathlib.Path, head: bytes) -> str | None:
    if head.startswith(b"\x89HDF"):
        return _kind_of_hdf5(path)
    if head.lstrip().startswith(b"{"):
        return _kind_of_json(documents.read(path))
    names = _columns(head)
    if names[:2] == ["temperature_degC", "bias_deg_per_s"]:
        return "table"
    if names[:1] == ["temperature_degC"] and names[1:] and \
            curves.COLUMN.fullmatch(names[1]):
        return "curves"
    return "recording" if {"time", "status"} <= set(names) else None


def _columns(head: bytes) -> list[str]:
    """The names in the first line of a CSV, without their units."""
    line = head.decode("utf-8-sig", "replace").partition("\n")[0]
    return [name.partition("[")[0].strip() for name in
            next(csv.reader([line]), [])]


def _kind_of_hdf5(path: pathlib.Path) -> str | None:
    with hdf5.opened(path) as file:
        filetype = hdf5.text_of(file.attributes.get("filetype", ""))
    return {"beamgyro-recording": "recording", "beamgyro-set": "set",
            "beamgyro-curves": "curves"}.get(filetype)


def _kind_of_json(data: dict[str, Any]) -> str | None:
    filetypes = {"beamgyro-compensator": "compensator",
                 "beamgyro-validation": "validation"}
    filetype = str(data.get("filetype"))
    if filetype in filetypes:
        return filetypes[filetype]
    members = {"plan": {"schedule", "trade_off"},
               "sensitivity": {"figures", "campaign", "temperatures"},
               "allan": {"series", "noise"}}
    for kind, names in members.items():
        if names <= data.keys():
            return kind
    return "allan" if any(data.get(name) for name in allan.KINDS) else None


def figure_of(kind: str, sources: Sequence[Source]) -> Figure:
    """The picture of one source, or of several over each other."""
    known = KINDS[kind]
    data = list(sources) if known.compares else sources[0]
    figure = style.new_figure(known.height(data))
    known.draw(figure, data)
    return figure
