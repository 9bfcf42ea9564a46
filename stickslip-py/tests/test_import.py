"""The Python files without their engine say what is missing and how it is built."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

FILES = Path(__file__).parents[1] / "python" / "stickslip"


def test_a_source_tree_that_is_not_built_says_how_to_build_it(tmp_path: Path) -> None:
    shutil.copytree(FILES, tmp_path / "stickslip", ignore=shutil.ignore_patterns("_core.*", "__pycache__"))
    line = [sys.executable, "-c", "import stickslip"]
    seen = dict(os.environ, PYTHONPATH=str(tmp_path))
    done = subprocess.run(line, capture_output=True, text=True, env=seen, cwd=tmp_path, check=False)
    last = done.stderr.strip().splitlines()[-1]
    assert done.returncode == 1
    assert last.startswith("ImportError: the Python files of Stickslip in "), done.stderr
    assert str(tmp_path / "stickslip") in last and "`pip install .` at the root of the tree" in last
