# SPDX-License-Identifier: MIT
"""What the user of a result should know and no error says."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterable

_HERE = os.path.dirname(__file__) + os.sep


class BeamgyroWarning(UserWarning):
    """A warning that the command line prints: saturation, loss of lock, ..."""


def warn(texts: Iterable[str]) -> None:
    """Warn at the line outside this package that led here."""
    level = 2
    frame = sys._getframe(1)
    while frame.f_back and frame.f_code.co_filename.startswith(_HERE):
        frame = frame.f_back
        level += 1
    for text in texts:
        warnings.warn(text, BeamgyroWarning, stacklevel=level)
