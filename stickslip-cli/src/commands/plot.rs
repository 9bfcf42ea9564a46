//! `stickslip plot DIR`: charts over time.

use super::{open, say};
use crate::chart::{Choice, chart, draw};
use crate::failure::Failure;
use clap::Args;
use miette::miette;
use std::path::PathBuf;
use stickslip::observe::BodyRow;

/// Draw what a run recorded over time, with the exact solution where the scene has one.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder of results.
    folder: PathBuf,

    /// Only this body; may be repeated.
    #[arg(long = "body", value_name = "NAME")]
    bodies: Vec<String>,

    /// Columns of bodies.csv, separated by commas; those with exact solutions without this.
    #[arg(long = "quantity", value_name = "COLUMN", value_delimiter = ',', value_parser = column)]
    quantities: Vec<String>,

    /// The chart, .png or .svg; DIR/plot.png without this.
    #[arg(long, value_parser = chart_file)]
    out: Option<PathBuf>,
}

/// Width and height of a chart [pixels].
const SIZE: [usize; 2] = [1280, 560];
/// Columns of `bodies.csv` that can be drawn.
const COLUMNS: &str = "mass, x, y, z, vx, vy, vz, wx, wy, wz, kinetic, strain";

fn column(text: &str) -> Result<String, String> {
    let known = text != "time" && BodyRow::default().quantity(text).is_some();
    if known { Ok(text.to_owned()) } else { Err(format!("allowed: {COLUMNS}")) }
}

#[test]
fn every_column_that_is_offered_can_be_drawn() {
    for name in COLUMNS.split(", ") {
        assert_eq!(column(name).as_deref(), Ok(name));
    }
    assert!(column("speed").is_err() && column("time").is_err());
}

fn chart_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    let known = ["png", "svg"].iter().any(|known| extension.eq_ignore_ascii_case(known));
    if known { Ok(path) } else { Err("allowed: a file name that ends in .png or .svg".to_owned()) }
}

#[test]
fn charts_are_png_or_svg() {
    assert!(chart_file("a/b.SVG").is_ok() && chart_file("b.png").is_ok());
    assert!(chart_file("b.pdf").is_err() && chart_file("b").is_err());
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let results = open(&self.folder)?;
        let names = results.body_names();
        if let Some(unknown) = self.bodies.iter().find(|body| !names.contains(body)) {
            return Err(Failure::Input(miette!("--body: found `{unknown}`; allowed: {}", names.join(", "))));
        }
        let choice = Choice { bodies: self.bodies, quantities: self.quantities };
        let out = self.out.unwrap_or_else(|| self.folder.join("plot.png"));
        let chart = chart(&results, &choice).map_err(Failure::input)?;
        draw(&chart, &out, SIZE)?;
        say(&format!("{} is written", out.display()))?;
        if chart.caption.is_empty() { Ok(()) } else { say(&chart.caption) }
    }
}
