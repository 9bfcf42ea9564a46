//! Columns of particles as NumPy arrays over the engine's own memory. Whatever is unsafe in this crate is here and where
//! compiled functions are called (`functions.rs`).

use crate::shared::{Hold, Shared};
use numpy::ndarray::{ArrayView1, ArrayView2, ShapeBuilder};
use numpy::{Element, PyArray1, PyArray2};
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip::column::Kind;
use stickslip::door::{ColumnPlace, NumberFormat};

/// What an array over the engine's memory stands on: it keeps the simulation alive.
#[pyclass(frozen, module = "stickslip._core")]
pub struct Memory(#[expect(dead_code, reason = "it is held, not asked")] Hold);

/// A column of a body as an array that can be read only: a row a particle, or a number. None if there is no such
/// column, or it does not stay where it is.
pub fn column<'py>(
    py: Python<'py>,
    shared: &Arc<Shared>,
    body: usize,
    name: &str,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let Some((place, hold)) = py.detach(|| Hold::column(shared, body, name)) else { return Ok(None) };
    let memory = Bound::new(py, Memory(hold))?.into_any();
    let array = match place.format {
        NumberFormat::Single => over::<f32>(&place, memory),
        NumberFormat::Double => over::<f64>(&place, memory),
        NumberFormat::Count => over::<u32>(&place, memory),
    };
    array.getattr("flags")?.setattr("writeable", false)?;
    Ok(Some(array))
}

/// An array over a column that `memory` holds in its place.
fn over<'py, T: Element>(place: &ColumnPlace, memory: Bound<'py, PyAny>) -> Bound<'py, PyAny> {
    let first = std::ptr::with_exposed_provenance::<T>(place.address);
    let entries = place.components.len();
    // SAFETY: the engine allocated the column, of numbers of this format, so long and so far apart, and exposed its
    // provenance. It keeps that memory as long as it lives and gives it to nothing else: bodies whose particles come
    // and go have no places. `memory` owns the simulation, and the array owns `memory`. Every number there is
    // initialised, and any bits are a number. The engine writes there while a step is taken, without the interpreter's
    // lock: who reads in another thread meanwhile may get numbers of two moments, as of any array that threads share,
    // and the package says so. No reference to the memory outlives this function.
    unsafe {
        if place.column.kind == Kind::Number {
            let view = ArrayView1::from_shape_ptr(place.len, first);
            PyArray1::borrow_from_array(&view, memory).into_any()
        } else {
            let strides = (1, place.stride / size_of::<T>());
            let view = ArrayView2::from_shape_ptr((place.len, entries).strides(strides), first);
            PyArray2::borrow_from_array(&view, memory).into_any()
        }
    }
}
