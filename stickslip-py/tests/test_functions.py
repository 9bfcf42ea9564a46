"""Laws, loads and prescribed motion as functions, against the built-in ones and formulas that say the same."""

from __future__ import annotations

import ctypes
import math
import pickle
import traceback
from pathlib import Path

import numpy as np
import pytest
import stickslip as ss
from conftest import flying, settling

K, G = 1e6 / 1.2, 1e6 / 2.6
MODULI = dict(bulk_modulus=K, shear_modulus=G)


def neo_hookean(step: ss.Step, bulk: float, shear: float) -> tuple[np.ndarray, np.ndarray]:
    """The built-in law.

    sigma = K/2 (J - 1/J) I + G J^(-5/3) dev(F F^T), W = K/2 ((J^2 - 1)/2 - ln J) + G/2 (J^(-2/3) tr(F F^T) - 3)
    """
    f = step.deformation
    j = np.linalg.det(f)[:, None, None]
    b = f @ f.transpose(0, 2, 1)
    trace = np.trace(b, axis1=1, axis2=2)[:, None, None]
    stress = bulk / 2 * (j - 1 / j) * np.eye(3) + shear * j ** (-5 / 3) * (b - trace / 3 * np.eye(3))
    j, trace = j[:, 0, 0], trace[:, 0, 0]
    return stress, bulk / 2 * ((j**2 - 1) / 2 - np.log(j)) + shear / 2 * (j ** (-2 / 3) * trace - 3)


def hypoelastic(step: ss.Step, bulk: float, shear: float) -> np.ndarray:
    """A law in rate form, which needs the increment, its stress and a history of its own."""
    step.history["steps"] += 1
    step.history["age"] += step.dt
    rate = step.increment - np.eye(3)
    strain = 0.5 * (rate + rate.transpose(0, 2, 1))
    trace = np.trace(strain, axis1=1, axis2=2)[:, None, None]
    more = bulk * trace * np.eye(3) + 2 * shear * (strain - trace / 3 * np.eye(3))
    step.wave_modulus[:] = 2 * (bulk + 4 / 3 * shear)
    return step.stress + more[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]


def own(scene: ss.Scene, law: object) -> ss.Scene:
    """The scene with a law of one's own in the place of its rubber's."""
    return scene.material("rubber", density=1000, outside=dict(law=law, **MODULI))


LAW = ss.Law(neo_hookean, constants=dict(bulk=K, shear=G))


def same_steps(exact: ss.Simulation, found: ss.Simulation, end: float) -> None:
    """Steps of one length: those of the two differ by the moduli of their waves."""
    while exact.time < end:
        step = exact.step(1e-4)
        assert found.step(step) == step


def test_a_law_over_arrays_is_the_built_in_one() -> None:
    for dimension in ("plane-strain", "3d"):
        exact, scene = settling(), own(settling(), LAW)
        if dimension == "3d":
            exact, scene = flying("3d"), own(flying("3d"), LAW)
            for made in (exact, scene):
                made.document["bodies"][0]["spin"] = [0, 0, 20]
        (a, b), body = (made.simulation(threads=2) for made in (exact, scene)), exact.document["bodies"][0]["name"]
        same_steps(a, b, 0.02)
        off = np.abs(a.bodies[body].by_number("position") - b.bodies[body].by_number("position")).max()
        assert off < 1e-9, (dimension, off)
        assert b.ledger().strain == pytest.approx(a.ledger().strain, rel=1e-6)
        assert a.ledger().strain > 1e-3
        assert "strain_energy_density" in [column.name for column in b.bodies[body].columns]


def test_what_a_law_remembers_is_a_column_and_threads_change_no_bit() -> None:
    law = ss.Law(
        hypoelastic, history=dict(steps="number", age=("number", "s")), constants=dict(bulk=K, shear=G), increment=True
    )
    ends = []
    for threads in (1, 3):
        sim = own(settling(), law).simulation(threads=threads)
        sim.run(until=0.01)
        disk = sim.bodies["disk"]
        assert np.all(disk.by_number("steps") == sim.steps)
        assert disk.by_number("age") == pytest.approx(sim.time)
        ends.append(disk.by_number("stress"))
    assert np.array_equal(*ends) and np.abs(ends[0]).max() > 100


def test_what_is_wrong_in_a_law_ends_the_run_with_its_traceback() -> None:
    def fails(step: ss.Step) -> np.ndarray:
        if step.time > 2e-3:
            raise ZeroDivisionError("no answer")
        return 0.0 * step.stress

    with pytest.raises(ss.StepError, match=r"the law `fails` of body `ball` failed near t = .*: no answer") as error:
        own(flying(), fails).simulation().run()
    assert isinstance(error.value.__cause__, ZeroDivisionError) and 1e-3 < error.value.time < 2e-2
    assert "in fails" in "".join(traceback.format_exception(error.value))

    for wrong, message in [
        (lambda step: np.zeros(3), r"law `lambda` gave a stress of shape \(3,\); allowed: \(\d+, 3, 3\), or"),
        (lambda step: step.increment, "increment=True"),
    ]:
        with pytest.raises(ss.StepError, match=message):
            own(flying(), wrong).simulation().step()
    with pytest.raises(ss.StepError, match="has a value that is not finite"):
        own(flying(), lambda step: np.nan * step.stress).simulation().step()

    seen: list[ss.Simulation] = []
    asking = own(flying(), lambda step: seen[0].time * step.stress).simulation()
    seen.append(asking)
    with pytest.raises(ss.StepError, match="asks a simulation"):
        asking.step()
    assert asking.time == 0.0


@pytest.mark.filterwarnings("ignore::stickslip.StickslipWarning")
def test_runs_with_a_law_of_ones_own_go_on_and_are_refused_without_it(tmp_path: Path) -> None:
    scene = own(flying(), LAW)
    scene.run(tmp_path / "whole", checkpoint_every=None)
    sim = scene.simulation()
    sim.run(until=0.1, out=tmp_path / "half")
    with pytest.raises(ss.SceneError, match="found the law `neo_hookean`, which is not given") as refused:
        ss.resume(tmp_path / "half", until=0.2)
    assert refused.value.key == "materials.rubber.outside.law"
    other = ss.Law(neo_hookean, constants=dict(bulk=2 * K, shear=G))
    with pytest.raises(ss.RunError, match="bulk"):
        ss.resume(tmp_path / "half", until=0.2, functions=dict(neo_hookean=other))
    ss.resume(tmp_path / "half", until=0.2, functions=dict(neo_hookean=LAW))
    ends = [ss.Results(tmp_path / name).bodies[-1] for name in ("whole", "half")]
    assert ends[0]["x"] == pytest.approx(ends[1]["x"], rel=1e-9) and ends[0]["time"] == ends[1]["time"]

    again = pickle.loads(pickle.dumps(scene))
    assert again == scene and again.simulation().step() == scene.simulation().step()


def test_plane_stress_takes_compiled_laws_alone() -> None:
    with pytest.raises(ss.SceneError, match="a law over arrays in plane stress"):
        own(flying("plane-stress"), LAW).simulation()


NUMBERS = ctypes.POINTER(ctypes.c_double)
C_LAW = ctypes.CFUNCTYPE(None, NUMBERS, NUMBERS, ctypes.c_double, NUMBERS, NUMBERS, NUMBERS, NUMBERS)
C_FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_double, NUMBERS, NUMBERS, NUMBERS)


def pointwise(f, increment, dt, constants, stress, history, answers):  # type: ignore[no-untyped-def]
    """The neo-Hookean law of one particle, as compiled code has it."""
    bulk, shear = constants[0], constants[1]
    j = f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) + f[2] * (f[3] * f[7] - f[4] * f[6])
    rows = [(0, 0), (3, 3), (6, 6), (0, 3), (3, 6), (0, 6)]
    b = [f[a] * f[c] + f[a + 1] * f[c + 1] + f[a + 2] * f[c + 2] for a, c in rows]
    trace = b[0] + b[1] + b[2]
    scale = shear * j ** (-5 / 3)
    for k in range(6):
        stress[k] = scale * b[k]
    for k in range(3):
        stress[k] += bulk / 2 * (j - 1 / j) - scale * trace / 3
    history[0] += dt
    answers[0] = bulk / 2 * ((j * j - 1) / 2 - math.log(j)) + shear / 2 * (j ** (-2 / 3) * trace - 3)


def test_a_compiled_law_takes_particle_by_particle_in_all_threads() -> None:
    law = ss.Law(C_LAW(pointwise), history=dict(age="number"), constants=dict(bulk=K, shear=G))
    for dimension in ("plane-strain", "plane-stress"):
        exact, found = flying(dimension), own(flying(dimension), law)
        for scene in (exact, found):
            scene.document["bodies"][0]["spin"] = 20
        a, b = exact.simulation(threads=2), found.simulation(threads=2)
        same_steps(a, b, 5e-3)
        off = np.abs(a.bodies["ball"].by_number("position") - b.bodies["ball"].by_number("position")).max()
        assert off < 1e-9, (dimension, off)
        assert b.ledger().strain == pytest.approx(a.ledger().strain, rel=1e-6)
        assert b.bodies["ball"].by_number("age") == pytest.approx(b.time)


def test_a_law_of_numba() -> None:
    numba = pytest.importorskip("numba")
    compiled = numba.cfunc(ss.Law.signature())(pointwise)
    law = ss.Law(compiled, history=dict(age="number"), constants=dict(bulk=K, shear=G))
    a, b = flying().simulation(), own(flying(), law).simulation()
    same_steps(a, b, 5e-3)
    assert np.allclose(a.bodies["ball"].by_number("position"), b.bodies["ball"].by_number("position"), atol=1e-9)


def pulled(**load: object) -> ss.Simulation:
    return flying().load("ball", **load).simulation()


def test_loads_as_functions_are_those_of_formulas() -> None:
    def pull(time: float, points: np.ndarray, start: np.ndarray) -> np.ndarray:
        return np.stack([1e4 * time * points[:, 1] / 0.3, 50 + 0 * start[:, 0]], axis=1)

    pairs = [
        (pulled(traction=pull), pulled(traction=["1e4 * t * y / 0.3", 50])),
        (pulled(force=lambda t, x, x0: (0.0, 300.0 * t)), pulled(force=[0, "300 * t"])),
        (pulled(pressure=lambda t, x, x0: 1e3 * x0[:, 0]), pulled(pressure="1e3 * x0")),
        (pulled(acceleration=lambda t, x, x0: 3 * x), pulled(acceleration=["3 * x", "3 * y"])),
    ]

    @C_FUNCTION
    def compiled(time, point, start, value):  # type: ignore[no-untyped-def]
        value[1] = 300 * time

    pairs.append((pulled(force=ss.Function(compiled)), pulled(force=[0, "300 * t"])))
    for number, (found, exact) in enumerate(pairs):
        for simulation in (found, exact):
            simulation.run(until=0.02)
        a, b = (simulation.bodies["ball"].by_number("position") for simulation in (found, exact))
        assert np.abs(a - b).max() < 1e-9, number
        free = flying().simulation()
        free.run(until=0.02)
        assert np.abs(a - free.bodies["ball"].by_number("position")).max() > 1e-7, number


def test_prescribed_motion_as_a_function() -> None:
    def driven(velocity: object, spin: object) -> ss.Simulation:
        scene = settling()
        scene.body("ram", material="rubber", shape=ss.disk((0, 0.3), 0.05), rigid=dict(velocity=velocity, spin=spin))
        return scene.simulation()

    found = driven(lambda t: (0.0, -30 * t), lambda t: 2.0)
    exact = driven((0, "-30 * t"), 2)
    for simulation in (found, exact):
        simulation.run(until=0.01)
    assert np.array_equal(found.bodies["ram"].position, exact.bodies["ram"].position)
    assert found.bodies["ram"].state.spin[2] == pytest.approx(2.0) and found.bodies["ram"].state.velocity[1] < -0.2

    fails = driven(lambda t: [][1], 0)
    with pytest.raises(ss.StepError, match="the prescribed motion of body `ram` failed") as error:
        fails.step()
    assert isinstance(error.value.__cause__, IndexError)
    with pytest.raises(ss.StepError, match=r"gave values of shape \(3,\); allowed: \(2,\)"):
        driven(lambda t: (0, 1, 2), 0).step()


def test_a_scene_keeps_the_names_of_its_functions(tmp_path: Path) -> None:
    scene = own(flying(), LAW).load("ball", force=lambda t, x, x0: (0, 1))
    assert scene.functions.keys() == {"neo_hookean", "lambda"}
    scene.load("ball", name="other", force=lambda t, x, x0: (0, 2))
    assert scene.document["loads"][1]["force"] == {"outside": "lambda_2"}
    scene.save(tmp_path / "scene.toml")
    again = ss.Scene.load(tmp_path / "scene.toml")
    with pytest.raises(ss.SceneError, match="`neo_hookean`, which is not given"):
        again.check()
    again.functions.update(scene.functions)
    assert again.check().particles > 0
    mine = flying()
    mine.functions["lambda"] = lambda t, x, x0: (0, 3)
    mine.load("ball", force=lambda t, x, x0: (0, 1))
    assert mine.document["loads"][0]["force"] == {"outside": "lambda_2"}, "the name that a user gave stays"
    with pytest.raises(TypeError, match="found <Function 'lambda'> where a law is wanted"):
        own(flying(), ss.Function(lambda t: 0)).check()
