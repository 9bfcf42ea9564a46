//! Small mathematics of measuring: slope, mean, deviation.

/// A mean over time, of a value that steps of unlike length bring.
#[derive(Clone, Copy, Debug, Default)]
pub struct TimeMean {
    sum: f64,
    time: f64,
}

impl TimeMean {
    /// The value that held for `time` [s].
    pub fn add(&mut self, value: f64, time: f64) {
        self.sum += value * time;
        self.time += time;
    }

    /// The mean; not a number if no time has passed.
    pub fn value(&self) -> f64 {
        self.sum / self.time
    }
}

/// Slope of y over x by least squares, from pairs (x, y).
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let x = points.iter().map(|p| p.0).sum::<f64>() / n;
    let y = points.iter().map(|p| p.1).sum::<f64>() / n;
    points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
        / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

/// Arithmetic mean; not a number for no values.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Standard deviation of these very values, not an estimate from a sample.
pub fn deviation(values: &[f64]) -> f64 {
    let center = mean(values);
    (values.iter().map(|x| (x - center).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

/// The value farthest from zero, with its sign; not a number if one of them is not.
pub fn farthest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |far: f64, &x| if x.abs() > far.abs() || x.is_nan() { x } else { far })
}

/// Angular frequency of the wave about a constant that fits pairs (t, y) best, within a fifth of a guess [rad/s].
///
/// ```text
/// min over a, b, c of sum (y - a - b cos wt - c sin wt)^2, the least of it over w
/// ```
pub fn angular_frequency(points: &[(f64, f64)], guess: f64) -> f64 {
    let (mut low, mut high) = (0.8 * guess, 1.2 * guess);
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        if residual(points, low + third) < residual(points, high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    0.5 * (low + high)
}

/// Sum of squares that the best wave of an angular frequency leaves.
fn residual(points: &[(f64, f64)], w: f64) -> f64 {
    // Gram and Schmidt: what each function adds to those before it, and what that explains.
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut left: Vec<f64> = points.iter().map(|p| p.1).collect();
    for function in [|_: f64| 1.0, f64::cos, f64::sin] {
        let mut row: Vec<f64> = points.iter().map(|p| function(w * p.0)).collect();
        for before in &rows {
            let part = dot(&row, before);
            row.iter_mut().zip(before).for_each(|(x, b)| *x -= part * b);
        }
        let size = dot(&row, &row).sqrt();
        row.iter_mut().for_each(|x| *x /= size);
        let part = dot(&left, &row);
        left.iter_mut().zip(&row).for_each(|(x, b)| *x -= part * b);
        rows.push(row);
    }
    dot(&left, &left)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_steps_weigh_more_in_a_mean_over_time() {
        let mut mean = TimeMean::default();
        assert!(mean.value().is_nan());
        mean.add(1.0, 3.0);
        mean.add(5.0, 1.0);
        assert_eq!(mean.value(), 2.0);
    }

    #[test]
    fn a_wave_has_its_frequency_whatever_it_swings_about() {
        let wave = |i: i32| (0.1 * f64::from(i), 3.0 + 0.2 * (0.17 * f64::from(i) + 0.5).sin());
        let points: Vec<_> = (0..60).map(wave).collect();
        assert!((angular_frequency(&points, 1.6) - 1.7).abs() < 1e-6);
    }

    #[test]
    fn a_line_has_its_slope_and_a_coin_its_deviation() {
        let line: Vec<_> = [0.5, 1.0, 4.0].map(|x| (x, 3.0 - 2.0 * x)).into();
        assert!((slope(&line) + 2.0).abs() < 1e-14);
        assert_eq!((mean(&[1.0, -1.0]), deviation(&[1.0, -1.0])), (0.0, 1.0));
        assert_eq!(farthest(&[0.5, -2.0, 1.0]), -2.0);
        assert!(farthest(&[0.5, f64::NAN]).is_nan());
    }
}
