"""docs/python.md tells of all that the package has."""

import pathlib
import re

import bandvox

ROOT = pathlib.Path(__file__).resolve().parents[2]


def test_every_function_is_told_of():
    text = (ROOT / "docs" / "python.md").read_text()
    untold = {"shape_names", "thread_count", "DrawnPath", "DrawnRegion", "Picture", "Error"}
    for name in set(bandvox.__all__) - untold:
        if not name.startswith("__"):
            assert re.search(rf"\b{name}\b", text), name
