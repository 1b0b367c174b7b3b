"""The PEP 517 backend of the Python package: CMake builds and installs, this makes a wheel of it.

It needs CMake, Ninja and what the library is built from (scripts/setup), and nothing from an index
of packages. Settings, as in `pip install . --config-settings=build-dir=build/release`:

build-dir: a build tree to take the package from. One that is there keeps its settings, and is only
brought up to date; otherwise it is configured first. By default build/python-<version of Python>.
build: "no" takes the tree as it is.
cmake-args: what CMake is told when the tree is configured, as "-DCMAKE_PREFIX_PATH=/opt/openvdb".
jobs: how many compilers run at a time.
"""

import base64
import hashlib
import io
import os
import pathlib
import re
import shlex
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAME = "bandvox"
# The earliest time that a .zip file can hold: wheels of one source are the same, byte by byte.
FIRST_TIME = (1980, 1, 1, 0, 0, 0)


def project_version():
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    found = re.search(r"project\(Bandvox VERSION ([0-9.]+)", text)
    if not found:
        raise RuntimeError("CMakeLists.txt: expected 'project(Bandvox VERSION ...'")
    return found[1]


def wheel_tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-" + re.sub(r"[-.]", "_", sysconfig.get_platform())


def metadata():
    readme = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    return "\n".join([
        "Metadata-Version: 2.1",
        f"Name: {NAME}",
        f"Version: {project_version()}",
        "Summary: Shapes to band-limited OpenVDB volumes, and pictures of them",
        "License: MPL-2.0",
        "Requires-Python: >=3.9",
        "Requires-Dist: numpy",
        "Classifier: Programming Language :: C++",
        "Classifier: Typing :: Typed",
        "Description-Content-Type: text/markdown",
        "",
        readme,
    ])


def wheel_description():
    return "\n".join([
        "Wheel-Version: 1.0", "Generator: bandvox_build", "Root-Is-Purelib: false",
        f"Tag: {wheel_tag()}", ""
    ])


def run(*command):
    print("+", *command, file=sys.stderr, flush=True)
    # What CMake says belongs to the protocol of neither pip nor this.
    subprocess.run([str(word) for word in command], check=True, stdout=sys.stderr)


def configure(build, arguments):
    run("cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
        "-DBANDVOX_BUILD_PYTHON=ON", "-DBANDVOX_BUILD_APPS=OFF", "-DBANDVOX_BUILD_EXAMPLES=OFF",
        "-DBANDVOX_BUILD_TESTS=OFF", "-DBANDVOX_UNITY_BUILD=ON",
        f"-DPython3_EXECUTABLE={sys.executable}", *arguments)


def stage(settings, folder):
    """Builds the package, and installs it with the libraries beside the module into a folder."""
    standard = f"build/python-{sys.version_info.major}.{sys.version_info.minor}"
    build = ROOT / settings.get("build-dir", standard)
    is_there = (build / "CMakeCache.txt").exists()
    if settings.get("build", "yes") != "no":
        if not is_there or "build-dir" not in settings:
            configure(build, shlex.split(settings.get("cmake-args", "")))
        jobs = ["-j", settings["jobs"]] if "jobs" in settings else []
        run("cmake", "--build", build, "--target", "bandvox-python", *jobs)
    elif not is_there:
        raise RuntimeError(f"build-dir: found no build tree in {build}; expected one, or build=yes")
    run("cmake", "--install", build, "--prefix", folder, "--component", "wheel", "--strip")
    module = folder / NAME / ("_bandvox" + sysconfig.get_config_var("EXT_SUFFIX"))
    if not module.exists():
        found = sorted(path.name for path in folder.glob(f"{NAME}/_bandvox*"))
        raise RuntimeError(f"{build} has {found or 'no module'}; expected {module.name}, "
                           f"that of {sys.executable}")


def staged_files(folder):
    """The files of a folder by their names, in order. A wheel holds no links: what a library is
    looked for by is what it is called."""
    links = [path for path in folder.rglob("*") if path.is_symlink()]
    targets = {path.resolve() for path in links}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and (path.is_symlink() or path.resolve() not in targets):
            yield path.relative_to(folder).as_posix(), path.read_bytes(), os.access(path, os.X_OK)


def write_wheel(path, files):
    """files: name, contents, and whether it is executable, of each."""
    dist_info = f"{NAME}-{project_version()}.dist-info"
    record = []
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:

        def add(name, contents, is_executable=False):
            entry = zipfile.ZipInfo(name, FIRST_TIME)
            entry.external_attr = (0o100755 if is_executable else 0o100644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, contents)

        licence = (ROOT / "LICENSE").read_bytes()
        described = [(f"{dist_info}/METADATA", metadata().encode(), False),
                     (f"{dist_info}/WHEEL", wheel_description().encode(), False),
                     (f"{dist_info}/LICENSE", licence, False)]
        for name, contents, is_executable in [*files, *described]:
            add(name, contents, is_executable)
            digest = base64.urlsafe_b64encode(hashlib.sha256(contents).digest()).rstrip(b"=")
            record.append(f"{name},sha256={digest.decode()},{len(contents)}")
        record.append(f"{dist_info}/RECORD,,")
        add(f"{dist_info}/RECORD", "\n".join(record) + "\n")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    name = f"{NAME}-{project_version()}-{wheel_tag()}.whl"
    with tempfile.TemporaryDirectory() as folder:
        staged = pathlib.Path(folder)
        stage(config_settings or {}, staged)
        write_wheel(pathlib.Path(wheel_directory, name), staged_files(staged))
    return name


def source_files():
    """What Git keeps, or would if it was told; of an unpacked archive all but what is built."""
    if (ROOT / ".git").exists():
        listed = subprocess.run(
            ["git", "-C", str(ROOT), "ls-files", "-z", "--cached", "--others",
             "--exclude-standard"], check=True, capture_output=True).stdout.decode()
        return sorted({name for name in listed.split("\0") if (ROOT / name).is_file()})
    built = {"build", "out", "PKG-INFO"}
    return sorted(path.relative_to(ROOT).as_posix() for path in ROOT.rglob("*")
                  if path.is_file() and path.relative_to(ROOT).parts[0] not in built
                  and "__pycache__" not in path.parts)


def build_sdist(sdist_directory, config_settings=None):
    base = f"{NAME}-{project_version()}"
    with tarfile.open(pathlib.Path(sdist_directory, base + ".tar.gz"), "w:gz") as archive:
        for name in source_files():
            archive.add(ROOT / name, f"{base}/{name}", recursive=False)
        text = metadata().encode()
        entry = tarfile.TarInfo(f"{base}/PKG-INFO")
        entry.size = len(text)
        archive.addfile(entry, io.BytesIO(text))
    return base + ".tar.gz"
