"""Shapes, by the words of scene files: each function gives the table that a file has under `shape`.

Lengths are numbers [m], or text with a unit or a formula; angles are numbers [rad], or text (`"30 deg"`). Places and
directions are sequences of two of them in the plane, (2,), and of three in space, (3,); directions may have any length.
What is None has the default of the scene file. A shape that is text is the name of one that `Scene.shape` gave.
"""

from __future__ import annotations

from typing import Any

Shape = dict[str, Any]


def ball(center: Any, radius: Any) -> Shape:
    """A ball; in the plane a disk: `center` (2,) or (3,) and `radius` [m]."""
    return {"ball": {"center": center, "radius": radius}}


def disk(center: Any, radius: Any) -> Shape:
    """A disk in the plane, the same as `ball`: `center` (2,) and `radius` [m]."""
    return ball(center, radius)


def box(min: Any, max: Any) -> Shape:
    """A box with faces across the axes, between its corners `min` and `max`, (2,) or (3,) [m]."""
    return {"box": {"min": min, "max": max}}


def cylinder(start: Any, end: Any, radius: Any) -> Shape:
    """A cylinder between the centres of its ends, `start` and `end` (3,), with a `radius` [m]; space only."""
    return {"cylinder": {"start": start, "end": end, "radius": radius}}


def cone(start: Any, end: Any, start_radius: Any, end_radius: Any = None) -> Shape:
    """A cone between the centres of its ends, `start` and `end` (3,), with the radius of each [m]; space only.

    By default it has a tip at the end.
    """
    return {"cone": {"start": start, "end": end, "start_radius": start_radius, "end_radius": end_radius}}


def ring(center: Any, inner_radius: Any, outer_radius: Any, axis: Any = None, width: Any = None) -> Shape:
    """A disk with a hole: `center` (2,) or (3,), radii [m]; in space a cylinder with a bore along `axis` (3,).

    `width` is its extent along the axis [m].
    """
    radii = {"inner_radius": inner_radius, "outer_radius": outer_radius}
    return {"ring": {"center": center, **radii, "axis": axis, "width": width}}


def capsule(start: Any, end: Any, radius: Any) -> Shape:
    """A cylinder with half a ball on each of its ends `start` and `end`, (2,) or (3,), with a `radius` [m].

    In the plane it is a rectangle with half a disk on each.
    """
    return {"capsule": {"start": start, "end": end, "radius": radius}}


def rounded_box(min: Any, max: Any, rounding: Any) -> Shape:
    """A box between the corners `min` and `max`, (2,) or (3,) [m].

    Its edges and corners have the radius `rounding` [m].
    """
    return {"rounded_box": {"min": min, "max": max, "rounding": rounding}}


def ellipsoid(center: Any, semi_axes: Any) -> Shape:
    """An ellipsoid with axes along those of space; in the plane an ellipse.

    `center` and `semi_axes`, half of its extent along each axis, are (2,) or (3,) [m].
    """
    return {"ellipsoid": {"center": center, "semi_axes": semi_axes}}


def superquadric(center: Any, semi_axes: Any, exponent: Any, exponent_along_z: Any = None) -> Shape:
    """From an ellipsoid (exponent 2) nearly to a box (20): `center` and `semi_axes`, (2,) or (3,) [m].

    `exponent_along_z` is by default as `exponent`; in the plane it is a superellipse.
    """
    exponents = {"exponent": exponent, "exponent_along_z": exponent_along_z}
    return {"superquadric": {"center": center, "semi_axes": semi_axes, **exponents}}


def torus(center: Any, axis: Any, radius: Any, tube_radius: Any) -> Shape:
    """A round tube around an `axis` (3,) through `center` (3,); space only.

    `radius` is that of the circle in the middle of the tube, `tube_radius` that of the tube [m].
    """
    return {"torus": {"center": center, "axis": axis, "radius": radius, "tube_radius": tube_radius}}


def half_space(point: Any, normal: Any) -> Shape:
    """All that lies behind a plane through `point` [m]; `normal` points out of it; both (2,) or (3,).

    It has no bounds: a rigid floor or wall, or to cut others with.
    """
    return {"half_space": {"point": point, "normal": normal}}


def polygon(points: Any, height: Any = None) -> Shape:
    """A polygon in the plane of x and y with the corners `points` (n, 2) [m].

    In space it is a prism with `height`, its lower and upper z (2,) [m].
    """
    return {"polygon": {"points": points, "height": height}}


def spline(points: Any, height: Any = None) -> Shape:
    """What a smooth closed curve through `points` (n, 2) [m] holds, in the plane of x and y.

    In space it is a prism with `height`, its lower and upper z (2,) [m].
    """
    return {"spline": {"points": points, "height": height}}


def revolved(center: Any, axis: Any, polygon: Any = None, spline: Any = None) -> Shape:
    """What an outline sweeps around the `axis` (3,) through `center` (3,) [m]; space only.

    It is a `polygon` with these corners, or a `spline`, a smooth curve, through these points, (n, 2) [m]: of each its
    distance from the axis, and its place along it from the centre.
    """
    return {"revolved": {"polygon": polygon, "spline": spline, "center": center, "axis": axis}}


def mesh(file: Any, scale: Any = None, translation: Any = None, section: Any = None) -> Shape:
    """A closed surface of triangles in an STL, OBJ or PLY file; in the plane, a section of it.

    `scale` is the length of its unit [m], by default 1 m; `translation` (2,) or (3,) moves it [m]; `section` is the
    height z at which the plane cuts it, after it is scaled [m].
    """
    return {"mesh": {"file": file, "scale": scale, "translation": translation, "section": section}}


def union(*shapes: Shape | str) -> Shape:
    """All that lies in any of them."""
    return {"union": list(shapes)}


def intersection(*shapes: Shape | str) -> Shape:
    """What lies in all of them."""
    return {"intersection": list(shapes)}


def difference(first: Shape | str, *others: Shape | str) -> Shape:
    """The first without the others."""
    return {"difference": [first, *others]}


def rotated(shape: Shape | str, center: Any, angle: Any, axis: Any = None) -> Shape:
    """A shape turned by an `angle` [rad] about the point `center`, (2,) or (3,) [m].

    In space it turns about an `axis` (3,) through that point.
    """
    return {"rotated": {"shape": shape, "center": center, "angle": angle, "axis": axis}}
