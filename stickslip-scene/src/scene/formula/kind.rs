//! What is known of a number's dimension.

use crate::scene::units::Powers;

/// What is known of a number's dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NumberKind {
    /// A plain number in the formula itself: a pure number in products, an SI value in sums.
    Number,
    /// A plain number from elsewhere: of whatever dimension fits.
    Any,
    /// Of this dimension by the units written.
    Known(Powers),
    /// Of this dimension because `t` is a time and `x` a length; no unit is written.
    Timed(Powers),
    /// Not a number but yes or no.
    Truth,
}

/// Two kinds that do not go together.
pub struct Clash;

impl NumberKind {
    /// The dimension, if it is known or probable.
    fn powers(self) -> Option<Powers> {
        match self {
            NumberKind::Known(powers) | NumberKind::Timed(powers) => Some(powers),
            NumberKind::Number => Some(Powers::NONE),
            NumberKind::Any | NumberKind::Truth => None,
        }
    }

    /// May a number of this kind stand where `wanted` is asked for?
    pub fn fits(self, wanted: Powers) -> bool {
        match self {
            NumberKind::Known(powers) => powers == wanted,
            NumberKind::Truth => false,
            NumberKind::Number | NumberKind::Any | NumberKind::Timed(_) => true,
        }
    }

    /// Has it a dimension by the units written?
    pub fn has_dimension(self) -> bool {
        matches!(self, NumberKind::Known(powers) if powers != Powers::NONE)
    }

    /// Kind of a sum, and of anything else whose terms must agree.
    pub fn sum(self, other: NumberKind) -> Result<NumberKind, Clash> {
        use NumberKind::*;
        match (self, other) {
            (Truth, _) | (_, Truth) => Err(Clash),
            (Number, kind) | (kind, Number) | (Any, kind) | (kind, Any) => Ok(kind),
            (Known(a), Known(b) | Timed(b)) | (Timed(a), Known(b)) if a == b => Ok(Known(a)),
            (Timed(a), Timed(b)) => Ok(if a == b { Timed(a) } else { Any }),
            _ => Err(Clash),
        }
    }

    /// Kind of a product with the other factor raised to `exponent`.
    pub fn product(self, other: NumberKind, exponent: f64) -> Result<NumberKind, Clash> {
        use NumberKind::*;
        let (Some(a), Some(b)) = (self.powers(), other.powers()) else {
            return if self == Truth || other == Truth { Err(Clash) } else { Ok(Any) };
        };
        let powers = a.times(b, exponent);
        Ok(match (self, other) {
            (Number, Number) => Number,
            (Known(_), _) | (_, Known(_)) => Known(powers),
            _ => Timed(powers),
        })
    }

    /// Kind of a power; `exponent` is `None` where it varies in time.
    pub fn power(self, exponent: Option<f64>) -> Result<NumberKind, Clash> {
        match (self, exponent) {
            (NumberKind::Number | NumberKind::Any, _) => Ok(self),
            (_, Some(exponent)) if exponent.is_finite() => match self {
                NumberKind::Timed(powers) => Ok(NumberKind::Timed(Powers::NONE.times(powers, exponent))),
                NumberKind::Known(powers) => Ok(NumberKind::Known(Powers::NONE.times(powers, exponent))),
                _ => Err(Clash),
            },
            (NumberKind::Timed(_), _) => Ok(NumberKind::Any),
            (NumberKind::Known(powers), _) if powers == Powers::NONE => Ok(self),
            _ => Err(Clash),
        }
    }

    /// `a length [m]`
    pub fn name(self) -> String {
        match self {
            NumberKind::Known(powers) if powers == Powers::NONE => "an angle or a ratio".to_string(),
            NumberKind::Known(powers) | NumberKind::Timed(powers) => powers.name(),
            NumberKind::Number | NumberKind::Any => "a plain number".to_string(),
            NumberKind::Truth => "a comparison".to_string(),
        }
    }
}
