"""Runs that leave results, as those of the command."""

from __future__ import annotations

import json
import os
import signal
import threading
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core
from .errors import ResultsError, RunError, StickslipWarning
from .progress import Progress, shown
from .records import Record

if TYPE_CHECKING:
    from .simulation import Simulation


class Summary(Record):
    """What a run came to: `print(summary)`, or its values.

    `status` is "finished", "interrupted" or "out_of_time"; `warnings` lists what makes the results doubtful, `start`
    and `end` are ledgers, `energy_drift` is in J, `references` compares with known answers, `performance` has the time
    that was reached [s], steps and wall times. `folder` is where the results are; the summary stands for it wherever a
    folder is asked for: `ss.Results(summary)`, `ss.render(summary)`.
    """

    folder: Path
    """Where the results are."""
    text: str
    """What the command prints."""

    def __init__(self, folder: Path, said: str, values: Mapping[str, Any]) -> None:
        super().__init__(values, folder=folder, text=said)

    def __fspath__(self) -> str:
        return str(self.folder)

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return f"<pre>{escape(self.text)}</pre>"


def way_to(until: float, every: float | None, callback: Callable[[], Any] | None, show: Progress | None) -> _core.Way:
    """Steps to a time [s], with a function that is called after each step or every so often [s]."""
    every = 0.0 if every is None else float(every)
    if not every >= 0.0:
        raise ValueError(f"found every={every}; allowed: a time from 0 [s], or None for every step")
    return {"until": float(until), "every": every, "callback": callback, "show": show}


def warn_of_missing_friction(read: _core.ReadScene, stacklevel: int) -> None:
    """Warns where bodies have no friction because no rule says how much; from where, as of `warnings.warn`."""
    pairs = read.pairs_without_friction()
    if pairs is not None:
        warnings.warn(pairs, StickslipWarning, stacklevel=stacklevel)


def warn_of_doubts(lines: list[str], stacklevel: int) -> None:
    """Warns of what makes the results of a run doubtful, as the command says it; from where, as of `warnings.warn`."""
    for line in lines:
        warnings.warn(line, StickslipWarning, stacklevel=stacklevel)


def threads_of(threads: int | None) -> int | None:
    """So many threads, or all processors."""
    if threads is not None and not threads >= 1:
        raise ValueError(f"found threads={threads}; allowed: a whole number from 1, or None for all processors")
    return threads


def carry_out(
    simulation: Simulation,
    out: str | os.PathLike[str],
    *,
    until: float | None = None,
    every: float | None = None,
    callback: Callable[[], Any] | None = None,
    progress: bool = False,
    checkpoint_every: float | None = 600.0,
    max_time: float | None = None,
    overwrite: bool = False,
) -> Summary:
    """A run of a simulation from where it is, with results in the folder `out`."""
    folder = Path(out)
    if not overwrite:
        _refuse_unfinished(simulation, folder)
    (path, given), (text, is_new) = simulation.scene._source(folder)
    request: _core.RunRequest = {
        "out": folder,
        "resumed": False,
        "source": (path, given, None if until is None else repr(float(until))),
        "text": text,
        "is_new": is_new,
        "checkpoint_every": checkpoint_every,
        "max_time": max_time,
    }
    with _records_first(), shown(progress) as show:
        way = way_to(simulation.end if until is None else until, every, callback, show)
        said, doubts, values = _core.run(simulation.engine, way, request)
    warn_of_doubts(doubts, stacklevel=4)
    return Summary(folder, said, Record.from_json(values))


def resume(
    folder: str | os.PathLike[str],
    until: float | str | None = None,
    *,
    scene: str | os.PathLike[str] | None = None,
    functions: Mapping[str, Any] | None = None,
    threads: int | None = None,
    progress: bool = False,
    checkpoint_every: float | None = 600.0,
    max_time: float | None = None,
) -> Summary:
    """Goes on with the run in a folder from its newest checkpoint, as `stickslip resume` does.

    It goes on to `until` [s], else to what was named last, else to the end of the scene. The scene is read again from
    where it was, as it was run if it is not there any more, or from the file `scene`. A run that was stopped ends in
    the same bits as one that was not. `functions` are the laws, loads and motions of your own that it names, as
    `Scene.functions` has them. `threads` are as many as are to step it, None for all processors. `checkpoint_every` and
    `max_time` are wall times [s], as of `Scene.run`. Bodies that have no friction because no rule says how much are
    warned of, and what makes the results doubtful (`StickslipWarning`).
    """
    folder = Path(folder)
    before = _record(folder)
    source = before.get("source") or {}
    if scene is None and not source:
        raise RunError(f"{folder} does not say which scene file it came from; name it with scene", help="name the file")
    path = Path(source["path"] if scene is None else scene).absolute()
    given = [(name, value) for name, value in source.get("set", [])]
    named = (source.get("until") if scene is None else None) if until is None else until
    named = named if named is None or isinstance(named, str) else repr(float(named))
    recorded = source.get("text") if scene is None else None
    if recorded is None and not path.exists():
        raise RunError(f"the scene file {path} is not there; name it with scene", help="name it with scene")
    read = _core.ReadScene.again((path, recorded), given, named, dict(functions or {}))
    warn_of_missing_friction(read, stacklevel=3)
    request: _core.RunRequest = {
        "out": folder,
        "resumed": True,
        "source": (path, given, named),
        "text": read.text,
        "is_new": False,
        "checkpoint_every": checkpoint_every,
        "max_time": max_time,
    }
    with _records_first(), shown(progress) as show:
        engine = read.simulation(threads_of(threads))
        said, doubts, values = _core.run(engine, way_to(read.end, None, None, show), request)
    warn_of_doubts(doubts, stacklevel=3)
    return Summary(folder, said, Record.from_json(values))


class _Ended(BaseException):
    """A signal came that ends the process."""


@contextmanager
def _records_first() -> Iterator[None]:
    """Lets SIGTERM and SIGHUP end a run as Ctrl-C does, and then the process.

    Those that the process ignores, or has functions of its own for, do what they did. As with Ctrl-C, only runs of the
    main thread see any.
    """

    def end(number: int, _: Any) -> None:
        raise _Ended(number)

    seen = threading.current_thread() is threading.main_thread()
    signals = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if seen and hasattr(signal, name)]
    deadly = [number for number in signals if signal.getsignal(number) is signal.SIG_DFL]
    for number in deadly:
        signal.signal(number, end)
    came = None
    try:
        yield
    except _Ended as ended:
        came = ended.args[0]
        if came not in deadly:
            # Of a run in whose callback this one is.
            raise
    finally:
        for number in deadly:
            signal.signal(number, signal.SIG_DFL)
    if came is not None:
        signal.raise_signal(came)


def _record(folder: Path) -> dict[str, Any]:
    """`run.json` of a folder."""
    try:
        return dict(json.loads((folder / "run.json").read_text(encoding="utf-8")))
    except (OSError, ValueError) as error:
        advice = "give the folder of a run, complete and unchanged"
        raise ResultsError(f"cannot read {folder / 'run.json'}: {error}; {advice}", help=advice) from error


def _refuse_unfinished(simulation: Simulation, folder: Path) -> None:
    """Refuses a folder with a run that did not finish and can go on."""
    newest = _core.unfinished(simulation.engine, folder)
    if newest is not None:
        advice = f"stickslip.resume({str(folder)!r}) goes on with it; overwrite=True begins anew"
        raise RunError(f"{folder} holds a run that did not finish, with a checkpoint: {newest}; {advice}", help=advice)
