"""Results of runs: tables through time, snapshots of the particles, charts."""

from __future__ import annotations

import base64
import csv
import os
import tempfile
from collections.abc import Iterator, Mapping
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from .errors import ResultsError, StickslipError
from .records import Record, Table, _needed
from .running import _record


class Frame(Mapping[str, np.ndarray]):
    """The particles at a time, by columns: `frame["stress"]`.

    Rows are ordered by body and then by the particle's number. `position`, `velocity` (n, 3) [m, m/s], `stress` (n, 6)
    as xx yy zz xy yz xz, tension positive, `pressure`, `von_mises` [Pa], `deformation` (n, 3, 3), `mass` [kg], `volume`
    [m^3], `body` (index), `number`, and what the laws remember. `units` has the units, `time` the time [s].
    """

    def __init__(
        self, time: float, columns: Mapping[str, np.ndarray], units: Mapping[str, str], names: list[str]
    ) -> None:
        self.time = time
        """Simulated time [s]."""
        self.units = dict(units)
        """SI units of the columns by their names; empty for numbers without one."""
        self._columns, self._names = dict(columns), names

    def body(self, name: str) -> Frame:
        """The particles of one body, n of them."""
        if name not in self._names:
            raise KeyError(f"found a body `{name}`, which the run does not have; allowed: {', '.join(self._names)}")
        rows = self._columns["body"] == self._names.index(name)
        return Frame(self.time, {key: column[rows] for key, column in self._columns.items()}, self.units, self._names)

    def to_pyvista(self) -> Any:
        """A `pyvista.PolyData` of points with all columns, for `.plot(scalars="pressure")`; needs pyvista."""
        cloud = _needed("pyvista").PolyData(np.ascontiguousarray(self["position"]))
        for name, column in self._flat():
            cloud.point_data[name] = column
        return cloud

    def to_meshio(self) -> Any:
        """A `meshio.Mesh` of vertices with all columns; needs meshio. `frame.to_meshio().write("frame.vtu")`"""
        points = self["position"]
        vertices = [("vertex", np.arange(len(points)).reshape(-1, 1))]
        return _needed("meshio").Mesh(points, vertices, point_data=dict(self._flat()))

    def to_xarray(self) -> Any:
        """An `xarray.Dataset` over the particles, with units and time as attributes; needs xarray."""
        data = {}
        for name, column in self._flat():
            axes = ("particle",) if column.ndim == 1 else ("particle", f"component_{column.shape[1]}")
            data[name] = (axes, column, {"unit": self.units.get(name, "")})
        return _needed("xarray").Dataset(data, attrs={"time": self.time})

    def _flat(self) -> Iterator[tuple[str, np.ndarray]]:
        """Columns but for the position, tensors row by row."""
        return ((name, column.reshape(len(column), -1) if column.ndim > 2 else column)
                for name, column in self._columns.items() if name != "position")

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._columns:
            raise KeyError(
                f"found a column `{name}`, which the snapshot does not have; allowed: {', '.join(self._columns)}"
            )
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<Frame t = {self.time:g} s: {len(self['body'])} particles, {', '.join(self)}>"


def read_table(path: Path) -> Table:
    """A table of a file; a last row that is cut short is left out."""
    with open(path, encoding="utf-8", newline="") as file:
        whole = (line for line in file if line.endswith("\n"))
        head, *rows = list(csv.reader(whole)) or [[]]
    columns = zip(*rows) if rows else ([] for _ in head)
    return Table.of_columns(dict(zip(head, map(list, columns))))


class Results:
    """What a run left in a folder, finished or not.

    `results.bodies` is bodies.csv, and so for every table there: `energy`, `contacts`, `loads`, `joints`, `sections`,
    `removed`, `groups`, `group_contacts`, `fabric`, `tractions`, `probes`, `arrivals`, `fronts`, `front_speeds`,
    `fringes`. `results.bodies.dtype.names` are the columns; what each is, with its unit, stands in the book,
    book/07-outputs.md of the repository. Tables and snapshots are read when they are asked for.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        """`folder` is that of `out` of a run, the run's summary, or NAME.results of the command."""
        self.folder = Path(folder)
        """Where they are."""
        if self.folder.is_file():
            advice = f"give the folder that the run left: ss.Results({str(self.folder.parent)!r})"
            raise ResultsError(f"{self.folder} is a file; {advice}", help=advice)
        self._frames = _core.frames(self.folder)
        self.record = Record(_record(self.folder))
        """`run.json`: status, warnings, performance, the scene as run."""
        self._drawn: str | None = None

    @property
    def status(self) -> str:
        """How the run stands: "running", "finished", "interrupted", "out_of_time", "stopped" or "failed"."""
        return str(self.record.status)

    @property
    def warnings(self) -> list[Record]:
        """What makes the results doubtful."""
        return list(self.record.warnings)

    @property
    def names(self) -> list[str]:
        """Names of the bodies, in the order of the numbers in snapshots."""
        return list(self.record.bodies)

    @property
    def tables(self) -> list[str]:
        """Names of the tables that there are."""
        return sorted(path.stem for path in self.folder.glob("*.csv"))

    @property
    def times(self) -> np.ndarray:
        """Times of the snapshots (n,) [s]."""
        return np.array([time for time, _ in self._frames], dtype=float)

    def table(self, name: str) -> Table:
        """The table of this name. A last row that is cut short is left out: a run may be writing it."""
        if name not in self.tables:
            raise AttributeError(f"found no table `{name}` in {self.folder}; allowed: {', '.join(self.tables)}")
        return Table.of(read_table(self.folder / f"{name}.csv"), self.names)

    def frame(self, number: int) -> Frame:
        """The snapshot of this number, from 0; -1 is the last. `times` has their times."""
        if not isinstance(number, (int, np.integer)):
            last = len(self._frames) - 1
            raise TypeError(
                f"found snapshot {number!r}; allowed: a number from 0 to {last}, or -1 for the last; `times` has their "
                "times [s], and abs(results.times - t).argmin() is the number of the one nearest to t"
            )
        if not -len(self._frames) <= number < len(self._frames):
            raise IndexError(f"found snapshot {number}; allowed: 0 to {len(self._frames) - 1}")
        time, path = self._frames[number]
        columns, units = {}, {}
        for name, (unit, count, values) in _core.read_frame(path).items():
            shape = {1: (-1,), 9: (-1, 3, 3)}.get(count, (-1, count))
            columns[name], units[name] = values.reshape(shape), unit
        return Frame(time, columns, units, self.names)

    def plot(self, body: str, quantity: str, ax: Any = None) -> Any:
        """A chart of a column of bodies.csv, in SI units, through time [s], with its known answer if the scene has one.

        Needs matplotlib; draws on `ax` if it is given, and returns the axes.
        """
        bodies = self.bodies
        if body not in self.names:
            raise ValueError(f"found a body `{body}`; allowed: {', '.join(self.names)}")
        quantities = [name for name in bodies.dtype.names or () if name not in ("time", "body")]
        if quantity not in quantities:
            raise ValueError(f"found a column `{quantity}`; allowed: {', '.join(quantities)}")
        if ax is None:
            ax = _needed("matplotlib.pyplot").figure().add_subplot()
        rows = bodies.where(body=body)
        ax.plot(rows["time"], rows[quantity], label=f"{body} {quantity}")
        for reference in self.record.references:
            if (reference.body, reference.quantity) == (body, quantity):
                points = np.array(reference.points)
                ax.plot(points[:, 0], points[:, 1], "--", label=reference.label)
        ax.set_xlabel("time [s]")
        ax.set_ylabel(f"{quantity} [{UNITS[quantity]}]" if quantity in UNITS else quantity)
        ax.set_title(self.record.title)
        ax.legend()
        return ax

    def __getattr__(self, name: str) -> Table:
        if name.startswith("_") or "folder" not in self.__dict__:
            raise AttributeError(name)
        return self.table(name)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.tables]

    def __repr__(self) -> str:
        reached = self.record.performance
        return (
            f"<Results {self.record.title!r}: {self.status} at t = {reached.time:g} s, {reached.steps} steps, "
            f"{len(self._frames)} snapshots, {len(self.warnings)} warnings>"
        )

    def _repr_html_(self) -> str:
        warned = "".join(f"<li>{escape(warning.message)}</li>" for warning in self.warnings)
        return f"<code>{escape(repr(self))}</code><br>tables: {', '.join(self.tables)}<ul>{warned}</ul>{self._shown()}"

    def _shown(self) -> str:
        """The picture that the run left, else its last snapshot, which is drawn once; why there is none."""
        if self._drawn is None and self._frames:
            from .commands import render

            picture = self.folder / "picture.png"
            try:
                with tempfile.TemporaryDirectory() as folder:
                    path = picture if picture.exists() else render(self, out=Path(folder) / "picture.png").path
                    shown = base64.b64encode(path.read_bytes()).decode()
                self._drawn = f'<img src="data:image/png;base64,{shown}">'
            except StickslipError as error:
                self._drawn = f"<code>no picture: {escape(str(error))}</code>"
        return self._drawn or ""


UNITS = {
    "mass": "kg",
    "kinetic": "J",
    "strain": "J",
    **{axis: "m" for axis in "xyz"},
    **{f"v{axis}": "m/s" for axis in "xyz"},
    **{f"w{axis}": "rad/s" for axis in "xyz"},
}
"""Units of the columns of bodies.csv."""

__all__ = ["Frame", "Results", "ResultsError"]
