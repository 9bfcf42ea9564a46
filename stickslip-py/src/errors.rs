//! Errors of the library as exceptions of `stickslip.errors`, with the message, the place and the advice that the
//! command prints.

use miette::{Diagnostic, LabeledSpan};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use stickslip::door::{NoColumn, StepError, WriteError};
use stickslip::march::MarchError;
use stickslip::run::RunError;
use stickslip::scene::{Loaded, Mistake, Problem, SceneError};

/// What an exception has beside its message.
type Facts<'py> = Vec<(&'static str, Bound<'py, PyAny>)>;

/// An exception of this class.
fn exception(py: Python<'_>, class: &str, message: &str, facts: Facts<'_>) -> PyErr {
    let made = || -> PyResult<PyErr> {
        let named = PyDict::new(py);
        facts.iter().try_for_each(|(name, value)| named.set_item(name, value))?;
        let class = py.import("stickslip.errors")?.getattr(class)?;
        Ok(PyErr::from_value(class.call((message,), Some(&named))?))
    };
    made().unwrap_or_else(|error| error)
}

fn fact<'py>(py: Python<'py>, value: impl IntoPyObject<'py>) -> Bound<'py, PyAny> {
    value.into_bound_py_any(py).unwrap_or_else(|_| py.None().into_bound(py))
}

/// The lines at fault, each with what is wrong underlined.
///
/// ```text
///    3 | cell = "1 mmm"
///      |        ^^^^^^^
/// ```
fn lines_at_fault(error: &dyn Diagnostic) -> String {
    let (Some(source), Some(labels)) = (error.source_code(), error.labels()) else { return String::new() };
    let shown = |label: LabeledSpan| {
        let contents = source.read_span(label.inner(), 1, 1).ok()?;
        let text = String::from_utf8_lossy(contents.data());
        let (before, after) = text.split_at_checked(label.offset() - contents.span().offset())?;
        let number = contents.line() + 1 + before.matches('\n').count();
        let before = before.rsplit('\n').next().unwrap_or_default();
        let after = after.lines().next().unwrap_or_default();
        let indent: String = before.chars().map(|_| ' ').collect();
        let marked = label.len().clamp(1, after.chars().count().max(1));
        Some(format!("\n{number:>6} | {before}{after}\n       | {indent}{}", "^".repeat(marked)))
    };
    labels.filter_map(shown).collect()
}

/// What is wrong with a scene.
pub fn of_scene(py: Python<'_>, error: SceneError) -> PyErr {
    let (said, facts) = match &error {
        SceneError::Unreadable { path, help, .. } => {
            let advice = help.as_ref().map_or(String::new(), |help| format!("; {help}"));
            let facts =
                vec![("file", fact(py, path.display().to_string())), ("help", fact(py, help.clone()))];
            (advice, facts)
        }
        SceneError::Mistake(mistake) => {
            let Mistake { problem: Problem { key, found, allowed, help }, file, line, column, .. } =
                &**mistake;
            let facts = vec![
                ("file", fact(py, file.clone())),
                ("line", fact(py, *line)),
                ("column", fact(py, *column)),
                ("key", fact(py, key.clone())),
                ("found", fact(py, found.clone())),
                ("allowed", fact(py, allowed.clone())),
                ("help", fact(py, help.clone())),
            ];
            (lines_at_fault(&error), facts)
        }
    };
    let message = format!("{error}{said}");
    exception(py, "SceneError", &message, facts)
}

/// A problem of a scene, in its place.
pub fn of_problem(py: Python<'_>, loaded: &Loaded, problem: Problem) -> PyErr {
    of_scene(py, loaded.source.locate(problem))
}

/// A step that went wrong.
pub fn of_step(py: Python<'_>, error: &StepError) -> PyErr {
    let said = format!("{error}; {}", error.advice());
    if let StepError::Outside { time, reason, .. } = error {
        let facts = vec![("time", fact(py, *time)), ("help", fact(py, error.advice()))];
        let raised = exception(py, "StepError", &said, facts);
        raised.set_cause(py, reason.0.downcast_ref::<PyErr>().map(|cause| cause.clone_ref(py)));
        return raised;
    }
    let (StepError::Inverted { body, number, position, time, .. }
    | StepError::Escaped { body, number, position, time, .. }
    | StepError::NoThickness { body, number, position, time }
    | StepError::Shrunk { body, number, position, time }
    | StepError::NotFinite { body, number, position, time }) = error
    else {
        return exception(py, "StepError", &said, Vec::new());
    };
    let facts = vec![
        ("body", fact(py, body.clone())),
        ("particle", fact(py, *number)),
        ("position", fact(py, position.to_vec())),
        ("time", fact(py, *time)),
        ("help", fact(py, error.advice())),
    ];
    exception(py, "StepError", &said, facts)
}

/// Steps that did not come to their time.
pub fn of_march(py: Python<'_>, error: &MarchError) -> PyErr {
    match error {
        MarchError::Step(error) => of_step(py, error),
        MarchError::Stuck { time, .. } => {
            let facts = vec![("time", fact(py, *time)), ("help", fact(py, error.advice()))];
            exception(py, "StepError", &format!("{error}; {}", error.advice()), facts)
        }
    }
}

/// A run that could not be made, or ended before its time.
pub fn of_run(py: Python<'_>, error: &RunError) -> PyErr {
    match error {
        RunError::Step { error, unsaved: None } => of_march(py, error),
        other => of_file(py, "RunError", other),
    }
}

/// An error with advice, such as one of a file that cannot be read.
pub fn of_file(py: Python<'_>, class: &str, error: &dyn Diagnostic) -> PyErr {
    let help = error.help().map(|help| help.to_string());
    let message = help.as_ref().map_or_else(|| error.to_string(), |help| format!("{error}; {help}"));
    exception(py, class, &message, vec![("help", fact(py, help))])
}

/// An error of a message and advice.
pub fn of_words(py: Python<'_>, class: &str, message: &str, help: &str) -> PyErr {
    exception(py, class, &format!("{message}; {help}"), vec![("help", fact(py, help))])
}

/// A column that particles do not have.
pub fn of_column(error: &NoColumn) -> PyErr {
    pyo3::exceptions::PyAttributeError::new_err(error.to_string())
}

/// Values that a column cannot take.
pub fn of_write(error: &WriteError) -> PyErr {
    match error {
        WriteError::Unknown(error) => of_column(error),
        other => pyo3::exceptions::PyValueError::new_err(other.to_string()),
    }
}
