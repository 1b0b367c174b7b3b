"""The tables of docs/performance.md are those that benchmarks/peers makes of what was measured."""

import shutil
import subprocess
import sys

import pages


def test_tables_are_made_of_what_was_measured(tmp_path):
    root = pages.ROOT
    page = tmp_path / "performance.md"
    shutil.copy(root / "docs" / "performance.md", page)
    subprocess.run([sys.executable, root / "benchmarks" / "peers", "--from",
                    root / "benchmarks" / "measured.json", "--page", page], check=True)
    assert page.read_text() == (root / "docs" / "performance.md").read_text()
    assert page.read_text().count("<!-- table: ") == page.read_text().count(" |\n| --- ") == 8
