# SPDX-License-Identifier: MIT
"""The snippets of doc/user/python.md run, one after another, as one script."""

import os
import re

import pytest

DATA = "/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz"


def test_snippets_run(tmp_path, monkeypatch, capsys):
    import pyscarp

    if not (os.path.exists(DATA) and pyscarp._core.HAS_FILES):
        pytest.skip("needs python-matplotlib-data and a build with GDAL")
    pytest.importorskip("xarray")
    monkeypatch.chdir(tmp_path)
    with open(os.path.join(os.environ["SCARP_SOURCE"], "doc/user/python.md")) as page:
        text = page.read()
    snippets = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    assert len(snippets) >= 15
    names = {}
    for number, snippet in enumerate(snippets):
        exec(compile(snippet, f"snippet {number}", "exec"), names)
    printed = capsys.readouterr().out
    # What the page says in its text and comments.
    rows, cols = names["elevation"].shape
    assert f"{cols} x {rows} samples (columns x rows) of {names['elevation'].dtype}" in " ".join(text.split())
    assert f"pyscarp.Terrain {cols} x {rows} int16" in printed
    assert "cells 74.5732 x 92.475 m" in printed  # rounded on the page
    assert "observer -80,36.6: is outside the terrain" in printed and "100%" in printed
    assert names["seen"].distance > 1000 and names["depth"].shape == (240, 320) and names["cloud"].shape[1] == 3
    assert names["mine"].heights[105, 55] == 300 and names["elevation"][105, 55] != 300
    assert names["scene"].cast((names["x"] + 20, names["y"] + 20, 2000), (0, 0, -1)).object == 1
    assert (tmp_path / "jacksboro.png").read_bytes()[1:4] == b"PNG"
