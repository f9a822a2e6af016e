# SPDX-License-Identifier: MIT
"""Runs the code of README.md, of every guide and tutorial, in order.

A block `sh` or `python` is run in a directory that looks like that of the
project. A block `text` after it is what it prints: a line `...` stands for any
lines, `...` within a line for any text.
"""

import re
import shutil
import subprocess
import sys

import pytest

from program import PATIENCE, PROGRAM, ROOT

# What library.md shows is C++, and built by library_test.py.
GUIDES = [page for page in sorted((ROOT / "docs/guide").glob("*.md"))
          if page.stem != "library"]
TUTORIALS = sorted((ROOT / "docs/tutorials").glob("*.md"))
PAGES = [ROOT / "README.md", *GUIDES, *TUTORIALS]
BLOCK = re.compile(r"^```(sh|python|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
MARK = "---8<---"


def steps(guide):
    """Language, code and expected output (or None) of each block of code."""
    blocks = BLOCK.findall(guide.read_text())
    for (kind, text), following in zip(blocks, [*blocks[1:], ("", "")]):
        if kind != "text":
            yield kind, text, following[1] if following[0] == "text" else None


def pattern(expected):
    """Regular expression of a block `text`."""
    lines = ["(?:.*\n)*" if line == "..." else
             ".*".join(map(re.escape, line.split("..."))) + "\n"
             for line in expected.splitlines()]
    return re.compile("".join(lines))


def project(folder):
    """A directory with what the commands of the guides name."""
    shutil.copytree(ROOT / "scenarios", folder / "scenarios")
    for name in ["examples", "include", "specs"]:
        (folder / name).symlink_to(ROOT / name)
    program = folder / "build/release/beamgyro"
    program.parent.mkdir(parents=True)
    program.symlink_to(PROGRAM)
    (program.parent / "python").symlink_to(PROGRAM.parent / "python")


def run_guide(guide, folder):
    """What each step printed."""
    script = ["set -euo pipefail"]
    for kind, code, _ in steps(guide):
        script += [code if kind == "sh" else
                   f"{sys.executable} - <<'PYTHON'\n{code}PYTHON",
                   f"echo '{MARK}'"]
    answer = subprocess.run(["bash", "-c", "\n".join(script)], cwd=folder,
                            text=True, stdin=subprocess.DEVNULL, check=False,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            timeout=PATIENCE)
    assert answer.returncode == 0, answer.stdout
    return answer.stdout.split(f"{MARK}\n")[:-1]


@pytest.mark.early
@pytest.mark.parametrize("guide", PAGES, ids=lambda guide: guide.stem)
def test_a_guide_prints_what_it_says(guide, tmp_path):
    project(tmp_path)
    printed = run_guide(guide, tmp_path)
    expected = [text for _, _, text in steps(guide)]
    assert len(printed) == len(expected)
    if guide.stem == "README":  # fits a terminal of 100 columns
        assert max(map(len, "".join(printed).splitlines())) <= 100
    for text, output in zip(expected, printed):
        if text is not None:
            assert pattern(text).fullmatch(output), \
                f"{guide.name} says\n{text}\nprinted is\n{output}"


def test_every_guide_is_found():
    names = {guide.stem for guide in GUIDES}
    assert {"first_run", "chamber_log", "firmware"} <= names
    assert len(TUTORIALS) >= 4
    for guide in GUIDES + TUTORIALS:
        if guide.stem == "plots":
            continue  # draws, and prints nothing
        assert any(text for _, _, text in steps(guide)), guide
