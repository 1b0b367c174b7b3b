"""The programs in examples/python run, and write what they say."""

import pathlib
import re
import subprocess
import sys

import pytest

EXAMPLES = sorted((pathlib.Path(__file__).resolve().parents[2] / "examples" / "python").glob("*.py"))


def test_there_are_examples():
    assert len(EXAMPLES) >= 4


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run(example, tmp_path):
    promised = re.search(rf"{example.name} FOLDER writes (.*) there\.", example.read_text())[1]
    names = set(re.split(r", | and ", promised))
    found = subprocess.run([sys.executable, "-B", "-W", "error", str(example), str(tmp_path)],
                           text=True, capture_output=True)
    assert found.returncode == 0, found.stderr
    assert found.stdout.strip() and not found.stderr
    assert {path.name for path in tmp_path.iterdir()} == names
    assert all(path.stat().st_size > 0 for path in tmp_path.iterdir())
