//! Section 3.3: stress waves through disks, seen as fringes; figures 9 to 11.

use super::Study;
use super::balance;
use super::case::{PaperCase, PaperResolution, PaperScene, Runs, TouchRule};
use super::chain::{self, Chain};
use super::frames;
use crate::failure::Failure;
use crate::page::{Cell, Column, EmbeddedImage, Figure, Mark, Section, Table};
use maud::html;

/// The study.
pub struct Disks;

/// One of the paper's arrangements with the times of its frames in transits.
pub struct DiskArrangement {
    pub figure: &'static str,
    scene: PaperScene,
    pub title: &'static str,
    /// Its name in tables.
    pub short: &'static str,
    /// Of the paper's simulation.
    pub simulated: [f64; 3],
    /// Of its experiment.
    pub measured: [f64; 3],
}

/// The three that the paper shows.
pub const ARRANGEMENTS: [DiskArrangement; 3] = [
    DiskArrangement {
        figure: "Figure 9",
        scene: PaperScene::COLLINEAR,
        title: "Four disks in a row",
        short: "in a row",
        simulated: [2.2, 5.5, 7.7],
        measured: [2.6, 6.6, 9.2],
    },
    DiskArrangement {
        figure: "Figure 10",
        scene: PaperScene::ZIGZAG,
        title: "Five disks in a zig-zag that slide on each other with friction 0.5",
        short: "zig-zag, sliding",
        simulated: [3.0, 6.0, 9.0],
        measured: [5.3, 10.5, 15.8],
    },
    DiskArrangement {
        figure: "Figure 11",
        scene: PaperScene::GLUED,
        title: "The same five disks, glued",
        short: "zig-zag, glued",
        simulated: [1.4, 3.6, 5.8],
        measured: [1.6, 4.2, 6.8],
    },
];

/// Part of the striker's speed with which a disk moves that the wave has come to.
const SET_OFF: f64 = 0.05;
/// The last disk is to be this much later sliding than glued.
const LATER: f64 = 1.3;

impl Study for Disks {
    fn name(&self) -> &'static str {
        "disks"
    }

    fn cases(&self, level: PaperResolution) -> Vec<PaperCase> {
        let mut cases = Vec::new();
        for rule in TouchRule::BOTH {
            cases.extend(ARRANGEMENTS.iter().map(|each| each.case(rule, level)));
            cases.push(frictionless(rule, level));
        }
        cases.extend([kinematic(level), to_the_letter(level)]);
        cases
    }

    fn section(&self, level: PaperResolution, runs: &Runs) -> Result<Section, Failure> {
        let mut section = Section::new("Stress waves through disks").text(html! {
            "Section 3.3. Disks of 1 cm in a frame are struck at the right by a step of velocity, and light between polarisers shows the \
             difference of the principal stresses as fringes, cos((σ" sub { "1" } " − σ" sub { "2" } ") / s). Here s = 0.3 ρ c V is the same \
             in all pictures; the paper, too, chose its own once. There are " (cells(level)) " cells across a disk and one particle a cell; the paper has 80 cells. \
             Times are in transits, those of a longitudinal wave through one disk: 0.98 µs. In the upper row are the paper's times of its own \
             simulation; in the lower, those at which its experiment showed the same pattern. The paper's fringes, and these by its \
             rule, run ahead of the experiment's, whose disks are of another material and in plane stress."
        });
        for each in &ARRANGEMENTS {
            section = section.figure(each.figure(level, runs)?);
        }
        section = section.table(frames::table(&ARRANGEMENTS, level, runs)?);
        section = section.text(
            "Sliding slows the fringes, gluing speeds them up. The wave counts as arrived when a disk's centre moves with a twentieth of the \
             striker's speed: in the zig-zag its path leaves the centres aside, so their stress tells little. What comes first is what is ordered: \
             by the paper's rule, with 40 cells and more, the fifth disk reaches a tenth of the striker's speed sooner without friction than with it.",
        );
        for rule in TouchRule::BOTH {
            section = section.table(arrivals(rule, level, runs)?);
        }
        section = section.table(load_paths(level, runs)?);
        if let Some(figure) = balance::figure(level, runs)? {
            section = section.figure(figure);
        }
        Ok(section.table(balance::table(level, runs)?))
    }
}

impl DiskArrangement {
    /// By which factor the times between the experiment's frames are longer than those of the paper's simulation.
    pub fn measured_stretch(&self) -> f64 {
        (self.measured[2] - self.measured[0]) / (self.simulated[2] - self.simulated[0])
    }

    /// What is run of it.
    pub fn case(&self, rule: TouchRule, level: PaperResolution) -> PaperCase {
        let times = self.simulated.iter().chain(&self.measured);
        let times: Vec<String> = times.map(|time| format!("\"{time} * transit\"")).collect();
        let times = format!("[{}]", times.join(", "));
        chain::case(self.scene, rule, cells(level), &[("outputs.particles_at", &times)])
    }

    fn figure(&self, level: PaperResolution, runs: &Runs) -> Result<Figure, Failure> {
        let caption = html! {
            (self.title) ", " (cells(level)) " cells across each. Times in transits; above the paper's of its simulation, below its experiment's, for each rule."
        };
        let mut figure = Figure::new(self.figure, caption);
        for rule in TouchRule::BOTH {
            let case = self.case(rule, level);
            let Some(chain) = runs.get(&case).and_then(Chain::new) else { continue };
            let Some(camera) = chain.camera()? else { continue };
            for (times, whose) in
                [(self.simulated, "the paper's simulation"), (self.measured, "its experiment")]
            {
                let mut row = Vec::new();
                for time in times {
                    let (shown, png) = camera.picture(time)?;
                    let description =
                        format!("{}, {} at t = {shown:.1}, a time of {whose}", self.title, rule.title());
                    row.push(
                        EmbeddedImage::png(&png, description)
                            .label(format!("{}, t = {shown:.1}", rule.short())),
                    );
                }
                figure = figure.row(row);
            }
        }
        Ok(figure)
    }
}

/// Cells across a disk.
pub fn cells(level: PaperResolution) -> usize {
    match level {
        PaperResolution::Sketch => 20,
        PaperResolution::Quick => 40,
        PaperResolution::Full => 80,
    }
}

/// The zig-zag without friction, which the paper does not show: the other end of the order.
pub fn frictionless(rule: TouchRule, level: PaperResolution) -> PaperCase {
    chain::case(PaperScene::ZIGZAG, rule, cells(level), &[("friction", "0")]).labelled("frictionless")
}

/// The rule before the paper's, for the energy that it gains.
pub fn kinematic(level: PaperResolution) -> PaperCase {
    chain::case(PaperScene::COLLINEAR, TouchRule::Kinematic, cells(level), &[])
}

/// The paper's rule in a row to the letter: each disk's own normals, and surfaces that are stairs of particles.
pub fn to_the_letter(level: PaperResolution) -> PaperCase {
    let settings = [("normal", "own"), ("particles", "lattice")];
    chain::case(PaperScene::COLLINEAR, TouchRule::Traction, cells(level), &settings).labelled("letter")
}

/// When the wave comes to each disk of the zig-zag.
fn arrivals(rule: TouchRule, level: PaperResolution, runs: &Runs) -> Result<Table, Failure> {
    let [_, sliding, glued] = &ARRANGEMENTS;
    let cases = [glued.case(rule, level), sliding.case(rule, level), frictionless(rule, level)];
    let mut times: Vec<Vec<Option<f64>>> = Vec::new();
    for case in &cases {
        times.push(
            runs.get(case).and_then(Chain::new).map_or(Ok(Vec::new()), |chain| chain.set_off(SET_OFF))?,
        );
    }
    let columns = vec![
        Column::text("disk, from the striker"),
        Column::number("glued"),
        Column::number("sliding, friction 0.5"),
        Column::number("frictionless"),
        Column::number("sliding / glued"),
        Column::text("glued < sliding < frictionless"),
    ];
    let caption = format!(
        "Arrival at the disks of the zig-zag in transits by {}. From the third disk on, the order is to hold; at the last, sliding is to be \
         {LATER} times as late as glued.",
        rule.title()
    );
    let mut table = Table::new(caption, columns);
    for disk in 0..DISKS {
        let at = |case: usize| times[case].get(disk).copied().flatten();
        let [glued, sliding, frictionless] = [at(0), at(1), at(2)];
        let mut row = vec![Cell::count(disk + 1)];
        row.extend(
            [glued, sliding, frictionless]
                .map(|time| time.map_or(Cell::text("not yet"), |time| Cell::number(time, 2))),
        );
        row.push(glued.zip(sliding).map_or(Cell::Empty, |(glued, sliding)| Cell::number(sliding / glued, 2)));
        let ordered = before(glued, sliding) && before(sliding, frictionless);
        let late = before(glued.map(|time| LATER * time), sliding);
        row.push(match disk + 1 {
            1 | 2 => Cell::Empty,
            DISKS => Cell::Verdict(Mark::of(ordered && late)),
            _ => Cell::Verdict(Mark::of(ordered)),
        });
        table = table.row(row);
    }
    Ok(table)
}

/// Which way the load goes at the third disk of the zig-zag: to the wall that it leans on, or on to the next disk.
fn load_paths(level: PaperResolution, runs: &Runs) -> Result<Table, Failure> {
    let [_, sliding, glued] = &ARRANGEMENTS;
    let columns = vec![
        Column::text("disks"),
        Column::text("contact rule"),
        Column::number(format!("on the wall, {PRECURSOR}")),
        Column::number(format!("on the fourth, {PRECURSOR}")),
        Column::number(format!("on the wall, {LOAD}")),
        Column::number(format!("on the fourth, {LOAD}")),
        Column::text("as the paper describes"),
    ];
    let caption = format!(
        "First time, in transits, at which the third disk of the zig-zag presses on the wall that it leans on and on the fourth disk with a part of the \
         pressure behind a plane wave times the radius. As the paper describes it, sliding disks load the wall first; glued ones pass the load \
         from contact to contact. What counts is {LOAD}; where disks slide, a precursor of {PRECURSOR} comes to both at about the same time."
    );
    let mut table = Table::new(caption, columns);
    for rule in TouchRule::BOTH {
        for (title, each) in [("sliding", sliding), ("glued", glued)] {
            let Some(chain) = runs.get(&each.case(rule, level)).and_then(Chain::new) else { continue };
            let mut row = vec![Cell::text(title), Cell::text(rule.short())];
            let mut holds = false;
            for part in [PRECURSOR, LOAD] {
                let wall =
                    earliest(chain.walls().into_iter().map(|wall| chain.pressed(["disk_3", wall], part)))?;
                let next = chain.pressed(["disk_3", "disk_4"], part)?;
                row.extend(
                    [wall, next].map(|time| time.map_or(Cell::text("not yet"), |time| Cell::number(time, 2))),
                );
                holds = if title == "sliding" { before(wall, next) } else { before(next, wall) };
            }
            row.push(Cell::Verdict(Mark::of(holds)));
            table = table.row(row);
        }
    }
    Ok(table)
}

/// Parts of a plane wave's force: what comes ahead of the load, and what counts as load.
const PRECURSOR: f64 = 0.05;
const LOAD: f64 = 0.2;

fn earliest(times: impl Iterator<Item = Result<Option<f64>, Failure>>) -> Result<Option<f64>, Failure> {
    let times: Vec<Option<f64>> = times.collect::<Result<_, _>>()?;
    Ok(times.into_iter().flatten().min_by(f64::total_cmp))
}

/// Disks in the zig-zag.
const DISKS: usize = 5;

/// Whether one came before the other, which may never have come.
fn before(one: Option<f64>, other: Option<f64>) -> bool {
    one.is_some_and(|one| other.is_none_or(|other| one < other))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_never_comes_comes_after_all() {
        assert!(before(Some(1.0), Some(2.0)) && before(Some(1.0), None));
        assert!(!before(Some(2.0), Some(1.0)) && !before(None, Some(1.0)) && !before(None, None));
    }
}
