"""Docstrings are plain text: what reStructuredText would take for markup is escaped."""

import re


def escape(app, what, name, obj, options, lines):
    for i, line in enumerate(lines):
        line = line.replace("\\", "\\\\")
        lines[i] = re.sub(r"([*`|]|_(?!\w))", r"\\\1", line)


def setup(app):
    app.connect("autodoc-process-docstring", escape)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
