//! Named parameters: numbers and formulas that may use each other in any order, and words for text.

use super::Parameter;
use super::document_node::{DocumentNode, Value};
use super::error::Fault;
use super::expression::{Expression, PLACE};
use super::formula::{self, Formula, FormulaError, FormulaNumber, Meaning, Names, NumberKind};
use super::letters::is_no_letter;
use super::source::Source;
use super::suggestion::did_you_mean;
use super::units::Powers;
use std::cell::{Cell, OnceCell, RefCell};
use std::collections::{BTreeMap, HashMap, HashSet};

/// The parameters of a scene, evaluated when they are first asked for.
pub(super) struct Parameters<'s> {
    source: &'s Source,
    nodes: &'s [DocumentNode],
    by_name: HashMap<&'s str, &'s DocumentNode>,
    /// What texts of the scene have in braces, once somebody asks.
    in_braces: OnceCell<HashSet<&'s str>>,
    evaluated: RefCell<BTreeMap<&'s str, Result<FormulaNumber, Fault>>>,
    /// Parameters that are being evaluated, to notice circles.
    pending: RefCell<Vec<&'s str>>,
    /// Parameters that were put into the present text.
    put: Cell<usize>,
    /// The indices of what is repeated, with their present values.
    indices: RefCell<Vec<(String, usize)>>,
}

/// Parameters that may wait for each other.
const LONGEST_CHAIN: usize = 64;
/// Parameters that may be put into one text, those in the texts of others among them.
const MOST_PUT: usize = 10_000;
/// Bytes that a text may have.
const LONGEST_TEXT: usize = 1 << 16;

/// What a formula may depend on beside parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Dependence {
    /// Nothing.
    Constant,
    /// The time, `t`.
    Time,
    /// The place, `x`, `y` and `z`.
    Place,
    /// The time, and the place: now `x`, `y` and `z`, at the start `x0`, `y0` and `z0`.
    TimeAndPlace,
}

struct Scope<'a, 's>(&'a Parameters<'s>, Dependence);

impl<'s> Parameters<'s> {
    /// The parameters `nodes` of `source`.
    ///
    /// # Errors
    /// Names that no formula can use; values that are neither number nor text.
    pub fn new(source: &'s Source, nodes: &'s [DocumentNode]) -> Result<Self, Fault> {
        for node in nodes {
            check_name(node)?;
            if !matches!(node.value, Value::Number(_) | Value::Text(_)) {
                return Err(node.fault("a number, or a formula or a word in quotes"));
            }
        }
        Ok(Parameters {
            source,
            nodes,
            by_name: nodes.iter().map(|node| (node.name(), node)).collect(),
            in_braces: OnceCell::new(),
            evaluated: RefCell::default(),
            pending: RefCell::default(),
            put: Cell::new(0),
            indices: RefCell::default(),
        })
    }

    /// Does `each` with an index at 0, 1 ... below `count`.
    ///
    /// # Errors
    /// A name that no formula can use or that something else has, and whatever `each` finds.
    pub fn with_index(
        &self,
        node: &DocumentNode,
        count: usize,
        each: &mut dyn FnMut() -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        check_name(node)?;
        let name = node.name();
        let is_taken =
            self.by_name.contains_key(name) || self.indices.borrow().iter().any(|(other, _)| other == name);
        if is_taken {
            let found = format!("the index `{name}`, which is the name of a parameter or of another index");
            return Err(Fault::new(&node.key(), found, "another name").at(node.name_span()));
        }
        for value in 0..count {
            self.indices.borrow_mut().push((name.to_string(), value));
            let done = each();
            self.indices.borrow_mut().pop();
            done?;
        }
        Ok(())
    }

    /// A fault with the present values of the indices.
    pub fn at_indices(&self, fault: Fault) -> Fault {
        let values: Vec<_> =
            self.indices.borrow().iter().map(|(name, value)| format!("{name} = {value}")).collect();
        if values.is_empty() { fault } else { fault.remark(&format!("this is with {}", values.join(", "))) }
    }

    /// The present value of an index; parameters, which are the same everywhere, have none.
    fn index(&self, name: &str) -> Option<usize> {
        let outside = self.pending.borrow().is_empty();
        let indices = self.indices.borrow();
        indices.iter().filter(|_| outside).find(|(other, _)| *other == name).map(|(_, value)| *value)
    }

    /// Every parameter with its value in this run. A text that has no value as a formula is a word.
    ///
    /// # Errors
    /// A formula that is wrong, unless it is a single word or used as text: `"{contact}"`.
    pub fn resolved(&self) -> Result<BTreeMap<String, Parameter>, Fault> {
        let mut resolved = BTreeMap::new();
        for node in self.nodes {
            let value = match self.quantity(node.name()) {
                Some(Ok(quantity)) => Parameter::Number(quantity.value),
                Some(Err(fault)) if !(is_word(node) || self.is_used_as_text(node.name())) => {
                    return Err(fault);
                }
                _ => Parameter::Text(self.text(node)?),
            };
            resolved.insert(node.name().to_string(), value);
        }
        Ok(resolved)
    }

    /// What a number or a formula says.
    ///
    /// # Errors
    /// A value that is no number and no formula, and whatever is wrong with the formula;
    /// `allowed` says what would be right.
    pub fn formula(
        &self,
        node: &DocumentNode,
        variation: Dependence,
        allowed: &str,
    ) -> Result<Formula, Fault> {
        match &node.value {
            Value::Number(number) => {
                Ok(Formula { expression: Expression::Constant(*number), kind: NumberKind::Number })
            }
            Value::Text(text) => {
                formula::compile(text, &Scope(self, variation)).map_err(|error| match error {
                    FormulaError::Parameter(fault) => fault,
                    FormulaError::Here(misread) => Fault::new(&node.key(), misread.found, misread.allowed)
                        .help(misread.help)
                        .at(self.source.inside(node, misread.span)),
                })
            }
            _ => Err(node.fault(allowed)),
        }
    }

    /// A text with the parameters in it, `{name}`, replaced by their values; `{{` is a brace.
    ///
    /// # Errors
    /// A value that is no text, a parameter that does not exist, a brace without end.
    pub fn text(&self, node: &DocumentNode) -> Result<String, Fault> {
        let text = match &node.value {
            Value::Text(text) => text,
            Value::Number(number) => return Ok(number.to_string()),
            _ => return Err(node.fault("text in quotes")),
        };
        if self.pending.borrow().is_empty() {
            self.put.set(0);
        }
        let too_long = || {
            Fault::new(&node.key(), "text that grows without end", "parameters that put less into each other")
        };
        let mut result = String::new();
        let mut at = 0;
        while let Some(brace) = text[at..].find('{') {
            result.push_str(&text[at..at + brace]);
            let open = at + brace;
            let rest = &text[open + 1..];
            if rest.starts_with('{') {
                result.push('{');
                at = open + 2;
                continue;
            }
            let Some(length) = rest.find('}') else {
                let fault =
                    Fault::new(&node.key(), "`{` without `}`", "a parameter in braces: \"{contact}\"");
                return Err(fault
                    .help(Some("`{{` is a brace itself".to_string()))
                    .at(self.source.inside(node, open..text.len())));
            };
            let name = rest[..length].trim();
            self.put.set(self.put.get() + 1);
            if self.put.get() > MOST_PUT || result.len() > LONGEST_TEXT {
                return Err(too_long().at(self.source.inside(node, open..open + length + 2)));
            }
            let shift = open + 1 + rest[..length].len() - rest[..length].trim_start().len();
            result.push_str(&self.word(name).unwrap_or_else(|| self.number_as_text(node, name, shift))?);
            at = open + length + 2;
        }
        result.push_str(&text[at..]);
        match result.chars().find(|&letter| is_no_letter(letter)) {
            Some(letter) => {
                let found = format!("text with the control character {letter:?}");
                Err(Fault::new(&node.key(), found, "text of letters, digits, signs and spaces")
                    .at(node.span()))
            }
            None => Ok(result),
        }
    }

    /// What a formula in braces gives, `{i + 1}`: a number without a unit; `shift` is where it begins in the text.
    fn number_as_text(&self, node: &DocumentNode, text: &str, shift: usize) -> Result<String, Fault> {
        let place = || self.source.inside(node, shift..shift + text.len());
        if is_plain(text) && self.index(text).is_none() {
            let allowed = format!("a parameter ({})", self.names().join(", "));
            return Err(Fault::new(&node.key(), format!("unknown parameter `{text}`"), allowed)
                .help(did_you_mean(text, self.names().iter().map(String::as_str)))
                .at(self.source.inside(node, shift - 1..shift + text.len() + 1)));
        }
        let formula =
            formula::compile(text, &Scope(self, Dependence::Constant)).map_err(|error| match error {
                FormulaError::Parameter(fault) => fault,
                FormulaError::Here(misread) => {
                    Fault::new(&node.key(), misread.found, misread.allowed).help(misread.help).at(place())
                }
            })?;
        let value = formula.expression.at(0.0);
        if formula.kind.fits(Powers::NONE) && value.is_finite() {
            return Ok(value.to_string());
        }
        Err(Fault::new(&node.key(), format!("`{text}`"), "a number without a unit in braces").at(place()))
    }

    /// The parameter as text, if there is one of that name.
    fn word(&self, name: &str) -> Option<Result<String, Fault>> {
        let node = self.by_name.get(name)?;
        Some(self.guarded(node, || self.text(node)))
    }

    /// The parameter as a number, if there is one of that name.
    fn quantity(&self, name: &str) -> Option<Result<FormulaNumber, Fault>> {
        let node = *self.by_name.get(name)?;
        if let Some(known) = self.evaluated.borrow().get(name) {
            return Some(known.clone());
        }
        let quantity = self.guarded(node, || {
            let formula = self.formula(node, Dependence::Constant, "a number")?;
            let kind = if formula.kind == NumberKind::Number { NumberKind::Any } else { formula.kind };
            Ok(FormulaNumber { value: formula.expression.at(0.0), kind })
        });
        self.evaluated.borrow_mut().insert(node.name(), quantity.clone());
        Some(quantity)
    }

    /// `evaluate`, unless that is going on already.
    fn guarded<T>(
        &self,
        node: &'s DocumentNode,
        evaluate: impl FnOnce() -> Result<T, Fault>,
    ) -> Result<T, Fault> {
        if let Some(first) = self.pending.borrow().iter().position(|name| *name == node.name()) {
            let circle = self.pending.borrow()[first..].join(" -> ");
            let allowed = "parameters that do not need each other in a circle";
            return Err(Fault::new(&node.key(), format!("the circle {circle} -> {}", node.name()), allowed));
        }
        if self.pending.borrow().len() >= LONGEST_CHAIN {
            let found = format!("a chain of more than {LONGEST_CHAIN} parameters that wait for each other");
            let fault = Fault::new(&node.key(), found, "shorter chains");
            return Err(fault
                .help(Some("put those that others need first".to_string()))
                .at(node.name_span()));
        }
        self.pending.borrow_mut().push(node.name());
        let result = evaluate();
        self.pending.borrow_mut().pop();
        result
    }

    /// Does any text in the scene say `{name}`?
    fn is_used_as_text(&self, name: &str) -> bool {
        let collect = || {
            let mut found = HashSet::new();
            collect_in_braces(self.source.root(), &mut found);
            found
        };
        self.in_braces.get_or_init(collect).contains(name)
    }

    /// Names of the parameters, and of the indices where they have values.
    fn names(&self) -> Vec<String> {
        let indices = self.indices.borrow();
        let parameters = self.nodes.iter().map(|node| node.name().to_string());
        parameters.chain(indices.iter().map(|(name, _)| name.clone())).collect()
    }
}

impl Names for Scope<'_, '_> {
    fn meaning(&self, name: &str) -> Meaning {
        if name == "t" && matches!(self.1, Dependence::Time | Dependence::TimeAndPlace) {
            return Meaning::Time;
        }
        let coordinate = PLACE.iter().position(|other| *other == name);
        let coordinate =
            coordinate.filter(|_| matches!(self.1, Dependence::Place | Dependence::TimeAndPlace));
        if let Some(value) = self.0.index(name) {
            if coordinate.is_some() {
                let found = format!("the index `{name}`, which is a place in formulas of loads");
                return Meaning::Wrong(Fault::new("", found, "another name"));
            }
            return Meaning::Value(FormulaNumber { value: value as f64, kind: NumberKind::Number });
        }
        match (self.0.quantity(name), coordinate) {
            (Some(_), Some(_)) => {
                let found = format!("the name `{name}`, which is a place in formulas of loads");
                Meaning::Wrong(Fault::new(&format!("parameters.{name}"), found, "another name"))
            }
            (None, Some(coordinate)) => Meaning::Place(coordinate),
            (Some(Ok(quantity)), None) => Meaning::Value(quantity),
            (Some(Err(fault)), None) => Meaning::Wrong(fault),
            (None, None) => Meaning::Unknown,
        }
    }

    fn all(&self) -> Vec<String> {
        self.0.names()
    }
}

/// Whether a formula can use a name.
fn is_plain(name: &str) -> bool {
    name.starts_with(|first: char| first.is_alphabetic() || first == '_')
        && name.chars().all(|letter| letter.is_alphanumeric() || letter == '_')
}

/// Refuses the name of a key that is to be used in formulas, if they cannot.
fn check_name(node: &DocumentNode) -> Result<(), Fault> {
    let name = node.name();
    let fault =
        |found: String, allowed: &str| Err(Fault::new(&node.key(), found, allowed).at(node.name_span()));
    if !is_plain(name) {
        return fault(format!("the name `{name}`"), "letters, digits and _, not beginning with a digit");
    }
    if formula::reserved().any(|word| word == name) {
        return fault(format!("the name `{name}`, which formulas use already"), "another name");
    }
    Ok(())
}

/// `gap`, `modified-last`
fn is_word(node: &DocumentNode) -> bool {
    matches!(&node.value, Value::Text(text) if text.starts_with(char::is_alphabetic)
        && text.chars().all(|letter| letter.is_alphanumeric() || letter == '-' || letter == '_'))
}

/// What the texts at a node and below it have in braces.
fn collect_in_braces<'s>(node: &'s DocumentNode, found: &mut HashSet<&'s str>) {
    if let Value::Text(text) = &node.value {
        let rests = text.split('{').skip(1);
        found.extend(rests.filter_map(|rest| rest.split_once('}').map(|(inner, _)| inner.trim())));
    }
    node.children().iter().for_each(|child| collect_in_braces(child, found));
}
