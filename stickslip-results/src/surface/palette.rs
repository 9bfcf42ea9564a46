//! Colours of bodies.

/// Colours that stay apart for colour-blind readers, in the order of the bodies.
const BODIES: [[u8; 3]; 10] = [
    [224, 122, 63],
    [126, 150, 176],
    [88, 158, 120],
    [232, 184, 76],
    [150, 110, 170],
    [196, 88, 100],
    [80, 164, 190],
    [166, 136, 106],
    [214, 140, 170],
    [142, 148, 96],
];

/// The colour of a body as screens have it: red, green and blue from 0 to 1.
pub fn body_color(body: usize) -> [f32; 3] {
    BODIES[body % BODIES.len()].map(|c| f32::from(c) / 255.0)
}
