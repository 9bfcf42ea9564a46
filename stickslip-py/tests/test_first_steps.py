"""Whoever knows the package from its documentation alone is told what went wrong and what to write instead."""

from __future__ import annotations

import re

import numpy as np
import pytest
import stickslip as ss
from conftest import flying, rings
from stickslip.simulation import DERIVED, WRITABLE


def test_a_column_that_is_assigned_is_refused_and_stays():
    sim = flying().simulation()
    ball = sim.bodies["ball"]
    with pytest.raises(AttributeError, match=r'columns are read only; use body.set\("velocity", values\)$'):
        ball.velocity = (0, 1)
    with pytest.raises(TypeError, match=r'columns are read only; use body.set\("velocity", values\)$'):
        ball["velocity"] = (0, 1)
    with pytest.raises(AttributeError, match="found values for `foo`; .*allowed: velocity, spin, mass"):
        ball.foo = 3
    ball.set("velocity", ball.velocity + (0, 1))
    assert ball.velocity.shape == (len(ball), 2) and ball.state.velocity[:2] == pytest.approx((3, 2))
    assert "body.set" in ss.Body.__doc__ and "set" in ss.Body.state.__doc__


def test_records_are_read_only():
    sim = flying().simulation()
    state = sim.bodies["ball"].state
    for record in (state, sim.ledger()):
        with pytest.raises(AttributeError, match="found a value for `velocity`; records are read only"):
            record.velocity = (0, 1)
    with pytest.raises(TypeError):
        state["velocity"] = (0, 1)
    with pytest.raises(ValueError, match="read-only"):
        state.velocity[1] = 1.0
    with pytest.raises(AttributeError, match="read only"):
        flying().check().text = ""


@pytest.mark.parametrize("longest", [-1, -1e-3, 0, float("nan")])
def test_steps_that_do_not_go_forward_are_refused(longest):
    sim = flying().simulation()
    with pytest.raises(ValueError, match="found a step of at most .* s; allowed: a time above zero"):
        sim.step(longest)
    assert sim.time == 0.0 and sim.steps == 0


def test_a_step_takes_text_as_a_run_does():
    sim = flying().simulation()
    assert sim.step("1 us") == 1e-6
    for wrong in ("1 m", "-1 us"):
        with pytest.raises(ss.SceneError, match="^longest: found .*allowed: a time"):
            sim.step(wrong)


def doubtful() -> ss.Scene:
    """A ball whose every step is short beside what is asked for."""
    return flying().health(small_step=dict(bound=1e9, then="warn"))


def test_doubts_found_during_a_run_are_warned_of_where_it_was_asked_for(tmp_path):
    def told(begin):
        with pytest.warns(ss.StickslipWarning) as warned:
            summary = begin()
        said = [str(warning.message) for warning in warned]
        printed = re.findall(r"^  warning +(.*)$", str(summary), re.MULTILINE)
        assert said == printed and len(said) == len(summary.warnings) == 1, said
        assert warned[0].filename == __file__
        return said[0]

    said = told(lambda: doubtful().run(tmp_path / "results"))
    assert said.startswith("from t = ") and "step" in said
    told(lambda: doubtful().simulation().run(out=tmp_path / "walked"))
    told(lambda: ss.resume(tmp_path / "results", until=0.21))
    for then in ("record", "ignore"):
        summary = doubtful().health(small_step=then).run(tmp_path / "quiet")
        assert summary.warnings == []


def test_it_is_said_that_a_finished_run_is_replaced(tmp_path):
    flying().run(tmp_path / "results")
    assert flying().time(end=0.1).run(tmp_path / "results").performance.time == 0.1
    assert "finished run" in ss.Scene.run.__doc__ and "replaced" in ss.Scene.run.__doc__


def test_a_time_that_has_passed_is_refused(tmp_path):
    sim = flying().simulation()
    sim.run(until="3.5 ms")
    for given in ("0.1 ms", -1.0, float("nan")):
        for out in (None, tmp_path / "results"):
            with pytest.raises(ValueError, match=r"found until = .* s, and the simulation is at 0.0035 s; allowed"):
                sim.run(until=given, out=out)
    steps = sim.steps
    sim.run(until=0.0035)
    assert sim.steps == steps and not (tmp_path / "results").exists()
    sim.run()
    sim.step(1e-5)
    with pytest.raises(ValueError, match=r"found the end of the scene at 0.2 s.*give `until`"):
        sim.run()


def test_rows_of_bodies_that_there_are_none_of_are_refused(tmp_path):
    sim = rings().simulation()
    sim.run(out=tmp_path / "results", until="6 ms")
    results = ss.Results(tmp_path / "results")
    for table, column in [(results.bodies, "body"), (results.contacts, "body_a"), (sim.contacts(), "body_b")]:
        for name in ("lfet", "grain *"):
            with pytest.raises(ValueError, match=re.escape(f"found {column}={name!r}; allowed: left, right")):
                table.where(**{column: name})
        with pytest.raises(ValueError, match="found a column `name`, which the table does not have; allowed: "):
            table.where(name="left")
    assert len(results.contacts.where(body_a="right")) == 0, "such a pair has no row, but the body is there"
    assert len(results.bodies.where(body="l*")) == len(results.bodies.where(body="left")) > 0
    assert len(results.bodies[:0].where(body="left")) == 0


def test_a_single_number_is_for_all_components_as_is_said():
    ball = flying().simulation().bodies["ball"]
    ball.set("velocity", 1.0)
    assert np.array_equal(ball.velocity, np.ones((len(ball), 2)))
    assert "a single number is for all components" in " ".join(ss.Body.set.__doc__.split())


@pytest.mark.parametrize("threads", [0, -1])
def test_threads_are_at_least_one(threads, tmp_path):
    scene = flying()
    scene.run(tmp_path / "results")
    begins = [scene.simulation, lambda threads: scene.run(tmp_path / "none", threads=threads)]
    for begin in [*begins, lambda threads: ss.resume(tmp_path / "results", until=0.3, threads=threads)]:
        with pytest.raises(ValueError, match=f"found threads={threads}; allowed: a whole number from 1, or None"):
            begin(threads=threads)
    assert not (tmp_path / "none").exists() and scene.simulation(threads=None).threads >= 1


def test_a_summary_stands_for_its_folder(tmp_path):
    summary = flying().run(tmp_path / "results")
    assert ss.Results(summary).status == "finished"
    assert ss.resume(summary, until=0.21).status == "finished"
    assert flying().start(summary).document["start"]["from"] == str(summary.folder)
    with pytest.raises(AttributeError, match="found no `results`; allowed: status, .*folder"):
        summary.results


def test_names_and_columns_in_the_wrong_brackets_are_told(tmp_path):
    sim = rings().simulation()
    with pytest.raises(AttributeError, match=r'bodies\["left"\]'):
        sim.bodies.left
    with pytest.raises(KeyError, match="bodies are by name"):
        sim.bodies[0]
    sim.run(until="6 ms")
    with pytest.raises(AttributeError, match=r'columns of tables are in brackets: table\["fx"\]'):
        sim.contacts().fx
    with pytest.raises(AttributeError, match="found no `speed`; columns of tables are in brackets: body_a, body_b"):
        sim.contacts().speed


def test_what_only_snapshots_have_is_told_so(tmp_path):
    scene = flying()
    ball = scene.simulation().bodies["ball"]
    scene.run(tmp_path / "results")
    columns = {column.name for column in ball.columns}
    frame = set(ss.Results(tmp_path / "results").frame(-1))
    assert frame - columns - {"body"} == set(DERIVED)
    for name in DERIVED:
        with pytest.raises(AttributeError, match=f"found a column `{name}`.*Results.frame, and is .*stress"):
            getattr(ball, name)


def test_what_may_be_set_is_said_alike_every_time():
    ball = flying().simulation().bodies["ball"]
    for name in ("speed", "position"):
        with pytest.raises(ValueError, match=f"found .*`{name}`.*; allowed: {', '.join(WRITABLE)}$"):
            ball.set(name, 1.0)
    for values in (("1 m/s", 0), "fast", None):
        with pytest.raises(ValueError, match=r"for `velocity`; allowed: numbers \[m/s\], without text or units"):
            ball.set("velocity", values)


def test_long_tables_are_shown_in_short(tmp_path):
    flying().run(tmp_path / "results")
    bodies = ss.Results(tmp_path / "results").bodies
    shown = repr(bodies)
    assert len(bodies) > 100 and len(shown.splitlines()) < 15 and shown.endswith(f"\n# {len(bodies)} rows")
    assert repr(bodies[:3]).count("ball") == 3 and "rows" not in repr(bodies["x"])


def test_results_are_those_of_a_folder_and_snapshots_have_numbers(tmp_path):
    flying().run(tmp_path / "results")
    with pytest.raises(ss.ResultsError, match=r"bodies.csv is a file; give the folder that the run left: ss.Results\("):
        ss.Results(tmp_path / "results/bodies.csv")
    with pytest.raises(TypeError, match=r"found snapshot 0.01; allowed: a number from 0 to 20.*`times`"):
        ss.Results(tmp_path / "results").frame(0.01)
