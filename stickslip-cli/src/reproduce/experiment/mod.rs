//! The paper's open question: why its simulation runs ahead of its experiment. The experiment with its own material,
//! thickness, striker and optics, measured by its fringe patterns.

mod answers;
mod frames;
mod ingredients;
mod ladder;
mod likeness;
mod place;
mod plate;
#[cfg(test)]
mod tests;

use super::Study;
use super::case::{PaperCase, PaperResolution, Runs};
use super::disks::cells;
use crate::failure::Failure;
use crate::page::Section;
use answers::Answers;
use ingredients::{INGREDIENTS, Ingredient, UNKNOWNS, as_known};
use place::Place;

/// The study.
pub struct Experiment;

impl Study for Experiment {
    fn name(&self) -> &'static str {
        "experiment"
    }

    fn cases(&self, level: PaperResolution) -> Vec<PaperCase> {
        let mut cases: Vec<PaperCase> = placed_cases(level).into_iter().map(|(_, case)| case).collect();
        if level != PaperResolution::Sketch {
            cases.extend(plate::cases(level));
        }
        cases
    }

    fn section(&self, level: PaperResolution, runs: &Runs) -> Result<Section, Failure> {
        let answers = Answers::new(level, runs)?;
        let mut section = Section::new("The experiment").text(frames::introduction(level));
        for (known, paper) in Place::KNOWN.into_iter().zip(Place::PAPER) {
            section = frames::pictures(section, &answers, (known, paper))?;
        }
        section = section.table(frames::stretches(&answers)).table(frames::frames(&answers));
        section = section.table(frames::orders(&answers)?);
        for place in Place::KNOWN {
            if let Some(figure) = frames::growth(&answers, place)? {
                section = section.figure(figure);
            }
        }
        if level == PaperResolution::Sketch {
            return Ok(section);
        }
        section = section.table(ladder::ingredients(&answers)?).table(ladder::unknowns(&answers));
        Ok(section.table(ladder::convergence(&answers)).table(plate::table(level, runs)?))
    }
}

/// What is run in the plane, with where it is. A sketch has only the paper's simulation and the experiment as known.
fn placed_cases(level: PaperResolution) -> Vec<(Place, PaperCase)> {
    let cells = cells(level);
    let mut cases = Vec::new();
    cases.extend(Place::PAPER.map(|place| (place, paper_case(place, level))));
    cases.extend(Place::KNOWN.map(|place| (place, as_known(place, cells))));
    if level == PaperResolution::Sketch {
        return cases;
    }
    for number in 0..INGREDIENTS.len() {
        cases.extend(Place::PAPER.map(|place| (place, Ingredient::case(number, place, cells))));
    }
    let coarse = cells_of_unknowns(level);
    for unknown in &UNKNOWNS {
        cases.extend(unknown.places.iter().map(|&place| (place, unknown.case(place, coarse))));
    }
    cases.extend(Place::KNOWN.map(|place| (place, as_known(place, coarse))));
    cases.extend(Place::KNOWN.map(|place| (place, as_known(place, 2 * cells))));
    cases
}

/// Cells across a disk where what is not known is varied: what counts there are differences, and they are many.
fn cells_of_unknowns(level: PaperResolution) -> usize {
    cells(level).min(cells(PaperResolution::Quick))
}

/// The paper's simulation, whose fringes are the yardstick. It has the paper's 80 cells, since its contact is as wide
/// as its cells allow and so carries the wave sooner on coarser ones; only a sketch has fewer.
fn paper_case(place: Place, level: PaperResolution) -> PaperCase {
    Ingredient::case(0, place, if level == PaperResolution::Sketch { cells(level) } else { 80 })
}
