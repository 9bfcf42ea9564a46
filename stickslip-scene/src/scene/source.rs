//! The text of a scene and where each key stands in it.

use super::document_node::{DocumentNode, Value};
use super::error::{Fault, Mistake, SceneError};
use super::letters::steers_text;
use super::{Problem, overrides};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use toml::de::{DeTable, DeValue};

/// The text of a scene and where each key stands in it, so that a [`Problem`] found later can be shown in its place.
#[derive(Clone, Debug)]
pub struct Source {
    /// The file, then each override: all in one range of byte positions, one after the other.
    documents: Vec<Document>,
    /// Where the files lie that it names.
    folder: PathBuf,
    root: DocumentNode,
    declared: Declared,
    told: Vec<Told>,
}

/// A key of the file that does nothing: its path, and why.
pub(super) type Told = (String, String);

/// Lists of the scene by their keys, and of each entry the table of the file that stands for it: one table may stand
/// for many entries.
pub(super) type Declared = BTreeMap<&'static str, Vec<String>>;

#[derive(Clone, Debug)]
struct Document {
    name: String,
    text: String,
    start: usize,
    /// Where its lines begin, once somebody asks.
    lines: OnceLock<Vec<usize>>,
}

/// Values that a scene file may have, by the signs around them: what they take in memory is some 150 bytes each.
const MOST_VALUES: usize = 10_000_000;
/// Bytes that a key may have in its table: the paths of all values in it begin with it.
const LONGEST_NAME: usize = 1000;

impl Source {
    /// Reads TOML and puts the overrides `name=value` in it.
    ///
    /// # Errors
    /// Text that is no TOML; overrides of parameters that do not exist.
    pub(super) fn read(name: &str, text: &str, overrides: &[(String, String)]) -> Result<Source, SceneError> {
        let document =
            Document { name: name.to_string(), text: text.to_string(), start: 0, lines: OnceLock::new() };
        let folder = Path::new(name).parent().map(Path::to_path_buf).unwrap_or_default();
        let mut source = Source {
            documents: vec![document],
            folder,
            root: DocumentNode::file(&DeTable::default()),
            declared: Declared::new(),
            told: Vec::new(),
        };
        // Before it is parsed: each value takes a hundred times its letter.
        if let Some((at, _)) = text.match_indices([',', '=', '[']).nth(MOST_VALUES) {
            let (found, allowed) = ("more values than a scene may have", format!("at most {MOST_VALUES}"));
            let help =
                "long tables and particles lie in CSV files, and many bodies are repeated by one table";
            let fault = Fault::new("", found, allowed).help(Some(help.to_string()));
            return Err(source.show(fault.at(at..at + 1)));
        }
        let table = DeTable::parse(text).map_err(|error| source.show(syntax_fault(text, &error)))?;
        if let Some(span) = long_name(table.get_ref()) {
            let allowed = format!("at most {LONGEST_NAME} bytes");
            let found = format!("a key of {} bytes", span.len());
            return Err(source.show(Fault::new("", found, allowed).at(span)));
        }
        source.root = DocumentNode::file(table.get_ref());
        drop(table);
        for (name, value) in overrides {
            let start = source.end() + 1;
            let name = name.trim();
            let (title, text) = (format!("--set {name}"), format!("{name}={value}"));
            let document = Document { name: title, text, start, lines: OnceLock::new() };
            source.documents.push(document);
            let place =
                overrides::OverridePlace { name: start..start + name.len(), value: start + name.len() + 1 };
            overrides::put(&mut source.root, name, value, &place).map_err(|fault| source.show(fault))?;
        }
        Ok(source)
    }

    /// The error for a problem, at its key or the nearest key around it that exists.
    pub fn locate(&self, problem: Problem) -> SceneError {
        self.show(Problem { key: self.written(&problem.key), ..problem }.into())
    }

    /// Says which tables of the file stand for the entries of lists.
    pub(super) fn declare(&mut self, declared: Declared) {
        self.declared = declared;
    }

    /// Keeps which keys of the file do nothing.
    pub(super) fn tell(&mut self, told: Vec<Told>) {
        self.told = told;
    }

    /// Keys of the file that do nothing, each with the reason.
    pub fn told(&self) -> &[(String, String)] {
        &self.told
    }

    /// The key in the file of a key of the scene: of body 17, which a table stands for that is repeated, `bodies[2]`.
    pub fn written(&self, key: &str) -> String {
        let entry = || {
            let (list, rest) = key.split_once('[')?;
            let (number, rest) = rest.split_once(']')?;
            let table = self.declared.get(list)?.get(number.parse::<usize>().ok()?)?;
            Some(format!("{table}{rest}"))
        };
        entry().unwrap_or_else(|| key.to_string())
    }

    /// File, line and column of a key of the file, or of the nearest key around it that exists: `scene.toml:49:1`.
    pub fn place(&self, key: &str) -> String {
        let (document, start, _) = self.within(&self.span_of(key));
        let [line, column] = document.line_and_column(start);
        format!("{}:{line}:{column}", document.name)
    }

    /// The same whose files lie in another folder than its name says, which is one that text cannot have.
    pub(super) fn beside(self, folder: &Path) -> Self {
        Source { folder: folder.to_path_buf(), ..self }
    }

    /// Where the files lie that it names.
    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Name of the file.
    pub fn name(&self) -> &str {
        &self.documents[0].name
    }

    /// Text of the file.
    pub fn text(&self) -> &str {
        &self.documents[0].text
    }

    pub(super) fn root(&self) -> &DocumentNode {
        &self.root
    }

    /// Where in all documents the letter `at` of the text value `node` stands, if it is written without escapes.
    pub(super) fn inside(&self, node: &DocumentNode, at: Range<usize>) -> Range<usize> {
        let Value::Text(text) = &node.value else { return node.span() };
        let document = self.document(node.span().start);
        let written = &document.text[node.span().start - document.start..node.span().end - document.start];
        match written.find(text.as_str()) {
            Some(quote) if written.len() <= text.len() + 2 * quote => {
                let start = node.span().start + quote;
                start + at.start..start + at.end
            }
            _ => node.span(),
        }
    }

    /// The error for a fault.
    pub(super) fn show(&self, fault: Fault) -> SceneError {
        let span = fault.span.unwrap_or_else(|| self.span_of(&fault.problem.key));
        let (document, start, end) = self.within(&span);
        let [line, column] = document.line_and_column(start);
        SceneError::Mistake(Box::new(Mistake {
            problem: fault.problem.shown(),
            file: document.name.clone(),
            line,
            column,
            span: start..end,
            text: without_control(&document.text),
        }))
    }

    /// The document that holds a span, and where in its text the span begins and ends.
    fn within(&self, span: &Range<usize>) -> (&Document, usize, usize) {
        let document = self.document(span.start);
        let boundary = |at: usize| {
            let at = at.saturating_sub(document.start).min(document.text.len());
            (0..=at).rfind(|at| document.text.is_char_boundary(*at)).unwrap_or(0)
        };
        (document, boundary(span.start), boundary(span.end.max(span.start)))
    }

    fn end(&self) -> usize {
        self.documents.iter().map(|document| document.start + document.text.len()).max().unwrap_or(0)
    }

    fn document(&self, at: usize) -> &Document {
        let found = self.documents.iter().rfind(|document| document.start <= at);
        found.expect("the first document starts at 0")
    }

    /// Where the key stands, or the nearest key around it.
    fn span_of(&self, key: &str) -> Range<usize> {
        let mut node = &self.root;
        while let Some(child) = node.child_around(key) {
            node = child;
        }
        if node.key() == key && !node.is_table() || node.name().is_empty() {
            node.span()
        } else {
            node.name_span()
        }
    }
}

impl Document {
    /// Line and column of a place in the text, each from 1.
    fn line_and_column(&self, at: usize) -> [usize; 2] {
        let starts = || [0].into_iter().chain(self.text.match_indices('\n').map(|(newline, _)| newline + 1));
        let lines = self.lines.get_or_init(|| starts().collect());
        let line = lines.partition_point(|&start| start <= at);
        [line, self.text[lines[line - 1]..at].chars().count() + 1]
    }
}

/// A text of the same length without what would steer a terminal.
fn without_control(text: &str) -> String {
    let letter = |letter: char| match steers_text(letter) {
        true => "?".repeat(letter.len_utf8()),
        false => letter.to_string(),
    };
    text.chars().map(letter).collect()
}

/// A key in a table, or in what it holds, that is longer than keys may be.
fn long_name(table: &DeTable<'_>) -> Option<Range<usize>> {
    fn within(value: &DeValue<'_>) -> Option<Range<usize>> {
        match value {
            DeValue::Array(items) => items.iter().find_map(|item| within(item.get_ref())),
            DeValue::Table(table) => long_name(table),
            _ => None,
        }
    }
    table.iter().find_map(|(name, value)| match name.get_ref().len() > LONGEST_NAME {
        true => Some(name.span()),
        false => within(value.get_ref()),
    })
}

fn syntax_fault(text: &str, error: &toml::de::Error) -> Fault {
    let span = error.span().unwrap_or(0..0);
    let message = error.message();
    if message.starts_with("string values must be quoted") {
        let help = "text, and numbers with units, stand in quotes: cell = \"0.4 m\"".to_string();
        let written = format!("`{}` without quotes", text[span.clone()].trim_end());
        return Fault::new("", written, "a number, or text in quotes").help(Some(help)).at(span);
    }
    if message.starts_with("duplicate key") {
        let found = format!("`{}` for the second time", &text[span.clone()]);
        return Fault::new("", found, "each key once").at(span);
    }
    Fault::new("", message, "TOML, see toml.io").at(span)
}
