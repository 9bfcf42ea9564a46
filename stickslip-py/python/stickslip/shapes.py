"""Shapes, by the words of scene files: each function gives the table that a file has under `shape`.

Lengths are numbers in metres or text with units; places are sequences of two numbers in the plane, of three in space.
"""

from __future__ import annotations

from typing import Any

Shape = dict[str, Any]


def ball(center: Any, radius: Any) -> Shape:
    """A ball; in the plane a disk."""
    return {"ball": {"center": center, "radius": radius}}


def disk(center: Any, radius: Any) -> Shape:
    """A disk in the plane: the same as `ball`."""
    return ball(center, radius)


def box(min: Any, max: Any) -> Shape:
    """A box with faces across the axes, between its lower and its upper corner."""
    return {"box": {"min": min, "max": max}}


def cylinder(start: Any, end: Any, radius: Any) -> Shape:
    """A cylinder between the centres of its ends; space only."""
    return {"cylinder": {"start": start, "end": end, "radius": radius}}


def half_space(point: Any, normal: Any) -> Shape:
    """All that lies behind a plane through `point`; `normal` points out of it. A rigid floor, or to cut others with."""
    return {"half_space": {"point": point, "normal": normal}}


def polygon(points: Any, height: Any = None) -> Shape:
    """A polygon in the plane of x and y; in space a prism with `height`, its lower and upper z."""
    return {"polygon": {"points": points, "height": height}}


def mesh(file: Any, scale: Any = None, translation: Any = None) -> Shape:
    """A closed surface of triangles in an STL or OBJ file; `scale` is the length of the file's unit, by default 1 m."""
    return {"mesh": {"file": file, "scale": scale, "translation": translation}}


def union(*shapes: Shape) -> Shape:
    """All that lies in any of them."""
    return {"union": list(shapes)}


def intersection(*shapes: Shape) -> Shape:
    """What lies in all of them."""
    return {"intersection": list(shapes)}


def difference(first: Shape, *others: Shape) -> Shape:
    """The first without the others."""
    return {"difference": [first, *others]}


def rotated(shape: Shape, center: Any, angle: Any, axis: Any = None) -> Shape:
    """A shape turned by an angle [rad] about a point that stays, in space about an axis through it."""
    return {"rotated": {"shape": shape, "center": center, "angle": angle, "axis": axis}}
