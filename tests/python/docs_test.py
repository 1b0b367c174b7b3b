"""What README.md and docs/python.md show of Python runs as it stands."""

import pathlib
import re
import subprocess
import sys

import pytest

import bandvox

ROOT = pathlib.Path(__file__).resolve().parents[2]
WRITTEN = {"README.md": {"torus.vdb", "torus.png"},
           "docs/python.md": {"bunny.vdb", "bunny.png", "surface.ply", "surface.vdb",
                              "surface.svg"}}


def blocks_of(page):
    return re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text(), re.DOTALL | re.MULTILINE)


def test_no_other_page_shows_python():
    pages = [page.relative_to(ROOT).as_posix() for page in (ROOT / "docs").rglob("*.md")]
    assert {page for page in [*pages, "README.md"] if blocks_of(page)} == set(WRITTEN)


@pytest.mark.parametrize("page", sorted(WRITTEN))
def test_the_blocks_of_a_page_run(page, tmp_path):
    bandvox.to_mesh(bandvox.bandlimit("shape:two-balls", resolution=32)).write(
        tmp_path / "bunny.obj")
    found = subprocess.run([sys.executable, "-B", "-c", "\n".join(blocks_of(page))], cwd=tmp_path,
                           text=True, capture_output=True)
    assert found.returncode == 0, found.stderr
    assert {path.name for path in tmp_path.iterdir()} == WRITTEN[page] | {"bunny.obj"}


def test_every_function_is_told_of():
    text = (ROOT / "docs" / "python.md").read_text()
    untold = {"shape_names", "thread_count", "DrawnPath", "DrawnRegion", "Picture", "Error"}
    for name in set(bandvox.__all__) - untold:
        if not name.startswith("__"):
            assert re.search(rf"\b{name}\b", text), name
