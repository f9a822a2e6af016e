# SPDX-License-Identifier: MIT
"""HTML of what notebooks show."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return an HTML table."""
    def line(cells: Sequence[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>"
                                for cell in cells) + "</tr>"
    body = "".join(line(row, "td") for row in rows)
    return (f"<table><thead>{line(header, 'th')}</thead>"
            f"<tbody>{body}</tbody></table>")
