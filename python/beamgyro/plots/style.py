# SPDX-License-Identifier: MIT
"""The look of all pictures: colours, sizes, titles, and how they are saved."""

from __future__ import annotations

import collections
import functools
import importlib
import io
import os
import pathlib
import re
import sys
import textwrap
from typing import Any, ContextManager, Sequence

import matplotlib.style
import numpy as np
from matplotlib import ft2font, ticker
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont

from .documents import PlotError

# Of Okabe and Ito: told apart by colour-blind eyes.
BLUE, ORANGE, GREEN, PURPLE = "#0072b2", "#d55e00", "#009e73", "#cc79a7"
YELLOW, SKY, BLACK, GREY = "#e69f00", "#56b4e9", "#1b1f23", "#9a9a9a"
WORDS = "#505050"
COLORS = [BLUE, ORANGE, GREEN, PURPLE, YELLOW, SKY, "#000000"]
DASHES: list[Any] = ["-", (0, (4, 2)), (0, (1, 1.5)), (0, (5, 1.5, 1, 1.5)),
                     (0, (7, 2)), (0, (2, 1, 0.5, 1, 0.5, 1)),
                     (0, (0.5, 2.5))]
MARKERS = ["o", "^", "s", "D", "x", "*", "+"]

# The recorded rate, the compensated rate, and what is true.
BEFORE, AFTER, TRUTH = ORANGE, BLUE, BLACK
RESULTS = {"pass": BLUE, "fail": ORANGE, "undecided": GREY, None: BLACK}

WIDTH = 8.0  # [inch]
NOTEBOOK_DPI = 100
LETTERS_PER_INCH = 14  # of the words below a title
LONGEST_TITLE = 75
MOST_DECADES = 6  # that are numbered on one axis
FONT = "DejaVu Sans"  # comes with matplotlib
STYLE = {
    "figure.figsize": (WIDTH, 4.5),  # 1600 x 900 pixels
    "figure.dpi": 100,
    "savefig.dpi": 200,
    "figure.constrained_layout.use": True,
    "figure.titlesize": 12,
    "font.size": 10,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.labelsize": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.formatter.useoffset": False,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.8,
    "axes.axisbelow": True,
    "lines.linewidth": 1.5,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "svg.hashsalt": "beamgyro",  # else the ids in an SVG change with every run
    "svg.fonttype": "none",  # text stays text
    "text.parse_math": False,  # a name may have a dollar
    "font.family": [FONT],
}
# Nothing that changes with the day or the machine.
METADATA: dict[str, dict[str, Any]] = {
    "png": {"Software": None}, "svg": {"Date": None, "Creator": None}}
FORMATS = tuple(METADATA)


def look() -> ContextManager[None]:
    """The style of all pictures, whatever the user set for others."""
    context: ContextManager[None] = matplotlib.style.context(
        ["default", STYLE])
    return context


class Picture(Figure):  # type: ignore[misc]
    """A figure that shows itself in a notebook, with or without pyplot."""

    def _repr_png_(self) -> bytes:
        written = io.BytesIO()
        with look():
            self.savefig(written, format="png", metadata=METADATA["png"],
                         dpi=NOTEBOOK_DPI)
        return written.getvalue()

    def show(self, warn: bool = True) -> None:
        """Show it where the notebook is; elsewhere as matplotlib does."""
        if "ipykernel" in sys.modules:
            display: Any = importlib.import_module("IPython.display")
            display.display(self)
        else:
            super().show(warn)


def new_figure(height: float, width: float = WIDTH) -> Picture:
    return Picture(figsize=(width, height), layout="constrained")


def _name_curves(figure: Figure) -> None:
    """Gives each curve of an SVG an id: its panel and its label."""
    for panel, axes in enumerate(figure.axes, 1):
        for line in axes.lines:
            label = str(line.get_label())
            if not label.startswith("_"):
                line.set_gid(re.sub(r"\W+", "-", f"curve {panel} {label}"))


def save(figure: Figure, path: str | os.PathLike[str],
         kind: str | None = None, dpi: float | None = None) -> None:
    """Writes a picture; without `kind` the name says whether PNG or SVG."""
    kind = (kind or pathlib.Path(path).suffix.removeprefix(".")).lower()
    if kind not in FORMATS:
        raise PlotError(f"{path}: unknown kind of picture \"{kind}\"; "
                        "expected a name that ends in .png or .svg")
    _name_curves(figure)
    with look():
        _fix_places(figure)
        figure.savefig(path, format=kind, metadata=METADATA[kind],
                       dpi=dpi or STYLE["savefig.dpi"])


def _fix_places(figure: Figure) -> None:
    """Lays a figure out, to places that are the same in every process.

    The solver adds in the order of a set of objects, which depends on their
    addresses: the last bit of a place differs now and then, and names of
    clipping paths in an SVG are made from all bits.
    """
    if figure.get_layout_engine() is None:
        return
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    for axes in figure.get_axes():
        if axes.get_axes_locator() is None:
            axes.set_position(np.round(axes.get_position().bounds, 9))


def spoken(text: str) -> str:
    """Text with its units as they are printed."""
    for written, printed in [(r"\bdegC\b", "°C"), (r"\bdegree\b", "°"),
                             (r"\bdeg\b", "°"), (r"\bm/s2\b", "m/s²"),
                             (r"\b1-sigma\b", "1σ"),
                             (r"(?<=[\s(])-(?=\d)", "−"),
                             (r"\bPhi\((.*?)sigma\)", r"Φ(\1σ)"),
                             (r"sqrt\((\w)\)", r"√\1")]:
        text = re.sub(written, printed, text)
    return printable(text)


@functools.lru_cache(maxsize=None)
def _letters() -> frozenset[int]:
    """What the font has, upright and bold."""
    fonts = [ft2font.FT2Font(findfont(FontProperties(
        family=[FONT], weight=weight))) for weight in ("normal", "bold")]
    return frozenset.intersection(*(frozenset(font.get_charmap())
                                    for font in fonts))


def printable(text: str) -> str:
    """Text whose letters the font lacks are written as their numbers."""
    return "".join(letter if ord(letter) in _letters() and letter.isprintable()
                   else letter.encode("unicode_escape").decode()
                   for letter in text)


def quantity(words: str, unit: str) -> str:
    """The label of an axis."""
    words = spoken(words)
    return f"{words} [{spoken(unit)}]" if unit not in ("", "1") else words


class FewLogTicks(ticker.Locator):  # type: ignore[misc]
    """Powers of ten; within less than two of them 1, 2 and 5 of each, and
    within less again a few round numbers. matplotlib's own prints up to ten
    numbers there, over each other."""

    def __init__(self, marks: Sequence[int] = ()) -> None:
        self._marks: list[Any] = [marks] if marks else [(1,), (1, 2, 5)]

    def __call__(self) -> Any:
        return self.tick_values(*self.axis.get_view_interval())

    def tick_values(self, vmin: float, vmax: float) -> Any:
        low, high = sorted((vmin, vmax))
        if not 0 < low < high < np.inf:
            return np.array([])
        first, last = (int(np.floor(np.log10(end))) for end in (low, high))
        stride = max(1, -(-(last - first) // MOST_DECADES))
        for marks in self._marks:
            decades = range(first, last + 1, stride if marks == (1,) else 1)
            ticks = np.array([mark * 10.0 ** power for power in decades
                              for mark in marks])
            ticks = ticks[(ticks >= low) & (ticks <= high)]
            if len(ticks) > 1:
                return ticks
        return ticker.MaxNLocator(3, min_n_ticks=2).tick_values(low, high)


def log_scale(axis: Axis, marks: Sequence[int] = ()) -> None:
    """A logarithmic axis with plain numbers: at powers of ten, or at these
    `marks` in every decade."""
    axis.axes.set(**{f"{axis.axis_name}scale": "log"})
    log_ticks(axis, marks)


def log_ticks(axis: Axis, marks: Sequence[int] = ()) -> None:
    """The numbers of an axis that is logarithmic."""
    axis.set_major_locator(FewLogTicks(marks))
    axis.set_major_formatter(ticker.FormatStrFormatter("%g"))
    axis.set_minor_formatter(ticker.NullFormatter())


def titled(figure: Figure, title: str, about: str = "") -> None:
    """A title at the left, and in smaller letters what it is about."""
    width, height = figure.get_size_inches()
    lines = textwrap.wrap(spoken(" ".join(about.split())),
                          int(LETTERS_PER_INCH * width))
    # The layout leaves room for as many empty lines.
    title = shortened(title, LONGEST_TITLE)
    figure.suptitle(title + "\n " * len(lines), x=0.01, ha="left",
                    weight="bold")
    if lines:
        figure.text(0.01, 1 - 0.29 / height, "\n".join(lines), fontsize=9,
                    color=WORDS, ha="left", va="top", linespacing=1.5)


def legend_below(axes: Axes, columns: int = 4) -> None:
    axes.legend(loc="upper left", bbox_to_anchor=(0, -0.16), ncols=columns)


def legend_above(axes: Axes, columns: int = 6,
                 extra: Sequence[Any] = ()) -> None:
    """Above the panel, so that it hides no sample."""
    axes.legend(handles=[*axes.get_legend_handles_labels()[0], *extra],
                loc="lower left", bbox_to_anchor=(-0.01, 0.98), ncols=columns,
                borderaxespad=0.2, columnspacing=1.2, handlelength=1.6)


def shortened(text: str, most: int) -> str:
    """Text without its middle where it is longer than that."""
    text = printable(text)
    if len(text) <= most:
        return text
    end = (most - 1) // 2
    return f"{text[:most - 1 - end]}…{text[-end:]}"


def labels(names: Sequence[str], most: int = 28) -> list[str]:
    """Names that fit a legend and are told apart there."""
    short = [shortened(name, most) for name in names]
    count = collections.Counter(short)
    seen: collections.Counter[str] = collections.Counter()
    for k, name in enumerate(short):
        if count[name] > 1:
            seen[name] += 1
            short[k] = f"{name} ({seen[name]})"
    return short


def names_of(paths: Sequence[pathlib.Path]) -> list[str]:
    """File names, with as many of their folders as tell them apart."""
    longest = max(len(path.parts) for path in paths)
    for count in range(1, longest + 1):
        names = ["/".join(path.parts[-count:]) for path in paths]
        if len(set(names)) == len(names):
            return names
    return [path.name for path in paths]
