//! During and after a run: what makes its results doubtful. One file a check, and the list of them.

mod crossing;
mod energy;
mod neighbours;
mod noise;
mod precision;
mod relaxation;
mod speed;
mod spin;
mod strain;
mod tearing;

use crate::door::{BodyState, Ledger, TracedParticle, View};
use crate::observe::{Memory, OutputError, RunWarning};
use crate::run::start::Remembered;
use crate::scene::{Body, Damping, Scene};
use energy::{EnergyBalance, WeighingTimes};
use neighbours::Neighbours;

/// Every check of a run.
fn checks() -> Vec<Box<dyn Check>> {
    vec![
        Box::new(energy::EnergyCheck),
        Box::new(noise::NoiseCheck),
        Box::new(spin::SpinCheck::default()),
        Box::new(strain::StrainCheck::default()),
        Box::new(tearing::TearingCheck::default()),
        Box::new(crossing::CrossingCheck),
        Box::new(speed::SpeedCheck),
        Box::new(precision::PrecisionCheck::default()),
        Box::new(relaxation::RelaxationCheck),
    ]
}

/// A check of a run.
trait Check {
    /// Its name in `run.json`.
    fn kind(&self) -> &'static str;

    /// What to try.
    fn advice(&self) -> &'static str;

    /// What is wrong now.
    fn look(&mut self, look: &CheckInputs) -> Vec<Finding>;

    /// Keeps what it knows of the run so far, or takes that up.
    fn remember(&mut self, _memory: &mut Memory) -> Result<(), OutputError> {
        Ok(())
    }

    /// Takes over what it knew of bodies in another run, from which they begin: of each body its place there.
    fn carry(&mut self, _memory: &mut Memory, _origins: &[Option<usize>]) -> Result<(), OutputError> {
        Ok(())
    }
}

/// What a check sees.
struct CheckInputs<'a> {
    scene: &'a Scene,
    simulation: &'a dyn View,
    /// Energy and momentum now.
    ledger: &'a Ledger,
    /// Energy since the start.
    balance: &'a EnergyBalance,
    /// The bodies now.
    bodies: &'a [BodyState],
    /// Neighbours at the start, body by body; none in rigid bodies.
    neighbours: &'a [Neighbours],
    /// Their particles now, in the order of [`Neighbours::start`].
    particles: &'a [Vec<TracedParticle>],
}

impl CheckInputs<'_> {
    /// Bodies that deform.
    fn free(&self) -> impl Iterator<Item = usize> {
        let free = |&i: &usize| !self.scene.bodies[i].is_rigid();
        (0..self.bodies.len()).filter(free)
    }

    /// Speed of the fastest wave in an undeformed body [m/s].
    fn wave_speed(&self, body: usize) -> f64 {
        let material = &self.scene.materials[self.scene.bodies[body].material];
        material.wave_speed(self.scene.dimension.thickness())
    }

    /// Stiffness against the fastest wave in an undeformed body [Pa].
    fn wave_modulus(&self, body: usize) -> f64 {
        let material = &self.scene.materials[self.scene.bodies[body].material];
        material.law.wave_modulus_at_rest(self.scene.dimension.thickness())
    }
}

/// Something wrong at one time.
struct Finding {
    /// The body, if it is one.
    body: Option<usize>,
    /// Where, if it has a place [m].
    position: Option<[f64; 3]>,
    /// By how much.
    worst: f64,
    /// What.
    message: String,
}

/// Looks at a run now and then, and remembers what was wrong.
pub(super) struct RunChecks {
    checks: Vec<Box<dyn Check>>,
    balance: EnergyBalance,
    weighing: WeighingTimes,
    neighbours: Vec<Neighbours>,
    interval: f64,
    next_time: f64,
    next_step: u64,
    warnings: Vec<RunWarning>,
    lines: usize,
}

/// Looks in a run, at most.
const LOOKS: f64 = 200.0;
/// Steps between two looks, or two weighings of energies, at least: what these cost is then nothing beside the steps.
const STEPS: u64 = 200;
/// Kind of the warning of checkpoints that could not be written.
const CHECKPOINT: &str = "checkpoint";
/// Lines in a run: beyond, the summary tells.
const MOST_LINES: usize = 6;

impl RunChecks {
    /// The verdict on a run that begins.
    pub(super) fn new(scene: &Scene, simulation: &dyn View) -> Self {
        RunChecks {
            checks: checks(),
            balance: EnergyBalance::default(),
            weighing: WeighingTimes::default(),
            neighbours: neighbours::of_bodies(scene, simulation),
            interval: scene.outputs.tables.max(scene.time.end / LOOKS),
            next_time: simulation.time(),
            next_step: simulation.steps(),
            warnings: Vec::new(),
            lines: 0,
        }
    }

    /// Keeps what is known of the run so far, or takes that up.
    pub(super) fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("balance", &mut self.balance)?;
        memory.keep("weighing", &mut self.weighing)?;
        memory.keep("next_time", &mut self.next_time)?;
        memory.keep("next_step", &mut self.next_step)?;
        memory.keep("warnings", &mut self.warnings)?;
        memory.keep("lines", &mut self.lines)?;
        self.lines = self.lines.min(MOST_LINES);
        self.checks
            .iter_mut()
            .try_for_each(|check| memory.part(check.kind(), |memory| check.remember(memory)))
    }

    /// Takes over what another run remembered of bodies that begin as it left them; `names` are those of its bodies.
    pub(super) fn carry(
        &mut self,
        scene: &Scene,
        (memory, names): &mut Remembered,
    ) -> Result<(), OutputError> {
        let there = |body: &Body| names.iter().position(|name| *name == body.name);
        let origins: Vec<Option<usize>> = scene.bodies.iter().map(there).collect();
        memory.part("verdict", |memory| {
            let carry = |check: &mut Box<dyn Check>| {
                memory.part(check.kind(), |memory| check.carry(memory, &origins))
            };
            self.checks.iter_mut().try_for_each(carry)
        })
    }

    /// What is new, if it is time to look.
    pub(super) fn look(&mut self, scene: &Scene, simulation: &dyn View) -> Vec<String> {
        if self.weighing.come(simulation.steps()) {
            self.balance.weigh(&simulation.ledger());
        }
        if simulation.time() < self.next_time || simulation.steps() < self.next_step {
            return Vec::new();
        }
        // At the times of tables, which sum up all particles anyway.
        self.next_time = ((simulation.time() / self.interval + EARLY).floor() + 1.0 - EARLY) * self.interval;
        self.next_step = simulation.steps() + STEPS;
        self.look_now(scene, simulation)
    }

    /// What is new at the end of the run.
    pub(super) fn conclude(&mut self, scene: &Scene, simulation: &dyn View) -> Vec<String> {
        let looked = self.next_step == simulation.steps() + STEPS;
        if looked { Vec::new() } else { self.look_now(scene, simulation) }
    }

    fn look_now(&mut self, scene: &Scene, simulation: &dyn View) -> Vec<String> {
        let (ledger, bodies) = (simulation.ledger(), simulation.bodies());
        self.balance.update(&ledger);
        let particles: Vec<_> = (self.neighbours.iter().enumerate())
            .map(|(body, neighbours)| neighbours.particles(simulation, body))
            .collect();
        let look = CheckInputs {
            scene,
            simulation,
            ledger: &ledger,
            balance: &self.balance,
            bodies: &bodies,
            neighbours: &self.neighbours,
            particles: &particles,
        };
        let mut lines = Vec::new();
        for check in &mut self.checks {
            let found = check.look(&look);
            let new = found.into_iter().filter_map(|finding| {
                let body = finding.body.map(|body| scene.bodies[body].name.clone());
                let known = self.warnings.iter_mut().find(|w| w.kind == check.kind() && w.body == body);
                if let Some(known) = known {
                    known.count += 1;
                    if finding.worst.abs() > known.worst.abs() {
                        known.message = finding.message;
                        known.position = finding.position;
                        known.worst = finding.worst;
                    }
                    return None;
                }
                self.warnings.push(RunWarning {
                    kind: check.kind().to_owned(),
                    message: finding.message,
                    advice: check.advice().to_owned(),
                    body,
                    position: finding.position,
                    time: simulation.time(),
                    count: 1,
                    worst: finding.worst,
                });
                self.warnings.last().map(line)
            });
            lines.extend(new);
        }
        lines.truncate(MOST_LINES - self.lines);
        self.lines += lines.len();
        if self.lines == MOST_LINES
            && let Some(line) = lines.last_mut()
        {
            *line += "; no more of this until the summary";
        }
        lines
    }

    /// Takes note of a checkpoint that could not be written, and says what there is to say.
    pub(super) fn note_checkpoint(&mut self, error: &OutputError, view: &dyn View) -> String {
        let message = format!("no checkpoint: {error}");
        match self.warnings.iter_mut().find(|warning| warning.kind == CHECKPOINT) {
            Some(known) => (known.count, known.message) = (known.count + 1, message.clone()),
            None => self.warnings.push(RunWarning {
                kind: CHECKPOINT.to_owned(),
                message: message.clone(),
                advice: "free some space; the next one is tried in its time".to_owned(),
                body: None,
                position: None,
                time: view.time(),
                count: 1,
                worst: 1.0,
            }),
        }
        message
    }

    /// The largest energy that drifts are held against [J].
    pub(super) fn energy_scale(&self) -> f64 {
        self.balance.scale
    }

    /// What was wrong, in the order in which it was found.
    pub(super) fn warnings(&self) -> &[RunWarning] {
        &self.warnings
    }
}

/// Part of the interval by which a look may come early, as tables may.
const EARLY: f64 = 1e-6;

/// A warning as it is printed.
pub(super) fn line(warning: &RunWarning) -> String {
    format!("{}; {}", warning.message, warning.advice)
}

/// Whether the scene wants forces of damping, or to be brought to rest.
fn asks_for_damping(scene: &Scene) -> bool {
    scene.damping != Damping::default() || scene.time.relax.is_some()
}

#[inline]
fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

#[inline]
fn norm(a: [f64; 3]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// `(0.1503, -2, 0)`: enough to find it in a picture.
fn place(position: [f64; 3]) -> String {
    let short = |x: f64| format!("{x:.3e}").parse().unwrap_or(x).to_string();
    format!("({}) m", position.map(short).join(", "))
}
