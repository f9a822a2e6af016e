#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes the manual pages and the bash completion from the program's own help.

help_pages.py PROGRAM COMMANDS.md DIR writes DIR/man1/beamgyro.1.gz, a page
DIR/man1/beamgyro-COMMAND.1.gz of each command, and DIR/completions/beamgyro.
The table of exit statuses is taken from COMMANDS.md. The same program gives
the same bytes.
"""

import gzip
import pathlib
import re
import subprocess
import sys
from dataclasses import dataclass, field

HERE = pathlib.Path(__file__).resolve().parent
TEXT_COLUMN = 26  # of the explanations in the help
LEFT = re.compile(r"  (\S.*?)(?:  +(\S.*))?$")


@dataclass
class Section:
    """A heading of the help with its entries or, of examples, its lines."""

    title: str
    entries: list[list[str]] = field(default_factory=list)  # left, text


@dataclass
class Help:
    """A help text taken to its parts."""

    summary: str
    usage: str
    sections: list[Section]

    def entries(self, title):
        """The entries of the section of this title; none without it."""
        return [entry for part in self.sections if part.title == title
                for entry in part.entries]


def joined(lines):
    """One paragraph of lines that the help has wrapped."""
    return " ".join(line.strip() for line in lines if line.strip())


def read_section(title, lines):
    """The entries of a section; each begins at the third column."""
    section = Section(title)
    for line in lines:
        begins = re.match(r"  \S", line)
        if begins and title == "Examples":
            section.entries.append([line.strip(), ""])
        elif begins:
            left, text = LEFT.match(line).groups()
            section.entries.append([left, text or ""])
        elif title == "Examples" and section.entries[-1][0].endswith("\\"):
            section.entries[-1][0] += "\n    " + line.strip()
        elif line.strip():
            entry = section.entries[-1]
            entry[1] = (entry[1] + " " + line.strip()).strip()
    return section


def read_help(text):
    """The parts of what the program prints for --help."""
    head, *rest = re.split(r"^(\S[^\n]*):$\n", text, flags=re.MULTILINE)
    summary, usage = head.split("Usage: ")
    return Help(joined(summary.splitlines()), joined(usage.splitlines()),
                [read_section(title, body.splitlines())
                 for title, body in zip(rest[::2], rest[1::2])])


def roff(text):
    """The text with what troff would take for its own made plain."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq")
    return re.sub(r"^\.", "\\\\&.", text, flags=re.MULTILINE)


def entry_lines(section):
    """troff of a section's entries."""
    for left, text in section.entries:
        if section.title == "Examples":
            yield from (".PP", ".nf", f"    {roff(left)}", ".fi", ".RS 8",
                        roff(text), ".RE")
        else:
            yield from (".TP", re.sub(r"(\\-[\w\\-]+)", r"\\fB\1\\fR",
                                      roff(left)), roff(text))


def page_name(command):
    """beamgyro or beamgyro-run."""
    return f"beamgyro-{command}" if command else "beamgyro"


def manual_page(command, text, others, version, statuses):
    """troff of one page; command is empty for that of the program."""
    name = page_name(command)
    summary = text.summary.rstrip(".")
    lines = [f'.TH {roff(name.upper())} 1 "" "beamgyro {version}" '
             '"User Commands"',
             ".SH NAME", f"{roff(name)} \\- {roff(summary)}",
             ".SH SYNOPSIS", roff(text.usage)]
    for section in text.sections:
        if section.title == "Examples":
            lines += [".SH EXIT STATUS"]
            for status, meaning in statuses:
                lines += [".TP", status, roff(meaning)]
        lines += [f".SH {roff(section.title.upper())}", *entry_lines(section)]
    seen = [page_name(other) for other in others if other != command]
    lines += [".SH SEE ALSO",
              ", ".join(f"\\fB{roff(page)}\\fR(1)" for page in seen) + ".",
              ".PP", roff("The documentation stands in "
                          "/usr/share/doc/beamgyro/docs.")]
    return "\n".join(lines) + "\n"


def options_of(text):
    """(names, stands for the value) of each option; "" for a flag."""
    for section in text.sections:
        for left, _ in section.entries if section.title != "Examples" else []:
            if left.startswith("-"):
                names, value = re.match(r"((?:-\w, )?--[\w-]+) ?(.*)",
                                        left).groups()
                yield names.split(", "), value


def values_of(value):
    """What the shell shall offer for a value: words, @files, @directories."""
    words = value.split("|")
    if all(re.fullmatch(r"[a-z0-9]+", word) for word in words):
        return " ".join(words)
    if value in ("DIR", "FILE"):
        return "@directories" if value == "DIR" else "@files"
    endings = re.findall(r"\.(\w+)", value)
    if value.endswith("png|svg"):
        endings.append("svg")
    return "@files " + " ".join(endings) if endings else ""


def completion(helps):
    """The script of bash: tables from the help, before what reads them."""
    options, values, arguments = [], [], []
    for command, text in helps.items():
        found = list(options_of(text))
        names = " ".join(name for both, _ in found for name in both)
        options.append(f'    "{command}") echo "{names}" ;;')
        if not command:
            continue
        for both, value in found:
            if value:
                cases = " | ".join(f"{command}:{name}" for name in both)
                values.append(f'    {cases}) echo "{values_of(value)}" ;;')
        endings = {ending for left, what in text.entries("Arguments")
                   for ending in re.findall(r"\b[A-Z]+\.(\w+)",
                                            f"{left} {what}")}
        if text.entries("Arguments"):
            arguments.append(
                f'    {command}) echo "@files {" ".join(sorted(endings))}" ;;')
    tables = {"commands": f'  echo "help{" ".join(helps)}"',
              "options": "\n".join(options), "values": "\n".join(values),
              "arguments": "\n".join(arguments)}
    text = (HERE / "completion.bash").read_text()
    for name, table in tables.items():
        text = re.sub(rf" +# {name}\n", table + "\n", text)
    return text


def exit_statuses(page):
    """Rows of the table of exit statuses."""
    table = page.split("| status | meaning |\n")[1].split("\n\n")[0]
    rows = [[cell.strip().replace("`", "") for cell in row.split("|")[1:3]]
            for row in table.splitlines()[1:]]
    return [(status, meaning) for status, meaning in rows]


def main():
    program, commands_page, folder = map(pathlib.Path, sys.argv[1:])

    def said(*words):
        return subprocess.run([program.resolve(), *words], check=True,
                              capture_output=True, text=True).stdout

    helps = {"": read_help(said("--help"))}
    for section in helps[""].sections:
        for left, _ in section.entries:
            if re.fullmatch(r"[a-z]+", left):
                helps[left] = read_help(said("help", left))
    version = said("--version").split()[1]
    statuses = exit_statuses(commands_page.read_text())
    pages = folder / "man1"
    pages.mkdir(parents=True, exist_ok=True)
    for old in pages.glob("*.gz"):
        old.unlink()
    for command, text in helps.items():
        page = manual_page(command, text, helps, version, statuses)
        (pages / f"{page_name(command)}.1.gz").write_bytes(
            gzip.compress(page.encode(), 9, mtime=0))
    shell = folder / "completions"
    shell.mkdir(exist_ok=True)
    (shell / "beamgyro").write_text(completion(helps))


if __name__ == "__main__":
    main()
