# SPDX-License-Identifier: MIT
"""What a picture cannot be drawn of."""


class PlotError(ValueError):
    """An input that has no picture: what, where, and what would be right."""


class MissingModule(ImportError):
    """Something that a picture needs is not installed."""
