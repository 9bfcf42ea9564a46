"""The flying cube in NVIDIA Warp on the processor: explicit MPM in f64 with a neo-Hookean law.

Linear functions: plain MPM (FLIP). Quadratic splines: MLS-MPM (APIC). Warp runs kernels on a processor with one thread.
"""

import warp as wp

from cube import CELL, LAMBDA, MU, TIME_STEP, Cube, arguments, measure, report

h = wp.constant(wp.float64(CELL))
dt = wp.constant(wp.float64(TIME_STEP))
mu = wp.constant(wp.float64(MU))
lam = wp.constant(wp.float64(LAMBDA))
zero = wp.constant(wp.float64(0.0))
one = wp.constant(wp.float64(1.0))
half = wp.constant(wp.float64(0.5))
three_halves = wp.constant(wp.float64(1.5))
three_quarters = wp.constant(wp.float64(0.75))
four = wp.constant(wp.float64(4.0))


@wp.func
def kirchhoff_stress(F: wp.mat33d):
    unit = wp.identity(n=3, dtype=wp.float64)
    return mu * (F * wp.transpose(F) - unit) + lam * wp.log(wp.determinant(F)) * unit


@wp.func
def place(x: wp.vec3d):
    """The lower node of the cell."""
    return wp.vec3i(wp.int32(wp.floor(x[0] / h)), wp.int32(wp.floor(x[1] / h)), wp.int32(wp.floor(x[2] / h)))


@wp.func
def tent(corner: int, s: wp.float64):
    """Value of the lower (0) or upper (1) node's function."""
    value = s
    if corner == 0:
        value = one - s
    return value


@wp.func
def slope(corner: int):
    value = one
    if corner == 0:
        value = -one
    return value / h


@wp.func
def spline(node: int, s: wp.float64):
    """Value of the quadratic spline of node 0, 1, 2 at distance s from node 0."""
    value = half * (three_halves - s) * (three_halves - s)
    if node == 1:
        value = three_quarters - (s - one) * (s - one)
    if node == 2:
        value = half * (s - half) * (s - half)
    return value


@wp.func
def apart(node: int, s: wp.float64):
    """From the particle to node 0, 1, 2, in cells."""
    return wp.float64(node) - s


@wp.kernel
def linear_to_grid(
    x: wp.array(dtype=wp.vec3d),
    v: wp.array(dtype=wp.vec3d),
    F: wp.array(dtype=wp.mat33d),
    volume: wp.float64,
    particle_mass: wp.float64,
    mass: wp.array3d(dtype=wp.float64),
    momentum: wp.array3d(dtype=wp.vec3d),
    force: wp.array3d(dtype=wp.vec3d),
):
    p = wp.tid()
    base = place(x[p])
    s = wp.vec3d(
        x[p][0] / h - wp.float64(base[0]), x[p][1] / h - wp.float64(base[1]), x[p][2] / h - wp.float64(base[2])
    )
    tau = volume * kirchhoff_stress(F[p])
    carried = particle_mass * v[p]
    for i in range(2):
        for j in range(2):
            for k in range(2):
                wx, wy, wz = tent(i, s[0]), tent(j, s[1]), tent(k, s[2])
                weight = wx * wy * wz
                gradient = wp.vec3d(slope(i) * wy * wz, slope(j) * wx * wz, slope(k) * wx * wy)
                wp.atomic_add(mass, base[0] + i, base[1] + j, base[2] + k, weight * particle_mass)
                wp.atomic_add(momentum, base[0] + i, base[1] + j, base[2] + k, weight * carried)
                wp.atomic_sub(force, base[0] + i, base[1] + j, base[2] + k, tau * gradient)


@wp.kernel
def accelerate(
    mass: wp.array3d(dtype=wp.float64), momentum: wp.array3d(dtype=wp.vec3d), force: wp.array3d(dtype=wp.vec3d)
):
    i, j, k = wp.tid()
    m = mass[i, j, k]
    if m > zero:
        change = dt * force[i, j, k] / m
        momentum[i, j, k] = momentum[i, j, k] / m + change
        force[i, j, k] = change


@wp.kernel
def grid_to_linear(
    x: wp.array(dtype=wp.vec3d),
    v: wp.array(dtype=wp.vec3d),
    F: wp.array(dtype=wp.mat33d),
    velocity: wp.array3d(dtype=wp.vec3d),
    change: wp.array3d(dtype=wp.vec3d),
):
    p = wp.tid()
    base = place(x[p])
    s = wp.vec3d(
        x[p][0] / h - wp.float64(base[0]), x[p][1] / h - wp.float64(base[1]), x[p][2] / h - wp.float64(base[2])
    )
    new_v = wp.vec3d(zero, zero, zero)
    dv = wp.vec3d(zero, zero, zero)
    L = wp.mat33d(zero, zero, zero, zero, zero, zero, zero, zero, zero)
    for i in range(2):
        for j in range(2):
            for k in range(2):
                wx, wy, wz = tent(i, s[0]), tent(j, s[1]), tent(k, s[2])
                weight = wx * wy * wz
                gradient = wp.vec3d(slope(i) * wy * wz, slope(j) * wx * wz, slope(k) * wx * wy)
                at_node = velocity[base[0] + i, base[1] + j, base[2] + k]
                new_v += weight * at_node
                dv += weight * change[base[0] + i, base[1] + j, base[2] + k]
                L += wp.outer(at_node, gradient)
    x[p] = x[p] + dt * new_v
    v[p] = v[p] + dv
    F[p] = F[p] + dt * (L * F[p])


@wp.kernel
def quadratic_to_grid(
    x: wp.array(dtype=wp.vec3d),
    v: wp.array(dtype=wp.vec3d),
    C: wp.array(dtype=wp.mat33d),
    F: wp.array(dtype=wp.mat33d),
    volume: wp.float64,
    particle_mass: wp.float64,
    mass: wp.array3d(dtype=wp.float64),
    momentum: wp.array3d(dtype=wp.vec3d),
):
    p = wp.tid()
    base = place(x[p] - wp.vec3d(half * h, half * h, half * h))
    s = wp.vec3d(
        x[p][0] / h - wp.float64(base[0]), x[p][1] / h - wp.float64(base[1]), x[p][2] / h - wp.float64(base[2])
    )
    affine = particle_mass * C[p] - (dt * four * volume / (h * h)) * kirchhoff_stress(F[p])
    for i in range(3):
        for j in range(3):
            for k in range(3):
                weight = spline(i, s[0]) * spline(j, s[1]) * spline(k, s[2])
                distance = wp.vec3d(apart(i, s[0]), apart(j, s[1]), apart(k, s[2])) * h
                wp.atomic_add(mass, base[0] + i, base[1] + j, base[2] + k, weight * particle_mass)
                carried = weight * (particle_mass * v[p] + affine * distance)
                wp.atomic_add(momentum, base[0] + i, base[1] + j, base[2] + k, carried)


@wp.kernel
def divide(mass: wp.array3d(dtype=wp.float64), momentum: wp.array3d(dtype=wp.vec3d)):
    i, j, k = wp.tid()
    m = mass[i, j, k]
    if m > zero:
        momentum[i, j, k] = momentum[i, j, k] / m


@wp.kernel
def grid_to_quadratic(
    x: wp.array(dtype=wp.vec3d),
    v: wp.array(dtype=wp.vec3d),
    C: wp.array(dtype=wp.mat33d),
    F: wp.array(dtype=wp.mat33d),
    velocity: wp.array3d(dtype=wp.vec3d),
):
    p = wp.tid()
    base = place(x[p] - wp.vec3d(half * h, half * h, half * h))
    s = wp.vec3d(
        x[p][0] / h - wp.float64(base[0]), x[p][1] / h - wp.float64(base[1]), x[p][2] / h - wp.float64(base[2])
    )
    new_v = wp.vec3d(zero, zero, zero)
    B = wp.mat33d(zero, zero, zero, zero, zero, zero, zero, zero, zero)
    for i in range(3):
        for j in range(3):
            for k in range(3):
                weight = spline(i, s[0]) * spline(j, s[1]) * spline(k, s[2])
                distance = wp.vec3d(apart(i, s[0]), apart(j, s[1]), apart(k, s[2]))
                at_node = velocity[base[0] + i, base[1] + j, base[2] + k]
                new_v += weight * at_node
                B += (four * weight / h) * wp.outer(at_node, distance)
    v[p] = new_v
    C[p] = B
    x[p] = x[p] + dt * new_v
    F[p] = F[p] + dt * (B * F[p])


def simulation(cube, quadratic):
    """A function that takes so many steps, and one that returns positions and velocities."""
    import numpy as np

    shape = (cube.nodes,) * 3
    x = wp.array(cube.position, dtype=wp.vec3d)
    v = wp.array(cube.velocity, dtype=wp.vec3d)
    F = wp.array(np.tile(np.eye(3), (cube.particles, 1, 1)), dtype=wp.mat33d)
    C = wp.zeros(cube.particles, dtype=wp.mat33d)
    mass = wp.zeros(shape, dtype=wp.float64)
    momentum = wp.zeros(shape, dtype=wp.vec3d)
    force = wp.zeros(shape, dtype=wp.vec3d)
    volume, particle_mass = wp.float64(cube.volume), wp.float64(cube.mass)

    def linear_step():
        force.zero_()
        wp.launch(linear_to_grid, cube.particles, [x, v, F, volume, particle_mass, mass, momentum, force])
        wp.launch(accelerate, shape, [mass, momentum, force])
        wp.launch(grid_to_linear, cube.particles, [x, v, F, momentum, force])

    def quadratic_step():
        wp.launch(quadratic_to_grid, cube.particles, [x, v, C, F, volume, particle_mass, mass, momentum])
        wp.launch(divide, shape, [mass, momentum])
        wp.launch(grid_to_quadratic, cube.particles, [x, v, C, F, momentum])

    def step(count):
        for _ in range(count):
            mass.zero_()
            momentum.zero_()
            quadratic_step() if quadratic else linear_step()
        wp.synchronize()

    return step, lambda: (x.numpy(), v.numpy())


def main():
    wp.config.quiet = True
    wp.init()
    wp.set_device("cpu")
    asked = arguments()
    cube = Cube(asked.cells)
    results = []
    for basis, quadratic in [("linear", False), ("quadratic", True)]:
        step, check = simulation(cube, quadratic)
        results.append(
            measure(asked, cube, step, check, program="Warp", version=wp.config.version, basis=basis)
        )
    report(asked, results)


if __name__ == "__main__":
    main()
