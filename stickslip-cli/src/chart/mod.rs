//! Charts of what a run recorded, over time.

mod contents;
mod paper;

pub use contents::{Choice, chart};
pub use paper::{draw, svg};

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

/// Curves that share their axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What runs along the page, with its unit: `time [s]`.
    pub along: &'static str,
    /// What the axis shows: `position`.
    pub name: String,
    /// Its SI unit, without prefix: `m`.
    pub unit: &'static str,
    /// The curves, drawn in this order.
    pub curves: Vec<Curve>,
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its name in the legend.
    pub label: String,
    /// Its colour.
    pub color: Rgb,
    /// How it is drawn.
    pub stroke: Stroke,
    /// What runs along the page, such as time [s], and value in SI units.
    pub points: Vec<[f64; 2]>,
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// A line: a result.
    Solid,
    /// Dashes: a known answer.
    Dashed,
    /// A line with a dot at each point: a few results.
    Dots,
}

/// Time along the page.
pub const TIME: &str = "time [s]";
