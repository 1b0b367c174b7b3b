"""Formulas as KaTeX draws them, while the manual is built: its pages need no script, and a formula that it does not
understand is a warning that names it."""

import atexit
import json
import os
import subprocess

from docutils.nodes import SkipNode

from sphinx.util import logging

# Answers each line, a formula, by a line with its HTML or what is wrong with it.
SERVER = """
const katex = require(process.argv[1]);
require('readline').createInterface({input: process.stdin}).on('line', line => {
    const {formula, display} = JSON.parse(line);
    let answer;
    try {
        answer = {html: katex.renderToString(formula, {displayMode: display, strict: 'error', output: 'htmlAndMathml'})};
    } catch (error) {
        answer = {error: String(error.message)};
    }
    process.stdout.write(JSON.stringify(answer) + '\\n');
});
"""
_logger = logging.getLogger(__name__)
_servers = {}
_done = {}


def _ask(formula, display):
    # Processes that write pages side by side do not share one.
    server = _servers.get(os.getpid())
    if server is None:
        server = _servers[os.getpid()] = subprocess.Popen(
            ["node", "-e", SERVER, os.path.join(os.environ["BANDVOX_KATEX"], "katex.min.js")],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8")
        atexit.register(server.terminate)
    print(json.dumps({"formula": formula, "display": display}), file=server.stdin, flush=True)
    line = server.stdout.readline()
    if not line:
        raise RuntimeError("node ended while it drew a formula; is Debian's libjs-katex there?")
    return json.loads(line)


def _draw(node, display):
    formula = node.astext().strip()
    key = (formula, display)
    if key not in _done:
        _done[key] = _ask(formula, display)
    if "error" in _done[key]:
        _logger.warning("formula %r: %s", formula, _done[key]["error"], location=node)
        return ""
    return _done[key]["html"]


def _inline(translator, node):
    translator.body.append(_draw(node, False))
    # What is in it is drawn already.
    raise SkipNode


def _block(translator, node):
    translator.body.append(_draw(node, True))
    raise SkipNode


def setup(app):
    app.add_html_math_renderer("katex", (_inline, None), (_block, None))
    app.config.html_math_renderer = "katex"
    return {"parallel_read_safe": True, "parallel_write_safe": True}
