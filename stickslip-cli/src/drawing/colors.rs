//! Colours for bodies and for values.

/// Red, green and blue from 0 to 1.
pub type Rgb = [f32; 3];

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

/// The colour of a body.
pub fn body_color(body: usize) -> Rgb {
    BODIES[body % BODIES.len()].map(|c| f32::from(c) / 255.0)
}

/// The colour times a factor, or mixed towards white where the factor is over 1.
pub fn shaded(color: Rgb, factor: f32) -> Rgb {
    if factor <= 1.0 { color.map(|c| c * factor) } else { color.map(|c| 1.0 - (1.0 - c) * (2.0 - factor)) }
}

/// Colours for values between two ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The values at the two ends.
    pub range: [f64; 2],
    /// The middle of the range is special (zero stress), and the two sides get colours of their own.
    pub diverging: bool,
}

impl Scale {
    /// The colour of a value; values outside the range get the colour of the nearer end.
    pub fn color(&self, value: f64) -> Rgb {
        let [low, high] = self.range;
        let share = if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 };
        let gradient = if self.diverging { colorous::RED_BLUE } else { colorous::VIRIDIS };
        // Red stands for the upper end, as readers of stress pictures expect.
        // The darkest violet would swallow light and shadow.
        let share = if self.diverging { 1.0 - share } else { 0.06 + 0.94 * share };
        gradient.eval_continuous(share).as_array().map(|c| f32::from(c) / 255.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_outside_the_range_get_the_end_colors() {
        let scale = Scale { range: [0.0, 2.0], diverging: false };
        assert_eq!(scale.color(-1.0), scale.color(0.0));
        assert_eq!(scale.color(9.0), scale.color(2.0));
    }

    #[test]
    fn the_upper_end_of_a_diverging_scale_is_red() {
        let [red, _, blue] = Scale { range: [-1.0, 1.0], diverging: true }.color(0.9);
        assert!(red > blue);
    }
}
