//! Which faces of the domain hold a body on a grid of its own.

use super::{Body, Face, Scene};
use crate::geometry::Bounds;
use crate::geometry::form::{HeldFace, HeldFaces};

/// How near to a face a body ends that lies on it [cells].
const ON: f64 = 1e-9;

/// Points along the largest side of a body, for what of its surface lies on a face: at most two a cell.
const POINTS: f64 = 100.0;

impl Scene {
    /// The mirrors and fixed faces of the domain on which a part of a body's surface lies. A body that touches one at a
    /// point or along an edge alone meets it as a wall.
    pub fn held_faces(&self, body: &Body) -> HeldFaces {
        let (axes, cell) = (self.dimension.axes(), self.discretization.cell);
        let mut held = HeldFaces::default();
        let (Some(domain), Some(bounds)) = (&self.domain, body.shape.bounds(axes)) else { return held };
        for axis in 0..axes {
            let ends = [(domain.min[axis], bounds.min[axis]), (domain.max[axis], bounds.max[axis])];
            for (side, (at, end)) in ends.into_iter().enumerate() {
                let face = domain.faces[axis][side];
                let is_near = (at - end).abs() <= ON * cell.max(at.abs());
                if matches!(face, Face::Symmetry | Face::Fixed) && is_near {
                    held.0[axis][side] = Some(HeldFace { at, is_fixed: face == Face::Fixed });
                }
            }
        }
        if held.is_empty() {
            return held;
        }
        let largest = bounds.size()[..axes].iter().fold(0.0_f64, |most, side| most.max(*side));
        let spacing = (0.5 * cell).max(largest / POINTS);
        let surface = body.shape.surface(spacing, axes, &Bounds::EVERYTHING);
        for (axis, side, face) in HeldFaces(held.0).iter() {
            let mut alone = HeldFaces::default();
            alone.0[axis][side] = Some(face);
            if !surface.iter().any(|point| alone.hold((point.position, point.normal), cell)) {
                held.0[axis][side] = None;
            }
        }
        held
    }
}
