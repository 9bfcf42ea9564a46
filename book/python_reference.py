"""The reference of the Python package as a chapter of the book, from its own docstrings and signatures.

    python book/python_reference.py

It writes `19-python-reference.md` beside itself, of the package `stickslip` that Python finds. A test of the package
asserts that the chapter is what this makes.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import stickslip

CHAPTER = Path(__file__).parent / "19-python-reference.md"
ORDER = ("scene", "language", "shapes", "simulation", "functions", "running", "results", "records", "commands", "errors")
"""Modules in the order of the chapter; others follow."""
WIDTH = 116
"""Characters of a line of code."""
WHOLE = dict(break_long_words=False, break_on_hyphens=False)
"""Words stay whole."""


BEGINNING = """# Reference of the Python package

All public names of `stickslip`, here `ss`, from their docstrings. [Chapter 15](15-python.md) shows them at work.
Everything is in SI units: (n, 3) is the shape of an array, (D,) two numbers in the plane and three in space, [m] a
unit, [-] a pure number. Stress is positive in tension; masses, forces and energies of plane scenes are per metre of
depth.

`python book/python_reference.py` made this page of the package, and a test holds it against the package.
"""


def chapter() -> str:
    """The whole chapter."""
    lines = [BEGINNING]
    for module, names in modules():
        lines += [f"## {module.capitalize()}", "", *prose(inspect.getmodule(getattr(stickslip, names[0])))]
        for name in names:
            thing = getattr(stickslip, name)
            whole = of_class(name, thing) if isinstance(thing, type) else entry(f"### `ss.{name}`", f"ss.{name}", thing)
            lines += whole
    return "\n".join(lines).rstrip() + "\n"


def modules() -> list[tuple[str, list[str]]]:
    """The public names by the modules that they come from, in the order of the source."""
    found: dict[str, list[str]] = {}
    for name in sorted(stickslip.__all__, key=lambda name: inspect.getsourcelines(getattr(stickslip, name))[1]):
        found.setdefault(getattr(stickslip, name).__module__.rpartition(".")[2], []).append(name)
    place = {module: number for number, module in enumerate(ORDER)}
    return sorted(found.items(), key=lambda group: (place.get(group[0], len(ORDER)), group[0]))


def of_class(name: str, kind: type) -> list[str]:
    """A class: what it is, how it is made if that is up to the reader, its attributes and its methods."""
    bases = [base.__name__ for base in kind.__bases__ if base is not object and not base.__name__.startswith("_")]
    lines = [f"### `ss.{name}`", ""]
    if bases:
        told = [f"[`{base}`](#ss{base.lower()})" if base in stickslip.__all__ else f"`{base}`" for base in bases]
        lines += [f"A kind of {' and '.join(told)}.", ""]
    lines += prose(kind)
    if any("__init__" in vars(owner) and vars(owner)["__init__"].__doc__ for owner in own(kind)):
        lines += [*code(f"ss.{name}", kind.__init__), *prose(kind.__init__)]
    attributes = list(values(kind))
    for attribute, about in attributes:
        lines += textwrap.wrap(f"- `{attribute}`: {about}", 120, subsequent_indent="  ", **WHOLE)
    lines += [""] if attributes else []
    for method, call, member in methods(kind):
        lines += entry(f"#### {method}", call, member)
    return lines


def values(kind: type) -> Iterator[tuple[str, str]]:
    """What its objects have: attributes that have a text behind them, and properties; with what they are."""
    done = set()
    for owner in own(kind):
        tree = ast.parse(textwrap.dedent(inspect.getsource(owner)))
        for block in (node for node in ast.walk(tree) if isinstance(node, (ast.ClassDef, ast.FunctionDef))):
            for before, text in zip(block.body, block.body[1:]):
                target = before.target if isinstance(before, ast.AnnAssign) else getattr(before, "targets", [None])[0]
                name = getattr(target, "attr", getattr(target, "id", None))
                is_text = isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant)
                if name and is_text and not name.startswith("_") and name not in done:
                    done.add(name)
                    yield name, " ".join(str(text.value.value).split())
        for name, member in vars(owner).items():
            if isinstance(member, property) and not name.startswith("_") and name not in done:
                done.add(name)
                yield name, " ".join((inspect.getdoc(member) or "").split())


def methods(kind: type) -> Iterator[tuple[str, str, Any]]:
    """Public methods of a class: its heading, how it is called, and what."""
    thing = kind.__name__.lower()
    for owner in own(kind):
        for name, member in vars(owner).items():
            if name.startswith("_") or isinstance(member, property) or not callable(getattr(kind, name)):
                continue
            heading = f"`{kind.__name__}.{name}`"
            if isinstance(member, (staticmethod, classmethod)):
                yield heading, f"ss.{kind.__name__}.{name}", getattr(kind, name)
            elif inspect.isfunction(member):
                yield heading, f"{thing}.{name}", member
            else:
                # One thing of the class, and another of its objects.
                yield heading, f"ss.{kind.__name__}.{name}", getattr(kind, name)
                yield f"{heading} of an object", f"{thing}.{name}", member.__get__(object.__new__(kind), kind)


def own(kind: type) -> list[type]:
    """A class and its private parents. Public ones are told of by themselves."""
    private = (owner for owner in kind.__mro__[1:] if owner.__name__.startswith("_"))
    return [kind, *(owner for owner in private if owner.__module__.startswith("stickslip."))]


def entry(heading: str, call: str, function: Any) -> list[str]:
    """A function or a method: its call, and what it does."""
    return [heading, "", *code(call, function), *prose(function)]


def code(name: str, function: Any) -> list[str]:
    """A call with its parameters, on one line or on several."""
    signature = inspect.signature(function)
    words: list[str] = []
    for parameter in signature.parameters.values():
        if parameter.kind is parameter.KEYWORD_ONLY and not any(word.startswith("*") for word in words):
            words.append("*")
        if parameter.name != "self":
            words.append(written(parameter))
    back = signature.return_annotation
    end = ")" if back in (signature.empty, "None", "Any", None) else f") -> {back}"
    line = f"{name}({', '.join(words)}{end}"
    if len(line) > WIDTH:
        line = "\n".join([f"{name}(", *(f"    {word}," for word in words), end])
    return ["```python", line, "```", ""]


def written(parameter: inspect.Parameter) -> str:
    """A parameter as its function has it, without `Any`."""
    stars = {parameter.VAR_POSITIONAL: "*", parameter.VAR_KEYWORD: "**"}.get(parameter.kind, "")
    text = stars + parameter.name
    typed = parameter.annotation not in (parameter.empty, "Any")
    if typed:
        text += f": {parameter.annotation}"
    if parameter.default is not parameter.empty:
        text += f" = {parameter.default!r}" if typed else f"={parameter.default!r}"
    return text


def prose(thing: Any) -> list[str]:
    """The docstring of something as lines of Markdown."""
    return [*(inspect.getdoc(thing) or "").splitlines(), ""]


if __name__ == "__main__":
    CHAPTER.write_text(chapter(), encoding="utf-8")
    print(f"{CHAPTER} is written")
