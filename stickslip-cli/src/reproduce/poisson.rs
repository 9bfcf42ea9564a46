//! The paper's study of Poisson's ratio with the longitudinal speed held.

use super::Study;
use super::case::{PaperCase, PaperResolution, PaperScene, Runs, TouchRule};
use super::chain::{self, Chain};
use super::drawn;
use crate::chart::{Chart, Curve, Panel, svg};
use crate::drawing::body_color;
use crate::failure::Failure;
use crate::page::{Cell, Column, EmbeddedImage, Figure, Mark, Section, Table};

/// The study.
pub struct Poisson;

/// Fringes at the first of [`ratios`] over those at the last are to be at least this much faster; the paper:
/// more than two.
const SLOWER: f64 = 2.2;

impl Study for Poisson {
    fn name(&self) -> &'static str {
        "poisson"
    }

    fn cases(&self, level: PaperResolution) -> Vec<PaperCase> {
        TouchRule::BOTH
            .iter()
            .flat_map(|&rule| ratios(level).iter().map(move |nu| case(rule, level, nu)))
            .collect()
    }

    fn section(&self, level: PaperResolution, runs: &Runs) -> Result<Section, Failure> {
        let mut columns =
            vec![Column::number("Poisson's ratio"), Column::number("shear / longitudinal speed")];
        columns.extend(
            TouchRule::BOTH.map(|rule| Column::number(format!("fringes / longitudinal, {}", rule.short()))),
        );
        let caption = "Speed of the fringes from the second disk's centre to the last one's, over the longitudinal speed.";
        let mut table = Table::new(caption, columns);
        let mut curves: Vec<Curve> = TouchRule::BOTH
            .into_iter()
            .enumerate()
            .map(|(number, rule)| Curve {
                label: rule.short().to_owned(),
                color: body_color(number),
                dashed: false,
                points: Vec::new(),
            })
            .collect();
        let mut shear = Vec::new();
        for text in ratios(level) {
            let nu: f64 = text.parse().expect("ratios are numbers");
            let mut row = vec![Cell::number(nu, 2), Cell::number(shear_speed(nu), 3)];
            shear.push([nu, shear_speed(nu)]);
            for (rule, curve) in TouchRule::BOTH.into_iter().zip(&mut curves) {
                let chain = runs.get(&case(rule, level, text)).and_then(Chain::new);
                let speed = chain.map_or(Ok(None), |chain| chain.fringe_speed())?;
                row.push(speed.map_or(Cell::text("none"), |speed| Cell::number(speed, 3)));
                curve.points.extend(speed.map(|speed| [nu, speed]));
            }
            table = table.row(row);
        }
        let mut row =
            vec![Cell::text("first over last"), Cell::number(shear[0][1] / shear[shear.len() - 1][1], 2)];
        let slower = [0, 1].map(|rule| match &curves[rule].points[..] {
            [first, .., last] if curves[rule].points.len() == shear.len() => Some(first[1] / last[1]),
            _ => None,
        });
        row.extend(slower.map(|ratio| ratio.map_or(Cell::Empty, |ratio| Cell::number(ratio, 2))));
        table = table.row(row);
        let mut row = vec![Cell::text(format!("at least {SLOWER}")), Cell::Empty];
        row.extend(
            slower.map(|ratio| ratio.map_or(Cell::Empty, |ratio| Cell::Verdict(Mark::of(ratio >= SLOWER)))),
        );
        table = table.row(row);
        curves.push(Curve {
            label: "shear waves".to_owned(),
            color: [0.22, 0.24, 0.27],
            dashed: true,
            points: shear,
        });
        let panel = Panel { name: "speed / longitudinal speed".to_owned(), unit: "", curves };
        let chart = Chart {
            title: String::new(),
            over: "Poisson's ratio".to_owned(),
            panels: vec![panel],
            caption: String::new(),
        };
        let mut section = Section::new("Poisson's ratio").text(format!(
            "Section 3.3, the four disks in a row with {} cells across a disk. With the longitudinal speed held, the paper finds the fringes slower \
             by more than a factor of two at 0.48 than at 0.22, because they show shear, and shear waves slow down; here the aim is {SLOWER}.",
            cells(level)
        ));
        if let Some(svg) = drawn(svg(&chart, [760, 420]))? {
            let figure = Figure::new(
                "Poisson study",
                "Speed of the fringes against Poisson's ratio, the longitudinal speed held.",
            );
            section = section.figure(
                figure.row(vec![EmbeddedImage::svg(&svg, "Speed of the fringes against Poisson's ratio")]),
            );
        }
        Ok(section.table(table))
    }
}

fn case(rule: TouchRule, level: PaperResolution, nu: &str) -> PaperCase {
    chain::case(PaperScene::COLLINEAR, rule, cells(level), &[("nu", nu)]).labelled(&format!("nu{nu}"))
}

fn cells(level: PaperResolution) -> usize {
    match level {
        PaperResolution::Sketch => 20,
        PaperResolution::Quick => 40,
        PaperResolution::Full => 80,
    }
}

fn ratios(level: PaperResolution) -> &'static [&'static str] {
    match level {
        PaperResolution::Sketch => &["0.22", "0.48"],
        PaperResolution::Quick => &["0.22", "0.35", "0.48"],
        PaperResolution::Full => &["0.22", "0.30", "0.38", "0.43", "0.48"],
    }
}

/// Speed of shear waves over that of longitudinal waves:
///
/// ```text
/// c_S / c_L = sqrt((1 - 2 nu) / (2 (1 - nu)))
/// ```
fn shear_speed(nu: f64) -> f64 {
    ((1.0 - 2.0 * nu) / (2.0 * (1.0 - nu))).sqrt()
}

#[test]
fn shear_waves_slow_down_threefold() {
    assert!((shear_speed(0.22) / shear_speed(0.48) - 3.06).abs() < 0.01);
}
