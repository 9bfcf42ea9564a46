//! `arrivals.csv`: when quantities first pass their thresholds.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::points::{Points, SamplePoint};
use super::probes::points;
use super::schedule::Schedule;
use super::shared::{Asked, Question, answer};
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{ARRIVALS, Doubt, Observer};
use crate::door::View;
use crate::exact::ExactSum;
use crate::scene::{Anchor, Arrival, Observable, Reading, Scene};
use serde::{Deserialize, Serialize};

/// A threshold that was passed; the columns of `arrivals.csv`. A threshold that was not passed has no row.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ArrivalRow {
    /// Simulated time at which it was passed, on a straight line between the samples before and after [s].
    pub time: f64,
    /// Name of the quantity.
    pub quantity: String,
    /// The threshold [Pa or m/s].
    pub threshold: f64,
    /// `probe`, or what stands for the body: `center`, `any`, `mean`.
    pub reading: String,
    /// Name of the probe or the body.
    pub place: String,
    /// Where it was passed [m].
    pub position: [f64; 3],
}

impl TableRow for ArrivalRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, quantity, threshold, reading, place, position: [x, y, z] } = self;
        columns![time, quantity, threshold, reading, place, x, y, z]
    }
}

/// Writes `arrivals.csv`.
pub(super) struct ArrivalsObserver {
    scene: Scene,
    awaited: Option<ArrivalWatches>,
    /// All that was ever awaited, as rows without time and place.
    known: Vec<ArrivalRow>,
    /// Whether what is awaited comes from a checkpoint, and the scene may want other things.
    taken_up: bool,
    schedule: Schedule,
    table: CsvTable<ArrivalRow>,
}

/// What has not arrived yet, and the points to look at.
#[derive(Serialize, Deserialize)]
struct ArrivalWatches {
    watches: Vec<ArrivalWatch>,
    points: Points,
}

/// One quantity at one place, until it arrives.
#[derive(Serialize, Deserialize)]
struct ArrivalWatch {
    quantity: Observable,
    source: ArrivalSource,
    crossing: ThresholdCrossing,
    /// Whether it is awaited only since the run went on: nobody knows when what has come by then came.
    late: bool,
    /// The row, but for time and place.
    row: ArrivalRow,
}

/// Where a watch looks.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
enum ArrivalSource {
    /// The point with this index.
    Point(usize),
    /// The body with this index: its furthest particle.
    Any(usize),
    /// The body with this index: its mean.
    Mean(usize),
}

/// Notices when a value first passes a threshold.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct ThresholdCrossing {
    threshold: f64,
    before: Option<[f64; 2]>,
}

impl ThresholdCrossing {
    /// A threshold, which is passed away from zero.
    pub(super) fn of(threshold: f64) -> Self {
        ThresholdCrossing { threshold, before: None }
    }

    /// Takes the value at a time [s]; the time of passing if it is at the threshold or beyond:
    ///
    /// ```text
    /// t = t0 + (threshold - q0) / (q1 - q0) (t1 - t0)
    /// ```
    ///
    /// and t1 itself where there was no value before.
    pub(super) fn at(&mut self, time: f64, value: f64) -> Option<f64> {
        let before = self.before.replace([time, value]);
        if value * self.threshold.signum() < self.threshold.abs() {
            return None;
        }
        Some(match before {
            Some([t0, q0]) if value != q0 => t0 + (self.threshold - q0) / (value - q0) * (time - t0),
            _ => time,
        })
    }
}

impl ArrivalsObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let wanted = &scene.outputs.measurements;
        Ok(ArrivalsObserver {
            scene: scene.clone(),
            awaited: None,
            known: Vec::new(),
            taken_up: false,
            schedule: Schedule::every(wanted.samples),
            table: CsvTable::create(folder, ARRIVALS, wanted.unit())?,
        })
    }
}

impl Observer for ArrivalsObserver {
    fn next(&self) -> f64 {
        match &self.awaited {
            Some(awaited) if awaited.watches.is_empty() && !self.taken_up => f64::INFINITY,
            _ => self.schedule.next(),
        }
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        if self.awaited.is_none() || self.taken_up {
            let wanted = ArrivalWatches::new(&self.scene, view);
            let rows: Vec<ArrivalRow> = wanted.watches.iter().map(|watch| watch.row.clone()).collect();
            self.awaited = Some(match self.awaited.take() {
                Some(before) => before.changed_to(wanted, &self.known),
                None => wanted,
            });
            self.known.extend(rows);
            self.taken_up = false;
        }
        let rows = self.awaited.as_mut().map_or_else(Vec::new, |awaited| awaited.arrived(view));
        self.table.append(rows)?;
        self.schedule.recorded(view.time());
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }

    fn doubts(&self) -> Vec<Doubt> {
        let awaited = self.awaited.iter().flat_map(|awaited| &awaited.watches);
        let awaited: Vec<(&str, f64)> =
            awaited.map(|watch| (watch.quantity.name(), watch.row.threshold)).collect();
        // Somewhere a threshold may well not be passed; where it is passed nowhere, nothing came of the table.
        let all = &self.scene.outputs.measurements.arrivals;
        let nowhere = all.iter().filter(|arrival| {
            let places = arrival.probes.len() + arrival.bodies.len();
            let waits = |other: &&(&str, f64)| **other == (arrival.quantity.name(), arrival.threshold);
            awaited.iter().filter(waits).count() >= places
        });
        let named: Vec<String> =
            nowhere.map(|arrival| format!("{} {}", arrival.quantity.name(), arrival.threshold)).collect();
        let message = |named: &str| format!("nothing ever reached the threshold of the arrival {named}");
        Doubt::of_all(&named.iter().collect::<Vec<_>>(), message, "it has no row: lower its `threshold`")
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("known", &mut self.known)?;
        let known = memory.keep("awaited", &mut self.awaited)?;
        if memory.is_taking_up() {
            self.taken_up = true;
            // Of what was not awaited nobody knows whether it has come.
            let nothing = || ArrivalWatches { watches: Vec::new(), points: Points::new(&self.scene, []) };
            self.awaited = self.awaited.take().filter(|_| known).or_else(|| Some(nothing()));
        }
        if memory.is_taking_up() && !self.awaited.iter().all(|awaited| awaited.fits(self.scene.bodies.len()))
        {
            return Err(memory.wrong("awaited", "it names bodies or points that there are not"));
        }
        self.schedule.remember(memory)?;
        self.table.remember(memory)
    }
}

impl ArrivalWatches {
    fn new(scene: &Scene, view: &dyn View) -> Self {
        let wanted = &scene.outputs.measurements;
        let mut points: Vec<SamplePoint> = points(scene, wanted.probes.iter()).collect();
        let mut watches = Vec::new();
        for arrival in &wanted.arrivals {
            for name in &arrival.probes {
                let probe = wanted.probes.iter().position(|probe| probe.name == *name);
                let probe = probe.expect("arrivals name probes of their scene");
                watches.push(ArrivalWatch::new(arrival, ("probe", name), ArrivalSource::Point(probe)));
            }
            for name in &arrival.bodies {
                let body = scene.bodies.iter().position(|body| body.name == *name);
                let body = body.expect("arrivals name bodies of their scene");
                let (reading, source) = match arrival.reading {
                    Reading::Center => ("center", ArrivalSource::Point(points.len())),
                    Reading::Any => ("any", ArrivalSource::Any(body)),
                    Reading::Mean => ("mean", ArrivalSource::Mean(body)),
                };
                if arrival.reading == Reading::Center {
                    let at = view.bodies()[body].position;
                    points.push(SamplePoint { at, body: Some(body), fixed_in: Anchor::Material });
                }
                watches.push(ArrivalWatch::new(arrival, (reading, name), source));
            }
        }
        ArrivalWatches { watches, points: Points::new(scene, points) }
    }

    /// Whether all bodies and points that it names are there.
    fn fits(&self, bodies: usize) -> bool {
        self.points.fit(bodies)
            && self.watches.iter().all(|watch| match watch.source {
                ArrivalSource::Point(point) => point < self.points.len(),
                ArrivalSource::Any(body) | ArrivalSource::Mean(body) => body < bodies,
            })
    }

    /// What is wanted now: of what was awaited that which still is, as far as it has come, and what is new, which must
    /// first be short of its threshold.
    fn changed_to(mut self, wanted: ArrivalWatches, known: &[ArrivalRow]) -> Self {
        self.watches.retain(|watch| wanted.watches.iter().any(|wanted| wanted.row == watch.row));
        for mut watch in wanted.watches.into_iter().filter(|watch| !known.contains(&watch.row)) {
            if let ArrivalSource::Point(point) = &mut watch.source {
                *point = self.points.add(&wanted.points, *point);
            }
            self.watches.push(ArrivalWatch { late: true, ..watch });
        }
        self
    }

    /// What arrived since the last look, in the order of time; it is watched no longer.
    fn arrived(&mut self, view: &dyn View) -> Vec<ArrivalRow> {
        let samples = self.points.sample(view);
        let mut rows = Vec::new();
        self.watches.retain_mut(|watch| {
            let seen = match watch.source {
                ArrivalSource::Point(point) => samples[point]
                    .map(|sample| (watch.value(&sample.velocity, &sample.stress), sample.position)),
                ArrivalSource::Any(body) => {
                    let side = watch.crossing.threshold.signum();
                    let furthest = answer(view, &Furthest { body, quantity: watch.quantity, side });
                    furthest.map(|(value, _, position)| (side * value, position))
                }
                ArrivalSource::Mean(body) => {
                    let sums = answer(view, &MassMean { body, quantity: watch.quantity });
                    let [mass, sum, moment @ ..] = sums.each_ref().map(ExactSum::value);
                    (mass > 0.0).then(|| (sum / mass, moment.map(|x| x / mass)))
                }
            };
            let late = std::mem::take(&mut watch.late);
            let Some((value, position)) = seen else { return true };
            let passed = watch.crossing.at(view.time(), value);
            if late {
                return passed.is_none();
            }
            rows.extend(passed.map(|time| ArrivalRow { time, position, ..watch.row.clone() }));
            passed.is_none()
        });
        rows.sort_by(|a, b| a.time.total_cmp(&b.time));
        rows
    }
}

impl ArrivalWatch {
    fn new(arrival: &Arrival, (reading, place): (&str, &str), source: ArrivalSource) -> Self {
        let Arrival { quantity, threshold, .. } = *arrival;
        let row = ArrivalRow {
            quantity: quantity.name().to_string(),
            threshold,
            reading: reading.to_string(),
            place: place.to_string(),
            ..ArrivalRow::default()
        };
        ArrivalWatch { quantity, source, crossing: ThresholdCrossing::of(threshold), late: false, row }
    }

    fn value(&self, velocity: &[f64; 3], stress: &[f64; 6]) -> f64 {
        self.quantity.value(velocity, stress)
    }
}

/// The value furthest to a side in a body, and where it is.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(super) struct Furthest {
    body: usize,
    quantity: Observable,
    /// 1 or -1.
    side: f64,
}

impl Question for Furthest {
    /// How far it is to that side, and the particle's number and place; none of a body without particles.
    type Answer = Option<(f64, u32, [f64; 3])>;

    fn look(&self, view: &dyn View) -> Self::Answer {
        let mut furthest = None;
        view.visit(self.body, &mut |particle| {
            let value = self.side * self.quantity.value(&particle.velocity, &particle.stress);
            furthest = Self::join(furthest, Some((value, particle.number, particle.position)));
        });
        furthest
    }

    fn join(one: Self::Answer, other: Self::Answer) -> Self::Answer {
        let (Some((value, number, _)), Some((most, of, _))) = (other, one) else { return one.or(other) };
        // Of equal ones the first by number: nobody knows in which order they are shown.
        if value > most || value == most && number < of { other } else { one }
    }

    fn asked(&self) -> Asked {
        Asked::Furthest(*self)
    }
}
/// The mean of values over the mass of a body, and its centre of mass.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(super) struct MassMean {
    body: usize,
    quantity: Observable,
}

impl Question for MassMean {
    /// Sums of m, m q and m x.
    type Answer = [ExactSum; 5];

    fn look(&self, view: &dyn View) -> Self::Answer {
        let mut sums = [0; 5].map(|_| ExactSum::default());
        view.visit(self.body, &mut |particle| {
            let value = self.quantity.value(&particle.velocity, &particle.stress);
            let [x, y, z] = particle.position;
            let of_mass = [1.0, value, x, y, z];
            sums.iter_mut().zip(of_mass).for_each(|(sum, x)| sum.add(particle.mass * x));
        });
        sums
    }

    fn join(mut one: Self::Answer, other: Self::Answer) -> Self::Answer {
        ExactSum::merge_each(&mut one, &other);
        one
    }

    fn asked(&self) -> Asked {
        Asked::Mean(*self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Time of passing of a quantity that is sampled at these times and values.
    fn passing(threshold: f64, samples: &[[f64; 2]]) -> Option<f64> {
        let mut crossing = ThresholdCrossing::of(threshold);
        samples.iter().find_map(|&[time, value]| crossing.at(time, value))
    }

    #[test]
    fn a_ramp_is_passed_exactly_between_samples() {
        let ramp: Vec<[f64; 2]> =
            (0..10).map(|i| [0.5 * f64::from(i), 3.0 * 0.5 * f64::from(i) - 2.0]).collect();
        // q = 3 t - 2: at 4 when t = 2, a sample; at 5 when t = 7/3, between samples.
        assert_eq!(passing(4.0, &ramp), Some(2.0));
        assert!((passing(5.0, &ramp).unwrap() - 7.0 / 3.0).abs() < 1e-15);
        assert_eq!(passing(100.0, &ramp), None);
    }

    #[test]
    fn a_negative_threshold_is_passed_downward() {
        let falling = [[0.0, 1.0], [1.0, -1.0], [2.0, -5.0]];
        assert_eq!(passing(-3.0, &falling), Some(1.5));
        assert_eq!(passing(3.0, &falling), None);
    }

    #[test]
    fn what_is_beyond_the_threshold_when_first_seen_arrives_then() {
        assert_eq!(passing(1.0, &[[0.25, 2.0], [0.5, 3.0]]), Some(0.25));
        assert_eq!(passing(2.0, &[[0.25, 2.0]]), Some(0.25), "at the threshold is passed");
    }
}
