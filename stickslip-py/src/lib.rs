//! The compiled half of the Python package `stickslip`: what its modules in Python need of the library.
//!
//! Scenes, tables and charts are Python (`python/stickslip/`); a scene crosses over as the text of a scene file, and
//! records come back as JSON. Here is what Python cannot have otherwise: the reader of scenes, the engine with its
//! particles, and the loop of a run.

// Errors of the library as exceptions.
mod errors;

// A scene that was read.
mod scene;

// A simulation that several owners share, each call under a lock.
mod shared;

// Laws, loads and prescribed motion from Python.
mod functions;

// Columns of particles as arrays, without a copy.
mod arrays;

// A simulation in Python.
mod engine;

// Runs: steps to a time, with or without results.
mod run;

// Snapshots of particles.
mod results;

/// What is compiled of `stickslip`; its modules in Python are to be used instead.
#[pyo3::pymodule]
mod _core {
    #[pymodule_export]
    use crate::engine::Engine;
    #[pymodule_export]
    use crate::results::{frames, read_frame};
    #[pymodule_export]
    use crate::run::{command, run, unfinished, walk};
    #[pymodule_export]
    use crate::scene::{ReadScene, document, free_memory, schema};

    /// Version of the package and of the library.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
