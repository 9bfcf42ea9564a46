"""A type checker follows the package's annotations through what users write, and finds what they would get wrong.

Set-up: the code of the tutorials and of the chapter on Python, each as one module, and the package's own modules.
Expected: mypy has nothing to say of them, and names each line of code that is wrong on purpose. Skipped where mypy is
not installed; `./check --all` installs it.
"""

from __future__ import annotations

import json
import re
import textwrap
from pathlib import Path

import pytest
import stickslip as ss
from conftest import REPOSITORY

api = pytest.importorskip("mypy.api")
WRITTEN = [REPOSITORY / "book/15-python.md", *sorted((REPOSITORY / "book/tutorials").glob("*.ipynb"))]


def complaints(*options: str) -> list[str]:
    """What mypy says of what is named."""
    cache = f"--cache-dir={REPOSITORY / 'target/mypy'}"
    said, trouble, _ = api.run([cache, "--no-error-summary", "--ignore-missing-imports", *options])
    assert trouble == ""
    return said.splitlines()


def code(path: Path) -> str:
    """The Python of a notebook or of a chapter."""
    if path.suffix == ".ipynb":
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        return "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    return "\n".join(re.findall(r"```python\n(.*?)```", path.read_text(encoding="utf-8"), re.DOTALL))


@pytest.mark.parametrize("path", WRITTEN, ids=lambda path: path.stem)
def test_what_the_book_writes_has_the_right_types(path, tmp_path):
    module = tmp_path / "module.py"
    module.write_text(code(path), encoding="utf-8")
    assert complaints(str(module), "--check-untyped-defs", "--allow-untyped-globals") == []


def test_the_package_has_the_types_that_it_says():
    assert complaints("--strict", "--package", "stickslip") == []


def test_wrong_uses_are_found(tmp_path):
    module = tmp_path / "module.py"
    module.write_text(
        textwrap.dedent(
            """
            import stickslip as ss
            scene = ss.Scene(cell=0.1)
            scene.run(thread=2)
            sim = scene.simulation(threads="2")
            sim.time.upper()
            sim.bodies["a"].position.nothing
            ss.Results("folder").frame("last")
            ss.resume("folder", until=[1])
            sim.bodies["a"].velocity = (0, 1)
            sim.ledger().kinetic = 0.0
            sim.contacts().fx
            """
        ).lstrip(),
        encoding="utf-8",
    )
    lines = [line for line in complaints(str(module)) if ": error: " in line]
    found = [int(line.split(":")[1]) for line in lines]
    assert found == [2, 3, 4, 5, 6, 7, 8, 9, 10, 11]
