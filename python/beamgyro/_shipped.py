# SPDX-License-Identifier: MIT
"""What is installed beside the package: the program and its scenarios."""

from __future__ import annotations

import shutil
from pathlib import Path

_PACKAGE = Path(__file__).parent


def program() -> str:
    """Return the program `beamgyro`, or an empty text where there is none."""
    compiled = Path(_PACKAGE.absolute())
    built = compiled.parent.parent / "beamgyro"
    installed = compiled.parents[3] / "bin" / "beamgyro"
    for candidate in (built, installed):
        if candidate.is_file():
            return str(candidate)
    return shutil.which("beamgyro") or ""


def file(name: str) -> Path:
    """Return a shipped file, such as "scenarios/qualification.toml".

    Raises:
        ValueError: there is none beside this package.
    """
    source = Path(__file__).resolve().parents[2] / name
    installed = (_PACKAGE.absolute().parents[3] / "share" / "beamgyro" / name
                 if len(_PACKAGE.absolute().parents) > 3 else source)
    for candidate in (source, installed):
        if candidate.is_file():
            return candidate
    raise ValueError(f"{name}: is not beside this package; expected its path")
