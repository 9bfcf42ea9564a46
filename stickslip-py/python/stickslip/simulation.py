"""Simulations: stepping, and looking at bodies, contacts and energies between steps."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

import numpy as np

from . import _core
from .functions import refuse_asking
from .progress import shown
from .records import Record, Table, matches
from .running import Summary, carry_out, way_to

if TYPE_CHECKING:
    from .scene import Scene

NUMBER = "number"
"""The column that names a body's particles."""
WRITABLE = ("velocity", "spin", "mass")
"""Columns that may be set between steps."""
DERIVED = {
    "pressure": "minus the mean of xx, yy and zz of `stress`",
    "von_mises": "the equivalent stress of `stress`",
}
"""What snapshots have beside the columns of bodies, and what it comes from."""


class Column(NamedTuple):
    """What a column of particles holds."""

    name: str
    """One word, as files call it."""
    unit: str
    """SI unit; empty for a number without one. In the plane masses [kg] and volumes [m^3] are per metre of depth."""
    components: tuple[str, ...]
    """Components that a row of the array has: those that the plane leaves free; none of a number."""


class Body:
    """A body of a simulation: its particles by columns.

    `body.position` and all other columns are arrays over the engine's own memory, to be read only: nothing is copied,
    and they show the present state, step after step. What they hold is changed by `set`: `body.set("velocity",
    body.velocity + (0, 1))`. In the plane masses and volumes are per metre of depth. Vectors are (n, D), `stress` and
    other symmetric tensors (n, xx yy zz xy yz xz), in the plane (n, xx yy zz xy); `deformation` is (n, 9) row by row,
    in the plane (n, xx xy yx yy zz); numbers are (n,). `columns` says which, with units. Rows are in the order of
    memory, the same in all columns at a time, which changes where a step sorts particles: `body.number` has the
    particle's number for each row. Use `by_number` for a copy in an order that stays. While a step is taken, another
    thread that reads may see numbers of two moments.
    """

    _own: _core.Engine
    index: int
    """Place of the body in the scene, from 0."""
    name: str
    """Name of the body."""

    def __init__(self, engine: _core.Engine, index: int, name: str) -> None:
        self.__dict__.update(_own=engine, index=index, name=name)

    @property
    def _engine(self) -> _core.Engine:
        refuse_asking()
        return self._own

    @property
    def columns(self) -> list[Column]:
        """The columns that its particles have."""
        found = [Column(name, unit, tuple(here)) for name, unit, _, here in self._engine.columns(self.index)]
        return [*found, Column(NUMBER, "", ())]

    @property
    def state(self) -> Record:
        """The body as a whole: mass [kg], position of its centre of mass [m], velocity [m/s], spin [rad/s],

        angular_momentum about the origin [kg m^2/s], kinetic and strain energy [J]; vectors have three components. In
        the plane masses, momenta and energies are per metre of depth. It is a copy; `set` changes the body.
        """
        return Record(json.loads(self._engine.states())[self.index])

    def column(self, name: str) -> np.ndarray:
        """The column of this name as an array over the engine's memory, see `Body`."""
        array = self._engine.array(self.index, name)
        if array is not None:
            return array
        known = [column.name for column in self.columns]
        if name in known:
            raise ValueError(
                f"the particles of `{self.name}`, which is rigid and without bounds, come and go with the bodies near "
                f"it; allowed: by_number({name!r}), a copy"
            )
        advice = f"; `{name}` is in snapshots, see Results.frame, and is {DERIVED[name]}" if name in DERIVED else ""
        raise AttributeError(
            f"found a column `{name}`, which body `{self.name}` does not have; allowed: {', '.join(known)}{advice}"
        )

    def by_number(self, name: str) -> np.ndarray:
        """A copy in the order of the particles' numbers, which never changes, with all components in space.

        Numbers are (n,), vectors (n, 3), symmetric tensors (n, 6) as xx yy zz xy yz xz, and tensors (n, 3, 3).
        """
        if name == NUMBER:
            return np.arange(len(self), dtype=np.uint32)
        values = self._engine.by_number(self.index, name)
        components = next(whole for column, _, whole, _ in self._engine.columns(self.index) if column == name)
        shape = {0: (-1,), 9: (-1, 3, 3)}.get(len(components), (-1, len(components)))
        return values.reshape(shape)

    def set(self, name: str, values: Any) -> None:
        """Gives all particles other values in a column: "velocity" [m/s], "spin" [rad/s] or "mass" [kg].

        `values` have the shape and the order of the column, or are broadcast to it: `ball.set("velocity", (0, 1))` is
        for all particles, and a single number is for all components, too: `ball.set("velocity", 1)` is (1, 1). They are
        numbers, not text; they must be finite, and masses above zero; the next step is as long as is stable with the
        new velocities. It follows from the density of the material: for particles far lighter than that, lower
        `time.courant`. The energy that comes in is external work of the ledger, whose total stays.

        A free rigid body (`rigid=dict(free={})`) takes one value for the whole, the "velocity" of its centre of mass
        (D,) or its "spin" (3,), in the plane a number: `wheel.set("spin", 20)`. What joints do not allow of it, the
        next step takes away. A prescribed one takes none.
        """
        known = next((column for column in self.columns if column.name == name), None)
        if known is None:
            problem = f"found a column `{name}`, which body `{self.name}` does not have"
            raise ValueError(f"{problem}; allowed: {', '.join(WRITABLE)}")
        if np.asarray(values).dtype.kind not in "biuf":
            unit = f" [{known.unit}]" if known.unit else ""
            raise ValueError(f"found {values!r} for `{name}`; allowed: numbers{unit}, without text or units")
        values = np.asarray(values, dtype=float)
        if name != NUMBER:
            each = (len(known.components),) if known.components else ()
            wanted = each if self._engine.is_rigid(self.index) else (len(self), *each)
            try:
                values = np.broadcast_to(values, wanted)
            except ValueError as error:
                raise ValueError(f"found values of shape {values.shape} for `{name}`; allowed: {wanted}") from error
        self._engine.write(self.index, name, values.ravel())

    def __len__(self) -> int:
        return self._engine.count(self.index)

    def __getitem__(self, name: str) -> np.ndarray:
        return self.column(name)

    def __getattr__(self, name: str) -> np.ndarray:
        if name.startswith("_"):
            raise AttributeError(name)
        return self.column(name)

    def __setattr__(self, name: str, value: NoReturn) -> NoReturn:
        raise AttributeError(f"found values for `{name}`; {_how_to_set(name)}")

    def __setitem__(self, name: str, values: NoReturn) -> NoReturn:
        raise TypeError(f"found values for `{name}`; {_how_to_set(name)}")

    def __dir__(self) -> Iterable[str]:
        return [*super().__dir__(), *(column.name for column in self.columns)]

    def __repr__(self) -> str:
        return f"<Body {self.name!r}: {len(self)} particles>"


def _how_to_set(name: str) -> str:
    """What to do instead of an assignment."""
    others = "" if name in WRITABLE else f"; allowed: {', '.join(WRITABLE)}"
    return f'columns are read only; use body.set("{name if name in WRITABLE else WRITABLE[0]}", values){others}'


class Bodies(Mapping[str, Body]):
    """The bodies of a simulation by their names, in the order of the scene: `bodies["ball"]`."""

    def __init__(self, engine: _core.Engine) -> None:
        self._bodies = {name: Body(engine, index, name) for index, name in enumerate(engine.names)}

    def matching(self, pattern: str) -> list[Body]:
        """The bodies whose names match, in the order of the scene: `matching("grain *")`; `*` is any letters."""
        return [body for name, body in self._bodies.items() if matches(pattern, name)]

    def __getitem__(self, name: str) -> Body:
        if name not in self._bodies:
            known = ", ".join(self._bodies)
            advice = "; bodies are by name; list(bodies.values()) is by number" if isinstance(name, int) else ""
            raise KeyError(f"found a body `{name}`, which the scene does not have; allowed: {known}{advice}")
        return self._bodies[name]

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> NoReturn:
            if name in self.__dict__.get("_bodies", {}):
                raise AttributeError(f'found `.{name}`; bodies are in brackets: bodies["{name}"]')
            raise AttributeError(f"found no `{name}`; bodies are in brackets, by their names")

    def __iter__(self) -> Iterator[str]:
        return iter(self._bodies)

    def __len__(self) -> int:
        return len(self._bodies)

    def __repr__(self) -> str:
        return f"<Bodies {', '.join(self._bodies)}>"


class Simulation:
    """A scene under way, from `Scene.simulation`. Everything is in SI units.

    Steps let other threads of Python work meanwhile, and Ctrl-C stops between two of them.
    """

    def __init__(self, engine: _core.Engine, scene: Scene) -> None:
        self._own = engine
        self.scene = scene
        """The scene that it is of."""
        self.bodies = Bodies(engine)
        """The bodies by their names."""

    @property
    def engine(self) -> _core.Engine:
        """The compiled half."""
        refuse_asking()
        return self._own

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.engine.time

    @property
    def end(self) -> float:
        """Simulated time at which the scene ends [s]."""
        return self.engine.end

    @property
    def steps(self) -> int:
        """Steps taken."""
        return self.engine.steps

    @property
    def particles(self) -> int:
        """Particles in all bodies."""
        return self.engine.particles

    @property
    def threads(self) -> int:
        """Threads that step it."""
        return self.engine.threads

    @property
    def stable_step(self) -> float:
        """Length of the step that `step` would take now [s]."""
        return self.engine.stable_step

    def step(self, longest: float | str = inf) -> float:
        """Takes one step, at most so long [s], and returns its length [s]. Raises `StepError`.

        Text may have a unit, which takes longer to read than a number: `sim.step("1 us")`.
        """
        seconds = self.scene._seconds("longest", longest)
        if not seconds > 0.0:
            raise ValueError(f"found a step of at most {longest} s; allowed: a time above zero [s]")
        return self.engine.step(seconds)

    def run(
        self,
        until: float | str | None = None,
        *,
        every: float | str | None = None,
        callback: Callable[[Simulation], Any] | None = None,
        progress: bool = False,
        out: str | os.PathLike[str] | None = None,
        checkpoint_every: float | None = 600.0,
        max_time: float | None = None,
        overwrite: bool = False,
    ) -> Summary | None:
        """Steps to a simulated time [s], without `until` to the end of the scene, where the last step ends exactly.

        It is the time of the simulation, not how long to go on: for that, `until=sim.time + 1e-3`. One that has passed
        raises `ValueError`. Times may be text with a unit: `sim.run(until="5 ms", every="1 ms", callback=look)`.

        `callback` is called with the simulation at the start, after the first step that reaches each multiple of
        `every` [s], and at the end; without `every` after each step. It may look at all there is, and change it; an
        exception ends the run. With `out` the run leaves results in that folder, as `Scene.run` does with the same
        `checkpoint_every`, `max_time` and `overwrite`, warns of what makes them doubtful, and returns a summary.
        Without `out` nothing is looked for.
        """
        call = None if callback is None else lambda: callback(self)
        until = None if until is None else self.scene._seconds("until", until)
        every = None if every is None else self.scene._seconds("every", every)
        self._refuse_passed(until)
        if out is not None:
            return carry_out(
                self,
                out,
                until=until,
                every=every,
                callback=call,
                progress=progress,
                checkpoint_every=checkpoint_every,
                max_time=max_time,
                overwrite=overwrite,
            )
        if max_time is not None:
            raise ValueError("found max_time without out; allowed: max_time for runs that leave results")
        with shown(progress) as show:
            _core.walk(self.engine, way_to(self.end if until is None else until, every, call, show))
        return None

    def _refuse_passed(self, until: float | None) -> None:
        """Refuses a time that has passed, but for round-off."""
        given, now = self.end if until is None else until, self.time
        if not given >= now - 1e-12 * abs(now):
            found = f"the end of the scene at {given:g} s" if until is None else f"until = {given:g} s"
            advice = "give `until`" if until is None else "until=sim.time + 1e-3 goes on for a millisecond"
            raise ValueError(f"found {found}, and the simulation is at {now:g} s; allowed: from there on; {advice}")

    def ledger(self) -> Record:
        """Energies [J] and momenta of all bodies that deform.

        kinetic, strain, potential, external_work, friction, adhesion, plastic, damping, and total, which stays in an
        exact solution; momentum [kg m/s] and angular_momentum about the origin [kg m^2/s], of three components. In the
        plane all are per metre of depth.
        """
        return Record.from_json(self.engine.ledger())

    def contacts(self) -> Table:
        """Contacts since this was asked for last, or since the start: means over that time, a row a pair of bodies.

        Columns are those of contacts.csv: body_a, body_b, force of the first on the second fx fy fz [N], normal: force
        that pushes them apart [N], tangential [N], nodes, centre x y z [m], area [m^2], gap between the surfaces [m],
        slip [m] and work of friction [J] in that time; and nx ny nz, the unit normal from the first body to the second,
        the direction in which the first pushes: the mean over nodes and time, each with its force along its normal. It
        is NaN where these forces cancel, as around a pin that is pressed from all sides. `contacts.rows("fx", "fy",
        "fz")` is (n, 3).
        """
        names = list(self.bodies)
        text = f"U{max(map(len, names), default=1)}"
        numbers = "fx fy fz normal tangential nodes x y z area gap slip friction nx ny nz".split()
        fields: list[tuple[str, Any]] = [("body_a", text), ("body_b", text)]
        fields += [(name, int if name == "nodes" else float) for name in numbers]
        rows = []
        for (a, b), vectors, normal, tangential, *rest, nodes in json.loads(self.engine.contacts()):
            force, direction, place = vectors
            found = [*force, normal, tangential, nodes, *place, *rest, *direction]
            rows.append((names[a], names[b], *(np.nan if x is None else x for x in found)))
        return Table.of(np.array(rows, np.dtype(fields)), names)

    def loads(self) -> dict[str, Record]:
        """What supports and loads did since the start, by their names.

        impulse on the body [N s], work on it [J], displacement of the part [m]; vectors have three components.
        """
        return {name: Record(state) for name, state in json.loads(self.engine.loads())}

    def joints(self) -> dict[str, Record]:
        """What joints did since the start on the bodies that they hold, and springs on that of `from`, by their names.

        impulse [N s], moment: its sum over time [N m s], way: angle [rad] or length [m], speed: its rate, work [J].
        """
        return {name: Record(state) for name, state in json.loads(self.engine.joints())}

    @property
    def relaxation(self) -> Record | None:
        """How far dynamic relaxation is: residual, peaks, at_rest; None where the scene asks for none."""
        state = json.loads(self.engine.relaxation())
        return None if state is None else Record(state)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a checkpoint of the present state, from which `restore` goes on, and scenes may `start`.

        That is no scene file; `sim.scene.save(path)` writes one.
        """
        if Path(path).suffix == ".toml":
            advice = "sim.scene.save(path) writes a scene file"
            raise ValueError(f"found {str(path)!r}; allowed: a name for a checkpoint, as 'here.checkpoint'; {advice}")
        self.engine.save(Path(path).absolute())

    def restore(self, path: str | os.PathLike[str]) -> None:
        """Takes up the state in a checkpoint, of `save` or of a run.

        The scene must be the same but for outputs and end. Steps from there are those that would have followed, bit
        for bit. Contacts count from there.
        """
        self.engine.restore(path)

    def __repr__(self) -> str:
        return f"<Simulation {self.engine.title!r}: t = {self.time:g} s, step {self.steps}, {self.particles} particles>"
