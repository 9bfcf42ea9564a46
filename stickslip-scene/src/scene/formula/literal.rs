//! The unit after a number: `6 MPa`, `9.81 m/s^2`.
//!
//! A unit goes on over spaces, `*`, `/` and `^` as long as names of units follow; it may start with `1/`. Where such a
//! name is also a parameter, spaces decide or nobody does: `2 kg/m` is a unit, `2 kg / m` is refused.

use super::parser::{Parsed, Parser, fail};
use super::token::Token;
use crate::scene::suggestion::did_you_mean;
use crate::scene::units::Unit;

/// Largest power of a unit.
const LARGEST_POWER: f64 = 9.0;

impl Parser<'_> {
    /// Reads what stands for the unit after a number that ends at `end`; returns where the unit ends.
    pub(super) fn unit(&mut self, end: usize) -> Parsed<(Option<Unit>, usize)> {
        // `10 1/s`: a unit that starts with its division
        let divides = self.divides();
        self.next += 2 * usize::from(divides);
        let (Token::Name(name), span) = self.peek() else { return Ok((None, end)) };
        let Some(first) = Unit::named(name).filter(|_| !self.calls()) else {
            let known = self.names.all();
            let help = if known.iter().any(|known| known == name) || self.calls() {
                Some(format!("write `* {name}` for a product"))
            } else {
                did_you_mean(name, Unit::names().iter().map(String::as_str))
            };
            return fail(
                span,
                format!("`{name}` after a number"),
                "a unit such as m, mm, kg, ms, MPa, deg",
                help,
            );
        };
        self.next += 1;
        let (power, mut end) = self.unit_power(span.end)?;
        let mut unit = Unit::ONE.times(first, if divides { -power } else { power });
        loop {
            // Units side by side are a product: `N s/m`.
            let (symbol, at) = match self.peek().0 {
                Token::Symbol(symbol @ ("*" | "/")) => (symbol, self.next + 1),
                _ => ("*", self.next),
            };
            let Some((Token::Name(name), span)) = self.words.get(at).cloned() else { break };
            let calls = self.words.get(at + 1).is_some_and(|(token, _)| *token == Token::Symbol("("));
            let Some(factor) = Unit::named(name).filter(|_| !calls) else { break };
            // `kg/m^3` written tightly is a unit even beside a parameter `m`
            let tight = at > self.next && span.start == end + 1;
            if !tight && self.names.all().iter().any(|known| known == name) {
                let found = format!("`{symbol} {name}`, where `{name}` is both a unit and a parameter");
                let help = format!(
                    "for the parameter put the quantity before it in brackets: `({}) {symbol} {name}`; for the unit leave out the spaces: `{symbol}{name}`",
                    self.text[..end].rsplit(['(', ',', '+']).next().unwrap_or_default().trim()
                );
                return fail(span, found, "a name with one meaning", Some(help));
            }
            self.next = at + 1;
            let (power, last) = self.unit_power(span.end)?;
            unit = unit.times(factor, if symbol == "*" { power } else { -power });
            end = last;
        }
        Ok((Some(unit), end))
    }

    /// Reads the power of a unit that ends at `end`: `^2`, `^-1` or nothing.
    fn unit_power(&mut self, end: usize) -> Parsed<(i32, usize)> {
        if self.peek().0 != Token::Symbol("^") {
            return Ok((1, end));
        }
        self.next += 1;
        let negative = self.peek().0 == Token::Symbol("-");
        self.next += usize::from(negative);
        match self.take() {
            (Token::Number(power), span) if power.fract() == 0.0 && power <= LARGEST_POWER => {
                let power = power as i32; // a whole number from 0 to 9
                Ok((if negative { -power } else { power }, span.end))
            }
            (_, span) => fail(
                span.clone(),
                self.quote(&span),
                format!("a whole power of a unit, up to {LARGEST_POWER}"),
                Some("for a power of the quantity put it in brackets: `(2 m)^n`".to_string()),
            ),
        }
    }

    /// Do `1 /` and a unit come next?
    fn divides(&self) -> bool {
        let ahead = |n: usize| self.words.get(self.next + n).map(|(token, _)| *token);
        let unit = matches!(ahead(2), Some(Token::Name(name)) if Unit::named(name).is_some());
        unit && ahead(0) == Some(Token::Number(1.0)) && ahead(1) == Some(Token::Symbol("/"))
    }

    /// Is the next word a name with a bracket after it?
    fn calls(&self) -> bool {
        self.words.get(self.next + 1).is_some_and(|(token, _)| *token == Token::Symbol("("))
    }
}
