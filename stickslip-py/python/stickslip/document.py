"""From a document of plain dictionaries and lists to the text of a scene file (TOML)."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from os import PathLike, fspath
from typing import Any

import numpy as np

BARE = re.compile(r"[A-Za-z0-9_-]+")
WIDTH = 110


def plain(value: Any, key: str = "") -> Any:
    """A value as the document keeps it: tuples and arrays as lists, numbers of NumPy as Python's, without what is None.

    `key` is where it stands, for the message of a TypeError.
    """
    if isinstance(value, PathLike):
        return str(fspath(value))
    if isinstance(value, Mapping):
        entries = ((str(name), entry) for name, entry in value.items() if entry is not None)
        return {name: plain(entry, f"{key}.{name}".lstrip(".")) for name, entry in entries}
    if isinstance(value, np.ndarray):
        return plain(value.tolist(), key)
    if isinstance(value, (list, tuple)):
        return [plain(entry, f"{key}[{number}]") for number, entry in enumerate(value)]
    if isinstance(value, np.generic):
        return plain(value.item(), key)
    if isinstance(value, (bool, int, float, str)):
        return value
    kind = type(value).__name__
    raise TypeError(f"{key}: found a {kind}; allowed: numbers, text, dictionaries, and lists or arrays of these")


def written(document: Mapping[str, Any]) -> str:
    """The text of a whole document: keys of its top, then its tables."""
    return "\n".join(_table(plain(document), [])).lstrip("\n") + "\n"


def written_value(value: Any) -> str:
    """A value on one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, list):
        return "[" + ", ".join(map(written_value, value)) + "]"
    entries = ", ".join(f"{_key(name)} = {written_value(entry)}" for name, entry in value.items())
    return f"{{ {entries} }}" if entries else "{}"


def _table(table: Mapping[str, Any], path: list[str]) -> list[str]:
    """The lines of a table without its header: its keys, then the tables in it."""
    lines, below = [], []
    for name, entry in table.items():
        inner = [*path, name]
        header = ".".join(map(_key, inner))
        if len(path) < 2 and isinstance(entry, dict):
            # A table that only holds tables needs no header.
            bare = bool(entry) and all(isinstance(value, dict) for value in entry.values()) and len(path) < 1
            below += [] if bare else ["", f"[{header}]"]
            below += _table(entry, inner)
        elif len(path) < 2 and isinstance(entry, list) and entry and all(isinstance(item, dict) for item in entry):
            for item in entry:
                below += ["", f"[[{header}]]", *_table(item, [*inner, ""])]
        else:
            lines.append(_line(name, entry))
    return lines + below


def _line(name: str, entry: Any) -> str:
    line = f"{_key(name)} = {written_value(entry)}"
    if len(line) > WIDTH and isinstance(entry, list):
        items = "".join(f"    {written_value(item)},\n" for item in entry)
        return f"{_key(name)} = [\n{items}]"
    plain_lines = isinstance(entry, str) and "\n" in entry and not re.search(r'["\\\x00-\x08\x0b-\x1f\x7f]', entry)
    return f'{_key(name)} = """\n{entry}"""' if plain_lines else line


def _key(name: str) -> str:
    return name if BARE.fullmatch(name) else _text(name)


def _text(value: str) -> str:
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
