#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Bundles the sources for clang-tidy, most of whose time goes to headers.

tidy_bundles.py BUILD LINES: reads BUILD/compile_commands.json, of a build that
has no bundles of its own, and writes BUILD/bundles/*.cpp, of about so many
lines each, with a compile_commands.json beside them. Prints their names, the
longest first. A source goes into the first bundle of its library that has room
and no local name of it; tests count as one library, and benchmarks.
"""

import json
import pathlib
import re
import shlex
import sys

from check_names import library_of, local_names

ROOT = pathlib.Path(__file__).resolve().parent.parent
# What the compiler writes, and where.
OUTPUTS, PLACES = {"-c", "-MD"}, {"-o", "-MT", "-MF"}


class Source:
    def __init__(self, entry):
        self.path = pathlib.Path(entry["file"])
        self.text = self.path.read_text()
        self.lines = self.text.count("\n")
        name = self.path.relative_to(ROOT).as_posix()
        self.library = library_of(name) or name.split("/")[0]
        # Most tests have a namespace of their own.
        self.names = set() if re.search(r"^namespace \w+::\w+::\w+ \{$",
                                        self.text, re.MULTILINE) \
            else local_names(self.text)
        self.macros, self.options = {"main": f"main_of_{self.path.stem}"}, []
        words = iter(shlex.split(entry["command"])[1:])
        for word in words:
            if word.startswith(("-DBEAMGYRO_", "-DLLVM")):
                name, _, value = word[2:].partition("=")
                self.macros[name] = value
            elif word in ("-isystem", "-include"):
                self.options.append((word, next(words)))
            elif word in PLACES:
                next(words)
            elif word not in OUTPUTS and word != entry["file"]:
                self.options.append((word,))

    def fits(self, other):
        return self.library == other.library and not self.names & other.names

    def included(self):
        return "".join(f"#define {name} {value}\n"
                       for name, value in self.macros.items()) + \
            f'#include "{self.path}"\n' + \
            "".join(f"#undef {name}\n" for name in self.macros)


def bundled(sources, lines):
    """Lists of sources."""
    bundles = []
    for source in sources:
        for bundle in bundles:
            if sum(other.lines for other in bundle) + source.lines <= lines \
                    and all(map(source.fits, bundle)):
                bundle.append(source)
                break
        else:
            bundles.append([source])
    return bundles


def main():
    build, lines = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2])
    entries = {entry["file"]: entry for entry in json.loads(
        (build / "compile_commands.json").read_text())}
    sources = [Source(entry) for name, entry in sorted(entries.items())
               if pathlib.Path(name).is_relative_to(ROOT)
               and not pathlib.Path(name).is_relative_to(build)
               and name.endswith(".cpp")]
    folder = build / "bundles"
    folder.mkdir(exist_ok=True)
    for old in folder.glob("*.cpp"):
        old.unlink()
    commands = []
    bundles = sorted(bundled(sources, lines), reverse=True,
                     key=lambda bundle: sum(one.lines for one in bundle))
    for number, bundle in enumerate(bundles):
        path = folder / f"{number:02}.cpp"
        print(path)
        path.write_text("".join(source.included() for source in bundle))
        options = dict.fromkeys(option for source in bundle
                                for option in source.options)
        commands.append({"directory": str(build), "file": str(path),
                         "arguments": ["c++",
                                       *(word for option in options
                                         for word in option),
                                       "-c", str(path)]})
    (folder / "compile_commands.json").write_text(json.dumps(commands))


main()
