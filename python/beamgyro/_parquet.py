# SPDX-License-Identifier: MIT
"""The samples of a set as a table in a Parquet file."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from beamgyro import _checks, _lazy
from beamgyro._windows import Columns

if TYPE_CHECKING:
    from beamgyro._set import Set as _Set


def tables_of(source: _Set, rows: Sequence[tuple[str, int]],
              columns: Columns) -> Iterator[dict[str, Any]]:
    """The columns of each run of a device, without samples that say nothing.
    """
    columns.look_at(source._native.recording(*rows[0]))
    for run, device in rows:
        recording = source._native.recording(run, device,
                                             variables=columns.variables)
        inputs, target, good = columns.of(recording)
        count = int(good.sum())
        yield {
            "run": [run] * count,
            "device": np.full(count, device, np.int32),
            "part": [source.part(device)] * count,
            "time": recording.arrays()["time"][good],
            **dict(zip(columns.inputs, inputs[good].T)),
            columns.target: target[good]}


def write(source: _Set, rows: Sequence[tuple[str, int]], columns: Columns,
          path: Any) -> None:
    """Write the tables, a row group for each run of a device."""
    name = _checks.path(path, "path")
    if FilePath(name).suffix != ".parquet":
        raise ValueError(f"path {_checks.shown(name)}: expected a name that "
                         "ends in .parquet")
    if not rows:
        raise ValueError("part: has no run with values; expected at least one")
    if len({"run", "device", "part", "time", *columns.inputs,
            columns.target}) < 5 + len(columns.inputs):
        raise ValueError("inputs: a name stands twice, or is that of another "
                         "column; expected different ones")
    arrow = _lazy.module("pyarrow")
    parquet = _lazy.module("pyarrow.parquet")
    unfinished = f"{name}.partial-{os.getpid()}"
    writer: Any = None
    try:
        for table in tables_of(source, rows, columns):
            made = arrow.table(table)
            if writer is None:
                writer = parquet.ParquetWriter(unfinished, made.schema)
            writer.write_table(made)
        writer.close()
        os.replace(unfinished, name)
    finally:
        FilePath(unfinished).unlink(missing_ok=True)
