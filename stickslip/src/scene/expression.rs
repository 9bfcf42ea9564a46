//! Formulas in scene files.

/// A number that may depend on time: `"5 m/s * min(t / (1 ms), 1)"`, compiled.
///
/// The only free variable is `t`, the simulated time in seconds; parameters and units are already resolved to SI.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub enum Expression {
    /// The same number at every time.
    Constant(f64),
}

impl Expression {
    /// The value at time `t` [s], in SI units.
    pub fn at(&self, _t: f64) -> f64 {
        match self {
            Expression::Constant(value) => *value,
        }
    }
}
