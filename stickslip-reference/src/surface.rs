//! Points of a body's surface, each for a piece of it.

use stickslip_mechanics::geometry::form::{Form, Weights};
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

/// Points of the surface of a shape with this grid: a part on a face that holds the body is none.
pub fn points<const D: usize>(shape: &Shape, form: &Form<D>) -> Vec<SurfacePoint<D>> {
    let bounds = shape.bounds(D).unwrap_or(Bounds::EVERYTHING);
    let all = shape.surface(SPACING * form.cell, D, &bounds).into_iter();
    let is_free =
        |point: &geometry::SurfacePoint| !form.faces.hold((point.position, point.normal), form.cell);
    all.filter(is_free)
        .map(|point| {
            let place = Vector::of(point.position);
            SurfacePoint {
                place,
                normal: Vector::of(point.normal),
                area: point.area,
                weights: form.weights(place),
            }
        })
        .collect()
}
