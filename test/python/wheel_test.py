# SPDX-License-Identifier: MIT
"""The back end that packs wheels, on the package of this build; `./dev wheel` builds and tries a complete wheel."""

import base64
import csv
import email
import hashlib
import importlib.util
import io
import os
import re
import subprocess
import sys
import zipfile

import pytest

import pyscarp


@pytest.fixture(scope="module")
def backend():
    path = os.path.join(os.environ["SCARP_SOURCE"], "python/backend/pyscarp_build.py")
    spec = importlib.util.spec_from_file_location("pyscarp_build", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def wheel(backend, tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    # One library stands for all; the package of this build finds its own in the system.
    own = {name: path for name, path in backend.needed_libraries(pyscarp._core.__file__).items() if "hwy" in name}
    return folder / backend.write_wheel(str(folder), os.path.dirname(pyscarp.__file__), own)


def test_names_the_oldest_system(wheel):
    tag = f"cp3{sys.version_info[1]}"
    assert re.fullmatch(rf"pyscarp-{pyscarp.__version__}-{tag}-{tag}-(manylinux_2_\d+|linux)_\w+\.whl", wheel.name)


def test_records_what_it_holds(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        info = f"pyscarp-{pyscarp.__version__}.dist-info"
        rows = list(csv.reader(io.StringIO(archive.read(f"{info}/RECORD").decode())))
        assert [row[0] for row in rows] == names
        for name, digest, size in rows[:-1]:
            data = archive.read(name)
            assert int(size) == len(data)
            assert digest == "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        described = email.message_from_bytes(archive.read(f"{info}/METADATA"))
        assert described["Name"] == "pyscarp" and described["Version"] == pyscarp.__version__
        assert f"Tag: {wheel.stem.split('-', 2)[2]}" in archive.read(f"{info}/WHEEL").decode()
    assert {"pyscarp/py.typed", "pyscarp/_core.pyi", "pyscarp/__init__.py", f"{info}/LICENSE"} <= set(names)


def test_packs_the_same_bytes_twice(backend, wheel, tmp_path):
    with zipfile.ZipFile(wheel) as archive:
        own = {name.rpartition("/")[2] for name in archive.namelist() if name.startswith("pyscarp/lib/")}
    paths = backend.needed_libraries(pyscarp._core.__file__)
    again = backend.write_wheel(str(tmp_path), os.path.dirname(pyscarp.__file__), {name: paths[name] for name in own})
    assert (tmp_path / again).read_bytes() == wheel.read_bytes()


def test_leaves_out_libraries_of_every_system(backend):
    needed = backend.needed_libraries(pyscarp._core.__file__)
    assert any(name.startswith("libtbb") for name in needed)
    assert not any(re.match(r"lib(c|m|stdc\+\+|gcc_s)\.so", name) for name in needed)


def test_installs_and_runs(wheel, tmp_path):
    pytest.importorskip("pip")
    subprocess.run(
        [
            sys.executable,
            "-m",
            "pip",
            "install",
            "-q",
            "--no-deps",
            "--no-index",
            "--root-user-action=ignore",
            "--target",
            tmp_path,
            wheel,
        ],
        check=True,
    )
    code = (
        "import numpy, pyscarp; terrain = pyscarp.Terrain(numpy.zeros((3, 3), 'f4'), cell=1); "
        "print(pyscarp.__file__, terrain.occluded([1, 1, 1], [0, 0, -1]))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
    )
    assert done.stdout.split() == [str(tmp_path / "pyscarp" / "__init__.py"), "True"], done.stderr


def test_metadata_needs_no_build(backend, tmp_path):
    info = backend.prepare_metadata_for_build_wheel(str(tmp_path))
    assert (tmp_path / info / "METADATA").read_text().startswith("Metadata-Version: 2.1\nName: pyscarp\n")
