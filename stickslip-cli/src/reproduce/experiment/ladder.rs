//! What the report says of the ingredients of the experiment, one after the other, and of what is not known.

use super::answers::{Answer, Answers};
use super::frames::{ALIKE, yes_or_no};
use super::ingredients::{INGREDIENTS, Ingredient, UNKNOWNS, as_known};
use super::place::Place;
use super::{cells, cells_of_unknowns};
use crate::failure::Failure;
use crate::page::{Cell, Column, Table};
use crate::reproduce::case::PaperCase;

/// How far the interval from disk to disk may be from sharp contact's.
const SHARP_NEAR: f64 = 0.03;
/// How far twice as many cells may change a time.
const CONVERGED: f64 = 0.02;

/// One change at a time from the paper's simulation to the experiment.
///
/// # Errors
/// A table cannot be read.
pub fn ingredients(answers: &Answers) -> Result<Table, Failure> {
    let mut columns = vec![Column::text("on top of all above")];
    columns.extend(factor_columns());
    columns.extend([
        Column::number("from disk to disk in a row [transits]"),
        Column::number("times the one above"),
        Column::number("by its own waves"),
        Column::number("sharp contact"),
        Column::text(format!("within {:.0} %", 100.0 * SHARP_NEAR)),
    ]);
    let caption = format!(
        "What each ingredient does, on {} cells across a disk: the factor by which the times of the paper's frames must be stretched to find the same \
         fringes, in brackets where the mean correlation is below {ALIKE}; and the mean time from the first disk's centre in the row to the last one's, for \
         each disk between, as a stress difference of 0.3 of the pressure behind a plane wave comes there, over that of the row above, and in crossings by \
         the material's own longitudinal waves, beside finite elements with sharp contact.",
        cells(answers.level)
    );
    let mut table = Table::new(caption, columns);
    table = table.row(measured_factors("the experiment", 1));
    let mut before = f64::NAN;
    for (number, ingredient) in INGREDIENTS.iter().enumerate() {
        let case = |place| Ingredient::case(number, place, cells(answers.level));
        let mut row = vec![Cell::text(ingredient.title)];
        row.extend(Place::PAPER.map(|place| factor_cell(&answers.of(&case(place)))));
        let wait = answers.wait(&case(Place::Row))?.unwrap_or(f64::NAN);
        row.push(if wait.is_finite() { Cell::number(wait, 2) } else { Cell::text("not yet") });
        row.push(Cell::number(wait / before, 2));
        before = wait;
        if let Some(sharp) = ingredient.sharp {
            let crossings = wait * crossings_in_a_transit(answers, &case(Place::Row))?;
            row.extend([
                Cell::number(crossings, 3),
                Cell::number(sharp, 3),
                yes_or_no((crossings / sharp - 1.0).abs() <= SHARP_NEAR),
            ]);
        }
        table = table.row(row);
    }
    let strips = answers.of(&as_known(Place::Strips, cells(answers.level)));
    Ok(table.row(vec![Cell::text("glue in strips of 3 mm"), Cell::Empty, Cell::Empty, factor_cell(&strips)]))
}

/// A column of factors for each arrangement.
fn factor_columns() -> [Column; 3] {
    Place::PAPER.map(|place| Column::number(place.arrangement().short))
}

/// A row of the experiment's own factors, after some columns.
fn measured_factors(title: &str, columns: usize) -> Vec<Cell> {
    let mut row = vec![Cell::Empty; columns];
    row[0] = Cell::text(title);
    row.extend(Place::PAPER.map(|place| Cell::number(place.arrangement().measured_stretch(), 2)));
    row
}

fn factor_cell(answer: &Answer) -> Cell {
    match &answer.stretch {
        None => Cell::text("not found"),
        Some(stretch) if stretch.correlation < ALIKE => Cell::Number(format!("({:.2})", stretch.factor)),
        Some(stretch) => Cell::number(stretch.factor, 2),
    }
}

/// How often a longitudinal wave crosses a disk in the time that counts as a transit.
fn crossings_in_a_transit(answers: &Answers, case: &PaperCase) -> Result<f64, Failure> {
    let Some(results) = answers.runs.get(case) else { return Ok(f64::NAN) };
    let scene = results.scene().map_err(Failure::input)?;
    Ok(scene.number("transit") * scene.number("c_L") / scene.number("diameter"))
}

/// What is not known, and what it would change.
pub fn unknowns(answers: &Answers) -> Table {
    let coarse = cells_of_unknowns(answers.level);
    let mut columns = vec![Column::text("all as known but for"), Column::text("range")];
    columns.extend(factor_columns());
    let caption = format!(
        "What is not known of the experiment: the factors with one thing at a time at an end of its range, on {coarse} cells across a disk. In brackets where \
         the mean correlation is below {ALIKE}."
    );
    let mut table = Table::new(caption, columns);
    table = table.row(measured_factors("the experiment", 2));
    let mut row = vec![Cell::text("as known"), Cell::Empty];
    row.extend(Place::KNOWN.map(|place| factor_cell(&answers.of(&as_known(place, coarse)))));
    table = table.row(row);
    for unknown in &UNKNOWNS {
        let mut row = vec![Cell::text(unknown.title), Cell::text(unknown.basis.word())];
        for index in 0..Place::PAPER.len() {
            let place = unknown.places.iter().find(|place| place.arrangement_index() == index);
            let answer = place.map(|&place| answers.of(&unknown.case(place, coarse)));
            row.push(answer.map_or(Cell::Empty, |answer| factor_cell(&answer)));
        }
        table = table.row(row);
    }
    table
}

/// The same with twice as many cells.
pub fn convergence(answers: &Answers) -> Table {
    let cells = cells(answers.level);
    let columns = vec![
        Column::text("figure"),
        Column::text("frame"),
        Column::number(format!("{cells} cells")),
        Column::number(format!("{} cells", 2 * cells)),
        Column::number("change"),
        Column::text(format!("within {:.0} %", 100.0 * CONVERGED)),
    ];
    let caption = "The experiment as it is known with twice as many cells across a disk, held to the same pictures: times of the frames in transits, and \
                   the factors.";
    let mut table = Table::new(caption, columns);
    for place in Place::KNOWN {
        let [coarse, fine] = [cells, 2 * cells].map(|cells| answers.of(&as_known(place, cells)));
        let times = (0..3).map(|frame| {
            let time = |answer: &Answer| answer.frames[frame].as_ref().map_or(f64::NAN, |found| found.time);
            ((frame + 1).to_string(), [time(&coarse), time(&fine)])
        });
        let factor = |answer: &Answer| answer.stretch.as_ref().map_or(f64::NAN, |stretch| stretch.factor);
        let factors = ("factor".to_owned(), [factor(&coarse), factor(&fine)]);
        for (title, [coarse, fine]) in times.chain([factors]) {
            let change = fine / coarse - 1.0;
            table = table.row(vec![
                Cell::text(place.arrangement().figure),
                Cell::text(title),
                Cell::number(coarse, 2),
                Cell::number(fine, 2),
                Cell::percent(change, 1),
                if change.is_finite() { yes_or_no(change.abs() <= CONVERGED) } else { Cell::Empty },
            ]);
        }
    }
    table
}
