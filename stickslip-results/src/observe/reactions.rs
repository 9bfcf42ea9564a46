//! `reactions.csv`: what presses on the faces of the domain and on rigid bodies.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{Observer, REACTIONS};
use crate::door::{View, WallState};
use crate::scene::{FACES, Scene};
use serde::{Deserialize, Serialize};
use stickslip_scene::tensor::cross;

/// What presses on a face of the domain or on a rigid body, averaged from the row before to this one; the columns of
/// `reactions.csv`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReactionRow {
    /// Simulated time at which the average ends [s].
    pub time: f64,
    /// Name of the face or of the rigid body.
    pub reaction: String,
    /// Name of the body that presses on a face; empty of a rigid body, on which all press.
    pub body: String,
    /// Mean force on the face or rigid body since the row before [N].
    pub force: [f64; 3],
    /// Mean moment, of a face about its middle, of a rigid body about its position in `bodies.csv` [N m].
    pub moment: [f64; 3],
}

impl TableRow for ReactionRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, reaction, body, force: [fx, fy, fz], moment: [mx, my, mz] } = self;
        columns![time, reaction, body, fx, fy, fz, mx, my, mz]
    }
}

/// Sums at a time.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Known {
    time: f64,
    faces: Vec<WallState>,
    /// Of each rigid body, impulse and moment about the origin [N s, N m s], and where it was [m].
    rigid: Vec<[[f64; 3]; 3]>,
}

/// Writes `reactions.csv`.
pub(super) struct ReactionsObserver {
    bodies: Vec<String>,
    /// Faces by axis and side.
    faces: Vec<(usize, bool)>,
    /// Indices of rigid bodies.
    rigid: Vec<usize>,
    before: Known,
    schedule: Schedule,
    table: CsvTable<ReactionRow>,
}

impl ReactionsObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let wanted = &scene.outputs.measurements.reactions;
        let faces = (0..3).flat_map(|axis| [(axis, false), (axis, true)]);
        let is_wanted = |&(axis, upper): &(usize, bool)| {
            wanted.iter().any(|name| name == FACES[axis][usize::from(upper)])
        };
        let rigid = (0..scene.bodies.len())
            .filter(|&i| scene.bodies[i].is_rigid() && wanted.contains(&scene.bodies[i].name));
        Ok(ReactionsObserver {
            bodies: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            faces: faces.filter(is_wanted).collect(),
            rigid: rigid.collect(),
            before: Known::default(),
            schedule: Schedule::every(scene.outputs.tables),
            table: CsvTable::create(folder, REACTIONS, scene.outputs.measurements.unit())?,
        })
    }

    fn known(&self, view: &dyn View) -> Known {
        let mut rigid = vec![[[0.0; 3]; 3]; self.rigid.len()];
        let bodies = view.bodies();
        for (sum, &body) in rigid.iter_mut().zip(&self.rigid) {
            sum[2] = bodies[body].position;
        }
        for contact in view.contact_sums() {
            for (side, body) in contact.bodies.into_iter().enumerate() {
                let Ok(which) = self.rigid.binary_search(&body) else { continue };
                let sign = if side == 0 { -1.0 } else { 1.0 };
                let [impulse, turn, _] = &mut rigid[which];
                let add = |sum: &mut [f64; 3], more: [f64; 3]| {
                    sum.iter_mut().zip(more).for_each(|(x, more)| *x += sign * more);
                };
                add(impulse, contact.impulse);
                add(turn, contact.turn);
            }
        }
        Known { time: view.time(), faces: view.walls(), rigid }
    }
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

impl Observer for ReactionsObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let now = self.known(view);
        let before = std::mem::replace(&mut self.before, now.clone());
        let (time, elapsed) = (now.time, now.time - before.time);
        // The start has no time before it to average over.
        if elapsed > 0.0 {
            let mut rows = Vec::new();
            for &(axis, upper) in &self.faces {
                let of_face = |state: &&WallState| (state.axis, state.upper) == (axis, upper);
                for state in now.faces.iter().filter(of_face) {
                    let same = |other: &&WallState| other.body == state.body;
                    let earlier = before.faces.iter().filter(of_face).find(same);
                    let [impulse, moment] =
                        earlier.map_or([[0.0; 3]; 2], |other| [other.impulse, other.moment]);
                    rows.push(ReactionRow {
                        time,
                        reaction: FACES[axis][usize::from(upper)].to_string(),
                        body: self.bodies[state.body].clone(),
                        force: minus(state.impulse, impulse).map(|x| x / elapsed),
                        moment: minus(state.moment, moment).map(|x| x / elapsed),
                    });
                }
            }
            for (which, &body) in self.rigid.iter().enumerate() {
                let zero = [[0.0; 3]; 3];
                let [impulse, moment, place] = *before.rigid.get(which).unwrap_or(&zero);
                let impulse = minus(now.rigid[which][0], impulse);
                // It was half-way on the average.
                let middle = std::array::from_fn(|i| 0.5 * (place[i] + now.rigid[which][2][i]));
                let about = minus(minus(now.rigid[which][1], moment), cross(middle, impulse));
                rows.push(ReactionRow {
                    time,
                    reaction: self.bodies[body].clone(),
                    body: String::new(),
                    force: impulse.map(|x| x / elapsed),
                    moment: about.map(|x| x / elapsed),
                });
            }
            self.table.append(rows)?;
        }
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("before", &mut self.before)?;
        self.schedule.remember(memory)?;
        self.table.remember(memory)
    }
}
