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


def cone(start: Any, end: Any, start_radius: Any, end_radius: Any = None) -> Shape:
    """A cone between the centres of its ends, with the radius of each, by default a tip at the end; space only."""
    return {"cone": {"start": start, "end": end, "start_radius": start_radius, "end_radius": end_radius}}


def ring(center: Any, inner_radius: Any, outer_radius: Any, axis: Any = None, width: Any = None) -> Shape:
    """A disk with a hole; in space a cylinder with a bore around `axis`, which is `width` long."""
    radii = {"inner_radius": inner_radius, "outer_radius": outer_radius}
    return {"ring": {"center": center, **radii, "axis": axis, "width": width}}


def capsule(start: Any, end: Any, radius: Any) -> Shape:
    """A cylinder with half a ball on each end; in the plane a rectangle with half a disk on each end."""
    return {"capsule": {"start": start, "end": end, "radius": radius}}


def rounded_box(min: Any, max: Any, rounding: Any) -> Shape:
    """A box whose edges and corners have the radius `rounding`."""
    return {"rounded_box": {"min": min, "max": max, "rounding": rounding}}


def ellipsoid(center: Any, semi_axes: Any) -> Shape:
    """An ellipsoid with axes along those of space; in the plane an ellipse."""
    return {"ellipsoid": {"center": center, "semi_axes": semi_axes}}


def superquadric(center: Any, semi_axes: Any, exponent: Any, exponent_along_z: Any = None) -> Shape:
    """From an ellipsoid (exponent 2) nearly to a box (20); in the plane a superellipse."""
    exponents = {"exponent": exponent, "exponent_along_z": exponent_along_z}
    return {"superquadric": {"center": center, "semi_axes": semi_axes, **exponents}}


def torus(center: Any, axis: Any, radius: Any, tube_radius: Any) -> Shape:
    """A round tube around an axis, with the radii of its circle and of the tube; space only."""
    return {"torus": {"center": center, "axis": axis, "radius": radius, "tube_radius": tube_radius}}


def half_space(point: Any, normal: Any) -> Shape:
    """All that lies behind a plane through `point`; `normal` points out of it. A rigid floor, or to cut others with."""
    return {"half_space": {"point": point, "normal": normal}}


def polygon(points: Any, height: Any = None) -> Shape:
    """A polygon in the plane of x and y; in space a prism with `height`, its lower and upper z."""
    return {"polygon": {"points": points, "height": height}}


def spline(points: Any, height: Any = None) -> Shape:
    """What a smooth closed curve through points holds, in the plane of x and y; in space a prism as of `polygon`."""
    return {"spline": {"points": points, "height": height}}


def revolved(center: Any, axis: Any, polygon: Any = None, spline: Any = None) -> Shape:
    """What an outline sweeps around an axis: corners of a polygon, or points of a smooth curve; space only.

    Each is its distance from the axis and its place along it from the centre.
    """
    return {"revolved": {"polygon": polygon, "spline": spline, "center": center, "axis": axis}}


def mesh(file: Any, scale: Any = None, translation: Any = None) -> Shape:
    """A closed surface of triangles in an STL, OBJ or PLY file; `scale` is its unit of length, by default 1 m."""
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
