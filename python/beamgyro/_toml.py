# SPDX-License-Identifier: MIT
"""Writes nested mappings as TOML text, which the compiled part reads."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping, Sequence
from typing import Any

from beamgyro import _checks

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+\Z")


def key(name: object) -> str:
    """Return one part of a key as TOML spells it."""
    if not isinstance(name, str):
        raise _checks.wrong(name, "key", "a text")
    _checks.text(name, "key")
    return name if _BARE_KEY.match(name) else json.dumps(name)


def value(item: Any, where: str) -> str:
    """Return a value in TOML syntax. `where` is its key, for messages."""
    if hasattr(item, "tolist") and not isinstance(item, memoryview):  # numpy
        item = item.tolist()
    if isinstance(item, bool):
        return "true" if item else "false"
    if isinstance(item, int):
        return repr(int(item))  # of a class of its own, too
    if isinstance(item, float):
        return repr(float(item))
    if isinstance(item, (str, os.PathLike)):
        return json.dumps(_checks.text(os.fspath(item), f"{where}:"),
                          ensure_ascii=False).replace(
            "\x7f", "\\u007f")
    if isinstance(item, Mapping):
        inside = (f"{key(name)} = {value(part, f'{where}.{name}')}"
                  for name, part in item.items())
        return "{ " + ", ".join(inside) + " }"
    if isinstance(item, Sequence) and not isinstance(
            item, (bytes, bytearray, memoryview)):
        return "[" + ", ".join(value(part, where) for part in item) + "]"
    raise ValueError(
        f"{where}: {_checks.shown(item)} is a {type(item).__name__}; expected "
        "a number, a text, true or false, a sequence or a mapping of these")


def text(table: Mapping[str, Any]) -> str:
    """Return a nested mapping as the text of a TOML file.

    Each mapping directly in `table` becomes a table of the file.
    """
    lines = [f"{key(name)} = {value(item, str(name))}"
             for name, item in table.items()
             if not isinstance(item, Mapping)]
    for name, item in table.items():
        if isinstance(item, Mapping):
            lines += ["", f"[{key(name)}]"]
            lines += [f"{key(part)} = {value(inner, f'{name}.{part}')}"
                      for part, inner in item.items()]
    return "\n".join(lines) + "\n"


def merged(keys: Mapping[str, Any] | None,
           more: Mapping[str, Any], name: str = "keys"
           ) -> dict[str, Any]:
    """Return the keys of both; a value of `more` stands for the same key."""
    return {**(_checks.keys(keys, name) or {}), **more}


def overrides(keys: Mapping[str, Any] | None) -> list[str]:
    """Return KEY=VALUE for each value of a mapping, as `--set` takes it.

    Keys are dotted, or mappings are nested; the two may be mixed.
    """
    found: list[str] = []

    def add(prefix: str, table: Mapping[str, Any]) -> None:
        for name, item in table.items():
            if not isinstance(name, str):
                key(name)  # refuses it
            if any(sign in name for sign in "=#\n\r"):
                raise _checks.wrong(name, "key", "a dotted key, such as "
                                    "\"beam.length_m\"")
            if isinstance(item, Mapping) and not prefix:
                add(f"{name}.", item)
            else:
                found.append(f"{prefix}{name}={value(item, prefix + name)}")

    add("", _checks.keys(keys, "set") or {})
    return found
