"""Problem P1 of `stickslip bench` for other programs: the particles, the constants, the clock.

An elastic cube with 8 particles a cell flies through space. The other programs keep a dense grid, so it gets the smallest one
that holds the motion: 16 cells more than the cube along each axis, against no limit for Stickslip.
"""

import argparse
import json
import time

import numpy as np

CELL = 0.03125  # m
DENSITY = 1000.0  # kg/m^3
MU, LAMBDA = 3e6, 4e6  # Pa: shear modulus 3 MPa, bulk modulus 6 MPa
TIME_STEP = 1e-4  # s: 0.4 of the time in which a wave of 100 m/s crosses a cell that moves at 10 m/s
MARGIN = 3  # cells below the cube
SPARE = 16  # cells more than the cube along each axis
VELOCITY = np.array([8.0, 5.0, 3.0])  # m/s
MOST_STEPS = 300  # then the cube is near the end of the grid


class Cube:
    """Positions [m] and velocities [m/s] of the particles, their volume [m^3] and mass [kg]."""

    def __init__(self, cells):
        sites = (np.arange(2 * cells) + 0.5) / 2 + MARGIN
        self.position = CELL * np.stack(np.meshgrid(sites, sites, sites, indexing="ij"), axis=-1).reshape(-1, 3)
        self.velocity = np.tile(VELOCITY, (len(self.position), 1))
        self.volume = (CELL / 2) ** 3
        self.mass = DENSITY * self.volume
        self.nodes = cells + SPARE
        self.particles = len(self.position)


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--cells", type=int, default=32)
    parser.add_argument("--warm-up", type=int, default=8)
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--steps", type=int, default=48, help="most steps of a repetition")
    parser.add_argument("--seconds", type=float, default=15.0, help="wall time for all repetitions")
    parser.add_argument("--out", default="/dev/stdout", help="file for the results, JSON")
    return parser.parse_args()


def measure(asked, cube, step, check, **names):
    """Times `step(count)`; `check()` returns the particles' positions and velocities as arrays."""
    start = time.perf_counter()
    step(1)
    first = time.perf_counter() - start
    step(asked.warm_up)
    start = time.perf_counter()
    step(1)
    pace = time.perf_counter() - start
    most = min(asked.steps, (MOST_STEPS - asked.warm_up - 2) // asked.repetitions)
    steps = max(1, min(most, int(asked.seconds / asked.repetitions / pace)))
    rates = []
    for _ in range(asked.repetitions):
        start = time.perf_counter()
        step(steps)
        rates.append(cube.particles * steps / (time.perf_counter() - start))
    # Free flight: the centre of mass keeps its velocity, whatever the shape functions.
    flown = TIME_STEP * (2 + asked.warm_up + steps * asked.repetitions)
    position, velocity = check()
    assert np.allclose(velocity.mean(axis=0), VELOCITY, rtol=1e-6), velocity.mean(axis=0)
    assert np.allclose((position - cube.position).mean(axis=0), VELOCITY * flown, rtol=1e-6)
    return dict(names, particles=cube.particles, steps=steps, repetitions=rates, first_step=first, threads=1)


def report(asked, results):
    with open(asked.out, "w") as file:
        json.dump(results, file)
