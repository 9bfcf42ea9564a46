"""Stickslip in Python: many deformable bodies in frictional contact, by the material point method.

A scene is the words of a scene file; numbers are in SI units, or text with units::

    import stickslip as ss

    scene = ss.Scene(dimension="plane-strain", cell="1 mm", gravity=(0, -9.81))
    scene.material("steel", density=7800, neo_hookean=dict(bulk_modulus="160 GPa", shear_modulus="80 GPa"))
    scene.body("ball", material="steel", shape=ss.ball((0, 0.02), 0.01), velocity=(0, -1))
    scene.time(end="1 ms")

    sim = scene.simulation()
    sim.run(until=0.5e-3)
    sim.bodies["ball"].position       # (n, 2), the engine's own memory [m]

`Scene` builds, loads and saves scenes, `Simulation` steps them, `Results` reads what runs left. All that comes out is
in SI units; stress is positive in tension, and forces and energies of plane scenes are per metre of depth.
"""

from . import _core
from .commands import Picture, Sweep, plot, render, sweep, validate
from .errors import ResultsError, RunError, SceneError, StepError, StickslipError, StickslipWarning
from .functions import Function, Law, Step
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
