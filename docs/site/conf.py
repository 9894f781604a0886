"""Sphinx's settings for the documentation site; tools/docs runs it. Every warning is an error there."""

import os
import pathlib
import re
import sys

sys.path.insert(0, os.path.dirname(__file__))
ROOT = pathlib.Path(__file__).resolve().parents[2]

project = "manyworlds"
author = "the authors of manyworlds"
version = re.search(r"project\(manyworlds VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
release = version

extensions = ["breathe", "myst_parser", "repository_links"]
root_doc = "README"
myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 4
breathe_projects = {"manyworlds": os.environ.get("MW_DOXYGEN_XML", "")}
breathe_default_project = "manyworlds"
breathe_show_include = False
# Each page of a header declares its namespace.
suppress_warnings = ["duplicate_declaration.cpp"]

html_theme = "furo"
html_title = f"manyworlds {version}"
html_static_path = []
html_show_sourcelink = False
html_copy_source = False
