"""Makes the meshes and images of the gallery's scenes; NumPy is all that it needs."""

import struct
import zlib
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent


def write_png(name, pixels):
    """A picture of greys, the first row on top."""
    height, width = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels.astype(np.uint8))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    data = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
    (HERE / name).write_bytes(b"\x89PNG\r\n\x1a\n" + data)


def write_stl(name, triangles):
    """Triangles, (n, 3, 3), counterclockwise from outside."""
    triangles = np.asarray(triangles, dtype="<f4")
    with open(HERE / name, "wb") as file:
        file.write(bytes(80) + struct.pack("<I", len(triangles)))
        for corners in triangles:
            file.write(bytes(12) + corners.tobytes() + bytes(2))


def spread(count, size, least, rng):
    """Places in a square that are at least so far apart, images beyond its sides not counted."""
    places = []
    while len(places) < count:
        place = rng.uniform(0, size, 2)
        if all(np.hypot(*(place - other)) > least for other in places):
            places.append(place)
    return np.array(places)


def nearest_two(places, size):
    """At each pixel, the number of the nearest place, and how much further the second is."""
    y, x = np.mgrid[0:size, 0:size] + 0.5
    away = np.hypot(x[..., None] - places[:, 0], y[..., None] - places[:, 1])
    order = np.argpartition(away, 1, axis=-1)[..., :2]
    two = np.take_along_axis(away, order, -1)
    swap = two[..., 0] > two[..., 1]
    first = np.where(swap, order[..., 1], order[..., 0])
    second = np.where(swap, order[..., 0], order[..., 1])
    apart = np.hypot(*(places[first] - places[second]).transpose(2, 0, 1))
    # Distance from the wall between the two.
    wall = np.abs(two[..., 1] ** 2 - two[..., 0] ** 2) / (2 * apart)
    return first, wall


def crystals():
    """Labels: crystals are the cells of a Voronoi diagram, the binder between them is 255. Each two neighbours have a
    layer of their own thickness between them, down to none, and where three meet is a pocket."""
    size, rng = 200, np.random.default_rng(1)
    places = spread(32, size, 24, rng)
    thickness = np.triu(rng.uniform(-5, 8, (32, 32)))
    thickness += thickness.T
    y, x = np.mgrid[0:size, 0:size] + 0.5
    away = np.hypot(x[..., None] - places[:, 0], y[..., None] - places[:, 1])
    order = np.argsort(away, axis=-1)[..., :3]
    first, second, third = order.transpose(2, 0, 1)
    to = np.take_along_axis(away, order, -1)
    apart = lambda other: np.hypot(*(places[first] - places[other]).transpose(2, 0, 1))
    wall = lambda k, other: (to[..., k] ** 2 - to[..., 0] ** 2) / (2 * apart(other))
    binder = wall(1, second) < thickness[first, second] / 2
    binder |= wall(1, second) + wall(2, third) < 7
    write_png("crystals.png", np.where(binder, 255, first + 1)[::-1])


def foam():
    """Greys: walls between the cells of a Voronoi diagram, with a skin above and below."""
    size = 160
    first, wall = nearest_two(spread(30, size, 22, np.random.default_rng(2)), size)
    y = np.mgrid[0:size, 0:size][0] + 0.5
    wall = np.minimum(wall, np.minimum(y, size - y) - 2)
    write_png("foam.png", np.clip(128 + 128 * (2 - wall), 0, 255)[::-1])


def tread():
    """A block of 20 x 16 x 10 mm with two sipes of 1.5 mm from below, as columns of boxes that share their faces."""
    x = [0.0, 5.75, 7.25, 12.75, 14.25, 20.0]
    y, z = [0.0, 16.0], [0.0, 6.0, 10.0]
    solid = np.ones((5, 1, 2), bool)
    solid[1, 0, 0] = solid[3, 0, 0] = False
    triangles = []
    for i, j, k in np.argwhere(solid):
        corner = lambda a, b, c: (x[i + a], y[j + b], z[k + c])
        for axis in range(3):
            for side in (0, 1):
                beside = [i, j, k]
                beside[axis] += 1 if side else -1
                inside = all(0 <= n < m for n, m in zip(beside, solid.shape)) and solid[tuple(beside)]
                if inside:
                    continue
                square = []
                for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    place = [0, 0, 0]
                    place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3] = side, u, v
                    square.append(corner(*place))
                if not side:
                    square.reverse()
                triangles += [[square[0], square[1], square[2]], [square[0], square[2], square[3]]]
    write_stl("tread.stl", triangles)


def gear(name, teeth, module=2.0, width=8.0, bore=6.0, backlash=0.05, sides=8):
    """A spur gear with involute teeth, pressure angle 20 degrees, around z: a ring between bore and roots, and strips
    between the flanks of each tooth. Lengths are in millimetres; a flank of the teeth has so many sides."""
    pitch, angle = teeth * module / 2, np.radians(20)
    base, tip, root = pitch * np.cos(angle), pitch + module, pitch - 1.25 * module
    involute = lambda radius: np.sqrt((radius / base) ** 2 - 1) - np.arctan(np.sqrt((radius / base) ** 2 - 1))
    half = np.pi / (2 * teeth) - backlash / (2 * pitch) + involute(pitch)
    # As long sides at the foot, where the involute curves most, as at the tip.
    radii = base * np.sqrt(1 + np.linspace(0, np.sqrt((tip / base) ** 2 - 1), sides + 1) ** 2)
    flank = [(root, half)] + [(radius, half - involute(radius)) for radius in radii]
    triangles = []
    corner = lambda radius, turn, z: (radius * np.cos(turn), radius * np.sin(turn), z)

    def square(a, b, c, d):
        triangles.extend([[a, b, c], [a, c, d]])

    def wall(p, q):
        square(corner(*p, 0), corner(*q, 0), corner(*q, width), corner(*p, width))

    def face(p, q, r, s):
        square(*(corner(*point, width) for point in (p, q, r, s)))
        square(*(corner(*point, 0) for point in (s, r, q, p)))

    for tooth in range(teeth):
        # The ends of a turn have the same corners to the last digit.
        turn = lambda number: 2 * np.pi * (number % teeth) / teeth
        left = [(radius, turn(tooth) + at) for radius, at in flank]
        right = [(radius, turn(tooth) - at) for radius, at in flank]
        onward = (root, turn(tooth + 1) - half)
        for i in range(len(flank) - 1):
            wall(right[i], right[i + 1])
            wall(left[i + 1], left[i])
            face(right[i], right[i + 1], left[i + 1], left[i])
        wall(right[-1], left[-1])
        wall(left[0], onward)
        for p, q in ((right[0], left[0]), (left[0], onward)):
            inner = [(bore, p[1]), (bore, q[1])]
            face(inner[0], p, q, inner[1])
            wall(inner[1], inner[0])
    write_stl(name, triangles)


def valley():
    """A slope of 35 degrees with a trough along it that runs out into a plain, closed below. The slope's corner is
    rounded over 20 m."""
    xs, ys = np.linspace(0, 180, 31), np.linspace(0, 80, 17)
    x, y = np.meshgrid(xs, ys, indexing="ij")
    fall = 0.5 * (np.sqrt((x - 60) ** 2 + 400) - (x - 60))
    ground = 5 + 0.7 * fall + 6 * ((y - 40) / 40) ** 2
    n, m = x.shape
    top = [(a, b, c) for a, b, c in zip(x.ravel(), y.ravel(), ground.ravel())]
    bottom = [(a, b, 0.0) for a, b, _ in top]
    number = lambda i, j, below=False: 1 + i * m + j + (n * m if below else 0)
    faces = []
    for i in range(n - 1):
        for j in range(m - 1):
            a, b, c, d = number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)
            faces += [(a, b, c), (a, c, d)]
            faces += [tuple(k + n * m for k in (a, c, b)), tuple(k + n * m for k in (a, d, c))]
    rim = [(i, 0) for i in range(n)] + [(n - 1, j) for j in range(1, m)]
    rim += [(i, m - 1) for i in range(n - 2, -1, -1)] + [(0, j) for j in range(m - 2, 0, -1)]
    for p, q in zip(rim, rim[1:] + rim[:1]):
        a, b, c, d = number(*p, True), number(*q, True), number(*q), number(*p)
        faces += [(a, b, c), (a, c, d)]
    lines = [f"v {a:.6g} {b:.6g} {c:.6g}" for a, b, c in top + bottom] + ["f {} {} {}".format(*face) for face in faces]
    (HERE / "valley.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    crystals()
    foam()
    tread()
    valley()
    gear("pinion.stl", 18)
    gear("gear.stl", 27)
