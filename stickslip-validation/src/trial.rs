//! A scene under way, and what every run records.

use crate::failure::CaseFailure;
use crate::penetration::penetration;
use std::time::Instant;
use stickslip::door::{
    BodyState, ContactCursor, ContactPoint, ContactState, GridSnapshot, Ledger, LoadState, ParticleSnapshot,
    Simulation,
};
use stickslip::march::March;
use stickslip::scene::{Face, Scene};
use stickslip::{scene, step};

/// What every run records besides what its benchmark measures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunRecord {
    /// Largest energy gained from nowhere, over the largest energy that moved or was stored [-].
    pub energy_gain: f64,
    /// Energy gained, or if negative lost, until the end, over the same [-].
    pub energy_drift: f64,
    /// Largest change of momentum over the sum of the bodies' sqrt(2 mass * kinetic energy) [-]; `None` where something
    /// outside acts.
    pub momentum_drift: Option<f64>,
    /// Largest change of angular momentum over the same sum times the distance of the farthest
    /// particle from the origin [-]; `None` where something outside acts.
    pub angular_drift: Option<f64>,
    /// Deepest overlap of particles of two bodies [cells].
    pub penetration: f64,
    /// Start of the first step in which two bodies push each other [s].
    pub first_contact: Option<f64>,
    /// Steps taken.
    pub steps: u64,
    /// Particles times steps.
    pub particle_steps: f64,
    /// Wall time [s].
    pub wall_time: f64,
}

impl RunRecord {
    /// Takes in another run: the worst drifts, the earliest contact, the sum of the times.
    pub fn include(&mut self, other: &RunRecord) {
        let worse = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
        self.energy_gain = self.energy_gain.max(other.energy_gain);
        self.energy_drift = worse(self.energy_drift, other.energy_drift);
        self.momentum_drift = larger(self.momentum_drift, other.momentum_drift);
        self.angular_drift = larger(self.angular_drift, other.angular_drift);
        self.penetration = self.penetration.max(other.penetration);
        self.first_contact = match (self.first_contact, other.first_contact) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        self.steps += other.steps;
        self.particle_steps += other.particle_steps;
        self.wall_time += other.wall_time;
    }
}

fn larger(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.max(b)),
        (a, b) => a.or(b),
    }
}

/// A scene under way.
pub struct Trial {
    name: String,
    text: String,
    scene: Scene,
    simulation: Box<dyn Simulation>,
    cursor: ContactCursor,
    contacts: Vec<ContactState>,
    way: March,
    step: f64,
    begin: Instant,
    first: Ledger,
    /// Energy that drifts are held against [J].
    scale: f64,
    /// Nothing outside the bodies acts on them.
    isolated: bool,
    next_balance: f64,
    next_overlap: f64,
    record: RunRecord,
}

/// Looks at the ledger in a run.
const BALANCES: f64 = 200.0;
/// Looks for overlaps in a run.
const OVERLAPS: f64 = 40.0;

impl Trial {
    /// The simulation of a scene that runs until its own end.
    ///
    /// # Errors
    /// The scene is not one or cannot be simulated.
    pub fn start(name: impl Into<String>, text: impl Into<String>) -> Result<Self, CaseFailure> {
        let (name, text) = (name.into(), text.into());
        let scene = scene::parse(&name, &text, &[])?.scene;
        let simulation = step::build(&scene)?;
        let isolated = scene.gravity.is_none()
            && scene.bodies.iter().all(|body| !body.is_rigid())
            && scene.domain.iter().flat_map(|domain| domain.faces).flatten().all(|face| face == Face::Open);
        let first = simulation.ledger();
        let end = scene.time.end;
        let mut trial = Trial {
            name,
            text,
            scene,
            cursor: ContactCursor::default(),
            contacts: Vec::new(),
            way: March::to(end),
            step: 0.0,
            begin: Instant::now(),
            first,
            scale: 0.0,
            isolated,
            next_balance: 0.0,
            next_overlap: 0.0,
            record: RunRecord::default(),
            simulation,
        };
        trial.look(true);
        Ok(trial)
    }

    /// Takes a step; false, and no step, at the scene's end.
    ///
    /// # Errors
    /// The step's failure.
    pub fn advance(&mut self) -> Result<bool, CaseFailure> {
        let now = self.simulation.time();
        let Some(step) = self.way.step(&mut *self.simulation)? else {
            self.look(true);
            return Ok(false);
        };
        self.step = step;
        self.contacts = self.cursor.read(&*self.simulation);
        if self.record.first_contact.is_none()
            && self.contacts.iter().any(|contact| contact.mean.normal > 0.0)
        {
            self.record.first_contact = Some(now);
        }
        self.look(false);
        Ok(true)
    }

    /// Notes energy, momentum and overlap where they are due or at a border of the run.
    fn look(&mut self, border: bool) {
        let (time, end) = (self.simulation.time(), self.scene.time.end);
        if border || time >= self.next_balance {
            self.next_balance = time + end / BALANCES;
            self.balance();
        }
        if border || time >= self.next_overlap {
            self.next_overlap = time + end / OVERLAPS;
            let depth = penetration(&self.simulation.snapshot()) / self.scene.discretization.cell;
            self.record.penetration = self.record.penetration.max(depth);
        }
    }

    fn balance(&mut self) {
        let (now, first) = (self.simulation.ledger(), &self.first);
        let fallen = (now.potential - first.potential).abs();
        self.scale = self.scale.max(now.kinetic + now.strain).max(now.friction).max(now.plastic).max(fallen);
        if self.scale > 0.0 {
            self.record.energy_drift = (now.total - first.total) / self.scale;
            self.record.energy_gain = self.record.energy_gain.max(self.record.energy_drift);
        }
        if !self.isolated {
            return;
        }
        // A body that only spins has no momentum, but parts with momenta.
        let momenta: f64 =
            self.simulation.bodies().iter().map(|body| (2.0 * body.mass * body.kinetic).sqrt()).sum();
        if momenta > 0.0 {
            let change = |a: [f64; 3], b: [f64; 3]| norm(std::array::from_fn(|i| a[i] - b[i])) / momenta;
            let linear = change(now.momentum, first.momentum);
            let angular = change(now.angular_momentum, first.angular_momentum) / self.reach();
            self.record.momentum_drift = larger(self.record.momentum_drift, Some(linear));
            self.record.angular_drift = larger(self.record.angular_drift, Some(angular));
        }
    }

    /// Distance of the farthest particle from the origin [m].
    fn reach(&self) -> f64 {
        self.simulation.snapshot().position.into_iter().map(norm).fold(0.0, f64::max)
    }

    /// Simulated time [s].
    pub fn time(&self) -> f64 {
        self.simulation.time()
    }

    /// Length of the last step [s].
    pub fn step_length(&self) -> f64 {
        self.step
    }

    /// The scene as read.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Start of the first step in which two bodies pushed each other, so far [s].
    pub fn first_contact(&self) -> Option<f64> {
        self.record.first_contact
    }

    /// The bodies now, in the order of the scene.
    pub fn bodies(&self) -> Vec<BodyState> {
        self.simulation.bodies()
    }

    /// Whether dynamic relaxation has brought it to rest.
    pub fn is_at_rest(&self) -> bool {
        self.simulation.relaxation().is_some_and(|relaxation| relaxation.at_rest)
    }

    /// Energy and momentum now.
    pub fn ledger(&self) -> Ledger {
        self.simulation.ledger()
    }

    /// Energy and momentum at the start.
    pub fn first_ledger(&self) -> &Ledger {
        &self.first
    }

    /// Energy gained, or if negative lost, until the last look at it, over the largest that moved or was stored [-];
    /// after the last step that of the whole run.
    pub fn energy_drift(&self) -> f64 {
        self.record.energy_drift
    }

    /// What supports and loads did since the start.
    pub fn loads(&self) -> Vec<LoadState> {
        self.simulation.loads()
    }

    /// The particles now.
    pub fn snapshot(&self) -> ParticleSnapshot {
        self.simulation.snapshot()
    }

    /// The grid of the last step.
    pub fn grid(&self) -> GridSnapshot {
        self.simulation.grid_snapshot()
    }

    /// The points of bodies on grids of their own at which contact acted in the last step.
    pub fn contact_points(&self) -> Vec<ContactPoint> {
        self.simulation.contact_points()
    }

    /// What contact did in the last step.
    pub fn contacts(&self) -> &[ContactState] {
        &self.contacts
    }

    /// Force of body `a` on body `b` in the last step [N], `a` before `b` in the scene.
    pub fn force(&self, a: usize, b: usize) -> [f64; 3] {
        let contact = self.contacts.iter().find(|contact| (contact.body_a, contact.body_b) == (a, b));
        contact.map_or([0.0; 3], |contact| contact.mean.force)
    }

    /// Name, scene and record.
    pub(crate) fn finish(mut self) -> (String, String, RunRecord) {
        self.record.steps = self.simulation.steps();
        self.record.particle_steps = self.simulation.steps() as f64 * self.simulation.particles() as f64;
        self.record.wall_time = self.begin.elapsed().as_secs_f64();
        (self.name, self.text, self.record)
    }
}

fn norm(a: [f64; 3]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}
