#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Fails when a folder includes or calls what it must not know about.

check_includes.py [ROOT]; one line per offence, exit status 1 if there is one.
"""

import pathlib
import re
import sys

# The rooms in their order: each may include what stands before it in its own
# list, and every room of the lists that ROOMS gives it.
DATASET = ["dataset/files", "dataset/recording", "dataset/netcdf",
           "dataset/log", "dataset/set/shard", "dataset/set"]
SIM = ["sim/numerics", "sim/thermal", "sim/signal", "sim/memory",
       "sim/device", "sim/dynamics", "sim/stepper", "sim/scenario",
       "sim/campaign"]
COMPENSATION = [f"compensation/{room}" for room in
                ("inputs", "firmware", "models", "uncertainty", "rows",
                 "network", "methods", "compensator", "scoring", "training", "export")]

VALIDATION = [f"validation/{room}" for room in
              ("external", "evidence", "metrics", "checks", "specification",
               "qualification", "result", "page", "bundle")]

SENSITIVITY = [f"sensitivity/{room}" for room in
               ("indices", "figures", "study")]

BASE = ["config", "linear_algebra", "statistics", "random", "parallel",
        "include"]


def in_order(rooms, below):
    return {room: {*below, *rooms[:k]} for k, room in enumerate(rooms)}


ALL = [*BASE, *DATASET, *SIM, *COMPENSATION]

# What each room may include besides itself.
MAY_INCLUDE = {
    "config": {"include"}, "linear_algebra": set(), "random": set(),
    "statistics": {"linear_algebra", "random"},
    "parallel": set(), "include": set(),
    **in_order(DATASET, ["config", "include"]),
    **in_order(SIM, [*BASE, *DATASET]),
    **in_order(COMPENSATION, [*BASE, *DATASET]),
    **in_order(VALIDATION, ALL),
    **in_order(SENSITIVITY, ALL),
    # Its binary carries what it includes, so it knows no files of others.
    "fmu": {"include", "config", "sim/numerics", "sim/device", "sim/dynamics",
            "sim/stepper"},
    # Designs need no physics but heat flow.
    "planning": {*BASE, *DATASET, *COMPENSATION, "sim/numerics",
                 "sim/thermal"},
    "report": {*ALL, *VALIDATION, *SENSITIVITY, "planning"},
    "api": {*ALL, *VALIDATION, *SENSITIVITY, "planning", "report", "fmu"},
    # The commands: the public library, and what it has no door to: writing
    # and watching files and processes, logs, sets in the making.
    "cli": {"include", "api", "report", "config", "dataset/files",
            "dataset/netcdf", "dataset/log", "dataset/set", "sim/campaign",
            "validation/external", "validation/bundle"},
    # The package of Python: the public headers, and few parts below them.
    "python": {"include", "api", "dataset/recording", "dataset/netcdf",
               "compensation/inputs", "compensation/rows",
               "validation/external"},
    "bench": {*ALL, *VALIDATION, *SENSITIVITY, "planning", "report", "fmu"},
    "fuzz": set(ALL),  # of tests/ only
    # of tests/ only
    "agreement": {*ALL, *VALIDATION, *SENSITIVITY, "planning"},
}
# Beside each other, not above each other.
MAY_INCLUDE["sensitivity/indices"] = {"random", "statistics"}
MAY_INCLUDE["sensitivity/figures"] -= {"sensitivity/indices"}
MAY_INCLUDE["dataset/recording"] -= {"dataset/files"}
MAY_INCLUDE["dataset/log"] -= {"dataset/netcdf"}
MAY_INCLUDE["dataset/set/shard"] -= {"dataset/log"}
MAY_INCLUDE["sim/signal"] -= {"sim/thermal"}
MAY_INCLUDE["sim/memory"] -= {"sim/signal"}
MAY_INCLUDE["sim/numerics"] = {"linear_algebra"}
MAY_INCLUDE["compensation/firmware"] -= {"compensation/inputs"}
MAY_INCLUDE["compensation/models"] -= {"compensation/inputs"}
MAY_INCLUDE["compensation/network"] -= {"compensation/inputs",
                                        "compensation/rows"}
for room in [*SIM[:-1]]:
    MAY_INCLUDE[room] -= {"dataset/set", "dataset/set/shard", "parallel"}

# Libraries that have one home, as prefixes of paths.
ONE_HOME = [
    (r"(sundials|cvode|nvector|sunmatrix|sunlinsol|sunnonlinsol)\w*/",
     ("sim/numerics/",)),
    (r"(hdf5|H5)\w*\.h",
     ("dataset/netcdf/", "dataset/set/shard/", "dataset/set/set_view.cpp",
      "tests/dataset/")),
    (r"libdeflate\.h", ("dataset/set/shard/chunk_filters.cpp",
                         "dataset/netcdf/inflate.cpp",
                         "dataset/files/zip_archive.cpp")),
    (r"openssl/", ("dataset/files/sha256.cpp",)),
    (r"toml\+\+/|toml\.hpp", ("config/",)),
    (r"CLI/", ("cli/",)),
    (r"boost/random/", ("sim/campaign/scrambled_sobol.cpp",)),
    (r"Random123/", ("random/", "tests/")),
    # What compiles Eigen's decompositions: seconds in every source.
    (r"Eigen/(?!Core$)|unsupported/Eigen/", ("linear_algebra/", "tests/")),
]

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)', re.MULTILINE)
RAW_TEXT = re.compile(r'R"(\w*)\(.*?\)\1"', re.DOTALL)
COMMENT_OR_TEXT = re.compile(
    r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
FRONT_END_ONLY = re.compile(
    r"\bstd::(?:cout|cerr|clog|exit|quick_exit|abort|getenv)\b"
    r"|\b(?:printf|fprintf|vprintf|puts|fputs|exit|_exit|abort|getenv)\s*\("
    r"|\bfmt::print\b")
OPTION = re.compile(r"(?<![\w-])--[a-z][\w-]*")
# A library names what is wrong and leaves dashes to the program (OptionError).
# These may name options of the command line, and why:
NAMED_OPTIONS = {
    # which commands take files of a kind
    "api/file_kind.cpp": {"--model", "--qualification", "--spec", "--map",
                          "--json"},
    # why a device of a set failed: bytes of the set
    "config/overrides.cpp": {"--set"},
    # import is a command of the program alone
    "report/recording_report.cpp": {"--join"},
    "validation/bundle/bundle.cpp": {"--bundle"},
}
PUBLIC = "include/beamgyro/"
FRONT_ENDS = ("cli/", "bench/", "tests/")


def room_of(path):
    """The room a path belongs to, or None: sim/thermal/x.h -> sim/thermal."""
    rooms = [room for room in MAY_INCLUDE if path.startswith(room + "/")]
    return max(rooms, key=len, default=None)


def allowed_in(path):
    """The rooms that a file may include, or None if it belongs to no room.

    A test belongs to a top-level folder: it may include what one of the rooms
    there may.
    """
    if not path.startswith("tests/"):
        room = room_of(path)
        return MAY_INCLUDE[room] | {room} if room else None
    folder = path.split("/")[1]
    rooms = {room for room in MAY_INCLUDE if room.split("/")[0] == folder}
    return rooms.union(*(MAY_INCLUDE[room] for room in rooms)) or None


def offences(path, text):
    allowed = allowed_in(path)
    if allowed is None:
        yield "belongs to no room that scripts/check_includes.py knows"
        return
    text = RAW_TEXT.sub('""', text)  # holds code of others
    for quote, target in INCLUDE.findall(text):
        for library, home in ONE_HOME:
            if re.match(library, target) and not path.startswith(home):
                yield f"<{target}> is for {home[0]}* only"
        if quote == "<":
            continue
        if path.startswith(PUBLIC) and target.startswith("beamgyro/"):
            continue  # as users name it
        if target.startswith((".", "/")) or "/" not in target:
            yield f'"{target}" must be named from the project root'
            continue
        other = room_of(target)
        if path.startswith(("tests/", "bench/")) and target.startswith(
                "tests/"):
            continue  # bench measures what tests hold
        if target.startswith("tests/") or other not in allowed:
            yield f'must not include "{target}"'
    if not path.startswith(FRONT_ENDS):
        for part in COMMENT_OR_TEXT.findall(text):
            for option in OPTION.findall(part) if part[0] == '"' else []:
                if option not in NAMED_OPTIONS.get(path, ()):
                    yield f"only cli/ knows options of the program: {option}"
        code = COMMENT_OR_TEXT.sub('""', text)
        for call in sorted(set(FRONT_END_ONLY.findall(code))):
            yield f"only cli/ prints, exits or reads the environment: {call}"


def main(root):
    folders = sorted({room.split("/")[0] for room in MAY_INCLUDE} | {"tests"})
    paths = [path for folder in folders
             for path in sorted((root / folder).rglob("*"))
             if path.suffix in {".h", ".cpp"}]
    if not paths:
        print(f"{root}: no sources here", file=sys.stderr)
        return 1
    bad = 0
    for path in paths:
        name = path.relative_to(root).as_posix()
        for offence in offences(name, path.read_text(encoding="utf-8")):
            print(f"{name}: {offence}")
            bad += 1
    return 1 if bad else 0


if __name__ == "__main__":
    here = pathlib.Path(__file__).resolve().parent.parent
    sys.exit(main(pathlib.Path(sys.argv[1]) if sys.argv[1:] else here))
