"""Whoever knows the package from its documentation alone is told what went wrong and what to write instead."""

from __future__ import annotations

import inspect
import re
import textwrap

import numpy as np
import pytest
import stickslip as ss
from conftest import flying, rings, settling
from stickslip.scene import CHECKPOINT
from stickslip.simulation import DERIVED, WRITABLE

LAWS = (
    "neo_hookean hypoelastic hencky mooney_rivlin ogden fluid johnson_cook armstrong_frederick von_mises "
    "crushable_foam viscoelastic damage drucker_prager modified_cam_clay mohr_coulomb mu_i"
).split()


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


# What documentation says is what the reader of scenes takes.


def test_the_laws_and_constants_that_docstrings_name_are_those_that_there_are():
    known = re.findall(r"^(\w+)[^\n]*:", ss.keys("material"), re.MULTILINE)
    laws = [name for name in known if name not in ("materials", "density", "volume_change", "thermal_expansion")]
    assert laws == [*LAWS, "outside"]
    for name in LAWS:
        assert f"`{name}`" in ss.Scene.material.__doc__
    for line in ss.keys("materials.neo_hookean").splitlines()[2:]:
        assert f"`{line.partition(':')[0]}`" in ss.Scene.material.__doc__


@pytest.mark.parametrize(
    ("key", "said"), [("transfer", ss.Scene.time), ("basis", ss.Scene.__init__), ("precision", ss.Scene.__init__)]
)
def test_the_words_that_docstrings_name_are_those_that_there_are(key, said):
    words = re.findall(r'^"([\w-]+)": ', ss.keys(key), re.MULTILINE)
    assert len(words) > 1
    for word in words:
        assert f'"{word}"' in said.__doc__, word
    (default,) = re.findall(rf'^{key} = "(.*)":', ss.keys("time") + "\n" + ss.keys("space"), re.MULTILINE)
    told = said.__doc__[said.__doc__.index(f"`{key}`") :]
    assert re.search(rf'"{default}"\s+(is the default|by\s+default)|is "{default}" by default', told), told


def test_the_keys_of_every_method_are_told():
    methods = "body packing image point_cloud contact support load joint spring domain time start damping health"
    for method in f"{methods} outputs probe section group arrival front reference material shape".split():
        assert callable(getattr(ss.Scene, method)) and len(ss.keys(method).splitlines()) > 2, method
    assert "end (required): Simulated time at which the run ends [s]." in ss.keys("time")
    assert '    "rflip": ' in ss.keys("time") and repr(ss.keys("time")) == ss.keys("time")
    assert "radius (required): Radius [m]." in ss.keys("shape.ball") and "gravity: " in ss.keys()
    assert max(map(len, ss.keys("outputs").splitlines())) <= 100
    for wrong, known in [("tiem", "time, start"), ("time.ends", "end, courant"), ("time.end.more", "nothing below")]:
        with pytest.raises(ss.SceneError, match=f"found no key .*allowed: .*{known}"):
            ss.keys(wrong)


def test_the_example_of_the_package_runs_from_the_scene_to_the_picture(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (example,) = re.findall(r"::\n\n(.*?)\n\nWhere to begin", ss.__doc__, re.DOTALL)
    exec(compile(textwrap.dedent(example), "stickslip.__doc__", "exec"), {})
    assert (tmp_path / "rings.results/picture.png").exists() and "left and right" in capsys.readouterr().out
    begin = ss.__doc__[ss.__doc__.index("Where to begin") :]
    for name in ("Scene", "keys", "Results", "render", "plot", "resume", "Law", "Function", "sweep", "validate"):
        assert re.search(rf"\b{name}\b", begin) and name in ss.__all__


# Messages.


def test_contact_takes_one_pair():
    with pytest.raises(TypeError, match=r'allowed: scene.contact\(\("left", "right"\), friction=0.3\)'):
        rings().contact("left", "right", friction=0.3)
    with pytest.raises(TypeError, match=r'Scene.time: too many .*; allowed: scene.time\(end="10 ms"\)'):
        rings().time(0.04)
    with pytest.raises(TypeError, match=r"missing a required argument: 'cell'; .*ss.Scene.load\(\"scene.toml\"\)"):
        ss.Scene("rings.toml")
    assert list(inspect.signature(ss.Scene.contact).parameters) == ["self", "between", "keys"]
    assert "without it the rule is for all pairs" in ss.Scene.contact.__doc__


@pytest.mark.parametrize(
    ("give", "meant"),
    [
        (lambda scene: scene.contact(mu=0.3), "friction"),
        (lambda scene: scene.time(duration=1), "end"),
        (lambda scene: scene.outputs(every=1), "tables"),
    ],
)
def test_words_of_other_programs_lead_to_those_here(give, meant):
    with pytest.raises(ss.SceneError, match=f"did you mean `{meant}`") as caught:
        give(rings())
    assert caught.value.help == f"did you mean `{meant}`?"


def test_laws_of_other_programs_have_an_answer():
    with pytest.raises(ss.SceneError, match="here: `hypoelastic`.*`neo_hookean` for large ones"):
        rings().material("steel", density=1, elastic=dict(young_modulus=1))


def test_what_a_scene_cannot_do_without_is_asked_for_by_its_method():
    scene = ss.Scene("plane-strain", 0.1)
    with pytest.raises(ss.SceneError, match=r"time: found nothing, the key is missing; .*; call scene.time\(end=..."):
        scene.check()
    scene.time(courant=0.3)
    with pytest.raises(ss.SceneError, match=r"time.end: found nothing.*; call scene.time\(end=...\)$"):
        scene.check()
    scene.time(end=1)
    with pytest.raises(ss.SceneError, match=r"materials: found nothing.*; call scene.material\(NAME"):
        scene.check()
    scene.material("rubber", density=1000)
    with pytest.raises(ss.SceneError, match=r"materials.rubber: found no law; .*neo_hookean.*; call scene.material\("):
        scene.check()
    scene.material("rubber", density=1000, neo_hookean=dict(young_modulus=1e6, poisson_ratio=0.3))
    with pytest.raises(ss.SceneError, match=r"bodies: found no body; .*; call scene.body\("):
        scene.check()


def test_keys_of_a_file_are_set_by_their_paths_in_words_of_python(tmp_path):
    rings().save(tmp_path / "rings.toml")
    with pytest.raises(ss.SceneError) as caught:
        ss.Scene.load(tmp_path / "rings.toml", friction=0.1)
    said = str(caught.value)
    assert said.startswith("friction: found no parameter `friction`; ") and "--set" not in said
    assert said.endswith('other keys are set by their path: **{"contact[0].friction": ...}')
    with pytest.raises(ss.SceneError, match=r'\*\*{"contact\[0\].friction": ...}$'):
        rings().set(friction=0.1)
    loaded = ss.Scene.load(tmp_path / "rings.toml", **{"contact[0].friction": 0.1})
    assert loaded.document["contact"][0]["friction"] == 0.1
    with pytest.raises(ss.SceneError, match=r"^contact\[0\].friction: found "):
        ss.Scene.load(tmp_path / "rings.toml", **{"contact[0].friction": "much"})


def test_a_checkpoint_is_no_scene(tmp_path):
    sim = flying().simulation()
    with pytest.raises(ValueError, match=r"sim.scene.save\(path\) writes a scene file"):
        sim.save(tmp_path / "sim.toml")
    sim.save(tmp_path / "here.checkpoint")
    assert (tmp_path / "here.checkpoint").read_bytes().startswith(CHECKPOINT)
    with pytest.raises(ss.SceneError, match=r"is a checkpoint, as Simulation.save writes.*restore\("):
        ss.Scene.load(tmp_path / "here.checkpoint")


def test_a_summary_stands_for_its_folder(tmp_path):
    summary = flying().run(tmp_path / "results")
    assert ss.Results(summary).status == "finished"
    assert ss.resume(summary, until=0.21).status == "finished"
    assert flying().start(summary).document["start"]["from"] == str(summary.folder)
    with pytest.raises(AttributeError, match="found no `results`; allowed: status, .*folder"):
        summary.results


def test_results_are_those_of_a_folder_and_snapshots_have_numbers(tmp_path):
    flying().run(tmp_path / "results")
    with pytest.raises(ss.ResultsError, match=r"bodies.csv is a file; give the folder that the run left: ss.Results\("):
        ss.Results(tmp_path / "results/bodies.csv")
    with pytest.raises(TypeError, match=r"found snapshot 0.01; allowed: a number from 0 to 20.*`times`"):
        ss.Results(tmp_path / "results").frame(0.01)
    with pytest.raises(AttributeError, match=r"no attribute 'load'; did you mean ss.Scene.load\?"):
        ss.load
    assert not hasattr(ss, "nothing")


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


def test_messages_of_commands_speak_of_keywords(tmp_path):
    scene = flying().outputs(particles=0.1)
    summary = scene.run(tmp_path / "results")
    with pytest.raises(ss.ResultsError) as caught:
        ss.render(summary, colour="velocity")
    assert str(caught.value) == "unexpected argument `colour` found; a similar argument exists: `color`"
    with pytest.raises(ss.ResultsError, match="^color: found `nonsense`, a quantity that the results do not") as caught:
        ss.render(summary, color="nonsense")
    for word in str(caught.value).partition("allowed: ")[2].split(", "):
        assert f'"{word}"' in ss.render.__doc__ or len(word) == 2 and word[0] in "xyz", word
    with pytest.raises(ss.RunError, match=r"^sped: found no parameter `sped`; .*did you mean `speed`\?"):
        ss.sweep(scene.parameter(speed=2), tmp_path / "sweep", sped=(1, 3))
    for out, color in [("a.png", "speed"), ("b.png", "velocity")]:
        ss.render(summary, color=color, out=tmp_path / out)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes(), "the same by another name"
    assert "quarters in two shades" in " ".join(ss.render.__doc__.split())


def test_long_tables_are_shown_in_short(tmp_path):
    flying().run(tmp_path / "results")
    bodies = ss.Results(tmp_path / "results").bodies
    shown = repr(bodies)
    assert len(bodies) > 100 and len(shown.splitlines()) < 15 and shown.endswith(f"\n# {len(bodies)} rows")
    assert repr(bodies[:3]).count("ball") == 3 and "rows" not in repr(bodies["x"])


def test_contacts_that_are_not_judged_are_said_to_be_so():
    scene = rings()
    assert "resolved" in str(scene.check())
    del scene.document["contact"][0]["between"]
    assert "contact (Hertz): not judged, as no bodies within a cell of each other" in str(scene.check())
    assert "disk on floor" in str(settling().check())
