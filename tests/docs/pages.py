"""The pages of the documentation, taken apart: blocks of code, headings, links."""

import dataclasses
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
FENCE = re.compile(r"^```(\S*)([^\n]*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
MARK = re.compile(r"<!-- not run: ([^\n]+?) -->\n\Z")
RUN = ("sh", "python")


@dataclasses.dataclass
class Block:
    language: str
    text: str
    line: int
    reason: str  # why it is not run; empty if it is


def all_pages():
    """Relative to the repository."""
    found = [*ROOT.glob("*.md")]
    for folder in ("docs", "examples", "benchmarks"):
        found += (ROOT / folder).rglob("*.md")
    return sorted(path.relative_to(ROOT).as_posix() for path in found)


def text_of(page):
    return (ROOT / page).read_text(encoding="utf-8")


def blocks_of(page):
    text = text_of(page)
    for match in FENCE.finditer(text):
        mark = MARK.search(text, 0, match.start())
        yield Block(match[1], match[3], text.count("\n", 0, match.start()) + 1, mark[1] if mark else "")


def run_blocks_of(page):
    return [block for block in blocks_of(page) if block.language in RUN]


def without_code(text):
    """What is read as words: no fences, no `code`."""
    return re.sub(r"(`+)(?!`).*?(?<!`)\1(?!`)", "", FENCE.sub("", text), flags=re.DOTALL)


def links_of(page):
    """Targets of links and pictures."""
    return re.findall(r"\]\(([^()\s]*(?:\([^()\s]*\)[^()\s]*)*)\)", without_code(text_of(page)))


def anchors_of(page):
    """As code hosts, and MyST, name headings."""
    found = {}
    for match in re.finditer(r"^#+ +(.*)$", FENCE.sub("", text_of(page)), re.MULTILINE):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", match[1])
        name = re.sub(r"[^\w\- ]", "", words.strip().lower()).replace(" ", "-")
        found[name] = found.get(name, -1) + 1
        yield name if found[name] == 0 else f"{name}-{found[name]}"
