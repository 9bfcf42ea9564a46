"""Records and tables: what simulations and results say, in SI units."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np


class Record(Mapping[str, Any]):
    """Named values: `record.kinetic` and `record["kinetic"]` are the same. Rows of numbers are arrays.

    It says how things were when it was asked for, and is read only.
    """

    def __init__(self, values: Mapping[str, Any], **further: Any) -> None:
        self.__dict__.update(further, _values={name: _kept(value) for name, value in values.items()})

    @classmethod
    def from_json(cls, text: str) -> Record:
        """From what the compiled half gives."""
        return cls(json.loads(text))

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __getattr__(self, name: str) -> Any:
        values = self.__dict__.get("_values", {})
        if name in values:
            return values[name]
        further = (known for known in self.__dict__ if not known.startswith("_"))
        raise AttributeError(f"found no `{name}`; allowed: {', '.join([*values, *further])}")

    def __setattr__(self, name: str, value: NoReturn) -> NoReturn:
        raise AttributeError(f"found a value for `{name}`; records are read only: they are copies of what was")

    def __dir__(self) -> Iterable[str]:
        return [*super().__dir__(), *self._values]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self._values.items())})"


def _kept(value: Any) -> Any:
    if isinstance(value, Mapping):
        return Record(value)
    if isinstance(value, list):
        numbers = value and all(isinstance(entry, (int, float)) and not isinstance(entry, bool) for entry in value)
        if not numbers:
            return [_kept(entry) for entry in value]
        array = np.array(value, dtype=float)
        array.flags.writeable = False
        return array
    return value


def matches(pattern: str, name: str) -> bool:
    """Whether a name is that of a pattern, in which each `*` is any letters, or none: as in scene files."""
    return re.fullmatch(".*".join(map(re.escape, pattern.split("*"))), name) is not None


class Table(np.ndarray):
    """A structured array: `table["x"]` is a column, `table[3]` a row, `table.dtype.names` are the columns.

    `table.where(body="ball")` are the rows with that body; `table.to_pandas()` and `table.to_polars()` are frames.
    """

    _bodies: Sequence[str] | None = None

    def __array_finalize__(self, parent: Any) -> None:
        self._bodies = getattr(parent, "_bodies", None)

    @classmethod
    def of(cls, array: np.ndarray, bodies: Sequence[str] | None = None) -> Table:
        """A structured array as a table; nothing is copied. `bodies` are all that the scene has, by their names."""
        table = array.view(cls)
        table._bodies = bodies
        return table

    @classmethod
    def of_columns(cls, columns: Mapping[str, Sequence[str]]) -> Table:
        """A table of columns of text, as files have them: numbers where all entries are numbers."""
        parsed = {name: _numbers(column) for name, column in columns.items()}
        array = np.empty(
            max(map(len, parsed.values()), default=0), [(name, column.dtype) for name, column in parsed.items()]
        )
        for name, column in parsed.items():
            array[name] = column
        return cls.of(array)

    def where(self, **equal: Any) -> Table:
        """The rows whose columns have these values: `contacts.where(body_a="ball")`; in text `*` is any letters.

        There may be none; a column or a body that there is not raises `ValueError`.
        """
        rows = np.ones(len(self), dtype=bool)
        for name, value in equal.items():
            column = np.asarray(self[name])
            if isinstance(value, str) and name in BODIES and self._bodies is not None:
                known = [*self._bodies, *map(str, np.unique(column))]
                if not any(matches(value, body) for body in known):
                    allowed = ", ".join(self._bodies)
                    raise ValueError(f"found {name}={value!r}; allowed: {allowed}, or a pattern of them with `*`")
            if isinstance(value, str) and "*" in value:
                fits = {entry: matches(value, str(entry)) for entry in np.unique(column)}
                rows &= np.array([fits[entry] for entry in column], dtype=bool)
            else:
                rows &= column == value
        found: Table = self[rows].view(Table)
        return found

    def rows(self, *names: str) -> np.ndarray:
        """Some columns of numbers side by side (n, number of names): `contacts.rows("fx", "fy", "fz")`."""
        return np.stack([np.asarray(self[name], dtype=float) for name in names], axis=-1)

    def columns(self) -> dict[str, np.ndarray]:
        """Columns by their names."""
        return {name: np.asarray(self[name]) for name in self.dtype.names or ()}

    def to_pandas(self) -> Any:
        """A `pandas.DataFrame`; needs pandas."""
        return _needed("pandas").DataFrame(self.columns())

    def to_polars(self) -> Any:
        """A `polars.DataFrame`; needs polars."""
        return _needed("polars").DataFrame(self.columns())

    def to_xarray(self) -> Any:
        """An `xarray.Dataset` over time, and over what else names the rows, such as the body; needs xarray."""
        columns = self.columns()
        labels = [name for name, column in columns.items() if name == "time" or column.dtype.kind == "U"]
        places, axes = [], {}
        for name in labels:
            axes[name], place = np.unique(columns[name], return_inverse=True)
            places.append(place)
        shape = tuple(len(axis) for axis in axes.values())
        data = {}
        for name in (name for name in columns if name not in labels):
            whole = np.full(shape, np.nan)
            whole[tuple(places)] = columns[name]
            data[name] = (tuple(labels), whole)
        return _needed("xarray").Dataset(data, axes)

    def __getitem__(self, key: Any) -> Any:
        names = self.dtype.names
        if isinstance(key, str) and names is not None and key not in names:
            raise ValueError(f"found a column `{key}`, which the table does not have; allowed: {', '.join(names)}")
        return super().__getitem__(key)

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> NoReturn:
            names = self.dtype.names or ()
            if name in names:
                raise AttributeError(f'found `.{name}`; columns of tables are in brackets: table["{name}"]')
            raise AttributeError(f"found no `{name}`; columns of tables are in brackets: {', '.join(names)}")

    def __repr__(self) -> str:
        if self.dtype.names is None or self.ndim != 1 or len(self) <= SHOWN:
            return super().__repr__()
        with np.printoptions(threshold=1):
            return f"{super().__repr__()}\n# {len(self)} rows"

    def _repr_html_(self) -> str | None:
        if self.dtype.names is None or self.ndim != 1:
            return None
        columns = self.columns()
        head = "".join(f"<th>{escape(name)}</th>" for name in columns)
        shown = min(len(self), SHOWN)
        cells = ("".join(f"<td>{escape(_cell(column[i]))}</td>" for column in columns.values()) for i in range(shown))
        rows = "".join(f"<tr>{row}</tr>" for row in cells)
        rest = f"<p>{len(self) - shown} more rows</p>" if len(self) > shown else ""
        return f"<table><tr>{head}</tr>{rows}</table>{rest}"


SHOWN = 20
"""Rows of a table that are shown; a notebook shows as many of a longer one, Python its first and its last three."""
BODIES = ("body", "body_a", "body_b")
"""Columns that name bodies."""


def _cell(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, np.floating) else str(value)


def _numbers(column: Sequence[str]) -> np.ndarray:
    try:
        return np.array(column, dtype=float)
    except ValueError:
        return np.array(column, dtype=str)


def _needed(package: str) -> Any:
    import importlib

    try:
        return importlib.import_module(package)
    except ImportError as error:
        name = package.split(".")[0]
        raise ImportError(f"this needs {name}, which is not installed: pip install {name}") from error
