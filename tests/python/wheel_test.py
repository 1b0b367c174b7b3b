"""`pip install` of the repository gives a package that works in a fresh environment."""

import os
import pathlib
import re
import subprocess
import sys
import tarfile
import zipfile

import numpy as np
import pytest

import bandvox

pytest.importorskip("venv")
pytest.importorskip("ensurepip", reason="needs python3-venv")

ROOT = pathlib.Path(__file__).resolve().parents[2]
BACKEND = ROOT / "python_bindings" / "build_backend"
# The module and the library as they are built: the test is of what is made of them.
SETTINGS = {"build-dir": os.environ["BANDVOX_BUILD_DIR"], "build": "no"}

NOTEBOOK = """
import numpy as np
import bandvox

points, triangles = np.load("points.npy"), np.load("triangles.npy")
density = bandvox.bandlimit((points, triangles), resolution=64)
picture = bandvox.render(density, width=160, height=120)
density.write("object.vdb")
picture
"""


def run(*command, folder=None):
    """In a world without the package of the build tree, and without an index of packages."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    environment.update(PIP_NO_INDEX="1", PIP_DISABLE_PIP_VERSION_CHECK="1", PIP_NO_CACHE_DIR="1")
    found = subprocess.run([str(word) for word in command], env=environment, cwd=folder, text=True,
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert found.returncode == 0, found.stdout
    return found.stdout


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    """A fresh environment with the package in it: its Python."""
    folder = tmp_path_factory.mktemp("venv")
    # The one that the module was built for; NumPy is Debian's.
    run(sys.executable, "-m", "venv", "--system-site-packages", folder)
    settings = [f"--config-settings={name}={value}" for name, value in SETTINGS.items()]
    run(folder / "bin" / "python", "-m", "pip", "install", *settings, ROOT)
    return folder / "bin" / "python"


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    program = f"import bandvox_build; bandvox_build.build_wheel({str(folder)!r}, {SETTINGS!r})"
    run(sys.executable, "-B", "-c", program, folder=BACKEND)
    (path,) = folder.iterdir()
    return path


def test_the_wheel_holds_module_library_and_types(wheel, tmp_path):
    version = bandvox.__version__
    assert re.fullmatch(rf"bandvox-{re.escape(version)}-(cp\d+)-\1-linux_\w+\.whl", wheel.name)
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        archive.extractall(tmp_path)
    assert {"bandvox/__init__.py", "bandvox/py.typed", "bandvox/_bandvox.pyi"} <= set(names)
    (module,) = [name for name in names if name.startswith("bandvox/_bandvox.cpython")]
    libraries = [name for name in names if re.match(r"bandvox/libbandvox\.so", name)]
    assert libraries == ["bandvox/libbandvox.so." + version.rpartition(".")[0]]
    assert any(name.startswith("bandvox/libbandvox-images") for name in names)
    header = run("readelf", "-d", tmp_path / module)
    assert re.search(r"runpath: \[\$ORIGIN[:\]]", header), header
    assert f"[{pathlib.Path(libraries[0]).name}]" in header
    record = (tmp_path / f"bandvox-{version}.dist-info" / "RECORD").read_text().splitlines()
    assert sorted(line.split(",")[0] for line in record) == sorted(names)


def test_the_wheel_is_the_same_every_time(wheel, tmp_path):
    program = f"import bandvox_build; bandvox_build.build_wheel({str(tmp_path)!r}, {SETTINGS!r})"
    run(sys.executable, "-B", "-c", program, folder=BACKEND)
    assert (tmp_path / wheel.name).read_bytes() == wheel.read_bytes()


def test_a_build_tree_that_is_not_there_is_named(tmp_path):
    settings = {"build-dir": str(tmp_path / "nowhere"), "build": "no"}
    program = f"import bandvox_build; bandvox_build.build_wheel({str(tmp_path)!r}, {settings!r})"
    found = subprocess.run([sys.executable, "-B", "-c", program], cwd=BACKEND, text=True,
                           capture_output=True)
    assert found.returncode != 0
    assert "nowhere" in found.stderr and "expected one" in found.stderr


def test_the_installed_package_is_that_of_the_wheel(environment):
    said = run(environment, "-c", "import bandvox; print(bandvox.__file__, bandvox.__version__)",
               folder="/")
    assert said.split() == [
        str(next(environment.parents[1].glob("lib/python*/site-packages/bandvox/__init__.py"))),
        bandvox.__version__]
    described = run(environment, "-m", "pip", "show", "bandvox", folder="/")
    assert "License: MPL-2.0" in described and "Requires: numpy" in described


def test_a_notebook_in_the_fresh_environment(environment, tmp_path):
    lines = [line for line in NOTEBOOK.splitlines() if line]
    assert len(lines) < 15
    data = pathlib.Path(os.environ.get("BANDVOX_TEST_DATA", ""), "stanford-bunny.obj")
    mesh = (bandvox.Mesh.read(data) if data.is_file()
            else bandvox.to_mesh(bandvox.bandlimit("shape:two-balls", resolution=32)))
    np.save(tmp_path / "points.npy", mesh.points)
    np.save(tmp_path / "triangles.npy", mesh.triangles)
    # A notebook shows the value of a cell's last line by its own picture of itself.
    lines[-1] = f"open('shown.png', 'wb').write({lines[-1]}._repr_png_())"
    run(environment, "-W", "ignore", "-c", "\n".join(lines), folder=tmp_path)
    assert (tmp_path / "shown.png").read_bytes().startswith(b"\x89PNG")
    (density,) = bandvox.read_vdb(tmp_path / "object.vdb")
    assert density.metadata["bandvox_grid_volume"] == pytest.approx(
        density.metadata["bandvox_source_volume"], rel=1e-3)


def test_the_notebook_of_the_examples_in_the_fresh_environment(environment, tmp_path):
    nbformat = pytest.importorskip("nbformat", reason="needs python3-nbclient")
    pytest.importorskip("nbclient", reason="needs python3-nbclient")
    pytest.importorskip("ipykernel", reason="needs python3-ipykernel")
    source = ROOT / "examples" / "notebooks" / "mesh_to_picture.ipynb"
    program = f"""
import nbformat, nbclient
notebook = nbformat.read({str(source)!r}, as_version=4)
nbclient.NotebookClient(notebook, timeout=120, resources={{"metadata": {{"path": "."}}}}).execute()
nbformat.write(notebook, "run.ipynb")
"""
    # Debian's kernel is one of the system's Python, which does not know the package.
    run(environment, "-m", "ipykernel", "install", "--sys-prefix", folder=tmp_path)
    run(environment, "-c", program, folder=tmp_path)
    cells = [cell for cell in nbformat.read(tmp_path / "run.ipynb", as_version=4).cells
             if cell.cell_type == "code"]
    assert len([line for line in cells[0].source.splitlines() if line]) < 15
    assert any("image/png" in output.get("data", {}) for output in cells[0].outputs)
    (density,) = bandvox.read_vdb(tmp_path / "head.vdb")
    assert density.metadata["bandvox_grid_volume"] == pytest.approx(
        density.metadata["bandvox_source_volume"], rel=1e-3)


def test_the_source_archive_holds_what_is_built_from(tmp_path):
    program = f"import bandvox_build; bandvox_build.build_sdist({str(tmp_path)!r})"
    run(sys.executable, "-B", "-c", program, folder=BACKEND)
    base = f"bandvox-{bandvox.__version__}"
    with tarfile.open(tmp_path / f"{base}.tar.gz") as archive:
        names = archive.getnames()
    assert len(names) == len(set(names))
    for name in ("PKG-INFO", "pyproject.toml", "CMakeLists.txt", "lib/CMakeLists.txt", "LICENSE",
                 "python_bindings/src/module.cpp", "python_bindings/bandvox/__init__.py",
                 "python_bindings/build_backend/bandvox_build.py", "docs/python.md"):
        assert f"{base}/{name}" in names
    assert not any(name.startswith((f"{base}/build/", f"{base}/.git/")) for name in names)
