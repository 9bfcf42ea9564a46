"""How far a run is, on standard error: one line that is written over on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import os
import sys
import time as clock
from collections.abc import Iterator
from contextlib import contextmanager
from math import ceil, inf

BETWEEN_LINES = 10.0
"""Wall time between two lines where nothing can be written over [s]."""
PREFIXES = (("G", 1e9), ("M", 1e6), ("k", 1e3))
"""Letters and factors of large rates."""


class Progress:
    """Shows a run under way."""

    def __init__(self) -> None:
        self._over = sys.stderr.isatty() and os.environ.get("TERM") != "dumb"
        self._began: tuple[float, float, int] | None = None
        self._written = clock.monotonic()
        self._open = False

    def __call__(self, time: float, end: float, steps: int, particles: int, notes: list[str]) -> None:
        now = clock.monotonic()
        self._began = self._began or (now, time, steps)
        for note in notes:
            self.close()
            print(f"t = {time:.4e} s: warning: {note}", file=sys.stderr)
        if self._over:
            line = self._line(now, time, end, steps, particles, _columns() - 1)
            print(f"\r\x1b[K{line}", end="", file=sys.stderr, flush=True)
            self._open = True
        elif now >= self._written + BETWEEN_LINES:
            print(self._line(now, time, end, steps, particles), file=sys.stderr, flush=True)
            self._written = now

    def _line(self, now: float, time: float, end: float, steps: int, particles: int, room: float = inf) -> str:
        """The time left, and as much of the rest as has room in so many columns."""
        began, first_time, first_step = self._began or (now, time, steps)
        wall = max(now - began, 1e-9)
        left = wall * (end - time) / (time - first_time) if time > first_time else inf
        # Of a run that ends before it is asked again, nobody knows the pace.
        line = f"{_duration(left if time < end else 0.0)} left"
        reached = f"{time:.3e} of {end:.3e}" if end < 1e-2 else f"{time:.4f} of {end:g}"
        pace = _with_prefix((steps - first_step) * particles / wall)
        for part in (f"t = {reached} s", f"step {steps}", f"{pace}particle-steps/s"):
            if len(line) + 2 + len(part) > room:
                break
            line = f"{line}, {part}"
        return line

    def close(self) -> None:
        """Ends the line that is written over."""
        if self._open:
            print(file=sys.stderr)
            self._open = False


def _columns() -> int:
    """Columns of the terminal; 80 where it does not say."""
    try:
        return os.get_terminal_size(sys.stderr.fileno()).columns or 80
    except OSError:
        return 80


def _duration(seconds: float) -> str:
    """`1 h 02 min`, `3 min 20 s`, `4 s`; unknown before there is a pace."""
    if seconds == inf:
        return "unknown time"
    whole = ceil(max(seconds, 0.0))
    hours, minutes, rest = whole // 3600, whole // 60 % 60, whole % 60
    if hours:
        return f"{hours} h {minutes:02} min"
    return f"{minutes} min {rest:02} s" if minutes else f"{rest} s"


def _with_prefix(rate: float) -> str:
    """`2.5 M `."""
    letter, factor = next(((name, size) for name, size in PREFIXES if rate >= size), ("", 1.0))
    return f"{rate / factor:.1f} {letter} ".replace("  ", " ")


@contextmanager
def shown(progress: bool) -> Iterator[Progress | None]:
    """What shows a run, if it is to be shown."""
    show = Progress() if progress else None
    try:
        yield show
    finally:
        if show is not None:
            show.close()
