//! The balls of which a shape's surface is made, for estimates of contact.

use super::Shape;
use super::rotation::Rotation;

/// A ball whose surface is part of a shape's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundPart {
    /// Centre [m].
    pub center: [f64; 3],
    /// Radius [m].
    pub radius: f64,
    /// The ball is cut out of the shape: its wall is hollow.
    pub hollow: bool,
    /// From one end of a cylinder to the other [m]; a ball has none.
    pub axis: Option<[f64; 3]>,
}

impl RoundPart {
    /// The ends of a cylinder [m]; a ball has none.
    pub fn ends(&self) -> Option<[[f64; 3]; 2]> {
        let at = |part: f64, axis: [f64; 3]| std::array::from_fn(|k| self.center[k] + part * axis[k]);
        self.axis.map(|axis| [at(-0.5, axis), at(0.5, axis)])
    }
}

impl Shape {
    /// All balls and cylinders that the shape is made of.
    pub fn round_parts(&self, dimension: usize) -> Vec<RoundPart> {
        match self {
            Shape::Ball { center, radius } => {
                vec![RoundPart { center: *center, radius: *radius, hollow: false, axis: None }]
            }
            Shape::Cylinder { start, end, radius } => {
                let axis: [f64; 3] = std::array::from_fn(|k| end[k] - start[k]);
                let center = std::array::from_fn(|k| start[k] + 0.5 * axis[k]);
                vec![RoundPart { center, radius: *radius, hollow: false, axis: Some(axis) }]
            }
            Shape::Box { .. }
            | Shape::HalfSpace { .. }
            | Shape::Polygon { .. }
            | Shape::Mesh(_)
            | Shape::Revolved(_)
            | Shape::Curved(_) => vec![],
            Shape::Union(shapes) | Shape::Intersection(shapes) => {
                shapes.iter().flat_map(|shape| shape.round_parts(dimension)).collect()
            }
            Shape::Difference(shapes) => {
                let mut parts: Vec<_> = shapes.iter().map(|shape| shape.round_parts(dimension)).collect();
                for part in parts.iter_mut().skip(1).flatten() {
                    part.hollow = !part.hollow;
                }
                parts.concat()
            }
            Shape::Rotated { shape, center, axis, angle } => {
                let rotation = Rotation::new(*center, *axis, *angle, dimension);
                let parts = shape.round_parts(dimension).into_iter();
                parts
                    .map(|part| RoundPart {
                        center: rotation.forward(part.center),
                        axis: part.axis.map(|axis| rotation.turned(axis)),
                        ..part
                    })
                    .collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shell_has_an_outer_and_a_hollow_ball_turned_with_it() {
        let ball = |radius| Shape::Ball { center: [1.0, 0.0, 0.0], radius };
        let shell = Box::new(Shape::Difference(vec![ball(1.0), ball(0.8)]));
        let angle = std::f64::consts::FRAC_PI_2;
        let turned = Shape::Rotated { shape: shell, center: [0.0; 3], axis: [0.0, 0.0, 1.0], angle };
        let parts = turned.round_parts(3);
        assert_eq!(
            [(parts[0].radius, parts[0].hollow), (parts[1].radius, parts[1].hollow)],
            [(1.0, false), (0.8, true)]
        );
        assert!((parts[0].center[1] - 1.0).abs() < 1e-15 && parts[0].center[0].abs() < 1e-15);
    }
}
