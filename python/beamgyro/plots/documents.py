# SPDX-License-Identifier: MIT
"""JSON documents, checked before anything is drawn of them.

Each kind of picture has a shape: the keys that it draws, and what their values
are. `checked` names the first value that is not of its shape.
"""

from __future__ import annotations

import json
import pathlib
import re
from dataclasses import dataclass
from typing import Any, Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

Numbers = npt.NDArray[np.float64]

# Where the squares and ratios of numbers are numbers, too.
SMALLEST, LARGEST = 1e-100, 1e100
LONGEST_INTEGER = 18  # [digits] that are read exactly
LETTERS = 40  # of a wrong value that are shown


class PlotError(ValueError):
    """An input that has no picture: what, where, and what would be right."""


class WrongValue(Exception):
    """The key of a value, the value in words, and what was expected."""


@dataclass(frozen=True)
class Shape:
    """What a value has to be, in words and as a check of value and key."""

    words: str
    check: Callable[[Any, str], None]


def shown(value: Any) -> str:
    try:
        text = json.dumps(value, ensure_ascii=False)
    except (TypeError, ValueError, RecursionError):
        text = type(value).__name__
    return text if len(text) <= LETTERS else text[:LETTERS - 1] + "…"


def _simple(words: str, holds: Callable[[Any], bool]) -> Shape:
    def check(value: Any, key: str) -> None:
        if not holds(value):
            raise WrongValue(key, shown(value), words)
    return Shape(words, check)


def number(least: float = -LARGEST, words: str = "a number") -> Shape:
    # A bool is an int in Python; a NaN is in no range.
    return _simple(words, lambda value: not isinstance(value, bool)
                   and isinstance(value, (int, float))
                   and least <= value <= (LARGEST if isinstance(value, float)
                                          else 10**LONGEST_INTEGER))


NUMBER = number()
POSITIVE = number(SMALLEST, "a number above 0")
NOT_NEGATIVE = number(0, "a number of 0 or more")
COUNT = _simple("a whole number of 1 or more", lambda value: type(value) is int
                and value > 0)
TEXT = _simple("a text", lambda value: isinstance(value, str))
FLAG = _simple("true or false", lambda value: isinstance(value, bool))
# It becomes the name of a file.
NAME = _simple("a name of letters, digits and _", lambda value: isinstance(
    value, str) and re.fullmatch(r"\w{1,200}", value, re.ASCII) is not None)


def either(*texts: str) -> Shape:
    return _simple(" or ".join(f'"{text}"' for text in texts),
                   lambda value: isinstance(value, str) and value in texts)


def maybe(shape: Shape) -> Shape:
    """That shape, or null."""
    words = f"{shape.words} or null"

    def check(value: Any, key: str) -> None:
        if value is not None:
            try:
                shape.check(value, key)
            except WrongValue as error:
                if error.args[0] != key:
                    raise
                raise WrongValue(key, error.args[1], words) from None
    return Shape(words, check)


def rows(shape: Shape, least: int = 0, most: float = float("inf")) -> Shape:
    """A list of values of that shape."""
    words = "a list" if most == float("inf") and not least else \
        f"a list of {least}" if least == most else f"a list of {least} or more"

    def check(value: Any, key: str) -> None:
        if not isinstance(value, (list, tuple)):
            raise WrongValue(key, shown(value), words)
        if not least <= len(value) <= most:
            raise WrongValue(key, f"{len(value)} values", words)
        for k, one in enumerate(value):
            shape.check(one, f"{key}[{k}]")
    return Shape(words, check)


PAIR = rows(NUMBER, 2, 2)


def _inside(key: str, name: str) -> str:
    return f"{key}.{name}" if key else name


def record(needed: Mapping[str, Shape], optional: Mapping[str, Shape] = {},
           alike: Sequence[str] = ()) -> Shape:
    """An object with these members; the lists `alike` are equally long."""
    def check(value: Any, key: str) -> None:
        if not isinstance(value, Mapping):
            raise WrongValue(key, shown(value), "an object")
        for name, shape in needed.items():
            if name not in value:
                raise WrongValue(_inside(key, name), "missing", shape.words)
            shape.check(value[name], _inside(key, name))
        for name, shape in optional.items():
            if name in value:
                shape.check(value[name], _inside(key, name))
        first, *others = [name for name in alike if name in value] or [""]
        for name in others:
            count = len(value[first])
            if len(value[name]) != count:
                raise WrongValue(_inside(key, name),
                                 f"{len(value[name])} values",
                                 f"{count}, as {first} has")
    return Shape("an object", check)


def both(shape: Shape, further: Callable[[Any, str], None]) -> Shape:
    """That shape and a further check of a value that has it."""
    def check(value: Any, key: str) -> None:
        shape.check(value, key)
        further(value, key)
    return Shape(shape.words, check)


def in_order(ends: Sequence[float | None], key: str) -> None:
    """The lower end of an interval stands first; null is no end."""
    low, high = ends
    if low is not None and high is not None and low > high:
        raise WrongValue(key, shown(ends), "the lower number first")


RANGE = both(PAIR, in_order)


def members(shape: Shape) -> Shape:
    """An object whose members all have that shape, one or more."""
    def check(value: Any, key: str) -> None:
        if not isinstance(value, Mapping) or not value:
            raise WrongValue(key, shown(value), "an object with members")
        for name, one in value.items():
            NAME.check(name, key)
            shape.check(one, _inside(key, name))
    return Shape("an object", check)


def check(document: Any, shape: Shape, where: object) -> None:
    """Raises PlotError that names the first value not of that shape."""
    try:
        shape.check(document, "")
    except WrongValue as error:
        key, met, expected = error.args
        place = f"{where}: {key}" if key else where
        raise PlotError(f"{place}: {met}; expected {expected}") from None


def parsed(text: str, where: object) -> Any:
    try:
        return json.loads(text, parse_int=lambda digits: int(digits)
                          if len(digits) <= LONGEST_INTEGER
                          else float(digits))
    except RecursionError:
        raise PlotError(f"{where}: no JSON that beamgyro writes: nested too "
                        "deeply") from None
    except ValueError as error:
        raise PlotError(f"{where}: no JSON: {error}") from None


def text_of(path: pathlib.Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise PlotError(f"{path}: byte {error.start} is not UTF-8; expected a "
                        "text file as beamgyro wrote it") from None
    except OSError as error:
        raise PlotError(f"{path}: {error.strerror}") from None


def table_of(path: pathlib.Path, lines: Sequence[str]) -> Numbers:
    """The numbers below the first line of a CSV over temperature."""
    count = lines[0].count(",") + 1
    for number, line in enumerate(lines[1:], 2):
        if line.count(",") + 1 != count:
            raise PlotError(f"{path}:{number}: {line.count(',') + 1} values; "
                            f"expected {count}, as the first line has")
    try:
        values: Numbers = np.loadtxt(lines[1:], delimiter=",", ndmin=2)
    except ValueError as error:
        raise PlotError(f"{path}: {error}; expected numbers") from None
    if values.size == 0:
        raise PlotError(f"{path}: no rows; expected one or more temperatures")
    return values


def read(path: pathlib.Path, name: str = "") -> dict[str, Any]:
    """A JSON object, as yet unchecked, and how pictures call it."""
    data = parsed(text_of(path), path)
    if not isinstance(data, dict):
        raise PlotError(f"{path}: {shown(data)}; expected the JSON object "
                        "that a command wrote")
    return {**data, "name": name or path.name}
