//! `fabric.csv`: stress and fabric of packings, from the forces between their bodies.
//!
//! ```text
//! sigma_ij = 1/V sum_p sum_c (x_c - x_p)_i f_j         Love (1927), Weber (1966): bodies p, contacts c on each
//! Z   = sum_p N_p / N                                  contacts of a body, the mean over all bodies
//! Z_m = (sum_p N_p - N_1) / (N - N_0 - N_1)            of those with two or more, Thornton (2000)
//! F_ij = mean over contacts of n_i n_j                 Satake (1982)
//! ```
//! V is a box of space, p the bodies whose centres are in it, N of them, N_0 and N_1 those with no contact and with
//! one; f is the force on p at the contact's centre, its mean since the row before. Two bodies that are both in the box
//! give one branch from centre to centre. The sum is the mean stress in V but for the weight and the inertia of the
//! bodies, and for bodies that the box cuts: it is exact of a box around a packing at rest.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{FABRIC, Observer};
use crate::door::{BodyState, ContactCursor, ContactState, View};
use crate::rigid::MassProperties;
use crate::scene::{FreeRigid, Scene};
use std::collections::{BTreeMap, HashMap};

/// A packing at one time, in SI units; the columns of `fabric.csv`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FabricRow {
    /// Simulated time [s].
    pub time: f64,
    /// Name of the packing.
    pub packing: String,
    /// How many of its bodies have their centres in its box.
    pub bodies: usize,
    /// What they fill of the box, undeformed [-].
    pub solid: f64,
    /// Pairs of bodies that touch, of which at least one is counted.
    pub contacts: usize,
    /// Contacts of a body, the mean over all [-].
    pub coordination: f64,
    /// The same without bodies of one contact or none [-].
    pub mechanical: f64,
    /// Mean stress xx, yy, zz, xy, yz, xz, tension positive [Pa].
    pub stress: [f64; 6],
    /// Mean over contacts of n n, whose trace is one: xx, yy, zz, xy, yz, xz [-].
    pub fabric: [f64; 6],
}

impl TableRow for FabricRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, packing, bodies, solid, contacts, coordination, mechanical, .. } = self;
        let Self { stress: [xx, yy, zz, xy, yz, xz], .. } = self;
        let Self { fabric: [fabric_xx, fabric_yy, fabric_zz, fabric_xy, fabric_yz, fabric_xz], .. } = self;
        columns![
            time,
            packing,
            bodies,
            solid,
            contacts,
            coordination,
            mechanical,
            xx,
            yy,
            zz,
            xy,
            yz,
            xz,
            fabric_xx,
            fabric_yy,
            fabric_zz,
            fabric_xy,
            fabric_yz,
            fabric_xz
        ]
    }
}

/// Rows and columns of a symmetric tensor's components.
const COMPONENTS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]];

/// Bodies of which stress and fabric are found.
struct Packing {
    name: String,
    bodies: Vec<usize>,
    within: [[f64; 3]; 2],
    /// Area of the box in the plane, volume in space.
    size: f64,
}

/// What must be known of bodies.
struct Bodies {
    /// Volume of those that do not deform, of the others their density, as the second.
    volumes: Vec<Result<f64, f64>>,
    /// Lengths after which the domain repeats itself, zero along others [m].
    periods: [f64; 3],
    axes: usize,
}

/// Writes `fabric.csv`.
pub(super) struct FabricObserver {
    packings: Vec<Packing>,
    bodies: Bodies,
    cursor: ContactCursor,
    schedule: Schedule,
    table: CsvTable<FabricRow>,
}

impl Bodies {
    fn new(scene: &Scene) -> Self {
        let volume = |body: &crate::scene::Body| {
            let density = scene.materials[body.material].density;
            let own = body.as_free_rigid().map(|_| MassProperties::of(scene, body, &FreeRigid::default()));
            // One whose shape has no mass to turn or move has no volume.
            own.map_or(Err(density), |own| Ok(own.map_or(0.0, |own| own.mass / density)))
        };
        Bodies {
            volumes: scene.bodies.iter().map(volume).collect(),
            periods: scene.domain.as_ref().map_or([0.0; 3], |domain| domain.periods()),
            axes: scene.dimension.axes(),
        }
    }

    fn volume(&self, body: usize, state: &BodyState) -> f64 {
        self.volumes[body].unwrap_or_else(|density| state.mass / density)
    }

    /// From one place to another, by the shortest way where the domain repeats itself [m].
    fn way(&self, from: [f64; 3], to: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| {
            let (way, period) = (to[k] - from[k], self.periods[k]);
            if period > 0.0 { way - period * (way / period).round() } else { way }
        })
    }
}

impl Packing {
    /// Whether a place is in the box, or an image of it.
    fn holds(&self, place: [f64; 3], bodies: &Bodies) -> bool {
        (0..bodies.axes).all(|k| {
            let ([min, max], period) = (self.within.map(|corner| corner[k]), bodies.periods[k]);
            let above = if period > 0.0 { (place[k] - min).rem_euclid(period) } else { place[k] - min };
            (0.0..=max - min).contains(&above)
        })
    }

    fn row(
        &self,
        (time, bodies): (f64, &Bodies),
        states: &[BodyState],
        contacts: &[ContactState],
    ) -> FabricRow {
        let inside = |body: &&usize| self.holds(states[**body].position, bodies);
        let mut numbers: BTreeMap<usize, usize> =
            self.bodies.iter().filter(inside).map(|&body| (body, 0)).collect();
        let (mut stress, mut fabric, mut touching, mut with_normal) = ([0.0; 6], [0.0; 6], 0, 0);
        for ContactState { body_a, body_b, direction, mean } in contacts {
            let mut counted = false;
            for (body, sign) in [(*body_a, -1.0), (*body_b, 1.0)] {
                let Some(number) = numbers.get_mut(&body) else { continue };
                *number += 1;
                counted = true;
                let arm = bodies.way(states[body].position, mean.position);
                for (sum, [i, j]) in stress.iter_mut().zip(COMPONENTS) {
                    let force = |k: usize| sign * mean.force[k];
                    *sum += 0.5 * (arm[i] * force(j) + arm[j] * force(i)) / self.size;
                }
            }
            if counted {
                touching += 1;
                if direction.iter().all(|n| n.is_finite()) {
                    with_normal += 1;
                    let products = COMPONENTS.map(|[i, j]| direction[i] * direction[j]);
                    fabric.iter_mut().zip(products).for_each(|(sum, product)| *sum += product);
                }
            }
        }
        let all: usize = numbers.values().sum();
        let with = |count: usize| numbers.values().filter(|&&number| number == count).count();
        let (none, one) = (with(0), with(1));
        let ratio = |above: usize, below: usize| if below > 0 { above as f64 / below as f64 } else { 0.0 };
        FabricRow {
            time,
            packing: self.name.clone(),
            bodies: numbers.len(),
            solid: numbers.keys().map(|&body| bodies.volume(body, &states[body])).sum::<f64>() / self.size,
            contacts: touching,
            coordination: ratio(all, numbers.len()),
            mechanical: ratio(all - one, numbers.len() - none - one),
            stress,
            fabric: fabric.map(|sum| if with_normal > 0 { sum / with_normal as f64 } else { 0.0 }),
        }
    }
}

impl FabricObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let numbers: HashMap<&str, usize> =
            scene.bodies.iter().enumerate().map(|(i, body)| (body.name.as_str(), i)).collect();
        let measurements = &scene.outputs.measurements;
        let packing = |asked: &crate::scene::Fabric| {
            let [min, max] = asked.within;
            Packing {
                name: asked.name.clone(),
                bodies: asked.bodies.iter().map(|name| numbers[name.as_str()]).collect(),
                within: asked.within,
                size: (0..scene.dimension.axes()).map(|k| max[k] - min[k]).product(),
            }
        };
        Ok(FabricObserver {
            packings: measurements.fabric.iter().map(packing).collect(),
            bodies: Bodies::new(scene),
            cursor: ContactCursor::default(),
            schedule: Schedule::every(scene.outputs.tables),
            table: CsvTable::create(folder, FABRIC, measurements.unit())?,
        })
    }
}

impl Observer for FabricObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        let contacts = self.cursor.read(view);
        // The start has no time before it in which forces were.
        if time > 0.0 {
            let states = view.bodies();
            let row = |packing: &Packing| packing.row((time, &self.bodies), &states, &contacts);
            self.table.append(self.packings.iter().map(row))?;
        }
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("cursor", &mut self.cursor)?;
        self.schedule.remember(memory)?;
        self.table.remember(memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::door::ContactMean;

    /// Four disks of radius 1 on a square in a box of side 4, each pushed by its neighbours and by two walls with 3 N/m:
    /// the walls bear 2 forces of 3 N/m on 4 m, so the stress is -1.5 Pa in both directions, without shear. A fifth disk
    /// outside of the box counts nowhere, nor does one of no contact but as a body.
    #[test]
    fn the_stress_of_a_square_of_disks_is_the_pressure_of_its_walls() {
        let (force, wall, outside) = (3.0, 4, 5);
        let places = [[1.0, 1.0], [3.0, 1.0], [1.0, 3.0], [3.0, 3.0]];
        let state = |[x, y]: [f64; 2]| BodyState {
            mass: 2.0 * std::f64::consts::PI,
            position: [x, y, 0.0],
            ..BodyState::default()
        };
        let mut states: Vec<BodyState> = places.map(state).to_vec();
        states.extend([BodyState::default(), state([9.0, 1.0])]);
        let contact = |body_a: usize, body_b: usize, place: [f64; 2], direction: [f64; 2]| ContactState {
            body_a,
            body_b,
            direction: [direction[0], direction[1], 0.0],
            mean: ContactMean {
                force: [force * direction[0], force * direction[1], 0.0],
                position: [place[0], place[1], 0.0],
                ..ContactMean::default()
            },
        };
        let mut contacts = vec![
            contact(0, 1, [2.0, 1.0], [1.0, 0.0]),
            contact(2, 3, [2.0, 3.0], [1.0, 0.0]),
            contact(0, 2, [1.0, 2.0], [0.0, 1.0]),
            contact(1, 3, [3.0, 2.0], [0.0, 1.0]),
            contact(wall, outside, [8.0, 1.0], [1.0, 0.0]),
        ];
        for (body, [x, y]) in places.into_iter().enumerate() {
            let (left, below) = (x < 2.0, y < 2.0);
            let side = |low: bool| if low { 0.0 } else { 4.0 };
            // From the disk to the wall.
            let way = |low: bool| if low { -1.0 } else { 1.0 };
            contacts.push(contact(body, wall, [side(left), y], [way(left), 0.0]));
            contacts.push(contact(body, wall, [x, side(below)], [0.0, way(below)]));
        }
        let packing = Packing {
            name: "all".into(),
            bodies: vec![0, 1, 2, 3, outside],
            within: [[0.0; 3], [4.0, 4.0, 0.0]],
            size: 16.0,
        };
        let bodies = Bodies { volumes: vec![Err(2.0); 6], periods: [0.0; 3], axes: 2 };
        let row = packing.row((1.0, &bodies), &states, &contacts);
        assert_eq!((row.bodies, row.contacts), (4, 12));
        assert!((row.solid - std::f64::consts::PI / 4.0).abs() < 1e-14);
        assert_eq!([row.coordination, row.mechanical], [4.0, 4.0]);
        for (found, expected) in row.stress.iter().zip([-1.5, -1.5, 0.0, 0.0, 0.0, 0.0]) {
            assert!((found - expected).abs() < 1e-14, "{:?}", row.stress);
        }
        assert_eq!(row.fabric, [0.5, 0.5, 0.0, 0.0, 0.0, 0.0]);
        // Without the contacts of the first two, one of them rattles, and one has a contact with the next.
        contacts.retain(|contact| contact.body_a != 0 && (contact.body_a, contact.body_b) != (1, wall));
        let row = packing.row((1.0, &bodies), &states, &contacts);
        // Of the four: 0, 1, 3 and 4 contacts.
        assert_eq!([row.coordination, row.mechanical], [8.0 / 4.0, 7.0 / 2.0]);
    }

    #[test]
    fn a_contact_through_a_periodic_face_has_the_short_arm() {
        let state = |x: f64| BodyState { mass: 1.0, position: [x, 0.5, 0.0], ..BodyState::default() };
        let states = [state(0.5), state(3.5)];
        let mean =
            ContactMean { force: [-2.0, 0.0, 0.0], position: [0.0, 0.5, 0.0], ..ContactMean::default() };
        let contact = ContactState { body_a: 0, body_b: 1, direction: [-1.0, 0.0, 0.0], mean };
        let packing = Packing {
            name: "row".into(),
            bodies: vec![0, 1],
            within: [[0.0; 3], [4.0, 1.0, 0.0]],
            size: 4.0,
        };
        let bodies = Bodies { volumes: vec![Err(1.0); 2], periods: [4.0, 0.0, 0.0], axes: 2 };
        let row = packing.row((1.0, &bodies), &states, &[contact]);
        // The branch is 1 m long: -2 N/m over 1 m2 in 4 m2.
        assert!((row.stress[0] + 2.0 * 1.0 / 4.0).abs() < 1e-14, "{:?}", row.stress);
    }
}
