# SPDX-License-Identifier: MIT
"""The package: names, types, documentation, the command line."""

import ast
import inspect
import os
import re
import subprocess
import sys

import numpy as np
import pytest

import pyscarp


def public_objects():
    for name in pyscarp.__all__:
        value = getattr(pyscarp, name)
        if callable(value):
            yield name, value
        if inspect.isclass(value):
            yield from ((f"{name}.{key}", getattr(value, key)) for key in vars(value) if not key.startswith("_"))


def test_everything_public_is_documented():
    missing = [
        name
        for name, value in public_objects()
        if not name.startswith("Status.")
        and value is not None
        and not isinstance(value, (int, float, str, tuple))
        and not inspect.getdoc(value)
        and not inspect.ismemberdescriptor(value)
    ]
    assert not missing


def test_functions_have_a_docstring_of_their_own_with_an_example():
    for name in (
        "horizon",
        "line_of_sight",
        "png",
        "profile",
        "render",
        "shadow",
        "sky_view",
        "sun_hours",
        "sun_masks",
        "sun_position",
        "viewshed",
    ):
        assert ">>>" in getattr(pyscarp, name).__doc__, name
    for name in "cast", "occluded", "heights_at", "all_hits", "cast_from", "edit", "samples_changed", "to_local":
        assert ">>>" in getattr(pyscarp.Terrain, name).__doc__, name


def stub_signatures():
    """Names of the functions of the stub, with those of their arguments."""
    tree = ast.parse(open(os.path.join(os.path.dirname(pyscarp.__file__), "_core.pyi")).read())
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            yield node.name, [a.arg for a in node.args.args] + ["*"] * bool(node.args.vararg)
        elif isinstance(node, ast.ClassDef):
            for member in node.body:
                if isinstance(member, ast.FunctionDef):
                    yield f"{node.name}.{member.name}", [a.arg for a in member.args.args] + ["*"] * bool(
                        member.args.vararg
                    )
                else:
                    assert isinstance(member, ast.Expr)
        elif isinstance(node, ast.AnnAssign):
            yield node.target.id, None


def test_stubs_name_the_arguments_of_the_module():
    from pyscarp import _core

    stubs = dict(stub_signatures())
    if not _core.HAS_FILES:
        for name in "wkt_of", "ground_plane", "line_plane", "crs_of", "lonlat", "node_of_lonlat", "local_shadow":
            del stubs[name]
    for name, arguments in stubs.items():
        found = _core
        for part in name.split("."):
            assert hasattr(found, part), name
            found = getattr(found, part)
        if arguments and "*" not in arguments and not isinstance(found, property) and found.__doc__:
            signature = found.__doc__.splitlines()[0].partition("(")[2].rpartition(")")[0]
            named = re.findall(r"(?:^|, )(\w+): ", signature)
            positional = all(re.fullmatch(r"arg\d+", n) for n in named if n != "self")
            assert named == arguments or (positional and len(named) == len(arguments)), (name, named)
    for name, value in vars(_core).items():
        if not name.startswith("__"):
            assert name in stubs or inspect.isclass(value), name


LONG = pytest.mark.skipif("SCARP_LONG_TESTS" not in os.environ, reason="mypy takes half a minute (./dev test --long)")


def mypy(tmp_path, *arguments):
    pytest.importorskip("mypy")
    return subprocess.run(
        [sys.executable, "-m", *arguments],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, "MYPYPATH": os.path.dirname(os.path.dirname(pyscarp.__file__))},
    )


@LONG
def test_stubs_agree_with_the_module(tmp_path):
    # The classes of pybind11 have a metaclass of their own.
    (tmp_path / "allowed").write_text(
        "".join(f"pyscarp._core.{name}\n" for name in ("SceneBase", "Terrain", "Voxels", "Scene"))
    )
    done = mypy(tmp_path, "mypy.stubtest", "pyscarp._core", "--allowlist", "allowed")
    assert done.returncode == 0, done.stdout + done.stderr


@LONG
def test_types_are_consistent_and_find_mistakes(tmp_path):
    done = mypy(tmp_path, "mypy", "-p", "pyscarp")
    assert done.returncode == 0, done.stdout
    (tmp_path / "use.py").write_text(
        "import numpy as np\nimport pyscarp\n"
        "terrain = pyscarp.Terrain(np.zeros((3, 3), np.float32), cell=1)\n"
        "hits: pyscarp.Hits = terrain.cast([0, 0, 1], [0, 0, -1])\n"
        "t: np.ndarray = hits.t\n"
        "terrain.cast([0, 0, 1], [0, 0, -1], outt=hits)\n"
    )
    lines = mypy(tmp_path, "mypy", "use.py").stdout.strip().splitlines()
    assert len(lines) == 2 and lines[0].startswith('use.py:6: error: Unexpected keyword argument "outt"'), lines


@pytest.mark.parametrize(
    "call",
    [
        lambda t: pyscarp.Terrain(t.heights, cell=1, exaggeration="x"),
        lambda t: pyscarp.Terrain(t.heights, cell=1, nodata="x"),
        lambda t: t.cast([0, 0, 1], [0, 0, 1], t_max="a"),
        lambda t: t.cast([0, 0, 1], [0, 0, 1], out=5),
        lambda t: t.cast(None, [0, 0, 1]),
        lambda t: t.occluded([0, 0, 1], [0, 0, 1], out=[1]),
        lambda t: t.heights_at([1, 2], [1, 2, 3]),
        lambda t: t.heights_at([1, 2], 1, out=np.zeros(2, np.float32)),
        lambda t: t.cast_from(None),
        lambda t: pyscarp.render(t, (8,)),
        lambda t: pyscarp.render(t, view=5),
        lambda t: pyscarp.render(t, eye=(1, 2)),
        lambda t: pyscarp.line_of_sight(t, 5, (1, 1)),
        lambda t: pyscarp.shadow(t, sun=5),
        lambda t: pyscarp.horizon(t, 0),
        lambda t: pyscarp.Scene(t),
        lambda t: pyscarp.Voxels(np.ones((2, 2, 2), np.uint8), side="x"),
    ],
)
def test_wrong_arguments_have_one_line(call):
    with pytest.raises((TypeError, pyscarp.Error)) as caught:
        call(pyscarp.Terrain(np.zeros((4, 4), np.float32), cell=1))
    assert "\n" not in str(caught.value) and ": " in str(caught.value)


HEIGHTS = np.zeros((4, 4), np.float32)
TERRAIN = pyscarp.Terrain(HEIGHTS, cell=1)
VOXELS = pyscarp.Voxels(np.ones((2, 2, 2), np.uint8))
RAY = ([0, 0, 1], [0, 0, -1])
#: Calls that succeed: a function, its arguments by position, and other arguments that some need beside them.
CALLS = [
    (pyscarp.Terrain, (HEIGHTS,), {"cell": 1}),
    (pyscarp.Terrain.open, ("none.tif",), {}),
    (TERRAIN.cast, RAY, {}),
    (TERRAIN.occluded, RAY, {}),
    (TERRAIN.heights_at, (1, 1), {}),
    (TERRAIN.all_hits, RAY, {}),
    (TERRAIN.cast_from, (pyscarp.Camera((1, 1, 9)),), {}),
    (TERRAIN.edit, (0,), {}),
    (TERRAIN.samples_changed, (), {}),
    (lambda **camera: TERRAIN.cast_from(pyscarp.Camera(**camera)), (), {"eye": (1, 1, 9), "columns": 4, "rows": 4}),
    (lambda **scanner: TERRAIN.cast_from(pyscarp.Scanner(**scanner)), (), {"eye": (1, 1, 9), "columns": 4}),
    (lambda **part: pyscarp.Scene([pyscarp.Part(**part)]), (), {"scene": VOXELS}),
    (pyscarp.Hits, (2,), {}),
    (pyscarp.Voxels, (np.ones((2, 2, 2), np.uint8),), {}),
    (VOXELS.edit, (), {"positions": [[0, 0, 0]]}),
    (pyscarp.Scene, ([TERRAIN],), {}),
    (pyscarp.render, (TERRAIN, (8, 8)), {}),
    (pyscarp.viewshed, (TERRAIN, (1, 1)), {}),
    (pyscarp.line_of_sight, (TERRAIN, (0, 0), (1, 1)), {}),
    (pyscarp.profile, (TERRAIN, (0, 0), (1, 1)), {}),
    (pyscarp.shadow, (TERRAIN, (90, 45)), {}),
    (pyscarp.horizon, (TERRAIN, 4), {}),
    (pyscarp.sky_view, (TERRAIN,), {"azimuths": 4}),
    (pyscarp.sun_hours, (TERRAIN,), {"suns": [(90, 45, 1)]}),
    (pyscarp.sun_masks, (TERRAIN, "2026-06-21"), {"place": (0, 45)}),
    (pyscarp.sun_position, (TERRAIN, "2026-06-21T12:00Z"), {"place": (0, 45)}),
    (pyscarp.set_threads, (0,), {}),
]
FIELDS = {"camera": pyscarp.Camera, "scanner": pyscarp.Scanner, "part": pyscarp.Part}
#: Messages name what is not a terrain by the argument of Terrain.
OTHER_NAMES = {
    "terrain": "heights",
    ("render", "scene"): "heights",
    "instrument": "cast_from",
    "indices": "voxels",
    "parts": ("parts", "scene"),
}


def arguments_of(function):
    found = inspect.signature(function).parameters
    fields = FIELDS.get(next(iter(found), None))
    return list(inspect.signature(fields).parameters if fields else found)


@pytest.mark.parametrize("function, given, others", CALLS, ids=lambda v: getattr(v, "__name__", ""))
@pytest.mark.parametrize("wrong", [object(), "two\nlines", 1j, np.full((3, 3, 3), "x")], ids=lambda v: type(v).__name__)
def test_every_argument_is_checked(function, given, others, wrong):
    for position, name in enumerate(arguments_of(function)):
        if name == "path" and isinstance(wrong, str):
            continue  # a path of a file that does not exist
        arguments, keywords = list(given), dict(others)
        if position < len(given):
            arguments[position] = wrong
        else:
            keywords[name] = wrong
        with pytest.raises((TypeError, pyscarp.Error)) as caught:
            function(*arguments, **keywords)
        message = str(caught.value)
        named = OTHER_NAMES.get((function.__name__, name), OTHER_NAMES.get(name, name))
        named = named if isinstance(named, tuple) else (named,)
        assert "\n" not in message and len(message) < 250, (name, message)
        assert message.startswith((*named, f"{function.__name__}: ")), (name, message)


def run(*arguments, **environment):
    return subprocess.run(
        [sys.executable, "-m", "pyscarp", *arguments], capture_output=True, text=True, env={**os.environ, **environment}
    )


def test_runs_the_command_line(scarp_program):
    path = os.path.dirname(os.path.abspath(scarp_program))
    done = run("--version", PATH=path)
    assert done.returncode == 0 and done.stdout.startswith("scarp ")
    assert run("viewshed", PATH=path).returncode != 0


def test_says_that_the_command_line_is_missing():
    done = run("viewshed", PATH="/nowhere")
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and "not installed" in done.stderr
    assert run("--version", PATH="/nowhere").stdout == f"pyscarp {pyscarp.__version__}\n"
