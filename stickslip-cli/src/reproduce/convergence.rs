//! Arrivals at the disks in a row on finer and finer cells, against codes with sharp contact.

use super::Study;
use super::case::{PaperCase, PaperResolution, PaperScene, Runs, TouchRule};
use super::chain::{self, Chain};
use super::drawn;
use crate::chart::{Chart, Curve, Panel, svg};
use crate::drawing::body_color;
use crate::failure::Failure;
use crate::page::{Cell, Column, EmbeddedImage, Figure, Section, Table};

/// The study.
pub struct Convergence;

/// Transits until the stress difference at the disks' centres is 0.3 rho c_L V, at V/c_L = 2.07e-3: two body-fitted
/// finite-element codes with sharp contact, which agree within 1.5 % and are converged within 1 %;
/// plane strain, nu = 0.2143.
const SHARP: [f64; DISKS] = [0.82, 2.81, 4.99, 7.11];
const DISKS: usize = 4;
/// The striker as fast as in the experiment, measured by the speed of waves.
const SPEED: &str = "2.07e-3 * c_L";

impl Study for Convergence {
    fn name(&self) -> &'static str {
        "convergence"
    }

    fn cases(&self, level: PaperResolution) -> Vec<PaperCase> {
        TouchRule::BOTH
            .iter()
            .flat_map(|&rule| cells(level).iter().map(move |&cells| case(rule, cells)))
            .collect()
    }

    fn section(&self, level: PaperResolution, runs: &Runs) -> Result<Section, Failure> {
        let columns = vec![
            Column::text("contact"),
            Column::number("cells across a disk"),
            Column::number("disk 1"),
            Column::number("disk 2"),
            Column::number("disk 3"),
            Column::number("disk 4"),
            Column::number("mean interval"),
            Column::number("off the sharp contact"),
        ];
        let caption = "Arrival at the centres of the disks in transits, and the mean interval between them.";
        let exact = mean_interval(&SHARP);
        let mut table = Table::new(caption, columns);
        let mut curves = Vec::new();
        for (number, rule) in TouchRule::BOTH.into_iter().enumerate() {
            let mut points = Vec::new();
            for &cells in cells(level) {
                let chain = runs.get(&case(rule, cells)).and_then(Chain::new);
                let arrivals = chain.map_or(Ok(Vec::new()), |chain| chain.arrivals())?;
                let complete: Option<Vec<f64>> = arrivals.iter().copied().collect();
                let interval =
                    complete.filter(|all| all.len() == DISKS).map_or(f64::NAN, |all| mean_interval(&all));
                let mut row = vec![Cell::text(rule.short()), Cell::count(cells)];
                row.extend((0..DISKS).map(|disk| match arrivals.get(disk).copied().flatten() {
                    Some(time) => Cell::number(time, 2),
                    None => Cell::text("none"),
                }));
                row.extend([Cell::number(interval, 3), Cell::percent(interval / exact - 1.0, 1)]);
                table = table.row(row);
                if interval.is_finite() {
                    points.push([cells as f64, interval]);
                }
            }
            let color = body_color(number);
            curves.push(Curve { label: rule.short().to_owned(), color, dashed: false, points });
        }
        let mut row = vec![Cell::text("sharp (finite elements)"), Cell::Empty];
        row.extend(SHARP.map(|time| Cell::number(time, 2)));
        row.extend([Cell::number(exact, 3), Cell::Empty]);
        let table = table.row(row);
        let ends = [0.0, cells(level).iter().max().copied().unwrap_or(0) as f64];
        let label = "sharp (finite elements)".to_owned();
        curves.push(Curve {
            label,
            color: [0.22, 0.24, 0.27],
            dashed: true,
            points: ends.map(|n| [n, exact]).to_vec(),
        });
        let panel = Panel { name: "mean interval [transits]".to_owned(), unit: "", curves };
        let chart = Chart {
            title: String::new(),
            over: "cells across a disk".to_owned(),
            panels: vec![panel],
            caption: String::new(),
        };
        let mut section = Section::new("Convergence of the arrivals").text(
            "How long the wave takes from one disk of a row to the next, with the experiment's V/c = 0.00207. Disks touch in a point, and the \
             wave waits until the contact has grown wide enough to carry it. By the paper's rule the grid lets bodies touch within a cell, so every contact \
             is too wide and carries the wave too early: that is one reason why the paper's fringes run ahead, and finer cells help slowly.",
        );
        if let Some(svg) = drawn(svg(&chart, [760, 420]))? {
            let figure = Figure::new(
                "Convergence",
                "Mean interval between arrivals at neighbouring disks in transits against resolution.",
            );
            section = section
                .figure(figure.row(vec![EmbeddedImage::svg(&svg, "Mean interval against resolution")]));
        }
        Ok(section.table(table))
    }
}

fn case(rule: TouchRule, cells: usize) -> PaperCase {
    let settings = [("speed", SPEED)];
    chain::case(PaperScene::COLLINEAR, rule, cells, &settings).labelled("experiment")
}

fn cells(level: PaperResolution) -> &'static [usize] {
    match level {
        PaperResolution::Sketch => &[20],
        PaperResolution::Quick => &[20, 40],
        PaperResolution::Full => &[20, 40, 80, 160],
    }
}

/// Mean time from one disk to the next.
fn mean_interval(arrivals: &[f64]) -> f64 {
    match arrivals {
        [first, .., last] => (last - first) / (arrivals.len() - 1) as f64,
        _ => f64::NAN,
    }
}

#[test]
fn the_sharp_contact_takes_two_transits_from_disk_to_disk() {
    assert!((mean_interval(&SHARP) - 2.097).abs() < 1e-3);
}
