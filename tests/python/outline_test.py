"""Patches come from files and arrays, and become drawings."""

import pathlib
import xml.etree.ElementTree

import numpy as np
import pytest

import bandvox

TEAPOT = pathlib.Path(__file__).resolve().parents[2] / "examples" / "data" / "teapot.bpt"


@pytest.fixture(scope="module")
def cylinder():
    """A quarter of a cylinder of radius 1 around z, from z = 0 to 2."""
    weight = np.sqrt(0.5)
    circle = np.array([(1, 0, 1), (weight, weight, weight), (0, 1, 1)])
    net = np.empty((3, 2, 4))
    for j, z in enumerate((0, 2)):
        net[:, j] = np.column_stack([circle[:, :2], z * circle[:, 2], circle[:, 2]])
    return bandvox.Patches([net])


@pytest.fixture(scope="module")
def drawing():
    return bandvox.outline(TEAPOT, up=(0, 0, 1), from_=(1, -2, 1))


def test_nets_come_back(cylinder):
    flat = np.random.RandomState(1).random_sample((4, 3, 3))
    patches = bandvox.Patches([flat, cylinder.nets[0]], objects=["leaf", "pipe"])
    assert len(patches) == 2 and patches.objects == ["leaf", "pipe"]
    np.testing.assert_array_equal(patches.nets[0][..., :3], flat)
    assert (patches.nets[0][..., 3] == 1).all()
    np.testing.assert_array_equal(patches.nets[1], cylinder.nets[0])
    assert len(bandvox.Patches(np.zeros((5, 2, 2, 3)))) == 5


def test_rational_patches_are_round(cylinder):
    uv = np.random.RandomState(2).random_sample((50, 2))
    points, normals = cylinder.position(0, uv), cylinder.normal(0, uv)
    np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 1]), 1, atol=1e-14)
    np.testing.assert_allclose(points[:, 2], 2 * uv[:, 1], atol=1e-14)
    np.testing.assert_allclose(normals[:, :2], points[:, :2], atol=1e-12)
    with pytest.raises(IndexError):
        cylinder.position(1, uv)
    with pytest.raises(bandvox.UsageError, match="from 0 to 1"):
        cylinder.position(0, [(0, 1.5)])


def test_bsplines_become_patches():
    x, y = np.meshgrid(np.linspace(0, 1, 6), np.linspace(0, 1, 4), indexing="ij")
    control = np.stack([x, y, np.sin(3 * x) * y], axis=-1)
    patches = bandvox.Patches.from_bspline(control, range(10), [0, 0, 0, 1, 2, 2, 2])
    assert [net.shape for net in patches.nets] == [(4, 3, 4)] * 6
    # Two neighbours meet with the same normals.
    side = np.column_stack([np.ones(5), np.linspace(0, 1, 5)])
    across = side * (0, 1)
    one = [i for i in range(6) if np.allclose(patches.position(i, across[:1]),
                                              patches.position(0, side[:1]))][0]
    np.testing.assert_allclose(patches.position(0, side), patches.position(one, across))
    np.testing.assert_allclose(patches.normal(0, side), patches.normal(one, across), atol=1e-12)
    with pytest.raises(bandvox.UsageError):
        bandvox.Patches.from_bspline(control, [3, 2, 1, 0, 0, 0, 0], [0, 0, 0, 1, 2, 2, 2])
    with pytest.raises(bandvox.UsageError, match="finite"):
        bandvox.Patches.from_bspline(control, [np.nan] * 10, [0, 0, 0, 1, 2, 2, 2])


def test_wrong_nets_are_named():
    for nets, words in (
        ([], "no control net"),
        ([np.zeros((3, 3))], r"control points: found an array of shape \(3, 3\) of float64"),
        ([np.zeros((1, 3, 3))], r"\(1, 3, 3\)"),
        ([np.zeros((2, 2, 4))], "weight 0"),
        ([np.full((2, 2, 3), np.inf)], "inf"),
        ([np.zeros((27, 2, 3))], "26 x 26"),
    ):
        with pytest.raises(bandvox.UsageError, match=words):
            bandvox.Patches(nets)
    with pytest.raises(bandvox.UsageError, match="objects: found 1"):
        bandvox.Patches(np.zeros((2, 2, 2, 3)), objects=["one"])


def test_a_drawing_is_svg(drawing, tmp_path):
    text = drawing.svg()
    root = xml.etree.ElementTree.fromstring(text)
    assert root.attrib["width"] == "200mm" and drawing.page == (200, 150)
    assert drawing._repr_svg_() == text
    for name in ("teapot.svg", "teapot.pdf", "teapot.eps", "teapot.DXF"):
        drawing.save(tmp_path / name)
    assert (tmp_path / "teapot.svg").read_text() == text
    assert (tmp_path / "teapot.pdf").read_bytes().startswith(b"%PDF")
    assert len(list(tmp_path.iterdir())) == 4
    with pytest.raises(bandvox.UsageError, match="teapot.png.*expected .svg"):
        drawing.save(tmp_path / "teapot.png")
    assert len(list(tmp_path.iterdir())) == 4


def test_a_dxf_has_the_same_curves(drawing, tmp_path):
    ezdxf = pytest.importorskip("ezdxf")
    drawing.save(tmp_path / "teapot.dxf")
    document = ezdxf.readfile(tmp_path / "teapot.dxf")
    audit = document.audit()
    assert not audit.errors and not audit.fixes
    assert document.units == ezdxf.units.MM
    splines = list(document.modelspace())
    assert {spline.dxftype() for spline in splines} == {"SPLINE"}
    nets = [np.asarray(spline.control_points)[:, :2] for spline in splines]
    assert len(splines) == len(drawing.paths)
    for path in drawing.paths:
        points = path.points * (1, -1) + (0, 150)
        [spline] = [spline for spline, net in zip(splines, nets)
                    if net.shape == points.shape and np.allclose(net, points, atol=2e-4)]
        # A parameter of 1 to each cubic.
        t = np.linspace(0, 1, 5)[:, np.newaxis]
        a, b, c, d = points[:4]
        curve = (1 - t)**3 * a + 3 * (1 - t)**2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d
        tool = spline.construction_tool()
        np.testing.assert_allclose([tuple(tool.point(s))[:2] for s in t[:, 0]], curve, atol=1e-3)
        layer = document.layers.get(spline.dxf.layer)
        assert spline.dxf.layer.endswith(("hidden " if path.hidden else "visible ") + path.kind)
        assert layer.dxf.linetype == ("HIDDEN_LINES" if path.hidden else "Continuous")
        assert spline.closed == path.closed


def test_lines_are_bezier_curves(drawing):
    kinds = {path.kind for path in drawing.paths}
    assert "contour" in kinds and "boundary" in kinds
    for path in drawing.paths:
        assert path.points.shape[1] == 2 and len(path.points) % 3 == 1
        assert path.object
        if path.closed:
            np.testing.assert_allclose(path.points[0], path.points[-1])
    assert any(path.hidden for path in drawing.paths)


def test_the_options_are_those_of_the_command(drawing):
    patches = bandvox.Patches.read(TEAPOT)
    same = bandvox.outline(patches, up=(0, 0, 1), from_=(1, -2, 1))
    assert same.svg() == drawing.svg()
    few = bandvox.outline(patches, up=(0, 0, 1), from_=(1, -2, 1), kinds=["contour"],
                          hidden=False, stroke=0.5, stroke_color="#ff0000", page=(90, 60))
    assert {path.kind for path in few.paths} == {"contour"}
    assert not any(path.hidden for path in few.paths)
    assert "#ff0000" in few.svg() and few.page == (90, 60)
    for wrong in ({"kinds": ["shadow"]}, {"stroke": 0}, {"stroke_color": "red}svg{"},
                  {"page": (0, 10)}, {"margin": 80}, {"camera": "fisheye"}, {"dash": ""},
                  {"crease_angle": 200}):
        with pytest.raises(bandvox.UsageError):
            bandvox.outline(patches, **wrong)
    with pytest.raises(bandvox.ResultError, match="these kinds"):
        bandvox.outline(patches, kinds=[])
    with pytest.raises(bandvox.UsageError, match="found a float"):
        bandvox.outline(1.5)


def test_grids_are_drawn_by_their_contours():
    ball = bandvox.bandlimit("shape:sphere", resolution=48)
    view = {"camera": "orthographic", "eye": (0, 0, 5), "lookat": (0, 0, 0), "frame": 4,
            "page": (100, 100), "margin": 0}
    found = bandvox.outline(ball, **view)
    assert [(path.kind, path.closed, path.hidden) for path in found.paths] == [("contour", True, 0)]
    # 25 mm to a unit; the surface of the filtered ball is a little within it.
    radii = np.linalg.norm(found.paths[0].points[::3] - 50, axis=1) / 25
    assert np.ptp(radii) < 1e-3 and 0.98 < radii.mean() < 1
    smaller = bandvox.outline(ball, iso=0.9, **view)
    assert np.linalg.norm(smaller.paths[0].points[0] - 50) / 25 < radii.min()
    lit = bandvox.outline(ball, isophotes=[0.5], light=(0, 0, 1), **view)
    # The normal is at 60 degrees to the light, which is behind the eye.
    ring = [path for path in lit.paths if path.kind == "isophote" and path.hidden == 0]
    lengths = np.linalg.norm(ring[0].points[::3] - 50, axis=1) / 25
    np.testing.assert_allclose(lengths, np.sqrt(0.75) * radii.mean(), atol=2e-3)
    both = bandvox.outline([ball, bandvox.Patches.read(TEAPOT)], up=(0, 0, 1))
    assert len({path.object for path in both.paths}) == 2
    with pytest.raises(bandvox.UsageError, match="iso is for grids and meshes"):
        bandvox.outline(TEAPOT, iso=0.5)
    with pytest.raises(bandvox.UsageError, match="found a int"):
        bandvox.outline([ball, 3])


def test_files_of_volumes_and_meshes_are_drawn(cube, tmp_path):
    view = {"from_": (1, -2, 1), "up": (0, 0, 1)}
    ball = bandvox.bandlimit("shape:sphere", resolution=32)
    other = bandvox.bandlimit("shape:torus", resolution=32)
    other.name = "ring"
    bandvox.write_vdb(tmp_path / "two.vdb", [other, ball])
    mesh = bandvox.Mesh(*cube)
    mesh.write(tmp_path / "cube.obj")
    for source, options, grid, name in (
        (tmp_path / "two.vdb", {}, ball, "two"),
        (str(tmp_path / "two.vdb"), {"grid": "ring"}, other, "two"),
        ("shape:sphere", {"resolution": 32}, ball, "shape:sphere"),
        (tmp_path / "cube.obj", {"voxel_size": 0.1, "order": 3, "cutoff": 0.2},
         bandvox.bandlimit(mesh, voxel_size=0.1, order=3, cutoff=0.2), "cube"),
    ):
        found, expected = bandvox.outline(source, **options, **view), bandvox.outline(grid, **view)
        assert {path.object for path in found.paths} == {name}
        assert len(found.paths) == len(expected.paths)
        for ours, theirs in zip(found.paths, expected.paths):
            np.testing.assert_array_equal(ours.points, theirs.points)
    scene = bandvox.outline([tmp_path / "two.vdb", "shape:torus", TEAPOT], resolution=32, **view)
    assert {"two", "shape:torus"} < {path.object for path in scene.paths}
    with pytest.raises(bandvox.InputError, match="'ring'.*expected a float grid 'none'"):
        bandvox.outline(tmp_path / "two.vdb", grid="none")
    with pytest.raises(bandvox.UsageError, match="grid is for .vdb files"):
        bandvox.outline(TEAPOT, grid="density")
    with pytest.raises(bandvox.InputError):
        bandvox.outline(tmp_path / "missing.vdb")


def test_a_torus_has_suggestive_contours():
    torus = bandvox.bandlimit("shape:torus", resolution=48)
    view = {"from_": (0.2, -1, 0.55), "up": (0, 0, 1), "camera": "orthographic"}
    kinds = [path.kind for path in bandvox.outline(torus, suggestive=1, **view).paths]
    assert "suggestive" in kinds
    kinds = [path.kind for path in bandvox.outline(torus, **view).paths]
    assert "suggestive" not in kinds
    with pytest.raises(bandvox.UsageError, match="strength"):
        bandvox.outline(torus, suggestive=-1)


@pytest.mark.parametrize("arguments", [
    {"hidden": False, "dash": "1 1"}, {"hidden": False, "hidden_stroke": 0.1},
    {"hidden": False, "hidden_color": "#888888"}, {"camera": "orthographic", "focal": 50},
    {"camera": "orthographic", "fov": 40}, {"camera": "orthographic", "aperture": 20},
    {"eye": (0, -20, 5), "from_": (0, -1, 0)}, {"light": (0, 0, 1)},
    {"isophotes": [0.5], "kinds": ["contour"]}, {"crease_angle": 10, "kinds": ["contour"]},
    {"suggestive": 5}, {"tones": [0.5]}, {"shade": 0.3}, {"fill_colors": ["#123456"]},
    {"fill": "flat", "tones": [0.5]}, {"resolution": 64}, {"voxel_size": 0.1}, {"cutoff": 0.2}, {"order": 4},
])
def test_arguments_that_change_nothing_are_refused(arguments):
    with pytest.raises(bandvox.UsageError, match="expected"):
        bandvox.outline(TEAPOT, **arguments)


def test_arguments_of_patches_are_refused_for_grids():
    ball = bandvox.bandlimit("shape:sphere", resolution=16)
    with pytest.raises(bandvox.UsageError, match="crease_angle is for patches"):
        bandvox.outline(ball, crease_angle=10)
    with pytest.raises(bandvox.UsageError, match="'suggestive' among the kinds"):
        bandvox.outline(ball, suggestive=5, kinds=["contour"])


def test_the_size_of_voxels_is_given_once():
    with pytest.raises(bandvox.UsageError, match="expected one of them"):
        bandvox.outline("shape:sphere", resolution=16, voxel_size=0.1)


def test_info_tells_of_patches(cylinder):
    found = bandvox.info(TEAPOT)
    assert found["patches"] == len(bandvox.Patches.read(TEAPOT)) and found["volume"] > 0
    open_one = bandvox.info(cylinder)
    assert not open_one["closed"] and open_one["bounds"]["max"] == pytest.approx([1, 1, 2])


def area(points):
    """Within a closed path."""
    t = np.linspace(0, 1, 50, endpoint=False)[:, np.newaxis]
    places = [(1 - t)**3 * a + 3 * (1 - t)**2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d
              for a, b, c, d in (points[k:k + 4] for k in range(0, len(points) - 1, 3))]
    x, y = np.concatenate(places).T
    return 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def test_masks_are_drawn_as_what_they_hold():
    inside = np.zeros((20, 20, 20), dtype=bool)
    inside[5:15, 5:15, 5:15] = True
    mask = bandvox.MaskGrid.from_array(inside)
    numbers = bandvox.Grid.from_array(inside.astype(float))
    drawn, expected = (bandvox.outline(grid, kinds=["contour"]) for grid in (mask, numbers))
    assert len(drawn.paths) == len(expected.paths) > 0
    for path, other in zip(drawn.paths, expected.paths):
        np.testing.assert_array_equal(path.points, other.points)


def test_what_is_between_lines_is_filled():
    ball = bandvox.bandlimit("shape:sphere", resolution=48)
    view = {"camera": "orthographic", "eye": (0, 0, 5), "lookat": (0, 0, 0), "frame": 4,
            "page": (100, 100), "margin": 0}
    assert bandvox.outline(ball, **view).regions == []
    flat = bandvox.outline(ball, fill="flat", fill_colors=["#123456"], **view)
    assert [(region.object, region.tone, len(region.loops)) for region in flat.regions] == [
        (flat.paths[0].object, 0, 1)]
    radius = np.linalg.norm(flat.paths[0].points[0] - 50)
    assert area(flat.regions[0].loops[0]) == pytest.approx(np.pi * radius**2, rel=2e-3)
    assert 'fill="#123456"' in flat.svg()
    toon = bandvox.outline(ball, fill="toon", tones=[0.5], light=(0, 0, 1), **view)
    dark, light = toon.regions
    assert (dark.tone, len(dark.loops), light.tone, len(light.loops)) == (0, 2, 1, 1)
    # What is lit is within 60 degrees of the light, which is behind the eye.
    radii = np.linalg.norm(light.loops[0][::3] - 50, axis=1) / 25
    np.testing.assert_allclose(radii, np.sqrt(0.75), atol=1e-2)
    assert {path.kind for path in toon.paths} == {"contour"}
    for wrong in [{"fill": "plaid"}, {"fill": "flat", "fill_colors": ["red"]},
                  {"fill": "flat", "fill_colors": []}, {"fill": "toon", "shade": 2},
                  {"fill": "toon", "tones": [0.5, 0.2]}]:
        with pytest.raises(bandvox.UsageError):
            bandvox.outline(ball, **wrong)


def test_a_cylinder_seen_from_the_side_is_a_rectangle(cylinder):
    found = bandvox.outline(cylinder, camera="orthographic", eye=(9, 9, 1), lookat=(0, 0, 1),
                            up=(0, 0, 1), frame=4, page=(100, 100), margin=0)
    assert {path.kind for path in found.paths} == {"boundary"}
    # 25 mm to a unit, and the quarter's ends at a distance of sqrt(1/2) from the middle.
    anchors = np.concatenate([path.points[::3] for path in found.paths]) / 25 - 2
    side = np.sqrt(0.5)
    np.testing.assert_allclose([anchors.min(axis=0), anchors.max(axis=0)],
                               [(-side, -1), (side, 1)], atol=1e-3)
    assert (np.isclose(np.abs(anchors[:, 0]), side, atol=1e-3)
            | np.isclose(np.abs(anchors[:, 1]), 1, atol=1e-3)).all()
