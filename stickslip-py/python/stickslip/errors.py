"""What can go wrong, with the message, the place and the advice that the command prints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


class StickslipError(Exception):
    """Whatever Stickslip refuses or cannot do."""

    help: str | None = None
    """What to try, or None."""

    def __init__(self, message: str, **facts: Any) -> None:
        super().__init__(message)
        self.__dict__.update(facts)

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), str(self), dict(self.__dict__))


def _again(kind: type[StickslipError], message: str, facts: dict[str, Any]) -> StickslipError:
    return kind(message, **facts)


class SceneError(StickslipError, ValueError):
    """A mistake in a scene. The message has its place, what was found, what is allowed, and the line at fault."""

    file: str | None = None
    """The file, or what stands for it: `<scene in Python>`."""
    line: int | None = None
    """Line in the file, from 1. Of a scene in Python, in the text that `Scene.text` gives."""
    column: int | None = None
    """Column in characters, from 1."""
    key: str | None = None
    """Path of the key, such as `bodies[1].shape.ball.radius`."""
    found: str | None = None
    """What was found."""
    allowed: str | None = None
    """What is allowed."""

    def at(self, key: str, file: str | None = None, help: str | None = None) -> SceneError:
        """The same mistake at another key, which stands in no line; with other advice if that is given."""
        place = key if file is None else f"{file}: {key}"
        help = help or self.help
        advice = f"; {help}" if help else ""
        facts = dict(file=file, key=key, found=self.found, allowed=self.allowed, help=help)
        return SceneError(f"{place}: found {self.found}; allowed: {self.allowed}{advice}", **facts)


class RunError(StickslipError, RuntimeError):
    """A run that could not begin, go on or write its results."""


class StepError(RunError):
    """A step that went wrong. The simulation is as it was then, and can still be looked at."""

    body: str | None = None
    """Name of the body."""
    particle: int | None = None
    """Number of the particle in its body."""
    position: Sequence[float] | None = None
    """Where it is (3,) [m]."""
    time: float | None = None
    """Simulated time [s]."""


class ResultsError(StickslipError, OSError):
    """Results that cannot be read."""


class StickslipWarning(UserWarning):
    """Something doubtful in a scene that is about to run, or in the results of one that has run."""
