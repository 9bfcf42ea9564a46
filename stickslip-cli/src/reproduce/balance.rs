//! Energy and momentum that the disks have from nowhere, over time and at two times.

use super::case::{PaperCase, PaperResolution, Runs, TouchRule};
use super::chain::Chain;
use super::disks::{ARRANGEMENTS, cells, frictionless, kinematic, to_the_letter};
use super::drawn;
use crate::chart::{Chart, Curve, Panel, svg};
use crate::drawing::body_color;
use crate::failure::Failure;
use crate::page::{Cell, Column, EmbeddedImage, Figure, Table};

/// Times at which the balance is drawn up, 3 us after impact and at the end [s].
const BALANCES: [f64; 2] = [3e-6, f64::INFINITY];
/// Transits before which the striker has done too little work to divide by.
const FIRST: f64 = 0.5;

/// The energy from nowhere in the disks in a row over time, by each rule; `None` if no run went well.
///
/// # Errors
/// A table cannot be read.
pub fn figure(level: PaperResolution, runs: &Runs) -> Result<Option<Figure>, Failure> {
    let [row, ..] = &ARRANGEMENTS;
    let cases = [
        (TouchRule::Kinematic, kinematic(level)),
        (TouchRule::Traction, row.case(TouchRule::Traction, level)),
        (TouchRule::Surface, row.case(TouchRule::Surface, level)),
    ];
    let mut curves = Vec::new();
    for (number, (rule, case)) in cases.iter().enumerate() {
        let Some(chain) = runs.get(case).and_then(Chain::new) else { continue };
        let gain = chain.energy_gain()?.into_iter().filter(|[time, _]| *time >= FIRST);
        let points = gain.map(|[time, gain]| [time, 100.0 * gain]).collect();
        curves.push(Curve {
            label: rule.short().to_owned(),
            color: body_color(number),
            dashed: false,
            points,
        });
    }
    let chart = Chart {
        title: String::new(),
        over: "time [transits]".to_owned(),
        panels: vec![Panel {
            name: "energy from nowhere / work of the striker".to_owned(),
            unit: "%",
            curves,
        }],
        caption: String::new(),
    };
    Ok(drawn(svg(&chart, [760, 420]))?.map(|svg| {
        let caption = format!(
            "Energy in four disks in a row beyond the striker's work, {} cells across a disk.",
            cells(level)
        );
        Figure::new("Energy balance", caption)
            .row(vec![EmbeddedImage::svg(&svg, "Energy from nowhere over time by three rules")])
    }))
}

/// Energy and momentum of the disks against what striker and frame gave.
///
/// # Errors
/// A table cannot be read.
pub fn table(level: PaperResolution, runs: &Runs) -> Result<Table, Failure> {
    let columns = vec![
        Column::text("disks"),
        Column::text("contact rule"),
        Column::number("energy from nowhere / work of the striker, at 3 us"),
        Column::number("momentum from nowhere / impulses, at 3 us"),
        Column::number("the end, in transits"),
        Column::number("energy, at the end"),
        Column::number("momentum, at the end"),
    ];
    let caption = "Balance of the disks 3 us after impact and at the end of each run. The paper's rule is to keep the energy in a row of disks within \
         0.5 % at 3 us with 80 cells; the rule before it (kinematic) gains energy. No rule keeps it exactly \
         to the end: the rows say how much came from nowhere (+) or was lost. To the letter, the paper's rule takes \
         each body's own normal, and particles stand on a lattice: where a surface is stairs, the normals of two bodies do not oppose each \
         other, and momentum is lost (its equation 16). All other runs take a common normal for each pair, and particles in rings that \
         follow the disks.";
    let row = |title: &str, rule: TouchRule, case: &PaperCase| -> Result<Vec<Cell>, Failure> {
        let mut row = vec![Cell::text(title), Cell::text(rule.short())];
        match runs.get(case).and_then(Chain::new) {
            None => row.push(Cell::text("failed")),
            Some(chain) => {
                let [early, late] = BALANCES.map(|time| chain.balance(time));
                let (early, late) = (early?, late?);
                row.extend([Cell::percent(early.energy, 2), Cell::percent(early.momentum, 4)]);
                row.push(Cell::number(late.time, 1));
                row.extend([Cell::percent(late.energy, 2), Cell::percent(late.momentum, 4)]);
            }
        }
        Ok(row)
    };
    let mut table = Table::new(caption, columns)
        .row(row("in a row", TouchRule::Kinematic, &kinematic(level))?)
        .row(row("in a row, to the letter", TouchRule::Traction, &to_the_letter(level))?);
    for rule in TouchRule::BOTH {
        for each in &ARRANGEMENTS {
            table = table.row(row(each.short, rule, &each.case(rule, level))?);
        }
        table = table.row(row("zig-zag, frictionless", rule, &frictionless(rule, level))?);
    }
    Ok(table)
}
