//! Formulas in scene files: `"2 * radius"`, `"10 m/s^2 * sin(angle)"`, `"25 * sqrt(2) / 14 * t^2"`.
//!
//! Dimensions are checked by these rules:
//! - a number with a unit has that unit's dimension; sums, comparisons and functions demand that dimensions agree;
//! - a plain number in a formula is a pure number: `2 * radius` is a length; alone, or in a sum, it is in SI units;
//! - a parameter that is a plain number is in whatever SI unit fits where it is used (`g = 9.81`), so products with it
//!   fit anywhere;
//! - `t` is a time, `x`, `y`, `z`, `x0`, `y0` and `z0` are lengths, but a formula in which no unit is written at all
//!   (`"3 * t + 5 * t^2"`) is in SI units.

mod call;
mod function;
mod kind;
mod literal;
mod parser;
mod token;

pub(super) use function::Function;
pub(super) use kind::NumberKind;
pub(super) use parser::DEEPEST;

use super::error::Fault;
use super::expression::Expression;
use std::ops::Range;

/// A number in SI units with what is known of its dimension.
#[derive(Clone, Copy, Debug)]
pub(super) struct FormulaNumber {
    pub value: f64,
    pub kind: NumberKind,
}

/// What a name in a formula stands for.
pub(super) enum Meaning {
    /// The simulated time.
    Time,
    /// A coordinate, by its number in [`super::expression::PLACE`].
    Place(usize),
    /// A number.
    Value(FormulaNumber),
    /// A parameter that is wrong itself.
    Wrong(Fault),
    /// Nothing.
    Unknown,
}

/// The names that a formula may use.
pub(super) trait Names {
    /// What a name stands for.
    fn meaning(&self, name: &str) -> Meaning;
    /// All names with a meaning.
    fn all(&self) -> Vec<String>;
}

/// A mistake in a formula, with the bytes of its text that are at fault.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Misread {
    pub span: Range<usize>,
    pub found: String,
    pub allowed: String,
    pub help: Option<String>,
}

/// Why a formula has no value.
#[derive(Debug)]
pub(super) enum FormulaError {
    /// It is wrong itself.
    Here(Misread),
    /// A parameter in it is wrong.
    Parameter(Fault),
}

/// A formula that was understood.
pub(super) struct Formula {
    pub expression: Expression,
    pub kind: NumberKind,
}

/// Names that no parameter may have.
pub(super) fn reserved() -> impl Iterator<Item = &'static str> {
    ["pi", "inf", "t", "if"].into_iter().chain(Function::ALL.iter().map(|(name, _)| *name))
}

/// Reads a formula and checks its dimensions.
///
/// # Errors
/// Text that is no formula, unknown names and units, dimensions that do not agree.
pub(super) fn compile(text: &str, names: &dyn Names) -> Result<Formula, FormulaError> {
    parser::Parser::new(text, names)?.formula()
}

#[cfg(test)]
mod tests;
