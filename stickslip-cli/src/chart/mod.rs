//! Charts of what a run recorded, over time.

mod contents;
mod paper;

pub use contents::{Choice, chart};
pub use paper::draw;

use crate::drawing::Rgb;

/// A page of panels.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Above everything.
    pub title: String,
    /// One after the other, two in a row.
    pub panels: Vec<Panel>,
    /// Below everything; may be empty.
    pub caption: String,
}

/// Curves over time that share an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What the axis shows: `position`.
    pub name: String,
    /// Its SI unit, without prefix: `m`.
    pub unit: &'static str,
    /// The curves, drawn in this order.
    pub curves: Vec<Curve>,
}

/// A curve over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its name in the legend.
    pub label: String,
    /// Its colour.
    pub color: Rgb,
    /// Drawn as dashes: a known answer rather than a result.
    pub dashed: bool,
    /// Time [s] and value in SI units.
    pub points: Vec<[f64; 2]>,
}
