//! The words of a formula.

use super::Misread;
use std::ops::Range;

/// A word of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Token<'a> {
    /// `1.5e-3`
    Number(f64),
    /// A parameter, a function or a unit.
    Name(&'a str),
    /// An operator, a bracket or a comma.
    Symbol(&'static str),
    /// There are no more words.
    End,
}

/// Longer symbols stand before their beginnings.
const SYMBOLS: [&str; 14] = ["<=", ">=", "==", "!=", "<", ">", "+", "-", "*", "/", "^", "(", ")", ","];

/// Splits a formula into words with the bytes they take; the last is [`Token::End`].
pub fn split(text: &str) -> Result<Vec<(Token<'_>, Range<usize>)>, Misread> {
    let mut words = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = if first.is_whitespace() {
            first.len_utf8()
        } else if first.is_ascii_digit() || first == '.' {
            let length = number_length(rest);
            let number = rest[..length].parse().map_err(|_| Misread {
                span: at..at + length,
                found: format!("`{}`", &rest[..length]),
                allowed: "a number such as 0.4 or 1.5e-3".to_string(),
                help: None,
            })?;
            words.push((Token::Number(number), at..at + length));
            length
        } else if first.is_alphabetic() || first == '_' {
            let end = rest.find(|letter: char| !letter.is_alphanumeric() && letter != '_');
            let length = end.unwrap_or(rest.len());
            words.push((Token::Name(&rest[..length]), at..at + length));
            length
        } else if let Some(symbol) = SYMBOLS.iter().find(|symbol| rest.starts_with(**symbol)) {
            words.push((Token::Symbol(symbol), at..at + symbol.len()));
            symbol.len()
        } else {
            let help = match first {
                '{' | '}' => Some("braces are for parameters in text; a formula names them as they are"),
                '=' => Some("comparisons are <, <=, >, >=, ==, !="),
                _ => None,
            };
            return Err(Misread {
                span: at..at + first.len_utf8(),
                found: format!("`{first}`"),
                allowed: "numbers, units, parameters, functions, + - * / ^ ( ) and comparisons".to_string(),
                help: help.map(str::to_string),
            });
        };
        at += length;
    }
    words.push((Token::End, text.len()..text.len()));
    Ok(words)
}

/// Bytes of the number at the start of `text`. An `e` belongs to it only if digits follow: `2 eV` has none.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| from + bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = end + 1 + sign;
        if bytes.get(exponent).is_some_and(u8::is_ascii_digit) {
            end = digits(exponent);
        }
    }
    end
}
