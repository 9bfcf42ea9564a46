//! `--set name=value`: parameters and keys that are replaced before a scene is read.

use super::document_node::{DocumentNode, Value, joined};
use super::error::Fault;
use super::suggestion::did_you_mean;
use std::ops::Range;
use std::sync::Arc;
use toml::de::DeValue;

/// Where an override stands among all documents: its name, and the start of its value.
pub(super) struct OverridePlace {
    pub name: Range<usize>,
    pub value: usize,
}

/// Puts `value` in place of the parameter `name`, or of the key if `name` is a path with dots.
///
/// A value that is TOML (a number, a list, text in quotes) is taken as such, anything else as text: `gap`,
/// `2 mm`, `pi / 6`.
///
/// # Errors
/// A parameter that does not exist; a path through a value that is no table or list.
pub(super) fn put(
    root: &mut DocumentNode,
    name: &str,
    value: &str,
    place: &OverridePlace,
) -> Result<(), Fault> {
    let written = value.trim();
    let start = place.value + (value.len() - value.trim_start().len());
    let parameter = !name.contains(['.', '[']);
    if parameter {
        let known = root.children().iter().find(|child| child.name() == "parameters");
        let known: Vec<&str> =
            known.iter().flat_map(|table| table.children()).map(|child| child.name()).collect();
        if !known.contains(&name) {
            let choices = if known.is_empty() { "there are none".to_string() } else { known.join(", ") };
            let found = format!("no parameter `{name}`");
            let help = did_you_mean(name, known)
                .or_else(|| Some("other keys are set by their path with dots: time.end=\"1 s\"".to_string()));
            let allowed = format!("a parameter of the scene ({choices})");
            return Err(Fault::new("", found, allowed).help(help).at(place.name.clone()));
        }
    }
    let path = if parameter { joined("parameters", name) } else { name.to_string() };
    let mut target = root;
    for step in path.split('.').flat_map(steps) {
        target = descend(target, step, place)?;
    }
    match DeValue::parse(written) {
        Ok(parsed) => target.put(&place.name, (&parsed, start)),
        Err(_) => target.put_text(&place.name, (written, start..start + written.len())),
    }
    Ok(())
}

/// `bodies[0]` is two steps: a name and a number.
enum KeyStep<'a> {
    Name(&'a str),
    Number(&'a str),
}

fn steps(word: &str) -> impl Iterator<Item = KeyStep<'_>> {
    let (name, numbers) = word.split_at(word.find('[').unwrap_or(word.len()));
    let numbers = numbers.split('[').skip(1).map(|number| KeyStep::Number(number.trim_end_matches(']')));
    std::iter::once(KeyStep::Name(name)).chain(numbers)
}

fn descend<'n>(
    node: &'n mut DocumentNode,
    step: KeyStep<'_>,
    place: &OverridePlace,
) -> Result<&'n mut DocumentNode, Fault> {
    let (found, path) = (node.found(), node.path().clone());
    let key = node.key();
    let fault = |found: String, allowed: &str| Fault::new(&key, found, allowed).at(place.name.clone());
    match (step, &mut node.value) {
        (KeyStep::Name(name), Value::Table(children)) => {
            Ok(DocumentNode::entry(children, &path, (name, &place.name)))
        }
        (KeyStep::Number(number), Value::List(items)) => {
            let count = items.len();
            let items = Arc::make_mut(items);
            let item = number.parse().ok().and_then(|number: usize| items.get_mut(number));
            item.ok_or_else(|| {
                fault(format!("number {number} of a list of {count}"), "a number in the list, from 0")
            })
        }
        (KeyStep::Name(name), _) => Err(fault(format!("`.{name}` in {found}"), "a name in a table")),
        (KeyStep::Number(number), _) => Err(fault(format!("`[{number}]` in {found}"), "a number in a list")),
    }
}
