"""What tests share: small scenes, the repository, and the command, where it is built."""

from __future__ import annotations

from pathlib import Path

import pytest
import stickslip as ss

REPOSITORY = Path(__file__).parents[2]


@pytest.fixture
def command() -> str:
    """The command of this build, by the same sources."""
    path = REPOSITORY / "target" / "release" / "stickslip"
    if not path.exists():
        pytest.skip("the command is not built")
    return str(path)


def flying(dimension: str = "plane-strain", **space: object) -> ss.Scene:
    """A ball that nothing touches, thrown up and aside; on the common grid, if nothing else is said."""
    space.setdefault("interior", "grid")
    scene = ss.Scene(dimension, 0.1, gravity=(0, -9.81) if dimension != "3d" else (0, -9.81, 0), **space)
    scene.material("rubber", density=1000, neo_hookean=dict(young_modulus=1e6, poisson_ratio=0.3))
    up = (3.0, 1.0) if dimension != "3d" else (3.0, 1.0, 0.0)
    scene.body("ball", material="rubber", shape=ss.ball([0.0] * len(up), 0.3), velocity=up)
    return scene.time(end=0.2)


def rings() -> ss.Scene:
    """Two rings that fly at each other off their centres, and touch by 5 ms."""
    scene = ss.Scene("plane-strain", "4 mm", basis="spline", title="rings")
    scene.material("rubber", density=1000, neo_hookean=dict(young_modulus="1 MPa", poisson_ratio=0.3))
    for name, x, y, speed in [("left", -0.045, 0, 2), ("right", 0.045, 0.03, -2)]:
        ring = ss.difference(ss.disk((x, y), 0.04), ss.disk((x, y), 0.024))
        scene.body(name, material="rubber", shape=ring, velocity=(speed, 0))
    scene.contact(("left", "right"), friction=0.3)
    return scene.time(end="10 ms")


def settling() -> ss.Scene:
    """A disk on a rigid floor without bounds."""
    scene = ss.Scene("plane-strain", 0.025, gravity=(0, -9.81), interior="grid")
    scene.material("rubber", density=1000, neo_hookean=dict(young_modulus=1e6, poisson_ratio=0.3))
    scene.body("disk", material="rubber", shape=ss.disk((0, 0.1), 0.1))
    scene.body("floor", material="rubber", shape=ss.half_space((0, 0), (0, 1)), rigid={})
    scene.contact(friction=0)
    return scene.time(end=0.02)
