"""The stubs say what the compiled module has, and type checkers are content with the package."""

import ast
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

import bandvox
from bandvox import _bandvox

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = pathlib.Path(bandvox.__file__).parent
STUB = ast.parse((PACKAGE / "_bandvox.pyi").read_text())


def signature_of_stub(function):
    """Names, whether by keyword alone, and defaults, as text, of a function's arguments."""
    arguments = function.args
    missing = len(arguments.args) - len(arguments.defaults)
    found = [(one.arg, False, None if i < missing else arguments.defaults[i - missing])
             for i, one in enumerate(arguments.args)]
    found += [(one.arg, True, default)
              for one, default in zip(arguments.kwonlyargs, arguments.kw_defaults)]
    return [(name, is_keyword, None if default is None else ast.literal_eval(default))
            for name, is_keyword, default in found if name != "self"]


def signature_of_module(function):
    """The same of the line that pybind11 begins a docstring with."""
    line = function.__doc__.splitlines()[0]
    # Types are C++'s, and may not be Python.
    line = re.sub(r": [\w.]+(\[[^=]*?\])?(?= =|[,)]| ->)", "", line.partition(" ->")[0])
    (parsed,) = ast.parse(f"def {line}: ...").body
    return signature_of_stub(parsed)


def members(node):
    return {one.name: one for one in node.body if isinstance(one, (ast.FunctionDef, ast.ClassDef))}


def is_public(name):
    return not name.startswith("_") or name in ("_render", "_turntable")


def test_the_stub_has_what_the_module_has():
    found = {name for name in vars(_bandvox) if is_public(name)}
    assert found == {name for name in members(STUB)}


@pytest.mark.parametrize("name", sorted(name for name, node in members(STUB).items()
                                        if isinstance(node, ast.FunctionDef)))
def test_functions_have_the_same_arguments(name):
    assert signature_of_stub(members(STUB)[name]) == signature_of_module(getattr(_bandvox, name))


@pytest.mark.parametrize("name", sorted(
    name for name, node in members(STUB).items() if isinstance(node, ast.ClassDef)
    and not issubclass(getattr(_bandvox, name), (Exception,))))
def test_classes_have_the_same_members(name):
    there = {member: value for member, value in vars(getattr(_bandvox, name)).items()
             if is_public(member) or member in ("__call__", "_repr_svg_", "__len__")}
    node = members(STUB)[name]
    fields = {one.target.id for one in node.body if isinstance(one, ast.AnnAssign)}
    stubbed = members(node)
    constructor = stubbed.pop("__init__", None)
    assert set(there) == set(stubbed) | fields
    assert all(there[field].fset for field in fields)
    if constructor:
        assert (signature_of_stub(constructor)
                == signature_of_module(getattr(_bandvox, name).__init__))
    for member, function in stubbed.items():
        if isinstance(there[member], property):
            assert not there[member].fset
            assert [one.id for one in function.decorator_list] == ["property"]
        else:
            value = getattr(getattr(_bandvox, name), member)
            assert signature_of_stub(function) == signature_of_module(value), member


@pytest.fixture()
def checker():
    if not shutil.which("mypy", path="/usr/bin"):
        pytest.skip("needs mypy")
    environment = {**os.environ, "MYPYPATH": str(PACKAGE.parent)}

    def check(*command):
        return subprocess.run([sys.executable, *map(str, command)], env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=ROOT)

    return check


def test_the_package_and_the_examples_are_typed(checker, tmp_path):
    examples = sorted((ROOT / "examples" / "python").glob("*.py"))
    found = checker("-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache", PACKAGE, *examples)
    assert found.returncode == 0, found.stdout
    wrong = tmp_path / "wrong.py"
    wrong.write_text('import bandvox\n\nbandvox.bandlimit("shape:torus", resolution="many")\n')
    found = checker("-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache", wrong)
    assert found.returncode == 1 and "resolution" in found.stdout


def test_mypy_finds_the_stubs_true(checker, tmp_path):
    # pybind11's classes have a metaclass and a constructor of its own, which is no matter of ours;
    # members are checked all the same, and constructors above.
    allowed = tmp_path / "allowed"
    allowed.write_text("bandvox\\._bandvox\\.[A-Za-z]+(\\.__init__)?\n")
    found = checker("-m", "mypy.stubtest", "bandvox._bandvox", "--ignore-missing-stub",
                    "--allowlist", allowed)
    assert found.returncode == 0, found.stdout
