"""The flying cube in Taichi: explicit MPM in f64 with a neo-Hookean law, written as in Taichi's own examples.

Linear functions: plain MPM (FLIP). Quadratic splines: MLS-MPM (APIC), as `mpm99`. One thread, once as users run it, with
Taichi's parallel loops and their atomic sums, and once with its option to make loops serial.
"""

import taichi as ti

from cube import CELL, LAMBDA, MU, TIME_STEP, Cube, arguments, measure, report


def simulation(cube, serial, quadratic):
    """A function that takes so many steps, and one that returns positions and velocities."""
    ti.init(arch=ti.cpu, default_fp=ti.f64, cpu_max_num_threads=1, log_level=ti.ERROR)
    n, h, dt = cube.nodes, CELL, TIME_STEP
    volume, particle_mass = cube.volume, cube.mass

    x = ti.Vector.field(3, ti.f64, cube.particles)
    v = ti.Vector.field(3, ti.f64, cube.particles)
    C = ti.Matrix.field(3, 3, ti.f64, cube.particles)
    F = ti.Matrix.field(3, 3, ti.f64, cube.particles)
    mass = ti.field(ti.f64, (n, n, n))
    momentum = ti.Vector.field(3, ti.f64, (n, n, n))  # then the velocity
    force = ti.Vector.field(3, ti.f64, (n, n, n))  # then the change of velocity

    x.from_numpy(cube.position)
    v.from_numpy(cube.velocity)

    @ti.kernel
    def begin():
        for p in F:
            F[p] = ti.Matrix.identity(ti.f64, 3)

    @ti.func
    def kirchhoff_stress(F):
        return MU * (F @ F.transpose() - ti.Matrix.identity(ti.f64, 3)) + LAMBDA * ti.log(
            F.determinant()
        ) * ti.Matrix.identity(ti.f64, 3)

    @ti.kernel
    def clear():
        ti.loop_config(serialize=serial)
        for i, j, k in ti.ndrange(n, n, n):
            mass[i, j, k] = 0.0
            momentum[i, j, k] = ti.Vector.zero(ti.f64, 3)
            force[i, j, k] = ti.Vector.zero(ti.f64, 3)

    @ti.kernel
    def linear_to_grid():
        ti.loop_config(serialize=serial)
        for p in range(cube.particles):
            base = ti.floor(x[p] / h).cast(int)
            fx = x[p] / h - base.cast(ti.f64)
            w = [1.0 - fx, fx]
            tau = kirchhoff_stress(F[p])
            for offset in ti.static(ti.ndrange(2, 2, 2)):
                i, j, k = ti.static(offset)
                weight = w[i][0] * w[j][1] * w[k][2]
                gradient = (
                    ti.Vector(
                        [
                            (2 * i - 1) * w[j][1] * w[k][2],
                            (2 * j - 1) * w[i][0] * w[k][2],
                            (2 * k - 1) * w[i][0] * w[j][1],
                        ]
                    )
                    / h
                )
                node = base + ti.Vector([i, j, k])
                mass[node] += weight * particle_mass
                momentum[node] += weight * particle_mass * v[p]
                force[node] -= volume * (tau @ gradient)

    @ti.kernel
    def accelerate():
        ti.loop_config(serialize=serial)
        for i, j, k in ti.ndrange(n, n, n):
            if mass[i, j, k] > 0.0:
                change = dt * force[i, j, k] / mass[i, j, k]
                momentum[i, j, k] = momentum[i, j, k] / mass[i, j, k] + change
                force[i, j, k] = change

    @ti.kernel
    def grid_to_linear():
        ti.loop_config(serialize=serial)
        for p in range(cube.particles):
            base = ti.floor(x[p] / h).cast(int)
            fx = x[p] / h - base.cast(ti.f64)
            w = [1.0 - fx, fx]
            velocity = ti.Vector.zero(ti.f64, 3)
            change = ti.Vector.zero(ti.f64, 3)
            L = ti.Matrix.zero(ti.f64, 3, 3)
            for offset in ti.static(ti.ndrange(2, 2, 2)):
                i, j, k = ti.static(offset)
                weight = w[i][0] * w[j][1] * w[k][2]
                gradient = (
                    ti.Vector(
                        [
                            (2 * i - 1) * w[j][1] * w[k][2],
                            (2 * j - 1) * w[i][0] * w[k][2],
                            (2 * k - 1) * w[i][0] * w[j][1],
                        ]
                    )
                    / h
                )
                node = base + ti.Vector([i, j, k])
                velocity += weight * momentum[node]
                change += weight * force[node]
                L += momentum[node].outer_product(gradient)
            x[p] += dt * velocity
            v[p] += change
            F[p] = F[p] + dt * (L @ F[p])

    @ti.kernel
    def quadratic_to_grid():
        ti.loop_config(serialize=serial)
        for p in range(cube.particles):
            base = ti.floor(x[p] / h - 0.5).cast(int)
            fx = x[p] / h - base.cast(ti.f64)
            w = [0.5 * (1.5 - fx) ** 2, 0.75 - (fx - 1.0) ** 2, 0.5 * (fx - 0.5) ** 2]
            affine = -(dt * 4.0 * volume / h**2) * kirchhoff_stress(F[p]) + particle_mass * C[p]
            for offset in ti.static(ti.ndrange(3, 3, 3)):
                i, j, k = ti.static(offset)
                weight = w[i][0] * w[j][1] * w[k][2]
                distance = (ti.Vector([i, j, k]).cast(ti.f64) - fx) * h
                node = base + ti.Vector([i, j, k])
                mass[node] += weight * particle_mass
                momentum[node] += weight * (particle_mass * v[p] + affine @ distance)

    @ti.kernel
    def divide():
        ti.loop_config(serialize=serial)
        for i, j, k in ti.ndrange(n, n, n):
            if mass[i, j, k] > 0.0:
                momentum[i, j, k] /= mass[i, j, k]

    @ti.kernel
    def grid_to_quadratic():
        ti.loop_config(serialize=serial)
        for p in range(cube.particles):
            base = ti.floor(x[p] / h - 0.5).cast(int)
            fx = x[p] / h - base.cast(ti.f64)
            w = [0.5 * (1.5 - fx) ** 2, 0.75 - (fx - 1.0) ** 2, 0.5 * (fx - 0.5) ** 2]
            velocity = ti.Vector.zero(ti.f64, 3)
            B = ti.Matrix.zero(ti.f64, 3, 3)
            for offset in ti.static(ti.ndrange(3, 3, 3)):
                i, j, k = ti.static(offset)
                weight = w[i][0] * w[j][1] * w[k][2]
                distance = ti.Vector([i, j, k]).cast(ti.f64) - fx
                node = base + ti.Vector([i, j, k])
                velocity += weight * momentum[node]
                B += (4.0 / h) * weight * momentum[node].outer_product(distance)
            v[p] = velocity
            C[p] = B
            x[p] += dt * velocity
            F[p] = F[p] + dt * (B @ F[p])

    begin()
    step_of = {
        False: (clear, linear_to_grid, accelerate, grid_to_linear),
        True: (clear, quadratic_to_grid, divide, grid_to_quadratic),
    }

    def step(count):
        for _ in range(count):
            for kernel in step_of[quadratic]:
                kernel()
        ti.sync()

    return step, lambda: (x.to_numpy(), v.to_numpy())


def main():
    asked = arguments()
    cube = Cube(asked.cells)
    results = []
    for program, serial in [("Taichi", False), ("Taichi, serial loops", True)]:
        for basis, quadratic in [("linear", False), ("quadratic", True)]:
            step, check = simulation(cube, serial, quadratic)
            version = ".".join(map(str, ti.__version__))
            results.append(measure(asked, cube, step, check, program=program, version=version, basis=basis))
    report(asked, results)


if __name__ == "__main__":
    main()
