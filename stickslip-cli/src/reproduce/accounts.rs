//! Energy and time of every run.

use super::case::Runs;
use super::momentum::momentum_error;
use crate::failure::Failure;
use crate::page::{Cell, Column, Section, Table};
use crate::progress::duration;
use stickslip::door::Ledger;
use stickslip::observe::Results;

/// Every run with its energy error and what it took.
pub fn section(runs: &Runs) -> Result<Section, Failure> {
    let columns = vec![
        Column::text("run"),
        Column::number("cell [m]"),
        Column::number("particles"),
        Column::number("steps"),
        Column::number("energy error"),
        Column::number("momentum error"),
        Column::number("time taken"),
        Column::number("threads"),
        Column::number("million particle-steps/s"),
    ];
    let caption = "Every run of this report. Energy error: the sum that an exact solution keeps (kinetic, strain and potential energy, \
                   heat, less the work of what moves as prescribed), end less start, over the largest energy that was stored or turned. Momentum error: what the disks or the sphere have \
                   at the end beyond the impulses of everything else and gravity, over the sum of these impulses.";
    let mut table = Table::new(caption, columns);
    for (name, results) in runs.iter() {
        let performance = &results.manifest().performance;
        table = table.row(vec![
            Cell::text(name),
            Cell::scientific(results.manifest().cell),
            Cell::count(performance.particles),
            Cell::count(performance.steps as usize),
            Cell::percent(energy_error(results)?, 3),
            momentum_error(results, f64::INFINITY)?.map_or(Cell::Empty, Cell::scientific),
            Cell::Number(duration(performance.wall_time)),
            Cell::count(performance.threads),
            Cell::number(performance.particle_steps_per_second / 1e6, 2),
        ]);
    }
    for failure in runs.failures() {
        table = table.row(vec![Cell::text(failure.name), Cell::text("failed")]);
    }
    Ok(Section::new("Energy and time").table(table))
}

/// Change of the total energy over the largest energy that a run stored or turned into heat [-].
///
/// The zero of potential energy is arbitrary: its change counts, not its value.
pub fn energy_error(results: &Results) -> Result<f64, Failure> {
    let rows = results.energy_table().map_err(Failure::input)?;
    let ledgers: Vec<&Ledger> = rows.iter().map(|row| &row.ledger).collect();
    let (Some(start), Some(end)) = (ledgers.first(), ledgers.last()) else { return Ok(f64::NAN) };
    let stored = ledgers.iter().map(|ledger| ledger.kinetic + ledger.strain).fold(0.0, f64::max);
    let heat = end.friction + end.plastic + end.damping;
    let fallen = (end.potential - start.potential).abs();
    Ok((end.total - start.total) / stored.max(heat).max(fallen))
}
