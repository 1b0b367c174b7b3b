"""Lays out what Sphinx reads: links to the repository's pages and files, beside pages that are generated.

    stage.py FOLDER COMMANDS XML     COMMANDS: the pages that `bandvox --write-manual` writes; XML: Doxygen's output
"""

import pathlib
import shutil
import sys

from api_pages import write_api

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What pages show or link to. Notebooks are pages after they have been run.
LINKED = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "docs", "examples", "lib", "benchmarks"]


def main():
    folder, commands, xml = map(pathlib.Path, sys.argv[1:])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name in LINKED:
        (folder / name).symlink_to(ROOT / name)
    (folder / "commands").symlink_to(commands.resolve())
    write_api(xml, folder / "api")


if __name__ == "__main__":
    main()
