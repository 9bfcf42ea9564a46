//! Fitting particles to a shape: rings, shells and boxes of its own instead of a lattice of space, with exact volumes.

use super::Shape;
use super::filling::{ParticleSite, parts};
use super::rings::sectors;
use super::rotation::Rotation;
use super::shells::pieces;
use crate::tensor::{Vector, cross};

/// A plane may miss the centre that it cuts through by this share of the radius.
const ROUND_OFF: f64 = 1e-9;

/// Shapes that particles can be fitted to, as messages say it.
pub const FITTED_SHAPES: &str = "a ball, box or cylinder, turned or not, or half of a ball or a cylinder cut by a half-space through its centre";

/// A shape with particles of its own, in frames of unit vectors.
enum Solid {
    Box {
        min: [f64; 3],
        max: [f64; 3],
    },
    /// `frame[1]` points into the half.
    Disk {
        center: [f64; 3],
        radius: f64,
        frame: [[f64; 3]; 2],
        half: bool,
    },
    /// `frame[2]` runs from the start to the end, `frame[1]` points into the half.
    Cylinder {
        start: [f64; 3],
        length: f64,
        radius: f64,
        frame: [[f64; 3]; 3],
        half: bool,
    },
    /// `frame[2]` points into the half.
    Ball {
        center: [f64; 3],
        radius: f64,
        frame: [[f64; 3]; 3],
        half: bool,
    },
}

/// Whether particles can be fitted to a shape.
pub fn fits(shape: &Shape, dimension: usize) -> bool {
    match shape {
        Shape::Rotated { shape, .. } => fits(shape, dimension),
        shape => solid(shape, dimension).is_some(),
    }
}

/// Particles fitted to a shape, at most `spacing` apart; `None` for a shape that none can be fitted to.
///
/// Their volumes add up to that of the shape, and none is larger than a cube of `spacing`.
pub(super) fn fit(shape: &Shape, spacing: f64, dimension: usize) -> Option<Vec<ParticleSite>> {
    if let Shape::Rotated { shape, center, axis, angle } = shape {
        let rotation = Rotation::new(*center, *axis, *angle, dimension);
        let mut sites = fit(shape, spacing, dimension)?;
        sites.iter_mut().for_each(|site| site.position = rotation.forward(site.position));
        return Some(sites);
    }
    let site = |position, volume| ParticleSite::of_volume(position, volume, dimension);
    Some(match solid(shape, dimension)? {
        Solid::Box { min, max } => in_box(min, max, spacing, dimension),
        Solid::Disk { center, radius, frame, half } => sectors(radius, spacing, half)
            .map(|s| {
                let across = [s.radius * libm::cos(s.angle), s.radius * libm::sin(s.angle)];
                site(placed(center, &frame, &across), s.area)
            })
            .collect(),
        Solid::Cylinder { start, length, radius, frame, half } => {
            let layers = parts(length, spacing);
            let thickness = length / layers as f64;
            let in_layer = |layer: usize| {
                sectors(radius, spacing, half).map(move |s| {
                    let along = (layer as f64 + 0.5) * thickness;
                    let at = [s.radius * libm::cos(s.angle), s.radius * libm::sin(s.angle), along];
                    site(placed(start, &frame, &at), s.area * thickness)
                })
            };
            (0..layers).flat_map(in_layer).collect()
        }
        Solid::Ball { center, radius, frame, half } => pieces(radius, spacing, half)
            .map(|p| site(placed(center, &frame, &p.position), p.volume))
            .collect(),
    })
}

fn solid(shape: &Shape, dimension: usize) -> Option<Solid> {
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    match shape {
        Shape::Box { min, max } => Some(Solid::Box { min: *min, max: *max }),
        &Shape::Ball { center, radius } if dimension == 2 => {
            Some(Solid::Disk { center, radius, frame: [x, y], half: false })
        }
        &Shape::Ball { center, radius } => {
            Some(Solid::Ball { center, radius, frame: [x, y, z], half: false })
        }
        &Shape::Cylinder { start, end, radius } if dimension == 3 => {
            let axis = Vector(end) - Vector(start);
            let frame = upright(axis.direction()?.0);
            Some(Solid::Cylinder { start, length: axis.norm(), radius, frame, half: false })
        }
        Shape::Intersection(shapes) => match &shapes[..] {
            [shape, Shape::HalfSpace { point, normal }] | [Shape::HalfSpace { point, normal }, shape] => {
                let normal = if dimension == 2 { [normal[0], normal[1], 0.0] } else { *normal };
                halved(solid(shape, dimension)?, *point, (-Vector(normal)).direction()?)
            }
            _ => None,
        },
        _ => None,
    }
}

/// The half of a round solid that lies in a direction from a plane through its centre.
fn halved(solid: Solid, point: [f64; 3], inward: Vector<f64, 3>) -> Option<Solid> {
    let on_plane = |center: [f64; 3], radius: f64| {
        inward.dot(Vector(center) - Vector(point)).abs() <= ROUND_OFF * radius
    };
    match solid {
        Solid::Disk { center, radius, half: false, .. } if on_plane(center, radius) => {
            let [a, b, _] = inward.0;
            Some(Solid::Disk { center, radius, frame: [[b, -a, 0.0], inward.0], half: true })
        }
        Solid::Ball { center, radius, half: false, .. } if on_plane(center, radius) => {
            Some(Solid::Ball { center, radius, frame: upright(inward.0), half: true })
        }
        Solid::Cylinder { start, length, radius, frame, half: false }
            if on_plane(start, radius)
                && inward.dot(Vector(frame[2])).abs() * length <= ROUND_OFF * radius =>
        {
            let frame = [cross(inward.0, frame[2]), inward.0, frame[2]];
            Some(Solid::Cylinder { start, length, radius, frame, half: true })
        }
        _ => None,
    }
}

/// A right-handed frame with its third vector along `axis`; along the axes of space where that is, so that a cylinder
/// along z has the rings of a disk in the plane.
fn upright(axis: [f64; 3]) -> [[f64; 3]; 3] {
    let least =
        (0..3).rev().min_by(|&i, &j| axis[i].abs().total_cmp(&axis[j].abs())).expect("three components");
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let first = Vector(cross(other, axis)).direction().expect("the axis is no multiple of the other");
    [first.0, cross(axis, first.0), axis]
}

/// origin + sum of coordinates times the frame's vectors
fn placed(origin: [f64; 3], frame: &[[f64; 3]], coordinates: &[f64]) -> [f64; 3] {
    frame.iter().zip(coordinates).fold(origin, |sum, (e, c)| std::array::from_fn(|k| sum[k] + c * e[k]))
}

/// Equal boxes, as many along each axis as bring them to the spacing or below.
fn in_box(min: [f64; 3], max: [f64; 3], spacing: f64, dimension: usize) -> Vec<ParticleSite> {
    let size: [f64; 3] = std::array::from_fn(|k| if k < dimension { max[k] - min[k] } else { 1.0 });
    let count: [usize; 3] = std::array::from_fn(|k| if k < dimension { parts(size[k], spacing) } else { 1 });
    let volume = (0..3).map(|k| size[k] / count[k] as f64).product();
    let at = |k: usize, i: usize| {
        if k < dimension { min[k] + size[k] * (i as f64 + 0.5) / count[k] as f64 } else { 0.0 }
    };
    let mut sites = Vec::with_capacity(count.iter().product());
    for i in 0..count[0] {
        for j in 0..count[1] {
            sites.extend(
                (0..count[2])
                    .map(|k| ParticleSite::of_volume([at(0, i), at(1, j), at(2, k)], volume, dimension)),
            );
        }
    }
    sites
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::boxed::Box;
    use std::f64::consts::PI;

    fn fitted(shape: &Shape, spacing: f64, dimension: usize) -> Vec<ParticleSite> {
        let sites = fit(shape, spacing, dimension).expect("a shape that can be fitted");
        let most = 0.5 * spacing * (1.0 + 1e-9);
        for site in &sites {
            assert!(shape.contains(site.position, dimension), "{site:?} outside {shape:?}");
            assert!(site.half_width <= most, "{site:?} wider than {most}");
        }
        sites
    }

    fn cut(shape: Shape, point: [f64; 3], normal: [f64; 3]) -> Shape {
        Shape::Intersection(vec![shape, Shape::HalfSpace { point, normal }])
    }

    #[test]
    fn particles_fill_the_exact_volume_of_every_shape() {
        let ball = || Shape::Ball { center: [0.3, -0.2, 0.0], radius: 1.3 };
        let can = || Shape::Cylinder { start: [0.1, 0.2, 0.3], end: [1.1, -0.7, 0.9], radius: 0.6 };
        let axis = [1.0, -0.9, 0.6];
        let slab = || Shape::Box { min: [0.0; 3], max: [1.0, 0.37, 0.21] };
        let turned = |shape| Shape::Rotated {
            shape: Box::new(shape),
            center: [1.0; 3],
            axis: [0.0, 0.0, 1.0],
            angle: 0.7,
        };
        let volume = |shape: &Shape, dimension| shape.volume(dimension).expect("closed form");
        let whole = [ball(), slab(), turned(ball()), turned(slab())];
        for dimension in [2, 3] {
            let mut cases: Vec<(Shape, f64)> =
                whole.iter().map(|shape| (shape.clone(), volume(shape, dimension))).collect();
            cases.push((cut(ball(), [0.3, -0.2, 0.0], [0.6, -0.8, 0.0]), 0.5 * volume(&ball(), dimension)));
            if dimension == 3 {
                cases.push((can(), volume(&can(), 3)));
                cases.push((turned(can()), volume(&can(), 3)));
                cases.push((
                    cut(can(), [0.1, 0.2, 0.3], cross(axis, [0.0, 0.0, 1.0])),
                    0.5 * volume(&can(), 3),
                ));
            }
            for (shape, exact) in cases {
                let sum: f64 = fitted(&shape, 0.11, dimension).iter().map(|site| site.volume).sum();
                assert!((sum / exact - 1.0).abs() < 1e-12, "{shape:?} in {dimension}: {sum} {exact}");
            }
        }
    }

    #[test]
    fn half_a_disk_and_its_other_half_are_the_disk() {
        let disk = || Shape::Ball { center: [1.0, 2.0, 0.0], radius: 0.5 };
        let normal = [0.0, -1.0, 0.0];
        let upper = fitted(&cut(disk(), [0.0, 2.0, 0.0], normal), 0.05, 2);
        let whole = fitted(&disk(), 0.05, 2);
        assert_eq!(2 * upper.len(), whole.len());
        let moment = |sites: &[ParticleSite], k: usize, c: f64| {
            sites.iter().map(|s| s.volume * (s.position[k] - c).powi(2)).sum::<f64>()
        };
        for (k, c) in [(0, 1.0), (1, 2.0)] {
            assert!((2.0 * moment(&upper, k, c) / moment(&whole, k, c) - 1.0).abs() < 1e-12);
            assert!(
                (moment(&whole, k, c) / (0.25 * PI * 0.5f64.powi(4)) - 1.0).abs() < 0.36 * 0.1f64.powi(2)
            );
        }
    }

    #[test]
    fn other_shapes_and_cuts_are_not_fitted() {
        let ball = || Shape::Ball { center: [0.0; 3], radius: 1.0 };
        let wedge =
            Shape::Polygon { points: vec![[0.0, 0.0], [0.0, 3.0], [4.0, 0.0]].into(), height: [0.0, 1.0] };
        let off = cut(ball(), [0.1, 0.0, 0.0], [1.0, 0.0, 0.0]);
        let quarter = cut(cut(ball(), [0.0; 3], [1.0, 0.0, 0.0]), [0.0; 3], [0.0, 1.0, 0.0]);
        for shape in [wedge, off, quarter, Shape::Union(vec![ball(), ball()])] {
            assert!(!fits(&shape, 2) && fit(&shape, 0.1, 2).is_none(), "{shape:?}");
            assert!(!fits(&shape, 3) && fit(&shape, 0.1, 3).is_none(), "{shape:?}");
        }
        assert!(fits(&ball(), 2) && fits(&cut(ball(), [0.0; 3], [1.0, 0.0, 0.0]), 3));
    }
}
