//! Where a face of one body lies flat on another body.

use super::touch::SAME;
use crate::geometry::Shape;
use crate::scene::Scene;
use crate::tensor::Vector;

/// A flat face of one body that faces another body over its whole width.
pub(super) struct Flat {
    pub pair: [usize; 2],
    pub gap: f64,
    /// Unit vector out of the face, to the other body.
    pub direction: Vector<f64, 3>,
    /// Half of the face's shorter side [m].
    pub half_width: f64,
}

/// Half of the shorter side of the face of a box with which one of two bodies lies flat before the other at the start,
/// the nearest such face [m]; none where no face does.
pub fn lies_flat(scene: &Scene, [a, b]: [usize; 2]) -> Option<f64> {
    let flats = [Flat::of(scene, [a, b]), Flat::of(scene, [b, a])];
    flats.into_iter().flatten().min_by(|a, b| a.gap.total_cmp(&b.gap)).map(|flat| flat.half_width)
}

/// A face of a box.
struct BoxFace {
    center: [f64; 3],
    normal: [f64; 3],
    corners: Vec<[f64; 3]>,
    half_width: f64,
}

impl Flat {
    /// The face of the first body that lies nearest to the second; `None` if none lies flat before it.
    /// Boxes have faces, turned or not.
    pub(super) fn of(scene: &Scene, pair: [usize; 2]) -> Option<Flat> {
        let [first, second] = pair.map(|i| &scene.bodies[i].shape);
        let dimension = scene.dimension.axes();
        let flat = |face: BoxFace| {
            let gap = second.distance(face.center, dimension);
            let round_off = SAME * face.half_width;
            let out = Vector(second.level(face.center, dimension).gradient).dot(Vector(face.normal));
            let even = face
                .corners
                .iter()
                .all(|&corner| (second.distance(corner, dimension) - gap).abs() <= round_off);
            (gap >= -round_off && even && out <= SAME - 1.0).then_some(Flat {
                pair,
                gap,
                direction: Vector(face.normal),
                half_width: face.half_width,
            })
        };
        faces(first, dimension).into_iter().filter_map(flat).min_by(|a, b| a.gap.total_cmp(&b.gap))
    }
}

fn faces(shape: &Shape, dimension: usize) -> Vec<BoxFace> {
    match shape {
        Shape::Box { min, max } => (0..dimension)
            .flat_map(|axis| [(axis, min[axis], -1.0), (axis, max[axis], 1.0)])
            .map(|(axis, at, sign)| {
                let mut normal = [0.0; 3];
                normal[axis] = sign;
                let mut center = std::array::from_fn(|k| 0.5 * (min[k] + max[k]));
                center[axis] = at;
                let across = (0..dimension).filter(|&k| k != axis);
                let shorter = across.map(|k| max[k] - min[k]).fold(f64::INFINITY, f64::min);
                let corner = |i: usize| {
                    let mut corner = std::array::from_fn(|k| if i >> k & 1 == 1 { max[k] } else { min[k] });
                    corner[axis] = at;
                    corner
                };
                BoxFace {
                    center,
                    normal,
                    corners: (0..1 << dimension).map(corner).collect(),
                    half_width: 0.5 * shorter,
                }
            })
            .collect(),
        Shape::Rotated { shape, center, axis, angle } => {
            let turn = |point| Shape::turned_point(point, (*center, *axis, *angle), dimension);
            let turned = |face: BoxFace| {
                let tip = turn(std::array::from_fn(|k| face.center[k] + face.normal[k]));
                let center = turn(face.center);
                BoxFace {
                    center,
                    normal: std::array::from_fn(|k| tip[k] - center[k]),
                    corners: face.corners.into_iter().map(turn).collect(),
                    half_width: face.half_width,
                }
            };
            faces(shape, dimension).into_iter().map(turned).collect()
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::tests::{at_rest, free, scene};
    use crate::scene::Dimension;

    fn flat(first: Shape, second: Shape) -> Option<Flat> {
        let scene = scene(Dimension::Space, 0.1, vec![free("first", 0, first), at_rest("second", second)]);
        Flat::of(&scene, [0, 1])
    }

    #[test]
    fn a_block_lies_on_a_half_space_and_on_a_wider_block_but_not_beyond_its_rim() {
        let block = || Shape::Box { min: [0.0, 0.0, 0.1], max: [1.0, 0.4, 1.0] };
        let floor = || Shape::HalfSpace { point: [0.0; 3], normal: [0.0, 0.0, 1.0] };
        let found = flat(block(), floor()).expect("flat");
        assert!((found.gap - 0.1).abs() < 1e-12 && (found.half_width - 0.2).abs() < 1e-12);
        assert_eq!(found.direction, Vector([0.0, 0.0, -1.0]));
        let slab = |end| Shape::Box { min: [-1.0, -1.0, -1.0], max: [end, 2.0, 0.0] };
        assert!(flat(block(), slab(2.0)).is_some() && flat(block(), slab(0.5)).is_none());
        // Turned together they lie as they lay.
        let turned = |shape| Shape::Rotated {
            shape: Box::new(shape),
            center: [0.3; 3],
            axis: [1.0, 2.0, 0.5],
            angle: 0.7,
        };
        assert!((flat(turned(block()), turned(floor())).expect("flat").gap - 0.1).abs() < 1e-12);
        assert!(flat(turned(block()), floor()).is_none());
    }
}
