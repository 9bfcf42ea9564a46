//! From the text of a formula to instructions, by operator precedence (Pratt 1973), checking dimensions on the way.
//!
//! From weakest to strongest: comparisons, `+ -`, `* /`, signs, `^` (from the right: `2^3^2` = 512, `-2^2` = -4), a
//! number with its unit.

use super::token::{self, Token};
use super::{Formula, FormulaError, FormulaNumber, Meaning, Misread, Names, NumberKind, reserved};
use crate::scene::expression::{Expression, Instruction, Moment, run};
use crate::scene::suggestion::did_you_mean;
use crate::scene::units::{Powers, Unit};
use std::ops::Range;

/// Brackets and powers may nest this deep.
pub const DEEPEST: usize = 64;
/// Strength of a sign before its operand: above `*`, below `^`.
const SIGN: u8 = 6;

/// Reads one formula.
pub struct Parser<'a> {
    pub(super) text: &'a str,
    pub(super) words: Vec<(Token<'a>, Range<usize>)>,
    pub(super) next: usize,
    depth: usize,
    pub(super) code: Vec<Instruction>,
    pub(super) names: &'a dyn Names,
}

/// A part of the formula that has been read and whose instructions stand at `code[start..]`.
pub struct ParsedPart {
    pub kind: NumberKind,
    /// Its value, unless it varies in time.
    pub value: Option<f64>,
    pub start: usize,
    pub span: Range<usize>,
}

pub type Parsed<T> = Result<T, FormulaError>;

impl<'a> Parser<'a> {
    /// A parser at the start of `text`.
    pub fn new(text: &'a str, names: &'a dyn Names) -> Parsed<Self> {
        let words = token::split(text).map_err(FormulaError::Here)?;
        Ok(Parser { text, words, next: 0, depth: 0, code: Vec::new(), names })
    }

    /// Reads all of it.
    pub fn formula(mut self) -> Parsed<Formula> {
        let whole = self.expression(0)?;
        let (token, span) = self.peek();
        if token != Token::End {
            let help = match token {
                Token::Name(_) | Token::Number(_) | Token::Symbol("(") => {
                    Some("a product needs its `*`".to_string())
                }
                _ => None,
            };
            return fail(span.clone(), self.quote(&span), "an operator, or the end of the formula", help);
        }
        if whole.kind == NumberKind::Truth {
            return fail(whole.span, "a comparison", "a number", Some("if(condition, a, b) chooses".into()));
        }
        Ok(Formula { expression: Expression::new(self.text, self.code), kind: whole.kind })
    }

    /// Reads operators stronger than `weakest` and their operands.
    pub(super) fn expression(&mut self, weakest: u8) -> Parsed<ParsedPart> {
        self.depth += 1;
        if self.depth > DEEPEST {
            let found = format!("more than {DEEPEST} levels of brackets and powers");
            return fail(
                self.peek().1,
                found,
                "a simpler formula",
                Some("name its parts as parameters".into()),
            );
        }
        let mut left = self.operand()?;
        loop {
            let (token, _) = self.peek();
            let Token::Symbol(symbol) = token else { break };
            let (strength, right_side) = match symbol {
                "<" | "<=" | ">" | ">=" | "==" | "!=" => (1, 2),
                "+" | "-" => (2, 3),
                "*" | "/" => (4, 5),
                "^" => (8, SIGN),
                _ => break,
            };
            if strength < weakest || (strength == 1 && left.kind == NumberKind::Truth) {
                break;
            }
            self.next += 1;
            let right = self.expression(right_side)?;
            left = self.combine(left, symbol, right)?;
        }
        self.depth -= 1;
        Ok(left)
    }

    /// Reads a sign, a bracket, a quantity or a name.
    fn operand(&mut self) -> Parsed<ParsedPart> {
        let (token, span) = self.take();
        let start = self.code.len();
        match token {
            Token::Number(number) => {
                let (unit, end) = self.unit(span.end)?;
                let kind = unit.map_or(NumberKind::Number, |unit| NumberKind::Known(unit.powers));
                let value = unit.map_or(number, |unit| unit.to_si(number));
                Ok(self.push(FormulaNumber { value, kind }, span.start..end))
            }
            Token::Name(name) if self.peek().0 == Token::Symbol("(") => self.call(name, span),
            Token::Name(name) => self.name(name, span),
            Token::Symbol(sign @ ("-" | "+")) => {
                let part = self.expression(SIGN)?;
                if part.kind == NumberKind::Truth {
                    return fail(part.span, "a comparison", "a number", None);
                }
                if sign == "-" {
                    self.code.push(Instruction::Negate);
                }
                let span = span.start..part.span.end;
                Ok(self.folded(ParsedPart { span, ..part }))
            }
            Token::Symbol("(") => {
                let inner = self.expression(0)?;
                let end = self.expect(")")?.end;
                Ok(ParsedPart { span: span.start..end, start, ..inner })
            }
            _ => {
                fail(span.clone(), self.quote(&span), "a number, a parameter, a function or a bracket", None)
            }
        }
    }

    /// The meaning of a name that stands alone.
    fn name(&mut self, name: &str, span: Range<usize>) -> Parsed<ParsedPart> {
        let number = |value| FormulaNumber { value, kind: NumberKind::Number };
        match name {
            "pi" => return Ok(self.push(number(std::f64::consts::PI), span)),
            "inf" => return Ok(self.push(number(f64::INFINITY), span)),
            _ => {}
        }
        match self.names.meaning(name) {
            Meaning::Value(quantity) => Ok(self.push(quantity, span)),
            Meaning::Wrong(fault) => Err(FormulaError::Parameter(fault)),
            Meaning::Time => Ok(self.variable(Instruction::Time, Powers::TIME, span)),
            Meaning::Place(which) => Ok(self.variable(Instruction::Place(which), Powers::LENGTH, span)),
            Meaning::Unknown if name == "t" => {
                let allowed = "a formula without time: only prescribed motion, gravity, loads and references vary in time";
                fail(span, "`t`, the time", allowed, None)
            }
            Meaning::Unknown => {
                let known = self.names.all();
                let parameters = known.iter().map(String::as_str);
                let help = match Unit::named(name) {
                    Some(_) => Some(format!("a unit stands right after a number: `1 {name}`")),
                    None => did_you_mean(name, parameters).or_else(|| did_you_mean(name, reserved())),
                };
                fail(span, format!("unknown name `{name}`"), self.choices(), help)
            }
        }
    }

    fn choices(&self) -> String {
        let known = self.names.all();
        let parameters =
            if known.is_empty() { "(there are none)".to_string() } else { format!("({})", known.join(", ")) };
        format!("a parameter {parameters}, pi or inf")
    }

    /// Emits an operator between two parts.
    fn combine(&mut self, left: ParsedPart, symbol: &str, right: ParsedPart) -> Parsed<ParsedPart> {
        let value = left.value.and(right.value);
        let (instruction, kind) = match symbol {
            "*" => (Instruction::Multiply, left.kind.product(right.kind, 1.0)),
            "/" => (Instruction::Divide, left.kind.product(right.kind, -1.0)),
            "^" => {
                if right.kind.has_dimension() || right.kind == NumberKind::Truth {
                    return fail(
                        right.span,
                        format!("{} as exponent", right.kind.name()),
                        "a plain number",
                        None,
                    );
                }
                (Instruction::Power, left.kind.power(right.value))
            }
            "+" => (Instruction::Add, Ok(self.agree(&left, &right)?.0)),
            "-" => (Instruction::Subtract, Ok(self.agree(&left, &right)?.0)),
            _ => {
                self.agree(&left, &right)?;
                if symbol.starts_with('>') {
                    // a > b is b < a
                    self.code[left.start..].rotate_left(right.start - left.start);
                }
                let instruction = match symbol {
                    "<" | ">" => Instruction::Less,
                    "<=" | ">=" => Instruction::LessOrEqual,
                    "==" => Instruction::Equal,
                    _ => Instruction::NotEqual,
                };
                (instruction, Ok(NumberKind::Truth))
            }
        };
        let span = left.span.start..right.span.end;
        let Ok(kind) = kind else {
            let found = format!("{} {symbol} {}", left.kind.name(), right.kind.name());
            return fail(span, found, "numbers, and constant exponents of quantities with units", None);
        };
        self.code.push(instruction);
        Ok(self.folded(ParsedPart { kind, value, start: left.start, span }))
    }

    /// The common kind of two parts; the value only says whether both are constant.
    pub(super) fn agree(&self, a: &ParsedPart, b: &ParsedPart) -> Parsed<(NumberKind, Option<f64>)> {
        let span = a.span.start..b.span.end;
        let Ok(kind) = a.kind.sum(b.kind) else {
            let found = format!("{} with {}", a.kind.name(), b.kind.name());
            let timed = matches!(a.kind, NumberKind::Timed(_)) || matches!(b.kind, NumberKind::Timed(_));
            let help =
                timed.then(|| "where units are written, every number needs its own; t is in s".to_string());
            return fail(span, found, "terms of the same dimension", help);
        };
        Ok((kind, a.value.and(b.value)))
    }

    fn variable(&mut self, instruction: Instruction, powers: Powers, span: Range<usize>) -> ParsedPart {
        self.code.push(instruction);
        ParsedPart { kind: NumberKind::Timed(powers), value: None, start: self.code.len() - 1, span }
    }

    fn push(&mut self, quantity: FormulaNumber, span: Range<usize>) -> ParsedPart {
        self.code.push(Instruction::Push(quantity.value));
        ParsedPart { kind: quantity.kind, value: Some(quantity.value), start: self.code.len() - 1, span }
    }

    /// The part with its instructions replaced by their number if it does not vary in time.
    pub(super) fn folded(&mut self, part: ParsedPart) -> ParsedPart {
        if part.value.is_none() {
            return part;
        }
        let value = run(&self.code[part.start..], &Moment::default());
        self.code.truncate(part.start);
        self.code.push(Instruction::Push(value));
        ParsedPart { value: Some(value), ..part }
    }

    pub(super) fn peek(&self) -> (Token<'a>, Range<usize>) {
        let last = self.words.len() - 1;
        self.words[self.next.min(last)].clone()
    }

    pub(super) fn take(&mut self) -> (Token<'a>, Range<usize>) {
        let word = self.peek();
        self.next += 1;
        word
    }

    pub(super) fn expect(&mut self, symbol: &'static str) -> Parsed<Range<usize>> {
        match self.take() {
            (Token::Symbol(found), span) if found == symbol => Ok(span),
            (_, span) => fail(span.clone(), self.quote(&span), format!("`{symbol}`"), None),
        }
    }

    pub(super) fn quote(&self, span: &Range<usize>) -> String {
        match &self.text[span.clone()] {
            "" => "the end of the formula".to_string(),
            text => format!("`{text}`"),
        }
    }
}

/// A mistake at these bytes.
pub fn fail<T>(
    span: Range<usize>,
    found: impl Into<String>,
    allowed: impl Into<String>,
    help: Option<String>,
) -> Parsed<T> {
    Err(FormulaError::Here(Misread { span, found: found.into(), allowed: allowed.into(), help }))
}
