# SPDX-License-Identifier: MIT
"""Packs the plugin of QGIS: pack.py OUT.zip. The same sources make the same bytes."""

import os
import re
import sys
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


def version():
    """The version of the project."""
    with open(os.path.join(ROOT, "CMakeLists.txt"), encoding="utf-8") as file:
        return re.search(r"project\(scarp VERSION ([0-9.]+)", file.read())[1]


def pack(path):
    """Writes the archive, whose one folder QGIS puts among its plugins."""
    folder = os.path.join(HERE, "scarp_qgis")
    files = sorted(name for name in os.listdir(folder) if name.endswith((".py", ".txt")))
    with zipfile.ZipFile(path, "w") as archive:
        for source in [os.path.join(folder, name) for name in files] + [os.path.join(ROOT, "LICENSE")]:
            with open(source, encoding="utf-8") as file:
                text = file.read()
            if source.endswith("metadata.txt"):
                text = text.replace("@VERSION@", version())
            entry = zipfile.ZipInfo(f"scarp_qgis/{os.path.basename(source)}")  # of 1980
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, text, zipfile.ZIP_DEFLATED)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: pack.py OUT.zip")
    pack(sys.argv[1])
