//! A simulation in Python: what `stickslip.Simulation` stands on.

use crate::shared::{Handle, Shared};
use crate::{arrays, errors, scene};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use serde_json::json;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use stickslip::column::{ColumnDescription, Kind};
use stickslip::door::{ContactCursor, ContactMean, ContactState, Simulation, View};
use stickslip::observe::{Checkpoint, CheckpointForm, Manifest, Memory, SceneRecord};
use stickslip::run::{CarriedBodies, begin, same_physics};
use stickslip::scene::{Loaded, Scene};

/// A simulation of a scene. All that it says is in SI units; records are JSON.
#[pyclass(frozen, module = "stickslip._core")]
pub struct Engine {
    pub scene: Scene,
    pub shared: Arc<Shared>,
    /// Which bodies began as another run left them.
    pub carried: Option<CarriedBodies>,
    contacts: Mutex<ContactCursor>,
}

impl Engine {
    /// The simulation of a scene, begun from another run if it asks for that.
    pub fn of(py: Python<'_>, loaded: &Loaded, threads: Option<usize>) -> PyResult<Self> {
        let pool = scene::pool(threads)?;
        let scene = loaded.scene.clone();
        let built = py.detach(|| pool.install(|| stickslip::step::build(&scene)));
        let mut simulation = built.map_err(|problem| errors::of_problem(py, loaded, problem))?;
        let carried = py.detach(|| pool.install(|| begin(&scene, &mut *simulation)));
        let carried = carried.map_err(|error| errors::of_file(py, "RunError", &error))?;
        let shared = Arc::new(Shared::new(simulation, pool));
        Ok(Engine { scene, shared, carried, contacts: Mutex::default() })
    }

    /// A hold on the simulation to step or ask it.
    pub fn handle(&self) -> Handle {
        Handle(Arc::clone(&self.shared))
    }

    /// Reads contacts.
    fn contacts_since(&self) -> Vec<ContactState> {
        let mut cursor = self.contacts.lock().unwrap_or_else(PoisonError::into_inner);
        cursor.read(&self.handle())
    }
}

#[pymethods]
impl Engine {
    /// Title of the scene.
    #[getter]
    fn title(&self) -> &str {
        &self.scene.title
    }

    /// Names of the bodies.
    #[getter]
    fn names(&self) -> Vec<&str> {
        self.scene.bodies.iter().map(|body| body.name.as_str()).collect()
    }

    /// 2 or 3.
    #[getter]
    fn axes(&self) -> usize {
        self.scene.dimension.axes()
    }

    /// Simulated time at which the scene ends [s].
    #[getter]
    fn end(&self) -> f64 {
        self.scene.time.end
    }

    /// Threads that step it.
    #[getter]
    fn threads(&self) -> usize {
        self.shared.threads()
    }

    /// Simulated time [s].
    #[getter]
    fn time(&self, py: Python<'_>) -> f64 {
        py.detach(|| self.handle().time())
    }

    /// Steps taken.
    #[getter]
    fn steps(&self, py: Python<'_>) -> u64 {
        py.detach(|| self.handle().steps())
    }

    /// Particles in all bodies.
    #[getter]
    fn particles(&self, py: Python<'_>) -> usize {
        py.detach(|| self.handle().particles())
    }

    /// The step that would be taken now [s].
    #[getter]
    fn stable_step(&self, py: Python<'_>) -> f64 {
        py.detach(|| self.handle().stable_step())
    }

    /// Takes a step, at most so long [s], and returns its length [s].
    fn step(&self, py: Python<'_>, longest: f64) -> PyResult<f64> {
        let stepped = py.detach(|| self.handle().step(longest));
        stepped.map_err(|error| errors::of_step(py, &error))
    }

    /// Energies and momenta.
    fn ledger(&self, py: Python<'_>) -> String {
        json(&py.detach(|| self.handle().ledger()))
    }

    /// Mass, motion and energy of each body.
    fn states(&self, py: Python<'_>) -> String {
        json(&py.detach(|| self.handle().bodies()))
    }

    /// How far dynamic relaxation has come.
    fn relaxation(&self, py: Python<'_>) -> String {
        json(&py.detach(|| self.handle().relaxation()))
    }

    /// What supports and loads did, with their names.
    fn loads(&self, py: Python<'_>) -> String {
        let names = self.scene.loads.iter().map(|load| load.name.as_str());
        let states = py.detach(|| self.handle().loads());
        json(&names.zip(states).collect::<Vec<_>>())
    }

    /// What joints and springs did, with their names.
    fn joints(&self, py: Python<'_>) -> String {
        let names = self.scene.joint_names();
        let states = py.detach(|| self.handle().joints());
        json(&names.zip(states).collect::<Vec<_>>())
    }

    /// Contacts since they were asked for before, or since the start.
    fn contacts(&self, py: Python<'_>) -> String {
        let found = py.detach(|| self.contacts_since());
        let row = |ContactState { body_a, body_b, direction, mean }: &ContactState| {
            let ContactMean { force, normal, tangential, nodes, position, area, gap, slip, friction } = *mean;
            let vectors = [force, *direction, position];
            json!([[body_a, body_b], vectors, normal, tangential, area, gap, slip, friction, nodes])
        };
        json(&found.iter().map(row).collect::<Vec<_>>())
    }

    /// Name, unit, components in space and components in memory of each column of a body.
    fn columns(&self, py: Python<'_>, body: usize) -> Vec<(&str, &str, Vec<&str>, Vec<&str>)> {
        let axes = self.axes();
        let of = |ColumnDescription { name, unit, kind }: ColumnDescription| {
            let all = components(kind);
            let in_memory =
                (0..kind.entries(axes)).filter_map(|entry| all.get(kind.place(axes, entry)).copied());
            (name, unit, all.to_vec(), in_memory.collect())
        };
        py.detach(|| self.handle().columns(body)).into_iter().map(of).collect()
    }

    /// A column of a body as an array over the engine's memory; none if it does not stay there.
    fn array<'py>(&self, py: Python<'py>, body: usize, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        arrays::column(py, &self.shared, body, name)
    }

    /// A copy of a column by the particles' numbers: the components in space of one after the other.
    fn by_number<'py>(
        &self,
        py: Python<'py>,
        body: usize,
        name: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let values = py.detach(|| {
            let handle = self.handle();
            let column = handle.column(body, name)?;
            let mut values = vec![0.0; column.description.kind.components() * column.len()];
            column.copy_to(&mut values);
            Ok(values)
        });
        Ok(PyArray1::from_vec(py, values.map_err(|error| errors::of_column(&error))?))
    }

    /// Particles of a body.
    fn count(&self, py: Python<'_>, body: usize) -> usize {
        py.detach(|| self.shared.count(body))
    }

    /// Whether a body is rigid.
    fn is_rigid(&self, body: usize) -> bool {
        self.scene.bodies[body].is_rigid()
    }

    /// Gives the particles of a body other values in a column, in the order of memory, or a free rigid body one as a whole.
    fn write(
        &self,
        py: Python<'_>,
        body: usize,
        name: &str,
        values: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<()> {
        // A copy: others may write to the array meanwhile.
        let values = values.as_array().to_vec();
        let written = py.detach(|| self.handle().write(body, name, &values));
        written.map_err(|error| errors::of_write(&error))
    }

    /// Writes a checkpoint.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let written = py.detach(|| {
            let state = self.handle().save().expect("an engine has a state");
            Checkpoint::new(&SceneRecord::new(&self.scene), state, Memory::keeping(&path))
                .write(&path, CheckpointForm::Plain)
        });
        written.map_err(|error| errors::of_file(py, "RunError", &error))
    }

    /// Takes up the state in a checkpoint of the same scene.
    fn restore(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let read = py.detach(|| Checkpoint::read(&path));
        let checkpoint = read.map_err(|error| errors::of_file(py, "ResultsError", &error))?;
        same_physics(&path, &checkpoint.scene(), &Manifest::record(&self.scene))
            .map_err(|error| errors::of_file(py, "RunError", &error))?;
        let restored = py.detach(|| {
            self.handle().restore(checkpoint.state)?;
            // Contacts count from here.
            *self.contacts.lock().unwrap_or_else(PoisonError::into_inner) = ContactCursor::default();
            self.contacts_since();
            Ok::<_, stickslip::door::RestoreError>(())
        });
        restored.map_err(|problem| {
            let message = format!("{} does not fit the scene: {problem}", path.display());
            errors::of_words(py, "RunError", &message, "restore what a simulation of the same scene saved")
        })
    }
}

/// A record as JSON; numbers that are not finite become null.
fn json(record: &impl serde::Serialize) -> String {
    serde_json::to_string(record).expect("records are tables of numbers and words")
}

/// Names of the components in space; none of a number.
fn components(kind: Kind) -> &'static [&'static str] {
    match kind {
        Kind::Number => &[],
        Kind::Vector | Kind::Rotation => &["x", "y", "z"],
        Kind::Tensor => &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"],
        Kind::Symmetric => &["xx", "yy", "zz", "xy", "yz", "xz"],
    }
}
