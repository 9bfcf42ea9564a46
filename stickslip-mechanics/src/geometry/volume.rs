//! Exact volumes.

use super::{Shape, polygon};
use crate::tensor::Vector;
use std::f64::consts::PI;

impl Shape {
    /// Volume [m^3], in the plane area [m^2]; `None` where no closed form exists: half-spaces and shapes combined.
    ///
    /// A polygon must not cross itself.
    pub fn volume(&self, dimension: usize) -> Option<f64> {
        match self {
            Shape::Ball { radius, .. } if dimension == 2 => Some(PI * radius * radius),
            Shape::Ball { radius, .. } => Some(4.0 / 3.0 * PI * radius.powi(3)),
            Shape::Box { min, max } => Some((0..dimension).map(|k| max[k] - min[k]).product()),
            Shape::Cylinder { .. } if dimension == 2 => None,
            Shape::Cylinder { start, end, radius } => {
                Some(PI * radius * radius * (Vector(*end) - Vector(*start)).norm())
            }
            Shape::Polygon { points, height } => {
                let depth = if dimension == 2 { 1.0 } else { height[1] - height[0] };
                Some(polygon::area(points) * depth)
            }
            Shape::Mesh(_) if dimension == 2 => None,
            Shape::Mesh(mesh) => Some(mesh.volume()),
            Shape::Revolved(_) if dimension == 2 => None,
            Shape::Revolved(revolved) => Some(revolved.volume()),
            Shape::Curved(curved) => curved.solid().volume(dimension),
            Shape::Rotated { shape, .. } => shape.volume(dimension),
            Shape::HalfSpace { .. } | Shape::Union(_) | Shape::Intersection(_) | Shape::Difference(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simple_solids_have_their_textbook_volumes() {
        let can = Shape::Cylinder { start: [1.0; 3], end: [1.0, 1.0, 4.0], radius: 2.0 };
        assert_eq!((can.volume(3), can.volume(2)), (Some(12.0 * PI), None));
        let wedge =
            Shape::Polygon { points: vec![[0.0, 0.0], [0.0, 3.0], [4.0, 0.0]].into(), height: [1.0, 1.5] };
        assert_eq!((wedge.volume(2), wedge.volume(3)), (Some(6.0), Some(3.0)));
        let slab = Shape::Box { min: [0.0; 3], max: [2.0, 3.0, 5.0] };
        let turned = Shape::Rotated { shape: Box::new(slab), center: [0.0; 3], axis: [1.0; 3], angle: 1.0 };
        assert_eq!((turned.volume(2), turned.volume(3)), (Some(6.0), Some(30.0)));
    }
}
