//! By how much results of a contact may be off, from how wide it is in cells: what benchmarks measured, and between
//! their points a straight line in logarithms.

use serde::Serialize;
use std::fmt::{self, Display, Formatter};

/// What benchmarks measured with the law `surface`, gimp and two particles a side: radius or half-width of the patch in
/// cells, relative error.
type ErrorTable = [(f64, f64)];

/// Pressure and width of B11's cylinder (book, chapter 13).
const STRESS: &ErrorTable = &[(1.0, 0.32), (2.0, 0.13), (8.0, 0.032)];

/// 1 less the restitution of B12's sphere, whose largest contact has a radius of 0.15 R. What is lost stays mostly as
/// vibration. At 2/3 cells, where the nodes happened to lie well, it was 0.060: left out, as others need not be so
/// lucky.
const REBOUND: &ErrorTable = &[
    (0.25, 0.305),
    (1.0 / 3.0, 0.260),
    (0.5, 0.190),
    (1.0, 0.135),
    (1.5, 0.134),
    (2.0, 0.081),
    (2.5, 0.024),
    (3.0, 0.014),
    (4.0, 0.007),
];

/// What B1's rolling sphere lacks of its way (book, chapter 5).
const MOTION: &ErrorTable = &[(1.0 / 3.0, 0.22), (2.0 / 3.0, 0.05), (4.0 / 3.0, 0.01)];

/// By how much results of a contact may be off. Beyond the benchmarks' points the last line goes on; at most 1: beyond,
/// the grid decides.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Relative error of pressures and widths in the contact [-].
    pub stress: f64,
    /// Relative error of the speed after an impact [-].
    pub rebound: f64,
    /// Relative error of how bodies roll on it [-].
    pub motion: f64,
}

impl Errors {
    /// From the radius or half-width of the patch in cells.
    pub fn of(cells: f64) -> Self {
        let [stress, rebound, motion] = [STRESS, REBOUND, MOTION].map(|points| between(points, cells));
        Errors { stress, rebound, motion }
    }
}

/// The measured error at `cells`, on straight lines in logarithms through the points.
fn between(points: &ErrorTable, cells: f64) -> f64 {
    let upper =
        points.iter().position(|&(at, _)| at >= cells).unwrap_or(points.len()).clamp(1, points.len() - 1);
    let [(x0, y0), (x1, y1)] = [points[upper - 1], points[upper]];
    let share = (cells / x0).ln() / (x1 / x0).ln();
    (y0 * (y1 / y0).powf(share)).min(1.0)
}

impl Display for Errors {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let percent = |error: f64| match error {
            error if error >= 1.0 => "100 % and more".to_string(),
            error if error >= 0.1 => format!("{:.0} %", 100.0 * error),
            error => format!("{:.1} %", 100.0 * error),
        };
        let Errors { stress, rebound, motion } = self;
        let [stress, rebound, motion] = [stress, rebound, motion].map(|&error| percent(error));
        write!(f, "pressure and width may be off by {stress}, rebounds by {rebound}, rolling by {motion}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_estimate_goes_through_what_benchmarks_measured() {
        for (points, of) in [
            (STRESS, (|errors| errors.stress) as fn(Errors) -> f64),
            (REBOUND, |errors| errors.rebound),
            (MOTION, |errors| errors.motion),
        ] {
            for &(cells, measured) in points {
                assert!((of(Errors::of(cells)) / measured - 1.0).abs() < 1e-12, "{cells}");
            }
        }
        // B12 at a/h = 2: e = 0.919, where a power through 1 and 4 had 0.97.
        assert!((Errors::of(2.0).rebound - 0.081).abs() < 1e-3);
    }

    #[test]
    fn wider_contacts_are_never_less_exact() {
        let all: Vec<_> = (1..400).map(|i| Errors::of(0.05 * f64::from(i))).collect();
        for pair in all.windows(2) {
            assert!(pair[1].stress <= pair[0].stress && pair[1].rebound <= pair[0].rebound);
            assert!(pair[1].motion <= pair[0].motion);
        }
        assert_eq!(Errors::of(0.001), Errors { stress: 1.0, rebound: 1.0, motion: 1.0 });
    }
}
