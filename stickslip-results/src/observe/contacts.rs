//! `contacts.csv`: the forces between bodies that touch.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::schedule::Schedule;
use super::table::{CsvTable, TableRow};
use super::{CONTACTS, Observer};
use crate::door::{ContactCursor, View};
use crate::scene::Scene;
use serde::{Deserialize, Serialize};

/// Contact of one pair of bodies, averaged from the row before to this one; the columns of `contacts.csv`.
///
/// Pairs that exerted no force on each other in that time have no row.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactRow {
    /// Simulated time at which the average ends [s].
    pub time: f64,
    /// Name of the first body.
    pub body_a: String,
    /// Name of the second body.
    pub body_b: String,
    /// Mean force of the first on the second body, first component [N].
    pub fx: f64,
    /// Mean force of the first on the second body, second component [N].
    pub fy: f64,
    /// Mean force of the first on the second body, third component [N].
    pub fz: f64,
    /// Mean of the sum over nodes of the force along each node's normal, positive when the bodies push each other apart
    /// [N].
    pub normal: f64,
    /// Magnitude of the mean of the sum over nodes of the force across each node's normal: forces that oppose each
    /// other, at two nodes or at two times, cancel [N].
    pub tangential: f64,
    /// Grid nodes that passed a force in the last step in which the surfaces touched.
    pub nodes: usize,
    /// Centre of the forces over nodes and time, each by its magnitude; first component [m].
    pub x: f64,
    /// Centre of the forces, second component [m].
    pub y: f64,
    /// Centre of the forces, third component [m].
    pub z: f64,
    /// Area over which the bodies touched, averaged as the force is [m^2], in the plane length per depth [m].
    pub area: f64,
    /// Mean distance between the surfaces over area and time, negative where they overlap [m].
    pub gap: f64,
    /// How far the surfaces slipped on each other since the row before, the mean over their area [m].
    pub slip: f64,
    /// Work of friction, cohesion and viscosity since the row before [J].
    pub friction: f64,
}

impl TableRow for ContactRow {
    fn time(&self) -> f64 {
        self.time
    }
}

/// Writes `contacts.csv`; each row is the mean since the row before.
pub(super) struct ContactsObserver {
    names: Vec<String>,
    cursor: ContactCursor,
    schedule: Schedule,
    table: CsvTable<ContactRow>,
}

impl ContactsObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        Ok(ContactsObserver {
            names: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            cursor: ContactCursor::default(),
            schedule: Schedule::every(scene.outputs.tables),
            table: CsvTable::create(folder.join(CONTACTS), scene.outputs.measurements.unit())?,
        })
    }
}

impl Observer for ContactsObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        let contacts = self.cursor.read(view);
        self.table.append(contacts.into_iter().map(|contact| {
            let ([fx, fy, fz], [x, y, z]) = (contact.force, contact.position);
            ContactRow {
                time,
                body_a: self.names[contact.body_a].clone(),
                body_b: self.names[contact.body_b].clone(),
                fx,
                fy,
                fz,
                normal: contact.normal,
                tangential: contact.tangential,
                nodes: contact.nodes,
                x,
                y,
                z,
                area: contact.area,
                gap: contact.gap,
                slip: contact.slip,
                friction: contact.friction,
            }
        }))?;
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }
}
