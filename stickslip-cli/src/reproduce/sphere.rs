//! What the studies of a sphere share: its curves against those of a rigid one, and the table of where it got.

use super::accounts::energy_error;
use super::case::{PaperCase, PaperScene, Runs, TouchRule};
use super::drawn;
use crate::chart::{Chart, Curve, Panel, svg};
use crate::drawing::{Rgb, body_color};
use crate::failure::Failure;
use crate::page::{Cell, Column, EmbeddedImage, Figure, Table};
use stickslip::observe::{Results, TableRow};

/// A sphere of a scene, by a rule, on cells of a part of its radius.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    pub scene: PaperScene,
    pub rule: TouchRule,
    /// Cells in a radius.
    pub cells: usize,
    /// What it is called in legends and tables.
    pub label: &'static str,
}

/// A column of `bodies.csv` with what stands on the axis.
#[derive(Clone, Copy, Debug)]
pub struct ChartAxis {
    pub quantity: &'static str,
    pub name: &'static str,
    pub unit: &'static str,
}

pub const DISTANCE: ChartAxis = ChartAxis { quantity: "x", name: "distance of the centre", unit: "m" };
pub const SPEED: ChartAxis = ChartAxis { quantity: "vx", name: "velocity of the centre", unit: "m/s" };

/// Width and height of a chart; the page scales it.
const SIZE: [usize; 2] = [480, 360];
const EXACT: Rgb = [0.22, 0.24, 0.27];

impl Sphere {
    /// The case to be run.
    pub fn case(&self) -> PaperCase {
        let cells = self.cells.to_string();
        let label = format!("{}-R{cells}", self.rule.word());
        let finely = [("cells_per_radius", cells.as_str()), ("outputs.particles", "0.5 s")];
        PaperCase::new(self.scene, &label, &[self.rule.settings(), finely].concat())
    }

    fn name(&self) -> String {
        format!(
            "{}R/{}",
            if self.label.is_empty() { String::new() } else { format!("{}, ", self.label) },
            self.cells
        )
    }
}

/// A figure of one quantity, a chart for each rule.
pub fn figure(figure: Figure, axis: ChartAxis, spheres: &[Sphere], runs: &Runs) -> Result<Figure, Failure> {
    let mut charts = Vec::new();
    for rule in TouchRule::BOTH {
        let of_rule: Vec<&Sphere> = spheres.iter().filter(|sphere| sphere.rule == rule).collect();
        let panel =
            Panel { name: axis.name.to_owned(), unit: axis.unit, curves: curves(&of_rule, axis, runs)? };
        let chart = Chart {
            title: String::new(),
            over: "time [s]".to_owned(),
            panels: vec![panel],
            caption: String::new(),
        };
        if let Some(svg) = drawn(svg(&chart, SIZE))? {
            let description = format!("{} over time, {}", axis.name, rule.title());
            charts.push(EmbeddedImage::svg(&svg, description).label(rule.title()));
        }
    }
    Ok(figure.row(charts))
}

fn curves(spheres: &[&Sphere], axis: ChartAxis, runs: &Runs) -> Result<Vec<Curve>, Failure> {
    let mut curves = Vec::new();
    let mut exact: Vec<Curve> = Vec::new();
    for (number, sphere) in spheres.iter().enumerate() {
        let Some(results) = runs.get(&sphere.case()) else { continue };
        let rows = results.bodies_table().map_err(Failure::input)?;
        let rows = rows.iter().filter(|row| row.body == BODY);
        let points = rows.filter_map(|row| Some([row.time, row.number(axis.quantity)?])).collect();
        curves.push(Curve { label: sphere.name(), color: body_color(number), dashed: false, points });
        let reference = results
            .manifest()
            .references
            .iter()
            .find(|reference| reference.body == BODY && reference.quantity == axis.quantity);
        if let Some(reference) = reference.filter(|new| exact.iter().all(|old| old.points != new.points)) {
            let label = reference.label.clone();
            exact.push(Curve { label, color: EXACT, dashed: true, points: reference.points.clone() });
        }
    }
    curves.extend(exact);
    Ok(curves)
}

/// Name of the body in all scenes with a sphere.
const BODY: &str = "sphere";

/// Where each sphere got against the rigid one.
pub fn table(caption: &str, spheres: &[Sphere], runs: &Runs) -> Result<Table, Failure> {
    let columns = vec![
        Column::text("case"),
        Column::text("contact rule"),
        Column::number("cells"),
        Column::number("x [m]"),
        Column::number("rigid [m]"),
        Column::number("difference"),
        Column::number("v [m/s]"),
        Column::number("rigid [m/s]"),
        Column::number("difference"),
        Column::number("energy error"),
    ];
    let mut table = Table::new(caption, columns);
    for sphere in spheres {
        let mut row = vec![
            Cell::text(sphere.label),
            Cell::text(sphere.rule.short()),
            Cell::Number(format!("R/{}", sphere.cells)),
        ];
        match runs.get(&sphere.case()) {
            None => row.push(Cell::text("failed")),
            Some(results) => {
                for axis in [DISTANCE, SPEED] {
                    let [value, exact] = reached(results, axis)?;
                    row.push(Cell::number(value, 3));
                    row.push(Cell::number(exact, 3));
                    row.push(Cell::percent(value / exact - 1.0, 1));
                }
                row.push(Cell::percent(energy_error(results)?, 2));
            }
        }
        table = table.row(row);
    }
    Ok(table)
}

/// What the sphere and the rigid one reached at the end.
fn reached(results: &Results, axis: ChartAxis) -> Result<[f64; 2], Failure> {
    let rows = results.bodies_table().map_err(Failure::input)?;
    let value = rows.iter().rfind(|row| row.body == BODY).and_then(|row| row.number(axis.quantity));
    let references = &results.manifest().references;
    let reference = references.iter().find(|each| each.body == BODY && each.quantity == axis.quantity);
    let exact = reference.and_then(|reference| reference.points.last()).map(|point| point[1]);
    Ok([value.unwrap_or(f64::NAN), exact.unwrap_or(f64::NAN)])
}
