//! The surface of a shape as points that each stand for a piece of it.

use super::filling::parts;
use super::rings::sectors;
use super::rotation::Rotation;
use super::{Bounds, Shape, polygon, zero_level};
use crate::tensor::{Vector, cross};
use std::f64::consts::PI;

/// A point that stands for a piece of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Where it is [m]; in the plane z is zero.
    pub position: [f64; 3],
    /// Unit normal, out of the shape.
    pub normal: [f64; 3],
    /// Area of the piece [m^2], in the plane its length [m].
    pub area: f64,
}

/// How far points are moved off a surface to see what is on either side, over the spacing.
const OFF: f64 = 1e-4;

impl Shape {
    /// Points of the shape's surface, each for a piece of at most about `spacing` across [m]. Areas of simple shapes
    /// are exact; where shapes cut each other, a piece is there or not as its point is.
    ///
    /// What is nowhere near `bounds` is left out: planes without end are covered only there. In the plane, what is of
    /// space only has no surface.
    pub fn surface(&self, spacing: f64, dimension: usize, bounds: &Bounds) -> Vec<SurfacePoint> {
        match self {
            Shape::Ball { center, radius } if dimension == 2 => circle(*center, *radius, spacing),
            Shape::Ball { center, radius } => sphere(*center, *radius, spacing),
            Shape::Box { min, max } => {
                // Faces of a box that is cut off here lie beside whatever it is part of.
                let near = Bounds { min: *min, max: *max }.intersected(&bounds.grown(2.0 * spacing));
                if near.is_empty() { Vec::new() } else { cuboid((near.min, near.max), spacing, dimension) }
            }
            Shape::Cylinder { .. } | Shape::Mesh(_) | Shape::Revolved(_) if dimension == 2 => Vec::new(),
            Shape::Cylinder { start, end, radius } => cylinder(*start, *end, *radius, spacing),
            Shape::HalfSpace { point, normal } => plane(*point, *normal, spacing, (dimension, bounds)),
            Shape::Polygon { points, height } => prism(points, *height, spacing, dimension),
            Shape::Mesh(mesh) => {
                mesh.triangle_corners().flat_map(|corners| triangle(corners, spacing)).collect()
            }
            Shape::Revolved(revolved) => revolved.surface(spacing),
            Shape::Curved(curved) => {
                let solid = curved.solid();
                zero_level::pieces(
                    &|x| solid.level(x, dimension),
                    &solid.bounds(dimension),
                    spacing,
                    dimension,
                )
            }
            Shape::Union(shapes) | Shape::Intersection(shapes) | Shape::Difference(shapes) => {
                self.seams((shapes, spacing), dimension, bounds)
            }
            Shape::Rotated { shape, center, axis, angle } => {
                let rotation = Rotation::new(*center, *axis, *angle, dimension);
                // A box around all turns of the bounds about the centre.
                let reach =
                    |k: usize| (bounds.min[k] - center[k]).abs().max((bounds.max[k] - center[k]).abs());
                let far = (0..dimension).map(|k| reach(k).powi(2)).sum::<f64>().sqrt();
                let around = Bounds { min: center.map(|x| x - far), max: center.map(|x| x + far) };
                let turned = |point: SurfacePoint| SurfacePoint {
                    position: rotation.forward(point.position),
                    normal: rotation.turned(point.normal),
                    ..point
                };
                shape.surface(spacing, dimension, &around).into_iter().map(turned).collect()
            }
        }
    }

    /// Of shapes combined: those points of each that have the whole inside on one side and outside on the other.
    /// Where the surfaces of several coincide, the first of them has it.
    fn seams(
        &self,
        (shapes, spacing): (&[Shape], f64),
        dimension: usize,
        bounds: &Bounds,
    ) -> Vec<SurfacePoint> {
        let off = OFF * spacing;
        let mut points = Vec::new();
        for (i, shape) in shapes.iter().enumerate() {
            let near = bounds.grown(spacing);
            let near = |p: &SurfacePoint| {
                (0..dimension).all(|k| near.min[k] <= p.position[k] && p.position[k] <= near.max[k])
            };
            for point in shape.surface(spacing, dimension, bounds).into_iter().filter(near) {
                let at = |way: f64| std::array::from_fn(|k| point.position[k] + way * off * point.normal[k]);
                let sides = |shape: &Shape| [-1.0, 1.0].map(|way| shape.contains(at(way), dimension));
                let [below, above] = sides(self);
                let earlier = |other: &Shape| {
                    let [below, above] = sides(other);
                    below != above
                };
                if below != above && !shapes[..i].iter().any(earlier) {
                    let normal = if below { point.normal } else { point.normal.map(|n| -n) };
                    points.push(SurfacePoint { normal, ..point });
                }
            }
        }
        points
    }
}

/// a + factor b
fn plus(a: [f64; 3], b: [f64; 3], factor: f64) -> [f64; 3] {
    (Vector(a) + Vector(b) * factor).0
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    (Vector(a) / Vector(a).norm()).0
}

/// Middles of equal parts of an interval, none longer than `spacing`, and the length of a part.
pub(super) fn middles([from, to]: [f64; 2], spacing: f64) -> (impl Iterator<Item = f64> + Clone, f64) {
    let count = parts(to - from, spacing);
    let part = (to - from) / count as f64;
    ((0..count).map(move |i| from + (i as f64 + 0.5) * part), part)
}

/// Middles of equal parts of a full turn, and the angle of a part: as many in each quarter, so that planes through the
/// centre along the axes cut none.
pub(super) fn turn(spacing: f64) -> (impl Iterator<Item = f64> + Clone, f64) {
    let quarter = parts(0.5 * PI, spacing);
    middles([0.0, 2.0 * PI], 0.5 * PI / quarter as f64)
}

fn circle(center: [f64; 3], radius: f64, spacing: f64) -> Vec<SurfacePoint> {
    let (angles, part) = turn(spacing / radius);
    let point = |angle: f64| {
        let normal = [libm::cos(angle), libm::sin(angle), 0.0];
        let position = plus([center[0], center[1], 0.0], normal, radius);
        SurfacePoint { position, normal, area: radius * part }
    };
    angles.map(point).collect()
}

/// Belts around z, each in equal pieces of exactly its area.
fn sphere(center: [f64; 3], radius: f64, spacing: f64) -> Vec<SurfacePoint> {
    let half = parts(0.5 * PI, spacing / radius);
    let (belts, width) = middles([0.0, PI], 0.5 * PI / half as f64);
    let mut points = Vec::new();
    for polar in belts {
        let area =
            2.0 * PI * radius * radius * (libm::cos(polar - 0.5 * width) - libm::cos(polar + 0.5 * width));
        let (angles, part) = turn(spacing / (radius * libm::sin(polar)));
        for angle in angles {
            let across = libm::sin(polar);
            let normal = [across * libm::cos(angle), across * libm::sin(angle), libm::cos(polar)];
            points.push(SurfacePoint {
                position: plus(center, normal, radius),
                normal,
                area: area * part / (2.0 * PI),
            });
        }
    }
    points
}

fn cuboid((min, max): ([f64; 3], [f64; 3]), spacing: f64, dimension: usize) -> Vec<SurfacePoint> {
    let mut points = Vec::new();
    for axis in 0..dimension {
        // The other axes; the third of the plane has one part of no extent.
        let [second, third] = [(axis + 1) % dimension, (axis + 2) % dimension];
        for (at, sign) in [(min[axis], -1.0), (max[axis], 1.0)] {
            let mut normal = [0.0; 3];
            normal[axis] = sign;
            let (along, length) = middles([min[second], max[second]], spacing);
            for x in along {
                let mut position = [0.0; 3];
                (position[axis], position[second]) = (at, x);
                if dimension == 2 {
                    points.push(SurfacePoint { position, normal, area: length });
                    continue;
                }
                let (across, width) = middles([min[third], max[third]], spacing);
                for y in across {
                    position[third] = y;
                    points.push(SurfacePoint { position, normal, area: length * width });
                }
            }
        }
    }
    points
}

/// Two directions at right angles to a unit vector and to each other.
pub(super) fn frame(axis: [f64; 3]) -> [[f64; 3]; 2] {
    let least = (0..3).min_by(|&i, &j| axis[i].abs().total_cmp(&axis[j].abs())).unwrap_or(0);
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let first = unit(cross(axis, other));
    [first, cross(axis, first)]
}

fn cylinder(start: [f64; 3], end: [f64; 3], radius: f64, spacing: f64) -> Vec<SurfacePoint> {
    let whole = Vector(end) - Vector(start);
    let (axis, length) = (unit(whole.0), whole.norm());
    let [first, second] = frame(axis);
    let outward = |angle: f64| plus(first.map(|x| x * libm::cos(angle)), second, libm::sin(angle));
    let (along, part) = middles([0.0, length], spacing);
    let (angles, sector) = turn(spacing / radius);
    let mut points: Vec<_> = along
        .flat_map(|x| angles.clone().map(move |angle| (x, angle)))
        .map(|(x, angle)| {
            let normal = outward(angle);
            let position = plus(plus(start, axis, x), normal, radius);
            SurfacePoint { position, normal, area: part * radius * sector }
        })
        .collect();
    for (center, sign) in [(start, -1.0), (end, 1.0)] {
        points.extend(sectors(radius, spacing, false).map(|sector| SurfacePoint {
            position: plus(center, outward(sector.angle), sector.radius),
            normal: axis.map(|a| sign * a),
            area: sector.area,
        }));
    }
    points
}

/// The part of a plane, in the plane of a line, that is near `bounds`.
fn plane(
    point: [f64; 3],
    normal: [f64; 3],
    spacing: f64,
    (dimension, bounds): (usize, &Bounds),
) -> Vec<SurfacePoint> {
    if !bounds.is_finite() || bounds.is_empty() {
        return Vec::new();
    }
    let normal = unit(std::array::from_fn(|k| if k < dimension { normal[k] } else { 0.0 }));
    let middle: [f64; 3] =
        std::array::from_fn(|k| if k < dimension { 0.5 * (bounds.min[k] + bounds.max[k]) } else { 0.0 });
    let away: f64 = (0..dimension).map(|k| (middle[k] - point[k]) * normal[k]).sum();
    let center = plus(middle, normal, -away);
    let size = bounds.size();
    let half = 0.5 * (0..dimension).map(|k| size[k] * size[k]).sum::<f64>().sqrt();
    let [first, second] =
        if dimension == 2 { [[-normal[1], normal[0], 0.0], [0.0; 3]] } else { frame(normal) };
    let (rows, length) = middles([-half, half], spacing);
    let (columns, width) =
        if dimension == 2 { middles([0.0, 1.0], 1.0) } else { middles([-half, half], spacing) };
    let near = bounds.grown(spacing);
    let inside = |p: &[f64; 3]| (0..dimension).all(|k| near.min[k] <= p[k] && p[k] <= near.max[k]);
    rows.flat_map(|x| columns.clone().map(move |y| plus(plus(center, first, x), second, y)))
        .filter(inside)
        .map(|position| SurfacePoint { position, normal, area: length * width })
        .collect()
}

fn prism(points: &[[f64; 2]], height: [f64; 2], spacing: f64, dimension: usize) -> Vec<SurfacePoint> {
    let mut surface = Vec::new();
    for (a, b, outward) in polygon::sides(points) {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        if length == 0.0 {
            continue;
        }
        let (along, part) = middles([0.0, length], spacing);
        for x in along {
            let [px, py] = [0, 1].map(|k| a[k] + (b[k] - a[k]) * (x / length));
            let normal = [outward[0], outward[1], 0.0];
            if dimension == 2 {
                surface.push(SurfacePoint { position: [px, py, 0.0], normal, area: part });
            } else {
                let (up, width) = middles(height, spacing);
                surface.extend(up.map(|z| SurfacePoint {
                    position: [px, py, z],
                    normal,
                    area: part * width,
                }));
            }
        }
    }
    if dimension == 3 {
        surface.extend(caps(points, height, spacing));
    }
    surface
}

/// The lower and the upper end of a prism, in squares of which those count whose middle is inside, with the polygon's
/// area in all.
fn caps(points: &[[f64; 2]], height: [f64; 2], spacing: f64) -> Vec<SurfacePoint> {
    let bounds = Bounds::around(points.iter().map(|&[x, y]| [x, y, 0.0]));
    let [rows, columns] = [0, 1].map(|k| middles([bounds.min[k], bounds.max[k]], spacing).0);
    let squares: Vec<_> = rows
        .flat_map(|x| columns.clone().map(move |y| [x, y]))
        .filter(|&square| polygon::contains(points, square))
        .collect();
    let area = polygon::area(points) / squares.len() as f64;
    let cap = |(z, sign): (f64, f64)| {
        squares.iter().map(move |&[x, y]| SurfacePoint {
            position: [x, y, z],
            normal: [0.0, 0.0, sign],
            area,
        })
    };
    [(height[0], -1.0), (height[1], 1.0)].into_iter().flat_map(cap).collect()
}

/// A triangle in n^2 equal ones.
fn triangle([a, b, c]: [[f64; 3]; 3], spacing: f64) -> Vec<SurfacePoint> {
    let [first, second] = [b, c].map(|corner| plus(corner, a, -1.0));
    let across = cross(first, second);
    let sides = [first, second, plus(b, c, -1.0)];
    let longest = sides.map(|side| Vector(side).norm()).into_iter().fold(0.0, f64::max);
    let count = parts(longest, spacing);
    let (normal, area) = (unit(across), 0.5 * Vector(across).norm() / (count * count) as f64);
    let at = |i: f64, j: f64| plus(plus(a, first, i / count as f64), second, j / count as f64);
    let mut points = Vec::new();
    for i in 0..count {
        for j in 0..count - i {
            let (x, y) = (i as f64, j as f64);
            points.push(SurfacePoint { position: at(x + 1.0 / 3.0, y + 1.0 / 3.0), normal, area });
            if i + j + 1 < count {
                points.push(SurfacePoint { position: at(x + 2.0 / 3.0, y + 2.0 / 3.0), normal, area });
            }
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(shape: &Shape, dimension: usize) -> Bounds {
        shape.bounds(dimension).expect("bounded")
    }

    /// Volume by the divergence theorem, V = sum A n . x / d, and the sum of A n, which a closed surface has zero.
    fn enclosed(points: &[SurfacePoint], dimension: usize) -> (f64, [f64; 3]) {
        let mut sum = [0.0; 3];
        let mut volume = 0.0;
        for SurfacePoint { position, normal, area } in points {
            for k in 0..3 {
                sum[k] += area * normal[k];
                volume += area * normal[k] * position[k] / dimension as f64;
            }
        }
        (volume, sum)
    }

    fn ball() -> Shape {
        Shape::Ball { center: [0.3, -0.2, 0.1], radius: 0.7 }
    }

    fn block() -> Shape {
        Shape::Box { min: [-0.4, -0.5, -0.3], max: [0.6, 0.2, 0.5] }
    }

    #[test]
    fn surfaces_are_closed_and_hold_the_shapes_volume() {
        let can = Shape::Cylinder { start: [0.0; 3], end: [0.7, 0.4, 0.9], radius: 0.5 };
        let corners = vec![[0.0, 0.0], [1.0, 0.1], [0.5, 0.4], [0.3, 1.0]];
        let prism = Shape::Polygon { points: corners.into(), height: [0.1, 0.8] };
        let ring = Shape::Difference(vec![ball(), Shape::Ball { center: [0.3, -0.2, 0.1], radius: 0.4 }]);
        let turned = Shape::Rotated {
            shape: Box::new(block()),
            center: [0.2, 0.1, 0.0],
            axis: [1.0, 2.0, 0.4],
            angle: 0.7,
        };
        let same = Shape::Union(vec![block(), block()]);
        let halves = [[-0.4, 0.1], [0.1, 0.6]]
            .map(|[from, to]| Shape::Box { min: [from, -0.5, -0.3], max: [to, 0.2, 0.5] });
        let joined = Shape::Union(halves.to_vec());
        let all = [ball(), block(), can, prism, ring, turned, same, joined];
        for (shape, dimension) in all.iter().flat_map(|shape| [(shape, 2), (shape, 3)]) {
            let bounds = around(shape, dimension);
            let points = shape.surface(0.05, dimension, &bounds);
            if points.is_empty() {
                assert!(matches!(shape, Shape::Cylinder { .. }) && dimension == 2);
                continue;
            }
            let (volume, sum) = enclosed(&points, dimension);
            let exact = match shape {
                Shape::Difference(parts) => {
                    [0, 1].map(|i| parts[i].volume(dimension).unwrap()).into_iter().reduce(|a, b| a - b)
                }
                Shape::Union(_) => block().volume(dimension),
                shape => shape.volume(dimension),
            };
            let exact = exact.expect("closed form");
            assert!((volume / exact - 1.0).abs() < 2e-3, "{shape:?} in {dimension}: {volume} for {exact}");
            assert!(sum.iter().all(|s| s.abs() < 1e-9), "{shape:?} in {dimension}: {sum:?}");
        }
    }

    #[test]
    fn a_plane_that_cuts_a_disk_is_part_of_its_surface() {
        let cut = Shape::HalfSpace { point: [0.3, 0.0, 0.0], normal: [1.0, 0.0, 0.0] };
        let half = Shape::Intersection(vec![ball(), cut]);
        let bounds = around(&half, 2);
        let points = half.surface(0.01, 2, &bounds);
        let flat: f64 = points.iter().filter(|point| point.normal == [1.0, 0.0, 0.0]).map(|p| p.area).sum();
        assert!((flat / 1.4 - 1.0).abs() < 0.02, "{flat}");
        let (volume, _) = enclosed(&points, 2);
        assert!((volume / (0.5 * PI * 0.49) - 1.0).abs() < 0.01, "{volume}");
    }
}
