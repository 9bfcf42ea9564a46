//! Where a grid lies over a shape.

use super::held::HeldFaces;
use super::spline::WIDTH;
use super::{MOST_NODES, NoForm};
use crate::geometry::{Bounds, Shape};
use crate::tensor::Vector;

/// Where a grid lies: its node zero and the directions of its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<const D: usize> {
    /// Undeformed place of node zero [m].
    pub origin: Vector<f64, D>,
    /// Unit vectors along the axes.
    pub axes: [Vector<f64, D>; D],
}

impl<const D: usize> Frame<D> {
    /// That of a grid of cells of this side over a shape, turned as the shape is, and its nodes along each axis.
    ///
    /// The grid lies evenly over the shape's box: so a face that is a whole number of cells from the other has nodes
    /// on it, and there is one node beyond. Where faces of the domain hold the body, it lies along them with nodes on
    /// them.
    ///
    /// # Errors
    /// The shape has no bounds, or is thinner than two cells with its images, or the grid is too large.
    pub fn over(shape: &Shape, cell: f64, faces: &HeldFaces) -> Result<(Self, [usize; D]), NoForm> {
        let (bounds, turn) = upright::<D>(shape, faces)?;
        let size = bounds.size();
        let across = (0..D).fold(f64::INFINITY, |least, a| least.min(size[a] * faces.images(a)));
        if across < 2.0 * cell * (1.0 - 1e-9) {
            return Err(NoForm::Thin(across));
        }
        let spans: [f64; D] = std::array::from_fn(|a| (size[a] / cell).round());
        let nodes = spans.iter().map(|span| span + WIDTH as f64).product();
        if nodes > MOST_NODES {
            return Err(NoForm::Large(nodes));
        }
        let middle = bounds.middle();
        let first = |a: usize| match faces.0[a] {
            [Some(lower), _] => lower.at,
            [None, Some(upper)] => upper.at - cell * spans[a],
            _ => middle[a] - cell * (0.5 * spans[a]),
        };
        let zero = std::array::from_fn(|a| if a < D { first(a) - cell } else { 0.0 });
        let origin = Vector::of(turn.forward(zero));
        let axes = std::array::from_fn(|a| {
            Vector::of(turn.forward(std::array::from_fn(|k| zero[k] + f64::from(u8::from(k == a))))) - origin
        });
        Ok((Frame { origin, axes }, spans.map(|span| span as usize + WIDTH)))
    }

    /// The place that lies so many cells of this side from node zero along the axes [m].
    #[inline]
    pub fn place(&self, cells: Vector<f64, D>, cell: f64) -> Vector<f64, D> {
        (0..D).fold(self.origin, |place, a| place + self.axes[a] * (cells[a] * cell))
    }

    /// How many cells of this side a place lies from node zero along the axes.
    #[inline]
    pub fn cells(&self, place: Vector<f64, D>, cell: f64) -> Vector<f64, D> {
        let arm = place - self.origin;
        Vector::from_fn(|a| arm.dot(self.axes[a]) / cell)
    }

    /// A vector of components along the grid's axes, along those of space.
    #[inline]
    pub fn turned(&self, own: [f64; D]) -> Vector<f64, D> {
        (0..D).fold(Vector::ZERO, |sum, a| sum + self.axes[a] * own[a])
    }
}

/// A turn about a point, or none.
struct Turn {
    of: Option<([f64; 3], [f64; 3], f64)>,
    dimension: usize,
}

impl Turn {
    fn forward(&self, point: [f64; 3]) -> [f64; 3] {
        self.of.map_or(point, |turn| Shape::turned_point(point, turn, self.dimension))
    }
}

/// The box of a shape before it is turned, and its turn; along faces that hold it, its box as it is.
fn upright<const D: usize>(shape: &Shape, faces: &HeldFaces) -> Result<(Bounds, Turn), NoForm> {
    let (shape, of) = match shape {
        Shape::Rotated { shape, center, axis, angle } if faces.is_empty() => {
            (&**shape, Some((*center, *axis, *angle)))
        }
        _ => (shape, None),
    };
    let bounds = shape.bounds(D).filter(Bounds::is_finite).ok_or(NoForm::Unbounded)?;
    Ok((faces.cut(bounds), Turn { of, dimension: D }))
}

#[cfg(test)]
mod tests {
    use super::super::HeldFace;
    use super::*;

    /// A bar between a mirror and a fixed face, cut out of a longer one: the box around it is that of the longer one.
    #[test]
    fn a_grid_ends_at_the_faces_that_hold_it() {
        let whole = Shape::Box { min: [-1.0, 0.0, 0.0], max: [1.0, 0.5, 0.0] };
        let left = Shape::HalfSpace { point: [0.0; 3], normal: [1.0, 0.0, 0.0] };
        let mut faces = HeldFaces::default();
        faces.0[0] =
            [Some(HeldFace { at: 0.0, is_fixed: false }), Some(HeldFace { at: 1.0, is_fixed: true })];
        let bar = Shape::Difference(vec![whole, left]);
        let (frame, counts) = Frame::<2>::over(&bar, 0.1, &faces).expect("a bar of ten cells");
        assert_eq!(counts, [10 + WIDTH, 5 + WIDTH]);
        let last = frame.place(Vector([11.0, 1.0]), 0.1);
        assert!((last - Vector([1.0, 0.0])).norm() < 1e-12, "{last:?}");
    }
}
