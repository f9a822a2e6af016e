# SPDX-License-Identifier: MIT
"""What recordings state beside their samples, and logs as CSV."""

from __future__ import annotations

import csv
import pathlib
import re
from typing import Any, Mapping, Sequence

import numpy as np

from . import hdf5
from .documents import PlotError
from .units import converted, unit_of


def device_of(data: Mapping[Any, Any], attributes: Mapping[str, Any]) -> str:
    """The device of a simulated run with its seed; of another run nothing."""
    source = hdf5.text_of(attributes.get("source", ""))
    if "virtual gyro" not in source:
        return ""
    words = "virtual gyro"
    scenario = getattr(data, "encoding", {}).get("beamgyro", {}).get("scenario")
    if scenario is None and "meta/scenario" in data:
        scenario = hdf5.text_of(data["meta/scenario"][()])
    named = re.search(r'^device\s*=\s*"(?:[^"]*/)?([^"/]+)\.toml"',
                      scenario or "", re.MULTILINE)
    if named:
        words += f" {named[1]}"
    return f"{words}, seed {attributes['seed']}" if "seed" in attributes \
        else words


def csv_columns(path: pathlib.Path, names_wanted: Sequence[str]
                ) -> dict[str, Any]:
    """The columns of a log that have these names, in the units of pictures."""
    with open(path, newline="", encoding="utf-8-sig") as file:
        try:
            header = next(csv.reader(file))
            names, units = zip(*(_column(head) for head in header))
            wanted = [k for k, key in enumerate(names)
                      if key in names_wanted]
            table = np.loadtxt(file, delimiter=",", usecols=wanted, ndmin=2)
        except UnicodeDecodeError:
            raise PlotError(f"{path}: holds bytes that are not UTF-8; "
                            "expected a text file") from None
        except ValueError as error:
            raise PlotError(f"{path}: {error}; expected numbers") from None
    data: dict[str, Any] = {}
    for k, values in zip(wanted, table.T):
        data[names[k]] = values if names[k] == "status" else converted(
            names[k], values, units[k] or unit_of(names[k]), f"{path}: ")
    return data


def _column(head: str) -> tuple[str, str]:
    name, _, unit = head.strip().partition("[")
    return name.strip(), unit.rstrip("]").strip()
