//! Values of a scene file with their keys and their places.

use super::error::Fault;
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A value with its key and its place: small, and copied without what it holds, as tables of millions of numbers are
/// made of them.
#[derive(Clone, Debug)]
pub(in crate::scene) struct DocumentNode {
    path: Path,
    name_span: Span,
    span: Span,
    pub value: Value,
}

/// What a scene file can hold.
#[derive(Clone, Debug)]
pub(in crate::scene) enum Value {
    Number(f64),
    Text(String),
    /// True, false, and dates: no key takes them.
    Other(String),
    List(Arc<[DocumentNode]>),
    /// In the order of the file.
    Table(Arc<[DocumentNode]>),
}

/// A key: its last step, and that of the list or table around it. The whole text is put together when somebody asks.
#[derive(Clone, Debug)]
pub(in crate::scene) struct Path {
    around: Option<Arc<Path>>,
    step: Step,
}

#[derive(Clone, Debug)]
enum Step {
    /// The whole file.
    File,
    /// In a table.
    Name(Arc<str>),
    /// In a list.
    Number(u32),
}

/// Where letters stand among all documents.
#[derive(Clone, Copy, Debug)]
struct Span([u32; 2]);

impl DocumentNode {
    /// All that a file holds.
    pub fn file(table: &DeTable<'_>) -> DocumentNode {
        let path = Path { around: None, step: Step::File };
        let value = table_value(table, &path, 0);
        DocumentNode { path, name_span: Span([0; 2]), span: Span([0; 2]), value }
    }

    /// The whole path: `bodies[1].shape.ball`.
    pub fn key(&self) -> String {
        self.path.text()
    }

    /// The last word of the path; empty in a list.
    pub fn name(&self) -> &str {
        if let Step::Name(name) = &self.path.step { name } else { "" }
    }

    /// Where the key stands.
    pub fn name_span(&self) -> Range<usize> {
        self.name_span.range()
    }

    /// Where the value stands; for a table under a header, the header.
    pub fn span(&self) -> Range<usize> {
        self.span.range()
    }

    /// Values in a list or a table.
    pub fn children(&self) -> &[DocumentNode] {
        match &self.value {
            Value::List(children) | Value::Table(children) => children,
            _ => &[],
        }
    }

    /// Puts another value in its place, which `name` names; `start` is that of the document which the value stands in.
    pub fn put(&mut self, name: &Range<usize>, (value, start): (&Spanned<DeValue<'_>>, usize)) {
        *self = DocumentNode { name_span: name.into(), ..node(value, self.path.clone(), start) };
    }

    /// The same with another value, as if that stood there.
    pub fn with(&self, value: Value) -> DocumentNode {
        DocumentNode { value, ..self.clone() }
    }

    /// Puts a text in its place.
    pub fn put_text(&mut self, name: &Range<usize>, (text, at): (&str, Range<usize>)) {
        let value = Value::Text(text.to_string());
        *self = DocumentNode { path: self.path.clone(), name_span: name.into(), span: (&at).into(), value };
    }

    /// What a table that stands at `path` has by a name: an empty table if it has nothing.
    pub fn entry<'n>(
        children: &'n mut Arc<[DocumentNode]>,
        path: &Path,
        (name, at): (&str, &Range<usize>),
    ) -> &'n mut DocumentNode {
        let found = children.iter().position(|child| child.name() == name);
        if found.is_none() {
            let path = Path { around: Some(Arc::new(path.clone())), step: Step::Name(name.into()) };
            let (name_span, span, value) = (at.into(), at.into(), Value::Table([].into()));
            let empty = DocumentNode { path, name_span, span, value };
            *children = children.iter().cloned().chain([empty]).collect();
        }
        let at = found.unwrap_or(children.len() - 1);
        &mut Arc::make_mut(children)[at]
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The child that is at a key or around it.
    pub fn child_around(&self, key: &str) -> Option<&DocumentNode> {
        let rest = key.strip_prefix(self.key().as_str()).filter(|rest| !rest.is_empty())?;
        if let Value::List(items) = &self.value {
            // Entries are found by their numbers.
            let (number, rest) = rest.strip_prefix('[')?.split_once(']')?;
            return items.get(number.parse::<usize>().ok()?).filter(|_| begins_a_step(rest));
        }
        let rest = rest.strip_prefix('.').unwrap_or(rest);
        self.children().iter().find(|child| rest.strip_prefix(child.name()).is_some_and(begins_a_step))
    }

    pub fn is_table(&self) -> bool {
        matches!(self.value, Value::Table(_))
    }

    /// The value as the user would recognise it: `"6 MPa"`, `3`, `a table`.
    pub fn found(&self) -> String {
        match &self.value {
            Value::Number(number) => format!("{number}"),
            Value::Text(text) => format!("{text:?}"),
            Value::Other(text) => format!("`{text}`"),
            Value::List(items) if items.len() <= 3 && !items.iter().any(|item| item.is_table()) => {
                format!("[{}]", items.iter().map(DocumentNode::found).collect::<Vec<_>>().join(", "))
            }
            Value::List(items) => format!("a list of {}", items.len()),
            Value::Table(_) => "a table".to_string(),
        }
    }

    /// A fault of this value.
    pub fn fault(&self, allowed: impl Into<String>) -> Fault {
        Fault::new(&self.key(), self.found(), allowed).at(self.place())
    }

    fn place(&self) -> Range<usize> {
        if self.is_table() && !self.name().is_empty() { self.name_span() } else { self.span() }
    }
}

impl Path {
    fn text(&self) -> String {
        let around = self.around.as_ref().map(|around| around.text()).unwrap_or_default();
        match &self.step {
            Step::File => around,
            Step::Name(name) => joined(&around, name),
            Step::Number(number) => format!("{around}[{number}]"),
        }
    }
}

impl Span {
    fn range(self) -> Range<usize> {
        let Span([start, end]) = self;
        start as usize..end as usize
    }
}

impl From<&Range<usize>> for Span {
    /// Beyond four gigabytes, places are not told apart.
    fn from(range: &Range<usize>) -> Span {
        Span([range.start, range.end].map(|at| u32::try_from(at).unwrap_or(u32::MAX)))
    }
}

/// The path of `name` in the table `key`.
pub(in crate::scene) fn joined(key: &str, name: &str) -> String {
    if key.is_empty() { name.to_string() } else { format!("{key}.{name}") }
}

/// Whether what follows a key is nothing or another step.
fn begins_a_step(rest: &str) -> bool {
    rest.is_empty() || rest.starts_with(['.', '['])
}

fn table_value(table: &DeTable<'_>, path: &Path, shift: usize) -> Value {
    let around = Arc::new(path.clone());
    let named = |(name, value): (&Spanned<Cow<'_, str>>, &Spanned<DeValue<'_>>)| {
        let path = Path { around: Some(Arc::clone(&around)), step: Step::Name((**name.get_ref()).into()) };
        DocumentNode { name_span: shifted(name.span(), shift), ..node(value, path, shift) }
    };
    let mut nodes: Vec<DocumentNode> = table.iter().map(named).collect();
    nodes.sort_by_key(|node| node.name_span().start);
    Value::Table(nodes.into())
}

fn list_value(items: &[Spanned<DeValue<'_>>], path: &Path, shift: usize) -> Value {
    let around = Arc::new(path.clone());
    let numbered = |(number, item): (u32, &Spanned<DeValue<'_>>)| {
        node(item, Path { around: Some(Arc::clone(&around)), step: Step::Number(number) }, shift)
    };
    Value::List((0..).zip(items).map(numbered).collect())
}

fn shifted(span: Range<usize>, shift: usize) -> Span {
    (&(span.start + shift..span.end + shift)).into()
}

/// The value with all keys and places in it; `shift` is the start of its document.
fn node(value: &Spanned<DeValue<'_>>, path: Path, shift: usize) -> DocumentNode {
    let span = shifted(value.span(), shift);
    let value = match value.get_ref() {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(integer) => {
            let whole = i64::from_str_radix(integer.as_str(), integer.radix());
            whole.map_or_else(
                |_| Value::Other(integer.as_str().to_string()),
                |whole| Value::Number(whole as f64),
            )
        }
        DeValue::Float(float) => {
            let number = float.as_str().parse();
            number.map_or_else(|_| Value::Other(float.as_str().to_string()), Value::Number)
        }
        DeValue::Boolean(truth) => Value::Other(truth.to_string()),
        DeValue::Datetime(date) => Value::Other(date.to_string()),
        DeValue::Array(items) => list_value(items, &path, shift),
        DeValue::Table(table) => table_value(table, &path, shift),
    };
    DocumentNode { path, name_span: span, span, value }
}
