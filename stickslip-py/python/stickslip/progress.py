"""How far a run is, on standard error: one line that is written over on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import sys
import time as clock
from collections.abc import Iterator
from contextlib import contextmanager

BETWEEN_LINES = 10.0
"""Wall time between two lines where nothing can be written over [s]."""


class Progress:
    """Shows a run under way."""

    def __init__(self) -> None:
        self._over = sys.stderr.isatty()
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
            print(f"\r\x1b[K{self._line(now, time, end, steps, particles)}", end="", file=sys.stderr, flush=True)
            self._open = True
        elif now >= self._written + BETWEEN_LINES:
            print(self._line(now, time, end, steps, particles), file=sys.stderr, flush=True)
            self._written = now

    def _line(self, now: float, time: float, end: float, steps: int, particles: int) -> str:
        began, first_time, first_step = self._began or (now, time, steps)
        wall = max(now - began, 1e-9)
        rest = f"{wall * (end - time) / (time - first_time):.0f} s" if time > first_time else "unknown time"
        rate = (steps - first_step) * particles / wall
        return f"t = {time:.4e} of {end:.4e} s, step {steps}, {rate:.2e} particle-steps/s, {rest} left"

    def close(self) -> None:
        """Ends the line that is written over."""
        if self._open:
            print(file=sys.stderr)
            self._open = False


@contextmanager
def shown(progress: bool) -> Iterator[Progress | None]:
    """What shows a run, if it is to be shown."""
    show = Progress() if progress else None
    try:
        yield show
    finally:
        if show is not None:
            show.close()
