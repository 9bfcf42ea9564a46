//! Pieces of scenes that benchmarks share.

/// The shape of a box that is turned about the origin by an angle [rad], counterclockwise; along the grid it is a box
/// itself.
pub fn turned_box(min: [f64; 2], max: [f64; 2], angle: f64) -> String {
    if angle == 0.0 {
        return format!("shape.box = {{ min = {min:?}, max = {max:?} }}");
    }
    format!(
        "shape.rotated = {{ shape.box = {{ min = {min:?}, max = {max:?} }}, center = [0, 0], angle = {angle} }}"
    )
}

/// The scene's text with another value for a parameter, which stands on a line of its own.
pub fn with_parameter(scene: &str, name: &str, value: &str) -> String {
    let sets = |line: &str| line.strip_prefix(name).is_some_and(|rest| rest.trim_start().starts_with('='));
    let line = |line: &str| if sets(line) { format!("{name} = {value}\n") } else { format!("{line}\n") };
    scene.lines().map(line).collect()
}

#[test]
fn a_parameter_is_replaced_and_its_namesakes_stay() {
    let text = "cells = 8   # per radius\ncells_more = 2\ncell = \"cells\"\n";
    assert_eq!(with_parameter(text, "cells", "4"), "cells = 4\ncells_more = 2\ncell = \"cells\"\n");
}
