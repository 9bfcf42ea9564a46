//! Small mathematics of measuring: slope, mean, deviation.

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_its_slope_and_a_coin_its_deviation() {
        let line: Vec<_> = [0.5, 1.0, 4.0].map(|x| (x, 3.0 - 2.0 * x)).into();
        assert!((slope(&line) + 2.0).abs() < 1e-14);
        assert_eq!((mean(&[1.0, -1.0]), deviation(&[1.0, -1.0])), (0.0, 1.0));
        assert_eq!(farthest(&[0.5, -2.0, 1.0]), -2.0);
        assert!(farthest(&[0.5, f64::NAN]).is_nan());
    }
}
