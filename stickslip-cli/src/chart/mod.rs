//! Charts of what a run recorded, over time or over a parameter.

mod contents;
mod measurements;
mod paper;
mod runs;
mod tables;

pub use contents::{ChartChoice, ChartTable, chart};
pub use paper::{draw, svg};
pub use runs::together;
pub use tables::{rows as table_rows, rows_of_any};

use crate::drawing::Rgb;

/// A page of panels.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Above everything.
    pub title: String,
    /// What all panels are drawn over: `time [s]`.
    pub over: String,
    /// One after the other, two in a row.
    pub panels: Vec<Panel>,
    /// Below everything; may be empty.
    pub caption: String,
}

/// Curves that share an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What the axis shows: `position`.
    pub name: String,
    /// Its SI unit, without prefix: `m`.
    pub unit: &'static str,
    /// The curves, drawn in this order.
    pub curves: Vec<Curve>,
}

/// A curve; one of few points has them marked, and so has a point between two without values.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its name in the legend.
    pub label: String,
    /// Its colour.
    pub color: Rgb,
    /// Drawn as dashes: a known answer rather than a result.
    pub dashed: bool,
    /// Time, or what the chart is drawn over, and value in SI units.
    pub points: Vec<[f64; 2]>,
}

impl Chart {
    /// Width and height that suit its panels [pixels].
    pub fn size(&self) -> [usize; 2] {
        let rows = self.panels.len().div_ceil(2).max(1);
        [1280, 120 + 440 * rows]
    }
}
