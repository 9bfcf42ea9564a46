//! The paper from one command: every application of Bardenhagen et al. (2001) run,
//! measured and put side by side with what it says.
//!
//! A [`Study`] is an application: the cases that it needs, and the section of the report that it makes of their
//! results. To add one, write its file and list it in [`STUDIES`].

mod accounts;
mod backspin;
mod balance;
mod case;
mod chain;
mod convergence;
mod disks;
mod experiment;
mod frames;
mod inclined_plane;
mod momentum;
mod poisson;
mod sphere;

pub use case::{PaperCase, PaperResolution, Runs};

use crate::drawing::DrawError;
use crate::failure::Failure;
use crate::jobs::{Job, JobRunner};
use crate::page::{Making, Page, Section};
use maud::html;
use std::time::Instant;

/// An application of the paper.
pub trait Study: Sync {
    /// Its name on the command line.
    fn name(&self) -> &'static str;

    /// What is to be run.
    fn cases(&self, level: PaperResolution) -> Vec<PaperCase>;

    /// What came out; runs that failed are missing in it.
    ///
    /// # Errors
    /// Results cannot be read.
    fn section(&self, level: PaperResolution, runs: &Runs) -> Result<Section, Failure>;
}

/// All applications, in the order of the paper.
pub const STUDIES: &[&dyn Study] = &[
    &inclined_plane::InclinedPlane,
    &backspin::Backspin,
    &disks::Disks,
    &poisson::Poisson,
    &convergence::Convergence,
    &experiment::Experiment,
];

/// Runs studies and makes the report of them; whether all runs went well stands in [`Runs::failures`].
///
/// # Errors
/// A scene cannot be built, results cannot be read, or the user stopped the runs.
pub fn reproduce(
    studies: &[&dyn Study],
    level: PaperResolution,
    runner: &JobRunner,
) -> Result<(Page, Runs), Failure> {
    let start = Instant::now();
    let mut jobs: Vec<Job> = Vec::new();
    for case in studies.iter().flat_map(|study| study.cases(level)) {
        // Studies share cases.
        if !jobs.iter().any(|job| job.name == case.name) {
            jobs.push(case.job().map_err(Failure::input)?);
        }
    }
    let runs = Runs::new(runner.work(&jobs)?);
    let sections: Vec<Section> =
        studies.iter().map(|study| study.section(level, &runs)).collect::<Result<_, _>>()?;
    let making = Making::now(start.elapsed())
        .note("Scale", level.explanation())
        .note("Results of the runs", runner.folder.display().to_string());
    let mut page = Page::new("Bardenhagen et al. (2001), remade with Stickslip", making).lead(html! {
        "Every application of S. G. Bardenhagen, J. E. Guilkey, K. M. Roessig, J. U. Brackbill, W. M. Witzel and J. C. Foster (2001): "
        i { "An Improved Contact Algorithm for the Material Point Method and Application to Stress Propagation in Granular Material" }
        ", CMES 2(4), 509-522, run again with its own numbers. Each is run with two contact rules: "
        b { "the paper's rule" } " (" code { "traction" } "), which holds bodies together while the traction between them is compressive, and "
        b { "Stickslip's default" } " (" code { "surface" } "), which pushes where their exact surfaces touch."
    });
    for failure in runs.failures() {
        page = page.warning(html! { strong { "Failed: " } (failure.name) ": " (failure.error) });
    }
    for section in sections {
        page = page.section(section);
    }
    Ok((page.section(accounts::section(&runs)?), runs))
}

/// A failure to draw what is on the page.
fn drawn<T>(outcome: Result<T, DrawError>) -> Result<Option<T>, Failure> {
    match outcome {
        Ok(drawing) => Ok(Some(drawing)),
        Err(DrawError::Empty(_)) => Ok(None),
        Err(error) => Err(error.into()),
    }
}
