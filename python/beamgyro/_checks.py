# SPDX-License-Identifier: MIT
"""Checks of texts, files and mappings that a caller gives.

Each function returns the value, or raises ValueError with the name of the
argument, the value that was met and what would be right.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Optional, TypeGuard, TypeVar, Union

from beamgyro import _arguments, _core
from beamgyro._words import shown as shown, wrong as wrong

Path = Union[str, "os.PathLike[str]"]
Kind = TypeVar("Kind")


def refuse(reason: str, **options: Any) -> None:
    """Raise ValueError for an option that is given but does not apply."""
    for name, value in options.items():
        if value is not None:
            raise ValueError(f"{name} {shown(value)}: is {reason}; expected "
                             f"no {name}")


def flag(value: Any, name: str) -> bool:
    """Return True or False."""
    if isinstance(value, bool) or type(value).__name__ in ("bool_", "bool"):
        return bool(value)
    raise wrong(value, name, "True or False")


def text(value: Any, name: str, right: str = "a text") -> str:
    """Return a text that UTF-8 can hold."""
    if not isinstance(value, str):
        raise wrong(value, name, right)
    try:
        value.encode()
    except UnicodeEncodeError as error:
        raise ValueError(
            f"{name} {shown(value)}: character {error.start} is half of a "
            "pair (a surrogate); expected a text that UTF-8 can hold"
        ) from None
    return value


def command(value: str, name: str) -> str:
    """Return a command of the shell."""
    if "\0" in text(value, name):
        raise ValueError(f"{name} {shown(value)}: holds a NUL; expected "
                         "\"cmd:PROGRAM ARGS\"")
    return value


def several(values: Any, name: str,
            one: Callable[[Any, str], Kind]) -> list[Kind]:
    """Return a list of what `one` returns of each value."""
    if isinstance(values, (str, bytes)):
        raise ValueError(f"{name} {shown(values)}: is one text; expected a "
                         f"sequence, such as [{shown(values)}]")
    if (not isinstance(values, Iterable) or isinstance(values, Mapping)
            or getattr(values, "ndim", 1) == 0):
        raise wrong(values, name, f"a sequence, such as [{shown(values)}]"
                    if isinstance(values, int) else "a sequence")
    return [one(value, name) for value in values]


def _anything(value: Any, _: str) -> Any:
    return value


def texts(values: Any, name: str) -> list[str]:
    """Return a list of texts."""
    found: list[Any] = several(values, name, _anything)
    if not all(isinstance(one, str) for one in found):
        raise wrong(values, name, "a sequence of texts")
    return [text(one, name) for one in found]


def wholes(values: Any, name: str) -> list[int]:
    """Return a list of whole numbers, such as those of devices."""
    return several(values, name, _arguments.whole)


def bound(value: Any, name: str) -> float:
    """Return a time, which may be infinite."""
    if isinstance(value, float) and math.isinf(value):
        return value
    return _arguments.number(value, name)


def path(value: Any, name: str, right: str = "the name of a file") -> str:
    """Return the name of a file or a directory."""
    try:
        found = os.fsdecode(value)
        os.fsencode(found)
    except TypeError:
        raise wrong(value, name, right) from None
    except UnicodeEncodeError:
        raise ValueError(f"{name} {shown(value)}: holds half of a pair of "
                         "characters (a surrogate); expected "
                         f"{right}") from None
    if "\0" in found:
        raise ValueError(f"{name} {shown(value)}: holds a NUL; expected "
                         f"{right}")
    if not found:
        raise wrong(value, name, right)
    return found


def paths(values: Any, name: str) -> list[str]:
    """Return a list of names of files or directories."""
    return several(values, name, path)


def file(value: Any, name: str, kind: str, also: str = "",
         tables: tuple[str, ...] = ()) -> str:
    """Return the name of a file that is none of another kind.

    Kinds are called as in messages: "a scenario", "a recording", ... A file
    of no known kind passes; who reads it says what is wrong. `also` are words
    on what else may be given, and `tables` kinds that could be meant, too.
    """
    found = path(value, name, f"the name of {kind}{also}")
    met = _core.kinds_of(found)
    if met and not {kind, *tables} & {*met}:
        printable = found.encode(errors="backslashreplace").decode()
        raise ValueError(f"{printable}: is {met[0]}; expected {kind}")
    return found


def is_table(value: Any) -> TypeGuard[Mapping[str, Any]]:
    """Return whether a value may be the contents of a TOML file.

    Datasets and sets are mappings, too, but no tables.
    """
    return isinstance(value, Mapping) and not hasattr(
        value, "data_vars") and not hasattr(value, "_native")


MAPPING = ", or a mapping with its contents"


def keys(value: Any, name: str) -> Optional[Mapping[str, Any]]:
    """Return keys and values, or None for none."""
    if value is None or is_table(value):
        return value
    raise wrong(value, name,
                "a mapping of keys to values, such as {\"duration_s\": 60}")
