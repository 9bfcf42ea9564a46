//! Pieces of scenes that benchmarks share.

/// The shape of a box that is turned about the origin by an angle [rad], counterclockwise; along the grid it is a box itself.
pub fn turned_box(min: [f64; 2], max: [f64; 2], angle: f64) -> String {
    if angle == 0.0 {
        return format!("shape.box = {{ min = {min:?}, max = {max:?} }}");
    }
    format!(
        "shape.rotated = {{ shape.box = {{ min = {min:?}, max = {max:?} }}, center = [0, 0], angle = {angle} }}"
    )
}
