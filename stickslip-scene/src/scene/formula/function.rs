//! Functions that formulas know.

/// A function of one or two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Sqrt,
    Exp,
    Ln,
    Abs,
    Min,
    Max,
    Mod,
    Floor,
    Ceil,
}

impl Function {
    /// Every function with its name.
    pub const ALL: &[(&str, Function)] = &[
        ("sin", Function::Sin),
        ("cos", Function::Cos),
        ("tan", Function::Tan),
        ("asin", Function::Asin),
        ("acos", Function::Acos),
        ("atan", Function::Atan),
        ("atan2", Function::Atan2),
        ("sqrt", Function::Sqrt),
        ("exp", Function::Exp),
        ("ln", Function::Ln),
        ("abs", Function::Abs),
        ("min", Function::Min),
        ("max", Function::Max),
        ("mod", Function::Mod),
        ("floor", Function::Floor),
        ("ceil", Function::Ceil),
    ];

    /// The function of that name.
    pub fn named(name: &str) -> Option<Function> {
        Function::ALL.iter().find(|(known, _)| *known == name).map(|(_, function)| *function)
    }

    /// How many numbers it takes; `min` and `max` take more as well.
    pub fn arguments(self) -> usize {
        if matches!(self, Function::Atan2 | Function::Min | Function::Max | Function::Mod) { 2 } else { 1 }
    }

    /// Its value; functions of one number ignore `b`. Angles are in radians.
    pub fn of(self, a: f64, b: f64) -> f64 {
        match self {
            Function::Sin => libm::sin(a),
            Function::Cos => libm::cos(a),
            Function::Tan => libm::tan(a),
            Function::Asin => libm::asin(a),
            Function::Acos => libm::acos(a),
            Function::Atan => libm::atan(a),
            Function::Atan2 => libm::atan2(a, b),
            Function::Sqrt => libm::sqrt(a),
            Function::Exp => libm::exp(a),
            Function::Ln => libm::log(a),
            Function::Abs => a.abs(),
            Function::Min => a.min(b),
            Function::Max => a.max(b),
            // a - b floor(a / b): between 0 and b
            Function::Mod => a - b * libm::floor(a / b),
            Function::Floor => libm::floor(a),
            Function::Ceil => libm::ceil(a),
        }
    }
}
