#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Fails when a file-local name could be taken for another one.

Libraries are compiled in bundles of sources, which share their anonymous
namespaces. There a name that another source of the library defines, or that a
header declares, would silently hide the other. Headers share one namespace:
two types of one name would be linked as if they were one, and constants of one
name keep two headers from being included together. Nor may a type of the
library bear the name of one of the public headers.

check_names.py [ROOT]; one line per offence, exit status 1 if there is one.
"""

import collections
import pathlib
import re
import sys

from check_includes import MAY_INCLUDE, room_of

# The sources that share bundles, as prefixes of paths; the first that fits.
LIBRARIES = ["dataset/set/", "dataset/", "sim/numerics/", "sim/thermal/",
             "sim/signal/", "sim/memory/", "sim/device/", "sim/dynamics/",
             "sim/stepper/", "sim/scenario/", "sim/campaign/", "fmu/", "compensation/", "config/",
             "linear_algebra/", "statistics/", "random/", "parallel/",
             "validation/", "planning/", "sensitivity/", "report/", "api/", "cli/",
             "python/"]


FUNCTION = re.compile(
    r"^(?:\[\[\w+\]\] )?[A-Za-z_][\w:<>,&* ]*[&* \n](\w+)\(", re.MULTILINE)
CONSTANT = re.compile(
    r"^(?:inline |static )?(?:constexpr|const) [\w:<>,&* ]*?\b(\w+)"
    r"(?:\[\w*\])* ?[={]", re.MULTILINE)
TYPE = re.compile(r"^(?:struct|class|enum class|enum) (\w+)", re.MULTILINE)
DEFINED_TYPE = re.compile(
    r"^(?:struct|class|enum class|enum) (\w+)(?: final)?(?:\s*:(?!:)[^;{}]*)?"
    r"\s*\{", re.MULTILINE)
LOCAL = re.compile(r"^namespace \{\n(.*?)^\}  // namespace$",
                   re.MULTILINE | re.DOTALL)


def names(text):
    text = re.sub(r"//[^\n]*", "", text)
    return {name for pattern in (FUNCTION, CONSTANT, TYPE)
            for name in pattern.findall(text)}


def local_names(text):
    """Those of its anonymous namespaces."""
    return {one for part in LOCAL.findall(text) for one in names(part)}


def library_of(path):
    return next((prefix for prefix in LIBRARIES if path.startswith(prefix)),
                None)


def sees(library, header):
    if library == "python/" or header.startswith("python/"):
        # The package of Python has a namespace of its own.
        return header.startswith(library)
    return library_of(header) == library or any(
        room_of(header) in MAY_INCLUDE[room]
        for room in MAY_INCLUDE if library_of(room + "/") == library)


def offences(root):
    declared = collections.defaultdict(list)
    defined = collections.defaultdict(list)
    types = collections.defaultdict(list)
    constants = collections.defaultdict(list)
    folders = {prefix.split("/")[0] for prefix in LIBRARIES}
    for path in sorted(path for folder in folders
                       for path in (root / folder).rglob("*")):
        name = path.relative_to(root).as_posix()
        if path.suffix == ".h":
            for one in names(path.read_text()):
                declared[one].append(name)
            for one in DEFINED_TYPE.findall(path.read_text()):
                types[one].append(name)
            for one in CONSTANT.findall(path.read_text()):
                constants[one].append(name)
        if path.suffix == ".cpp":
            for one in local_names(path.read_text()):
                defined[library_of(name), one].append(name)
    for path in sorted((root / "include").rglob("*.h")):
        for one in set(DEFINED_TYPE.findall(path.read_text())):
            types[one].append(path.relative_to(root).as_posix())
    for one, headers in sorted(types.items()):
        if len(headers) > 1:
            yield f"{one}: a type in {', '.join(headers)}"
    for one, headers in sorted(constants.items()):
        if len(headers) > 1:
            yield f"{one}: a constant in {', '.join(headers)}"
    for (library, one), files in sorted(defined.items()):
        hidden = [header for header in declared[one] if sees(library, header)]
        if len(files) > 1 or hidden:
            yield f"{one}: local to {', '.join(files)}" + (
                f", declared in {', '.join(hidden)}" if hidden else "")


def main(root):
    found = list(offences(root))
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    here = pathlib.Path(__file__).resolve().parent.parent
    sys.exit(main(pathlib.Path(sys.argv[1]) if sys.argv[1:] else here))
