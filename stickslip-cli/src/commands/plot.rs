//! `stickslip plot DIR`: charts over time.

use super::{are_names, open, say};
use crate::chart::{ChartChoice, ChartTable, chart, draw};
use crate::failure::Failure;
use crate::sweep;
use clap::Args;
use miette::miette;
use std::path::PathBuf;
use stickslip::observe::{ReadError, Results};

/// Draw what a run recorded over time, with the exact solution where the scene has one; or what a sweep came to.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder of results, of a run or of a sweep.
    folder: PathBuf,

    /// The table to draw; without this, what the scene knows answers for or measures.
    #[arg(long)]
    table: Option<ChartTable>,

    /// Only this body, or the probe or front of this name; may be repeated. In a pattern `*` is any letters: of bodies
    /// that match, masses and energies are added up, and of the rest means by mass are drawn.
    #[arg(long = "body", value_name = "NAME")]
    bodies: Vec<String>,

    /// Columns of the table, separated by commas; those with exact solutions, or the table's usual one, without this.
    #[arg(long = "quantity", value_name = "COLUMN", value_delimiter = ',')]
    quantities: Vec<String>,

    /// The chart, .png or .svg; DIR/plot.png without this.
    #[arg(long, value_parser = chart_file)]
    out: Option<PathBuf>,
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
        if sweep::is_sweep(&self.folder) {
            return self.sweep();
        }
        let results = open(&self.folder)?;
        let table = self.table.unwrap_or(ChartTable::Bodies);
        let names = names(&results, table).map_err(Failure::input)?;
        are_names(&self.bodies, &names)?;
        if let Some(unknown) = self.quantities.iter().find(|name| !table.columns().contains(&name.as_str())) {
            let allowed = table.columns().join(", ");
            return Err(Failure::Input(miette!("--quantity: found `{unknown}`; allowed: {allowed}")));
        }
        let choice = ChartChoice { bodies: self.bodies, quantities: self.quantities, table: self.table };
        let out = self.out.unwrap_or_else(|| self.folder.join("plot.png"));
        let chart = chart(&results, &choice).map_err(Failure::input)?;
        draw(&chart, &out, chart.size())?;
        say(&format!("{} is written", out.display()))?;
        if chart.caption.is_empty() { Ok(()) } else { say(&chart.caption) }
    }
}

impl Arguments {
    fn sweep(self) -> Result<(), Failure> {
        if self.table.is_some() || !self.bodies.is_empty() || !self.quantities.is_empty() {
            let folder = self.folder.display();
            return Err(Failure::Input(miette!(
                help = format!("draw one of its runs: stickslip plot {folder}/RUN"),
                "{folder} is a sweep; allowed with it: --out"
            )));
        }
        let chart = sweep::chart(&sweep::read(&self.folder)?);
        let out = self.out.unwrap_or_else(|| self.folder.join("plot.png"));
        draw(&chart, &out, chart.size())?;
        say(&format!("{} is written", out.display()))
    }
}

/// What the rows of a table are about.
fn names(results: &Results, table: ChartTable) -> Result<Vec<String>, ReadError> {
    let mut names: Vec<String> = match table {
        ChartTable::Bodies | ChartTable::Contacts | ChartTable::Energy => {
            return Ok(results.body_names().to_vec());
        }
        ChartTable::Probes => results.probes_table()?.into_iter().map(|row| row.probe).collect(),
        ChartTable::Arrivals => results.arrivals_table()?.into_iter().map(|row| row.place).collect(),
        ChartTable::Fronts => results.fronts_table()?.into_iter().map(|row| row.front).collect(),
    };
    names.sort();
    names.dedup();
    Ok(names)
}
