//! Quadratic B-splines of one axis, on nodes a unit apart.

/// Nodes along an axis at which a place sees functions.
pub const WIDTH: usize = 3;

/// The functions at a place along an axis, and their slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// First of the nodes.
    pub base: i32,
    /// Values [-].
    pub value: [f64; WIDTH],
    /// Slopes [1/cell].
    pub slope: [f64; WIDTH],
}

impl Axis {
    /// At a place, in cells from node zero.
    ///
    /// ```text
    /// N = (1 - r)^2/2,  3/4 - (r - 1/2)^2,  r^2/2        r = x - 1/2 - base in [0, 1)
    /// ```
    #[inline]
    pub fn at(x: f64) -> Self {
        let base = (x - 0.5).floor();
        Self::in_cell(base as i32, x - 0.5 - base)
    }

    /// The same by the functions of a cell, which go on beyond it as polynomials.
    #[inline]
    pub fn in_cell(base: i32, r: f64) -> Self {
        let s = 1.0 - r;
        Axis {
            base,
            value: [0.5 * s * s, 0.75 - (r - 0.5) * (r - 0.5), 0.5 * r * r],
            slope: [-s, 1.0 - 2.0 * r, r],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_sum_to_one_and_reproduce_places() {
        for x in [0.5, 0.7, 1.0, 1.49, 2.5, 3.9] {
            let Axis { base, value, slope } = Axis::at(x);
            let places: [f64; WIDTH] = std::array::from_fn(|i| f64::from(base) + i as f64);
            let sum = |w: [f64; WIDTH], p: &dyn Fn(f64) -> f64| {
                (0..WIDTH).map(|i| w[i] * p(places[i])).sum::<f64>()
            };
            assert!((sum(value, &|_| 1.0) - 1.0).abs() < 1e-15 && (sum(value, &|x| x) - x).abs() < 1e-14);
            assert!(sum(slope, &|_| 1.0).abs() < 1e-15 && (sum(slope, &|x| x) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn slopes_are_those_of_values() {
        let (x, step) = (2.3, 1e-6);
        let [before, at, after] = [x - step, x, x + step].map(Axis::at);
        for i in 0..WIDTH {
            assert!(((after.value[i] - before.value[i]) / (2.0 * step) - at.slope[i]).abs() < 1e-9);
        }
    }
}
