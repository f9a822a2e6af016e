#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws files of beamgyro. `beamgyro plot` runs this script.

__main__.py FILE... [-o PICTURE [--format png|svg]] [--compare] [--curves]
__main__.py RESULT.json --each DIR

With --curves it reads a line for each file: of a compensator its curve.
"""

import argparse
import importlib.util
import json
import os
import pathlib
import sys
from typing import Any, NoReturn

HERE = pathlib.Path(__file__).resolve().parent
WRONG_INPUT, NOT_POSSIBLE = 2, 3
DPI, HIGHEST_WINDOW = 100.0, 900.0  # of a window, which a screen has to hold


def load_package() -> Any:
    """The package that this script belongs to, without the one around it,
    which needs its compiled part."""
    sys.path[:] = [folder for folder in sys.path
                   if pathlib.Path(folder or ".").resolve() != HERE]
    spec = importlib.util.spec_from_file_location(
        "beamgyro_plots", HERE / "__init__.py",
        submodule_search_locations=[str(HERE)])
    assert spec and spec.loader
    package = importlib.util.module_from_spec(spec)
    sys.modules["beamgyro_plots"] = package
    spec.loader.exec_module(package)
    return package


def fail(status: int, message: object) -> NoReturn:
    """Ends with a message of one line: a file name may have several."""
    print("\\n".join(str(message).splitlines()), file=sys.stderr)
    sys.exit(status)


def require_window() -> None:
    """Ends unless a window can be opened."""
    display = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    if not display:
        fail(WRONG_INPUT, "no display for a window; expected "
             "-o PICTURE.png or -o PICTURE.svg")
    import matplotlib
    from matplotlib import pyplot
    try:
        pyplot.switch_backend(matplotlib.rcParams["backend"])
    except ImportError as error:
        fail(NOT_POSSIBLE, f"no window: {error} (python3-tk in Debian); or "
             "use -o PICTURE.png")
    if pyplot.get_backend().lower() not in map(
            str.lower, matplotlib.rcsetup.interactive_bk):
        wanted = os.environ.get("MPLBACKEND")
        fail(NOT_POSSIBLE, f"no window on display {display}: " +
             (f"MPLBACKEND is {wanted}" if wanted else "it is not there, or "
              "matplotlib has no windows (python3-tk in Debian)") +
             "; or use -o PICTURE.png")


def show(figures: list[Any], names: list[str]) -> None:
    """Opens a window for each figure and waits until all are closed."""
    from matplotlib import pyplot
    for figure, name in zip(figures, names):
        width, height = figure.get_size_inches()
        dpi = min(DPI, HIGHEST_WINDOW / height)
        figure.set_dpi(dpi)
        manager = pyplot.figure(figsize=(width, height),
                                dpi=dpi).canvas.manager
        figure.set_canvas(manager.canvas)
        manager.canvas.figure = figure
        manager.set_window_title(name)
    pyplot.show()


def main() -> None:
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("files", nargs="+")
    parser.add_argument("-o", "--output")
    parser.add_argument("--format", choices=["png", "svg"])
    parser.add_argument("--compare", action="store_true")
    parser.add_argument("--curves", action="store_true")
    parser.add_argument("--each", type=pathlib.Path)
    arguments = parser.parse_args()
    if arguments.output or arguments.each:  # whatever MPLBACKEND says
        os.environ["MPLBACKEND"] = "agg"
    try:
        plots = load_package()
    except ValueError:  # of matplotlib, which reads it first
        fail(WRONG_INPUT, f"MPLBACKEND is {os.environ.get('MPLBACKEND')}; "
             "expected one that matplotlib knows, or none")
    except ImportError as error:
        fail(NOT_POSSIBLE, f"{error}; pictures need Python 3 with matplotlib "
             "and h5py (python3-matplotlib and python3-h5py in Debian)")
    try:
        draw(plots, arguments)
    except plots.PlotError as error:
        fail(WRONG_INPUT, error)
    except ModuleNotFoundError as error:
        fail(NOT_POSSIBLE, f"{error}; pictures need python3-{error.name}")
    except OSError as error:
        fail(NOT_POSSIBLE, f"the picture was not written: {error.strerror}")
    except MemoryError:
        fail(NOT_POSSIBLE, f"{arguments.files[0]}: not enough memory to draw "
             "it")


def draw(plots: Any, arguments: argparse.Namespace) -> None:
    if arguments.curves:
        plots.compensator.CURVES.update(zip(
            map(pathlib.Path, arguments.files), map(json.loads, sys.stdin)))
    if arguments.each:
        plots.save_each(arguments.files[0], arguments.each)
    elif arguments.output:
        figure = plots.plot(arguments.files, arguments.compare)
        plots.save(figure, arguments.output, arguments.format)
    else:
        require_window()
        groups = [arguments.files] if arguments.compare \
            else [[file] for file in arguments.files]
        show([plots.plot(group, arguments.compare) for group in groups],
             [", ".join(group) for group in groups])


if __name__ == "__main__":
    main()
