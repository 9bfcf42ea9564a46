//! Snapshots of the particles that a run wrote.

use crate::{errors, scene};
use numpy::PyArray1;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use stickslip::column::{IDENTITY, every};
use stickslip::door::SnapshotColumn;
use stickslip::observe::{FileColumns, Frame, ReadError, Results, read_columns};

/// Time [s] and file of each snapshot in a folder of results.
#[pyfunction]
pub fn frames(py: Python<'_>, folder: PathBuf) -> PyResult<Vec<(f64, PathBuf)>> {
    let results = py.detach(|| Results::open(&folder)).map_err(|error| unread(py, &error))?;
    Ok(results.frames().iter().map(|Frame { time, path }| (*time, path.clone())).collect())
}

/// A snapshot: for each name of a column its unit, how many components it has, and those of one particle after the
/// other, ordered by body and number.
#[pyfunction]
pub fn read_frame(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let pool = scene::pool(None)?;
    let read = py.detach(|| pool.install(|| read_columns(&path)));
    let FileColumns { position, body, number, columns: others } = read.map_err(|error| unread(py, &error))?;
    let columns = PyDict::new(py);
    for (name, values) in IDENTITY.into_iter().zip([body, number]) {
        columns.set_item(name, ("", 1, PyArray1::from_vec(py, values)).into_bound_py_any(py)?)?;
    }
    let place = every("position");
    let of_place = SnapshotColumn {
        name: place.name.to_string(),
        unit: place.unit.to_string(),
        kind: place.kind,
        values: position.into_flattened(),
    };
    for SnapshotColumn { name, unit, kind, values } in [of_place].into_iter().chain(others) {
        let values = PyArray1::from_vec(py, values);
        columns.set_item(name, (unit, kind.components(), values).into_bound_py_any(py)?)?;
    }
    Ok(columns)
}

fn unread(py: Python<'_>, error: &ReadError) -> PyErr {
    errors::of_file(py, "ResultsError", error)
}
