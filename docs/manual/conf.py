"""How Sphinx makes the manual. Started by scripts/build-manual, which says by the environment where things are."""

import os
import pathlib
import re
import sys

ROOT = pathlib.Path(os.environ["BANDVOX_ROOT"])
sys.path.insert(0, str(ROOT / "docs" / "manual"))
sys.path.insert(0, os.environ["BANDVOX_PYTHON"])

project = "Bandvox"
author = "The Bandvox authors"
version = release = re.search(r"project\(Bandvox VERSION ([0-9.]+)",
                              (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]

extensions = ["myst_parser", "sphinx.ext.autodoc", "breathe", "site_docstrings", "site_links", "site_math"]
root_doc = "docs/manual/index"
# The source folder is one of links to what lies in the repository, and of generated pages.
include_patterns = ["*.md", "docs/**", "benchmarks/*.md", "commands/*", "notebooks/*", "api/*"]
nitpicky = True
# Names of other libraries, and of the parts that classes keep to themselves.
nitpick_ignore_regex = [("cpp:identifier", r"bandvox|openvdb(::.*)?|SplineVolumeParts|EnvironmentMap|WindingTree"),
                        ("py:.*", r"(os|numpy|typing|distributed)\..*|bandvox\._bandvox\._.*|handle"),
                        # "Subclassed by": Breathe gives classes other labels than it takes them to have.
                        ("std:ref", r"(class|struct)bandvox_.*")]
exclude_patterns = ["docs/manual/theme"]

html_theme = "furo"
html_title = f"Bandvox {version}"
html_static_path = [str(ROOT / "docs" / "manual" / "theme"), os.environ["BANDVOX_KATEX"]]
html_css_files = ["katex.min.css", "manual.css"]
html_copy_source = html_show_sourcelink = False
# The web page of the manual begins in its uppermost folder.
html_extra_path = [str(ROOT / "docs" / "manual" / "theme" / "index.html")]
html_show_sphinx = html_show_copyright = False

# Options begin with two dashes, which have to stay two.
smartquotes = False
highlight_language = "none"
pygments_style, pygments_dark_style = "friendly", "monokai"

myst_enable_extensions = ["dollarmath", "deflist"]
# "$3, ... 5$" is not mathematics.
myst_dmath_allow_space = False
myst_heading_anchors = 4

autodoc_member_order = "bysource"
autodoc_typehints = "none"

breathe_projects = {"bandvox": os.environ["BANDVOX_XML"]}
breathe_default_project = "bandvox"
breathe_default_members = ("members",)
breathe_show_include = False
cpp_index_common_prefix = ["bandvox::"]
