"""Stickslip in Python: many deformable bodies in frictional contact, by the material point method.

From a scene to a picture; numbers are in SI units, or text with units::

    import stickslip as ss

    scene = ss.Scene(dimension="plane-strain", cell="4 mm", basis="spline", title="Two rings collide")
    scene.material("rubber", density=1000, neo_hookean=dict(young_modulus="1 MPa", poisson_ratio=0.3))
    scene.body("left", material="rubber", shape=ss.ring((-0.05, 0), 0.024, 0.04), velocity=(2, 0))
    scene.body("right", material="rubber", shape=ss.ring((0.05, 0.03), 0.024, 0.04), velocity=(-2, 0))
    scene.contact(("left", "right"), friction=0.3)
    scene.time(end="20 ms")

    print(scene.check())                                # particles, steps, wall time, and what is doubtful
    summary = scene.run(out="rings.results")            # a folder of tables and snapshots, as of `stickslip run`
    results = ss.Results("rings.results")
    print(results.bodies.where(body="left")["vx"])      # a column of bodies.csv [m/s]
    ss.render(results, color="pressure")                # rings.results/picture.png

    sim = scene.simulation()                            # or step by step, without a folder
    sim.run(until="5 ms")
    print(sim.bodies["left"].position)                  # (n, 2), the engine's own memory [m]

Where to begin:

    Scene           a scene, by the words of scene files; Scene.load reads one
    ball, box ...   shapes; also disk, ring, polygon, mesh, union, difference ...
    keys            what a table of a scene may hold: ss.keys("material"), ss.keys("time")
    Scene.check     what is wrong or doubtful, and what the run will be
    Scene.run       runs it and leaves results in a folder; resume goes on with such a run
    Results         reads them: tables, snapshots, charts
    render, plot    pictures and charts in files
    Scene.simulation  a Simulation, to be stepped: bodies, contacts and energies between steps
    Law, Function   laws, loads and motion of your own
    sweep           every combination of values of parameters
    validate        problems with known answers
    StickslipError  what all errors are; StickslipWarning is what is doubtful

All that comes out is in SI units; stress is positive in tension, and masses, forces and energies of plane scenes are
per metre of depth. Results replace finished ones of the same folder.
"""

from typing import TYPE_CHECKING as _TYPE_CHECKING

try:
    from . import _core
except ImportError as _missing:
    if "cannot import name" not in str(_missing):
        raise
    _files = __path__[0]
    raise ImportError(
        f"the Python files of Stickslip in {_files} have no engine beside them: they are those of a source tree. Build "
        "and install it with `pip install .` at the root of the tree (which needs Rust; `maturin develop --release` "
        "for work on it), and take that folder out of PYTHONPATH, or start Python elsewhere",
        name="stickslip._core",
    ) from None
from .commands import Picture, Sweep, plot, render, sweep, validate
from .errors import ResultsError, RunError, SceneError, StepError, StickslipError, StickslipWarning
from .functions import Function, Law, Step
from .language import keys
from .records import Record, Table
from .results import Frame, Results
from .running import Summary, resume
from .scene import Report, Scene
from .shapes import (
    ball,
    box,
    capsule,
    cone,
    cylinder,
    difference,
    disk,
    ellipsoid,
    half_space,
    intersection,
    mesh,
    polygon,
    revolved,
    ring,
    rotated,
    rounded_box,
    spline,
    superquadric,
    torus,
    union,
)
from .simulation import Bodies, Body, Column, Simulation

__version__: str = _core.VERSION

__all__ = [
    "Bodies",
    "Body",
    "Column",
    "Frame",
    "Function",
    "Law",
    "Picture",
    "Record",
    "Report",
    "Results",
    "ResultsError",
    "RunError",
    "Scene",
    "SceneError",
    "Simulation",
    "Step",
    "StepError",
    "StickslipError",
    "StickslipWarning",
    "Summary",
    "Sweep",
    "Table",
    "ball",
    "box",
    "capsule",
    "cone",
    "cylinder",
    "difference",
    "disk",
    "ellipsoid",
    "half_space",
    "intersection",
    "keys",
    "mesh",
    "plot",
    "polygon",
    "render",
    "resume",
    "revolved",
    "ring",
    "rotated",
    "rounded_box",
    "spline",
    "superquadric",
    "sweep",
    "torus",
    "union",
    "validate",
]

if not _TYPE_CHECKING:

    def __getattr__(name: str) -> None:
        """Says where what others call so is."""
        places = {"load": "Scene.load", "run": "Scene.run", "simulate": "Scene.simulation", "help": "keys"}
        advice = f"; did you mean ss.{places[name]}?" if name in places else ""
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{advice}")
