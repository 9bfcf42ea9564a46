"""Laws, loads and prescribed motion as functions: of Python over arrays, or compiled over one particle or point."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from os import PathLike
from typing import Any

import numpy as np

COMPONENTS = {"number": (), "vector": (3,), "symmetric": (6,), "tensor": (3, 3)}
"""Kinds of history, with the shape of a particle's."""


class _Asking(threading.local):
    """Whether this thread is in a function that a step has called, which waits for it."""

    now = False


_asking = _Asking()


@contextmanager
def asked() -> Iterator[None]:
    """While a step waits for what is done here."""
    _asking.now = True
    try:
        yield
    finally:
        _asking.now = False


def refuse_asking() -> None:
    """Refuses a function that asks a simulation: the step that called it would wait for itself."""
    if _asking.now:
        raise RuntimeError("a law, a load or a motion asks a simulation; it may use its arguments alone")


def _address(function: Any) -> int | None:
    """Where compiled code is: of numba's `cfunc`, or of a function pointer of ctypes."""
    if isinstance(function, ctypes._CFuncPtr):  # type: ignore[attr-defined]
        return ctypes.cast(function, ctypes.c_void_p).value
    address = getattr(function, "address", None)
    return address if isinstance(address, int) else None


class _Given:
    """A function under a name, which is not copied with its scene."""

    def __init__(self, function: Any) -> None:
        """`function` is one of Python, a `cfunc` of numba, or a pointer of ctypes."""
        if not callable(function) and _address(function) is None:
            raise TypeError(f"found a {type(function).__name__}; allowed: a function, a cfunc of numba or of ctypes")
        self.function = function

    @property
    def address(self) -> int | None:
        """Where its code is if it is compiled, else None."""
        return _address(self.function)

    @property
    def name(self) -> str:
        """What messages and scene files call it."""
        return getattr(self.function, "__name__", type(self).__name__.lower()).strip("<>")

    def __deepcopy__(self, _: Any) -> _Given:
        return self

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name!r}>"


class Step:
    """What a law over arrays is asked: all particles of a body in a step, a row each, by their numbers.

    `deformation`: F at the end of the step (n, 3, 3). `stress`: Cauchy stress at its start (n, 6) as xx yy zz xy yz xz
    [Pa]. `time` at its end and its length `dt` [s]. `history`: what the law declares, by name; change these arrays in
    place. `increment`: I + L dt (n, 3, 3), of laws with `increment=True`.

    To be written as far as the law has them: `energy` and `dissipation` per undeformed volume [J/m^3], and
    `wave_modulus`, the stiffness against a longitudinal wave [Pa], on which the length of the next steps rests; it
    begins as K + 4G/3.
    """

    def __init__(self, law: Law, times: tuple[float, float], arrays: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
        self.time, self.dt = times
        deformation, stress, rows = arrays
        self.deformation = deformation.reshape(-1, 3, 3)
        self.stress = stress.copy()
        self.history: dict[str, np.ndarray] = {}
        first = 0
        for name, kind, _, _ in law.columns:
            shape = COMPONENTS[kind]
            width = int(np.prod(shape, dtype=int))
            self.history[name] = rows[:, first : first + width].reshape(len(rows), *shape)
            first += width
        self.energy, self.dissipation, self.wave_modulus = rows[:, first : first + 3].T
        self._increment = rows[:, first + 3 :].reshape(-1, 3, 3) if law.increment else None

    @property
    def increment(self) -> np.ndarray:
        """I + L dt (n, 3, 3)."""
        if self._increment is None:
            raise AttributeError("a law that looks at the increment is ss.Law(function, increment=True)")
        return self._increment

    def __len__(self) -> int:
        return len(self.stress)


class Law(_Given):
    """A law of your own, for `scene.material(name, density=..., outside=dict(law=Law(...), bulk_modulus=...))`.

    `function(step, **constants)` takes all particles of a body (see `Step`) and returns the Cauchy stress at the end of
    the step, (n, 3, 3) or (n, 6) as xx yy zz xy yz xz, tension positive [Pa]; or that and the strain energy per
    undeformed volume, (n,) [J/m^3]. It must depend on nothing but its arguments, change only `step.history`,
    `step.energy`, `step.dissipation` and `step.wave_modulus`, and ask no simulation. It is called once a body and step.
    Plane stress is not for it.

    `history` are columns that its particles remember: a kind for each name, "number", "vector", "symmetric" or
    "tensor", or kind, unit and value before anything moves, of tensors that of the diagonal: `dict(plastic="number",
    stretch=("tensor", "", 1.0))`. `increment` keeps I + L dt for it, too.

    A compiled `function`, a `numba.cfunc` or a pointer of ctypes, takes one particle at a time, in all threads and
    without Python: `void law(const double *F, const double *increment, double dt, const double *constants, double
    *stress, double *history, double *answers)`. F and I + L dt are nine numbers row by row; `constants` in the order of
    the dictionary; `stress` is six numbers, at the start of the step, to be changed into those at its end; `history`
    likewise; `answers` are energy, dissipation and wave_modulus. `Law.signature()` is numba's word for it.
    """

    def __init__(
        self,
        function: Any,
        *,
        history: Mapping[str, str | tuple[str, str] | tuple[str, str, float]] | None = None,
        constants: Mapping[str, float] | None = None,
        increment: bool = False,
    ) -> None:
        """`constants` are the numbers, in SI units, with which `function` is called."""
        super().__init__(function)
        self.constants = {name: float(value) for name, value in (constants or {}).items()}
        """Numbers that it is called with, in SI units."""
        self.increment = increment
        """Whether it looks at the increment."""
        self.columns = [_column(name, declared) for name, declared in (history or {}).items()]
        """Name, kind, unit and start of what it remembers."""

    @staticmethod
    def signature() -> Any:
        """The signature of a compiled law, for `numba.cfunc`; needs numba."""
        import numba

        types: Any = numba.types
        numbers = types.CPointer(types.float64)
        return types.void(numbers, numbers, types.float64, numbers, numbers, numbers, numbers)

    def _respond(self, time: float, dt: float, deformation: np.ndarray, stress: np.ndarray, rows: np.ndarray) -> None:
        step = Step(self, (time, dt), (deformation, stress, rows))
        with asked():
            answer = self.function(step, **self.constants)
        found, energy = answer if isinstance(answer, tuple) else (answer, None)
        stress[:] = self._symmetric(np.asarray(found, dtype=float), len(step))
        if energy is not None:
            step.energy[:] = energy

    def _symmetric(self, stress: np.ndarray, count: int) -> np.ndarray:
        if stress.shape == (count, 3, 3):
            return stress[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
        if stress.shape == (count, 6):
            return stress
        raise ValueError(
            f"law `{self.name}` gave a stress of shape {stress.shape}; allowed: ({count}, 3, 3), or ({count}, 6) as xx "
            "yy zz xy yz xz"
        )


def _column(name: str, declared: Any) -> tuple[str, str, str, float]:
    given: list[Any] = [declared] if isinstance(declared, str) else list(declared)
    kind, unit, start = given + ["number", "", 0.0][len(given) :]
    if kind not in COMPONENTS:
        raise ValueError(f"found a history `{name}` of kind {kind!r}; allowed: {', '.join(COMPONENTS)}")
    return name, kind, unit, float(start)


class Function(_Given):
    """A load or a prescribed motion of your own.

    Of a load: `function(time, points, start)` gives the force, traction [Pa] or acceleration [m/s^2] at all points of
    the part at once, (n, D) or what is broadcast to it, of a pressure (n,) [Pa]. `points` is where they are now and
    `start` where they were at the start, (n, D) [m]. Of the velocity of a rigid body: `function(time)` gives D numbers
    [m/s], of its spin three, in the plane one [rad/s]. It must depend on nothing but its arguments, and ask no
    simulation.

    A compiled one takes one point at a time: `void function(double time, const double *point, const double *start,
    double *value)`, three numbers each; a pressure is the first of `value`, a spin in the plane the third, and a motion
    has points of zeros. `Function.signature()` is numba's word for it.
    """

    @staticmethod
    def signature() -> Any:
        """The signature of a compiled function, for `numba.cfunc`; needs numba."""
        import numba

        types: Any = numba.types
        numbers = types.CPointer(types.float64)
        return types.void(types.float64, numbers, numbers, numbers)

    def _values(self, purpose: tuple[str, int], time: float, points: np.ndarray, start: np.ndarray) -> np.ndarray:
        """The values as rows of three."""
        kind, axes = purpose
        values = np.zeros((len(points), 3))
        if kind == "vector at points":
            wanted = values[:, :axes]
        elif kind == "number at points":
            wanted = values[:, 0]
        elif kind == "spin" and axes == 2:
            wanted = values[0, 2:]
        else:
            wanted = values[0, :axes]
        at_points = kind.endswith("at points")
        with asked():
            found = self.function(time, points[:, :axes], start[:, :axes]) if at_points else self.function(time)
        try:
            wanted[:] = found
        except ValueError as error:
            shape = np.shape(found)
            raise ValueError(f"`{self.name}` gave values of shape {shape}; allowed: {wanted.shape}") from error
        return values


def made(given: Any, kind: str) -> Law | Function:
    """A function as a "law" or as a "function" of time and place."""
    wanted: type[Law] | type[Function] = Law if kind == "law" else Function
    if isinstance(given, wanted):
        return given
    if isinstance(given, _Given):
        raise TypeError(f"found {given!r} where a {kind} is wanted; allowed: ss.{wanted.__name__}(...)")
    return wanted(given)


def named(value: Any, key: str, functions: dict[str, Law | Function | Callable[..., Any]]) -> Any:
    """A value in which each function is the name under which it is kept in `functions`."""
    if isinstance(value, Mapping) and not isinstance(value, PathLike):
        return {name: named(entry, name, functions) for name, entry in value.items()}
    if not (isinstance(value, _Given) or callable(value) or _address(value) is not None):
        return value
    given = made(value, "law" if key == "law" else "function")
    name, number = given.name, 1
    while getattr(known := functions.get(name, given), "function", known) is not given.function:
        number += 1
        name = f"{given.name}_{number}"
    functions.setdefault(name, given)
    return name if key == "law" else {"outside": name}

