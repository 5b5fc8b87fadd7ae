# SPDX-License-Identifier: MIT
"""``python3 -m pyscarp`` runs the command line ``scarp`` where it is installed: beside the package, else in PATH."""

import os
import shutil
import sys

from . import __version__


def main() -> int:
    """Replaces this process by the command line."""
    beside = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "scarp")
    program = beside if os.access(beside, os.X_OK) else shutil.which("scarp")
    if program:
        os.execv(program, ["scarp", *sys.argv[1:]])
    if sys.argv[1:] == ["--version"]:
        print(f"pyscarp {__version__}")
        return 0
    print(
        "pyscarp: error: the command line 'scarp' is not installed (install the package scarp, or put it in PATH)",
        file=sys.stderr,
    )
    return 1


if __name__ == "__main__":
    sys.exit(main())
