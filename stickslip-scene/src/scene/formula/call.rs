//! Calls of functions: `min(t / 1 ms, 1)`, `if(t < 1 s, a, b)`.

use super::parser::{Parsed, ParsedPart, Parser, fail};
use super::token::Token;
use super::{Function, NumberKind};
use crate::scene::expression::Instruction;
use crate::scene::suggestion::did_you_mean;
use std::ops::Range;

impl Parser<'_> {
    /// Reads a call from its bracket on.
    pub(super) fn call(&mut self, name: &str, span: Range<usize>) -> Parsed<ParsedPart> {
        let function = Function::named(name);
        if function.is_none() && name != "if" {
            let all: Vec<&str> = Function::ALL.iter().map(|(name, _)| *name).chain(["if"]).collect();
            let help = match self.names.all().iter().any(|known| known == name) {
                true => Some(format!("write `{name} * (...)` for a product")),
                false => did_you_mean(name, all.iter().copied()),
            };
            return fail(span, format!("unknown function `{name}`"), all.join(", "), help);
        }
        self.next += 1; // the bracket
        let start = self.code.len();
        let mut arguments = vec![self.expression(0)?];
        while self.peek().0 == Token::Symbol(",") {
            self.next += 1;
            arguments.push(self.expression(0)?);
            // min and max of many are taken two at a time, so that code needs no counts
            if let (Some(function @ (Function::Min | Function::Max)), [a, b]) = (function, &arguments[..]) {
                let (kind, value) = self.agree(a, b)?;
                self.code.push(Instruction::Call(function));
                let span = a.span.start..b.span.end;
                arguments = vec![self.folded(ParsedPart { kind, value, start, span })];
            }
        }
        let end = self.expect(")")?.end;
        let span = span.start..end;
        match (function, &arguments[..]) {
            (None, [condition, then, otherwise]) => {
                if condition.kind != NumberKind::Truth {
                    return fail(
                        condition.span.clone(),
                        condition.kind.name(),
                        "a comparison such as t < 1 s",
                        None,
                    );
                }
                let (kind, value) = self.agree(then, otherwise)?;
                self.code.push(Instruction::Choose);
                Ok(self.folded(ParsedPart { kind, value: condition.value.and(value), start, span }))
            }
            (Some(Function::Min | Function::Max), [part]) => Ok(ParsedPart { span, start, ..*part }),
            (Some(function @ Function::Atan2), [y, x]) => {
                let (_, value) = self.agree(y, x)?;
                self.code.push(Instruction::Call(function));
                Ok(self.folded(ParsedPart { kind: NumberKind::Number, value, start, span }))
            }
            (Some(function @ Function::Mod), [a, b]) => {
                let (kind, value) = self.agree(a, b)?;
                self.code.push(Instruction::Call(function));
                Ok(self.folded(ParsedPart { kind, value, start, span }))
            }
            (Some(function), [part]) if function.arguments() == 1 => {
                let kind = result(function, part)?;
                self.code.push(Instruction::Call(function));
                Ok(self.folded(ParsedPart { kind, value: part.value, start, span }))
            }
            _ => {
                let wanted = match function {
                    None => "if(condition, a, b)".to_string(),
                    Some(function) if function.arguments() == 2 => format!("{name}(a, b)"),
                    Some(_) => format!("{name}(a)"),
                };
                fail(span, format!("`{name}` of {}", arguments.len()), wanted, None)
            }
        }
    }
}

/// Kind of a function of one number.
fn result(function: Function, part: &ParsedPart) -> Parsed<NumberKind> {
    let kind = match function {
        Function::Abs | Function::Floor | Function::Ceil => part.kind,
        Function::Sqrt => part.kind.power(Some(0.5)).unwrap_or(NumberKind::Truth),
        _ if part.kind.has_dimension() => {
            let help = "divide by a quantity of the same dimension: `t / 1 s`".to_string();
            return fail(
                part.span.clone(),
                part.kind.name(),
                "a number without unit, or an angle",
                Some(help),
            );
        }
        _ => NumberKind::Number,
    };
    match part.kind {
        NumberKind::Truth => fail(part.span.clone(), part.kind.name(), "a number", None),
        _ => Ok(kind),
    }
}
