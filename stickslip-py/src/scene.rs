//! A scene that was read: what is wrong with it, what its run will be, and its simulation.

use crate::engine::Engine;
use crate::{errors, functions};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::ops::Range;
use std::path::PathBuf;
use stickslip::observe::{Manifest, SceneSource};
use stickslip::scene::{Loaded, Scene, SceneError};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A scene and the text that it came from. Reading raises `SceneError`.
#[pyclass(frozen, module = "stickslip._core")]
pub struct ReadScene {
    pub loaded: Loaded,
}

/// A pool of so many threads, or of one a processor.
pub fn pool(threads: Option<usize>) -> PyResult<rayon::ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0));
    pool.build().map_err(|error| pyo3::exceptions::PyOSError::new_err(error.to_string()))
}

impl ReadScene {
    /// A scene with the functions that it names.
    fn given(
        py: Python<'_>,
        loaded: Result<Loaded, SceneError>,
        functions: &Bound<'_, PyDict>,
    ) -> PyResult<Self> {
        let mut loaded = loaded.map_err(|error| errors::of_scene(py, error))?;
        functions::give(&mut loaded.scene, functions)?;
        Ok(ReadScene { loaded })
    }
}

#[pymethods]
impl ReadScene {
    /// Reads a text; `name` stands for its file, and relative paths start at that file's folder.
    #[new]
    fn new(
        py: Python<'_>,
        given: (String, String),
        set: Vec<(String, String)>,
        functions: &Bound<'_, PyDict>,
    ) -> PyResult<Self> {
        let (name, text) = given;
        ReadScene::given(py, py.detach(|| stickslip::scene::parse(&name, &text, &set)), functions)
    }

    /// Reads a file.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf, set: Vec<(String, String)>) -> PyResult<Self> {
        let loaded = py.detach(|| stickslip::scene::load(&path, &set));
        loaded.map(|loaded| ReadScene { loaded }).map_err(|error| errors::of_scene(py, error))
    }

    /// Reads the scene of a run again: its file or, where that has gone, the recorded text; what was set, and to where it
    /// goes on.
    #[staticmethod]
    fn again(
        py: Python<'_>,
        file: (PathBuf, Option<String>),
        set: Vec<(String, String)>,
        until: Option<String>,
        functions: &Bound<'_, PyDict>,
    ) -> PyResult<Self> {
        let (path, text) = file;
        let source = SceneSource { path, set, until, text };
        let recorded = || if source.is_gone() { source.recorded() } else { None };
        let read = || recorded().unwrap_or_else(|| source.load());
        ReadScene::given(py, py.detach(read), functions)
    }

    /// The text that was read.
    #[getter]
    fn text(&self) -> &str {
        self.loaded.source.text()
    }

    /// Title of the scene.
    #[getter]
    fn title(&self) -> &str {
        &self.loaded.scene.title
    }

    /// Simulated time at which it ends [s].
    #[getter]
    fn end(&self) -> f64 {
        self.loaded.scene.time.end
    }

    /// The scene as run.json has it, as JSON.
    fn record(&self) -> String {
        Manifest::record(&self.loaded.scene).to_string()
    }

    /// What `stickslip check` says of it: the text, and the same as JSON.
    fn check(&self, py: Python<'_>) -> PyResult<(String, String)> {
        let pool = pool(None)?;
        let Loaded { scene, source, .. } = &self.loaded;
        let report = py.detach(|| pool.install(|| stickslip::check::report(scene)));
        let mut report = report.map_err(|problem| errors::of_problem(py, &self.loaded, problem))?;
        report.memory += stickslip::run::memory(&report);
        let report = report.in_memory(stickslip::check::free_memory()).placed(source);
        let mut text = report.to_string();
        if scene.start.is_some() {
            // As the run will begin, so that what it would refuse is refused here.
            let carried = Engine::of(py, &self.loaded, None)?.carried;
            text.extend(carried.map(|carried| format!("\n{carried}\n")));
        }
        Ok((text, serde_json::to_string(&report).expect("reports are tables of numbers and words")))
    }

    /// Pairs of bodies that have no friction because no rule says how much.
    fn pairs_without_friction(&self) -> Option<String> {
        stickslip::check::pairs_without_friction(&self.loaded.scene)
    }

    /// Its simulation, by so many threads or by all processors.
    #[pyo3(signature = (threads=None))]
    fn simulation(&self, py: Python<'_>, threads: Option<usize>) -> PyResult<Engine> {
        Engine::of(py, &self.loaded, threads)
    }
}

/// Memory that the machine has free [bytes]; infinite where it does not say.
#[pyfunction]
pub fn free_memory() -> f64 {
    stickslip::check::free_memory()
}

/// The JSON schema of scene files: their keys, with what they mean, their units and their defaults.
#[pyfunction]
pub fn schema() -> String {
    stickslip::scene::schema().to_string()
}

/// A text that [`ReadScene`] has read, as a dictionary of what stands there, in its order.
#[pyfunction]
pub fn document<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    let table = DeTable::parse(text);
    let table = table.map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))?;
    of_table(py, table.get_ref())
}

fn of_table<'py>(py: Python<'py>, table: &DeTable<'_>) -> PyResult<Bound<'py, PyAny>> {
    let mut entries: Vec<(Range<usize>, &str, &Spanned<DeValue>)> =
        table.iter().map(|(name, value)| (name.span(), name.get_ref().as_ref(), value)).collect();
    entries.sort_by_key(|(span, ..)| span.start);
    let dictionary = PyDict::new(py);
    for (_, name, value) in entries {
        dictionary.set_item(name, of_value(py, value.get_ref())?)?;
    }
    Ok(dictionary.into_any())
}

fn of_value<'py>(py: Python<'py>, value: &DeValue<'_>) -> PyResult<Bound<'py, PyAny>> {
    match value {
        DeValue::String(text) => text.as_ref().into_bound_py_any(py),
        DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
            Ok(whole) => whole.into_bound_py_any(py),
            Err(_) => number.as_str().into_bound_py_any(py),
        },
        DeValue::Float(number) => match number.as_str().parse::<f64>() {
            Ok(number) => number.into_bound_py_any(py),
            Err(_) => number.as_str().into_bound_py_any(py),
        },
        DeValue::Boolean(truth) => truth.into_bound_py_any(py),
        DeValue::Datetime(date) => date.to_string().into_bound_py_any(py),
        DeValue::Array(items) => {
            let list = PyList::empty(py);
            items.iter().try_for_each(|item| list.append(of_value(py, item.get_ref())?))?;
            Ok(list.into_any())
        }
        DeValue::Table(table) => of_table(py, table),
    }
}

/// The scene with another end [s].
pub fn until(scene: &Scene, end: f64) -> Scene {
    let mut scene = scene.clone();
    scene.time.end = end;
    scene
}
