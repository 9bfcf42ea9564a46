//! Round numbers for axes, and SI prefixes.

/// Round numbers between two ends, about `count` of them: steps of 1, 2 or 5 times a power of ten.
pub fn ticks(range: [f64; 2], count: usize) -> Vec<f64> {
    let step = step(range, count);
    let slack = 1e-9 * step;
    let first = ((range[0] - slack) / step).ceil() as i64;
    let last = ((range[1] + slack) / step).floor() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

/// Distance between round numbers.
fn step(range: [f64; 2], count: usize) -> f64 {
    let raw = ((range[1] - range[0]) / count.max(1) as f64).max(f64::MIN_POSITIVE);
    let power = 10f64.powf(raw.log10().floor());
    let round = [1.0, 2.0, 5.0, 10.0].into_iter().find(|round| round * power >= raw * 0.999);
    round.unwrap_or(10.0) * power
}

/// A tick's number with as many decimals as its neighbours need.
pub fn label(value: f64, range: [f64; 2], count: usize) -> String {
    let decimals = (-step(range, count).log10() - 1e-9).ceil().clamp(0.0, 9.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        text.trim_start_matches('-').to_owned()
    } else {
        text.replace('-', "\u{2212}")
    }
}

/// A power of 1000 with its SI prefix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prefix {
    /// The letter before the unit.
    pub letter: &'static str,
    /// What a number is divided by.
    pub factor: f64,
}

/// The prefix that brings a magnitude to between 1 and 1000.
pub fn prefix(magnitude: f64) -> Prefix {
    const LETTERS: [(&str, i32); 9] =
        [("n", -9), ("\u{b5}", -6), ("m", -3), ("", 0), ("k", 3), ("M", 6), ("G", 9), ("T", 12), ("P", 15)];
    if magnitude <= 0.0 || !magnitude.is_finite() {
        return Prefix { letter: "", factor: 1.0 };
    }
    let power = (magnitude.log10() / 3.0).floor().clamp(-3.0, 5.0) as i32;
    let (letter, exponent) = LETTERS[(power + 3) as usize];
    Prefix { letter, factor: 10f64.powi(exponent) }
}

/// The prefix for an axis up to this magnitude: none where the numbers read well without, where there is no unit, or
/// where that has a prefix already, as kg has.
pub fn axis_prefix(magnitude: f64, unit: &str) -> Prefix {
    let bare = unit.is_empty() || unit.starts_with("kg");
    if bare || (0.05..1000.0).contains(&magnitude) { prefix(1.0) } else { prefix(magnitude) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(ticks([0.0, 10.0], 5), vec![0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(ticks([-0.3, 0.31], 4), vec![-0.2, 0.0, 0.2]);
    }

    #[test]
    fn labels_have_the_decimals_of_the_step() {
        assert_eq!(label(0.2, [-0.3, 0.31], 4), "0.2");
        assert_eq!(label(-0.0, [-0.3, 0.31], 4), "0.0");
        assert_eq!(label(10.0, [0.0, 10.0], 5), "10");
    }

    #[test]
    fn prefixes_follow_the_magnitude() {
        assert_eq!(prefix(6.0e6).letter, "M");
        assert_eq!(prefix(999.0).letter, "");
        assert_eq!(prefix(0.02).letter, "m");
        assert_eq!(prefix(0.0).letter, "");
        assert_eq!(["Pa", "kg/m³", ""].map(|unit| axis_prefix(2.5e3, unit).letter), ["k", "", ""]);
    }
}
