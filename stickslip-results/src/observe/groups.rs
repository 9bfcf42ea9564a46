//! `groups.csv` and `group_contacts.csv`: sums over groups of bodies, and what groups do to each other.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{GROUP_CONTACTS, GROUPS, Observer};
use crate::door::{BodyState, ContactCursor, ContactState, View};
use crate::scene::Scene;
use std::collections::{BTreeMap, HashMap};

/// A group of bodies at one time, in SI units; the columns of `groups.csv`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroupRow {
    /// Simulated time [s].
    pub time: f64,
    /// Name of the group.
    pub group: String,
    /// How many bodies it has.
    pub bodies: usize,
    /// Their mass [kg].
    pub mass: f64,
    /// Their centre of mass; of bodies without mass the mean of their places [m].
    pub position: [f64; 3],
    /// Its velocity [m/s].
    pub velocity: [f64; 3],
    /// Their kinetic energy [J].
    pub kinetic: f64,
    /// Their strain energy [J].
    pub strain: f64,
}

/// Contact of two groups, or of the bodies of one, averaged from the row before to this one; the columns of
/// `group_contacts.csv`. Groups that exerted no force on each other in that time have no row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroupContactRow {
    /// Simulated time at which the average ends [s].
    pub time: f64,
    /// Name of the first group.
    pub group_a: String,
    /// Name of the second group; that of the first again for contacts within a group.
    pub group_b: String,
    /// Pairs of bodies that touched.
    pub contacts: usize,
    /// Force of the first group on the second; within a group, and between bodies that both groups share, it cancels
    /// [N].
    pub force: [f64; 3],
    /// Sum over pairs of the normal forces, positive when the bodies push each other apart [N].
    pub normal: f64,
    /// Sum over pairs of the tangential forces' magnitudes [N].
    pub tangential: f64,
    /// Work of friction, cohesion and viscosity [J].
    pub friction: f64,
}

impl TableRow for GroupRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, group, bodies, mass, position: [x, y, z], velocity: [vx, vy, vz], .. } = self;
        let Self { kinetic, strain, .. } = self;
        columns![time, group, bodies, mass, x, y, z, vx, vy, vz, kinetic, strain]
    }
}

impl TableRow for GroupContactRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, group_a, group_b, contacts, force: [fx, fy, fz], normal, tangential, friction } =
            self;
        columns![time, group_a, group_b, contacts, fx, fy, fz, normal, tangential, friction]
    }
}

/// Where `group_contacts.csv` is in what is remembered of groups.
pub(super) const PAIRS: &str = "contacts";

/// Writes `groups.csv` and `group_contacts.csv`.
pub(super) struct GroupsObserver {
    groups: Groups,
    cursor: ContactCursor,
    schedule: Schedule,
    sums: CsvTable<GroupRow>,
    contacts: CsvTable<GroupContactRow>,
}

/// Who belongs where.
struct Groups {
    names: Vec<String>,
    /// Of each group, its bodies.
    bodies: Vec<Vec<usize>>,
    /// Of each body, its groups, ascending.
    of_body: Vec<Vec<usize>>,
}

impl Groups {
    fn new(scene: &Scene) -> Self {
        let numbers: HashMap<&str, usize> =
            scene.bodies.iter().enumerate().map(|(i, body)| (body.name.as_str(), i)).collect();
        let groups = &scene.outputs.measurements.groups;
        let members = |names: &[String]| names.iter().map(|name| numbers[name.as_str()]).collect();
        let bodies: Vec<Vec<usize>> = groups.iter().map(|group| members(&group.bodies)).collect();
        let mut of_body = vec![Vec::new(); scene.bodies.len()];
        for (group, bodies) in bodies.iter().enumerate() {
            bodies.iter().for_each(|&body| of_body[body].push(group));
        }
        Groups { names: groups.iter().map(|group| group.name.clone()).collect(), bodies, of_body }
    }

    /// A row for each group.
    fn sums(&self, time: f64, states: &[BodyState]) -> Vec<GroupRow> {
        let row = |(name, bodies): (&String, &Vec<usize>)| {
            let each = || bodies.iter().map(|&body| &states[body]);
            let mass: f64 = each().map(|state| state.mass).sum();
            let weight = |state: &BodyState| match mass > 0.0 {
                true => state.mass / mass,
                false => 1.0 / bodies.len() as f64,
            };
            let mean = |of: fn(&BodyState) -> [f64; 3]| {
                std::array::from_fn(|k| each().map(|state| weight(state) * of(state)[k]).sum())
            };
            GroupRow {
                time,
                group: name.clone(),
                bodies: bodies.len(),
                mass,
                position: mean(|state| state.position),
                velocity: mean(|state| state.velocity),
                kinetic: each().map(|state| state.kinetic).sum(),
                strain: each().map(|state| state.strain).sum(),
            }
        };
        self.names.iter().zip(&self.bodies).map(row).collect()
    }

    /// A row for each pair of groups that touch, in their order.
    fn contacts(&self, time: f64, contacts: &[ContactState]) -> Vec<GroupContactRow> {
        let mut rows: BTreeMap<[usize; 2], GroupContactRow> = BTreeMap::new();
        for ContactState { body_a, body_b, mean, .. } in contacts {
            // Of each pair of groups, which way the force of the first on the second goes.
            let mut ways: BTreeMap<[usize; 2], f64> = BTreeMap::new();
            for &a in &self.of_body[*body_a] {
                for &b in &self.of_body[*body_b] {
                    let way = if a < b {
                        1.0
                    } else if a > b {
                        -1.0
                    } else {
                        0.0
                    };
                    *ways.entry([a.min(b), a.max(b)]).or_default() += way;
                }
            }
            for (pair, way) in ways {
                let row = rows.entry(pair).or_insert_with(|| {
                    let [group_a, group_b] = pair.map(|group| self.names[group].clone());
                    GroupContactRow { time, group_a, group_b, ..GroupContactRow::default() }
                });
                row.contacts += 1;
                (0..3).for_each(|k| row.force[k] += way * mean.force[k]);
                row.normal += mean.normal;
                row.tangential += mean.tangential;
                row.friction += mean.friction;
            }
        }
        rows.into_values().collect()
    }
}

impl GroupsObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let unit = scene.outputs.measurements.unit();
        Ok(GroupsObserver {
            groups: Groups::new(scene),
            cursor: ContactCursor::default(),
            schedule: Schedule::every(scene.outputs.tables),
            sums: CsvTable::create(folder, GROUPS, unit)?,
            contacts: CsvTable::create(folder, GROUP_CONTACTS, unit)?,
        })
    }
}

impl Observer for GroupsObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        self.sums.append(self.groups.sums(time, &view.bodies()))?;
        self.contacts.append(self.groups.contacts(time, &self.cursor.read(view)))?;
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.sums.finish()?;
        self.contacts.finish()
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("cursor", &mut self.cursor)?;
        self.schedule.remember(memory)?;
        self.sums.remember(memory)?;
        memory.part(PAIRS, |memory| self.contacts.remember(memory))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::door::ContactMean;

    #[test]
    fn forces_add_up_between_groups_and_cancel_within() {
        let names = ["even", "odd", "first two"].map(str::to_string).to_vec();
        let groups = Groups {
            names,
            bodies: vec![vec![0, 2], vec![1, 3], vec![0, 1]],
            of_body: vec![vec![0, 2], vec![1, 2], vec![0], vec![1]],
        };
        let contact = |body_a, body_b, fx: f64| ContactState {
            body_a,
            body_b,
            direction: [1.0, 0.0, 0.0],
            mean: ContactMean {
                force: [fx, 0.0, 0.0],
                normal: fx.abs(),
                tangential: 1.0,
                ..ContactMean::default()
            },
        };
        let rows = groups.contacts(0.5, &[contact(0, 1, 3.0), contact(1, 2, 5.0), contact(0, 2, 7.0)]);
        let told: Vec<_> = rows
            .iter()
            .map(|row| (&*row.group_a, &*row.group_b, row.contacts, row.force[0], row.normal))
            .collect();
        assert_eq!(
            told,
            [
                ("even", "even", 1, 0.0, 7.0),
                ("even", "odd", 2, 3.0 - 5.0, 8.0),
                // 0 on 1 is of the first on the second, 1 on 2 and 0 on 2 are of the second on the first.
                ("even", "first two", 3, 3.0 - 5.0 - 7.0, 15.0),
                ("odd", "first two", 1, -3.0, 3.0),
                ("first two", "first two", 1, 0.0, 3.0),
            ]
        );
    }
}
