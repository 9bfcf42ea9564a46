//! Points of a body's surface, each for a piece of it.

use stickslip_mechanics::geometry::form::{Form, HeldFaces, Weights};
use stickslip_mechanics::geometry::{self, Bounds, Shape};
use stickslip_mechanics::tensor::Vector;

/// A point of the undeformed surface.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint<const D: usize> {
    /// Where it is [m].
    pub place: Vector<f64, D>,
    /// Unit normal, out of the shape.
    pub normal: Vector<f64, D>,
    /// Undeformed area for which it stands [m^2], in the plane length [m].
    pub area: f64,
    /// The functions there.
    pub weights: Weights<D>,
}

/// Distance of neighbouring points over the cell.
pub const SPACING: f64 = 0.5;

/// Points of the surface of a shape with this grid.
pub fn points<const D: usize>(shape: &Shape, form: &Form<D>) -> Vec<SurfacePoint<D>> {
    let point = |point: &geometry::SurfacePoint| {
        let place = Vector::of(point.position);
        SurfacePoint {
            place,
            normal: Vector::of(point.normal),
            area: point.area,
            weights: form.weights(place),
        }
    };
    free_points(shape, (form.cell, &form.faces), D).iter().map(point).collect()
}

/// Where these are, for cells of this side [m]: a part on a face that holds the body is none.
pub fn free_points(
    shape: &Shape,
    (cell, faces): (f64, &HeldFaces),
    dimension: usize,
) -> Vec<geometry::SurfacePoint> {
    let bounds = shape.bounds(dimension).unwrap_or(Bounds::EVERYTHING);
    let mut points = shape.surface(SPACING * cell, dimension, &bounds);
    points.retain(|point| !faces.hold((point.position, point.normal), cell));
    points
}
