//! What the runs say: when their fringes are most like those of the paper's simulation.

use super::ingredients::{Basis, UNKNOWNS, as_known};
use super::likeness::{Likeness, Sequence, Stretch};
use super::place::Place;
use super::{cells, cells_of_unknowns, paper_case, placed_cases};
use crate::failure::Failure;
use crate::reproduce::case::{PaperCase, PaperResolution, Runs};
use crate::reproduce::chain::Chain;
use std::collections::BTreeMap;
use stickslip::scene::Sensitivity;

/// What is read from the runs once for all tables.
pub struct Answers<'a> {
    pub runs: &'a Runs,
    pub level: PaperResolution,
    /// By the names of cases.
    answers: BTreeMap<String, Answer>,
}

/// When a run's fringes are most like the paper's.
#[derive(Clone, Debug, Default)]
pub struct Answer {
    /// Of the three frames of the arrangement together.
    pub stretch: Option<Stretch>,
    /// Of each by itself, within a quarter of the time that the stretch says.
    pub frames: [Option<Likeness>; 3],
}

/// How far a time may be from the experiment's, over it.
pub const NEAR: f64 = 0.05;
/// By how much the experiment's clock may be off: 10 us, over the transit of 19 us.
pub const CLOCK: f64 = 10.0 / 19.0;
/// How far from its time by the stretch a frame is looked for, over it.
const AROUND: f64 = 0.25;

impl<'a> Answers<'a> {
    /// # Errors
    /// Pictures cannot be read.
    pub fn new(level: PaperResolution, runs: &'a Runs) -> Result<Self, Failure> {
        let mut paper: [Option<Sequence>; 3] = [None, None, None];
        for place in Place::PAPER {
            paper[place.arrangement_index()] = sequence(runs, &paper_case(place, level))?;
        }
        let mut answers = BTreeMap::new();
        for (place, case) in placed_cases(level) {
            // Some stand for several things.
            if answers.contains_key(&case.name) {
                continue;
            }
            let (Some(run), Some(paper)) = (sequence(runs, &case)?, &paper[place.arrangement_index()]) else {
                continue;
            };
            let given = place.arrangement().simulated;
            let stretch = run.stretch(paper, &given, CLOCK);
            let frames = given.map(|time| {
                let about = stretch.as_ref().map(|stretch| stretch.offset + stretch.factor * time)?;
                run.most_like(paper, time, [(1.0 - AROUND) * about, (1.0 + AROUND) * about])
            });
            answers.insert(case.name, Answer { stretch, frames });
        }
        Ok(Answers { runs, level, answers })
    }

    /// What a run says.
    pub fn of(&self, case: &PaperCase) -> Answer {
        self.answers.get(&case.name).cloned().unwrap_or_default()
    }

    /// The lowest and the highest factor of an arrangement if what is not known lies anywhere in its range: of each
    /// quantity the largest deviation on either side, on the cells on which it is varied, of all quantities added in
    /// squares. With assumed ranges, or of published ones alone; `None` if a run has no factor.
    pub fn band(&self, place: Place, assumed: bool) -> Option<[f64; 2]> {
        let factor = |case: &PaperCase| Some(self.of(case).stretch?.factor);
        let coarse = cells_of_unknowns(self.level);
        let [known, before] = [cells(self.level), coarse].map(|cells| factor(&as_known(place, cells)));
        let (known, before) = (known?, before?);
        let mut largest: BTreeMap<&str, [f64; 2]> = BTreeMap::new();
        for unknown in &UNKNOWNS {
            let counts = unknown.basis == Basis::Published || (assumed && unknown.basis == Basis::Assumed);
            let same = |other: &&Place| other.arrangement_index() == place.arrangement_index();
            let Some(&there) = unknown.places.iter().find(same).filter(|_| counts) else { continue };
            let off = factor(&unknown.case(there, coarse))? - before;
            let sides = largest.entry(unknown.quantity).or_default();
            let side = &mut sides[usize::from(off > 0.0)];
            *side = side.max(off.abs());
        }
        let sum = |side: usize| largest.values().map(|sides| sides[side].powi(2)).sum::<f64>().sqrt();
        Some([known - sum(0), known + sum(1)])
    }

    /// Mean time from the first disk's centre to the last one's for each disk between, as the stress difference comes
    /// there [transits]; `None` if it does not come to both.
    ///
    /// # Errors
    /// A table cannot be read.
    pub fn wait(&self, case: &PaperCase) -> Result<Option<f64>, Failure> {
        let Some(chain) = self.runs.get(case).and_then(Chain::new) else { return Ok(None) };
        let arrivals = chain.arrivals()?;
        let [Some(first), .., Some(last)] = arrivals[..] else { return Ok(None) };
        Ok(Some((last - first) / (arrivals.len() - 1) as f64))
    }

    /// Fringe order over time in transits at each probe, by its name: `centre 2`, `contact 1`.
    ///
    /// # Errors
    /// A table cannot be read.
    pub fn orders(&self, case: &PaperCase) -> Result<BTreeMap<String, Vec<[f64; 2]>>, Failure> {
        let mut orders: BTreeMap<String, Vec<[f64; 2]>> = BTreeMap::new();
        let Some(results) = self.runs.get(case) else { return Ok(orders) };
        let scene = results.scene().map_err(Failure::input)?;
        let outputs = &scene.outputs;
        let (Some(unit), Some(camera)) = (&outputs.measurements.time_unit, &outputs.fringes) else {
            return Ok(orders);
        };
        // The light's way through a plane scene counts as one.
        let (Sensitivity::StressPerFringe(fringe) | Sensitivity::StressThicknessPerFringe(fringe)) =
            camera.polariscope.sensitivity;
        for row in results.probes_table().map_err(Failure::input)? {
            let order = [row.time / unit.seconds, row.stress_difference / fringe];
            orders.entry(row.probe).or_default().push(order);
        }
        Ok(orders)
    }
}

/// What the camera of a run saw; `None` if it failed.
///
/// # Errors
/// Pictures cannot be read.
pub fn sequence(runs: &Runs, case: &PaperCase) -> Result<Option<Sequence>, Failure> {
    runs.get(case).map_or(Ok(None), Sequence::new)
}
