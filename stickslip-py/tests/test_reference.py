"""The reference of the package in the book is that of this package, and leaves nothing out."""

from __future__ import annotations

import importlib.util
from types import ModuleType

import pytest
import stickslip as ss
from conftest import REPOSITORY


@pytest.fixture(scope="module")
def maker() -> ModuleType:
    """`book/python_reference.py`."""
    spec = importlib.util.spec_from_file_location("python_reference", REPOSITORY / "book/python_reference.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_chapter_is_that_of_this_package(maker):
    assert maker.CHAPTER.read_text(encoding="utf-8") == maker.chapter(), "run python book/python_reference.py"


def test_every_public_name_is_on_the_page_with_all_that_it_has(maker):
    lines = maker.chapter().splitlines()
    for name in ss.__all__:
        thing = getattr(ss, name)
        assert f"### `ss.{name}`" in lines and thing.__doc__, name
        if not isinstance(thing, type):
            continue
        for member in (member for member in vars(thing) if not member.startswith("_")):
            attribute = any(line.startswith(f"- `{member}`: ") for line in lines)
            assert attribute or f"#### `{name}.{member}`" in lines, f"{name}.{member}"


def test_every_entry_says_something(maker):
    for name in (name for name in ss.__all__ if isinstance(getattr(ss, name), type)):
        for heading, _, member in maker.methods(getattr(ss, name)):
            assert member.__doc__, heading
        for attribute, about in maker.values(getattr(ss, name)):
            assert about, f"{name}.{attribute}"
