//! During and after a run: what makes its results doubtful. One file a check, and the list of them.

mod crossing;
mod cutting;
mod energy;
mod leaving;
mod max_strain;
mod momentum;
mod negligible;
mod neighbours;
mod noise;
mod precision;
mod relaxation;
mod self_contact;
mod small_step;
mod speed;
mod spin;
mod strain;
mod tearing;

pub(super) use neighbours::bytes_of as bytes_of_neighbours;

use crate::door::{BodyState, Ledger, TracedParticle, View};
use crate::observe::{Memory, OutputError, RunWarning};
use crate::run::start::Remembered;
use crate::scene::{Body, Damping, HealthCheck, Interior, Response, Scene};
use cutting::StepCuttings;
use energy::{EnergyBalance, WeighingTimes};
use negligible::Negligible;
use neighbours::Neighbours;

/// Every check of a run that the scene does not ignore.
fn checks(scene: &Scene) -> Vec<Box<dyn Check>> {
    let all: [Box<dyn Check>; 14] = [
        Box::new(energy::EnergyCheck),
        Box::new(noise::NoiseCheck::default()),
        Box::new(momentum::MomentumCheck::default()),
        Box::new(spin::SpinCheck::default()),
        Box::new(strain::StrainCheck::default()),
        Box::new(tearing::TearingCheck::default()),
        Box::new(crossing::CrossingCheck),
        Box::new(speed::SpeedCheck),
        Box::new(small_step::SmallStepCheck),
        Box::new(max_strain::MaxStrainCheck),
        Box::new(precision::PrecisionCheck::default()),
        Box::new(relaxation::RelaxationCheck),
        Box::new(leaving::LeavingCheck::default()),
        Box::new(self_contact::SelfContactCheck::default()),
    ];
    all.into_iter().filter(|check| scene.health.response(check.kind()) != Response::Ignore).collect()
}

/// A check of a run.
trait Check {
    /// Which it is.
    fn kind(&self) -> HealthCheck;

    /// What to try in a run of this scene.
    fn advice(&self, scene: &Scene) -> &'static str;

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
    /// What is too little to be judged.
    negligible: &'a Negligible,
    /// Neighbours at the start, body by body; none in rigid bodies.
    neighbours: &'a [Neighbours],
    /// Their particles now, in the order of [`Neighbours::start`].
    particles: &'a [Vec<TracedParticle>],
    /// The longest step that is allowed now, and the first one [s].
    steps: [f64; 2],
}

impl CheckInputs<'_> {
    /// The bound that the scene sets to a check.
    fn bound(&self, check: HealthCheck) -> f64 {
        self.scene.health_bound(check)
    }

    /// Bodies that deform.
    fn free(&self) -> impl Iterator<Item = usize> {
        let free = |&i: &usize| !self.scene.bodies[i].is_rigid();
        (0..self.bodies.len()).filter(free)
    }

    /// Those of them that are computed on the common grid: what a grid does to particles, it does to these.
    fn on_grid(&self) -> impl Iterator<Item = usize> {
        on_grid(self.scene)
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

/// Bodies that deform on the common grid.
fn on_grid(scene: &Scene) -> impl Iterator<Item = usize> {
    let is_on_it = |&body: &usize| !scene.bodies[body].is_rigid() && scene.interior(body) == Interior::Grid;
    (0..scene.bodies.len()).filter(is_on_it)
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

/// Something wrong at one time, as the run itself finds it.
pub(super) struct Noted {
    /// Which check it belongs to.
    pub check: HealthCheck,
    /// What, by how much, and what to try.
    pub message: String,
    pub worst: f64,
    pub advice: String,
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
    /// The stable step at the start [s].
    first_step: f64,
    looks: u64,
    /// What was found, whatever the scene wants to be done about it.
    found: Vec<RunWarning>,
    lines: usize,
    /// What ends the run.
    stop: Option<RunWarning>,
    cuttings: StepCuttings,
    negligible: Negligible,
}

/// Looks in a run, at most.
const LOOKS: f64 = 200.0;
/// Steps between two looks, or two weighings of energies, at least: what these cost is then nothing beside the steps.
const STEPS: u64 = 200;
/// Lines in a run: beyond, the summary tells.
const MOST_LINES: usize = 6;

impl RunChecks {
    /// The verdict on a run that begins.
    pub(super) fn new(scene: &Scene, simulation: &dyn View) -> Self {
        RunChecks {
            checks: checks(scene),
            balance: EnergyBalance::default(),
            weighing: WeighingTimes::default(),
            neighbours: neighbours::of_bodies(scene, simulation),
            interval: scene.outputs.tables.max(scene.time.end / LOOKS),
            next_time: simulation.time(),
            next_step: simulation.steps(),
            first_step: simulation.stable_step(),
            looks: 0,
            found: Vec::new(),
            lines: 0,
            stop: None,
            cuttings: StepCuttings::of(scene),
            negligible: Negligible::of(scene),
        }
    }

    /// Keeps what is known of the run so far, or takes that up.
    pub(super) fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("balance", &mut self.balance)?;
        memory.keep("weighing", &mut self.weighing)?;
        memory.keep("next_time", &mut self.next_time)?;
        memory.keep("next_step", &mut self.next_step)?;
        memory.keep("first_step", &mut self.first_step)?;
        memory.keep("looks", &mut self.looks)?;
        memory.keep("warnings", &mut self.found)?;
        memory.keep("lines", &mut self.lines)?;
        self.cuttings.remember(memory)?;
        for (body, neighbours) in self.neighbours.iter_mut().enumerate() {
            memory.part(&format!("neighbours {body}"), |memory| neighbours.remember(memory))?;
        }
        self.lines = self.lines.min(MOST_LINES);
        self.checks
            .iter_mut()
            .try_for_each(|check| memory.part(check.kind().word(), |memory| check.remember(memory)))
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
                memory.part(check.kind().word(), |memory| check.carry(memory, &origins))
            };
            self.checks.iter_mut().try_for_each(carry)
        })
    }

    /// Whether what a run looks at is due after a step of this length [s], by steps of this part of the stable one.
    pub(super) fn is_due(&self, scene: &Scene, view: &dyn View, (step, part): (f64, f64)) -> bool {
        self.weighing.are_due(view.steps()) || self.checks_are_due(scene, view, (step, part))
    }

    fn checks_are_due(&self, scene: &Scene, view: &dyn View, (step, part): (f64, f64)) -> bool {
        // Where steps are that small simulated time hardly goes on, and the next look by it is far.
        let bound = scene.health_bound(HealthCheck::SmallStep) * self.first_step;
        let small = || step > 0.0 && step < bound && part * view.stable_step() < bound;
        view.steps() >= self.next_step && (view.time() >= self.next_time || small())
    }

    /// What is new, if it is time to look after a step of this length [s], where steps may be this part of the stable
    /// one.
    pub(super) fn look(
        &mut self,
        scene: &Scene,
        simulation: &dyn View,
        (step, part): (f64, f64),
    ) -> Vec<String> {
        if self.weighing.come(simulation.steps()) {
            let ledger = simulation.ledger();
            let least = self.negligible.energy(simulation, &ledger);
            self.balance.weigh(&ledger, least);
            self.cuttings.look(scene, simulation, &self.negligible);
        }
        if !self.checks_are_due(scene, simulation, (step, part)) {
            return Vec::new();
        }
        // At the times of tables, which sum up all particles anyway.
        self.next_time = ((simulation.time() / self.interval + EARLY).floor() + 1.0 - EARLY) * self.interval;
        self.next_step = simulation.steps() + STEPS;
        self.look_now(scene, simulation, part)
    }

    /// What is new at the end of the run.
    pub(super) fn conclude(&mut self, scene: &Scene, simulation: &dyn View, part: f64) -> Vec<String> {
        let looked = self.next_step == simulation.steps() + STEPS;
        if looked { Vec::new() } else { self.look_now(scene, simulation, part) }
    }

    fn look_now(&mut self, scene: &Scene, simulation: &dyn View, part: f64) -> Vec<String> {
        if self.checks.is_empty() {
            return Vec::new();
        }
        self.looks += 1;
        let (ledger, bodies) = (simulation.ledger(), simulation.bodies());
        self.balance.update(&ledger, self.negligible.energy(simulation, &ledger));
        let particles = neighbours::particles(&mut self.neighbours, simulation);
        let look = CheckInputs {
            scene,
            simulation,
            ledger: &ledger,
            balance: &self.balance,
            bodies: &bodies,
            negligible: &self.negligible,
            neighbours: &self.neighbours,
            particles: &particles,
            steps: [part * simulation.stable_step(), self.first_step],
        };
        let found: Vec<_> = (self.checks.iter_mut())
            .map(|check| (check.kind(), check.advice(scene), check.look(&look)))
            .collect();
        let mut lines = Vec::new();
        for (check, advice, found) in found {
            // A line a kind in a run, whichever bodies join in later.
            let told = self.found.iter().any(|warning| warning.kind == check.word());
            let mut new: Vec<(f64, String)> = Vec::new();
            for finding in found {
                let worst = finding.worst.abs();
                let line = self.take_note((scene, simulation), (check, advice), finding);
                new.extend(line.filter(|_| !told).map(|line| (worst, line)));
            }
            // Of many bodies the worst stands for all.
            let others = new.len().saturating_sub(1);
            let worst = new.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
            lines.extend(worst.map(|(_, line)| match others {
                0 => line,
                1 => format!("{line}; 1 more body likewise"),
                others => format!("{line}; {others} more bodies likewise"),
            }));
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

    /// Records what was found, and returns the line that tells of it if it is new.
    fn take_note(
        &mut self,
        (scene, view): (&Scene, &dyn View),
        (check, advice): (HealthCheck, &str),
        Finding { body, position, worst, message }: Finding,
    ) -> Option<String> {
        // A record holds finite numbers alone.
        let worst = if worst.is_finite() { worst } else { f64::MAX };
        let body = body.map(|body| scene.bodies[body].name.clone());
        let known = self.found.iter().position(|w| w.kind == check.word() && w.body == body);
        let place = known.unwrap_or_else(|| {
            self.found.push(RunWarning {
                kind: check.word().to_owned(),
                message: message.clone(),
                advice: advice.to_owned(),
                body,
                position,
                time: view.time(),
                count: 0,
                worst,
            });
            self.found.len() - 1
        });
        let warning = &mut self.found[place];
        warning.count += 1;
        if worst.abs() > warning.worst.abs() {
            (warning.message, warning.position, warning.worst) = (message, position, worst);
        }
        if scene.health.response(check) == Response::Stop && self.stop.is_none() {
            self.stop = Some(warning.clone());
            return None;
        }
        let told = known.is_none() && scene.health.response(check) != Response::Record;
        told.then(|| line(warning))
    }

    /// Records what the run itself found, and says what there is to say.
    pub(super) fn note(&mut self, scene: &Scene, view: &dyn View, noted: Noted) -> Option<String> {
        let Noted { check, message, worst, advice } = noted;
        if scene.health.response(check) == Response::Ignore {
            return None;
        }
        let finding = Finding { body: None, position: None, worst, message };
        self.take_note((scene, view), (check, &advice), finding)
    }

    /// Records something of which each is told: a checkpoint that could not be written or read, a probe without rows.
    pub(super) fn note_each(
        &mut self,
        (scene, view): (&Scene, &dyn View),
        (check, message, advice): (HealthCheck, String, &str),
    ) -> Option<String> {
        let noted = Noted { check, message: message.clone(), worst: 1.0, advice: advice.to_owned() };
        self.note(scene, view, noted);
        (scene.health.response(check) == Response::Warn).then_some(message)
    }

    /// Records a checkpoint that could not be written.
    pub(super) fn note_checkpoint(
        &mut self,
        told: (&Scene, &dyn View),
        error: &OutputError,
    ) -> Option<String> {
        let advice = "free some space; the next one is tried in its time";
        self.note_each(told, (HealthCheck::Checkpoint, format!("no checkpoint: {error}"), advice))
    }

    /// What ends the run, if something does.
    pub(super) fn stop(&self) -> Option<&RunWarning> {
        self.stop.as_ref()
    }

    /// Whether steps are to be shorter from now on; told once.
    pub(super) fn asks_to_cut(&mut self) -> bool {
        self.cuttings.ask()
    }

    /// How often the run was looked at.
    pub(super) fn looks(&self) -> u64 {
        self.looks
    }

    /// The largest energy that drifts are held against [J].
    pub(super) fn energy_scale(&self) -> f64 {
        self.balance.scale
    }

    /// What was wrong, in the order in which it was found: warnings, and what the scene wants to be recorded only.
    pub(super) fn found(&self, scene: &Scene) -> [Vec<RunWarning>; 2] {
        let recorded = |warning: &RunWarning| {
            let check = HealthCheck::ALL.into_iter().find(|check| check.word() == warning.kind);
            check.is_some_and(|check| scene.health.response(check) == Response::Record)
        };
        let (remarks, warnings) = self.found.iter().cloned().partition(recorded);
        [warnings, remarks]
    }
}

/// Part of the interval by which a look may come early, as tables may.
const EARLY: f64 = 1e-6;

/// A warning as it is printed.
pub(super) fn line(warning: &RunWarning) -> String {
    format!("{}; {}", warning.message, warning.advice)
}

/// A part of a whole, of which nothing is none [-]. What is no number stays none.
pub(super) fn share(part: f64, whole: f64) -> f64 {
    if part == 0.0 { 0.0 } else { part / whole }
}

/// Whether a share is beyond its bound; what is no number is.
fn exceeds(share: f64, bound: f64) -> bool {
    share.is_nan() || share > bound
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{BasisKind, Transfer, parse};

    const SCENE: &str = r#"
[space]
dimension = "plane-strain"
interior = "grid"
cell = 1
[time]
end = 1
[materials.rubber]
density = 1
neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 }
[[bodies]]
name = "block"
material = "rubber"
shape.box = { min = [0, 0], max = [1, 1] }
"#;

    #[test]
    fn what_is_no_number_exceeds_every_bound() {
        assert_eq!([share(0.0, 0.0), share(1.0, 4.0)], [0.0, 0.25]);
        assert!(share(f64::NAN, 1.0).is_nan() && share(1.0, f64::NAN).is_nan());
        let beyond = [0.1, 0.2, f64::NAN, share(1.0, 0.0)].map(|share| exceeds(share, 0.1));
        assert_eq!(beyond, [false, true, true, true]);
    }

    #[test]
    fn no_advice_names_what_the_scene_has_already() {
        let mut scene = parse("scene", SCENE, &[]).unwrap().scene;
        let bases = [(BasisKind::Gimp, "gimp"), (BasisKind::Cubic, "cubic"), (BasisKind::Spline, "spline")];
        let transfers = [(Transfer::Rflip, "rflip"), (Transfer::Apic, "apic"), (Transfer::Flip, "flip")];
        for (basis, word) in bases {
            for (transfer, transfer_word) in transfers {
                scene.discretization.basis = basis;
                scene.time.transfer = transfer;
                for check in checks(&scene).iter().filter(|check| check.kind() != HealthCheck::CellCrossing) {
                    let advice = check.advice(&scene);
                    let named = [word, transfer_word].map(|word| advice.contains(&format!("\"{word}\"")));
                    assert_eq!(named, [false; 2], "{word}, {transfer_word}: {advice}");
                }
            }
        }
    }
}
