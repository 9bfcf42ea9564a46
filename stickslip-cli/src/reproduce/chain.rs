//! What the studies of disks share: cases, times in transits, arrivals of the wave, the balance of momentum and energy.

use super::case::{PaperCase, PaperScene, TouchRule};
use super::momentum::momentum_error;
use crate::failure::Failure;
use stickslip::door::Ledger;
use stickslip::observe::{ArrivalRow, ContactRow, Frame, RecordedScene, Results};
use stickslip::polariscope::{self, ImageWindow, OpticalBench, Stage};

/// The paper's disks: touching at the start, one particle a cell; surfaces that follow the disks and one normal for
/// each pair, unless `more` says otherwise.
pub fn case(scene: PaperScene, rule: TouchRule, cells: usize, more: &[(&str, &str)]) -> PaperCase {
    let (label, cells) = (format!("{}-n{cells}", rule.word()), cells.to_string());
    let settings = [
        ("cells_per_diameter", cells.as_str()),
        ("particles_per_side", "1"),
        ("outputs.particles", "never"),
        // The report takes its own pictures, from snapshots at the times that it shows.
        ("outputs.fringes.interval", "1000 * transit"),
        ("outputs.fringes.field", "light"),
        ("outputs.samples", "step"),
    ];
    // Glued disks have no rule between them; that at the frame stays as it is.
    PaperCase::new(scene, &label, &[&settings[..], &rule.settings(), more].concat())
}

/// A chain of disks after its run.
pub struct Chain<'a> {
    results: &'a Results,
    scene: RecordedScene,
    /// Time in which a longitudinal wave crosses a disk [s].
    transit: f64,
}

/// A camera behind a polariscope, with the disks of a run before it.
pub struct PolariscopeCamera<'a> {
    results: &'a Results,
    transit: f64,
    bench: OpticalBench,
}

/// Width of a picture [pixels].
const WIDTH: usize = 720;

/// What went in and out of the disks until a time.
pub struct Balance {
    /// The time, in transits.
    pub time: f64,
    /// Energy in the disks and turned to heat, less the work of the striker, over that work [-].
    pub energy: f64,
    /// Momentum of the disks less the impulses of striker and frame, over these impulses [-].
    pub momentum: f64,
}

impl<'a> Chain<'a> {
    pub fn new(results: &'a Results) -> Option<Self> {
        let scene = results.scene().ok()?;
        let transit = scene.outputs.measurements.time_unit.as_ref()?.seconds;
        Some(Chain { results, scene, transit })
    }

    /// When the wave came to the centre of each disk, counted from the striker, in transits.
    ///
    /// # Errors
    /// The table cannot be read.
    pub fn arrivals(&self) -> Result<Vec<Option<f64>>, Failure> {
        let rows = self.results.arrivals_table().map_err(Failure::input)?;
        let arrival = |disk: &&String| {
            let of_disk = |row: &&ArrivalRow| row.place == **disk && row.quantity == "stress_difference";
            rows.iter().find(of_disk).map(|row| row.time / self.transit)
        };
        Ok(self.disks().iter().map(arrival).collect())
    }

    /// When the centre of mass of each disk, counted from the striker,
    /// first moved with a part of the striker's speed, in transits.
    ///
    /// # Errors
    /// The table cannot be read.
    pub fn set_off(&self, part: f64) -> Result<Vec<Option<f64>>, Failure> {
        let speed = part * self.scene.number("speed");
        let rows = self.results.bodies_table().map_err(Failure::input)?;
        let first = |disk: &&String| {
            let states = rows.iter().filter(|row| row.body == **disk);
            let states: Vec<[f64; 2]> =
                states.map(|row| [row.time, row.state.velocity[0].hypot(row.state.velocity[1])]).collect();
            let passed = states.windows(2).find(|pair| pair[1][1] >= speed)?;
            let [[t0, v0], [t1, v1]] = [passed[0], passed[1]];
            Some((t0 + (speed - v0) / (v1 - v0) * (t1 - t0)) / self.transit)
        };
        Ok(self.disks().iter().map(first).collect())
    }

    /// When two bodies, named in any order, first pressed on each other with a part of the striker's first force, rho
    /// c_L V times a disk's radius, in transits.
    ///
    /// # Errors
    /// The table cannot be read.
    pub fn pressed(&self, pair: [&str; 2], part: f64) -> Result<Option<f64>, Failure> {
        let value = |name: &str| self.scene.number(name);
        let force = part * value("density") * value("c_L") * value("speed") * 0.5 * value("diameter");
        let rows = self.results.contacts_table().map_err(Failure::input)?;
        let of_pair =
            |row: &&ContactRow| [&row.body_a, &row.body_b] == pair || [&row.body_b, &row.body_a] == pair;
        Ok(rows
            .iter()
            .filter(of_pair)
            .find(|row| row.mean.normal >= force)
            .map(|row| row.time / self.transit))
    }

    /// Names of the bodies of the frame but for the striker.
    pub fn walls(&self) -> Vec<&str> {
        let names = self.results.body_names().iter().map(String::as_str);
        names.filter(|name| !name.starts_with("disk") && *name != "striker").collect()
    }

    /// Names of the disks, from the striker on.
    fn disks(&self) -> Vec<&String> {
        self.results.body_names().iter().filter(|name| name.starts_with("disk")).collect()
    }

    /// Speed of the fringes from the second disk's centre to the last one's over that of longitudinal waves [-]; `None`
    /// if they have not come to all.
    ///
    /// # Errors
    /// The table cannot be read.
    pub fn fringe_speed(&self) -> Result<Option<f64>, Failure> {
        let Some(arrivals) = self.arrivals()?.into_iter().collect::<Option<Vec<f64>>>() else {
            return Ok(None);
        };
        let [_, second, .., last] = &arrivals[..] else { return Ok(None) };
        Ok(Some((arrivals.len() - 2) as f64 / (last - second)))
    }

    /// How far the fringes have come from the striker until each sample: time in transits, distance in diameters.
    ///
    /// # Errors
    /// The table cannot be read.
    pub fn front(&self) -> Result<Vec<[f64; 2]>, Failure> {
        let diameter = self.scene.number("diameter");
        let rows = self.results.fronts_table().map_err(Failure::input)?;
        let mut furthest = 0.0_f64;
        let track = rows.iter().map(|row| {
            furthest = furthest.max(row.distance / diameter);
            [row.time / self.transit, furthest]
        });
        Ok(track.collect())
    }

    /// Energy from nowhere over the striker's work until then, at each row of the table: time in transits,
    /// and the share.
    ///
    /// # Errors
    /// The table cannot be read.
    pub fn energy_gain(&self) -> Result<Vec<[f64; 2]>, Failure> {
        let rows = self.results.energy_table().map_err(Failure::input)?;
        let worked = rows.iter().filter(|row| row.ledger.external_work != 0.0);
        Ok(worked.map(|row| [row.time / self.transit, gain(&row.ledger)]).collect())
    }

    /// Takes pictures of the fringes.
    ///
    /// # Errors
    /// The first snapshot cannot be read.
    pub fn camera(&self) -> Result<Option<PolariscopeCamera<'a>>, Failure> {
        let fringes = self.scene.outputs.fringes.as_ref();
        let (Some(fringes), Some(first)) = (fringes, self.results.frames().first()) else { return Ok(None) };
        let bodies = self.results.body_names();
        let specimens: Vec<usize> =
            (0..bodies.len()).filter(|&body| fringes.bodies.contains(&bodies[body])).collect();
        let particles = self.results.particles(first).map_err(Failure::input)?;
        let Some(bounds) = polariscope::bounds(&particles, &specimens) else { return Ok(None) };
        let stage = Stage { window: ImageWindow::around(bounds, WIDTH), specimens };
        let bench = OpticalBench::new(&fringes.polariscope, stage);
        Ok(Some(PolariscopeCamera { results: self.results, transit: self.transit, bench }))
    }

    /// The balance of the disks at a time [s], or at the end of the run if that is earlier.
    ///
    /// # Errors
    /// A table cannot be read.
    pub fn balance(&self, time: f64) -> Result<Balance, Failure> {
        let until = time * (1.0 + 1e-9);
        let energy = self.results.energy_table().map_err(Failure::input)?;
        let Some(end) = energy.iter().rfind(|row| row.time <= until) else {
            return Ok(Balance { time: f64::NAN, energy: f64::NAN, momentum: f64::NAN });
        };
        Ok(Balance {
            time: end.time / self.transit,
            energy: gain(&end.ledger),
            momentum: momentum_error(self.results, time)?.unwrap_or(f64::NAN),
        })
    }
}

/// Energy from nowhere over the striker's work until then [-].
fn gain(ledger: &Ledger) -> f64 {
    ledger.total / ledger.external_work.abs()
}

impl PolariscopeCamera<'_> {
    /// The picture of the snapshot nearest to a time in transits, as PNG, and its time in transits.
    ///
    /// # Errors
    /// The snapshot cannot be read.
    pub fn picture(&self, time: f64) -> Result<(f64, Vec<u8>), Failure> {
        let off = |frame: &&Frame| (frame.time / self.transit - time).abs();
        let frames = self.results.frames().iter();
        let frame = frames.min_by(|a, b| off(a).total_cmp(&off(b))).expect("a camera has seen a snapshot");
        let particles = self.results.particles(frame).map_err(Failure::input)?;
        let mut png = Vec::new();
        let written = self.bench.photograph(&particles).write_png(&mut png);
        written.expect("a vector takes all bytes");
        Ok((frame.time / self.transit, png))
    }
}
