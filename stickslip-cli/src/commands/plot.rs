//! `stickslip plot DIR`: charts over time.

use super::{are_names, open, say};
use crate::chart::{self, Chart, ChartChoice, ChartTable, chart, draw, together};
use crate::failure::Failure;
use crate::sweep;
use clap::Args;
use miette::miette;
use std::path::{Path, PathBuf};
use stickslip::observe::{CHART, ReadError, Results};

/// Draw what one run or several recorded over time, with the exact solution where the scene has one; or what a sweep
/// came to.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder of results, of a run or of a sweep; of several runs, for one chart of all.
    #[arg(required = true, value_name = "FOLDER")]
    folders: Vec<PathBuf>,

    /// The table to draw; without this, what the scene knows answers for or measures.
    #[arg(long)]
    table: Option<ChartTable>,

    /// Only this body, or the probe or front of this name; may be repeated. In a pattern `*` is any letters: of bodies
    /// that match, masses and energies are added up, and of the rest means by mass are drawn.
    #[arg(long = "body", value_name = "NAME")]
    bodies: Vec<String>,

    /// Columns of the table, of a sweep those of sweep.csv, separated by commas; those with exact solutions, or the
    /// table's usual one, without this.
    #[arg(long = "quantity", value_name = "COLUMN", value_delimiter = ',')]
    quantities: Vec<String>,

    /// The chart, .png or .svg; DIR/plot.png without this, of several runs plot.png here.
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
        if let Some(folder) = self.folders.iter().find(|folder| sweep::is_sweep(folder)) {
            return self.sweep(folder);
        }
        let table = self.table.unwrap_or(ChartTable::Bodies);
        if let Some(unknown) = self.quantities.iter().find(|name| !table.columns().contains(&name.as_str())) {
            let allowed = table.columns().join(", ");
            return Err(Failure::Input(miette!("--quantity: found `{unknown}`; allowed: {allowed}")));
        }
        let charts: Result<Vec<Chart>, Failure> =
            self.folders.iter().map(|folder| self.of_run(folder)).collect();
        let mut charts = charts?;
        let chart = match charts.len() {
            1 => charts.remove(0),
            _ => together(run_names(&self.folders).into_iter().zip(charts).collect())
                .map_err(Failure::input)?,
        };
        self.draw(&chart)?;
        if chart.caption.is_empty() { Ok(()) } else { say(&chart.caption) }
    }

    fn of_run(&self, folder: &Path) -> Result<Chart, Failure> {
        let results = open(folder)?;
        let names = names(&results, self.table.unwrap_or(ChartTable::Bodies)).map_err(Failure::input)?;
        are_names(&self.bodies, &names)?;
        let choice = ChartChoice {
            bodies: self.bodies.clone(),
            quantities: self.quantities.clone(),
            table: self.table,
        };
        chart(&results, &choice).map_err(Failure::input)
    }

    fn sweep(&self, folder: &Path) -> Result<(), Failure> {
        let shown = folder.display();
        if self.folders.len() > 1 || self.table.is_some() || !self.bodies.is_empty() {
            return Err(Failure::Input(miette!(
                help = format!("draw some of its runs: stickslip plot {shown}/RUN ..."),
                "{shown} is a sweep; allowed with it: --quantity and --out"
            )));
        }
        let sweep = sweep::read(folder)?;
        let known = sweep.figures();
        if let Some(unknown) = self.quantities.iter().find(|name| !known.contains(&name.as_str())) {
            let allowed = known.join(", ");
            return Err(Failure::Input(miette!("--quantity: found `{unknown}`; allowed: {allowed}")));
        }
        self.draw(&sweep::chart(&sweep, &self.quantities))
    }

    fn draw(&self, chart: &Chart) -> Result<(), Failure> {
        let usual = || match &self.folders[..] {
            [folder] => folder.join(CHART),
            _ => PathBuf::from(CHART),
        };
        let out = self.out.clone().unwrap_or_else(usual);
        draw(chart, &out, chart.size())?;
        say(&format!("{} is written", out.display()))
    }
}

/// What runs are called in a chart: their folders without `.results`, or with the folders above where that is not
/// clear.
fn run_names(folders: &[PathBuf]) -> Vec<String> {
    let short = |folder: &PathBuf| {
        let name = folder
            .file_name()
            .map_or_else(|| folder.display().to_string(), |name| name.to_string_lossy().into());
        name.strip_suffix(".results").unwrap_or(&name).to_owned()
    };
    let names: Vec<String> = folders.iter().map(short).collect();
    let is_clear = |name: &String| names.iter().filter(|other| *other == name).count() == 1;
    let whole = |folder: &PathBuf| folder.display().to_string();
    names
        .iter()
        .zip(folders)
        .map(|(name, folder)| if is_clear(name) { name.clone() } else { whole(folder) })
        .collect()
}

#[test]
fn runs_are_called_by_what_tells_them_apart() {
    let names = |folders: &[&str]| run_names(&folders.iter().map(PathBuf::from).collect::<Vec<_>>());
    assert_eq!(names(&["a/fine.results", "coarse.results/"]), ["fine", "coarse"]);
    assert_eq!(names(&["a/ball", "b/ball", ".."]), ["a/ball", "b/ball", ".."]);
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
        _ => {
            let rows = chart::table_rows(results, table)?;
            rows.iter().flat_map(|row| row.name.split(", ").map(str::to_owned)).collect()
        }
    };
    names.sort();
    names.dedup();
    Ok(names)
}
