# SPDX-License-Identifier: MIT
"""Words of messages on values that callers give."""

from __future__ import annotations

import numbers
import os
import reprlib
from typing import Any


class _Short(reprlib.Repr):
    def __init__(self) -> None:
        super().__init__()
        self.maxstring = self.maxother = self.maxlong = 80
        self.maxlevel = 2

    def repr_instance(self, x: Any, level: int) -> str:
        if x is None or isinstance(
                x, (bool, float, complex, bytes, os.PathLike)):
            return super().repr_instance(x, level)
        shape = getattr(x, "shape", None)
        if shape == () and hasattr(x, "item"):  # of numpy
            return f"{x.item()!r}"
        if isinstance(x, numbers.Number) or hasattr(x, "isoformat"):
            return str(x)[:self.maxother]
        of = f" of the shape {shape}" if isinstance(shape, tuple) else ""
        kind = type(x)
        if isinstance(x, type):
            return f"the class {x.__module__}.{x.__qualname__}"
        name = kind.__qualname__
        if kind.__module__ != "builtins":
            name = f"{kind.__module__.partition('.')[0]}.{name}"
        return f"<{name}{of}>"


def shown(value: Any) -> str:
    """Return a value for a message: short, and on one line."""
    text = _Short().repr(value)
    return text if text.isprintable() else ascii(text)


def wrong(value: Any, name: str, right: str) -> ValueError:
    """Return the error of an argument that is not what is `right`."""
    return ValueError(f"{name} {shown(value)}: expected {right}")
