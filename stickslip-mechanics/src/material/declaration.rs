//! What a law declares of itself: its constants with their units and bounds. Scene files, schema,
//! checks and error messages follow.

use super::{Isotropic, Material};
use std::collections::BTreeMap;

/// A law as scene files name it.
#[derive(Debug)]
pub struct Description {
    /// Key in a scene file.
    pub name: &'static str,
    /// One sentence for the schema.
    pub summary: &'static str,
    /// Its constants.
    pub constants: &'static [Constant],
    pub(super) build: fn(&Given) -> Result<Material<f64>, BadConstants>,
}

/// What a law says of itself.
pub trait Declared: Sized {
    /// One sentence for the schema.
    const SUMMARY: &'static str;
    /// Its constants.
    const CONSTANTS: &'static [Constant];

    /// The law with these constants, which are within their bounds, and none of which is missing that may not be.
    ///
    /// # Errors
    /// Constants of which no stable material can be made.
    fn build(given: &Given) -> Result<Self, BadConstants>;

    /// Its constants, as [`Declared::build`] takes them.
    fn given(&self) -> Given;

    /// Elastic moduli at small strain, of a sudden strain where they depend on time: for what is said of a scene before
    /// it runs.
    fn elastic(&self) -> Isotropic<f64>;

    /// The law for cells of this side [m]; most laws do not ask for it.
    ///
    /// # Errors
    /// Cells for which it has no answer.
    fn on_grid(self, _cell: f64) -> Result<Self, BadConstants> {
        Ok(self)
    }
}

/// A constant of a law.
#[derive(Clone, Copy, Debug)]
pub struct Constant {
    /// Key in a scene file.
    pub name: &'static str,
    /// One sentence for the schema.
    pub summary: &'static str,
    /// What may stand there.
    pub form: Form,
    /// What holds where it is not given.
    pub absent: Absent,
}

/// What may stand at a constant.
#[derive(Clone, Copy, Debug)]
pub enum Form {
    /// A number.
    Number(Quantity),
    /// A list of pairs, at most so many.
    Pairs([Quantity; 2], usize),
    /// One of these words, each with one sentence for the schema; its value is its place among them.
    Word(&'static [(&'static str, &'static str)]),
}

/// What a number must be.
#[derive(Clone, Copy, Debug)]
pub struct Quantity {
    /// What it is called in error messages about a pair.
    pub name: &'static str,
    /// Its unit.
    pub unit: ConstantUnit,
    /// What it may be.
    pub bounds: AllowedRange,
}

/// A unit.
#[derive(Clone, Copy, Debug)]
pub struct ConstantUnit {
    /// Powers of kilogram, metre and second.
    pub powers: [i8; 3],
    /// As it is written after a number; empty where there is none.
    pub symbol: &'static str,
}

/// Of a number without unit.
pub const RATIO: ConstantUnit = ConstantUnit { powers: [0, 0, 0], symbol: "" };
/// Of an angle.
pub const ANGLE: ConstantUnit = ConstantUnit { powers: [0, 0, 0], symbol: "rad" };
/// Of a pressure or a modulus.
pub const PRESSURE: ConstantUnit = ConstantUnit { powers: [1, -1, -2], symbol: "Pa" };
/// Of a time.
pub const TIME: ConstantUnit = ConstantUnit { powers: [0, 0, 1], symbol: "s" };
/// Of a rate.
pub const RATE: ConstantUnit = ConstantUnit { powers: [0, 0, -1], symbol: "1/s" };
/// Of a viscosity.
pub const VISCOSITY: ConstantUnit = ConstantUnit { powers: [1, -1, -1], symbol: "Pa*s" };
/// Of an energy per volume.
pub const ENERGY_PER_VOLUME: ConstantUnit = ConstantUnit { powers: [1, -1, -2], symbol: "J/m^3" };
/// Of a length.
pub const LENGTH: ConstantUnit = ConstantUnit { powers: [0, 1, 0], symbol: "m" };
/// Of a density.
pub const DENSITY: ConstantUnit = ConstantUnit { powers: [1, -3, 0], symbol: "kg/m^3" };
/// Of an energy per area.
pub const ENERGY_PER_AREA: ConstantUnit = ConstantUnit { powers: [1, 0, -2], symbol: "J/m^2" };

/// What a number may be; it is always finite.
#[derive(Clone, Copy, Debug)]
pub struct AllowedRange {
    /// Its lower end.
    pub from: End,
    /// Its upper end.
    pub to: End,
    /// Why, as the end of a sentence: `, else the material is not stable`.
    pub because: &'static str,
}

/// An end of what a number may be.
#[derive(Clone, Copy, Debug)]
pub enum End {
    /// There is none.
    Free,
    /// This number, and it belongs to what is allowed.
    At(f64),
    /// This number, and it does not.
    Beyond(f64),
}

/// Above zero.
pub const POSITIVE: AllowedRange = AllowedRange { from: End::Beyond(0.0), to: End::Free, because: "" };
/// Zero or above.
pub const NOT_NEGATIVE: AllowedRange = AllowedRange { from: End::At(0.0), to: End::Free, because: "" };

impl AllowedRange {
    /// Between two numbers, neither of which is allowed.
    pub const fn between(from: f64, to: f64) -> Self {
        AllowedRange { from: End::Beyond(from), to: End::Beyond(to), because: "" }
    }

    /// The same with a reason.
    pub const fn because(self, because: &'static str) -> Self {
        AllowedRange { because, ..self }
    }

    fn contains(&self, value: f64) -> bool {
        let from = match self.from {
            End::Free => true,
            End::At(least) => value >= least,
            End::Beyond(least) => value > least,
        };
        let to = match self.to {
            End::Free => true,
            End::At(most) => value <= most,
            End::Beyond(most) => value < most,
        };
        value.is_finite() && from && to
    }
}

/// `a positive number`, `at least 0`, `above -1 and below 0.5, else the material is not stable`
impl std::fmt::Display for AllowedRange {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let from = match self.from {
            End::Free => None,
            End::At(least) => Some(format!("at least {least}")),
            End::Beyond(0.0) if matches!(self.to, End::Free) => Some("a positive number".to_string()),
            End::Beyond(least) => Some(format!("above {least}")),
        };
        let to = match self.to {
            End::Free => None,
            End::At(most) => Some(format!("at most {most}")),
            End::Beyond(most) => Some(format!("below {most}")),
        };
        let ends: Vec<String> = from.into_iter().chain(to).collect();
        let ends = if ends.is_empty() { "a finite number".to_string() } else { ends.join(" and ") };
        write!(formatter, "{ends}{}", self.because)
    }
}

/// `"this" or "that"`
fn listed(words: &[(&str, &str)]) -> String {
    words.iter().map(|(word, _)| format!("{word:?}")).collect::<Vec<_>>().join(" or ")
}

/// What holds where a constant is not given.
#[derive(Clone, Copy, Debug)]
pub enum Absent {
    /// It must be given, like this: as scene files have it, a number with a unit in quotes.
    Refused(&'static str),
    /// This number.
    Default(f64),
    /// The law judges: any two of its elastic constants give the others.
    Judged,
}

impl Constant {
    /// A number that must be given, like `example`, which is written as in a scene file: `"\"4 MPa\""`.
    pub const fn required(
        name: &'static str,
        summary: &'static str,
        (unit, bounds): (ConstantUnit, AllowedRange),
        example: &'static str,
    ) -> Self {
        let form = Form::Number(Quantity { name, unit, bounds });
        Constant { name, summary, form, absent: Absent::Refused(example) }
    }

    /// A number that may be given.
    pub const fn optional(
        name: &'static str,
        summary: &'static str,
        (unit, bounds): (ConstantUnit, AllowedRange),
        default: f64,
    ) -> Self {
        let form = Form::Number(Quantity { name, unit, bounds });
        Constant { name, summary, form, absent: Absent::Default(default) }
    }

    /// What each number of it must be, one after the other and over again.
    pub fn quantities(&self) -> &[Quantity] {
        match &self.form {
            Form::Number(one) => std::slice::from_ref(one),
            Form::Pairs(two, _) => two,
            Form::Word(_) => &[],
        }
    }

    fn bad(&self, found: String, allowed: String) -> BadConstants {
        BadConstants { key: Some(self.name.to_string()), found, allowed }
    }

    fn missing(&self, example: &str) -> BadConstants {
        let wanted = match self.form {
            Form::Number(quantity) => quantity.bounds.to_string(),
            Form::Pairs([a, b], _) => format!("a list of pairs [{}, {}]", a.name, b.name),
            Form::Word(words) => listed(words),
        };
        BadConstants::together(
            format!("no {}", self.name),
            format!("{}, {wanted}, like {example}", self.name),
        )
    }

    /// Whether values are within bounds.
    fn check(&self, values: &[f64]) -> Result<(), BadConstants> {
        if let Form::Pairs(_, most) = self.form
            && !(1..=most).contains(&(values.len() / 2))
        {
            return Err(self.bad(format!("{} pairs", values.len() / 2), format!("1 to {most} pairs")));
        }
        if let Form::Word(words) = self.form
            && let Some(value) =
                values.iter().find(|value| !(0..words.len()).any(|place| **value == place as f64))
        {
            return Err(
                self.bad(value.to_string(), format!("0 to {}, for {}", words.len() - 1, listed(words)))
            );
        }
        for (&value, quantity) in values.iter().zip(self.quantities().iter().cycle()) {
            if !quantity.bounds.contains(value) {
                let found = format!("{value} {}", quantity.unit.symbol).trim_end().to_string();
                return Err(match self.form {
                    Form::Number(_) | Form::Word(_) => self.bad(found, quantity.bounds.to_string()),
                    Form::Pairs(..) => self.bad(
                        format!("{} {found}", quantity.name),
                        format!("{} {}", quantity.name, quantity.bounds),
                    ),
                });
            }
        }
        Ok(())
    }
}

/// Constants by name in SI units; pairs one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Given(BTreeMap<String, Vec<f64>>);

impl Given {
    /// The number of this name, if it is given.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.0.get(name).and_then(|values| values.first().copied())
    }

    /// The number of this name, which has a default or may not be missing.
    pub fn number(&self, name: &str) -> f64 {
        self.get(name).unwrap_or(f64::NAN)
    }

    /// The pairs of this name.
    pub fn pairs(&self, name: &str) -> &[[f64; 2]] {
        self.0.get(name).map_or(&[], |values| values.as_chunks().0)
    }

    /// Adds values under a name.
    pub fn put(&mut self, name: impl Into<String>, values: Vec<f64>) {
        self.0.insert(name.into(), values);
    }

    /// The same with another number.
    pub fn with(mut self, name: &str, value: f64) -> Self {
        self.put(name, vec![value]);
        self
    }
}

impl<S: Into<String>> FromIterator<(S, f64)> for Given {
    fn from_iter<I: IntoIterator<Item = (S, f64)>>(numbers: I) -> Self {
        Given(numbers.into_iter().map(|(name, value)| (name.into(), vec![value])).collect())
    }
}

impl<S: Into<String>, const N: usize> From<[(S, f64); N]> for Given {
    fn from(numbers: [(S, f64); N]) -> Self {
        numbers.into_iter().collect()
    }
}

/// Constants from which no stable material can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{found}; {allowed}")]
pub struct BadConstants {
    /// The constant at fault, if it is one alone.
    pub key: Option<String>,
    /// What was found.
    pub found: String,
    /// What is allowed.
    pub allowed: String,
}

impl BadConstants {
    /// What is wrong with several constants together.
    pub fn together(found: impl Into<String>, allowed: impl Into<String>) -> Self {
        BadConstants { key: None, found: found.into(), allowed: allowed.into() }
    }

    /// What is wrong with one constant.
    pub fn of(key: &str, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        BadConstants { key: Some(key.to_string()), ..Self::together(found, allowed) }
    }
}

impl Description {
    /// The material with these constants in SI units.
    ///
    /// # Errors
    /// Constants that are missing, out of bounds, too many, or of no stable material.
    pub fn build(&self, given: &Given) -> Result<Material<f64>, BadConstants> {
        let mut given = given.clone();
        for constant in self.constants {
            match (given.0.get(constant.name), constant.absent) {
                (Some(values), _) => constant.check(values)?,
                (None, Absent::Default(value)) => given.put(constant.name, vec![value]),
                (None, Absent::Refused(example)) => return Err(constant.missing(example)),
                (None, Absent::Judged) => {}
            }
        }
        (self.build)(&given)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_say_what_they_are() {
        let stable = AllowedRange::between(-1.0, 0.5).because(", else the material is not stable");
        assert_eq!(stable.to_string(), "above -1 and below 0.5, else the material is not stable");
        assert_eq!(POSITIVE.to_string(), "a positive number");
        assert_eq!(NOT_NEGATIVE.to_string(), "at least 0");
        assert!(
            stable.contains(0.4999)
                && !stable.contains(0.5)
                && !stable.contains(-1.0)
                && !POSITIVE.contains(f64::INFINITY)
        );
        assert!(NOT_NEGATIVE.contains(0.0) && !NOT_NEGATIVE.contains(f64::NAN));
    }
}
