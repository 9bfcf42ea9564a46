//! A mistake in a scene file, shown where it stands.

use super::Problem;
use std::ops::Range;
use std::path::PathBuf;

/// Why there is no scene.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum SceneError {
    /// The file cannot be read.
    #[error("{}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: std::io::Error,
        /// What to try.
        #[help]
        help: Option<String>,
    },
    /// The file says something that cannot be.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Mistake(Box<Mistake>),
}

/// A mistake with its place. Displayed, it is one line with all that is known; as a diagnostic it shows the source.
#[derive(Clone, Debug, PartialEq)]
pub struct Mistake {
    /// What is wrong.
    pub problem: Problem,
    /// Name of the file, or the `--set` argument.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    pub(super) text: String,
    pub(super) span: Range<usize>,
}

impl std::fmt::Display for Mistake {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Problem { key, found, allowed, help } = &self.problem;
        write!(formatter, "{}:{}:{}: ", self.file, self.line, self.column)?;
        if !key.is_empty() {
            write!(formatter, "{key}: ")?;
        }
        write!(formatter, "found {found}; allowed: {allowed}")?;
        match help {
            Some(help) => write!(formatter, "; {help}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Mistake {}

impl miette::Diagnostic for Mistake {
    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        Some(self)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = miette::LabeledSpan> + '_>> {
        let label = miette::LabeledSpan::new_with_span(Some(self.problem.found.clone()), self.span.clone());
        Some(Box::new(std::iter::once(label)))
    }

    fn help<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        self.problem.help.as_ref().map(|help| Box::new(help) as Box<dyn std::fmt::Display>)
    }
}

impl miette::SourceCode for Mistake {
    fn read_span<'a>(
        &'a self,
        span: &miette::SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn miette::SpanContents<'a> + 'a>, miette::MietteError> {
        let contents = self.text.read_span(span, lines_before, lines_after)?;
        Ok(Box::new(miette::MietteSpanContents::new_named(
            self.file.clone(),
            contents.data(),
            *contents.span(),
            contents.line(),
            contents.column(),
            contents.line_count(),
        )))
    }
}

/// A problem on its way to its place: the bytes at fault, if they are known better than the key tells.
#[derive(Clone, Debug)]
pub(super) struct Fault {
    pub problem: Box<Problem>,
    pub span: Option<Range<usize>>,
}

impl From<Problem> for Fault {
    fn from(problem: Problem) -> Self {
        Fault { problem: Box::new(problem), span: None }
    }
}

impl Fault {
    /// A fault of the key `key`.
    pub fn new(key: &str, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        let (found, allowed) = (found.into(), allowed.into());
        Problem { key: key.to_string(), found, allowed, help: None }.into()
    }

    /// The same with advice.
    pub fn help(mut self, help: Option<String>) -> Self {
        self.problem.help = help;
        self
    }

    /// The same with more advice.
    pub fn remark(mut self, text: &str) -> Self {
        let help = self.problem.help.take();
        self.problem.help = Some(help.map_or(text.to_string(), |help| format!("{help}; {text}")));
        self
    }

    /// The same at other bytes.
    pub fn at(mut self, span: Range<usize>) -> Self {
        self.span = Some(span);
        self
    }
}
