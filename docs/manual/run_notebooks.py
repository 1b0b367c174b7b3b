"""Runs notebooks and writes each as a page with its pictures; one that fails, or holds outputs, is an error.

    run_notebooks.py FOLDER PAGES     FOLDER: of the notebooks; PAGES: where the pages go
"""

import os
import pathlib
import sys
import tempfile

import nbformat
from nbconvert import MarkdownExporter
from nbconvert.preprocessors import ExecutePreprocessor


def page_of(path, folder):
    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        if cell.cell_type == "code" and (cell.outputs or cell.execution_count):
            sys.exit(f"{path}: holds outputs; clear them before it is committed")
    # What it writes is in a folder of its own.
    with tempfile.TemporaryDirectory() as work:
        runner = ExecutePreprocessor(timeout=120, kernel_name="python3")
        runner.preprocess(notebook, {"metadata": {"path": work}})
    # Notebooks show the best form of an output, which for a page is a drawing or a picture.
    exporter = MarkdownExporter(config={"NbConvertBase": {"display_data_priority": [
        "image/svg+xml", "image/png", "text/plain"]}})
    name = path.stem
    text, resources = exporter.from_notebook_node(
        notebook, resources={"output_files_dir": f"{name}_files", "unique_key": name})
    for file, content in resources["outputs"].items():
        target = folder / file
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)
    (folder / f"{name}.md").write_text(text, encoding="utf-8")


def main():
    source, folder = map(pathlib.Path, sys.argv[1:])
    folder.mkdir(parents=True, exist_ok=True)
    # The kernel inherits it.
    os.environ["PYTHONPATH"] = os.environ["BANDVOX_PYTHON"]
    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # It warns of the modules that Python itself has frozen.
    os.environ["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"
    notebooks = sorted(source.glob("*.ipynb"))
    if not notebooks:
        sys.exit(f"{source}: there are no notebooks")
    for path in notebooks:
        page_of(path, folder)


if __name__ == "__main__":
    main()
