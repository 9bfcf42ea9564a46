//! Everything that a user can hand over, as functions of bytes: fuzzing looks for bytes at which one of them panics,
//! hangs or takes too much memory, and `tests/corpus.rs` holds that none of those in `corpus/` does any more.
//!
//! `fuzz/run TARGET` fuzzes one of them, with coverage, by libFuzzer and the stable compiler.

#![forbid(unsafe_code)]

mod checkpoint;
mod formula;
mod image;
mod mesh;
mod point_cloud;
mod request;
mod results;
mod scene;
mod steps;
mod table;
mod template;

use std::hash::{DefaultHasher, Hash, Hasher};

/// A kind of input, and what reads it.
pub struct Target {
    /// One word: that of its folder in `corpus/`, too.
    pub name: &'static str,
    /// Reads an input. A panic is a finding.
    pub run: fn(&[u8]),
    /// Sound inputs to begin with, made by this version of the program.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Bytes that an input has at most.
    pub longest: usize,
}

/// All of them.
pub const TARGETS: &[Target] = &[
    Target { name: "scene", run: scene::run, seeds: scene::seeds, longest: 6000 },
    Target { name: "steps", run: steps::run, seeds: steps::seeds, longest: 3000 },
    Target { name: "formula", run: formula::run, seeds: formula::seeds, longest: 500 },
    Target { name: "csv", run: table::run, seeds: table::seeds, longest: 2000 },
    Target { name: "stl", run: mesh::stl, seeds: mesh::stl_seeds, longest: 2000 },
    Target { name: "obj", run: mesh::obj, seeds: mesh::obj_seeds, longest: 1000 },
    Target { name: "ply", run: mesh::ply, seeds: mesh::ply_seeds, longest: 1000 },
    Target { name: "png", run: image::png, seeds: image::png_seeds, longest: 1000 },
    Target { name: "tiff", run: image::tiff, seeds: image::tiff_seeds, longest: 1000 },
    Target { name: "point_cloud", run: point_cloud::run, seeds: point_cloud::seeds, longest: 2000 },
    Target { name: "checkpoint", run: checkpoint::run, seeds: checkpoint::seeds, longest: 120_000 },
    Target { name: "record", run: results::record, seeds: results::record_seeds, longest: 10_000 },
    Target { name: "tables", run: results::tables, seeds: results::table_seeds, longest: 3000 },
    Target { name: "snapshot", run: results::snapshot, seeds: results::snapshot_seeds, longest: 20_000 },
    Target { name: "collection", run: results::collection, seeds: results::collection_seeds, longest: 1000 },
    Target { name: "request", run: request::run, seeds: request::seeds, longest: 500 },
];

/// Whether an input is one of so many for which what takes long is done, too; always the same ones.
fn is_one_in(count: u64, bytes: &[u8]) -> bool {
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    hasher.finish().is_multiple_of(count)
}

/// Makes what several targets need, so that no input is charged with it.
pub fn prepare() {
    template::Template::get();
}

/// The target of a name.
pub fn named(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}
