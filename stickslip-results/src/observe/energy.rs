//! `energy.csv`: where the energy is and went, and the momentum of everything.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::schedule::Schedule;
use super::table::{CsvTable, TableRow};
use super::{ENERGY, Observer};
use crate::door::{Ledger, View};
use crate::scene::Scene;
use serde::{Deserialize, Serialize};

/// Energy and momentum of everything at one time; the columns of `energy.csv`. See [`Ledger`] for what each term is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyRow {
    /// Simulated time [s].
    pub time: f64,
    /// Kinetic energy [J].
    pub kinetic: f64,
    /// Strain energy [J].
    pub strain: f64,
    /// Potential energy in gravity [J].
    pub potential: f64,
    /// Work of prescribed motion since the start [J].
    pub external_work: f64,
    /// Dissipated by friction, cohesion and viscosity of contacts since the start [J].
    pub friction: f64,
    /// Taken by bonds of contacts that adhere since the start, where they give way [J].
    pub adhesion: f64,
    /// Dissipated by plastic flow since the start [J].
    pub plastic: f64,
    /// Dissipated by damping since the start [J].
    pub damping: f64,
    /// Sum that is constant in an exact solution [J].
    pub total: f64,
    /// Momentum, first component [kg m/s].
    pub px: f64,
    /// Momentum, second component [kg m/s].
    pub py: f64,
    /// Momentum, third component [kg m/s].
    pub pz: f64,
    /// Angular momentum about the origin, first component [kg m^2/s].
    pub lx: f64,
    /// Angular momentum about the origin, second component [kg m^2/s].
    pub ly: f64,
    /// Angular momentum about the origin, third component [kg m^2/s].
    pub lz: f64,
}

impl EnergyRow {
    /// The row of a ledger at a time [s].
    pub fn new(time: f64, ledger: &Ledger) -> Self {
        let Ledger {
            kinetic,
            strain,
            potential,
            external_work,
            friction,
            adhesion,
            plastic,
            damping,
            total,
            ..
        } = *ledger;
        let ([px, py, pz], [lx, ly, lz]) = (ledger.momentum, ledger.angular_momentum);
        EnergyRow {
            time,
            kinetic,
            strain,
            potential,
            external_work,
            friction,
            adhesion,
            plastic,
            damping,
            total,
            px,
            py,
            pz,
            lx,
            ly,
            lz,
        }
    }
}

impl TableRow for EnergyRow {
    fn time(&self) -> f64 {
        self.time
    }
}

/// Writes `energy.csv`.
pub(super) struct EnergyObserver {
    schedule: Schedule,
    table: CsvTable<EnergyRow>,
}

impl EnergyObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        Ok(EnergyObserver {
            schedule: Schedule::every(scene.outputs.tables),
            table: CsvTable::create(folder.join(ENERGY), scene.outputs.measurements.unit())?,
        })
    }
}

impl Observer for EnergyObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        self.table.append([EnergyRow::new(time, &view.ledger())])?;
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }
}
