//! What the report says of the frames: pictures side by side, their times, and how the fringes grow.

use super::answers::{Answers, CLOCK, NEAR, sequence};
use super::ingredients::as_known;
use super::place::Place;
use super::{cells, paper_case};
use crate::chart::{Chart, Curve, Panel, svg};
use crate::drawing::body_color;
use crate::failure::Failure;
use crate::page::{Cell, Column, EmbeddedImage, Figure, Section, Table};
use crate::reproduce::case::PaperResolution;
use crate::reproduce::drawn;
use maud::{Markup, html};
use std::collections::BTreeMap;

/// Correlation from which on patterns are the same to the eye.
pub const ALIKE: f64 = 0.8;

pub fn introduction(level: PaperResolution) -> Markup {
    html! {
        "The paper ends with its simulation ahead of its experiment. Here is the experiment itself: disks of Plexiglas of 2 inches and a quarter of an \
         inch, in plane stress, struck at 5.6 m/s, with Plexiglas' stiffness, relaxation and optics, " (cells(level)) " cells across a disk. Nothing is \
         fitted. The yardstick is the fringes of the paper's simulation at the times of its frames, remade with its numbers and its rule (a common normal \
         for each pair, particles that follow the edge). A run is like them where the light in all disks correlates best. The paper matched its three \
         frames together, with the times between them stretched alike; so does the factor here, with an offset of at most " (format!("{CLOCK:.2}")) " \
         transits, since the experiment knows the time of its impact to 10 µs. Times are in transits of 19 µs."
    }
}

/// The factors of the three arrangements.
pub fn stretches(answers: &Answers) -> Table {
    let columns = vec![
        Column::text("figure"),
        Column::text("disks"),
        Column::number("the experiment"),
        Column::number("the experiment as it is known"),
        Column::number("off the experiment"),
        Column::number("offset [transits]"),
        Column::number("as good from"),
        Column::number("to"),
        Column::number("correlation"),
        Column::number("published ranges allow from"),
        Column::number("to"),
        Column::number("with assumed ones from"),
        Column::number("to"),
        Column::text("the experiment within"),
    ];
    let caption = "By which factor the times of the paper's simulated frames must be stretched to find the same fringes. As good: the mean correlation of the \
                   frames is less by at most 0.02. What ranges allow: each quantity that is not known at the ends of its range, all else as known, on \
                   the cells of the table of what is not known; the largest deviations on either side, added in squares.";
    let mut table = Table::new(caption, columns);
    for place in Place::KNOWN {
        let arrangement = place.arrangement();
        let measured = arrangement.measured_stretch();
        let mut row =
            vec![Cell::text(arrangement.figure), Cell::text(arrangement.short), Cell::number(measured, 2)];
        if let Some(stretch) = answers.of(&as_known(place, cells(answers.level))).stretch {
            row.extend([
                Cell::number(stretch.factor, 2),
                Cell::percent(stretch.factor / measured - 1.0, 0),
                Cell::number(stretch.offset, 2),
                Cell::number(stretch.range[0], 2),
                Cell::number(stretch.range[1], 2),
                Cell::number(stretch.correlation, 2),
            ]);
            let [published, assumed] = [false, true].map(|assumed| answers.band(place, assumed));
            for band in [published, assumed] {
                row.extend(band.unwrap_or([f64::NAN; 2]).map(|end| Cell::number(end, 2)));
            }
            let within = assumed.map(|[low, high]| (low..=high).contains(&measured));
            row.push(within.map_or(Cell::Empty, yes_or_no));
        } else {
            row.push(Cell::text("not found"));
        }
        table = table.row(row);
    }
    table
}

/// An answer that is neither good nor bad.
pub fn yes_or_no(holds: bool) -> Cell {
    Cell::text(if holds { "yes" } else { "no" })
}

/// The paper's simulation at the times of its frames, and the experiment as it is known when it is most like them and
/// at the times of the measured frames.
///
/// # Errors
/// Pictures cannot be read.
pub fn pictures(
    section: Section,
    answers: &Answers,
    (known, paper): (Place, Place),
) -> Result<Section, Failure> {
    let arrangement = known.arrangement();
    let case = as_known(known, cells(answers.level));
    let paper = sequence(answers.runs, &paper_case(paper, answers.level))?;
    let (Some(run), Some(paper)) = (sequence(answers.runs, &case)?, paper) else { return Ok(section) };
    let alike = answers.of(&case).frames.map(|time| time.map_or(f64::NAN, |time| time.time));
    let caption = html! {
        (arrangement.title) ": the paper's simulation at the times of its frames; the experiment as it is known when its fringes are most like these; the \
         same at the times at which the experiment showed them."
    };
    let mut figure = Figure::new(format!("Experiment of {}", arrangement.figure.to_lowercase()), caption);
    let rows = [
        (&paper, arrangement.simulated, "the paper's simulation"),
        (&run, alike, "most like it"),
        (&run, arrangement.measured, "at the experiment's time"),
    ];
    for (sequence, times, whose) in rows {
        let mut row = Vec::new();
        for time in times.into_iter().filter(|time| time.is_finite()) {
            let (shown, png) = sequence.picture(time)?;
            let description = format!("{}, {whose}, t = {shown:.1}", arrangement.title);
            row.push(EmbeddedImage::png(&png, description).label(format!("{whose}, t = {shown:.1}")));
        }
        if !row.is_empty() {
            figure = figure.row(row);
        }
    }
    Ok(section.figure(figure))
}

/// The nine frames.
pub fn frames(answers: &Answers) -> Table {
    let columns = vec![
        Column::text("figure"),
        Column::number("the paper's simulation"),
        Column::number("its experiment"),
        Column::number("the experiment as it is known"),
        Column::number("spread over disks"),
        Column::number("correlation"),
        Column::text("patterns"),
        Column::number("off the experiment"),
        Column::text(format!("within {:.0} %", 100.0 * NEAR)),
    ];
    let caption = format!(
        "The nine frames one by one, in transits, each looked for within a quarter of its time by the factor above. The spread is the standard deviation \
         over the disks that have fringes. Below a correlation of {ALIKE} the patterns differ in kind, and the time says little."
    );
    let mut table = Table::new(caption, columns);
    for place in Place::KNOWN {
        let arrangement = place.arrangement();
        let frames = answers.of(&as_known(place, cells(answers.level))).frames;
        for (frame, found) in frames.iter().enumerate() {
            let measured = arrangement.measured[frame];
            let mut row = vec![
                Cell::text(arrangement.figure),
                Cell::number(arrangement.simulated[frame], 1),
                Cell::number(measured, 1),
            ];
            if let Some(found) = found {
                let off = found.time / measured - 1.0;
                row.extend([
                    Cell::number(found.time, 2),
                    Cell::number(found.spread(), 2),
                    Cell::number(found.correlation, 2),
                    Cell::text(if found.correlation < ALIKE { "differ in kind" } else { "alike" }),
                    Cell::percent(off, 0),
                    yes_or_no(off.abs() <= NEAR),
                ]);
            } else {
                row.push(Cell::text("not found"));
            }
            table = table.row(row);
        }
    }
    table
}

/// When the first fringe comes to each disk's centre and to its contact, and what order it grows to.
///
/// # Errors
/// A table cannot be read.
pub fn orders(answers: &Answers) -> Result<Table, Failure> {
    let columns = vec![
        Column::text("disks"),
        Column::number("from the striker"),
        Column::number("a quarter of an order at the centre: the paper's simulation"),
        Column::number("as known"),
        Column::number("one order beside the contact: the paper's simulation"),
        Column::number("as known"),
        Column::number("largest order at the centre until the last frame: the paper's simulation"),
        Column::number("as known"),
    ];
    let caption = "Arrival and growth of the fringes: times in transits at which the order at a disk's centre first is a quarter, and a quarter of the radius \
                   from its contact with the next disk, or the wall, first is one; and the largest order at the centre until the last frame, the paper's \
                   of its own simulation and the experiment's.";
    let mut table = Table::new(caption, columns);
    for (place, paper) in Place::KNOWN.into_iter().zip(Place::PAPER) {
        let arrangement = place.arrangement();
        let cases = [paper_case(paper, answers.level), as_known(place, cells(answers.level))];
        let [paper, known] = [answers.orders(&cases[0])?, answers.orders(&cases[1])?];
        let at = |orders: &BTreeMap<String, Vec<[f64; 2]>>, probe: String| {
            orders.get(&probe).cloned().unwrap_or_default()
        };
        let ends = [arrangement.simulated[2], arrangement.measured[2]];
        for disk in 1..=place.disks() {
            let mut row = vec![Cell::text(arrangement.short), Cell::count(disk)];
            for (probe, order) in [("centre", 0.25), ("contact", 1.0)] {
                for orders in [&paper, &known] {
                    let history = at(orders, format!("{probe} {disk}"));
                    let first = history.iter().find(|[_, there]| *there >= order);
                    row.push(first.map_or(Cell::text("not yet"), |[time, _]| Cell::number(*time, 2)));
                }
            }
            for (orders, end) in [&paper, &known].into_iter().zip(ends) {
                let history = at(orders, format!("centre {disk}"));
                let until = history.iter().filter(|[time, _]| *time <= end).map(|[_, order]| *order);
                row.push(Cell::number(until.fold(f64::NAN, f64::max), 1));
            }
            table = table.row(row);
        }
    }
    Ok(table)
}

/// Fringe order at the disks' centres over time, of the paper's simulation (dashed) and of the experiment as known.
///
/// # Errors
/// A table cannot be read, or the chart cannot be drawn.
pub fn growth(answers: &Answers, place: Place) -> Result<Option<Figure>, Failure> {
    let arrangement = place.arrangement();
    let paper = Place::PAPER[place.arrangement_index()];
    let cases = [(paper_case(paper, answers.level), true), (as_known(place, cells(answers.level)), false)];
    let mut curves = Vec::new();
    for (case, dashed) in &cases {
        let mut orders = answers.orders(case)?;
        for disk in 1..=place.disks() {
            let points = orders.remove(&format!("centre {disk}")).unwrap_or_default();
            let label = if *dashed { String::new() } else { format!("disk {disk}") };
            curves.push(Curve { label, color: body_color(disk - 1), dashed: *dashed, points });
        }
    }
    let chart = Chart {
        title: String::new(),
        over: "time [transits]".to_owned(),
        panels: vec![Panel { name: "fringe order at the centre".to_owned(), unit: "", curves }],
        caption: String::new(),
    };
    Ok(drawn(svg(&chart, [760, 420]))?.map(|svg| {
        let caption = format!(
            "{}: fringe order at the disks' centres; dashed, the paper's simulation; drawn out, the experiment as it is known.",
            arrangement.title
        );
        Figure::new(format!("Growth of the fringes, {}", arrangement.short), caption)
            .row(vec![EmbeddedImage::svg(&svg, "Fringe order at the centres of the disks over time")])
    }))
}
