"""Lays out what Sphinx reads: links to the repository's pages and files, beside pages that are generated.

    stage.py FOLDER COMMANDS     COMMANDS: the pages that `bandvox --write-manual` writes
"""

import pathlib
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADERS = ROOT / "lib" / "include"
# What pages show or link to. Notebooks are pages after they have been run.
LINKED = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "docs", "examples", "lib", "benchmarks"]


def write_api(folder):
    """A page for each stage, a section for each public header."""
    folder.mkdir()
    stages = sorted(path for path in (HEADERS / "bandvox").iterdir() if path.is_dir())
    for stage in stages:
        lines = [f"# C++: {stage.name}", ""]
        for header in sorted(stage.glob("*.h")):
            name = header.relative_to(HEADERS).as_posix()
            lines += [f"## {name}", "", "```cpp", f"#include <{name}>", "```", "",
                      "```{eval-rst}", f".. doxygenfile:: {name}", "   :sections: briefdescription"
                      " detaileddescription innerclass define enum func typedef var"
                      " user-defined public-attrib public-func public-static-func public-type", "```", ""]
        (folder / f"{stage.name}.md").write_text("\n".join(lines), encoding="utf-8")


def main():
    folder, commands = map(pathlib.Path, sys.argv[1:])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name in LINKED:
        (folder / name).symlink_to(ROOT / name)
    (folder / "commands").symlink_to(commands.resolve())
    write_api(folder / "api")


if __name__ == "__main__":
    main()
