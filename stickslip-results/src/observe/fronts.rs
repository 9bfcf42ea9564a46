//! `fronts.csv` and `front_speeds.csv`: how far fronts have come, and how fast they run.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::shared::{Asked, Question, answer};
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{Doubt, FRONT_SPEEDS, FRONTS, Observer};
use crate::door::{ParticleView, View};
use crate::scene::{Front, Scene};
use serde::{Deserialize, Serialize};

/// A front at one time, in SI units; the columns of `fronts.csv`. A front that is nowhere has no row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrontRow {
    /// Simulated time [s].
    pub time: f64,
    /// Name of the front.
    pub front: String,
    /// How far it is from its starting point, along its direction [m].
    pub distance: f64,
    /// Where the particle there is [m].
    pub position: [f64; 3],
}

/// The speed of a front, in SI units; the columns of `front_speeds.csv`.
///
/// ```text
/// speed = sum (t - t_mean)(s - s_mean) / sum (t - t_mean)^2       (least squares of s = s_0 + speed t)
/// error = sqrt(sum (s - s_0 - speed t)^2 / (n - 2) / sum (t - t_mean)^2)
/// ```
///
/// over the samples in which s, the furthest that the front has been, lies on the way that is fitted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrontSpeedRow {
    /// Time of the last sample that is fitted [s].
    pub time: f64,
    /// Name of the front.
    pub front: String,
    /// Speed [m/s].
    pub speed: f64,
    /// Standard error of the speed [m/s].
    pub error: f64,
    /// Time of the first sample that is fitted [s].
    pub start_time: f64,
    /// Start of the way that is fitted [m].
    pub start: f64,
    /// End of the way that is fitted [m].
    pub end: f64,
    /// Samples that are fitted.
    pub samples: usize,
}

impl TableRow for FrontRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, front, distance, position: [x, y, z] } = self;
        columns![time, front, distance, x, y, z]
    }
}

impl TableRow for FrontSpeedRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, front, speed, error, start_time, start, end, samples } = self;
        columns![time, front, speed, error, start_time, start, end, samples]
    }
}

/// Writes `fronts.csv`, and at the end `front_speeds.csv`.
pub(super) struct FrontsObserver {
    tracks: Vec<Track>,
    schedule: Schedule,
    table: CsvTable<FrontRow>,
    speeds: CsvTable<FrontSpeedRow>,
}

/// A front and where it has been.
struct Track {
    front: Front,
    /// Indices of the bodies in which it runs.
    bodies: Vec<usize>,
    /// Time [s] and the furthest that it has been until then [m].
    furthest: Vec<[f64; 2]>,
}

impl FrontsObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let wanted = &scene.outputs.measurements;
        let track = |front: &Front| Track {
            front: front.clone(),
            bodies: (0..scene.bodies.len())
                .filter(|&i| front.bodies.contains(&scene.bodies[i].name))
                .collect(),
            furthest: Vec::new(),
        };
        Ok(FrontsObserver {
            tracks: wanted.fronts.iter().map(track).collect(),
            schedule: Schedule::every(wanted.samples),
            table: CsvTable::create(folder, FRONTS, wanted.unit())?,
            speeds: CsvTable::create(folder, FRONT_SPEEDS, wanted.unit())?,
        })
    }
}

impl Observer for FrontsObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let rows: Vec<FrontRow> = self.tracks.iter_mut().filter_map(|track| track.follow(view)).collect();
        self.table.append(rows)?;
        self.schedule.recorded(view.time());
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        let rows: Vec<FrontSpeedRow> = self.tracks.iter().filter_map(Track::speed).collect();
        self.speeds.append(rows)?;
        self.speeds.finish()?;
        self.table.finish()
    }

    fn doubts(&self) -> Vec<Doubt> {
        let never = self.tracks.iter().filter(|track| track.furthest.is_empty());
        let names: Vec<&String> = never.map(|track| &track.front.name).collect();
        let message = |named: &str| format!("nothing ever reached the threshold of the front {named}");
        Doubt::of_all(&names, message, "it has no row: lower `threshold`, or widen `within`")
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        let of_track = |track: &Track| (track.front.clone(), track.furthest.clone());
        let mut kept: Vec<_> = self.tracks.iter().map(of_track).collect();
        memory.keep("tracks", &mut kept)?;
        for track in &mut self.tracks {
            if let Some((_, furthest)) = kept.iter().find(|(front, _)| *front == track.front) {
                track.furthest.clone_from(furthest);
            }
        }
        self.schedule.remember(memory)?;
        memory.part("speeds", |memory| self.speeds.remember(memory))?;
        self.table.remember(memory)
    }
}

impl Track {
    /// Where the front is now, if anywhere.
    fn follow(&mut self, view: &dyn View) -> Option<FrontRow> {
        let question = FrontQuestion { front: self.front.clone(), bodies: self.bodies.clone() };
        let (distance, _, position) = answer(view, &question)?;
        let time = view.time();
        let before = self.furthest.last().map_or(f64::NEG_INFINITY, |[_, distance]| *distance);
        self.furthest.push([time, distance.max(before)]);
        Some(FrontRow { time, front: self.front.name.clone(), distance, position })
    }

    /// Its speed, if it went over enough of the way.
    fn speed(&self) -> Option<FrontSpeedRow> {
        let (&[_, first], &[_, last]) = (self.furthest.first()?, self.furthest.last()?);
        let [start, end] = self.front.fit.unwrap_or([0.1, 0.9].map(|part| first + part * (last - first)));
        let fitted = self.furthest.iter().filter(|[_, way]| (start..=end).contains(way));
        let fitted: Vec<[f64; 2]> = fitted.copied().collect();
        let (&[start_time, _], &[time, _]) = (fitted.first()?, fitted.last()?);
        let (speed, error) = slope(&fitted)?;
        let front = self.front.name.clone();
        Some(FrontSpeedRow { time, front, speed, error, start_time, start, end, samples: fitted.len() })
    }
}

/// How far along a front's direction a particle is, if the quantity is at the threshold or beyond there.
fn way(front: &Front, particle: &ParticleView) -> Option<f64> {
    let value = front.quantity.value(&particle.velocity, &particle.stress);
    if value * front.threshold.signum() < front.threshold.abs() {
        return None;
    }
    let from: [f64; 3] = std::array::from_fn(|k| particle.position[k] - front.from[k]);
    let along: f64 = (0..3).map(|k| from[k] * front.direction[k]).sum();
    let across = (0..3).map(|k| (from[k] - along * front.direction[k]).powi(2)).sum::<f64>().sqrt();
    front.within.is_none_or(|within| across <= within).then_some(along)
}

/// Where a front is furthest in some bodies.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct FrontQuestion {
    front: Front,
    bodies: Vec<usize>,
}

impl Question for FrontQuestion {
    /// How far it is, the body and the number of the particle, and its place.
    type Answer = Option<(f64, (u32, usize), [f64; 3])>;

    fn look(&self, view: &dyn View) -> Self::Answer {
        let mut furthest = None;
        for &body in &self.bodies {
            view.visit(body, &mut |particle| {
                let here =
                    way(&self.front, particle).map(|way| (way, (particle.number, body), particle.position));
                furthest = Self::join(furthest, here);
            });
        }
        furthest
    }

    fn join(one: Self::Answer, other: Self::Answer) -> Self::Answer {
        let (Some((way, which, _)), Some((most, of, _))) = (other, one) else { return one.or(other) };
        // Of equal ones the first by number: nobody knows in which order they are shown.
        if way > most || way == most && which < of { other } else { one }
    }

    fn asked(&self) -> Asked {
        Asked::Front(self.clone())
    }
}

/// Slope of the straight line that is closest to points in the sense of least squares, and its standard error; `None`
/// of fewer than three points and of points one above the other.
fn slope(points: &[[f64; 2]]) -> Option<(f64, f64)> {
    let n = points.len() as f64;
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / n;
    let [t, s] = [mean(0), mean(1)];
    let spread: f64 = points.iter().map(|point| (point[0] - t).powi(2)).sum();
    if points.len() < 3 || spread <= 0.0 {
        return None;
    }
    let slope = points.iter().map(|point| (point[0] - t) * (point[1] - s)).sum::<f64>() / spread;
    let rest: f64 = points.iter().map(|point| (point[1] - s - slope * (point[0] - t)).powi(2)).sum();
    Some((slope, (rest / (n - 2.0) / spread).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Observable;

    fn front(fit: Option<[f64; 2]>) -> Front {
        Front {
            name: "front".into(),
            quantity: Observable::StressDifference,
            threshold: 1.0,
            from: [1.0, 0.0, 0.0],
            direction: [0.6, 0.8, 0.0],
            within: Some(0.5),
            bodies: Vec::new(),
            fit,
        }
    }

    fn particle(position: [f64; 3], stress: f64) -> ParticleView {
        ParticleView {
            number: 0,
            mass: 1.0,
            volume: 1.0,
            position,
            velocity: [0.0; 3],
            stress: [stress, 0.0, 0.0, 0.0, 0.0, 0.0],
        }
    }

    #[test]
    fn only_loaded_material_near_the_line_counts() {
        let front = front(None);
        assert!((way(&front, &particle([2.2, 1.6, 0.0], -1.5)).unwrap() - 2.0).abs() < 1e-15);
        assert_eq!(way(&front, &particle([2.2, 1.6, 0.0], -0.5)), None, "below the threshold");
        assert_eq!(way(&front, &particle([2.2, 1.6, 0.6], -1.5)), None, "off the line");
    }

    #[test]
    fn the_slope_of_points_on_a_line_is_exact_and_of_scattered_ones_has_an_error() {
        let line: Vec<[f64; 2]> = (0..9).map(|i| [f64::from(i), 3.0 - 2.0 * f64::from(i)]).collect();
        assert_eq!(slope(&line), Some((-2.0, 0.0)));
        // Residuals 1, -2, 1 about s = 1 + 0 t: variance 6 / (3 - 2), spread 2.
        let (flat, error) = slope(&[[0.0, 2.0], [1.0, -1.0], [2.0, 2.0]]).unwrap();
        assert!(flat.abs() < 1e-15 && (error - 3.0_f64.sqrt()).abs() < 1e-14);
        assert_eq!(slope(&line[..2]), None);
        assert_eq!(slope(&[[1.0, 0.0]; 4]), None);
    }

    #[test]
    fn a_front_that_stops_is_fitted_while_it_runs() {
        let track = |fit| Track {
            front: front(fit),
            bodies: Vec::new(),
            // 5 m/s until it has gone 10 m, then it stands.
            furthest: (0..100).map(|i| [0.05 * f64::from(i), (0.25 * f64::from(i)).min(10.0)]).collect(),
        };
        let speed = track(None).speed().unwrap();
        assert!((speed.speed - 5.0).abs() < 1e-12 && speed.error < 1e-12, "{speed:?}");
        assert_eq!((speed.start, speed.end, speed.samples), (1.0, 9.0, 33));
        let chosen = track(Some([2.0, 4.0])).speed().unwrap();
        assert_eq!((chosen.start_time, chosen.time, chosen.samples), (0.4, 0.8, 9));
        assert_eq!(track(Some([20.0, 40.0])).speed(), None);
    }
}
