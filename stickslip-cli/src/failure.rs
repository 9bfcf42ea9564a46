//! What can go wrong for a user, how it is printed, and the exit code it gives.

use crate::drawing::DrawError;
use crate::progress::terminal;
use crate::tell::tell;
use miette::{Diagnostic, GraphicalReportHandler, Report};
use std::io::{self, ErrorKind};
use std::path::Path;

/// Why a command did not do what it was asked.
#[derive(Debug)]
pub enum Failure {
    /// The input is at fault: a scene, a folder, a flag.
    Input(Report),
    /// The input is sound, yet the run or its outputs went wrong.
    Run(Report),
    /// The run ended, and so many of its warnings count as a failure.
    Doubtful(usize),
    /// A run that was made again did not end in the same bits.
    Differs,
    /// Scenes of the gallery failed, each with a message of its own, or their checks do not hold.
    Gallery {
        /// Those that failed, and the exit code of the first one.
        failed: (Vec<&'static str>, u8),
        /// Those whose checks do not hold.
        untrue: Vec<&'static str>,
    },
    /// The user stopped it; everything written is valid.
    Interrupted,
    /// It took as long as it was given, by `--max-time`; everything written is valid.
    OutOfTime,
}

impl Failure {
    /// Exit code after Ctrl-C, as shells count it: 128 + SIGINT.
    pub const INTERRUPTED: u8 = 130;

    /// The input is at fault.
    pub fn input(error: impl Diagnostic + Send + Sync + 'static) -> Self {
        Failure::Input(Report::new(error))
    }

    /// The run went wrong.
    pub fn run(error: impl Diagnostic + Send + Sync + 'static) -> Self {
        Failure::Run(Report::new(error))
    }

    /// A file could not be written: the path is at fault, or the disk.
    pub fn unwritten(path: &Path, error: &io::Error) -> Self {
        let report = miette::miette!("cannot write {}: {error}", path.display());
        match error.kind() {
            ErrorKind::NotFound
            | ErrorKind::PermissionDenied
            | ErrorKind::ReadOnlyFilesystem
            | ErrorKind::AlreadyExists
            | ErrorKind::IsADirectory
            | ErrorKind::NotADirectory
            | ErrorKind::InvalidInput
            | ErrorKind::InvalidFilename => Failure::Input(report),
            _ => Failure::Run(report),
        }
    }

    /// The same where the run is over: its input was sound, or it would not have begun.
    pub fn after_the_run(self) -> Self {
        match self {
            Failure::Input(report) => Failure::Run(report),
            other => other,
        }
    }

    /// 2 for input, 1 for a run, 3 for results that are doubtful or untrue, 4 for a run out of its time, 130 for
    /// Ctrl-C.
    pub fn exit_code(&self) -> u8 {
        match self {
            Failure::Input(_) => 2,
            Failure::Run(_) => 1,
            Failure::Gallery { failed: (scenes, code), .. } if !scenes.is_empty() => *code,
            Failure::Doubtful(_) | Failure::Differs | Failure::Gallery { .. } => 3,
            Failure::OutOfTime => 4,
            Failure::Interrupted => Self::INTERRUPTED,
        }
    }

    /// Prints to standard error: with the lines at fault on a terminal, as `file:line:column: error: ...` elsewhere.
    pub fn print(&self) {
        match self {
            Failure::Interrupted => tell!("interrupted; everything written is valid"),
            Failure::OutOfTime => tell!("out of time; everything written is valid"),
            Failure::Doubtful(_) | Failure::Differs | Failure::Gallery { .. } => tell!("error: {self}"),
            Failure::Input(report) | Failure::Run(report) => {
                let mut text = String::new();
                let drawn = terminal()
                    && GraphicalReportHandler::new()
                        .render_report(&mut text, &DrawnError::new(report))
                        .is_ok();
                if !drawn {
                    text = plain(report.as_ref());
                }
                tell!("{}", text.trim_end());
            }
        }
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Failure::Interrupted => f.write_str("interrupted"),
            Failure::OutOfTime => f.write_str("out of time"),
            Failure::Differs => f.write_str("the run did not end in the same bits"),
            Failure::Gallery { failed: (failed, _), untrue } => {
                let failed = Some(failed).filter(|scenes| !scenes.is_empty());
                let untrue = Some(untrue).filter(|scenes| !scenes.is_empty());
                let told = [("these scenes failed", failed), ("the check does not hold", untrue)];
                let told = told.into_iter().filter_map(|(what, scenes)| Some((what, scenes?.join(", "))));
                f.write_str(
                    &told.map(|(what, scenes)| format!("{what}: {scenes}")).collect::<Vec<_>>().join("; "),
                )
            }
            Failure::Doubtful(1) => f.write_str("the results are doubtful: 1 warning, with --strict"),
            Failure::Doubtful(count) => {
                write!(f, "the results are doubtful: {count} warnings, with --strict")
            }
            Failure::Input(report) | Failure::Run(report) => report.fmt(f),
        }
    }
}

impl From<DrawError> for Failure {
    fn from(error: DrawError) -> Self {
        match error {
            DrawError::Write { path, source } => Failure::unwritten(&path, &source),
            DrawError::Empty(_) => Failure::Input(miette::miette!("{error}")),
            DrawError::Ink(_) => Failure::Run(miette::miette!("{error}")),
        }
    }
}

/// An error as it is drawn over the lines at fault: its place and its remedy are drawn too,
/// so the headline leaves them out.
#[derive(Debug, thiserror::Error)]
#[error("{headline}")]
struct DrawnError<'a> {
    headline: String,
    error: &'a dyn Diagnostic,
}

impl<'a> DrawnError<'a> {
    fn new(report: &'a Report) -> Self {
        let error: &dyn Diagnostic = report.as_ref();
        let message = error.to_string();
        let mut headline = message.as_str();
        if let Some((place, _)) = places(error).first() {
            headline = headline.strip_prefix(&format!("{place}: ")).unwrap_or(headline);
        }
        if let Some(help) = error.help() {
            headline = headline.strip_suffix(&format!("; {help}")).unwrap_or(headline);
        }
        DrawnError { headline: headline.to_owned(), error }
    }
}

impl Diagnostic for DrawnError<'_> {
    fn help<'b>(&'b self) -> Option<Box<dyn std::fmt::Display + 'b>> {
        self.error.help()
    }

    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        self.error.source_code()
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = miette::LabeledSpan> + '_>> {
        self.error.labels()
    }
}

/// A line for each place at fault, one for the remedy, and so on for the errors that came along.
///
/// What the message says already, its place or its remedy, is not said again.
fn plain(error: &dyn Diagnostic) -> String {
    let message = error.to_string();
    let places = places(error);
    let mut text = match places.first() {
        Some((place, _)) if !message.starts_with(place.as_str()) => format!("{place}: error: {message}\n"),
        Some(_) => format!("{message}\n"),
        None => format!("error: {message}\n"),
    };
    for (place, label) in &places {
        if let Some(label) = label.as_deref().filter(|label| !message.contains(label)) {
            text += &format!("{place}: note: {label}\n");
        }
    }
    let help = error.help().map(|help| help.to_string());
    if let Some(help) = help.filter(|help| !message.contains(help.as_str())) {
        text += &format!("  help: {help}\n");
    }
    text.extend(error.related().into_iter().flatten().map(plain));
    text
}

/// `file:line:column` of every label, and what the label says.
fn places(error: &dyn Diagnostic) -> Vec<(String, Option<String>)> {
    let (Some(source), Some(labels)) = (error.source_code(), error.labels()) else { return Vec::new() };
    let place = |label: miette::LabeledSpan| {
        let contents = source.read_span(label.inner(), 0, 0).ok()?;
        let file = contents.name().unwrap_or("scene");
        let place = format!("{file}:{}:{}", contents.line() + 1, contents.column() + 1);
        Some((place, label.label().map(str::to_owned)))
    };
    labels.filter_map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use miette::{LabeledSpan, MietteDiagnostic, NamedSource};

    #[test]
    fn a_plain_error_names_file_line_and_column() {
        let error = MietteDiagnostic::new("unknown key `radios`")
            .with_help("did you mean `radius`?")
            .with_label(LabeledSpan::at(8..14, "here"));
        let report =
            Report::new(error).with_source_code(NamedSource::new("a.toml", "[ball]\n\nradios = 1\n"));
        let text = plain(report.as_ref());
        assert!(text.starts_with("a.toml:3:1: error: unknown key `radios`\n"), "{text}");
        assert!(text.contains("  help: did you mean `radius`?"), "{text}");
    }

    #[test]
    fn a_message_that_names_its_place_does_not_get_it_twice() {
        let error = MietteDiagnostic::new("a.toml:1:1: unknown key `radios`")
            .with_label(LabeledSpan::at(0..6, "unknown key `radios`"));
        let report = Report::new(error).with_source_code(NamedSource::new("a.toml", "radios = 1\n"));
        assert_eq!(plain(report.as_ref()), "a.toml:1:1: unknown key `radios`\n");
    }

    #[test]
    fn a_drawn_error_says_place_and_remedy_once() {
        let error = MietteDiagnostic::new("a.toml:1:1: unknown key `radios`; did you mean `radius`?")
            .with_help("did you mean `radius`?")
            .with_label(LabeledSpan::at(0..6, "here"));
        let report = Report::new(error).with_source_code(NamedSource::new("a.toml", "radios = 1\n"));
        let mut text = String::new();
        GraphicalReportHandler::new().render_report(&mut text, &DrawnError::new(&report)).unwrap();
        assert_eq!(text.matches("a.toml:1:1").count(), 1, "{text}");
        assert_eq!(text.matches("did you mean").count(), 1, "{text}");
    }

    #[test]
    fn an_error_without_a_place_is_still_an_error() {
        assert_eq!(plain(Report::msg("no such file").as_ref()), "error: no such file\n");
    }
}
