"""Links of all pages lead to what is there: files, folders, headings. Those to the network are looked at, not followed."""

import re
import urllib.parse

import pages
import pytest

EXTERNAL = re.compile(r"https?://[a-z0-9-]+(\.[a-z0-9-]+)+(/[^\s<>\"]*)?\Z")


def wrong_links(page):
    for link in pages.links_of(page):
        if re.match("[a-z]+:", link):
            if not EXTERNAL.match(link):
                yield f"{link} is no address"
            continue
        path, _, anchor = urllib.parse.unquote(link).partition("#")
        target = (pages.ROOT / page).parent / path if path else pages.ROOT / page
        if not target.exists():
            yield f"{link} leads to nothing"
        elif anchor and anchor not in pages.anchors_of(target.resolve().relative_to(pages.ROOT)):
            yield f"{link} names a heading that is not there"


@pytest.mark.parametrize("page", pages.all_pages())
def test_links_lead_somewhere(page):
    assert list(wrong_links(page)) == []


def test_links_are_found_and_judged(tmp_path, monkeypatch):
    (tmp_path / "other.md").write_text("# A heading: `code`, and more\n\n## Twice\n\n## Twice\n")
    (tmp_path / "page.md").write_text(
        "[a](other.md) [b](other.md#a-heading-code-and-more) [c](other.md#twice-1) [d](#none)\n"
        "![e](none.png) `[f](code)` [g](https://example.org/a_(b)) [h](http:/example)\n"
        "```sh\n[i](code)\n```\n[j](other.md#twice-2)\n")
    monkeypatch.setattr(pages, "ROOT", tmp_path)
    assert list(wrong_links("page.md")) == [
        "#none names a heading that is not there", "none.png leads to nothing", "http:/example is no address",
        "other.md#twice-2 names a heading that is not there"]


@pytest.mark.parametrize("page", ["README.md", "CONTRIBUTING.md"])
def test_scripts_that_are_named_are_there(page):
    named = set(re.findall(r"\bscripts/[a-z-]+", pages.text_of(page)))
    assert named and [script for script in named if not (pages.ROOT / script).exists()] == []


def test_there_are_links():
    assert sum(len(pages.links_of(page)) for page in pages.all_pages()) > 80
