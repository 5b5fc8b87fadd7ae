# SPDX-License-Identifier: MIT
"""The module leaves no memory. AddressSanitizer's allocator finds leaks in modules that were not compiled with it."""

import os
import re
import subprocess
import sys

import pytest


pytestmark = pytest.mark.skipif(
    "SCARP_LONG_TESTS" not in os.environ, reason="AddressSanitizer takes ten seconds (./dev test --long)"
)


@pytest.fixture(scope="module")
def sanitizer():
    """The libraries to load first: those of the compiler."""
    found = []
    for name in "libasan.so", "libstdc++.so.6":
        try:
            done = subprocess.run(["g++", f"-print-file-name={name}"], capture_output=True, text=True)
        except OSError:
            pytest.skip("there is no g++, whose AddressSanitizer finds leaks")
        if not os.path.isabs(done.stdout.strip()):
            pytest.skip(f"g++ has no {name}")
        found.append(done.stdout.strip())
    return " ".join(found)


def leaks_of_the_module(sanitizer, *arguments):
    done = subprocess.run(
        [sys.executable, "-B", os.path.join(os.path.dirname(__file__), "leak_calls.py"), *arguments],
        capture_output=True,
        text=True,
        env={
            **os.environ,
            "LD_PRELOAD": sanitizer,
            "PYTHONMALLOC": "malloc",
            # Python itself leaves memory at its end; whole stacks tell whose it is.
            "ASAN_OPTIONS": "detect_leaks=1:fast_unwind_on_malloc=0:malloc_context_size=25",
        },
    )
    assert done.stdout == "done\n", done.stderr[-2000:]
    if "LeakSanitizer has encountered a fatal error" in done.stderr:
        pytest.skip("LeakSanitizer cannot run here (ptrace)")
    stacks = re.findall(r"leak of .*?\n\n", done.stderr + "\n\n", re.DOTALL)
    return [stack for stack in stacks if "pyscarp/_core." in stack and "PyInit__core" not in stack]


def test_finds_a_map_that_is_kept(sanitizer):
    assert leaks_of_the_module(sanitizer, "keep")


def test_nothing_leaks(sanitizer):
    assert not leaks_of_the_module(sanitizer)
