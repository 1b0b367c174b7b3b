"""Every block of sh and Python that the documentation shows runs as it stands, one page after another in a folder of
its own; but for sizes, which are smaller here. A block that cannot run has a line before it that only its source shows:

    <!-- not run: why -->
"""

import os
import pathlib
import re
import subprocess
import sys

import fixtures
import pages
import pytest

# What a page's blocks begin with, and what they leave (each * being anything).
PAGES = {
    "README.md": (
        ["bunny.obj", "painted.obj", "head.nrrd", "scan", "dicom", "particles.csv", "scan.ply", "heights.csv",
         "terrain.csv", "examples", "old_sdf.vdb"],
        "bunny.vdb bunny.png large.vdb sharp.vdb sampled.vdb bunny.json piped.png blended.vdb painted.vdb small.vdb levels.vdb "
        "scan.vdb half.vdb water.vdb statue.vdb surface.bpt terrain.vdb teapot.svg bunny.svg bone.vdb bone.stl density.vdb "
        "distances.vdb small.nrrd bunny.ply painted.glb wide.png bunny.exr soft.png glass.png fog.png around.03.png "
        "voxels.png shares.vdb mask.vdb both.vdb bunny.html sim.0002.vdb again.vdb torus.vdb torus.png"),
    "docs/any-mesh.md": (["examples", "surface.bpt"], "teapot.vdb solid.vdb"),
    "docs/compare-and-merge.md": (
        ["before.vdb", "after.vdb", "bunny.vdb", "bunny.obj", "a.vdb", "b.vdb", "c.vdb", "part.vdb", "part.stl",
         "body.vdb", "hat.vdb", "block.vdb", "drill.vdb"], "both.vdb part.vdb between.vdb all.vdb"),
    "docs/farm.md": (
        ["sim.0001.obj", "sim.0002.obj", "sim.0003.obj"],
        "vol.0003.vdb surface.0003.ply coarse.01.vdb coarse.03.vdb whole.vdb third.vdb large.vdb shot.vdb fine.vdb"),
    "docs/fit.md": ([], "surface.bpt surface.npy surface.ply surface.exr solid.vdb simple.bpt bent.npy field.vdb flow.vdb"),
    "docs/gallery.md": (
        ["scenes", "stanford-bunny.obj", "teapot.obj", "spot.obj"],
        "bunny.png teapot_in_glass.png melting_balls.png tree.png cloud.png spot.png head.png"),
    "docs/manual/tour.md": (
        ["bunny.obj", "examples", "heights.csv"],
        "hyperboloid.vdb hyperboloid.png bunny.vdb bunny.png coarse.vdb both.vdb bunny.ply distances.vdb teapot.svg "
        "lines.svg surface.ply bunny.html torus.png"),
    "docs/mesh-output.md": (["bunny.vdb", "painted.obj", "smoke.vdb"], "bunny.ply smooth.glb shell.stl"),
    "docs/outline.md": (["examples", "bunny.obj", "cow.obj"], "teapot.svg bunny.svg cow.svg tree.svg"),
    "docs/points.md": ([], "water.vdb drops.vdb water.ply distances.vdb"),
    "docs/python.md": (
        ["bunny.obj"],
        "bunny.vdb bunny.png scan.npy bone.html scene.exr around.0.png around.3.png surface.ply surface.vdb surface.svg"),
    "docs/scans.md": (
        ["scan", "slice.0000.tif", "scan.tif", "two series", "bunny.obj"],
        "scan.vdb head.vdb head.nrrd bunny.0001.png head.0001.tif small.nrrd"),
    "docs/solids-of-volumes.md": (
        ["scan.nrrd", "scan.npy", "cloud.vdb", "old_sdf.vdb", "bunny.obj", "bunny.vdb"],
        "bone.vdb soft.vdb cloud.ply density.vdb distances.vdb fog.vdb small.ply"),
    "docs/vfx.md": (["examples", "bunny.obj"], "bandvox_volumes.zip bunny.vdb bunny.exr asset.usda asset.vdb"),
}
# What the standard error of all blocks of a page has so many times.
SAID = {"docs/farm.md": {"skipped  vol.000": 3, "redo     vol.000": 3, "resolution was 48, is 40": 3}}
# Voxels along the longest side at most; of pieces that have to be united fewer will do.
RESOLUTION = {"docs/any-mesh.md": 24}
BUILD = pathlib.Path(os.environ["BANDVOX_BUILD_DIR"])


def at_most(limit):
    return lambda match: match[1] + str(min(int(match[2]), limit))


def smaller(text, resolution):
    """The same, of fewer voxels and pixels."""
    text = re.sub(r"((?:--resolution |-r |\bresolution *= *))(\d+)", at_most(resolution), text)
    text = re.sub(r"(--res )\d+x\d+", r"\g<1>32x24", text)
    text = re.sub(r"(bandvox render [^\n]*--samples )(\d+)", at_most(1), text)
    return re.sub(r"(\b(?:width|height)=)(\d+)", at_most(64), text)


def run(words, folder):
    environment = dict(os.environ, PATH=f"{BUILD / 'apps' / 'bandvox'}:{os.environ['PATH']}", PYTHONDONTWRITEBYTECODE="1")
    return subprocess.run(words, cwd=folder, env=environment, text=True, capture_output=True, check=False)


def run_page(page, folder):
    """Runs its blocks; those of Python, which go on where the one before ended, as one program."""
    shown = [block for block in pages.run_blocks_of(page) if not block.reason]
    resolution = RESOLUTION.get(page, 64)
    said = ""
    for block in shown:
        if block.language != "sh":
            continue
        result = run(["/bin/sh", "-e", "-c", smaller(block.text, resolution)], folder)
        assert result.returncode == 0, f"{page}:{block.line}\n{block.text}{result.stderr}"
        said += result.stderr
    program = "\n".join(smaller(block.text, resolution) for block in shown if block.language == "python")
    if program:
        result = run([sys.executable, "-c", program], folder)
        assert result.returncode == 0, f"{page}\n{result.stderr}"
    return said


@pytest.fixture(autouse=True)
def command_on_path(monkeypatch):
    monkeypatch.setenv("PATH", f"{BUILD / 'apps' / 'bandvox'}:{os.environ['PATH']}")


def reduce_scenes(folder):
    for scene in folder.glob("*.json"):
        text = re.sub(r'"res": \[\d+, \d+\]', '"res": [24, 18]', scene.read_text())
        scene.write_text(re.sub(r'"samples": \d+', '"samples": 1', text))


@pytest.mark.parametrize("page", sorted(PAGES))
def test_blocks_run(page, tmp_path):
    names, left = PAGES[page]
    fixtures.make(names, tmp_path)
    if "scenes" in names:
        reduce_scenes(tmp_path)
    before = {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()}
    said = run_page(page, tmp_path)
    for name in left.split():
        path = tmp_path / name
        assert path.exists() and path.stat().st_mtime_ns != before.get(path), name
    for words, times in SAID.get(page, {}).items():
        assert said.count(words) == times, f"{words}\n{said}"


def test_every_block_is_run_or_says_why_not():
    untold, kept_back = [], []
    for page in pages.all_pages():
        for block in pages.run_blocks_of(page):
            if block.reason:
                kept_back.append(f"{page}:{block.line}: {block.reason}")
            elif page not in PAGES:
                untold.append(f"{page}:{block.line}")
    assert untold == []
    print(f"{len(kept_back)} blocks are not run:", *kept_back, sep="\n")
    assert len(kept_back) < 20


def test_the_page_about_rendering_shows_a_scene_that_is_one(tmp_path):
    [scene] = [block.text for block in pages.blocks_of("docs/rendering.md") if block.language == "json"]
    (tmp_path / "scene.json").write_text(scene)
    reduce_scenes(tmp_path)
    fixtures.make(["bunny.vdb", "ball.vdb"], tmp_path)
    for words in (["ball.vdb", "-o", "sky.exr", "--res", "16x8", "--background", "1,1,1"],
                  ["scene.json", "-o", "scene.png"]):
        result = run(["bandvox", "render", *words], tmp_path)
        assert result.returncode == 0, result.stderr
    assert (tmp_path / "scene.png").exists()


def test_ctest_runs_every_page():
    assert set(os.environ["BANDVOX_PAGES"].split(":")) == set(PAGES)


def test_a_mark_keeps_only_the_block_after_it_back(tmp_path, monkeypatch):
    (tmp_path / "page.md").write_text("<!-- not run: no reason -->\n```sh\nfalse\n```\n```sh\ntrue\n```\n")
    monkeypatch.setattr(pages, "ROOT", tmp_path)
    assert [block.reason for block in pages.run_blocks_of("page.md")] == ["no reason", ""]
    run_page("page.md", tmp_path)
    (tmp_path / "page.md").write_text("```sh\ntrue\nfalse\n```\n")
    with pytest.raises(AssertionError, match="page.md:1"):
        run_page("page.md", tmp_path)
