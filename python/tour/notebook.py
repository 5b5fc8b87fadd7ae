# SPDX-License-Identifier: MIT
"""Converts a script with cells (# %%) to a notebook: notebook.py tour.py tour.ipynb."""

import json
import re
import sys


def cells_of(script):
    """Returns (kind, lines) of each cell; kinds are "markdown" and "code". Lines before the first cell are dropped."""
    cells = []
    for line in script.splitlines():
        begins = re.fullmatch(r"# %%( \[markdown\])?", line)
        if begins:
            cells.append(("markdown" if begins[1] else "code", []))
        elif cells:
            kind, lines = cells[-1]
            lines.append(re.sub("^# ?", "", line) if kind == "markdown" else line)
    for _, lines in cells:
        while lines and not lines[-1]:
            lines.pop()
    return cells


def notebook_of(script):
    """Returns the text of the notebook, without results of cells."""
    cells = []
    for number, (kind, lines) in enumerate(cells_of(script)):
        cell = {"cell_type": kind, "id": f"cell-{number}", "metadata": {}}
        if kind == "code":
            cell.update(execution_count=None, outputs=[])
        cell["source"] = [line + "\n" for line in lines[:-1]] + lines[-1:]
        cells.append(cell)
    about = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    return json.dumps({"cells": cells, "metadata": about, "nbformat": 4, "nbformat_minor": 5}, indent=1) + "\n"


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: notebook.py SCRIPT.py NOTEBOOK.ipynb")
    with open(sys.argv[1], encoding="utf-8") as source:
        text = notebook_of(source.read())
    with open(sys.argv[2], "w", encoding="utf-8") as target:
        target.write(text)
