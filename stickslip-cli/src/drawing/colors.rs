//! Colours for bodies and for values.

/// Red, green and blue from 0 to 1.
pub type Rgb = [f32; 3];

/// The colour times a factor, or mixed towards white where the factor is over 1.
pub fn shaded(color: Rgb, factor: f32) -> Rgb {
    if factor <= 1.0 { color.map(|c| c * factor) } else { color.map(|c| 1.0 - (1.0 - c) * (2.0 - factor)) }
}

/// Colours that values run through.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum ColorMap {
    Viridis,
    Cividis,
    Plasma,
    Inferno,
    Magma,
    Turbo,
    Greys,
    /// From blue over white to red
    RedBlue,
    /// From violet over white to orange
    PurpleOrange,
}

impl ColorMap {
    fn gradient(self) -> colorous::Gradient {
        match self {
            ColorMap::Viridis => colorous::VIRIDIS,
            ColorMap::Cividis => colorous::CIVIDIS,
            ColorMap::Plasma => colorous::PLASMA,
            ColorMap::Inferno => colorous::INFERNO,
            ColorMap::Magma => colorous::MAGMA,
            ColorMap::Turbo => colorous::TURBO,
            ColorMap::Greys => colorous::GREYS,
            ColorMap::RedBlue => colorous::RED_BLUE,
            ColorMap::PurpleOrange => colorous::PURPLE_ORANGE,
        }
    }

    /// Whether its first colour belongs at the upper end: red stands for that, as readers of stress pictures expect.
    fn is_upside_down(self) -> bool {
        matches!(self, ColorMap::RedBlue)
    }
}

/// Colours for values between two ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The values at the two ends.
    pub range: [f64; 2],
    /// The middle of the range is special (zero stress), and the two sides get colours of their own.
    pub diverging: bool,
    /// The colours; without it those that suit.
    pub map: Option<ColorMap>,
}

impl Scale {
    /// The colour of a value; values outside the range get the colour of the nearer end.
    pub fn color(&self, value: f64) -> Rgb {
        let [low, high] = self.range;
        let share = if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 };
        let usual = if self.diverging { ColorMap::RedBlue } else { ColorMap::Viridis };
        let map = self.map.unwrap_or(usual);
        // The darkest violet would swallow light and shadow.
        let dark = if map == ColorMap::Viridis { 0.06 } else { 0.0 };
        let share = if map.is_upside_down() { 1.0 - share } else { dark + (1.0 - dark) * share };
        map.gradient().eval_continuous(share).as_array().map(|c| f32::from(c) / 255.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_outside_the_range_get_the_end_colors() {
        let scale = Scale { range: [0.0, 2.0], diverging: false, map: None };
        assert_eq!(scale.color(-1.0), scale.color(0.0));
        assert_eq!(scale.color(9.0), scale.color(2.0));
    }

    #[test]
    fn the_upper_end_of_a_diverging_scale_is_red() {
        let [red, _, blue] = Scale { range: [-1.0, 1.0], diverging: true, map: None }.color(0.9);
        assert!(red > blue);
        let named = Scale { range: [0.0, 1.0], diverging: false, map: Some(ColorMap::Greys) };
        assert_eq!(named.color(0.0), [1.0; 3]);
    }
}
