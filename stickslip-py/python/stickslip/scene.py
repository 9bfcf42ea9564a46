"""Scenes: what a user asks for, by the words of scene files."""

from __future__ import annotations

import copy
import functools
import inspect
import keyword
import os
import tempfile
import warnings
from collections.abc import Callable, Iterator, Mapping
from html import escape
from pathlib import Path
from typing import Any, TypeVar, cast, overload

from . import _core
from .document import plain, written, written_value
from .errors import RunError, SceneError, StickslipError, StickslipWarning
from .functions import Function, Law, named
from .records import Record
from .results import Results
from .running import Summary, carry_out, threads_of, warn_of_missing_friction
from .simulation import Simulation

IN_PYTHON = "<scene in Python>"
"""What stands for the file of a scene that has none."""
MOST_DRAWN = 100_000
"""Particles of a scene that is drawn where a notebook shows it: more take longer than a reader waits."""
CHECKPOINT = b"stickslip checkpoint"
"""How a checkpoint begins."""
CALLS = {
    "time": "call scene.time(end=...)",
    "materials": "call scene.material(NAME, density=..., LAW=dict(...)), see ss.keys('material')",
    "bodies": "call scene.body(NAME, material=..., shape=...)",
}
"""What gives the tables that no scene can do without."""
MISSING = ("nothing, the key is missing", "no body", "no law")
"""What the reader finds where there is nothing."""

Method = TypeVar("Method", bound=Callable[..., Any])


def _such_as(example: str) -> Callable[[Method], Method]:
    """Of a method: arguments that do not fit are refused with an example of what does."""

    def told(method: Method) -> Method:
        signature = inspect.signature(method)

        @functools.wraps(method)
        def call(*arguments: Any, **keys: Any) -> Any:
            try:
                signature.bind(*arguments, **keys)
            except TypeError as error:
                raise TypeError(f"{method.__qualname__}: {error}; allowed: {example}") from None
            return method(*arguments, **keys)

        return cast(Method, call)

    return told


class Report(Record):
    """What a run will be, as `stickslip check` says: `print(report)`, or its values, such as `report.particles`."""

    text: str
    """What the command prints."""

    def __init__(self, said: str, values: Mapping[str, Any]) -> None:
        super().__init__(values, text=said)

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return f"<pre>{escape(self.text)}</pre>"


class _Load:
    """`Scene.load(path)` reads a file; `scene.load(body, ...)` adds a load, as `scene.support` adds a support."""

    @overload
    def __get__(self, scene: None, kind: type[Scene]) -> Callable[..., Scene]: ...
    @overload
    def __get__(self, scene: Scene, kind: type[Scene]) -> Callable[..., Scene]: ...
    def __get__(self, scene: Scene | None, kind: type[Scene]) -> Callable[..., Scene]:
        return kind._from_file if scene is None else scene._add_load


class Scene:
    """A scene: bodies, materials, how they touch, what holds and loads them, time, and outputs.

    Its methods take the keys of the scene file as keywords, all of which `ss.keys` lists: `ss.keys("body")` those of
    `Scene.body`. Values are numbers in SI units, or text with a unit or a formula (`"0.5 mm"`, `"radius / 8"`); vectors
    are sequences of two numbers in the plane, of three in space, written (D,) below. In the plane forces and masses are
    per metre of depth. A key that is a word of Python gets an underscore behind it: `from_`. All methods that
    add something return the scene. What is wrong is said by `check`, `simulation`, `run` and `save`, as `SceneError`.

    `document` is the scene as nested dictionaries and lists, as the file has it; it may be changed at will.
    """

    document: dict[str, Any]
    """The scene as nested dictionaries and lists."""
    functions: dict[str, Law | Function | Callable[..., Any]]
    """Laws, loads and motions of your own by the names that `{ outside = NAME }` of the document has for them."""

    @_such_as('ss.Scene(dimension="plane-strain", cell="1 mm"); ss.Scene.load("scene.toml") reads a file')
    def __init__(
        self,
        dimension: str,
        cell: Any,
        *,
        title: str | None = None,
        about: str | None = None,
        gravity: Any = None,
        parameters: Mapping[str, Any] | None = None,
        **space: Any,
    ) -> None:
        """`dimension` is "plane-strain" or "2d", "plane-stress" or "3d", `cell` the side of a grid cell [m].

        `gravity` is the acceleration of every body (D,) [m/s^2]; `parameters` are names of your own for numbers and
        words; `space` are further keys of `[space]`: `basis`, the shape functions between particles and grid ("gimp" by
        default, "linear", "spline" or "cubic"), `interior`, where bodies that deform are computed ("reference"
        for elastic bodies by default, "grid" or "auto"), `precision` ("double" by default, or "single"),
        `particles_per_side` of a cell (2 by default).
        """
        top = {"title": title, "about": about, "gravity": gravity, "parameters": parameters}
        table = {"dimension": dimension, "cell": cell, **_keys(space)}
        self.functions = {}
        self.document = plain({**top, "space": table})
        self._file: tuple[Path, str] | None = None
        self._loaded: dict[str, Any] | None = None
        self._set: list[tuple[str, str]] = []
        self._refuse_unknown({"space": self.document["space"]})

    load = _Load()

    @classmethod
    def _from_file(cls, path: str | os.PathLike[str], /, **parameters: Any) -> Scene:
        """Reads a scene file; keywords replace parameters, as `--set` does.

        `Scene.load("backspin.toml", cells_per_radius=4)`; other keys by their path, in a dictionary:
        `Scene.load("backspin.toml", **{"time.end": "0.5 s", "contact[0].friction": 0.1})`.
        """
        given = [(name, written_value(plain(value, name))) for name, value in parameters.items()]
        try:
            words = _core.ReadScene.load(path, given).text
        except SceneError as error:
            raise _of_loading(error, Path(path)) from None
        scene = cls.__new__(cls)
        scene.document, scene.functions = _core.document(words), {}
        scene._file, scene._loaded, scene._set = (Path(path).absolute(), words), copy.deepcopy(scene.document), []
        return scene.set(**parameters)

    def set(self, **values: Any) -> Scene:
        """Gives parameters other values, and other keys by their path.

        `scene.set(friction=0.2)`, `scene.set(**{"bodies[0].velocity": (1, 0)})`
        """
        given = [(name, plain(value, name)) for name, value in values.items()]
        known = self.document.get("parameters", {})
        for name, value in given:
            if "." not in name and "[" not in name and name not in known:
                choices = ", ".join(known) or "there are none"
                problem = f"found no parameter `{name}`; allowed: a parameter of the scene ({choices})"
                advice = _by_path(self.document, name)
                raise SceneError(f"{problem}; {advice}", key=name, allowed=choices, help=advice)
        before = self._is_loaded()
        for name, value in given:
            _put(self.document, name if "." in name or "[" in name else f"parameters.{name}", value)
        if before:
            # The file as it is, with what was set: mistakes are shown in its own lines.
            self._set += [(name, written_value(value)) for name, value in given]
            self._loaded = copy.deepcopy(self.document)
        return self

    def parameter(self, **values: Any) -> Scene:
        """Names of your own for numbers in SI units, formulas and words: `scene.parameter(radius="5 cm")`."""
        return self._update("parameters", values)

    def material(self, name: str, **keys: Any) -> Scene:
        """A material: `density` [kg/m^3], and a law with its constants [Pa].

        `scene.material("rubber", density=1000, neo_hookean=dict(young_modulus="1 MPa", poisson_ratio=0.3))`

        Laws are `neo_hookean` for rubber and whatever else is elastic at large strains, `hypoelastic` for small strains
        and large rotations, `von_mises` for metals and clay (`yield_stress`, `hardening_modulus`), `viscoelastic` for
        polymers and gels, `damage` for rock, concrete and glass, `hencky`, `mooney_rivlin` and `ogden` for rubber,
        `fluid` for what flows, `johnson_cook` and `armstrong_frederick` for metals, `crushable_foam` for foams,
        `drucker_prager`, `mohr_coulomb`, `modified_cam_clay` and `mu_i` for soils and grains. Elastic constants are any
        two of `bulk_modulus`, `shear_modulus`, `young_modulus`, `poisson_ratio` and `p_wave_modulus`.
        `ss.keys("materials.von_mises")` lists what one takes. A law of your own is
        `outside=dict(law=function, bulk_modulus=..., shear_modulus=...)`, see `Law`.
        """
        return self._update("materials", {name: _keys(keys)})

    def body(self, name: str, **keys: Any) -> Scene:
        """A body: `material`, `shape` (`ss.ball` ...), `velocity` (D,) [m/s], `spin` [rad/s], `rigid=dict(...)` ...

        In the plane `spin` is one number, in space (3,). `velocity` and `spin` of `rigid` may be functions of time, see
        `Function`.
        """
        return self._append("bodies", {"name": name, **keys})

    def shape(self, name: str, shape: Any) -> Scene:
        """A shape by name, to be used wherever a shape is: `shape="tooth"`, `within="clamp"`.

        It may name those that were given before it.
        """
        return self._update("shapes", {name: shape})

    def packing(self, name: str, **keys: Any) -> Scene:
        """Bodies `name` 1, 2 ... at random places: `material`, `shape`, `within`, `count` or `solid_fraction` ...

        `sizes` are over that of the shape [-], `gap` is a length [m].
        """
        return self._append("packings", {"name": name, **keys})

    def image(self, name: str, file: str | os.PathLike[str], **keys: Any) -> Scene:
        """Bodies `name` 1, 2 ... from the labels of an image, with `threshold` from its greys.

        `pixel` is the side of one [m], `origin` the lower corner of the image (D,) [m].
        """
        return self._append("images", {"name": name, "file": file, **keys})

    def point_cloud(self, name: str, file: str | os.PathLike[str], **keys: Any) -> Scene:
        """A body, or one for each value of `body`, of the particles in a CSV file: `material`, `unit` [m] ..."""
        return self._append("point_clouds", {"name": name, "file": file, **keys})

    @_such_as('scene.contact(("left", "right"), friction=0.3), of which the pair may be left out')
    def contact(self, between: Any = None, **keys: Any) -> Scene:
        """A contact rule: `scene.contact(("left", "right"), friction=0.3)`. The first that fits a pair holds.

        `between` names two bodies or materials, or patterns of them with `*`; without it the rule is for all pairs.
        `friction` is a coefficient [-], `law` is "surface" by default; `ss.keys("contact")` lists the rest.
        """
        return self._append("contact", {"between": between, **keys})

    def support(self, body: str, **keys: Any) -> Scene:
        """What holds or drives a part of a body: `on`, `within`, and what it does to it.

        `displacement` (D,) [m] or `velocity` (D,) [m/s], "free" along axes that it leaves free, `stiffness` [N/m],
        `dashpot` [N s/m].
        """
        return self._append("supports", {"body": body, **keys})

    def _add_load(self, body: str, **keys: Any) -> Scene:
        """What presses or pulls a part of a body: `on`, `within`, and one of five.

        `force` (D,) [N], `traction` (D,) [Pa], `pressure` [Pa], `acceleration` (D,) [m/s^2] or `temperature` [K]. All
        but the last may be functions of time and place, see `Function`.
        """
        return self._append("loads", {"body": body, **keys})

    def joint(self, body: str, **keys: Any) -> Scene:
        """What joins a free rigid body to another, `to`, or the ground: `hinge=dict(point=...)`, `slider`, `ball` ...

        Points are (D,) [m], `torque` is in N m, `force` in N, `speed` in rad/s or m/s.
        """
        return self._append("joints", {"body": body, **keys})

    def spring(self, from_: Any, to: Any, **keys: Any) -> Scene:
        """A spring between parts of bodies, each a `dict(body=..., on=..., within=...)`.

        `stiffness` [N/m], `dashpot` [N s/m], `length` without a force [m].
        """
        return self._append("springs", {"from": from_, "to": to, **keys})

    def domain(self, min: Any, max: Any, **faces: Any) -> Scene:
        """A box that holds all material: its corners (D,) [m], and what its faces do (`x_min="symmetry"` ...)."""
        space = self.document.get("space", {})
        space = {**space, "domain": plain({"min": min, "max": max, **faces}, "space.domain")}
        self._refuse_unknown({"space": space})
        self.document["space"] = space
        return self

    @_such_as('scene.time(end="10 ms")')
    def time(self, **keys: Any) -> Scene:
        """Time and step: `end` of the run [s], `courant` [-], `max_step` [s], `relax=dict()` ...

        `transfer` between particles and grid is "rflip" by default, which keeps the spin of bodies; "flip", "apic",
        "xpic" and "pic" are others. `ss.keys("time")` says what each does.
        """
        return self._update("time", keys)

    def start(self, folder: str | os.PathLike[str], **keys: Any) -> Scene:
        """Bodies begin as the run in `folder`, or a checkpoint, left those of the same names."""
        return self._update("start", {"from": folder, **keys})

    @_such_as("scene.damping(local=0.1)")
    def damping(self, **keys: Any) -> Scene:
        """What slows bodies down: `viscous` [1/s], `local`, `bulk_linear`, `bulk_quadratic` [-]."""
        return self._update("damping", keys)

    def health(self, **keys: Any) -> Scene:
        """What a run watches, and what it does where something is wrong: `contact="ignore"`, `energy="stop"` ...

        It warns by default. What is only recorded or ignored is not warned of (`StickslipWarning`) either.
        """
        return self._update("health", keys)

    @_such_as('scene.outputs(tables="0.1 ms", particles="1 ms")')
    def outputs(self, **keys: Any) -> Scene:
        """What runs write: intervals of `tables`, `particles`, `grid`, `samples`, `checkpoints` [s], `fringes` ..."""
        return self._update("outputs", keys)

    def probe(self, name: str, at: Any, **keys: Any) -> Scene:
        """A point at which velocity [m/s] and stress [Pa] are recorded: `at` (D,) [m], `body`, `fixed_in`.

        With `to` (D,) [m] and `count` there is a line of them.
        """
        return self._measure("probes", {"name": name, "at": at, **keys})

    def section(self, name: str, point: Any, normal: Any, **keys: Any) -> Scene:
        """A plane through which force [N] and moment [N m] are recorded: a `point` (D,) [m], and the `normal` (D,).

        `within` is a box and `bodies` are names to which it is confined.
        """
        return self._measure("sections", {"name": name, "point": point, "normal": normal, **keys})

    def group(self, name: str, bodies: Any, **keys: Any) -> Scene:
        """Bodies, by names or patterns, whose sums and the forces between them and other groups are recorded."""
        return self._measure("groups", {"name": name, "bodies": bodies, **keys})

    def arrival(self, quantity: str, threshold: Any, **keys: Any) -> Scene:
        """A threshold, in the unit of `quantity`, whose first passing is recorded: `probes`, `bodies`, `reading`."""
        return self._measure("arrivals", {"quantity": quantity, "threshold": threshold, **keys})

    def front(self, name: str, **keys: Any) -> Scene:
        """A front whose way is recorded: `quantity`, `threshold`, `from_` (D,) [m], `direction` (D,) ..."""
        return self._measure("fronts", {"name": name, **keys})

    def reference(self, body: str, quantity: str, value: Any, label: str) -> Scene:
        """A known answer for a column of bodies.csv, in its unit, as a formula of `t` [s]; charts compare with it."""
        entry = {"body": body, "quantity": quantity, "value": value, "label": label}
        return self._append("references", entry)

    def text(self) -> str:
        """The scene as the text of a scene file: the file's own, comments and all, if nothing was changed."""
        if self._file is not None and not self._set and self._is_loaded():
            return self._file[1]
        return written(self.document)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a scene file, from which `Scene.load` and `stickslip run` read the same scene.

        Paths of meshes and tables are written so that they lead from there to where they led.
        """
        path = Path(path)
        self._read()
        moved = _moved(self.document, self._folder(), path.absolute().parent)
        path.write_text(self.text() if moved == self.document else written(moved), encoding="utf-8")

    def check(self) -> Report:
        """What is wrong or doubtful, and what the run will be, as `stickslip check` says.

        Raises `SceneError` if there can be no run.
        """
        return _report(self._read())

    def simulation(self, threads: int | None = None) -> Simulation:
        """The simulation of this scene at time 0, by so many threads, None for all processors; the bits are the same.

        Where bodies have no friction because no rule says how much, it warns of them (`StickslipWarning`).
        """
        return self._simulation(self._read(), threads)

    def run(
        self,
        out: str | os.PathLike[str] | None = None,
        *,
        threads: int | None = None,
        progress: bool = False,
        checkpoint_every: float | None = 600.0,
        max_time: float | None = None,
        max_memory: float | None = None,
        overwrite: bool = False,
    ) -> Summary:
        """Runs the scene to its end as `stickslip run` does, in the same bits, and leaves results in a folder.

        Without `out` the folder is NAME.results here, NAME being that of the file, or `scene`. A finished run that is
        there is replaced; where one did not finish that could go on, `overwrite` begins anew. `threads` are as many as
        are to step it, None for all processors. `checkpoint_every` is the wall time between checkpoints [s], None for
        none at all; `max_time` ends the run with one after so much wall time [s]; `max_memory` is what it may take
        [bytes], without it what is free.

        What is doubtful before the run is warned of (`StickslipWarning`), and bodies that have no friction because no
        rule says how much; and at its end what makes the results doubtful, which `Summary.warnings` has, too.
        """
        name = "scene" if self._file is None else self._file[0].stem
        read = self._read()
        report = _report(read)
        limit = _core.free_memory() if max_memory is None else max_memory
        if report.memory > limit:
            needs = f"the run needs about {report.memory:.2g} bytes, and may take {limit:.2g}"
            advice = "take larger cells, fewer particles, or a larger machine; max_memory allows more or less"
            raise RunError(f"{needs}; {advice}", help=advice)
        for warning in report.warnings:
            about = ": ".join(part for part in (warning.place, warning.key, warning.text) if part)
            warnings.warn(about, StickslipWarning, stacklevel=2)
        return carry_out(
            self._simulation(read, threads),
            f"{name}.results" if out is None else out,
            progress=progress,
            checkpoint_every=checkpoint_every,
            max_time=max_time,
            overwrite=overwrite,
        )

    def _simulation(self, read: _core.ReadScene, threads: int | None) -> Simulation:
        simulation = Simulation(read.simulation(threads_of(threads)), copy.deepcopy(self))
        warn_of_missing_friction(read, stacklevel=4)
        return simulation

    def _source(self, out: Path) -> tuple[tuple[Path, list[tuple[str, str]]], tuple[str, bool]]:
        """Where a run in the folder `out` comes from: file and what was set, the text, and whether there is no file."""
        if self._file is not None and self._is_loaded():
            return (self._file[0], list(self._set)), (self._file[1], False)
        moved = _moved(self.document, self._folder(), out.absolute())
        return (out.absolute() / "scene.toml", []), (written(moved), True)

    def _read(self, *further: tuple[str, str]) -> _core.ReadScene:
        """The scene as the one reader of scenes has it, with what is set besides."""
        if self._file is not None and self._is_loaded():
            given = (_shown(self._file[0]), self._file[1])
            return _core.ReadScene(given, [*self._set, *further], self.functions)
        name = IN_PYTHON
        if self._file is not None:
            # Lines are those of the text in Python.
            name = _shown(self._file[0].with_name(f"<{self._file[0].name} in Python>"))
        try:
            return _core.ReadScene((name, written(self.document)), list(further), self.functions)
        except SceneError as error:
            call = CALLS.get((error.key or "").partition(".")[0])
            if call is None or error.found not in MISSING:
                raise
            raise error.at(error.key or "", name, call) from None

    def _seconds(self, name: str, time: float | str) -> float:
        """The time that is given as `name` [s]; text may have a unit or be a formula, as `time.end` of a file."""
        if not isinstance(time, str):
            return float(time)
        try:
            return self._read(("time.end", written_value(time))).end
        except SceneError as error:
            if error.key != "time.end":
                raise
            raise error.at(name) from None

    def _is_loaded(self) -> bool:
        """Whether it is what its file and `set` say."""
        return self._loaded is not None and self._loaded == self.document

    def _folder(self) -> Path:
        """Where relative paths start."""
        return Path.cwd() if self._file is None else self._file[0].parent

    def _update(self, table: str, keys: Mapping[str, Any]) -> Scene:
        keys = plain(named(_keys(keys), table, self.functions), table)
        before = {} if table == "materials" else self.document.get(table, {})
        self._refuse_unknown({table: {**before, **keys}})
        self.document.setdefault(table, {}).update(keys)
        return self

    def _append(self, table: str, keys: Mapping[str, Any]) -> Scene:
        entries = self.document.get(table, [])
        entry = plain(named(_keys(keys), table, self.functions), f"{table}[{len(entries)}]")
        self._refuse_unknown({table: [entry]}, f"{table}[{len(entries)}]")
        self.document.setdefault(table, []).append(entry)
        return self

    def _measure(self, table: str, keys: Mapping[str, Any]) -> Scene:
        entries = self.document.get("outputs", {}).get(table, [])
        entry = plain(_keys(keys), f"outputs.{table}[{len(entries)}]")
        self._refuse_unknown({"outputs": {table: [entry]}}, f"outputs.{table}[{len(entries)}]")
        self.document.setdefault("outputs", {}).setdefault(table, []).append(entry)
        return self

    def _refuse_unknown(self, tables: dict[str, Any], place: str | None = None) -> None:
        """Refuses keys that the scene file does not have, as the one reader of scenes finds them, once they are given.

        `tables` are those that are new; of a list with one entry, `place` is what stands for that in messages.
        """
        dimension = self.document["space"].get("dimension")
        # A time without an end is where the reader stops once it has seen all keys, before it fills any shape.
        rest: dict[str, Any] = {"space": {"dimension": dimension, "cell": 1}, "time": {"end": "1 kg"}}
        rest |= {"materials": {"any_material": {}}}
        if "materials" in tables:
            rest["time"] = {"end": 1}
        try:
            _core.ReadScene((IN_PYTHON, written({**rest, **tables})), [], {})
        except SceneError as error:
            if not (error.found or "").startswith("unknown key"):
                return
            key = error.key or ""
            key = key if place is None else place + key[key.index("]") + 1 :]
            raise error.at(key, IN_PYTHON) from None

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and plain(self.document) == plain(other.document)

    __hash__ = None  # type: ignore[assignment]

    def __str__(self) -> str:
        return self.text()

    def __repr__(self) -> str:
        space, bodies = self.document.get("space", {}), self.document.get("bodies", [])
        title = self.document.get("title") or (self._file[0].stem if self._file else "scene")
        return f"<Scene {title!r}: {len(bodies)} bodies, {space.get('dimension')}, cells of {space.get('cell')}>"

    def _repr_html_(self) -> str:
        return f"{self._shown()}<pre>{escape(self.text())}</pre>"

    def _shown(self) -> str:
        """A picture of the scene as it begins; none of one that is not complete or has too many particles."""
        scene = copy.deepcopy(self)
        scene.document.pop("outputs", None)
        try:
            read = scene._read()
            if _report(read).particles > MOST_DRAWN:
                return ""
            with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
                warnings.simplefilter("ignore", StickslipWarning)
                start = Path(folder) / "start"
                # That is no time for a step.
                Simulation(read.simulation(None), scene).run(out=start, max_time=1e-9, checkpoint_every=None)
                return Results(start)._shown()
        except StickslipError:
            return ""


def _report(read: _core.ReadScene) -> Report:
    said, values = read.check()
    return Report(said, Record.from_json(values))


def _keys(keys: Mapping[str, Any]) -> dict[str, Any]:
    """`from_` is `from`: a word of Python has an underscore behind it."""

    def word(name: str) -> str:
        return name[:-1] if name.endswith("_") and keyword.iskeyword(name[:-1]) else name

    return {word(name): value for name, value in keys.items()}


def _shown(path: Path) -> str:
    """A path as a user would write it from here."""
    return str(path.relative_to(Path.cwd())) if path.is_relative_to(Path.cwd()) else str(path)


def _of_loading(error: SceneError, path: Path) -> SceneError:
    """What is wrong with a file that was to be loaded, in words of Python."""
    place, name = error.file or "", (error.file or "").removeprefix("--set ")
    if name != place:
        is_parameter = (error.found or "").startswith("no parameter") and not (error.help or "").startswith("did you")
        document = _core.document(path.read_text(encoding="utf-8")) if is_parameter else {}
        return error.at(name, help=_by_path(document, name) if is_parameter else None)
    try:
        with open(path, "rb") as file:
            is_checkpoint = file.read(len(CHECKPOINT)) == CHECKPOINT
    except OSError:
        return error
    if not is_checkpoint:
        return error
    advice = f"scene.simulation().restore({str(path)!r}) goes on from it, for the scene that it is of"
    return SceneError(f"{path} is a checkpoint, as Simulation.save writes them, and no scene; {advice}", help=advice)


def _by_path(document: Mapping[str, Any], name: str) -> str:
    """How to set keys that are no parameters: those of this name, if there are any."""
    found = [*_places(document, name)][:3] or ["time.end"]
    return "other keys are set by their path: " + ", ".join(f'**{{"{path}": ...}}' for path in found)


def _places(value: Any, name: str, path: str = "") -> Iterator[str]:
    """Paths of all keys that are called so."""
    if isinstance(value, Mapping):
        for key, entry in value.items():
            inner = f"{path}.{key}".lstrip(".")
            if key == name:
                yield inner
            yield from _places(entry, name, inner)
    elif isinstance(value, list):
        for number, entry in enumerate(value):
            yield from _places(entry, name, f"{path}[{number}]")


def _put(document: dict[str, Any], path: str, value: Any) -> None:
    """Puts a value at a path: `time.end`, `bodies[0].velocity`."""
    place: Any = document
    steps: list[Any] = []
    for word in path.split("."):
        name, *numbers = word.split("[")
        steps += [name, *(int(number.rstrip("]")) for number in numbers)]
    try:
        for step in steps[:-1]:
            place = place.setdefault(step, {}) if isinstance(place, dict) else place[step]
        place[steps[-1]] = value
    except (IndexError, TypeError, AttributeError) as error:
        raise SceneError(
            f"found the key `{path}`, which the scene has no place for; allowed: names in tables, numbers "
            "from 0 in lists",
            key=path,
        ) from error


FILES = {"file", "csv", "from"}
"""Keys whose text is a path that starts at the folder of the scene file."""


def _moved(value: Any, old: Path, new: Path, name: str = "") -> Any:
    """A document whose relative paths lead from another folder to where they led."""
    if isinstance(value, dict):
        return {name: _moved(entry, old, new, name) for name, entry in value.items()}
    if isinstance(value, list):
        return [_moved(entry, old, new) for entry in value]
    if name in FILES and isinstance(value, str) and not Path(value).is_absolute() and old.resolve() != new.resolve():
        return os.path.relpath(old / value, new)
    return value
