# SPDX-License-Identifier: MIT
"""Pictures of what beamgyro writes.

    from beamgyro import plots
    plots.plot("warm_up.h5").savefig("warm_up.png")
    plots.plot(["cubic.json", "bp.json"], compare=True)

Each function returns a matplotlib Figure. It needs numpy, h5py and matplotlib,
and of the compiled part of the package the curves of compensators only.
"""

from __future__ import annotations

import os
import pathlib
from typing import Any, Mapping, Sequence, Union

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .documents import PlotError
from .kinds import KINDS, figure_of, kind_of
from .recording import Run, draw_panel
from .style import look, names_of, save
from .table import columns_of as table_columns

__all__ = ["PlotError", "kind_of", "plot", "plot_allan", "plot_compensator",
           "plot_plan", "plot_recording", "plot_sensitivity", "plot_table",
           "plot_validation", "save", "save_each"]

# How this door spells it: `beamgyro plot` runs the package under another name.
COMPARING = "compare=True" if __name__ == "beamgyro.plots" else "--compare"
CHARACTERISTIC = "beamgyro-characteristic"  # of the dataset of characterise
Path = Union[str, "os.PathLike[str]"]


def plot(files: Path | Sequence[Path] | Mapping[Any, Any],
         compare: bool = False) -> Figure:
    """The picture of a file or of the directory of a set; with `compare` of
    several files of one kind over each other. Recordings may also be
    xarray.Dataset. Raises PlotError, a ValueError, for a file that has no
    picture."""
    if not isinstance(compare, bool):
        raise PlotError(f"compare {compare!r}: expected True or False")
    if isinstance(files, Mapping):
        if getattr(files, "attrs", {}).get("filetype") == CHARACTERISTIC:
            return plot_table(files)
        return plot_recording(files)
    given = _several(files)
    if compare and given and all(isinstance(one, Mapping) for one in given):
        return plot_recording(*given)
    paths = [_path_of(file) for file in given]
    if not paths:
        raise PlotError("no file to plot; expected one or more")
    kinds = [kind_of(path) for path in paths]
    _require_comparable(paths, kinds, compare)
    sources = [KINDS[kinds[0]].read(path, name)
               for path, name in zip(paths, names_of(paths))]
    return _plotted(kinds[0], *sources, places=paths)


def _several(files: Any) -> Sequence[Any]:
    if isinstance(files, (str, os.PathLike)) or not hasattr(files, "__iter__"):
        return [files]
    return list(files)


def _path_of(file: Any) -> pathlib.Path:
    if not isinstance(file, (str, os.PathLike)):
        raise PlotError(f"{type(file).__name__}: has no picture; expected "
                        "the name of a file, several names, or a recording")
    path = pathlib.Path(file)
    if "\0" in str(path):
        raise PlotError(f"{str(path)!r}: holds a NUL; expected the name of a "
                        "file")
    return path


def _require_comparable(paths: Sequence[Any], kinds: Sequence[str],
                        compare: bool) -> None:
    if len(paths) == 1:
        if compare:
            raise PlotError(f"{paths[0]}: one file is compared with nothing; "
                            "expected two or more with "
                            f"{COMPARING}")
        return
    if not compare:
        raise PlotError(f"{paths[1]}: a second file for one picture; expected "
                        f"{COMPARING}, which draws files of one "
                        "kind over each other")
    first = KINDS[kinds[0]]
    for path, kind in zip(paths[1:], kinds[1:]):
        if kind != kinds[0]:
            raise PlotError(
                f"{path}: a file of the kind {KINDS[kind].name} cannot be "
                f"compared with {paths[0]}, which is of the kind "
                f"{first.name}; expected one kind")
    if not first.compares:
        known = ", ".join(one.name for one in KINDS.values() if one.compares)
        raise PlotError(f"{paths[0]}: files of the kind {first.name} cannot "
                        f"be compared; expected one of: {known}")


def _plotted(kind: str, *sources: Any, places: Sequence[object] = ()
             ) -> Figure:
    names = [place or KINDS[kind].name for place in
             [*places, *[None] * (len(sources) - len(places))]]
    drawn = [KINDS[kind].checked(source, name)
             for source, name in zip(sources, names)]
    with look():
        return figure_of(kind, drawn)


def _plotted_documents(kind: str, data: Sequence[Any], names: Sequence[str]
                       ) -> Figure:
    names = [*names, *[KINDS[kind].name] * (len(data) - len(names))]
    for one, name in zip(data, names):
        if not isinstance(one, Mapping):
            raise PlotError(f"{name}: {type(one).__name__}; expected the JSON "
                            "of a command as a dict")
    return _plotted(kind, *({"name": name, **one}
                            for one, name in zip(data, names)), places=names)


def plot_recording(*recordings: Any, names: Sequence[str] = (),
                   ax: Axes | None = None, panel: str = "rate") -> Figure:
    """One recording, or several over each other: xarray.Dataset, or mappings
    from the names of variables to arrays in deg/s, degC, Hz and s. With `ax`
    one panel of one recording is drawn there: rate, error, left (what a
    compensator leaves), temperature, drive_frequency or quadrature."""
    if ax is not None:
        if len(recordings) != 1:
            raise PlotError(f"ax: {len(recordings)} recordings; expected one")
        draw_panel(ax, Run(recordings[0], ""), panel)
        return ax.figure
    names = [*names, *[f"recording {k + 1}" if len(recordings) > 1 else ""
                       for k in range(len(names), len(recordings))]]
    return _plotted("recording", *map(Run, recordings, names))


def plot_table(*tables: Any, names: Sequence[str] = ()) -> Figure:
    """Tables of `characterise`: its datasets, or mappings from the names of
    columns to arrays."""
    names = [*names, *["device"] * (len(tables) - len(names))]
    return _plotted("table", *({"name": name, **table_columns(table)}
                               for table, name in zip(tables, names)))


def plot_allan(*results: Mapping[str, Any], names: Sequence[str] = ()
               ) -> Figure:
    """Results of `allan --json`, as dicts."""
    return _plotted_documents("allan", results, names)


def plot_compensator(*compensators: Mapping[str, Any],
                     names: Sequence[str] = ()) -> Figure:
    """Compensators or populations, as dicts of their JSON."""
    return _plotted_documents("compensator", compensators, names)


def plot_validation(result: Mapping[str, Any]) -> Figure:
    """The result of `validate --json`, as a dict."""
    return _plotted("validation", result)


def plot_plan(plan: Mapping[str, Any]) -> Figure:
    """The result of `plan --json`, as a dict."""
    return _plotted("plan", plan)


def plot_sensitivity(study: Mapping[str, Any]) -> Figure:
    """The result of `sensitivity --json`, as a dict."""
    return _plotted("sensitivity", study)


def save_each(file: Path, folder: Path) -> list[str]:
    """Writes a PNG of every figure of a validation or sensitivity study by
    itself to a directory, and returns their names."""
    path = pathlib.Path(file)
    kind = KINDS[kind_of(path)]
    if kind.each is None:
        raise PlotError(f"{path}: one picture only; expected the --json of "
                        "validate or sensitivity")
    names = []
    source = kind.checked(kind.read(path, path.name), path)
    with look():
        for name, figure in kind.each(source):
            names.append(f"{name}.png")
            save(figure, pathlib.Path(folder) / names[-1])
    return names
