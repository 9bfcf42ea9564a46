//! Names, choices and counts as scene files write them.

use super::Context;
use super::quantity::{QuantityInput, Ratio};
use super::read::Read;
use crate::scene::error::Fault;
use crate::scene::source::{DocumentNode, Value};
use crate::scene::suggestion::{did_you_mean, listed};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::marker::PhantomData;
use std::ops::RangeInclusive;

/// Text, with parameters in braces.
pub struct Text(DocumentNode);

/// One of a few words.
pub trait Choice: Copy + 'static {
    /// Each word with its meaning and one sentence for the schema.
    const WORDS: &'static [(&'static str, Self, &'static str)];
}

/// One of a few words, or a parameter in braces that holds one.
pub struct Word<C> {
    node: DocumentNode,
    choice: PhantomData<C>,
}

/// A small whole number.
pub struct Count(QuantityInput<Ratio>);

impl Text {
    /// The text with its parameters replaced.
    pub fn value(&self, context: &Context) -> Result<String, Fault> {
        context.parameters.text(&self.0)
    }

    /// The text as it stands in the file.
    pub fn as_written(&self) -> &str {
        match &self.0.value {
            Value::Text(text) => text,
            _ => "",
        }
    }

    /// Prose of any number of lines, as it stands in the file but for what steers terminals.
    pub fn as_prose(&self) -> String {
        let seen = |letter: &char| !letter.is_control() || matches!(letter, '\n' | '\t');
        self.as_written().trim().chars().filter(seen).collect()
    }

    /// The text, which must be the name of something; `what` says of what, `known` are those that there are.
    pub fn name_of(&self, context: &Context, what: &str, known: &[&str]) -> Result<String, Fault> {
        let name = self.value(context)?;
        if known.contains(&name.as_str()) {
            return Ok(name);
        }
        let quoted: Vec<String> = known.iter().map(|name| format!("{name:?}")).collect();
        let allowed = format!("{what} ({})", quoted.join(", "));
        Err(self.refused(&name, allowed).help(did_you_mean(&name, known.iter().copied())))
    }

    /// Refuses a name that is empty or among those that are `taken`.
    pub fn unlike<'n>(&self, name: &str, mut taken: impl Iterator<Item = &'n str>) -> Result<(), Fault> {
        if name.trim().is_empty() || taken.any(|other| other == name) {
            return Err(self.refused(name, "a name that no other in the list has"));
        }
        Ok(())
    }

    /// The fault of a text that is not allowed.
    pub fn refused(&self, value: &str, allowed: impl Into<String>) -> Fault {
        let mut fault = self.0.fault(allowed);
        fault.problem.found = match &self.0.value {
            Value::Text(text) if text != value => format!("{text:?}, which is {value:?}"),
            _ => format!("{value:?}"),
        };
        fault
    }
}

impl<C: Choice> Word<C> {
    /// The meaning of the word.
    pub fn value(&self, context: &Context) -> Result<C, Fault> {
        let text = Text(self.node.clone());
        let word = text.value(context)?;
        let chosen = C::WORDS.iter().find(|(name, ..)| *name == word);
        chosen.map(|(_, meaning, _)| *meaning).ok_or_else(|| {
            let names = C::WORDS.iter().map(|(name, ..)| *name);
            text.refused(&word, Self::wanted()).help(did_you_mean(&word, names))
        })
    }

    /// The fault of a word that is not allowed beside others.
    pub fn refused(&self, context: &Context, allowed: impl Into<String>) -> Fault {
        let text = Text(self.node.clone());
        text.value(context).map_or_else(|fault| fault, |word| text.refused(&word, allowed))
    }

    /// Where it stands.
    pub fn node(&self) -> &DocumentNode {
        &self.node
    }
}

impl Count {
    /// Its value, in the range.
    pub fn value(&self, context: &Context, range: RangeInclusive<usize>) -> Result<usize, Fault> {
        let allowed = format!("a whole number from {} to {}", range.start(), range.end());
        let fits = |value: f64| value.fract() == 0.0 && value >= 0.0 && range.contains(&(value as usize));
        self.0.checked(context, &allowed, fits).map(|value| value as usize)
    }
}

impl Count {
    /// The fault of a number that does not belong here.
    pub fn refused(&self, context: &Context, allowed: &str) -> Result<Fault, Fault> {
        Ok(self.0.refused(self.0.value(context)?, allowed))
    }
}

impl Read for Text {
    fn wanted() -> String {
        "text in quotes".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Text(_) => Ok(Text(node.clone())),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl<C: Choice> Read for Word<C> {
    fn wanted() -> String {
        let quoted: Vec<String> = C::WORDS.iter().map(|(name, ..)| format!("{name:?}")).collect();
        listed(quoted.iter().map(String::as_str))
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Text(_) => Ok(Word { node: node.clone(), choice: PhantomData }),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl Read for Count {
    fn wanted() -> String {
        "a whole number".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Number(_) | Value::Text(_) => Ok(Count(QuantityInput::new(node))),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl JsonSchema for Text {
    fn schema_name() -> Cow<'static, str> {
        "Text".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string" })
    }
}

impl<C: Choice> JsonSchema for Word<C> {
    fn schema_name() -> Cow<'static, str> {
        format!("Word_{}", C::WORDS.iter().map(|(name, ..)| *name).collect::<Vec<_>>().join("_")).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let words =
            C::WORDS.iter().map(|(name, _, about)| json_schema!({ "const": name, "description": about }));
        let parameter =
            json_schema!({ "type": "string", "pattern": "\\{", "description": "A parameter in braces." });
        let all: Vec<Schema> = words.chain([parameter]).collect();
        json_schema!({ "anyOf": all })
    }
}

impl JsonSchema for Count {
    fn schema_name() -> Cow<'static, str> {
        "Count".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["integer", "string"] })
    }
}
