"""The tutorials of the book run from the first cell to the last, and their numbers hold."""

from __future__ import annotations

import json
import warnings

import pytest
import stickslip as ss
from conftest import REPOSITORY

TUTORIALS = sorted((REPOSITORY / "book/tutorials").glob("*.ipynb"))


@pytest.mark.parametrize("path", TUTORIALS, ids=lambda path: path.stem)
def test_a_tutorial_runs(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    cells = [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
    assert not any(cell["outputs"] for cell in cells), "notebooks are kept without outputs"
    names: dict = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ss.StickslipWarning)
        for number, cell in enumerate(cells, 1):
            exec(compile("".join(cell["source"]), f"cell {number} of {path.name}", "exec"), names)
    assert "assert " in "".join("".join(cell["source"]) for cell in cells)


def test_there_are_three():
    assert len(TUTORIALS) == 3
