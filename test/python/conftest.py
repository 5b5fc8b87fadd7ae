# SPDX-License-Identifier: MIT
"""Fields that several tests share. Random cases have fixed seeds: failures come from changes, not from chance."""

import os

import hypothesis
import numpy as np
import pytest

import pyscarp

# A program, which QGIS's interpreter runs.
collect_ignore = ["qgis_script.py"]

hypothesis.settings.register_profile("fixed", derandomize=True, max_examples=40, deadline=None, database=None)
hypothesis.settings.load_profile("fixed")


@pytest.fixture(autouse=True)
def names_of_examples(doctest_namespace):
    doctest_namespace.update(np=np, pyscarp=pyscarp, **{name: getattr(pyscarp, name) for name in pyscarp.__all__})


def hills(rows, cols, dtype=np.float32):
    """Smooth ground with some roughness, 0 to about 300."""
    y, x = np.mgrid[0:rows, 0:cols]
    rough = np.random.default_rng(7).random((rows, cols)) * 20
    return (140 + 60 * np.sin(x / 9) + 60 * np.cos(y / 7) + rough).astype(dtype)


@pytest.fixture
def ground():
    return pyscarp.Terrain(hills(60, 80), cell=10)


@pytest.fixture
def scarp_program():
    program = os.environ.get("SCARP", "")
    if not os.access(program, os.X_OK):
        pytest.skip("this build has no command line")
    return program
