//! Volume, centre and second moments of shapes: what a solid body of even density weighs and how it turns.

use super::rotation::Rotation;
use super::{Bounds, Shape};
use crate::tensor::Matrix;

/// Moments of a shape: its volume, its centre, and its second moments about the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeMoments {
    /// Integral of dV [m^3], in the plane area [m^2].
    pub volume: f64,
    /// Integral of x dV over the volume [m].
    pub center: [f64; 3],
    /// Integral of (x - c) (x - c)^T dV [m^5, in the plane m^4].
    pub second: Matrix<f64>,
}

impl ShapeMoments {
    /// Tensor of inertia about the centre over the density, trace(S) I - S with the second moments S [m^5]. In the plane
    /// only its last entry is of use.
    pub fn inertia(&self) -> Matrix<f64> {
        Matrix::IDENTITY * self.second.trace() - self.second
    }
}

/// How often a box is halved before its part in the shape is estimated, in the plane and in space.
const HALVINGS: [u32; 2] = [10, 7];

impl Shape {
    /// Its moments; `None` of a shape without bounds or without anything in it.
    ///
    /// The box that holds the shape is halved along all axes, again and again, where the surface may pass through it.
    /// The smallest boxes, a thousandth of the shape wide in the plane and 1/128 in space, are cut by the plane that
    /// the signed distance at their centres tells. Where a closed form exists the volume is exact
    /// ([`Shape::volume`]), and the second moments follow it. Balls and boxes are exact, turned or not; other moments
    /// are right to 2e-6 in the plane and 2e-4 in space, but of walls that are thinner than the smallest boxes.
    pub fn moments(&self, dimension: usize) -> Option<ShapeMoments> {
        if let Shape::Ball { center, radius } = self {
            let volume = self.volume(dimension)?;
            // R^2 over the axes and two
            let square = radius * radius / (dimension + 2) as f64; // 2 or 3
            let second = |i: usize, j: usize| if i == j && i < dimension { volume * square } else { 0.0 };
            let center = std::array::from_fn(|k| if k < dimension { center[k] } else { 0.0 });
            return Some(ShapeMoments { volume, center, second: Matrix::from_fn(second) });
        }
        if let Shape::Box { min, max } = self {
            let volume = self.volume(dimension)?;
            let side = |k: usize| if k < dimension { max[k] - min[k] } else { 0.0 };
            let second = |i: usize, j: usize| if i == j { volume * side(i) * side(i) / 12.0 } else { 0.0 };
            let center = std::array::from_fn(|k| if k < dimension { 0.5 * (min[k] + max[k]) } else { 0.0 });
            return Some(ShapeMoments { volume, center, second: Matrix::from_fn(second) });
        }
        if let Shape::Rotated { shape, center, axis, angle } = self {
            let still = shape.moments(dimension)?;
            let rotation = Rotation::new(*center, *axis, *angle, dimension);
            let columns: [[f64; 3]; 3] = std::array::from_fn(|k| {
                rotation.turned(std::array::from_fn(|i| f64::from(u8::from(i == k))))
            });
            let turn = Matrix::from_fn(|i, k| columns[k][i]);
            return Some(ShapeMoments {
                center: rotation.forward(still.center),
                second: turn * still.second * turn.transpose(),
                ..still
            });
        }
        let bounds = self.bounds(dimension)?;
        let mut sums = Sums { dimension, origin: bounds.middle(), ..Sums::default() };
        sums.add(self, &bounds, HALVINGS[dimension - 2]);
        if sums.volume <= 0.0 {
            return None;
        }
        let mean = sums.first.map(|x| x / sums.volume);
        let second = Matrix::from_fn(|i, j| sums.second[i][j] - sums.volume * mean[i] * mean[j]);
        let volume = self.volume(dimension).unwrap_or(sums.volume);
        Some(ShapeMoments {
            volume,
            center: std::array::from_fn(|k| sums.origin[k] + mean[k]),
            second: second * (volume / sums.volume),
        })
    }
}

/// Sums over boxes, about `origin`.
#[derive(Default)]
struct Sums {
    dimension: usize,
    origin: [f64; 3],
    volume: f64,
    first: [f64; 3],
    second: [[f64; 3]; 3],
}

impl Sums {
    /// Adds what of a box is in the shape.
    fn add(&mut self, shape: &Shape, bounds: &Bounds, halvings: u32) {
        let axes = 0..self.dimension;
        let (center, size) = (bounds.middle(), bounds.size());
        let level = shape.level(center, self.dimension);
        let half_diagonal = 0.5 * axes.clone().map(|k| size[k] * size[k]).sum::<f64>().sqrt();
        if level.distance >= half_diagonal {
            return;
        }
        if halvings == 0 || level.distance <= -half_diagonal {
            // The width of the box across the surface, along its normal.
            let width = axes.map(|k| size[k] * level.gradient[k].abs()).sum::<f64>();
            let share = if width > 0.0 { (0.5 - level.distance / width).clamp(0.0, 1.0) } else { 1.0 };
            if level.distance <= -half_diagonal || share == 1.0 {
                return self.add_box(center, size, 1.0);
            }
            // The middle of what is beneath the plane.
            let down = 0.5 * (1.0 - share) * width;
            let middle = std::array::from_fn(|k| center[k] - down * level.gradient[k]);
            self.add_box(middle, size, share);
            // It is thinner than the box along the normal.
            let volume = share * size[..self.dimension].iter().product::<f64>();
            let thinner = volume * (share * share - 1.0) * width * width / 12.0;
            for i in 0..self.dimension {
                for j in 0..self.dimension {
                    self.second[i][j] += thinner * level.gradient[i] * level.gradient[j];
                }
            }
            return;
        }
        for corner in 0..1_usize << self.dimension {
            let (mut min, mut max) = (bounds.min, bounds.max);
            for k in 0..self.dimension {
                if corner >> k & 1 == 1 { min[k] = center[k] } else { max[k] = center[k] }
            }
            self.add(shape, &Bounds { min, max }, halvings - 1);
        }
    }

    fn add_box(&mut self, center: [f64; 3], size: [f64; 3], share: f64) {
        let volume = share * size[..self.dimension].iter().product::<f64>();
        let x: [f64; 3] = std::array::from_fn(|k| match k < self.dimension {
            true => center[k] - self.origin[k],
            false => 0.0,
        });
        self.volume += volume;
        for i in 0..self.dimension {
            self.first[i] += volume * x[i];
            self.second[i][i] += volume * size[i] * size[i] / 12.0;
            for j in 0..self.dimension {
                self.second[i][j] += volume * x[i] * x[j];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn off(found: f64, exact: f64) -> f64 {
        (found / exact - 1.0).abs()
    }

    #[test]
    fn a_box_is_exact_turned_or_not() {
        let slab = Shape::Box { min: [1.0, 2.0, 3.0], max: [2.0, 4.0, 6.0] };
        let found = slab.moments(3).expect("a box has moments");
        assert_eq!((found.volume, found.center), (6.0, [1.5, 3.0, 4.5]));
        let inertia = found.inertia();
        for (i, exact) in [0.5 * (4.0 + 9.0), 0.5 * (1.0 + 9.0), 0.5 * (1.0 + 4.0)].into_iter().enumerate() {
            assert!(off(inertia.0[i][i], exact) < 1e-12, "{inertia:?}");
        }
        let turned =
            Shape::Rotated { shape: Box::new(slab), center: [0.0; 3], axis: [0.0, 0.0, 1.0], angle: 0.3 };
        let found = turned.moments(2).expect("it has moments");
        assert!(off(found.inertia().0[2][2], 2.0 / 12.0 * 5.0) < 1e-5, "{found:?}");
    }

    #[test]
    fn balls_are_exact_and_halving_boxes_finds_them() {
        let ball = Shape::Ball { center: [3.0, -1.0, 2.0], radius: 0.7 };
        let halved = Shape::Union(vec![ball.clone()]);
        for (dimension, near) in [(2, 2e-6), (3, 2e-4)] {
            let [exact, found] = [&ball, &halved].map(|shape| shape.moments(dimension).expect("it has"));
            let off = [off(found.volume, exact.volume), off(found.second.0[0][0], exact.second.0[0][0])];
            assert!(off.iter().all(|off| *off < near), "{dimension} dimensions: {off:?}");
            assert!((0..3).all(|i| (found.center[i] - exact.center[i]).abs() < 1e-6), "{found:?}");
        }
        let [disk, solid] = [2, 3].map(|dimension| ball.moments(dimension).expect("a ball has moments"));
        assert!(off(disk.inertia().0[2][2], 0.5 * PI * 0.7_f64.powi(4)) < 1e-12, "{disk:?}");
        let exact = 0.4 * 0.49 * 4.0 / 3.0 * PI * 0.7_f64.powi(3);
        for i in 0..3 {
            assert!(off(solid.inertia().0[i][i], exact) < 1e-12, "{solid:?}");
        }
    }

    #[test]
    fn shapes_combined_have_moments_and_half_spaces_none() {
        let ball = |radius| Shape::Ball { center: [0.0; 3], radius };
        let ring = Shape::Difference(vec![ball(2.0), ball(1.0)]);
        let found = ring.moments(2).expect("a ring has moments");
        assert!(
            off(found.volume, 3.0 * PI) < 1e-5 && off(found.inertia().0[2][2], 7.5 * PI) < 1e-5,
            "{found:?}"
        );
        let floor = Shape::HalfSpace { point: [0.0; 3], normal: [0.0, 1.0, 0.0] };
        assert_eq!(floor.moments(2), None);
    }
}
