#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Fails when a folder includes or calls what it must not know about.

check_includes.py [ROOT]; one line per offence, exit status 1 if there is one.
"""

import pathlib
import re
import sys

NUMERICS = {"sim/numerics"}
FILES = {"config", "dataset"}
SETS = {"dataset/set"}
SIM = {"sim/numerics", "sim/device", "sim/thermal", "sim/signal",
       "sim/dynamics", "sim/scenario", "sim/campaign"}

# What each room may include besides itself.
MAY_INCLUDE = {
    "parallel": set(),
    "config": set(),
    "dataset": {"config"},
    "dataset/set": FILES,
    "sim/numerics": set(),
    "sim/thermal": FILES | NUMERICS,
    "sim/signal": FILES | NUMERICS,
    "sim/device": FILES | NUMERICS | {"sim/thermal", "sim/signal"},
    "sim/dynamics": FILES | SIM - {"sim/scenario", "sim/campaign"},
    "sim/scenario": FILES | SIM - {"sim/campaign"},
    "sim/campaign": FILES | SETS | SIM | {"parallel"},
    "compensation": FILES | SETS | {"parallel"},
    "cli": FILES | SETS | SIM | {"compensation"},
    "bench": FILES | SETS | SIM | {"compensation"},
    "fuzz": FILES | SETS | SIM | {"compensation"},  # of tests/ only
    "agreement": FILES | SIM | {"compensation"},  # of tests/ only
}

# Libraries that have one home, as prefixes of paths.
ONE_HOME = [
    (r"(sundials|cvode|nvector|sunmatrix|sunlinsol|sunnonlinsol)\w*/",
     ("sim/numerics/",)),
    (r"(hdf5|H5)\w*\.h", 
     ("dataset/hdf5_", "dataset/set/hdf5_", "tests/dataset/hdf5_",
      "tests/dataset/set/hdf5_")),
    (r"libdeflate\.h", ("dataset/set/chunk_filters.cpp",)),
    (r"openssl/", ("dataset/sha256.cpp",)),
    (r"toml\+\+/|toml\.hpp", ("config/",)),
    (r"CLI/", ("cli/",)),
    (r"ceres/", ("compensation/lbfgs_trainer.cpp",)),
    (r"boost/random/", ("sim/campaign/scrambled_sobol.cpp",)),
    (r"Random123/", ("dataset/random_stream", "tests/")),
]

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)', re.MULTILINE)
RAW_TEXT = re.compile(r'R"(\w*)\(.*?\)\1"', re.DOTALL)
COMMENT_OR_TEXT = re.compile(
    r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
FRONT_END_ONLY = re.compile(
    r"\bstd::(?:cout|cerr|clog|exit|quick_exit|abort|getenv)\b"
    r"|\b(?:printf|fprintf|vprintf|puts|fputs|exit|_exit|abort|getenv)\s*\("
    r"|\bfmt::print\b")
FRONT_ENDS = ("cli/", "bench/", "tests/")


def room_of(path):
    """The room a path belongs to, or None: sim/thermal/x.h -> sim/thermal."""
    inside = path.removeprefix("tests/")
    rooms = [room for room in MAY_INCLUDE if inside.startswith(room + "/")]
    return max(rooms, key=len, default=None)


def offences(path, text):
    room = room_of(path)
    if room is None:
        yield "belongs to no room that scripts/check_includes.py knows"
        return
    text = RAW_TEXT.sub('""', text)  # holds code of others
    for quote, target in INCLUDE.findall(text):
        for library, home in ONE_HOME:
            if re.match(library, target) and not path.startswith(home):
                yield f"<{target}> is for {home[0]}* only"
        if quote == "<":
            continue
        if target.startswith((".", "/")) or "/" not in target:
            yield f'"{target}" must be named from the project root'
            continue
        other = room_of(target)
        allowed = MAY_INCLUDE[room] | {room}
        if path.startswith("tests/") and target.startswith("tests/"):
            continue
        if target.startswith("tests/") or other not in allowed:
            yield f'must not include "{target}"'
    if not path.startswith(FRONT_ENDS):
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
