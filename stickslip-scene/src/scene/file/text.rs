//! Names, choices and counts as scene files write them.

use super::Context;
use super::quantity::{QuantityInput, Ratio};
use super::read::Read;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::letters::is_no_letter;
use crate::scene::suggestion::{did_you_mean, listed};
use crate::scene::{NamePattern, is_pattern};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::collections::HashSet;
use std::marker::PhantomData;
use std::ops::RangeInclusive;

/// Names that a message lists.
const MOST_LISTED: usize = 12;

/// Text, with parameters in braces.
pub struct Text(DocumentNode);

/// One of a few words.
pub trait Choice: Copy + 'static {
    /// Each word with its meaning and one sentence for the schema.
    const WORDS: &'static [(&'static str, Self, &'static str)];

    /// Words that other programs have, in lower case, and what there is here for each.
    const ELSEWHERE: &'static [(&'static str, &'static str)] = &[];

    /// What helps whoever wrote another word.
    fn help(word: &str) -> Option<String> {
        let elsewhere = Self::ELSEWHERE.iter().find(|(name, _)| word.eq_ignore_ascii_case(name));
        match elsewhere {
            Some((_, answer)) => Some(answer.to_string()),
            None => did_you_mean(word, Self::WORDS.iter().map(|(name, ..)| *name)),
        }
    }
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
        let seen = |&letter: &char| !is_no_letter(letter) || matches!(letter, '\n' | '\t');
        self.as_written().trim().chars().filter(seen).collect()
    }

    /// The text, which must be the name of something; `what` says of what, `known` are those that there are.
    pub fn name_of(&self, context: &Context, what: &str, known: &[&str]) -> Result<String, Fault> {
        let name = self.value(context)?;
        if known.contains(&name.as_str()) {
            return Ok(name);
        }
        let one = is_pattern(&name).then(|| "one name is wanted here, no pattern".to_string());
        let fault = self.unknown(&name, what, known);
        Err(if one.is_some() { fault.help(one) } else { fault })
    }

    /// The text, which must be the name of something or a pattern that some names match, and the places of those.
    pub fn names_of(
        &self,
        context: &Context,
        what: &str,
        known: &[&str],
    ) -> Result<(String, Vec<usize>), Fault> {
        let name = self.value(context)?;
        let pattern = NamePattern::new(&name);
        let found: Vec<usize> = (0..known.len()).filter(|&i| pattern.matches(known[i])).collect();
        if found.is_empty() { Err(self.unknown(&name, what, known)) } else { Ok((name, found)) }
    }

    /// The fault of a name that is not known.
    fn unknown(&self, name: &str, what: &str, known: &[&str]) -> Fault {
        let mut quoted: Vec<String> =
            known.iter().take(MOST_LISTED).map(|name| format!("{name:?}")).collect();
        if known.len() > MOST_LISTED {
            quoted.push(format!("and {} more", known.len() - MOST_LISTED));
        }
        let allowed = match &quoted[..] {
            [] => what.to_string(),
            _ => format!("{what} ({})", quoted.join(", ")),
        };
        let begins = |other: &&str| other.strip_prefix(name).is_some_and(|rest| rest.starts_with(' '));
        let help = match is_pattern(name) {
            true => Some("in a pattern, `*` is any letters: none of these names match it".to_string()),
            false if known.iter().filter(|other| begins(other)).count() > 1 => {
                Some(format!("`{name} *` is all whose names begin so"))
            }
            false => did_you_mean(name, known.iter().copied()),
        };
        self.refused(name, allowed).help(help)
    }

    /// A name of something new, which is not empty and none of those that are `taken`, and is now.
    pub fn new_name(&self, context: &Context, taken: &mut HashSet<String>) -> Result<String, Fault> {
        let name = self.value(context)?;
        self.is_no_pattern(&name)?;
        if name.trim().is_empty() || !taken.insert(name.clone()) {
            return Err(self.refused(&name, "a name that no other in the list has"));
        }
        Ok(name)
    }

    /// The name of something new in a table of the file: that of its key, or by default what it is and its number.
    pub fn name_or(
        given: Option<&Text>,
        (kind, number): (&str, usize),
        (declared, taken): (&str, &mut HashSet<String>),
        context: &Context,
    ) -> Result<String, Fault> {
        if let Some(text) = given {
            return text.new_name(context, taken);
        }
        let name = format!("{kind} {number}");
        if taken.insert(name.clone()) {
            return Ok(name);
        }
        let found = format!("the name `{name}`, which another has");
        Err(Fault::new(declared, found, "a `name` of its own"))
    }

    /// Refuses a new name that would stand for others.
    pub fn is_no_pattern(&self, name: &str) -> Result<(), Fault> {
        let allowed = "a name without `*`, which is any letters where bodies are named";
        if is_pattern(name) { Err(self.refused(name, allowed)) } else { Ok(()) }
    }

    /// Where it stands.
    pub fn node(&self) -> &DocumentNode {
        &self.0
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

/// Names that a list gives, each of which must be known or a pattern of some that are; each once.
pub fn names_in(
    list: &[Text],
    (what, known): (&str, &[&str]),
    context: &Context,
) -> Result<Vec<String>, Fault> {
    let (mut names, mut seen) = (Vec::new(), HashSet::new());
    for text in list {
        let (_, found) = text.names_of(context, what, known)?;
        names.extend(found.into_iter().filter(|&i| seen.insert(i)).map(|i| known[i].to_string()));
    }
    Ok(names)
}

impl<C: Choice> Word<C> {
    /// The meaning of the word.
    pub fn value(&self, context: &Context) -> Result<C, Fault> {
        let text = Text(self.node.clone());
        let word = text.value(context)?;
        let chosen = C::WORDS.iter().find(|(name, ..)| *name == word);
        chosen
            .map(|(_, meaning, _)| *meaning)
            .ok_or_else(|| text.refused(&word, Self::wanted()).help(C::help(&word)))
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
