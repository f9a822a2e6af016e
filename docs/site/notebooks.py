#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs notebooks and writes what they show as pages: notebooks.py DIR [FILE]...

Each page has the cells as they are, and below each what it showed: pictures
beside the page, HTML as it is, all else as text. An exception is a failure.
"""

import base64
import pathlib
import sys

import nbclient
import nbformat

ROOT = pathlib.Path(__file__).resolve().parents[2]
LONGEST = 600  # [s], a cell


def fenced(kind, text):
    """A block of Markdown; the fence is longer than any in the text."""
    fence = "`" * 3
    while fence in text:
        fence += "`"
    return f"{fence}{kind}\n{text.rstrip()}\n{fence}\n"


def shown(output, name, folder):
    """One output of a cell, as Markdown."""
    if output.output_type == "stream":
        return fenced("text", output.text) if output.name == "stdout" else ""
    data = output.data
    if "image/png" in data:
        (folder / f"{name}.png").write_bytes(base64.b64decode(
            data["image/png"]))
        return f"![What the cell above shows]({name}.png)\n"
    if "text/html" in data:
        return fenced("{raw} html", data["text/html"])
    return fenced("text", data["text/plain"])


def page(notebook, name, folder):
    """The text of a page."""
    parts = []
    for number, cell in enumerate(notebook.cells):
        if cell.cell_type == "markdown":
            parts.append(cell.source + "\n")
            continue
        parts.append(fenced("python", cell.source))
        parts += [shown(output, f"{name}_{number}_{part}", folder)
                  for part, output in enumerate(cell.outputs)]
    parts.append(f"The notebook is `examples/python/{name}.ipynb`; what it "
                 "shows was made with this page.\n")
    return "\n".join(parts)


def main():
    """Writes a page for each notebook."""
    folder = pathlib.Path(sys.argv[1])
    files = list(map(pathlib.Path, sys.argv[2:])) or sorted(
        (ROOT / "examples/python").glob("*.ipynb"))
    folder.mkdir(parents=True, exist_ok=True)
    for file in files:
        notebook = nbformat.read(file, 4)
        nbclient.NotebookClient(
            notebook, timeout=LONGEST, kernel_name="python3",
            resources={"metadata": {"path": str(ROOT)}}).execute()
        (folder / f"{file.stem}.md").write_text(
            page(notebook, file.stem, folder))


if __name__ == "__main__":
    main()
