# SPDX-License-Identifier: MIT
"""The progress of long calls, on standard error."""

from __future__ import annotations

import importlib
import importlib.util
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Optional, Union

ProgressFunction = Callable[[float], object]
ProgressArgument = Union[bool, ProgressFunction, None]

_DELAY_S = 2.0
_WIDTH = 30


class NotebookBar:
    """A bar of tqdm in the cell, for work of more than two seconds."""

    def __init__(self, title: str, tqdm: Callable[..., Any]) -> None:
        self._title = title
        self._tqdm = tqdm
        self._start = time.monotonic()
        self._bar: Any = None

    def __call__(self, share: float) -> None:
        """Show the share of the work that is done, 0 to 1."""
        if self._bar is None:
            if time.monotonic() - self._start < _DELAY_S:
                return
            self._bar = self._tqdm(
                total=100, desc=self._title, leave=False, mininterval=0,
                bar_format="{desc} {bar} {percentage:3.0f} %, {remaining} left")
        done = round(100 * share)
        if done != self._bar.n:
            self._bar.update(done - self._bar.n)

    def close(self) -> None:
        """Remove the bar."""
        if self._bar is not None:
            self._bar.close()


def notebook_tqdm() -> Optional[Callable[..., Any]]:
    """Return tqdm for a notebook: with widgets where they are, else as text;
    None where there is no notebook or no tqdm."""
    if "ipykernel" not in sys.modules:
        return None
    kind = "notebook" if importlib.util.find_spec("ipywidgets") else "std"
    try:
        found: Callable[..., Any] = \
            importlib.import_module(f"tqdm.{kind}").tqdm
    except ImportError:
        return None
    return found


class Bar:
    """A bar on standard error for work of more than two seconds.

    It is drawn on terminals and in notebooks only.
    """

    def __init__(self, title: str) -> None:
        self._title = title
        self._start = time.monotonic()
        self._shown = ""
        self._is_watched = sys.stderr.isatty() or "ipykernel" in sys.modules

    def __call__(self, share: float) -> None:
        """Show the share of the work that is done, 0 to 1."""
        late = time.monotonic() - self._start >= _DELAY_S
        if not (self._is_watched and late):
            return
        done = round(share * _WIDTH)
        bar = "#" * done + "." * (_WIDTH - done)
        text = f"\r{self._title} [{bar}] {100 * share:3.0f} %"
        if text != self._shown:
            print(text, end="", file=sys.stderr, flush=True)
            self._shown = text

    def close(self) -> None:
        """Remove the bar."""
        if self._shown:
            print("\r" + " " * len(self._shown) + "\r", end="",
                  file=sys.stderr, flush=True)
            self._shown = ""


def _bar(title: str) -> Union[Bar, NotebookBar]:
    tqdm = notebook_tqdm()
    return Bar(title) if tqdm is None else NotebookBar(title, tqdm)


@contextmanager
def watched(progress: ProgressArgument, title: str
            ) -> Iterator[Optional[ProgressFunction]]:
    """Give the function that a long call tells its progress, or None."""
    if callable(progress):
        yield progress
        return
    if not (progress is None or isinstance(progress, bool)):
        raise ValueError(f"progress {progress!r}: expected True, False or "
                         "a function of the share that is done")
    bar = _bar(title) if progress else None
    try:
        yield bar
    finally:
        if bar is not None:
            bar.close()
