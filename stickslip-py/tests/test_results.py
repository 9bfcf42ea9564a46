"""Runs from Python are those of the command, and what they leave is read back."""

from __future__ import annotations

import base64
import contextlib
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import types
import warnings

import numpy as np
import pytest
import stickslip as ss
from conftest import REPOSITORY, flying, rings, settling
from stickslip import commands
from stickslip.progress import Progress


@pytest.fixture(scope="module")
def results(tmp_path_factory) -> ss.Results:
    """Of the rings, with their end as a callback saw it."""
    folder = tmp_path_factory.mktemp("rings")
    scene = rings().outputs(tables="1 ms", particles="2 ms", snapshots=dict(precision="double"))
    sim = scene.reference("left", "vx", "2 m/s", "before they meet").simulation()
    times = []
    summary = sim.run(out=folder / "results", every=1e-3, callback=lambda sim: times.append(sim.time))
    found = ss.Results(folder / "results")
    found.__dict__.update(sim=sim, summary=summary, seen=times)
    return found


def test_a_run_leaves_its_tables(results):
    assert results.status == "finished" and repr(results).startswith("<Results 'rings': finished at t = 0.01 s")
    assert {"bodies", "energy", "contacts"} <= set(results.tables)
    bodies = results.bodies
    assert bodies.dtype["time"] == float and bodies.dtype["body"].kind == "U"
    left = bodies.where(body="left")
    assert left["time"].tolist() == results.seen == results.energy["time"].tolist()
    assert left["vx"][-1] == results.sim.bodies["left"].state.velocity[0]
    assert results.energy["total"][-1] == results.sim.ledger().total
    assert set(results.contacts["body_a"]) == {"left"}
    with pytest.raises(AttributeError, match="found no table `bodeis` in .*; allowed: bodies, contacts, energy"):
        results.bodeis
    assert "bodies" in dir(results)


def test_a_row_that_is_cut_short_is_left_out(results, tmp_path):
    for name in ("run.json", "bodies.csv"):
        (tmp_path / name).write_bytes((results.folder / name).read_bytes())
    whole = ss.Results(tmp_path).bodies
    with open(tmp_path / "bodies.csv", "a") as file:
        file.write("0.5,lef")
    assert np.array_equal(ss.Results(tmp_path).bodies, whole)
    (tmp_path / "bodies.csv").write_text("time,body,x\n")
    assert len(ss.Results(tmp_path).bodies["x"]) == 0


def test_snapshots_with_some_columns_of_some_bodies_are_read(tmp_path):
    scene = rings().outputs(snapshots=dict(columns=["velocity", "pressure"], bodies=["r*"], every=2))
    sim = scene.simulation()
    sim.run(until="1 ms", out=tmp_path / "results")
    frame = ss.Results(tmp_path / "results").frame(-1)
    assert set(frame) == {"position", "velocity", "pressure", "body", "number"} and set(frame["body"]) == {1}
    right = sim.bodies["right"]
    assert np.array_equal(frame["number"], np.arange(0, len(right), 2)) and frame.units["pressure"] == "Pa"
    assert np.array_equal(frame["velocity"], right.by_number("velocity")[::2].astype(np.float32))


def test_snapshots_are_the_particles(results):
    assert len(results.times) == 6 and results.times[-1] == 0.01
    frame = results.frame(-1)
    assert np.array_equal(results.frame(5)["stress"], frame["stress"])
    for name in ("left", "right"):
        part, body = frame.body(name), results.sim.bodies[name]
        for column in ("position", "velocity", "stress", "deformation", "mass", "volume", "number"):
            assert np.array_equal(part[column], body.by_number(column)), column
    assert frame["pressure"] == pytest.approx(-frame["stress"][:, :3].sum(axis=1) / 3, rel=1e-12)
    assert frame.units["pressure"] == "Pa" and frame.time == 0.01 and len(frame) == len(list(frame))
    with pytest.raises(KeyError, match="found a column `presure`.*allowed: body, number, position"):
        frame["presure"]
    with pytest.raises(KeyError, match="found a body `ring`"):
        frame.body("ring")
    with pytest.raises(IndexError, match="found snapshot 6; allowed: 0 to 5"):
        results.frame(6)


def test_the_summary_is_that_of_the_command(results):
    summary = results.summary
    assert summary.status == "finished" and summary.performance.time == 0.01
    assert summary.energy_drift == pytest.approx(summary.end.total - summary.start.total)
    assert str(summary).startswith("finished at t = 0.010000 s after ") and "  energy " in str(summary)
    (reference,) = summary.references
    assert reference.exact == 2.0 and reference.value == results.bodies.where(body="left")["vx"][-1]
    assert summary.folder == results.folder and "<pre>" in summary._repr_html_()


def test_frames_of_pandas_and_polars_have_all_columns(results, monkeypatch):
    made = []
    fake = types.SimpleNamespace(DataFrame=made.append)
    contacts = results.sim.contacts()
    for name in ("pandas", "polars"):
        monkeypatch.setitem(sys.modules, name, None)
        with pytest.raises(ImportError, match=f"pip install {name}"):
            getattr(results.energy, f"to_{name}")()
        monkeypatch.setitem(sys.modules, name, fake)
        getattr(results.energy, f"to_{name}")()
        getattr(contacts, f"to_{name}")()
    assert list(made[0]) == list(results.energy.dtype.names) and np.array_equal(made[0]["px"], results.energy["px"])
    assert {"body_a", "body_b", "fx", "fy", "fz", "normal"} <= set(made[1])


def test_contacts_of_simulations_have_the_columns_of_tables_and_the_normal(results):
    live, table = results.sim.contacts(), results.contacts
    recorded = [name for name in table.dtype.names if name != "time"]
    assert list(live.dtype.names) == [*recorded, "nx", "ny", "nz"]
    assert table.rows("fx", "fy", "fz").shape == (len(table), 3)


def test_a_table_over_time_and_bodies_is_a_dataset(results, monkeypatch):
    fake = types.SimpleNamespace(Dataset=lambda data, coords=None, attrs=None: (data, coords, attrs))
    monkeypatch.setitem(sys.modules, "xarray", fake)
    data, axes, _ = results.bodies.to_xarray()
    assert list(axes) == ["time", "body"] and list(axes["body"]) == ["left", "right"]
    names, speed = data["vx"]
    assert names == ("time", "body") and np.array_equal(speed[:, 1], results.bodies.where(body="right")["vx"])
    data, _, attributes = results.frame(-1).to_xarray()
    names, stress, about = data["stress"]
    assert names == ("particle", "component_6") and about == {"unit": "Pa"} and attributes == {"time": 0.01}
    assert data["deformation"][1].shape == (len(stress), 9) and "position" not in data


def test_pictures_and_charts_are_those_of_the_command(results, tmp_path):
    picture = ss.render(results, color="velocity", frame=(0, 1), out=tmp_path / "two.png")
    assert picture._repr_png_()[:4] == b"\x89PNG" and picture._repr_svg_() is None
    chart = ss.plot(results.folder, table="energy", out=tmp_path / "energy.svg")
    assert "total, their sum" in chart._repr_svg_() and chart._repr_png_() is None
    again = ss.plot(results, results.folder, body="left", quantity="x", out=tmp_path / "both.svg")
    assert again._repr_svg_().count(": left x") == 2
    look = dict(background="transparent", window=(0, 0, "1 m", 1), hide=("title", "time"))
    clear = ss.render(results, out=tmp_path / "clear.png", **look)
    assert clear._repr_png_()[25] == 6, "colour with opacity"
    with pytest.raises(ss.ResultsError, match="^color: found `nonsense`"):
        ss.render(results, color="nonsense", out=tmp_path / "none.png")


def test_a_sweep_has_a_row_and_results_for_each_run(tmp_path):
    scene = flying().parameter(speed=2)
    scene.document["bodies"][0]["velocity"] = ["speed", 0]
    runs = ss.sweep(scene, tmp_path / "sweep", speed=(1, 3))
    assert list(runs.table["speed"]) == [1, 3] and set(runs.table["status"]) == {"finished"} and len(runs) == 2
    assert [round(float(run.bodies["vx"][-1]), 6) for run in runs] == [1, 3]
    assert "<table>" in runs._repr_html_()
    with pytest.raises(ss.SceneError, match="found functions of Python"):
        ss.sweep(flying().load("ball", force=lambda t, x, x0: (0, 1)), tmp_path / "none", speed=(1, 3))

    # As if the second had been killed before it began, and the folder moved.
    moved = (tmp_path / "sweep").rename(tmp_path / "moved")
    (moved / "rows/speed=3.csv").unlink()
    shutil.rmtree(moved / "speed=3")
    assert "2 of 2 runs finished" in commands.command("sweep", moved)
    assert (moved / "speed=3/run.json").exists() and (moved / "scene.toml").read_text() == scene.text()


def test_a_sweep_that_is_refused_leaves_no_trace(tmp_path):
    scene = flying().parameter(speed=2)
    with pytest.raises(ss.RunError, match="sped"):
        ss.sweep(scene, tmp_path / "new", sped=(1, 3))
    assert not (tmp_path / "new").exists()
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "thesis.txt").write_text("years of work")
    with pytest.raises(ss.RunError, match="thesis.txt"):
        ss.sweep(scene, mine, speed=(1, 3))
    (mine / "scene.toml").write_text("mine")
    with pytest.raises(ss.RunError, match="would be replaced"):
        ss.sweep(scene, mine, speed=(1, 3))
    assert sorted(path.name for path in mine.iterdir()) == ["scene.toml", "thesis.txt"]
    assert (mine / "scene.toml").read_text() == "mine"


def test_the_script_of_a_sweep_calls_the_command_as_it_was_called(tmp_path):
    scene = flying().parameter(speed=2)
    scene.document["bodies"][0]["velocity"] = ["speed", 0]
    scene.save(tmp_path / "scene.toml")
    folder = tmp_path / "it's array"
    commands.command("sweep", tmp_path / "scene.toml", set="speed=1,3", script=True, out=folder)
    job = subprocess.run(["sh", folder / "array.sh"], env={**os.environ, "SLURM_ARRAY_TASK_ID": "1"}, check=False)
    assert job.returncode == 0 and (folder / "rows/speed=3.csv").exists()


def test_frames_go_to_other_packages_with_all_columns(results, tmp_path):
    meshio = pytest.importorskip("meshio")
    frame = results.frame(-1)
    frame.to_meshio().write(tmp_path / "frame.vtu")
    mesh = meshio.read(tmp_path / "frame.vtu")
    assert np.array_equal(mesh.points, frame["position"])
    assert np.array_equal(mesh.point_data["stress"], frame["stress"])
    assert set(mesh.point_data) == set(frame) - {"position"}


def test_a_chart_has_the_run_and_its_known_answer(results, monkeypatch):
    drawn, said = [], []
    axes = types.SimpleNamespace(
        plot=lambda x, y, *style, label: drawn.append((np.asarray(x), np.asarray(y), label)),
        set_xlabel=said.append,
        set_ylabel=said.append,
        set_title=said.append,
        legend=lambda: None,
    )
    assert results.plot("left", "vx", ax=axes) is axes
    (times, speeds, label), (_, known, answer) = drawn
    assert np.array_equal(speeds, results.bodies.where(body="left")["vx"]) and label == "left vx"
    assert set(known) == {2.0} and answer == "before they meet"
    assert said == ["time [s]", "vx [m/s]", "rings"]
    with pytest.raises(ValueError, match="found a column `vxx`; allowed: mass, x, y"):
        results.plot("left", "vxx", ax=axes)
    with pytest.raises(ValueError, match="found a body `ring`; allowed: left, right"):
        results.plot("ring", "vx", ax=axes)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(ImportError, match="needs matplotlib, which is not installed"):
        results.plot("left", "vx")


def test_notebooks_show_tables_and_results(results, tmp_path, monkeypatch):
    shown = results.bodies._repr_html_()
    assert shown.startswith("<table><tr><th>time</th><th>body</th>") and "2 more rows" in shown
    assert results.bodies["x"]._repr_html_() is None
    shown = results._repr_html_()
    assert "finished at t = 0.01 s" in shown and picture_in(shown)[1] > 400
    assert not (results.folder / "picture.png").exists(), "looking at results writes nothing to them"
    drawn = ss.render(results, out=tmp_path / "picture.png")
    assert base64.b64encode(drawn._repr_png_()).decode() in shown
    monkeypatch.setattr("stickslip.commands.subprocess.run", None)
    assert results._repr_html_() == shown, "drawn once"


def test_notebooks_show_results_without_a_picture_and_say_why(tmp_path):
    scene = rings().time(end="1 ms").outputs(particles="1 ms", snapshots=dict(columns=["mass"]))
    scene.run(tmp_path / "results")
    assert "no picture: " in ss.Results(tmp_path / "results")._repr_html_()


def picture_in(html: str) -> tuple[int, int]:
    """Width and height of the PNG that a piece of HTML has in itself."""
    (encoded,) = re.findall(r'<img src="data:image/png;base64,([^"]+)">', html)
    png = base64.b64decode(encoded)
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", png[16:24])


def test_a_resumed_run_warns_of_friction_that_nobody_gave(tmp_path):
    scene = settling()
    del scene.document["contact"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ss.StickslipWarning)
        scene.run(tmp_path / "results")
    with pytest.warns(ss.StickslipWarning, match="disk.*floor|floor.*disk") as warned:
        ss.resume(tmp_path / "results", until=0.03)
    assert warned[0].filename == __file__, "it names the line that resumes"


def test_notebooks_show_scenes_as_they_begin(monkeypatch):
    shown = rings()._repr_html_()
    assert picture_in(shown)[0] > 400 and "<pre>" in shown and "neo_hookean" in shown
    incomplete = ss.Scene("3d", 1)
    assert incomplete._repr_html_() == f"<pre>{incomplete.text()}</pre>".replace('"', "&quot;")
    monkeypatch.setattr("stickslip.scene.MOST_DRAWN", 10)
    assert "<img" not in rings()._repr_html_()


def test_the_bits_are_those_of_the_command(command, tmp_path, monkeypatch):
    """By state_sum, a SHA-256 of all particles: a file with another parameter, and a scene that has no file."""
    monkeypatch.chdir(tmp_path)
    path = REPOSITORY / "scenes/paper/backspin.toml"
    given = {"cells_per_radius": 2, "time.end": "20 ms"}
    scene = ss.Scene.load(path, **given)
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        scene.run(out="python.results")
    assert any("backspin.toml:56:1: bodies[1].shape: thinner than" in str(warning.message) for warning in warned)
    own = rings()
    own.save("rings.toml")
    own.run(out="rings.python", threads=1)
    sets = [word for name, value in given.items() for word in ("--set", f"{name}={value}")]
    for arguments in ([path, "--out", "command.results", *sets], ["rings.toml", "--out", "rings.command"]):
        subprocess.run([command, "run", *arguments], check=True, capture_output=True)
    sums = {}
    for name in ("python.results", "command.results", "rings.python", "rings.command"):
        record = json.loads((tmp_path / name / "run.json").read_text())
        sums[name] = record["state_sum"]
        if name.startswith(("python", "command")):
            assert record["source"]["path"] == str(path) and dict(record["source"]["set"])["cells_per_radius"] == "2"
    assert sums["python.results"] == sums["command.results"] and sums["rings.python"] == sums["rings.command"]
    tables = [(tmp_path / name / "bodies.csv").read_bytes() for name in ("rings.python", "rings.command")]
    assert tables[0] == tables[1]
    # The command goes on with what Python began, and Python with what the command did; where the scene has gone, by its
    # recorded text.
    subprocess.run([command, "resume", "rings.python", "--until", "12 ms"], check=True, capture_output=True)
    ss.resume("rings.command", until=0.012, threads=1)
    for scene in ("rings.toml", "rings.python/scene.toml"):
        (tmp_path / scene).unlink()
    subprocess.run([command, "resume", "rings.python", "--until", "13 ms"], check=True, capture_output=True)
    ss.resume("rings.command", until=0.013, threads=1)
    sums = [
        json.loads((tmp_path / name / "run.json").read_text())["state_sum"]
        for name in ("rings.python", "rings.command")
    ]
    assert sums[0] == sums[1]


def test_a_simulation_that_is_stepped_by_hand_has_the_bits_of_a_run(tmp_path):
    run, walked = rings().simulation(), rings().simulation()
    position = walked.bodies["left"].position
    run.run(out=tmp_path / "results", checkpoint_every=None)
    walked.run()
    assert np.array_equal(run.bodies["left"].by_number("position"), walked.bodies["left"].by_number("position"))
    assert np.array_equal(position, run.bodies["left"].position)
    assert not list((tmp_path / "results").glob("checkpoints/*"))


def test_a_run_begins_from_another(tmp_path):
    with pytest.warns(ss.StickslipWarning):
        settling().outputs(snapshots=dict(precision="double")).run(out=tmp_path / "packing")
    scene = settling().start(tmp_path / "packing", velocities="zero")
    assert "2 of 2 bodies begin as they were at t = 0.02 s" in str(scene.check())
    sim = scene.simulation()
    last = ss.Results(tmp_path / "packing").frame(-1).body("disk")
    assert sim.time == 0.0 and np.array_equal(sim.bodies["disk"].by_number("position"), last["position"])
    assert not sim.bodies["disk"].velocity.any()
    # What is changed before the first step stays, though a run begins.
    sim.bodies["disk"].set("velocity", (0.0, 1.0))
    sim.run(until=1e-4, out=tmp_path / "on")
    assert ss.Results(tmp_path / "on").bodies.where(body="disk")["vy"][0] == pytest.approx(1.0)


def test_runs_refuse_what_the_command_refuses(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scene = flying()
    with pytest.raises(ss.RunError, match="the run needs about .* bytes, and may take 1e.03; take larger cells"):
        scene.run(max_memory=1e3)
    (tmp_path / "notes").mkdir()
    (tmp_path / "notes" / "diary.txt").write_text("mine")
    with pytest.raises(ss.RunError, match="holds files that are not the results of a run, such as `diary.txt`"):
        scene.run(out="notes")
    with pytest.raises(ss.ResultsError, match="cannot read .*run.json"):
        ss.Results("notes")
    with pytest.raises(ss.ResultsError, match="cannot read .*run.json"):
        ss.resume("notes")
    with pytest.raises(ValueError, match="found 0 s of wall time"):
        scene.run(max_time=0)
    long = flying().time(end=1e4)
    assert long.run(max_time=0.3).status == "out_of_time", "in scene.results"
    with pytest.raises(ss.RunError, match=r"did not finish, with a checkpoint: .*overwrite=True begins anew"):
        scene.run()
    assert scene.run(overwrite=True).status == "finished"
    with pytest.raises(ss.StepError, match="left the domain") as caught:
        flying().domain((-1, -1), (0.5, 1)).time(end=1).run(out="failed")
    assert caught.value.body == "ball" and ss.Results("failed").status == "failed"
    with pytest.raises(ValueError, match="max_time without out"):
        scene.simulation().run(max_time=1.0)


def test_an_exception_in_a_callback_ends_a_run_with_results_that_can_be_read(tmp_path):
    def stop(sim):
        if sim.time > 0.1:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        flying().simulation().run(out=tmp_path / "results", callback=stop)
    assert ss.Results(tmp_path / "results").status == "interrupted"
    assert ss.resume(tmp_path / "results").status == "finished", "and goes on from scene.toml beside it"


def test_progress_is_shown_when_asked_for(tmp_path, capfd, monkeypatch):
    monkeypatch.setattr("stickslip.progress.BETWEEN_LINES", 0.0)
    flying("3d").run(out=tmp_path / "shown", progress=True)
    shown = capfd.readouterr().err
    assert "0 s left, t = 0.2000 of 0.2 s, step " in shown and "particle-steps/s" in shown
    flying().run(out=tmp_path / "quiet")
    assert capfd.readouterr().err == ""


def on_a_terminal(columns: int, monkeypatch) -> str:
    """What progress writes to a terminal of so many columns: at the start, and after 50 s of wall time."""
    walls = iter([0.0, 0.0, 50.0])
    monkeypatch.setattr("stickslip.progress.clock", types.SimpleNamespace(monotonic=lambda: next(walls)))
    pty, termios, fcntl = (pytest.importorskip(name) for name in ("pty", "termios", "fcntl"))
    other, end = pty.openpty()
    fcntl.ioctl(end, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    with os.fdopen(end, "w") as terminal, contextlib.redirect_stderr(terminal):
        show = Progress()
        show(0.0, 1e-4, 0, 60_000, [])
        show(1.25e-5, 1e-4, 123_456, 60_000, ["a note"])
        show.close()
    written = b""
    # What has no writer any more has an end, which Linux tells as an error.
    with contextlib.suppress(OSError):
        while part := os.read(other, 4096):
            written += part
    os.close(other)
    return written.decode()


def test_progress_on_a_terminal_fits_and_a_dumb_one_gets_whole_lines(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    for columns in (40, 80, 120):
        written = on_a_terminal(columns, monkeypatch)
        lines = [line for line in re.split(r"[\r\n]+", written.replace("\x1b[K", "")) if line]
        assert lines[0].startswith("unknown time left") and lines[1] == "t = 1.2500e-05 s: warning: a note"
        assert max(map(len, lines)) < columns, lines
        parts = ["5 min 50 s left", "t = 1.250e-05 of 1.000e-04 s", "step 123456", "148.1 M particle-steps/s"]
        assert lines[2] == ", ".join(parts[: {40: 1, 80: 3, 120: 4}[columns]])
    monkeypatch.setenv("TERM", "dumb")
    monkeypatch.setattr("stickslip.progress.BETWEEN_LINES", 0.0)
    written = on_a_terminal(80, monkeypatch)
    assert "\x1b" not in written and written.count("\n") == 3 and "particle-steps/s" in written
