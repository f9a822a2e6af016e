# SPDX-License-Identifier: MIT
"""Imports of large packages, when they are first needed."""

from __future__ import annotations

import importlib
from types import ModuleType

_WHAT_FOR = {
    "xarray": "datasets; without it, ask for output=\"arrays\"",
    "matplotlib": "plots",
    "h5py": "sets",
    "pandas": "data frames",
    "pyarrow": "Parquet files",
}
# Where it is no package of Debian 12.
_INSTALL = {"pyarrow": "pip install pyarrow"}


def module(name: str) -> ModuleType:
    """Import a module, or say which package is missing and what needs it."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        top = name.partition(".")[0]
        raise ImportError(
            f"{top} is missing, which is needed for "
            f"{_WHAT_FOR.get(top, 'this')}; "
            + _INSTALL.get(top, f"install the package python3-{top}"),
            name=top) from error


def xarray() -> ModuleType:
    """Return xarray, with the accessor `.beamgyro` of its datasets."""
    found = module("xarray")
    module("beamgyro._accessor")
    return found
