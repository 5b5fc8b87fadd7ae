# SPDX-License-Identifier: MIT
"""The tour: its cells run, each picture shows something, and the notebook is made from the script."""

import ast
import os
import struct
import sys
import zlib

import numpy as np
import pytest

FOLDER = os.path.join(os.environ["SCARP_SOURCE"], "python/tour")
sys.path.insert(0, FOLDER)

from notebook import cells_of, notebook_of  # noqa: E402

DATA = "/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz"


def read(name):
    with open(os.path.join(FOLDER, name), encoding="utf-8") as file:
        return file.read()


def shown(source, names):
    """Runs a cell as a notebook does: returns the value of its last line, if that is an expression."""
    tree = ast.parse(source)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    return eval(compile(ast.Expression(last.value), "cell", "eval"), names) if last else None


def colours_of(png):
    """Number of different colours of a PNG that pyscarp has written."""
    width, height, _, colour = struct.unpack(">IIBB", png[16:26])
    at, data = 8, b""
    while at < len(png):
        length, name = struct.unpack(">I4s", png[at : at + 8])
        data += png[at + 8 : at + 8 + length] if name == b"IDAT" else b""
        at += 12 + length
    channels = {0: 1, 2: 3}[colour]
    pixels = np.frombuffer(zlib.decompress(data), np.uint8).reshape(height, 1 + width * channels)[:, 1:]
    return len(np.unique(pixels.reshape(-1, channels), axis=0))


def test_cells_run_and_show_pictures(tmp_path, capsys):
    import pyscarp

    if not (os.path.exists(DATA) and pyscarp._core.HAS_FILES):
        pytest.skip("needs python-matplotlib-data and a build with GDAL")
    names, pictures = {}, 0
    for kind, lines in cells_of(read("tour.py")):
        if kind == "markdown":
            continue
        value = shown("\n".join(lines), names)
        if hasattr(value, "_repr_png_"):
            png = value._repr_png_()
            (tmp_path / f"{pictures}.png").write_bytes(png)
            assert colours_of(png) >= 2, lines
            pictures += 1
    assert pictures >= 10
    printed = capsys.readouterr().out
    for words in "samples are visible", "over ", "% lit", "hours", "points":
        assert words in printed
    # What the texts say.
    assert names["visible"].dtype == np.uint8 and set(np.unique(names["visible"])) == {0, 1, 255}
    assert names["count"].max() == 3 and set(np.unique(names["shade"])) == {0, 1, 2}
    assert np.isinf(names["depth"]).any() and len(names["cloud"]) > 100_000
    assert names["mine"].heights[tuple(names["centre"])] < names["elevation"][tuple(names["centre"])] - 200


def test_notebook_is_that_of_the_script():
    assert read("tour.ipynb") == notebook_of(read("tour.py")), "run python/tour/notebook.py python/tour/tour.{py,ipynb}"


def test_notebook_has_the_format_of_notebooks():
    nbformat = pytest.importorskip("nbformat")
    nbformat.validate(nbformat.reads(read("tour.ipynb"), as_version=4))
