# SPDX-License-Identifier: MIT
"""Reads the reference pages of docs/."""

import re

from program import ROOT


def page(name):
    """Text of docs/reference/NAME.md."""
    return (ROOT / f"docs/reference/{name}.md").read_text()


def section(text, title):
    """What stands below the heading `## title`."""
    return text.split(f"\n## {title}\n")[1].split("\n## ")[0]


def rows(text):
    """Text by name of every table row "| `name` | text |" and of every list
    item "- `name` (default): text" or "- `name`, `name`: text"."""
    found = {match[1]: match[2] for match in
             re.finditer(r"^\| `([^`]+)` \| (.*) \|$", text, re.MULTILINE)}
    for item in re.split(r"\n(?=\n|- |#)", text):
        item = " ".join(item.split())
        if match := re.match(r"- ((?:`[^`]+`,? ?)+)(\([^:]*\))?: (.*)",
                             item):
            for name in re.findall("`([^`]+)`", match[1]):
                found[name] = f"{match[2] or ''} {match[3]}"
    return found
