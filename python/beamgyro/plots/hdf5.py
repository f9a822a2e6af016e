# SPDX-License-Identifier: MIT
"""Arrays and texts of HDF5 files, checked as they are read."""

from __future__ import annotations

import pathlib
from contextlib import contextmanager
from typing import Any, Iterator

import numpy.typing as npt

from .documents import PlotError

Values = npt.NDArray[Any]


def text_of(value: object) -> str:
    return value.decode(errors="replace") if isinstance(value, bytes) \
        else str(value)


class File:
    """An open HDF5 file."""

    def __init__(self, path: pathlib.Path, file: Any) -> None:
        self.path = path
        self.contents = file

    def __contains__(self, name: str) -> bool:
        return name in self.contents

    @property
    def attributes(self) -> dict[str, Any]:
        return dict(self.contents.attrs)

    def variable(self, name: str, dimensions: int = 1) -> Any:
        """A dataset of numbers that is not read yet."""
        import h5py
        found = self.contents.get(name)
        if not isinstance(found, h5py.Dataset):
            met = "missing" if found is None else "no variable"
            raise PlotError(f"{self.path}: {name}: {met}; expected numbers")
        if found.dtype.kind not in "iuf":
            raise PlotError(f"{self.path}: {name}: values of type "
                            f"{found.dtype}; expected numbers")
        if found.ndim != dimensions:
            raise PlotError(f"{self.path}: {name}: {found.ndim} dimensions; "
                            f"expected {dimensions}")
        return found

    def numbers(self, name: str) -> Values:
        """All values of a variable of one dimension."""
        values: Values = self.variable(name)[()]
        return values


def _reject_driver_information(path: pathlib.Path) -> None:
    """HDF5 takes the memory that such a block claims, up to 4 GiB."""
    undefined = b"\xff" * 8
    with path.open("rb") as file:
        # Where HDF5 looks for its first bytes.
        place, size = 0, path.stat().st_size
        while place < size:
            file.seek(place)
            head = file.read(60)
            if head.startswith(b"\x89HDF\r\n\x1a\n"):
                begin = {b"\0": 48, b"\1": 52}.get(head[8:9])
                if begin and head[begin:begin + 8] != undefined:
                    raise PlotError(
                        f"{path}: has a block of driver information, which no "
                        "file of beamgyro has; expected a whole file as "
                        "beamgyro wrote it")
                return
            place = max(512, 2 * place)


@contextmanager
def opened(path: pathlib.Path) -> Iterator[File]:
    """Raises PlotError where HDF5 fails, at opening or at reading."""
    import h5py
    try:
        _reject_driver_information(path)
        with h5py.File(path) as file:
            yield File(path, file)
    except (OSError, RuntimeError) as error:
        raise PlotError(f"{path}: HDF5 cannot read it: {error}; expected a "
                        "whole file as beamgyro wrote it") from None
