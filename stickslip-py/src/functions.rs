//! Laws, loads and prescribed motion from Python: functions over arrays, and compiled ones by their addresses.
//!
//! A function over arrays is called by one thread between two loops of a step, which holds the interpreter's lock then
//! and only then. A compiled one is called by all threads without it.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::cell::Cell;
use std::sync::Arc;
use stickslip::column::Kind;
use stickslip::material::{CustomLaw, History, Isotropic, LawArrays, LawOverArrays, Material, Motion};
use stickslip::outside::{OUTSIDE, OutsideFault, OutsideFunction, OutsidePoints};
use stickslip::scene::{OutsideUse, Scene};
use stickslip::tensor::{Matrix, Symmetric};

/// Gives a scene the functions that it names. They stay in memory, as the engine's laws do.
pub fn give(scene: &mut Scene, functions: &Bound<'_, PyDict>) -> PyResult<()> {
    for material in &mut scene.materials {
        let Material::Custom(custom) = material.law else { continue };
        if let Some(given) = functions.get_item(custom.law().name())? {
            material.law = Material::custom(Box::leak(Box::new(GivenLaw::of(&given, custom.law())?)));
        }
    }
    let axes = scene.dimension.axes();
    scene.give_functions(|name, purpose| {
        let Some(given) = functions.get_item(name)? else { return Ok(None) };
        let given = made(&given, "function")?;
        let how = match address(&given)? {
            Some(address) => Asked::Compiled(compiled_function(address)),
            None => Asked::Python(given.getattr("_values")?.unbind()),
        };
        let function: &'static dyn OutsideFunction =
            Box::leak(Box::new(GivenFunction { how, purpose, axes }));
        Ok(Some(function))
    })
}

thread_local! {
    /// Whether this thread is in a function of Python's that a step calls.
    static IN_FUNCTION: Cell<bool> = const { Cell::new(false) };
}

/// Whether a step waits for a function of Python's that this thread is in.
pub fn is_in_function() -> bool {
    IN_FUNCTION.get()
}

/// Calls Python from a step.
fn called(call: impl FnOnce(Python<'_>) -> PyResult<()>) -> Result<(), OutsideFault> {
    let before = IN_FUNCTION.replace(true);
    let outcome = Python::attach(call);
    IN_FUNCTION.set(before);
    outcome.map_err(|error| OutsideFault(Arc::new(error)))
}

/// An object of Python's as `stickslip.functions` understands it: a "law" or a "function".
fn made<'py>(given: &Bound<'py, PyAny>, kind: &str) -> PyResult<Bound<'py, PyAny>> {
    given.py().import("stickslip.functions")?.getattr("made")?.call1((given, kind))
}

/// Where its code is, if it is compiled.
fn address(given: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    given.getattr("address")?.extract()
}

/// A compiled law over one particle: F and I + L dt row by row, dt, constants; and to be changed the stress xx yy zz xy
/// yz xz, the history, and its answers.
type CompiledLaw =
    unsafe extern "C" fn(*const f64, *const f64, f64, *const f64, *mut f64, *mut f64, *mut f64);

/// A compiled function of the time, a point now and at the start, and its value.
type CompiledFunction = unsafe extern "C" fn(f64, *const f64, *const f64, *mut f64);

fn compiled_law(address: usize) -> CompiledLaw {
    // SAFETY: the user says that a function of this signature is there, as `stickslip.Law` documents.
    unsafe { std::mem::transmute::<*const (), CompiledLaw>(std::ptr::with_exposed_provenance(address)) }
}

fn compiled_function(address: usize) -> CompiledFunction {
    // SAFETY: likewise of `stickslip.Function`.
    unsafe { std::mem::transmute::<*const (), CompiledFunction>(std::ptr::with_exposed_provenance(address)) }
}

/// How a function is asked.
#[derive(Debug)]
enum Asked<C> {
    Python(Py<PyAny>),
    Compiled(C),
}

/// A law from Python.
///
/// Its history is what the user declares, then its answers: strain energy and dissipation per undeformed volume, and
/// the stiffness against a longitudinal wave; then, if it wants that, I + L dt of the step.
#[derive(Debug)]
struct GivenLaw {
    name: &'static str,
    elastic: Isotropic<f64>,
    history: &'static [History],
    /// Components of the user's history.
    components: usize,
    /// Where I + L dt is kept.
    increment: Option<usize>,
    names: Vec<String>,
    constants: Vec<f64>,
    how: Asked<CompiledLaw>,
    /// What is compiled belongs to it.
    _given: Py<PyAny>,
}

/// How many answers a law has.
const ANSWERS: usize = 3;

impl GivenLaw {
    fn of(given: &Bound<'_, PyAny>, missing: &dyn CustomLaw) -> PyResult<Self> {
        let given = made(given, "law")?;
        let elastic = missing.elastic();
        let declared: Vec<(String, String, String, f64)> = given.getattr("columns")?.extract()?;
        let column = |(name, kind, unit, start): (String, String, String, f64)| {
            Ok(History { start, ..History::new(name.leak(), unit.leak(), kind_of(&kind)?) })
        };
        let mut history = declared.into_iter().map(column).collect::<PyResult<Vec<_>>>()?;
        let components = history.iter().map(|history| history.column.kind.components()).sum();
        let modulus = History::new("wave_modulus", "Pa", Kind::Number);
        history.extend([
            History::new("strain_energy_density", "J/m^3", Kind::Number),
            History::new("dissipation_density", "J/m^3", Kind::Number),
            History { start: elastic.p_wave_modulus(), ..modulus },
        ]);
        let how = match address(&given)? {
            Some(address) => Asked::Compiled(compiled_law(address)),
            None => Asked::Python(given.getattr("_respond")?.unbind()),
        };
        let mut increment = None;
        if given.getattr("increment")?.extract()? {
            increment = Some(components + ANSWERS);
            history.push(History { start: 1.0, ..History::new("increment", "", Kind::Tensor) });
        }
        let constants: Vec<(String, f64)> = given
            .getattr("constants")?
            .call_method0("items")?
            .try_iter()?
            .map(|item| item?.extract())
            .collect::<PyResult<_>>()?;
        let (names, constants) = constants.into_iter().unzip();
        let (name, history, _given) = (missing.name(), &*history.leak(), given.unbind());
        Ok(GivenLaw { name, elastic, history, components, increment, names, constants, how, _given })
    }
}

fn kind_of(kind: &str) -> PyResult<Kind> {
    match kind {
        "number" => Ok(Kind::Number),
        "vector" => Ok(Kind::Vector),
        "symmetric" => Ok(Kind::Symmetric),
        "tensor" => Ok(Kind::Tensor),
        other => Err(PyValueError::new_err(format!(
            "found a history of kind {other:?}; allowed: \"number\", \"vector\", \"symmetric\" or \"tensor\""
        ))),
    }
}

impl CustomLaw for GivenLaw {
    fn name(&self) -> &'static str {
        self.name
    }

    fn key(&self) -> &'static str {
        OUTSIDE
    }

    fn constants(&self) -> Vec<(String, f64)> {
        self.names.iter().cloned().zip(self.constants.iter().copied()).collect()
    }

    fn over_arrays(&self) -> Option<&dyn LawOverArrays> {
        matches!(self.how, Asked::Python(_)).then_some(self as &dyn LawOverArrays)
    }

    fn history(&self) -> &'static [History] {
        self.history
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic
    }

    fn respond(&self, motion: &Motion<f64>, history: &mut [f64]) -> Symmetric<f64> {
        let increment = motion.increment.0.as_flattened();
        if let Some(first) = self.increment {
            history[first..first + 9].copy_from_slice(increment);
        }
        let mut stress = motion.stress;
        if let Asked::Compiled(law) = self.how {
            let (own, answers) = history.split_at_mut(self.components);
            let deformation = motion.deformation.0.as_flattened().as_ptr();
            // SAFETY: of the signature, each pointer to as many numbers as `stickslip.Law` documents.
            unsafe {
                law(
                    deformation,
                    increment.as_ptr(),
                    motion.dt,
                    self.constants.as_ptr(),
                    stress.0.as_mut_ptr(),
                    own.as_mut_ptr(),
                    answers.as_mut_ptr(),
                );
            }
        }
        stress
    }

    fn strain_energy(&self, _: &Matrix<f64>, _: &Symmetric<f64>, history: &[f64]) -> f64 {
        history[self.components]
    }

    fn dissipation(&self, history: &[f64]) -> f64 {
        history[self.components + 1]
    }

    fn wave_modulus(&self, _: &Matrix<f64>, jacobian: f64, history: &[f64]) -> f64 {
        history[self.components + 2] * jacobian
    }
}

impl LawOverArrays for GivenLaw {
    fn respond(&self, particles: LawArrays<'_>) -> Result<(), OutsideFault> {
        let Asked::Python(respond) = &self.how else { return Ok(()) };
        let LawArrays { time, dt, deformation, stress, history } = particles;
        called(|py| {
            let width = history.len() / stress.len().max(1);
            let deformation = rows(py, deformation.as_flattened(), 9)?;
            let (stresses, histories) = (rows(py, stress.as_flattened(), 6)?, rows(py, history, width)?);
            respond.call1(py, (time, dt, deformation, &stresses, &histories))?;
            stress.as_flattened_mut().copy_from_slice(stresses.readonly().as_slice()?);
            history.copy_from_slice(histories.readonly().as_slice()?);
            Ok(())
        })
    }
}

/// Numbers as an array of so many columns.
fn rows<'py>(py: Python<'py>, numbers: &[f64], width: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
    PyArray1::from_slice(py, numbers).reshape([numbers.len() / width.max(1), width])
}

/// A load or a prescribed motion from Python.
#[derive(Debug)]
struct GivenFunction {
    how: Asked<CompiledFunction>,
    purpose: OutsideUse,
    axes: usize,
}

impl OutsideFunction for GivenFunction {
    fn evaluate(&self, points: OutsidePoints<'_>, values: &mut [[f64; 3]]) -> Result<(), OutsideFault> {
        let OutsidePoints { time, now, start } = points;
        let function = match &self.how {
            Asked::Compiled(function) => {
                for ((now, start), value) in now.iter().zip(start).zip(values) {
                    // SAFETY: of the signature, each pointer to three numbers.
                    unsafe { function(time, now.as_ptr(), start.as_ptr(), value.as_mut_ptr()) };
                }
                return Ok(());
            }
            Asked::Python(function) => function,
        };
        let purpose = match self.purpose {
            OutsideUse::Vector => "vector",
            OutsideUse::Spin => "spin",
            OutsideUse::VectorAtPoints => "vector at points",
            OutsideUse::NumberAtPoints => "number at points",
        };
        called(|py| {
            let (now, start) = (rows(py, now.as_flattened(), 3)?, rows(py, start.as_flattened(), 3)?);
            let said = function.call1(py, ((purpose, self.axes), time, now, start))?;
            let said: PyReadonlyArray2<'_, f64> = said.extract(py)?;
            values.as_flattened_mut().copy_from_slice(said.as_slice()?);
            Ok(())
        })
    }
}
