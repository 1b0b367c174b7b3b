"""The add-on of examples/blender in Blender without a window: installed, used, and a picture rendered."""

import json
import math
import os
import pathlib
import shutil
import subprocess

import numpy as np
import pytest

import bandvox

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = ROOT / "examples" / "blender"
COMMAND = pathlib.Path(os.environ["BANDVOX_BUILD_DIR"], "apps", "bandvox", "bandvox")
BALL = 4 / 3 * math.pi
CUBE = """v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"""

pytestmark = pytest.mark.skipif(not shutil.which("blender"), reason="Blender is not installed: no blender on PATH")


def radius_of(radius, voxel_size, iso=0.5, cutoff=0.16):
    """Where the density of a ball, filtered with order 2, has the value iso; lengths in world units.

    The filter is a Gaussian then, whose convolution with a ball has a closed form.
    """
    deviation = voxel_size / (math.sqrt(2) * math.pi * cutoff)

    def density(r):
        near, far = (r - radius) / deviation, (r + radius) / deviation
        bells = math.exp(-near * near / 2) - math.exp(-far * far / 2)
        return (math.erf(far / math.sqrt(2)) - math.erf(near / math.sqrt(2))) / 2 \
            - deviation / (r * math.sqrt(2 * math.pi)) * bells

    low, high = 0.1 * radius, 2 * radius
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if density(middle) > iso else (low, middle)
    return low


def run_blender(folder, *words):
    # Of its own, so that neither the user's settings nor the user's add-ons matter.
    environment = dict(os.environ, BLENDER_USER_RESOURCES=str(folder / "settings"), HOME=str(folder),
                       PATH=f"{COMMAND.parent}:{os.environ['PATH']}", PYTHONDONTWRITEBYTECODE="1")
    return subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "9", "--python", *map(str, words)],
                          env=environment, text=True, capture_output=True, check=False)


def write_files(folder):
    (folder / "cube.obj").write_text(CUBE)
    (folder / "open.obj").write_text(CUBE.replace("f 5 6 7 8\n", ""))
    (folder / "junk.obj").write_text("nothing\n")
    (folder / "junk.vdb").write_text("nothing\n")
    (folder / "points.csv").write_text("x,y,z,radius\n0,0,0,0.5\n0.4,0,0,0.5\n")
    density = bandvox.bandlimit("shape:sphere", resolution=24)
    bandvox.write_vdb(folder / "distances.vdb", [bandvox.to_level_set(density)])
    heat = np.full((8, 8, 8), 1500, np.float32)
    color = bandvox.VectorGrid.from_array(np.full((8, 8, 8, 3), 0.5, np.float32), voxel_size=0.1, name="Cd")
    bandvox.write_vdb(folder / "vectors.vdb", [color])
    bandvox.write_vdb(folder / "fire.vdb", [
        bandvox.Grid.from_array(heat, voxel_size=0.1, name="temperature"), color,
        bandvox.Grid.from_array(heat / 3000, voxel_size=0.1, name="density")])


@pytest.fixture(scope="module", params=["package", "command"])
def found(request, tmp_path_factory):
    """What blender_addon_steps.py has found."""
    folder = tmp_path_factory.mktemp(request.param)
    write_files(folder)
    archive = shutil.make_archive(str(folder / "addon"), "zip", HERE, "bandvox_volumes")
    rendered = run_blender(folder, HERE / "import_and_render.py", "--", "shape:torus", folder / "picture.png")
    assert rendered.returncode == 0, rendered.stdout + rendered.stderr
    steps = run_blender(folder, ROOT / "tests" / "python" / "blender_addon_steps.py", "--", archive,
                        "package" if request.param == "package" else COMMAND, folder, folder / "found.json")
    assert steps.returncode == 0, steps.stdout + steps.stderr
    return {**json.loads((folder / "found.json").read_text()), "said": steps.stdout}


def test_comes_and_goes(found):
    assert found["operators"] == ["import_volume", "volume_material", "volume_of_mesh", "volume_surface"]
    assert not found["after"]


def test_a_sphere_becomes_a_volume_of_its_size(found):
    kept = found["sphere"]["kept"]
    assert kept["type"] == "VOLUME" and kept["bandvox_grid"] == "density" and kept["bandvox_iso"] == 0.5
    assert kept["bandvox_voxel_size"] == pytest.approx(2 / 32)
    assert kept["bandvox_volume"] == pytest.approx(BALL, rel=1e-4)
    [grid] = bandvox.read_vdb(kept["path"])
    low, high = np.array(grid.bounds)
    # Blender's box is that of the leaves, of 8 voxels, at most.
    box = np.array(kept["box"]) / kept["bandvox_voxel_size"]
    assert np.all(box[0] <= low) and np.all(box[0] >= low - 9)
    assert np.all(box[1] >= high - 1) and np.all(box[1] <= high + 9)


def test_cycles_shows_it_where_it_is(found):
    # Moved by half a voxel it would be at 0.0625.
    np.testing.assert_allclose(found["from above"], 0, atol=0.01)


def test_its_surface_is_the_sphere_where_the_object_is(found):
    radius = 2 * radius_of(1, 2 / 32)
    assert 1.98 < radius < 1.99
    # The triangles of N=32 leave out 4e-3 of the ball at most.
    for name, error in (("surface", 4e-3), ("modifier", 6e-3)):
        surface = found["sphere"][name]
        assert surface["volume"] == pytest.approx(BALL * radius ** 3, rel=error), name
        assert surface["open edges"] == 0
        np.testing.assert_allclose(surface["low"], np.array([3, 2, 1]) - radius, atol=0.01)
        np.testing.assert_allclose(surface["high"], np.array([3, 2, 1]) + radius, atol=0.01)
    higher = 2 * radius_of(1, 2 / 32, iso=0.9)
    assert found["sphere"]["higher"]["volume"] == pytest.approx(BALL * higher ** 3, rel=4e-3)


def test_a_surface_can_enclose_what_the_source_does(found):
    for name in ("whole", "whole by modifier"):
        assert found["sphere"][name]["volume"] == pytest.approx(8 * BALL, rel=6e-3), name


def test_materials(found):
    solid, fog = found["sphere"]["solid"], found["sphere"]["fog"]
    assert solid["Density"] == pytest.approx(3 / (2 / 32))
    assert solid["Density Attribute"] == "density" and solid["Color Attribute"] == ""
    assert solid["Blackbody Intensity"] == 0
    low, high = np.array(found["sphere"]["kept"]["box"])
    assert fog["Density"] == pytest.approx(2 * 10 / max(high - low), rel=1e-5)
    assert fog["Color"] == pytest.approx([0.1, 0.2, 0.3, 1]) and fog["Anisotropy"] == 0.5
    fire = found["files"]["fire"]
    assert fire["Color Attribute"] == "Cd" and fire["Temperature Attribute"] == "temperature"
    assert fire["Blackbody Intensity"] == 1


def test_voxels_of_a_size_and_another_axis_up(found):
    kept = found["voxel size"]["kept"]
    assert kept["bandvox_voxel_size"] == pytest.approx(0.125)
    assert kept["bandvox_volume"] == pytest.approx(2, rel=1e-4)
    # (x, y, z) of the file is (x, -z, y).
    surface = found["voxel size"]["surface"]
    np.testing.assert_allclose(surface["low"], [0, -2, 0], atol=0.03)
    np.testing.assert_allclose(surface["high"], [1, 0, 1], atol=0.03)
    assert [pathlib.Path(found["voxel size"][name]["path"]).name for name in ("kept", "again")] == ["cube.vdb", "cube_2.vdb"]


def test_a_mesh_object_is_taken_as_it_is_seen(found):
    mesh = found["mesh"]
    assert mesh["kept"]["bandvox_volume"] == pytest.approx(mesh["expected"]["volume"], rel=1e-4)
    assert mesh["expected"]["volume"] == pytest.approx(2 * BALL, rel=0.08)
    assert mesh["surface"]["volume"] == pytest.approx(mesh["expected"]["volume"], rel=0.04)
    for end in ("low", "high"):
        np.testing.assert_allclose(mesh["surface"][end], mesh["expected"][end], atol=0.04)  # half a voxel, at its sharp ends
    assert mesh["hidden"]


def test_volumes_of_other_programs(found):
    files = found["files"]
    assert files["fire kept"]["bandvox_grid"] == "density" and files["fire kept"]["path"].endswith("fire.vdb")
    distances = files["distances"]
    assert distances["bandvox_is_level_set"] and distances["bandvox_iso"] == 0 and distances["materials"] == 0
    assert files["distances' surface"]["volume"] == pytest.approx(BALL * radius_of(1, 2 / 24) ** 3, rel=8e-3)
    assert "expected" in files["volume of distances"]
    assert "holds distances; expected a density" in files["material of distances"]


def test_volumes_and_points_on_new_voxels(found):
    new = found["command's"]
    assert new["solid"]["bandvox_grid"] == "density" and not new["solid"]["bandvox_is_level_set"]
    once = radius_of(1, 2 / 24)
    twice = radius_of(once, new["solid"]["bandvox_voxel_size"])
    assert new["solid"]["bandvox_volume"] == pytest.approx(BALL * once ** 3, rel=5e-3)
    assert new["surface"]["volume"] == pytest.approx(BALL * twice ** 3, rel=1e-2)
    # Two balls of radius 0.5, 0.4 apart: one sphere, and what the other adds.
    lens = math.pi * (4 * 0.5 + 0.4) * (2 * 0.5 - 0.4) ** 2 / 12
    assert new["points"]["bandvox_volume"] == pytest.approx(2 * BALL / 8 - lens, rel=1e-2)
    assert new["coarse"]["bandvox_voxel_size"] == pytest.approx(0.2)


def test_warnings_are_passed_on(found):
    [warning] = [line for line in found["said"].splitlines() if line.startswith("Warning: ") and "hole" in line]
    assert "capped" in warning


def test_errors_say_what_was_expected(found):
    errors = found["errors"]
    for name, words in (("junk.obj", "expected a surface"), ("missing.obj", "does not exist"), ("junk.vdb", "junk.vdb"),
                        ("vectors.vdb", "has no grid of floats; expected one"), ("folder", "expected a folder for volumes"),
                        ("flat", "the mesh is flat"), ("empty", "has no faces; expected the surface"),
                        ("command", "cannot run '/nowhere/bandvox'")):
        assert words in errors[name], f"{name}: {errors[name]}"


def test_the_picture_shows_volume_and_surface(found):
    picture = found["picture"]
    assert picture["size"] == [128, 96]
    assert all(0.05 < part < 0.6 for part in picture["seen"])
    (red, _, blue), (other_red, _, other_blue) = picture["colors"]
    assert red > 1.3 * blue and other_blue > 1.3 * other_red
