"""The .ply files by which the add-on of examples/blender talks to the command; this needs no Blender."""

import importlib.util
import pathlib

import numpy as np
import pytest

import bandvox

PATH = pathlib.Path(__file__).resolve().parents[2] / "examples" / "blender" / "bandvox_volumes" / "ply.py"
SPEC = importlib.util.spec_from_file_location("ply", PATH)
ply = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(ply)


def test_bandvox_reads_what_is_written(cube, tmp_path):
    points, triangles = cube
    ply.write(tmp_path / "cube.ply", points / 3, triangles)
    mesh = bandvox.Mesh.read(tmp_path / "cube.ply")
    np.testing.assert_allclose(mesh.points, points / 3, rtol=1e-7)  # they are read as floats
    np.testing.assert_array_equal(mesh.triangles, triangles)


def test_what_bandvox_writes_is_read(torus, tmp_path):
    mesh = bandvox.to_mesh(torus)
    mesh.write(tmp_path / "torus.ply")
    points, triangles = ply.read(tmp_path / "torus.ply")
    np.testing.assert_allclose(points, mesh.points, atol=1e-6)
    np.testing.assert_array_equal(triangles, mesh.triangles)


@pytest.mark.parametrize("change, words", [
    (lambda data: data[:-1], "the file ends after"),
    (lambda data: data.replace(b"binary_little_endian", b"ascii"), "is ascii; expected binary_little_endian"),
    (lambda data: data.replace(b"element face", b"element edge"), "has elements vertex, edge; expected vertex and face"),
    (lambda data: data[:-13] + b"\x04" + data[-12:], "has a face of 4 corners; expected triangles")])
def test_other_files_are_refused(cube, tmp_path, change, words):
    path = tmp_path / "cube.ply"
    ply.write(path, *cube)
    path.write_bytes(change(path.read_bytes()))
    with pytest.raises(ValueError, match=words):
        ply.read(path)
