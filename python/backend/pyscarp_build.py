# SPDX-License-Identifier: MIT
"""Build back end (PEP 517) of the wheel `pyscarp`: CMake builds the extension module from scarp::core, analysis and
render; the wheel holds it, the Python files, and those shared libraries that other systems may not have.

It follows auditwheel's rules: the libraries of the manylinux policy (glibc, libstdc++, libgcc) are not in the wheel;
all others are, in pyscarp/lib, where the module finds them ($ORIGIN/lib). The platform tag is the oldest glibc that has
the symbols used. Needs only Python's standard library, so that it runs where scikit-build-core is missing (Debian 12).

Settings (pip's --config-settings): build-dir=DIR (build/wheel), cmake=OPTION (one more option of CMake).
"""

from __future__ import annotations

import base64
import hashlib
import os
import platform
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from typing import Any, Iterable, Optional

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# Libraries that every system with a manylinux tag has, and the newest versions of their symbols (auditwheel's policy
# manylinux_2_36).
SYSTEM_LIBRARIES = re.compile(
    r"^(libc|libm|libdl|librt|libpthread|libutil|libstdc\+\+|libgcc_s|ld-linux.*|linux-vdso)\.so"
)
NEWEST_CXX = {"GLIBCXX": (3, 4, 30), "CXXABI": (1, 3, 13)}

# Everything that reads or writes files is left out.
OPTIONS = [
    "SCARP_PYTHON=ON",
    *(
        f"SCARP_{name}=OFF"
        for name in (
            "GDAL",
            "OPENEXR",
            "CAIRO",
            "MESH",
            "OPENVDB",
            "EMBREE",
            "VULKAN",
            "APP",
            "VIEWER",
            "TESTS",
            "EXAMPLES",
            "BENCH",
        )
    ),
]

Settings = Optional[dict[str, Any]]


def version() -> str:
    """The version of the project."""
    with open(os.path.join(ROOT, "CMakeLists.txt"), encoding="utf-8") as file:
        found = re.search(r"project\(scarp VERSION ([0-9.]+)", file.read())
    assert found, "CMakeLists.txt has no version"
    return found[1]


def metadata() -> str:
    """The text of METADATA."""
    with open(os.path.join(ROOT, "doc/user/python.md"), encoding="utf-8") as file:
        readme = file.read()
    lines = [
        "Metadata-Version: 2.1",
        "Name: pyscarp",
        f"Version: {version()}",
        "Summary: Exact ray queries and maps on elevation models and voxels, on NumPy arrays without copies",
        "License: MIT",
        "Requires-Python: >=3.9",
        "Requires-Dist: numpy<2",  # as pybind11 before 2.12
    ]
    for extra, package in (("xarray", "xarray"), ("crs", "pyproj"), ("progress", "tqdm")):
        lines += [f"Provides-Extra: {extra}", f'Requires-Dist: {package}; extra == "{extra}"']
    return "\n".join([*lines, "Description-Content-Type: text/markdown", "", readme])


def needed_libraries(module: str) -> dict[str, str]:
    """Names and paths of the shared libraries of a module that a wheel must hold."""
    listed = subprocess.run(["ldd", module], check=True, capture_output=True, text=True).stdout
    found = dict(re.findall(r"^\s*(\S+) => (\S+)", listed, re.MULTILINE))
    missing = [name for name, path in found.items() if path == "not"]
    if missing:
        raise SystemExit(f"{module}: {', '.join(missing)} not found")
    return {name: path for name, path in found.items() if not SYSTEM_LIBRARIES.match(name)}


def platform_tag(files: Iterable[str]) -> str:
    """manylinux_2_N for the oldest glibc that has the symbols used; linux_MACHINE where libstdc++ is newer."""
    glibc = (2, 17)
    for file in files:
        text = subprocess.run(["readelf", "-V", "-W", file], check=True, capture_output=True, text=True).stdout
        for name, digits in re.findall(r"Name: (GLIBC|GLIBCXX|CXXABI)_([0-9.]+)", text):
            number = tuple(map(int, digits.split(".")))
            if name == "GLIBC":
                glibc = max(glibc, number[:2])
            elif number > NEWEST_CXX[name]:
                return f"linux_{platform.machine()}"
    return f"manylinux_{glibc[0]}_{glibc[1]}_{platform.machine()}"


def write_wheel(folder: str, package: str, libraries: dict[str, str]) -> str:
    """Packs a folder with the package and these libraries; returns the name of the wheel. Same input, same bytes."""
    contents: dict[str, bytes] = {}

    def add(name: str, path: str) -> None:
        with open(path, "rb") as file:
            contents[name] = file.read()

    modules = []
    for file in sorted(os.listdir(package)):
        if file.endswith((".py", ".pyi", ".so")) or file == "py.typed":
            add(f"pyscarp/{file}", os.path.join(package, file))
            if file.endswith(".so"):
                modules.append(os.path.join(package, file))
    for name, path in sorted(libraries.items()):
        add(f"pyscarp/lib/{name}", path)
    python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    tag = f"{python}-{python}-{platform_tag([*modules, *libraries.values()])}"
    info = f"pyscarp-{version()}.dist-info"
    add(f"{info}/LICENSE", os.path.join(ROOT, "LICENSE"))
    contents[f"{info}/METADATA"] = metadata().encode()
    contents[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: pyscarp_build {version()}\nRoot-Is-Purelib: false\n" f"Tag: {tag}\n"
    ).encode()
    record = ""
    for name, data in contents.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(data)}\n"
    contents[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    wheel = f"pyscarp-{version()}-{tag}.whl"
    os.makedirs(folder, exist_ok=True)
    with zipfile.ZipFile(os.path.join(folder, wheel), "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, data in contents.items():
            entry = zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if ".so" in name else 0o644) << 16
            archive.writestr(entry, data)
    return wheel


def build_package(build: str, options: Iterable[str]) -> str:
    """Builds the package in a folder; returns the folder that is to be packed."""
    flags = "-g0"
    subprocess.run(
        [
            "cmake",
            "-S",
            ROOT,
            "-B",
            build,
            "-G",
            "Ninja",
            "-D",
            "CMAKE_BUILD_TYPE=Release",
            "-D",
            f"CMAKE_CXX_FLAGS={flags}",
            "-D",
            f"Python_EXECUTABLE={sys.executable}",
            *(f"-D{option}" for option in [*OPTIONS, *options]),
            "--log-level=WARNING",
        ],
        check=True,
    )
    subprocess.run(["cmake", "--build", build, "--target", "pyscarp"], check=True)
    package = os.path.join(build, "wheel", "pyscarp")
    shutil.rmtree(package, ignore_errors=True)
    shutil.copytree(os.path.join(build, "python", "pyscarp"), package, ignore=shutil.ignore_patterns("__pycache__"))
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    subprocess.run(["strip", os.path.join(package, f"_core{suffix}")], check=True)
    return package


# The interface of PEP 517.


def build_wheel(
    wheel_directory: str, config_settings: Settings = None, metadata_directory: Optional[str] = None
) -> str:
    """Builds the wheel; returns its name."""
    settings = config_settings or {}
    build = os.path.abspath(settings.get("build-dir", os.path.join(ROOT, "build", "wheel")))
    options = settings.get("cmake", [])
    package = build_package(build, [options] if isinstance(options, str) else options)
    (module,) = (os.path.join(package, name) for name in os.listdir(package) if name.endswith(".so"))
    return write_wheel(wheel_directory, package, needed_libraries(module))


def prepare_metadata_for_build_wheel(metadata_directory: str, config_settings: Settings = None) -> str:
    """Writes METADATA without building anything; returns the name of its folder."""
    info = f"pyscarp-{version()}.dist-info"
    os.makedirs(os.path.join(metadata_directory, info), exist_ok=True)
    with open(os.path.join(metadata_directory, info, "METADATA"), "w", encoding="utf-8") as file:
        file.write(metadata())
    return info


def build_sdist(sdist_directory: str, config_settings: Settings = None) -> str:
    """Packs the files of the checkout; returns the name of the archive."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], check=True, capture_output=True, text=True).stdout
    name = f"pyscarp-{version()}"
    with tarfile.open(os.path.join(sdist_directory, f"{name}.tar.gz"), "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for file in filter(None, listed.split("\0")):
            archive.add(os.path.join(ROOT, file), f"{name}/{file}", recursive=False)
        path = os.path.join(sdist_directory, "PKG-INFO")
        with open(path, "w", encoding="utf-8") as info:
            info.write(metadata())
        archive.add(path, f"{name}/PKG-INFO")
        os.remove(path)
    return f"{name}.tar.gz"
