"""Simulations in Python: known answers, memory that is shared, and what may happen between two steps."""

from __future__ import annotations

import gc
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import stickslip as ss
from conftest import flying, rings, settling

GRAVITY = 9.81


@pytest.mark.parametrize("dimension", ["plane-strain", "3d"])
def test_a_ball_in_free_flight_goes_where_its_steps_take_it(dimension):
    """Steps v += g dt, x += v dt come to x = v_0 t + 1/2 g (t^2 + sum dt^2): the parabola, but for their length."""
    sim = flying(dimension).simulation(threads=2)
    start, steps = sim.bodies["ball"].state, []
    while sim.time < 0.1:
        steps.append(sim.step())
    t, squares = sim.time, sum(dt**2 for dt in steps)
    state, ledger = sim.bodies["ball"].state, sim.ledger()
    assert sim.steps == len(steps) > 20 and sim.time == pytest.approx(sum(steps), rel=1e-14)
    assert state.velocity[1] == pytest.approx(1.0 - GRAVITY * t, rel=1e-12)
    assert state.position[1] - start.position[1] == pytest.approx(t - 0.5 * GRAVITY * (t**2 + squares), rel=1e-12)
    assert squares < 0.03 * t**2
    assert state.position[0] - start.position[0] == pytest.approx(3.0 * sim.time, rel=1e-12)
    assert ledger.momentum[:2] == pytest.approx(state.mass * np.array([3.0, 1.0 - GRAVITY * sim.time]), rel=1e-12)
    assert ledger["total"] == ledger.kinetic + ledger.strain + ledger.potential + ledger.damping
    mass = sim.bodies["ball"].mass
    assert state.mass == pytest.approx(mass.sum(), rel=1e-14) and ledger.momentum.shape == (3,)


def test_a_ball_on_a_grid_of_its_own_takes_velocities_and_nothing_else():
    sim = flying(interior="auto").simulation()
    ball = sim.bodies["ball"]
    x, y = ball.position.T
    ball.set("velocity", np.stack([1 - 2 * y, 2 * x], axis=1))
    sim.step()
    # A step along tangents takes it outwards by (w dt)^2.
    assert ball.state.spin[2] == pytest.approx(2.0, rel=1e-4)
    words = 'found `mass` of body `ball`, which is on a grid of its own; allowed: velocity; or interior = "grid"'
    with pytest.raises(ValueError, match=words):
        ball.set("mass", 1.0)


def test_the_last_step_of_a_run_ends_where_it_should():
    sim, seen = flying().simulation(), []
    assert sim.run(until="50 ms", every="20 ms", callback=lambda sim: seen.append(sim.time)) is None
    assert sim.time == 0.05 and [round(time, 2) for time in seen] == [0.0, 0.02, 0.04, 0.05]
    with pytest.raises(ss.SceneError, match=r'found "5 m", a length \[m\]; allowed: a time \[s\]'):
        sim.run(until="5 m")
    assert sim.step(1e-5) == 1e-5 and sim.time == 0.05 + 1e-5
    sim.run()
    assert (sim.time, sim.end) == (0.2, 0.2) and sim.stable_step > 1e-4
    assert repr(sim).startswith("<Simulation") and len(sim.bodies["ball"]) == sim.particles


def test_rings_that_collide_keep_momentum_and_give_the_same_bits_on_any_threads():
    sims = [rings().simulation(threads=threads) for threads in (1, 2)]
    assert [sim.threads for sim in sims] == [1, 2]
    for sim in sims:
        sim.run()
    left, right = (sims[0].bodies[name].state for name in ("left", "right"))
    assert left.velocity[0] < 1.0 and left.velocity[1] < -0.1, "they have met"
    assert left.mass * left.velocity == pytest.approx(-right.mass * right.velocity, abs=1e-13)
    ledger = sims[0].ledger()
    assert ledger.momentum == pytest.approx([0.0] * 3, abs=1e-13)
    assert ledger.friction > 0.0
    for name in ("left", "right"):
        for column in ("position", "stress", "deformation"):
            one, two = (sim.bodies[name].by_number(column) for sim in sims)
            assert np.array_equal(one, two), column


def test_contacts_are_means_since_the_last_reading():
    sim = rings().simulation()
    sim.run(until=5e-3)
    sim.contacts()
    before, momentum = sim.time, sim.bodies["right"].state
    sim.run(until=6e-3)
    after = sim.bodies["right"].state
    (row,) = sim.contacts()
    assert (row["body_a"], row["body_b"]) == ("left", "right")
    change = after.mass * (after.velocity - momentum.velocity)
    force = np.array([row["fx"], row["fy"], row["fz"]])
    assert force * (sim.time - before) == pytest.approx(change, rel=1e-9, abs=1e-12), "force times time"
    assert row["normal"] > 0.0 and row["area"] > 0.0 and row["nodes"] > 0 and row["slip"] > 0.0
    normal = np.array([row["nx"], row["ny"], row["nz"]])
    assert np.linalg.norm(normal) == pytest.approx(1.0) and normal[0] > 0.5, "from the left to the right"
    across = np.linalg.norm(force - normal * (force @ normal))
    assert 0.0 < across <= 0.3 * row["normal"] * (1.0 + 1e-9), "no more than friction holds"
    assert len(sim.contacts()) == 0, "no time has passed"


def test_columns_are_the_engines_memory_and_show_the_present_state():
    sim = flying().simulation()
    ball = sim.bodies["ball"]
    position, number, mass = ball.position, ball.number, ball["mass"]
    count = len(ball)
    assert position.shape == (count, 2) and number.shape == mass.shape == (count,)
    assert ball.stress.shape == (count, 4) and ball.deformation.shape == (count, 5)
    again = ball.position
    assert np.shares_memory(position, again)
    # Columns lie beside each other in one piece of memory: a stride apart, in the order of `columns`.
    addresses = {column.name: ball[column.name].__array_interface__["data"][0] for column in ball.columns}
    stride = position.strides[1]
    assert position.strides == (8, stride) and stride >= 8 * count
    assert addresses["velocity"] - addresses["position"] == 2 * stride
    assert addresses["mass"] - addresses["position"] == 5 * stride
    orders = set()
    for _ in range(40):
        before = position.copy()
        sim.step()
        assert not np.array_equal(position, before), "they move"
        assert np.array_equal(position, ball.by_number("position")[number][:, :2])
        assert np.array_equal(mass, ball.by_number("mass")[number])
        orders.add(number.tobytes())
    assert len(orders) > 1, "particles were sorted, and the arrays followed"
    assert ball.position.__array_interface__ == position.__array_interface__


def test_arrays_outlive_everything_but_cannot_be_written():
    sim = flying().simulation()
    position = sim.bodies["ball"].position
    with pytest.raises(ValueError, match="read-only"):
        position[0, 0] = 1.0
    with pytest.raises(ValueError, match="WRITEABLE"):
        position.flags.writeable = True
    part, copy = position[3:, 1], position.copy()
    del sim, position
    gc.collect()
    # Memory that was given back would be taken by these.
    others = [flying().simulation() for _ in range(5)]
    assert np.array_equal(part, copy[3:, 1]) and len(others) == 5


def test_precision_and_dimension_are_those_of_the_scene():
    sim = flying("3d", precision="single").simulation()
    ball = sim.bodies["ball"]
    assert ball.position.dtype == np.float32 and ball.number.dtype == np.uint32
    assert ball.position.shape == (len(ball), 3) and ball.deformation.shape == (len(ball), 9)
    assert np.array_equal(ball.by_number("deformation"), np.broadcast_to(np.eye(3), (len(ball), 3, 3)))
    columns = {column.name: column for column in ball.columns}
    assert columns["stress"] == ("stress", "Pa", ("xx", "yy", "zz", "xy", "yz", "xz"))
    assert columns["number"].components == columns["mass"].components == ()
    assert np.array_equal(ball.by_number("number"), np.arange(len(ball)))


def test_what_a_body_does_not_have_is_told():
    sim = settling().simulation()
    sim.step()
    with pytest.raises(AttributeError, match="found a column `strian`, which body `disk` does not have; allowed: posi"):
        sim.bodies["disk"].strian
    with pytest.raises(AttributeError, match="strian"):
        sim.bodies["disk"].by_number("strian")
    with pytest.raises(KeyError, match="found a body `disc`.*allowed: disk, floor"):
        sim.bodies["disc"]
    floor = sim.bodies["floor"]
    with pytest.raises(ValueError, match="`floor`, which is rigid and without bounds.*by_number"):
        floor.position
    assert floor.by_number("position").shape == (len(floor), 3) and len(floor) > 0
    assert {"position", "stress", "by_number"} <= set(dir(sim.bodies["disk"]))
    assert list(sim.bodies) == ["disk", "floor"]


def test_velocities_are_written_between_steps():
    sim = flying().simulation()
    sim.run(until=0.05)
    ball = sim.bodies["ball"]
    step = sim.stable_step
    ball.set("velocity", -2.0 * ball.velocity)
    assert ball.state.velocity[:2] == pytest.approx([-6.0, -2.0 * (1.0 - GRAVITY * 0.05)], rel=1e-12)
    assert sim.stable_step < step, "faster particles ask for shorter steps"
    ball.set("velocity", (0.0, 5.0))
    x, y, _ = ball.state.position
    dt = sim.step()
    assert ball.state.position[:2] == pytest.approx([x, y + dt * (5.0 - GRAVITY * dt)], rel=1e-9)
    ball.set("mass", 0.25)
    assert ball.state.mass == pytest.approx(0.25 * len(ball), rel=1e-12)


def test_the_ledger_is_told_what_is_written(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    sim = flying().simulation()
    sim.run(until=0.02)
    ball = sim.bodies["ball"]
    kinetic = sim.ledger().kinetic
    for name, values in [("velocity", -2.0 * ball.velocity), ("spin", 100.0), ("mass", 1.5 * ball.mass)]:
        before = sim.ledger()
        ball.set(name, values)
        after = sim.ledger()
        assert after.kinetic > before.kinetic + 0.1 * kinetic
        assert after.external_work > before.external_work
        assert after.total == pytest.approx(before.total, abs=1e-12 * after.kinetic)
    sim.save("written.checkpoint")
    again = flying().simulation()
    again.restore("written.checkpoint")
    assert again.engine.ledger() == sim.engine.ledger(), "with what was written"


def test_a_run_is_sound_though_velocities_and_masses_are_written(tmp_path):
    writes = []

    def write(sim):
        if not 0.06 < sim.time < 0.14:
            return
        ball = sim.bodies["ball"]
        arm = ball.position - ball.state.position[:2]
        turn = 4.0 * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
        ball.set("velocity", ball.velocity + turn - (5.0, 0.0))
        ball.set("mass", 1.1 * ball.mass)
        writes.append(sim.time)

    sim = flying().simulation()
    sim.bodies["ball"].set("velocity", (6.0, 0.0))
    summary = sim.run(out=tmp_path / "results", every=0.05, callback=write)
    assert len(writes) == 1 and summary.warnings == []
    assert abs(summary.relative_energy_drift) < 1e-3
    assert abs(summary.end.external_work - summary.start.external_work) > 0.1 * summary.start.kinetic
    energy = ss.Results(tmp_path / "results").energy
    assert energy["external_work"][0] == summary.start.external_work > 0.0


@pytest.mark.parametrize(
    ("name", "values", "message"),
    [
        ("velocity", (1.0, float("nan")), "found NaN for the particle at 0 in memory; allowed: finite numbers"),
        ("velocity", (1.0, 2.0, 3.0), r"found values of shape \(3,\) for `velocity`; allowed: \(\d+, 2\)"),
        ("mass", 0.0, "found 0 for the particle at 0 in memory; allowed: finite numbers above zero"),
        ("mass", -1.0, "finite numbers above zero"),
        ("stress", 0.0, "found `stress`, which only steps write to; allowed: velocity, spin, mass"),
    ],
)
def test_nonsense_is_not_written(name, values, message):
    ball = flying().simulation().bodies["ball"]
    before = ball.by_number(name)
    with pytest.raises(ValueError, match=message):
        ball.set(name, values)
    assert np.array_equal(ball.by_number(name), before)
    with pytest.raises(ValueError, match="body `floor` is rigid"):
        settling().simulation().bodies["floor"].set("mass", 1.0)


def test_a_normal_leads_from_the_first_body_to_the_second():
    sim = settling().simulation()
    sim.run(until=0.02)
    (row,) = sim.contacts()
    assert (row["body_a"], row["body_b"]) == ("disk", "floor") and row["normal"] > 0.0
    assert (row["nx"], row["ny"], row["nz"]) == pytest.approx((0.0, -1.0, 0.0), abs=1e-9), "down, as the disk pushes"


@pytest.mark.parametrize("dimension", ["plane-strain", "3d"])
def test_a_free_rigid_body_takes_velocity_and_spin_and_the_ledger_is_told(dimension, tmp_path):
    scene = flying(dimension)
    scene.document["bodies"][0]["rigid"] = dict(free={})
    space = dimension == "3d"
    velocity, spin = ((1.0, -2.0, 0.5), (3.0, 2.0, 10.0)) if space else ((1.0, -2.0), 10.0)
    sim = scene.simulation()
    sim.run(until=0.02)
    ball = sim.bodies["ball"]
    first = sim.ledger()
    ball.set("velocity", velocity)
    assert np.array_equal(ball.velocity, np.broadcast_to(velocity, ball.velocity.shape)), "of each point"
    ball.set("spin", spin)
    after, state = sim.ledger(), ball.state
    whole = np.zeros(3)
    whole[: len(velocity)] = velocity
    assert state.velocity == pytest.approx(whole) and state.spin == pytest.approx(spin if space else (0, 0, spin))
    assert after.external_work - first.external_work == pytest.approx(after.kinetic - first.kinetic, rel=1e-12)
    assert after.total == pytest.approx(first.total, abs=1e-12 * abs(after.kinetic))
    time = sim.time
    summary = sim.run(until=0.1, out=tmp_path / "results")
    gone, fall = sim.time - time, np.array([0.0, -GRAVITY, 0.0])
    assert ball.state.velocity == pytest.approx(whole + fall * gone, rel=1e-9)
    assert ball.state.spin == pytest.approx(state.spin, rel=1e-9), "nothing turns a ball"
    assert summary.warnings == [] and abs(summary.end.total - first.total) < 1e-3 * after.kinetic
    before = sim.engine.ledger()
    for name, values, message in [
        ("mass", 1.0, "its mass is that of the scene; allowed: velocity, spin"),
        ("velocity", (1.0, float("nan"), 0.0)[: len(velocity)], "found .*NaN.* for body `ball`, which is rigid"),
        ("velocity", np.ones((5, len(velocity))), "allowed: "),
    ]:
        with pytest.raises(ValueError, match=message):
            ball.set(name, values)
    assert sim.engine.ledger() == before


def test_joints_take_away_what_they_do_not_allow_of_what_is_written():
    scene = ss.Scene("plane-strain", 0.1)
    scene.material("steel", density=1000, neo_hookean=dict(young_modulus=1e6, poisson_ratio=0.3))
    scene.body("wheel", material="steel", shape=ss.disk((0, 0), 0.2), rigid=dict(free=dict(mass=50, inertia=1)))
    sim = scene.joint("wheel", name="axle", hinge=dict(point=(0, 0))).time(end=0.5).simulation()
    wheel, before = sim.bodies["wheel"], sim.ledger().total
    wheel.set("velocity", (1.0, 0.0))
    wheel.set("spin", 4.0)
    sim.step()
    assert wheel.state.velocity == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert wheel.state.spin[2] == pytest.approx(4.0) and sim.ledger().total == pytest.approx(before, abs=1e-9)


def test_supports_and_loads_say_what_they_did():
    scene = flying()
    scene.document["gravity"] = [0, 0]
    sim = scene.load("ball", name="push", on="volume", force=(6, 0)).simulation()
    sim.run(until=0.01)
    load = sim.loads()["push"]
    assert load.impulse == pytest.approx([0.06, 0.0, 0.0], rel=1e-9, abs=1e-12)
    ball = sim.bodies["ball"].state
    assert ball.mass * (ball.velocity[0] - 3.0) == pytest.approx(0.06, rel=1e-6)
    assert sim.relaxation is None
    assert scene.time(relax={}).simulation().relaxation.peaks == 0


def test_joints_say_what_they_did():
    scene = ss.Scene("plane-strain", 0.1, gravity=(0, -9.81))
    scene.material("steel", density=1000, neo_hookean=dict(young_modulus=1e6, poisson_ratio=0.3))
    scene.body("wheel", material="steel", shape=ss.disk((0, 0), 0.2), rigid=dict(free=dict(mass=50, inertia=1)))
    scene.joint("wheel", name="axle", hinge=dict(point=(0, 0), torque="2 N m"))
    sim = scene.time(end=0.5).simulation()
    sim.run(until=0.5)
    axle = sim.joints()["axle"]
    assert axle.impulse == pytest.approx([0.0, 50 * 9.81 * 0.5, 0.0], rel=1e-9, abs=1e-9)
    assert (axle.speed, axle.work) == pytest.approx((1.0, 0.5), rel=1e-3)
    assert axle.way == pytest.approx(0.25, rel=3e-3)


def test_callbacks_come_at_multiples_and_may_look_and_write():
    sim = flying().simulation()
    seen = []

    def look(found):
        assert found is sim
        seen.append((found.time, found.ledger().momentum[0], float(found.bodies["ball"].position[:, 0].mean())))

    sim.run(until=0.055, every=0.01, callback=look)
    times = [time for time, *_ in seen]
    assert len(times) == 7 and times[0] == 0.0 and times[-1] == 0.055
    assert all(0.01 * i - 1e-8 <= time < 0.01 * i + sim.stable_step for i, time in enumerate(times[:-1]))
    assert [x for *_, x in seen] == pytest.approx([3.0 * time for time in times], abs=1e-9)
    count = []
    steps = sim.steps
    sim.run(until=0.07, callback=lambda sim: count.append(sim.steps))
    assert count == list(range(steps, sim.steps + 1)), "once at the start, then after each step"
    sim.run(until=0.08, callback=lambda sim: sim.bodies["ball"].set("velocity", (1.0, 0.0)))
    assert sim.bodies["ball"].state.velocity[0] == pytest.approx(1.0, rel=1e-9)

    def stop(sim):
        if sim.time > 0.09:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        sim.run(callback=stop)
    assert 0.09 < sim.time < 0.1
    with pytest.raises(ValueError, match="found every=-1"):
        sim.run(every=-1, callback=stop)


def test_a_state_comes_back_bit_for_bit(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    sim = rings().simulation()
    position = sim.bodies["left"].position
    place = position.__array_interface__
    sim.run(until=4e-3)
    sim.save("state.checkpoint")
    sim.run(until=6e-3)
    end = sim.bodies["left"].by_number("stress")
    other = rings().simulation()
    for again in (sim, other):
        again.restore("state.checkpoint")
        assert again.time == 4e-3 and len(again.contacts()) == 0
        again.run(until=6e-3)
        assert np.array_equal(again.bodies["left"].by_number("stress"), end)
    assert position.__array_interface__ == place == sim.bodies["left"].position.__array_interface__
    assert np.array_equal(position, sim.bodies["left"].position), "an array shows the state that was taken up"
    with pytest.raises(ss.RunError, match="was made with another scene"):
        flying().simulation().restore("state.checkpoint")
    with pytest.raises(ss.ResultsError, match="nowhere"):
        sim.restore("nowhere")


def test_a_step_that_fails_names_the_particle():
    sim = flying().domain((-1, -1), (0.5, 1)).time(end=1).simulation()
    with pytest.raises(ss.StepError, match="left the domain.*make the domain larger") as caught:
        sim.run()
    error = caught.value
    assert (
        error.body == "ball" and 0 <= error.particle < sim.particles and error.time == pytest.approx(sim.time, rel=0.1)
    )
    assert error.position[0] > 0.4 and "domain" in error.help
    assert isinstance(error, ss.RunError)
    assert sim.bodies["ball"].state.position[0] > 0.1, "it can still be looked at"


def test_other_threads_of_python_go_on_while_a_step_is_taken():
    scene = flying("3d", particles_per_side=4)
    scene.set(**{"space.cell": 0.02})
    sim = scene.simulation(threads=1)
    sim.step()
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(1e-4)

    thread = threading.Thread(target=count)
    thread.start()
    before, began = counted[0], time.perf_counter()
    sim.step()
    wall, done = time.perf_counter() - began, counted[0] - before
    stop.set()
    thread.join()
    assert wall > 0.02, "a step that takes its time"
    assert done > 10, f"{done} in {wall} s"
    with pytest.raises(TypeError, match="pickle"):
        import pickle

        pickle.dumps(sim)


INTERRUPTED = """
import signal, sys, stickslip as ss
# Whoever runs the tests in the background may have Ctrl-C ignored, and a process begins as its parent is.
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.path.insert(0, {tests!r})
from conftest import flying
scene = flying("3d").time(end=1e3)
scene.outputs(tables=1e-2, particles=10.0)
sim = scene.simulation()
out = sys.argv[1] if len(sys.argv) > 1 else None
try:
    # Called at the start only: from then on no line of Python runs.
    sim.run(out=out, every=1e9, callback=lambda sim: print("begun", flush=True))
except KeyboardInterrupt:
    before = sim.time
    sim.step()
    print("interrupted", sim.steps, sim.time > before, flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT")
@pytest.mark.parametrize("with_results", [False, True])
def test_ctrl_c_ends_a_run_between_two_steps(with_results, tmp_path):
    from pathlib import Path

    script = INTERRUPTED.format(tests=str(Path(__file__).parent))
    arguments = [sys.executable, "-c", script, *(["results"] if with_results else [])]
    process = subprocess.Popen(arguments, cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "begun\n"
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=60)
    finally:
        # One that does not end by itself would run for hours.
        process.kill()
        process.wait()
    assert process.returncode == 0 and said.startswith("interrupted") and said.split()[2] == "True", said
    if with_results:
        results = ss.Results(tmp_path / "results")
        assert results.status == "interrupted" and results.bodies["time"][-1] == results.record.performance.time > 0
        assert len(results.frame(-1)["position"]) == results.record.performance.particles
        end = results.record.performance.time + 0.01
        assert ss.resume(tmp_path / "results", until=end).performance.time == end


ENDED = """
import signal, sys, stickslip as ss
number = getattr(signal, sys.argv[1])
# A process begins with signals ignored as its parent has them.
signal.signal(number, signal.SIG_DFL if sys.argv[2] == "default" else lambda *_: print("mine", flush=True))
sys.path.insert(0, {tests!r})
from conftest import flying
flying("3d").time(end=1e-3).run(out="before")
assert sys.argv[2] != "default" or signal.getsignal(number) is signal.SIG_DFL
scene = flying("3d").time(end=1e3)
scene.outputs(tables=1e-2, particles=10.0)
scene.simulation().run(out="results", every=1e9, callback=lambda sim: print("begun", flush=True))
print("went on", flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no signals")
@pytest.mark.parametrize("handler", ["default", "own"])
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_process_that_is_asked_to_end_leaves_whole_results(name, handler, tmp_path):
    from pathlib import Path

    number = getattr(signal, name)
    script = ENDED.format(tests=str(Path(__file__).parent))
    arguments = [sys.executable, "-c", script, name, handler]
    process = subprocess.Popen(arguments, cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "begun\n"
        time.sleep(0.3)
        process.send_signal(number)
        if handler == "own":
            assert process.stdout.readline() == "mine\n"
            time.sleep(0.2)
            assert process.poll() is None and ss.Results(tmp_path / "results").status == "running"
            return
        said, _ = process.communicate(timeout=60)
    finally:
        # One that does not end by itself would run for hours.
        process.kill()
        process.wait()
        process.stdout.close()
    assert (process.returncode, said) == (-number, "")
    results = ss.Results(tmp_path / "results")
    assert results.status == "interrupted" and results.bodies["time"][-1] == results.record.performance.time > 0


def test_many_bodies_are_asked_for_by_patterns():
    scene = flying("plane-strain")
    scene.body("disk {i}", repeat=dict(i=3), material="rubber", shape=ss.disk(("5 + i * 2", 5), 0.5))
    scene.contact(friction=0)
    sim = scene.simulation()
    assert [body.name for body in sim.bodies.matching("disk *")] == ["disk 0", "disk 1", "disk 2"]
    assert sim.bodies.matching("disk") == [] and len(sim.bodies.matching("*")) == len(sim.bodies)


def test_times_that_cannot_be_read_are_named_as_they_were_given():
    sim = flying().simulation()
    for given in (dict(until="5 m"), dict(every="soon", callback=print)):
        (name,) = given.keys() - {"callback"}
        with pytest.raises(ss.SceneError, match=f"^{name}: found ") as error:
            sim.run(**given)
        assert error.value.key == name and "time.end" not in str(error.value)
    assert sim.time == 0.0
