#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Lays out what Sphinx reads: pages.py XML DIR

XML is what Doxygen has read from the public headers.
The Markdown pages of the project are copied as they are, in their places, so
that links between them hold. To these come the front page, a gallery of the
pictures, and a page of C++ for each public header.
"""

import pathlib
import re
import shutil
import sys
from xml.etree import ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITE = ROOT / "docs/site"
PAGES = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "THIRD_PARTY.md",
         "bench/*.md", "docs/*.md", "docs/guide/*.md",
         "docs/tutorials/*.md", "docs/reference/*.md"]
# What pages link to besides pages.
FILES = ["LICENSE", "CITATION.cff", "docs/pictures/*"]
# What Doxygen calls a free declaration, and the directive that shows it.
DIRECTIVES = {"function": "doxygenfunction", "enum": "doxygenenum",
              "typedef": "doxygentypedef", "variable": "doxygenvariable",
              "define": "doxygendefine"}
PICTURE = re.compile(r"!\[([^\]]*)\]\(([^)]*/(plot_\w+)\.png)\)")


def copy_pages(target):
    """Copies pages and pictures to the same places below the target."""
    for pattern in PAGES + FILES:
        for path in sorted(ROOT.glob(pattern)):
            place = target / path.relative_to(ROOT)
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, place)


def heading(text, line="="):
    """A heading of reStructuredText."""
    return f"{text}\n{line * len(text)}\n\n"


def declarations(xml, compound):
    """Directives of what stands free in a compound of Doxygen, by header."""
    tree = ElementTree.parse(xml / f"{compound}.xml")
    for member in tree.iter("memberdef"):
        name = member.findtext("qualifiedname") or member.findtext("name")
        arguments = member.findtext("argsstring") or ""
        header = pathlib.Path(member.find("location").get("file")).name
        directive = DIRECTIVES[member.get("kind")]
        if directive == "doxygenfunction":
            name += arguments
        yield header, f".. {directive}:: {name}\n"


def doxygen_name(header):
    """What doxygen calls a header: an underscore is written twice."""
    return header.stem.replace("_", "__") + "_8h"


def header_page(xml, header, free):
    """The page of one public header: what it is, classes, free functions."""
    tree = ElementTree.parse(xml / f"{doxygen_name(header)}.xml")
    parts = [heading(f"beamgyro/{header.name}"),
             f".. doxygenfile:: {header.name}\n"
             "   :sections: briefdescription detaileddescription\n"]
    for inner in tree.iter("innerclass"):
        if inner.get("prot") == "public" and inner.text.count("::") == 1:
            kind = inner.get("refid").split("beamgyro")[0]  # class or struct
            parts.append(f".. doxygen{kind}:: {inner.text}\n   :members:\n"
                         "   :undoc-members:\n")
    return "\n".join(parts + [line for name, line in free
                              if name == header.name])


def write_cpp_pages(target, xml):
    """A page of each public header, and one that lists them."""
    folder = target / "cpp"
    folder.mkdir(parents=True)
    headers = sorted((ROOT / "include/beamgyro").glob("*.h"))
    free = list(declarations(xml, "namespacebeamgyro"))
    for header in headers:
        own = list(declarations(xml, doxygen_name(header)))
        (folder / f"{header.stem}.rst").write_text(
            header_page(xml, header, free + own))
    text = (SITE / "cpp.rst").read_text()
    (folder / "index.rst").write_text(
        text + "".join(f"   {header.stem}\n" for header in headers))


def gallery(pages):
    """Every picture of `beamgyro plot` once, under what a page calls it."""
    seen = {}
    for page in pages:
        for words, _, name in PICTURE.findall(page.read_text()):
            seen.setdefault(name, (words, page.relative_to(ROOT)))
    parts = [(SITE / "gallery.md").read_text()]
    for picture in sorted((ROOT / "docs/pictures").glob("plot_*.png")):
        words, page = seen.get(picture.stem, (picture.stem, None))
        parts.append(f"\n## {words}\n\n![{words}](docs/pictures/"
                     f"{picture.name})\n")
        if page:
            parts.append(f"\nFrom the page [{page.stem}]({page}).\n")
    return "".join(parts)


def main():
    """Makes the directory anew."""
    xml, target = map(pathlib.Path, sys.argv[1:])
    shutil.rmtree(target, ignore_errors=True)
    target.mkdir(parents=True)
    copy_pages(target)
    for name in ["conf.py", "index.md", "python.rst"]:
        shutil.copy(SITE / name, target)
    write_cpp_pages(target, xml)
    (target / "gallery.md").write_text(
        gallery(sorted((ROOT / "docs").rglob("*.md"))))


if __name__ == "__main__":
    main()
