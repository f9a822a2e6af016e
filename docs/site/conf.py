# SPDX-License-Identifier: MIT
"""Settings of Sphinx; scripts/docs.sh builds the site without a network."""

import os
import sys

sys.path.insert(0, os.environ["BEAMGYRO_PYTHON_PACKAGE"])

project = "beamgyro"
author = "the beamgyro authors"
copyright = "2026 the beamgyro authors"  # pylint: disable=redefined-builtin
release = os.environ["BEAMGYRO_VERSION"]

extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc",
              "sphinx.ext.napoleon"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # README pages begin where they like

breathe_projects = {"beamgyro": os.environ["BEAMGYRO_DOXYGEN"]}
breathe_default_project = "beamgyro"

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_default_options = {"members": True, "show-inheritance": False}

html_theme = "sphinx_rtd_theme"
html_copy_source = False
html_last_updated_fmt = None
html_theme_options = {"navigation_depth": 3}
pygments_style = "default"
highlight_language = "text"
