"""Scenes of several objects are drawn as the command draws them, and their files are read as it reads them."""

import json
import os
import pathlib
import pickle
import subprocess

import numpy as np
import pytest

import bandvox

BANDVOX = pathlib.Path(os.environ.get("BANDVOX_BUILD_DIR", ""), "apps", "bandvox", "bandvox")
needs_command = pytest.mark.skipif(not BANDVOX.exists(), reason="needs the command")


@pytest.fixture(scope="module")
def ball():
    return bandvox.bandlimit("shape:sphere", resolution=24)


@pytest.fixture(scope="module")
def painted(ball):
    mesh = bandvox.to_mesh(ball)
    points = np.array(mesh.points)
    shades = (points - points.min(0)) / np.ptp(points, 0)
    return bandvox.colors(bandvox.Mesh(points, mesh.triangles, shades), ball)


def command(folder, *words):
    subprocess.run([BANDVOX, *map(str, words)], check=True, capture_output=True, cwd=folder)


def test_objects_are_put_where_they_are_asked_to_be(ball):
    options = {"width": 40, "height": 40, "eye": (0, 0, 9), "lookat": (0, 0, 0)}
    one = bandvox.render(bandvox.SceneObject(ball, translate=(1, 0, 0)), width=40, height=40,
                         eye=(1, 0, 9), lookat=(1, 0, 0))
    moved = one.channels["position"][one.channels["depth"] < np.inf]
    assert moved[:, 0].mean() == pytest.approx(1, abs=1e-3)
    small = bandvox.render(bandvox.SceneObject(ball, scale=0.5), **options)
    seen = small.channels["position"][small.channels["depth"] < np.inf]
    assert np.linalg.norm(seen, axis=1).mean() == pytest.approx(0.5, abs=0.01)
    both = bandvox.render([ball, bandvox.SceneObject(ball, translate=(2, 0, 0), color=(1, 0, 0))],
                          **options)
    x, red = both.channels["position"][..., 0], both.image
    right = (x > 1.2) & (both.image[..., 3] == 1)
    left = (x < 0.8) & (both.image[..., 3] == 1)
    assert right.any() and left.any()
    assert (red[right][:, 1] == 0).all() and (red[left][:, 1] > 0).any()


def test_colors_are_those_of_the_grid(ball, painted):
    options = {"width": 24, "height": 24, "ambient": 1.0, "eye": (0, 0, 9), "lookat": (0, 0, 0)}
    picture = bandvox.render(bandvox.SceneObject(ball, colors=painted), **options)
    seen = picture.image[..., 3] == 1
    place = picture.channels["position"][seen]
    np.testing.assert_allclose(picture.image[seen][:, 0], (place[:, 0] + 1) / 2, atol=0.06)
    with pytest.raises(bandvox.UsageError, match="colors: found a"):
        bandvox.render(bandvox.SceneObject(ball, colors=ball), **options)


def test_what_the_picture_is_lit_by(ball, tmp_path):
    options = {"width": 21, "height": 21, "eye": (0, 0, 9), "lookat": (0, 0, 0)}
    dark = bandvox.render(ball, lights=[], environment=bandvox.Environment(color=(0, 0, 0)), **options)
    assert dark.image[..., :3].max() == 0
    even = bandvox.render(ball, lights=[], ambient=1, color=(0.5, 0.25, 1), **options)
    middle = even.image[10, 10]
    np.testing.assert_allclose(middle, (0.5, 0.25, 1, 1), atol=1e-3)
    lamp = bandvox.Light(position=(0, 0, 3), color=(4, 4, 4))
    near = bandvox.render(ball, lights=[lamp], ambient=0, color=(1, 1, 1), **options)
    at = bandvox.render(ball, light_at=(0, 0, 3), light_color=(4, 4, 4), ambient=0, color=(1, 1, 1), **options)
    np.testing.assert_array_equal(near.image, at.image)
    # Two units from it there is a fourth of its light.
    assert near.image[10, 10, 0] == pytest.approx(1, abs=0.05)
    # An image of what is around is light by itself.
    sky = np.ones((8, 16, 4), np.float32) * (0.2, 0.4, 0.6, 1)
    bandvox.write_image(tmp_path / "sky.exr", sky)
    lit = bandvox.render(ball, environment=tmp_path / "sky.exr", color=(1, 1, 1), **options)
    np.testing.assert_allclose(lit.image[10, 10, :3], (0.2, 0.4, 0.6), atol=0.01)
    around = bandvox.Environment(file=tmp_path / "sky.exr", visible=True)
    behind = bandvox.render(ball, environment=around, **options)
    np.testing.assert_allclose(behind.image[0, 0], (0.2, 0.4, 0.6, 1), atol=0.01)


def test_volumes_stop_light(ball):
    fog = bandvox.SceneObject(ball, mode="volume", extinction=2.0)
    picture = bandvox.render(fog, width=21, height=21, eye=(0, 0, 50), lookat=(0, 0, 0))
    # Through the middle of a ball of radius 1 the way is 2 long; the filter only spreads it.
    assert picture.image[10, 10, 3] == pytest.approx(1 - np.exp(-4), abs=0.02)
    hot = bandvox.Grid.from_array(np.full((8, 8, 8), 2000.0), origin=(-4, -4, -4), voxel_size=0.5)
    glowing = bandvox.render(bandvox.SceneObject(ball, mode="volume", temperature=hot, color=(0, 0, 0)),
                             width=21, height=21, eye=(0, 0, 50), lookat=(0, 0, 0))
    red, green, blue, _ = glowing.image[10, 10]
    assert red > green > blue >= 0


def test_a_crop_is_a_part_of_the_picture(ball, tmp_path):
    options = {"width": 40, "height": 30, "samples": 4, "filter": "gaussian"}
    whole = bandvox.render(ball, **options)
    part = bandvox.render(ball, crop=(10, 5, 30, 20), **options)
    np.testing.assert_array_equal(part.image, whole.image[5:20, 10:30])
    assert part.window == (10, 5, 40, 30) and whole.window is None
    part.write(tmp_path / "part.exr", channels=["color", "depth"])
    back = pickle.loads(pickle.dumps(part))
    np.testing.assert_array_equal(back.image, part.image)
    assert back.window == part.window and back.metadata["bandvox_samples"] == 4
    for crop in ((0, 0, 41, 30), (0, 0, 1), "all"):
        with pytest.raises(bandvox.UsageError):
            bandvox.render(ball, crop=crop, **options)
    with pytest.raises(bandvox.UsageError, match="channels"):
        part.write(tmp_path / "part.exr", channels=["heat"])


def test_the_angle_of_view_says_how_long_the_lens_is(ball):
    options = {"width": 32, "height": 32, "eye": (0, 0, 5), "lookat": (0, 0, 0)}
    wide = bandvox.render(ball, fov=2 * np.degrees(np.arctan(0.5 * 41.2136 / 50)), **options)
    np.testing.assert_allclose(wide.image, bandvox.render(ball, focal=50, **options).image, atol=1e-6)
    for wrong in ({"fov": 0}, {"fov": 180}, {"fov": 40, "focal": 50}):
        with pytest.raises(bandvox.UsageError, match="fov is"):
            bandvox.render(ball, **wrong, **options)


def test_a_camera_of_a_file(ball, tmp_path):
    scene = {"asset": {"version": "2.0"}, "cameras": [
        {"type": "perspective", "name": "main", "perspective": {"yfov": 0.5, "znear": 0.1}}],
        "nodes": [{"camera": 0, "translation": [0, 0, 6]}]}
    (tmp_path / "camera.gltf").write_text(json.dumps(scene))
    expected = bandvox.render(ball, width=32, height=32, eye=(0, 0, 6), lookat=(0, 0, 0), up=(0, 1, 0),
                              fov=np.degrees(0.5))
    for name in ("camera.gltf", "camera.gltf:main"):
        found = bandvox.render(ball, width=32, height=32, camera_file=tmp_path / name)
        np.testing.assert_allclose(found.image, expected.image, atol=1e-5)
    with pytest.raises(bandvox.InputError, match="no camera 'other'"):
        bandvox.render(ball, camera_file=tmp_path / "camera.gltf:other")


def test_previews_are_shown_and_can_end_the_work(torus):
    shown = []
    picture = bandvox.render(torus, width=400, height=400, samples=16, threads=1, preview=shown.append)
    assert all(one.shape == (400, 400, 4) for one in shown)
    assert picture.image.shape == (400, 400, 4)

    def end(image):
        raise LookupError("seen enough")

    if shown:
        with pytest.raises(LookupError, match="seen enough"):
            bandvox.render(torus, width=400, height=400, samples=64, threads=1, preview=end)


def test_a_turntable_goes_around(torus):
    views = bandvox.turntable(torus, 4, width=32, height=32, from_=(0, 0, 1))
    assert len(views) == 4
    eyes = np.array([view["eye"] for view in views])
    middle = np.array(views[0]["lookat"])
    far = np.linalg.norm(eyes - middle, axis=1)
    np.testing.assert_allclose(far, far[0])
    # A quarter of a turn each: opposite eyes are opposite.
    np.testing.assert_allclose(eyes[0] + eyes[2], 2 * middle, atol=1e-9)
    np.testing.assert_allclose(np.sum((eyes[0] - middle) * (eyes[1] - middle)), 0, atol=1e-9)
    first = bandvox.render(torus, width=32, height=32, **views[0])
    opposite = bandvox.render(torus, width=32, height=32, **views[2], light=(0, 0, 1))
    assert first.image[..., 3].sum() == pytest.approx(opposite.image[..., 3].sum(), rel=0.02)
    with pytest.raises(TypeError, match="frames"):
        bandvox.turntable(torus, 4, frames=2)
    with pytest.raises(bandvox.UsageError):
        bandvox.turntable(torus, 0)


def test_wrong_scenes_are_named(ball):
    thing = bandvox.SceneObject
    for source, options, words in (
        ([], {}, "objects"),
        ("ball", {}, "found a str; expected a bandvox.Grid"),
        (thing(ball, mode="gas"), {}, "mode is 'gas'"),
        (thing(ball, roughness=2), {}, "roughness"),
        (thing(ball, roughness="smooth"), {}, "roughness: found 'smooth'; expected a number"),
        (thing(ball, scale=0), {}, "scale"),
        (thing(ball), {"iso": 0.4}, "a SceneObject has its own"),
        (ball, {"samples": 1.5}, "samples: found 1.5; expected a whole number"),
        (ball, {"filter": "sinc"}, "'blackman-harris'"),
        (ball, {"lights": [bandvox.Light()]}, "a direction or a position"),
        (ball, {"lights": [], "light": (0, 0, 1)}, "lights are all"),
        (ball, {"light": (0, 0, 1), "light_at": (0, 0, 1)}, "exclude"),
        (ball, {"volume_method": "guess"}, "'tracking'"),
        (ball, {"bounces": 2}, "gather"),
        ([ball, ball], {"shading": "phong"}, "one surface under one lamp"),
        (ball, {"width": 0}, "width"),
        (ball, {"seed": -1}, "seed is -1"),
        (ball, {"frame": 2}, "camera='orthographic'"),
    ):
        with pytest.raises(bandvox.UsageError, match=words):
            bandvox.render(source, **{"width": 8, "height": 8, **options})
    with pytest.raises(bandvox.InputError):
        bandvox.render(ball, environment="nowhere.exr")


SCENE = {
    "objects": [
        {"file": "torus.vdb", "color": [0.9, 0.5, 0.1], "reflectance": 0.05, "scale": 0.5},
        {"file": "ball.vdb", "mode": "surface", "transparency": 1, "roughness": 0, "translate": [1, 0, 0]},
    ],
    "lights": [{"direction": [-0.5, 1, 0.7], "color": [0.8, 0.78, 0.72], "size": 6},
               {"position": [3, 2, 3], "color": [3, 3.2, 3.6]}],
    "environment": {"color": [0.5, 0.6, 0.75]},
    "camera": {"from": [0.2, 0.4, 1], "fov": 32},
    "picture": {"res": [30, 20], "samples": 4, "filter": "gaussian", "shadows": True, "gather": 1},
}


@pytest.fixture()
def folder(torus, ball, painted, tmp_path):
    bandvox.write_vdb(tmp_path / "torus.vdb", [torus])
    bandvox.write_vdb(tmp_path / "ball.vdb", [ball, painted])
    (tmp_path / "scene.json").write_text(json.dumps(SCENE))
    return tmp_path


@needs_command
def test_a_scene_file_is_drawn_as_the_command_draws_it(folder):
    scene = bandvox.read_scene(folder / "scene.json")
    assert len(scene["source"]) == 2 and scene["source"][1].colors.name == "Cd"
    assert (scene["width"], scene["height"], scene["samples"], scene["fov"]) == (30, 20, 4, 32)
    picture = bandvox.render(**scene)
    command(folder, "render", "scene.json", "-o", "theirs.png", "--seed", 0)
    picture.write(folder / "ours.png")
    assert image_data(folder / "ours.png") == image_data(folder / "theirs.png")


def image_data(path):
    """The compressed pixels of a .png, without what it says of itself."""
    data, at, found = path.read_bytes(), 8, b""
    while at < len(data):
        size = int.from_bytes(data[at:at + 4], "big")
        if data[at + 4:at + 8] in (b"IHDR", b"IDAT"):
            found += data[at + 8:at + 8 + size]
        at += 12 + size
    return found


@needs_command
@pytest.mark.parametrize("words, options", [
    ([], {}),
    (["--light-at", "1,2,3", "--ambient", 0.3, "--samples", 4], {"light_at": (1, 2, 3), "ambient": 0.3,
                                                                "samples": 4}),
    (["--camera", "orthographic", "--frame", 3, "--background", "0.1,0.2,0.3", "--shadows"],
     {"camera": "orthographic", "frame": 3, "background": (0.1, 0.2, 0.3), "shadows": True}),
    (["--shading", "phong"], {"shading": "phong"}),
    (["--fov", 30, "--light-color", "1,0.5,0", "--crop", "4,2,20,18"],
     {"fov": 30, "light_color": (1, 0.5, 0), "crop": (4, 2, 20, 18)}),
])
def test_pictures_are_those_of_the_command(folder, torus, words, options):
    command(folder, "render", "torus.vdb", "-o", "theirs.png", "--res", "32x24", *words)
    bandvox.render(torus, width=32, height=24, **options).write(folder / "ours.png")
    assert image_data(folder / "ours.png") == image_data(folder / "theirs.png")


@pytest.mark.parametrize("change, words", [
    ({"objects": []}, "no objects"),
    ({"objects": [{"iso": 1}]}, r"objects\[0\].file is missing"),
    ({"objects": [{"file": "torus.vdb", "grid": "smoke"}]}, "expected one Grid 'smoke'"),
    ({"objects": [{"file": "torus.vdb", "colour": 1}]}, r"objects\[0\] has 'colour'"),
    ({"objects": {}}, "objects is no list"),
    ({"lights": [3]}, r"lights\[0\] holds no settings"),
    ({"picture": {"shadows": 1}}, "neither true nor false"),
    ({"picture": {"samples": True}}, "true or false"),
    ({"picture": {"samples": None}}, "neither text, a number"),
    ({"picture": {"res": "wide"}}, "expected numbers"),
    ({"picture": {"filter": 3}}, "is no text"),
    ({"things": 1}, "there is 'things'"),
])
def test_scene_files_that_are_none(folder, change, words):
    (folder / "wrong.json").write_text(json.dumps({**SCENE, **change}))
    with pytest.raises(bandvox.InputError, match=words):
        bandvox.read_scene(folder / "wrong.json")


def test_what_is_no_scene_at_all(folder):
    for text, words in (("[1]", "holds no scene"), ("{", "is no JSON"), ('{"a": 1, "a": 2}', "twice")):
        (folder / "wrong.json").write_text(text)
        with pytest.raises(bandvox.InputError, match=words):
            bandvox.read_scene(folder / "wrong.json")
    with pytest.raises(bandvox.InputError, match="cannot be opened"):
        bandvox.read_scene(folder / "none.json")
    # As an option would have it on the command line.
    text = json.dumps({**SCENE, "picture": {"res": "12x8", "background": "0.5,0,1e-3",
                                              "channels": "color"}})
    (folder / "text.json").write_text(text)
    scene = bandvox.read_scene(folder / "text.json")
    assert (scene["width"], scene["height"], scene["background"]) == (12, 8, [0.5, 0, 1e-3])
    assert "channels" not in scene
