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
    that was reached [s], steps and wall times. `folder` is where the results are.
    """

    folder: Path
    """Where the results are."""
    text: str
    """What the command prints."""

    def __init__(self, folder: Path, said: str, values: Mapping[str, Any]) -> None:
        super().__init__(values)
        self.folder, self.text = folder, said

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
        said, values = _core.run(simulation.engine, way, request)
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
    `Scene.functions` has them. `checkpoint_every` and `max_time` are wall times [s], as of `Scene.run`. Bodies that
    have no friction because no rule says how much are warned of (`StickslipWarning`).
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
        said, values = _core.run(read.simulation(threads), way_to(read.end, None, None, show), request)
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
