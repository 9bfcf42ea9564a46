"""The words of scenes: each key with what it means, its unit and its default, as the reader of scene files has them."""

from __future__ import annotations

import json
import textwrap
from collections import deque
from collections.abc import Iterator
from functools import cache
from typing import Any

from . import _core
from .errors import SceneError

WIDTH = 100
"""Characters of a line."""


class Keys(str):
    """A text that shows itself where Python shows values, line by line."""

    def __repr__(self) -> str:
        return str(self)


def keys(of: str = "") -> str:
    """What a table of a scene may hold: each key with its meaning, its unit, its default and the words it takes.

    `ss.keys()` lists the tables, `ss.keys("material")` the keys of `Scene.material`, and so for every other method that
    adds something; `ss.keys("materials.neo_hookean")`, `ss.keys("shape.ball")` and `ss.keys("transfer")` lead on from
    there. It is what `stickslip schema` prints, to be read by people. Raises `SceneError` where there is no such key.
    """
    path, node = _found(of.split(".")) if of else ("", _schema())
    heading = f"{path}: {node.get('description', '')}" if path else "Tables and keys of a scene"
    lines = textwrap.wrap(heading.removesuffix(": "), WIDTH) + [""]
    for name, entry, required in _entries(node):
        lines += _told(name, entry, required)
    return Keys("\n".join(lines + _words(node)).strip())


@cache
def _schema() -> dict[str, Any]:
    schema: dict[str, Any] = json.loads(_core.schema())
    return schema


def _whole(node: Any) -> dict[str, Any]:
    """A node of the schema with what it refers to; what it says itself goes first."""
    while "$ref" in node:
        meant = _schema()["$defs"][node["$ref"].rpartition("/")[2]]
        node = {**meant, **{name: entry for name, entry in node.items() if name != "$ref"}}
    return dict(node)


def _entries(node: Any) -> Iterator[tuple[str, dict[str, Any], bool]]:
    """Keys of a table, of the tables in a list, or of those by names: name, node, and whether it must be there."""
    node = _whole(node)
    for name, entry in node.get("properties", {}).items():
        # What of several there is has its meaning beside it.
        yield name, {"description": node.get("description", ""), **_whole(entry)}, name in node.get("required", ())
    inner = [*node.get("anyOf", ()), node.get("items"), node.get("additionalProperties")]
    for table in (table for table in inner if isinstance(table, dict)):
        one_of = "anyOf" in node
        yield from ((name, entry, required and not one_of) for name, entry, required in _entries(table))


def _found(path: list[str]) -> tuple[str, dict[str, Any]]:
    """The node at a path, whose first word may stand anywhere and in the singular: its whole path, and the node."""
    first, *rest = path
    place, node = _anywhere(first)
    for word in rest:
        inner = {name: entry for name, entry, _ in _entries(node)}
        if word not in inner:
            raise _unknown(".".join(path), word, list(inner))
        place, node = f"{place}.{word}", inner[word]
    return place, node


def _anywhere(word: str) -> tuple[str, dict[str, Any]]:
    """The key nearest to the top that is called so: `body` is `bodies`, `transfer` is `time.transfer`."""
    wanted = {word, f"{word}s", f"{word.removesuffix('y')}ies"}
    queue: deque[tuple[str, Any]] = deque([("", _schema())])
    seen: set[str] = set()
    while queue:
        place, node = queue.popleft()
        for name, entry, _ in _entries(node):
            inner = f"{place}.{name}".lstrip(".")
            if name in wanted:
                return inner, entry
            # Shapes hold shapes.
            if name not in seen:
                seen.add(name)
                queue.append((inner, entry))
    raise _unknown(word, word, [name for name, _, _ in _entries(_schema())])


def _unknown(path: str, word: str, known: list[str]) -> SceneError:
    allowed = ", ".join(known) or "nothing below it"
    return SceneError(f"found no key `{word}` in `{path}`; allowed: {allowed}", key=path, allowed=allowed)


def _told(name: str, node: dict[str, Any], required: bool) -> list[str]:
    """A key on lines of its own, with the words that it takes."""
    default = json.dumps(node["default"]) if "default" in node else None
    head = f"{name} = {default}" if default is not None else f"{name} (required)" if required else name
    examples = [json.dumps(example) for example in node.get("examples", [])]
    such = f" Such as {' or '.join(examples)}." if examples else ""
    text = f"{head}: {node.get('description', '')}{such}"
    return textwrap.wrap(text, WIDTH, subsequent_indent="    ") + ["    " + line for line in _words(node)]


def _words(node: dict[str, Any]) -> list[str]:
    """The words that a key takes, with what each means."""
    choices = [choice for choice in _whole(node).get("anyOf", ()) if "const" in choice]
    return [
        line
        for choice in choices
        for line in textwrap.wrap(
            f"{json.dumps(choice['const'])}: {choice.get('description', '')}", WIDTH - 4, subsequent_indent="    "
        )
    ]
