"""What the command does and the library does not, from Python: pictures, sweeps, validation.

Each is the command in a process of its own. Its options are keywords: `render(folder, time=0.1, color="pressure")` is
`stickslip render folder --time 0.1 --color pressure`.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .errors import ResultsError, RunError, SceneError, StickslipError
from .results import Results, read_table

if TYPE_CHECKING:
    from .records import Table
    from .scene import Scene

Folder = str | os.PathLike[str]
"""A path."""
REFUSED = 2
"""Exit code of a command that asks for what cannot be, and did nothing."""


class Picture:
    """A picture in a file, which notebooks show: PNG, animated or not, or SVG."""

    def __init__(self, path: Path) -> None:
        self.path = path
        """The file."""

    def _repr_png_(self) -> bytes | None:
        return self.path.read_bytes() if self.path.suffix.lower() == ".png" else None

    def _repr_svg_(self) -> str | None:
        return self.path.read_text(encoding="utf-8") if self.path.suffix.lower() == ".svg" else None

    def __fspath__(self) -> str:
        return str(self.path)

    def __repr__(self) -> str:
        return f"<Picture {self.path}>"


class Sweep:
    """A family of runs: `table` has a row each, `sweep[0]` are the results of the first."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        """Where the runs are."""

    @property
    def table(self) -> Table:
        """sweep.csv: a row a run, with its parameters, how it stands and what it came to."""
        return read_table(self.folder / "sweep.csv")

    def __len__(self) -> int:
        return len(self.table)

    def __getitem__(self, number: int) -> Results:
        return Results(self.folder / str(self.table["run"][number]))

    def __iter__(self) -> Iterator[Results]:
        return (self[number] for number in range(len(self)))

    def _repr_html_(self) -> str | None:
        return self.table._repr_html_()

    def __repr__(self) -> str:
        return f"<Sweep {self.folder}: {len(self)} runs>"


def _folder(results: Results | Folder) -> Path:
    return Path(results.folder if isinstance(results, Results) else results)


def render(results: Results | Folder, *, out: Folder | None = None, **options: Any) -> Picture:
    """Draws a snapshot of a run, the last without `frame` or `time`; `stickslip render --help` lists the options.

    `color` is "body" by default, or "velocity" (the speed), "vx", "vy", "vz", "pressure", "von_mises", a component of
    stress as "xx", "density", "jacobian", or what a law remembers. By body, round bodies, rings among them, have
    quarters in two shades, so that turning shows. Further options are `range=(-1e5, 1e5)`, `view=(30, 10)`,
    `size="1200x800"`, `window=("-2 cm", 0, "2 cm", "4 cm")`, `background="transparent"`, `contours=8`,
    `vectors="velocity"`, `hide=("title", "axes")`, `animate=True`, ... Where `out` ends in .glb it is the surfaces of
    bodies in space, as a model in glTF. Without `out` it is DIR/picture.png, of an animation DIR/animation.png.
    """
    folder = _folder(results)
    name = "animation.png" if options.get("animate") else "picture.png"
    path = folder / name if out is None else Path(out)
    command("render", folder, out=path, failure=ResultsError, **options)
    return Picture(path)


def plot(
    results: Results | Folder, *others: Results | Folder, out: Folder | None = None, **options: Any
) -> Picture:
    """Draws the chart of a run, of several runs or of a sweep: `table="energy"`, `body="ball"`, `quantity="x,y"`.

    `body` is one, or many by a pattern, such as "*" for all; `quantity` takes several with commas. PNG or SVG, by
    the name of `out`; without it plot.png, in the folder of a single run. `Results.plot` draws with matplotlib instead.
    """
    folders = [_folder(each) for each in (results, *others)]
    usual = Path("plot.png") if others else folders[0] / "plot.png"
    path = usual if out is None else Path(out)
    command("plot", *folders, out=path, failure=ResultsError, **options)
    return Picture(path)


def sweep(
    scene: Scene,
    out: Folder,
    *,
    columns: dict[str, str] | None = None,
    jobs: int | None = None,
    threads: int | None = None,
    **values: Any,
) -> Sweep:
    """Runs a scene with every combination of values of its parameters: `sweep(scene, "out", friction=(0, 0.3))`.

    `columns` adds numbers of the runs' tables to the table: `columns={"peak": "largest contacts.normal of disk"}`, the
    `largest`, `smallest`, `last` or `mean` of a column.

    `out` is a new folder, or that of an earlier sweep, which is run anew; the scene is written there, as scene.toml. A
    sweep that was stopped goes on by `stickslip sweep out`. Scenes with functions of Python are not for it: run them
    one after the other.
    """
    if scene.functions:
        names = ", ".join(scene.functions)
        raise SceneError(f"found functions of Python ({names}) in a sweep; allowed: scenes of the scene file alone")
    given = []
    for name, value in values.items():
        listed = value if isinstance(value, (list, tuple)) else [value]
        given.append(f"{name}={','.join(map(str, listed))}")
    folder, file = Path(out), Path(out) / "scene.toml"
    before = file.read_bytes() if file.exists() else None
    if before is not None and not (folder / "sweep.json").exists():
        advice = "give a folder that is new or empty, or that of a sweep"
        raise RunError(f"{file} is not that of a sweep, and would be replaced; {advice}", help=advice)
    # What is wrong with the scene itself is said before anything is written.
    scene._read()
    is_new = not folder.exists()
    folder.mkdir(parents=True, exist_ok=True)
    scene.save(file)
    own = [f"{name}={what}" for name, what in (columns or {}).items()]
    done = _carried_out("sweep", file, set=given, column=own, out=out, jobs=jobs, threads=threads)
    if done.returncode == REFUSED:
        # Nothing was run: the folder is what it was.
        file.unlink() if before is None else file.write_bytes(before)
        if is_new:
            folder.rmdir()
    _said(done, RunError)
    return Sweep(folder)


def validate(*, out: Folder, **options: Any) -> str:
    """Problems with known answers by the contact laws: what `stickslip validate` prints, and its page in `out`."""
    return command("validate", out=out, failure=RunError, **options)


def command(name: str, *words: Any, failure: type[StickslipError] = RunError, **options: Any) -> str:
    """What a command prints: `command("check", "scene.toml", set=["cell=0.1"])`.

    Options are keywords with underscores for hyphens: True stands for an option without a value, False and None leave
    one out, tuples are joined by commas, and each entry of a list repeats it. Raises `failure` with what the command
    says of what is wrong.
    """
    return _said(_carried_out(name, *words, **options), failure)


def _carried_out(name: str, *words: Any, **options: Any) -> subprocess.CompletedProcess[str]:
    """A command in a process of its own."""
    line = [sys.executable, "-m", "stickslip", name, *map(os.fspath, words)]
    for option, value in options.items():
        for entry in value if isinstance(value, list) else [value]:
            if entry is None or entry is False:
                continue
            text = ",".join(map(str, entry)) if isinstance(entry, tuple) else str(entry)
            flag = f"--{option.rstrip('_').replace('_', '-')}"
            line.append(flag if entry is True else f"{flag}={text}")
    return subprocess.run(line, capture_output=True, text=True, encoding="utf-8", check=False)


def _said(done: subprocess.CompletedProcess[str], failure: type[StickslipError]) -> str:
    """What a command printed; raises `failure` with what it says of what is wrong."""
    if done.returncode not in (0, 3):
        said = _in_python(done.stderr.strip().removeprefix("error: "))
        raise failure(said or f"{' '.join(map(str, done.args[2:4]))} ended with {done.returncode}")
    return done.stdout


def _in_python(said: str) -> str:
    """What a command says of its options, of which Python has keywords."""
    said = re.split(r"\n+(?:Usage:|For more information)", said)[0]
    said = re.sub(r"\s*\n\s*tip: ", "; ", said)
    said = re.sub(r"^--set (\S+):\d+:\d+: ", r"\1: ", said)
    return re.sub(r"^--([a-z][a-z-]*)(?=:)|'--([a-z][a-z-]*)[^']*'", _keyword, said)


def _keyword(option: re.Match[str]) -> str:
    name = (option[1] or option[2]).replace("-", "_")
    return name if option[1] else f"`{name}`"
