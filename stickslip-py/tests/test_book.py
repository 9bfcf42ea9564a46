"""What the chapter on Python says is true: its code runs, from the first line to the last."""

from __future__ import annotations

import re
import warnings

import stickslip as ss
from conftest import REPOSITORY


def blocks() -> list[str]:
    text = (REPOSITORY / "book/15-python.md").read_text()
    return re.findall(r"```python\n(.*?)```", text, re.DOTALL)


def test_the_code_of_the_chapter_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names: dict = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ss.StickslipWarning)
        for number, block in enumerate(blocks()):
            exec(compile(block, f"block {number} of book/15-python.md", "exec"), names)
    assert "did you mean `radius`?" in capsys.readouterr().out
    assert names["summary"].status == "finished" and not names["summary"].warnings, (
        "rings that are no example of trouble"
    )
    left, right = (names["results"].bodies.where(body=name) for name in ("left", "right"))
    assert max(abs(left["vx"] + right["vx"])) < 1e-12 and abs(left["vx"][-1]) < 1.0 and left["wz"][-1] > 1.0


def test_two_rings_collide_in_less_than_twenty_lines():
    first = blocks()[0]
    assert "ring" in first and len([line for line in first.splitlines() if line.strip()]) < 20


def test_all_that_is_public_is_explained_by_its_docstring():
    for name in ss.__all__:
        thing = getattr(ss, name)
        assert thing.__doc__, name
        for member in vars(thing) if isinstance(thing, type) else ():
            if not member.startswith("_") and callable(getattr(thing, member)) and member != "load":
                assert getattr(thing, member).__doc__, f"{name}.{member}"


def test_the_version_is_that_of_the_library():
    text = (REPOSITORY / "Cargo.toml").read_text()
    assert f'version = "{ss.__version__}"' in text
