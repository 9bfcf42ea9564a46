//! The times of the paper's frames, and those at which the default's fringes have come as far.

use super::case::{PaperResolution, Runs, TouchRule};
use super::chain::Chain;
use super::disks::DiskArrangement;
use crate::failure::Failure;
use crate::page::{Cell, Column, Table};

/// Frame by frame: the paper's times, how far the fringes are then by its rule, and when they are there by the default.
///
/// # Errors
/// A table cannot be read.
pub fn table(
    arrangements: &[DiskArrangement],
    level: PaperResolution,
    runs: &Runs,
) -> Result<Table, Failure> {
    let columns = vec![
        Column::text("figure"),
        Column::number("the paper's simulation"),
        Column::number("its experiment"),
        Column::number("fringes at the paper's time, its rule [diameters]"),
        Column::number("as far by the default"),
        Column::number("off the paper's simulation"),
        Column::number("the paper off its experiment"),
        Column::number("the default off the experiment"),
    ];
    let caption = "Times of the frames in transits. The paper's simulation and its experiment show the same pattern at the times in the first two columns; \
         the third says how far the foremost fringe is from the striker at the paper's time, in the run by its rule; the fourth, when it is as far in the run by the default. \
         Once it is at the far end it tells nothing more. The experiment's disks are of another material, in plane stress, and struck four times as fast by the measure of their waves, \
         which makes sharp contacts carry sooner; the table on convergence has a row of disks struck as fast.";
    let number = |value: Option<f64>| value.map_or(Cell::text("not yet"), |value| Cell::number(value, 2));
    let off = |value: Option<f64>, other: f64| {
        value.map_or(Cell::Empty, |value| Cell::percent(value / other - 1.0, 0))
    };
    let mut table = Table::new(caption, columns);
    for each in arrangements {
        let track = |rule| {
            runs.get(&each.case(rule, level)).and_then(Chain::new).map(|chain| chain.front()).transpose()
        };
        let (paper, default) = (track(TouchRule::Traction)?, track(TouchRule::Surface)?);
        for (simulated, measured) in each.simulated.into_iter().zip(each.measured) {
            let foremost = paper.as_ref().and_then(|track| place(track, simulated));
            let all = paper.as_ref().and_then(|track| track.last()).map(|last| last[1]);
            let arrived = foremost.zip(all).is_some_and(|(place, all)| place > END * all);
            let there = match (&default, foremost) {
                (Some(track), Some(place)) if !arrived => time(track, place),
                _ => None,
            };
            table = table.row(vec![
                Cell::text(each.figure),
                Cell::number(simulated, 1),
                Cell::number(measured, 1),
                if arrived { Cell::text("at the end") } else { number(foremost) },
                if arrived { Cell::Empty } else { number(there) },
                off(there, simulated),
                off(Some(simulated), measured),
                off(there, measured),
            ]);
        }
    }
    Ok(table)
}

/// Part of the whole way from which on a front is at its end: it then says nothing about when it came there.
const END: f64 = 0.98;

/// How far a front has been until a time; `None` before it set out.
fn place(track: &[[f64; 2]], time: f64) -> Option<f64> {
    track.iter().rfind(|sample| sample[0] <= time).map(|sample| sample[1])
}

/// When a front first was as far as a place.
fn time(track: &[[f64; 2]], place: f64) -> Option<f64> {
    track.iter().find(|sample| sample[1] >= place).map(|sample| sample[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_is_where_it_was_last_and_comes_when_it_first_is_there() {
        let track = [[1.0, 0.5], [2.0, 0.5], [3.0, 1.5]];
        assert_eq!([0.5, 1.0, 2.9, 9.0].map(|t| place(&track, t)), [None, Some(0.5), Some(0.5), Some(1.5)]);
        assert_eq!([0.5, 0.6, 2.0].map(|x| time(&track, x)), [Some(1.0), Some(3.0), None]);
    }
}
