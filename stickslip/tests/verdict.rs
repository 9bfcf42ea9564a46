//! A run that is wrong says so, and one that is sound does not.
//!
//! A puppet moves as it is told, so that each thing that can be wrong is wrong alone, whatever the engine can do.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use stickslip::column;
use stickslip::door::*;
use stickslip::march::MarchError;
use stickslip::observe::{Checkpoint, Manifest, Results, RunWarning, Status};
use stickslip::run::{self, Checkpointing, RunError, RunOptions};
use stickslip::scene::{self, Scene};

/// A block of 10 by 4 cells of 10 cm with four particles in each, about the origin.
const SCENE: &str = r#"
    space = { dimension = "plane-strain", interior = "grid", cell = 0.1, basis = "gimp" }
    time = { end = 1 }
    materials.gel = { density = 1000, neo_hookean = { bulk_modulus = 2e4, shear_modulus = 1e4 } }
    [[bodies]]
    name = "block"
    material = "gel"
    shape.box = { min = [-0.5, -0.2], max = [0.5, 0.2] }
"#;
const DENSITY: f64 = 1000.0;
const SPACING: f64 = 0.05;
const STEP: f64 = 1.0 / 1024.0;
/// Particles along x and along y.
const SIDES: [usize; 2] = [20, 8];
const PARTICLES: usize = SIDES[0] * SIDES[1];

/// Where a particle is before anything moves [m].
fn start(number: usize) -> [f64; 2] {
    let along = |i: usize, count: usize| SPACING * (i as f64 + 0.5 - 0.5 * count as f64);
    [along(number % SIDES[0], SIDES[0]), along(number / SIDES[0], SIDES[1])]
}

/// Where a particle is that was at a point, its velocity and its deformation gradient.
type BodyMotion = fn([f64; 2], f64) -> ([f64; 2], [f64; 2], [[f64; 2]; 2]);

/// A body that moves as it is told.
struct Puppet {
    motion: BodyMotion,
    /// Total and strain energy at a time [J].
    energy: fn(f64) -> [f64; 2],
    /// Momentum at a time [kg m/s].
    momentum: fn(f64) -> [f64; 3],
    /// The stable step at a time [s].
    stable: fn(f64) -> f64,
    /// What makes it so short.
    limit: Option<StepLimit>,
    /// Impulses of contact with a second body so far, and how many of them were reduced.
    pushes: [u64; 2],
    /// Bodies that all move so.
    crowd: usize,
    time: f64,
    steps: u64,
}

const REST: [[f64; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];

impl Puppet {
    fn new(motion: BodyMotion) -> Self {
        Puppet {
            motion,
            energy: |_| [0.0, 0.0],
            momentum: |_| [0.0; 3],
            stable: |_| STEP,
            limit: None,
            pushes: [0; 2],
            crowd: 1,
            time: 0.0,
            steps: 0,
        }
    }

    fn now(&self) -> impl Iterator<Item = TracedParticle> {
        (0..PARTICLES).map(|number| {
            let [x, y] = start(number);
            let (position, velocity, f) = (self.motion)([x, y], self.time);
            TracedParticle {
                number: number as u32,
                half_width: 0.5 * SPACING,
                half_side: 0.5 * SPACING,
                position: [position[0], position[1], 0.0],
                velocity: [velocity[0], velocity[1], 0.0],
                deformation: [[f[0][0], f[0][1], 0.0], [f[1][0], f[1][1], 0.0], [0.0, 0.0, 1.0]],
            }
        })
    }
}

impl View for Puppet {
    fn time(&self) -> f64 {
        self.time
    }

    fn steps(&self) -> u64 {
        self.steps
    }

    fn particles(&self) -> usize {
        PARTICLES
    }

    fn stable_step(&self) -> f64 {
        (self.stable)(self.time)
    }

    fn step_limit(&self) -> Option<StepLimit> {
        self.limit
    }

    fn bodies(&self) -> Vec<BodyState> {
        let particle = DENSITY * SPACING * SPACING;
        let mean = |of: fn(&TracedParticle) -> [f64; 3]| {
            let sum = self.now().fold([0.0; 3], |sum, p| [0, 1, 2].map(|i| sum[i] + of(&p)[i]));
            sum.map(|x| x / self.particles() as f64)
        };
        let moment = |p: TracedParticle| p.position[0] * p.velocity[1] - p.position[1] * p.velocity[0];
        let angular: f64 = self.now().map(moment).sum();
        let squares = self.now().flat_map(|p| p.velocity).map(|v| v * v).sum::<f64>();
        let state = BodyState {
            mass: particle * self.particles() as f64,
            position: mean(|p| p.position),
            velocity: mean(|p| p.velocity),
            spin: [0.0; 3],
            angular_momentum: [0.0, 0.0, particle * angular],
            kinetic: 0.5 * particle * squares,
            strain: (self.energy)(self.time)[1],
        };
        vec![state; self.crowd]
    }

    fn ledger(&self) -> Ledger {
        let [total, strain] = (self.energy)(self.time);
        let momentum = (self.momentum)(self.time);
        Ledger { kinetic: self.bodies()[0].kinetic, strain, total, momentum, ..Ledger::default() }
    }

    fn contact_sums(&self) -> Vec<ContactSum> {
        let [pushes, reduced] = self.pushes;
        if pushes == 0 {
            return Vec::new();
        }
        // The scene has one body, which here is both of a pair.
        vec![ContactSum { bodies: [0, 0], pushes, reduced, ..ContactSum::default() }]
    }

    fn patches(&self) -> Vec<ContactPatch> {
        Vec::new()
    }

    fn snapshot(&self) -> ParticleSnapshot {
        let mut snapshot = ParticleSnapshot { dimension: 2, ..ParticleSnapshot::default() };
        for particle in self.now() {
            snapshot.body.push(0);
            snapshot.number.push(particle.number);
            snapshot.position.push(particle.position);
            snapshot.velocity.push(particle.velocity);
            snapshot.mass.push(DENSITY * SPACING * SPACING);
            snapshot.volume.push(SPACING * SPACING);
            snapshot.stress.push([0.0; 6]);
            snapshot.deformation.push(std::array::from_fn(|i| particle.deformation[i / 3][i % 3]));
        }
        snapshot
    }

    /// The start and the deformation are all that is asked for.
    fn column(&self, _body: usize, name: &str) -> Result<ColumnRef<'_>, NoColumn> {
        let numbers: Vec<u32> = (0..PARTICLES as u32).collect();
        if name == "deformation" {
            let all: Vec<TracedParticle> = self.now().collect();
            let at = move |row: usize, component: usize| all[row].deformation[component / 3][component % 3];
            return Ok(ColumnRef::new(column::every(name), numbers, at));
        }
        assert_eq!(name, "start");
        let at = |row, component| if component < 2 { start(row)[component] } else { 0.0 };
        Ok(ColumnRef::new(column::every(name), numbers, at))
    }

    fn trace(&self, _body: usize, wanted: &[u32]) -> Vec<TracedParticle> {
        self.now().filter(|particle| wanted.contains(&particle.number)).collect()
    }

    fn grid_snapshot(&self) -> GridSnapshot {
        GridSnapshot::default()
    }

    fn timings(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }
}

impl Simulation for Puppet {
    fn step(&mut self, longest: f64) -> Result<f64, StepError> {
        let step = longest.min(self.stable_step());
        self.time += step;
        self.steps += 1;
        Ok(step)
    }
}

/// What a run of this scene notes while it runs, and what its record says in the end.
fn judge(text: &str, simulation: &mut dyn Simulation) -> (Vec<String>, Vec<RunWarning>) {
    let (notes, recorded, text) = summarized(text, simulation);
    let kinds: std::collections::BTreeSet<&str> = recorded.iter().map(|warning| &warning.kind[..]).collect();
    assert_eq!(text.matches("  warning    ").count(), kinds.len(), "a line a kind: {text}");
    (notes, recorded)
}

/// What was told during the run, what was recorded, and the summary.
fn summarized(text: &str, simulation: &mut dyn Simulation) -> (Vec<String>, Vec<RunWarning>, String) {
    let scene: Scene = scene::parse("puppet.toml", text, &[]).unwrap().scene;
    let out = tempfile::tempdir().unwrap();
    let stop = Arc::new(AtomicBool::new(false));
    let options = RunOptions { stop, threads: 1, ..RunOptions::new(out.path().join("results")) };
    let mut notes = Vec::new();
    let mut progress = |progress: &run::Progress| notes.extend(progress.notes.clone());
    let summary = run::run(&scene, simulation, &options, &mut progress).unwrap();
    let recorded = Results::open(&options.out).unwrap().manifest().warnings.clone();
    assert_eq!(summary.warnings, recorded);
    (notes, recorded, summary.to_string())
}

/// Kinds of what is wrong.
fn kinds(text: &str, mut puppet: Puppet) -> Vec<String> {
    judge(text, &mut puppet).1.into_iter().map(|warning| warning.kind).collect()
}

/// Turning at 1 rad/s, and flying.
fn turning([x, y]: [f64; 2], t: f64) -> ([f64; 2], [f64; 2], [[f64; 2]; 2]) {
    let (sin, cos) = t.sin_cos();
    let turned = [cos * x - sin * y, sin * x + cos * y];
    ([turned[0] + 2.0 * t, turned[1]], [2.0 - turned[1], turned[0]], [[cos, -sin], [sin, cos]])
}

#[test]
fn a_body_that_turns_flies_and_stretches_is_sound() {
    assert!(kinds(SCENE, Puppet::new(turning)).is_empty());
    let stretching: BodyMotion = |[x, y], t| {
        let stretch = 1.0 + 0.5 * t;
        ([stretch * x, y], [0.5 * x, 0.0], [[stretch, 0.0], [0.0, 1.0]])
    };
    assert!(kinds(SCENE, Puppet::new(stretching)).is_empty());
}

#[test]
fn energy_from_nowhere_is_found_at_its_time_and_at_its_worst() {
    let mut puppet = Puppet { energy: |t| [t * t, 1.0], ..Puppet::new(|x, _| (x, [0.0; 2], REST)) };
    let (notes, warnings) = judge(SCENE, &mut puppet);
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert_eq!((warning.kind.as_str(), &warning.body), ("energy", &None));
    assert!((warning.worst - 1.0).abs() < 1e-12, "{warning:?}");
    assert!(warning.time > 0.1_f64.sqrt() && warning.time < 0.1_f64.sqrt() + 201.0 * STEP, "{warning:?}");
    assert!(warning.count > 2 && warning.message.contains("+100.0 %"), "{warning:?}");
    assert_eq!(notes.len(), 1);
    assert!(notes[0].starts_with("energy comes from nowhere") && notes[0].ends_with(&warning.advice));
}

#[test]
fn the_scene_sets_how_far_energy_may_drift() {
    let puppet = || Puppet { energy: |t| [-0.3 * t, 1.0], ..Puppet::new(|x, _| (x, [0.0; 2], REST)) };
    assert_eq!(kinds(SCENE, puppet()), ["energy"]);
    assert!(kinds(&SCENE.replace("end = 1", "end = 1, energy_drift = 0.4"), puppet()).is_empty());
}

#[test]
fn a_check_that_stops_ends_the_run_with_all_records() {
    let out = tempfile::tempdir().unwrap();
    let stopping =
        SCENE.replace("[[bodies]]", "health = { energy = { then = \"stop\", bound = 0.3 } }\n[[bodies]]");
    let scene = scene::parse("puppet.toml", &stopping, &[]).unwrap().scene;
    let mut puppet = Puppet { energy: |t| [t * t, 1.0], ..Puppet::new(|x, _| (x, [0.0; 2], REST)) };
    let options = RunOptions { threads: 1, ..RunOptions::new(out.path()) };
    let error = run::run(&scene, &mut puppet, &options, &mut |_| {}).unwrap_err();
    let RunError::Unhealthy { warning, time } = &error else { panic!("{error}") };
    assert_eq!((warning.kind.as_str(), warning.count, *time), ("energy", 1, puppet.time));
    assert!(*time > 0.3_f64.sqrt() && *time < 0.3_f64.sqrt() + 201.0 * STEP, "{error}");
    assert!(error.to_string().contains("by health.energy: energy comes from nowhere"), "{error}");
    assert!(miette::Diagnostic::help(&error).unwrap().to_string().contains("try"));
    let manifest = Manifest::read(out.path()).unwrap();
    assert_eq!((manifest.status, manifest.error), (Status::Stopped, Some(error.to_string())));
    assert!(manifest.looks > 1 && manifest.warnings == [*warning.clone()], "{:?}", manifest.warnings);
    let results = Results::open(out.path()).unwrap();
    assert_eq!(results.energy_table().unwrap().last().unwrap().time, puppet.time);
    assert_eq!(results.frames().last().unwrap().time, puppet.time);
}

#[test]
fn a_run_that_a_check_stopped_goes_on_once_the_scene_lets_it() {
    let out = tempfile::tempdir().unwrap();
    let text = r#"
        space = { dimension = "plane-strain", interior = "grid", cell = "2 cm" }
        time = { end = "40 ms" }
        health = { speed = { then = "stop", bound = 1e-6 } }
        materials.gel = { density = 1000, neo_hookean = { young_modulus = "1 MPa", poisson_ratio = 0.3 } }
        [[bodies]]
        name = "left"
        material = "gel"
        shape.ball = { center = [0, 0], radius = "10 cm" }
        spin = 1
    "#;
    let make = |text: &str| scene::parse("disk.toml", text, &[]).unwrap().scene;
    let checkpoints = Checkpointing { at_end: true, ..Checkpointing::default() };
    let options = RunOptions { threads: 1, checkpoints, ..RunOptions::new(out.path()) };
    let stopping = make(text);
    let error = run::run(&stopping, &mut *stickslip::step::build(&stopping).unwrap(), &options, &mut |_| {});
    assert!(matches!(error, Err(RunError::Unhealthy { .. })), "{error:?}");
    assert_eq!(Checkpoint::list(out.path()).unwrap().len(), 1);
    let warning = make(&text.replace("stop", "warn"));
    let mut simulation = stickslip::step::build(&warning).unwrap();
    let summary = run::resume(&warning, &mut *simulation, &options, &mut |_| {}).unwrap();
    assert_eq!(summary.status, Status::Finished);
    assert!(summary.warnings[0].count > 1, "{:?}", summary.warnings);
}

#[test]
fn what_the_scene_ignores_is_not_looked_for() {
    let drifting = || Puppet { energy: |t| [-0.3 * t, 1.0], ..Puppet::new(|x, _| (x, [0.0; 2], REST)) };
    for health in ["energy = \"ignore\"", "default = \"ignore\"", "energy = { bound = 0.4 }"] {
        let text = SCENE.replace("[[bodies]]", &format!("health = {{ {health} }}\n[[bodies]]"));
        assert!(kinds(&text, drifting()).is_empty(), "{health}");
    }
    let text =
        SCENE.replace("[[bodies]]", "health = { default = \"ignore\", energy = \"warn\" }\n[[bodies]]");
    assert_eq!(kinds(&text, drifting()), ["energy"]);
}

#[test]
fn steps_are_cut_where_energy_drifts() {
    let cutting = SCENE.replace("[[bodies]]", "health = { energy = \"cut-step\" }\n[[bodies]]");
    let drifting = || Puppet { energy: |t| [0.5 * t, 1.0], ..Puppet::new(|x, _| (x, [0.0; 2], REST)) };
    let (mut whole, mut cut) = (drifting(), drifting());
    let kinds =
        |warnings: Vec<RunWarning>| warnings.into_iter().map(|warning| warning.kind).collect::<Vec<_>>();
    assert_eq!(kinds(judge(SCENE, &mut whole).1), ["energy"]);
    assert_eq!(kinds(judge(&cutting, &mut cut).1), ["energy"]);
    // From t = 0.2 s on, and again and again.
    assert!(whole.steps == 1024 && cut.steps > 4 * whole.steps, "{} {}", whole.steps, cut.steps);
    assert_eq!(cut.time, 1.0);
}

#[test]
fn steps_are_cut_where_momentum_drifts() {
    let cutting = SCENE.replace("[[bodies]]", "health = { momentum = \"cut-step\" }\n[[bodies]]");
    let drifting = || Puppet {
        momentum: |t| [400.0 + 40.0 * t, 0.0, 0.0],
        ..Puppet::new(|[x, y], t| ([x + t, y], [1.0, 0.0], REST))
    };
    let (mut whole, mut cut) = (drifting(), drifting());
    for (text, puppet) in [(SCENE, &mut whole), (&cutting[..], &mut cut)] {
        let (notes, warnings) = judge(text, puppet);
        assert_eq!((notes.len(), warnings.len(), warnings[0].kind.as_str()), (1, 1, "momentum"));
    }
    assert!(whole.steps == 1024 && cut.steps > 4 * whole.steps, "{} {}", whole.steps, cut.steps);
    let sound = || Puppet::new(|[x, y], t| ([x + t, y], [1.0, 0.0], REST));
    let mut sound = Puppet { momentum: |_| [400.0, 0.0, 0.0], ..sound() };
    assert!(judge(&cutting, &mut sound).1.is_empty() && sound.steps == 1024, "{}", sound.steps);
}

#[test]
fn momentum_that_nothing_from_outside_gives_is_found() {
    let pushed = |momentum| Puppet { momentum, ..Puppet::new(|[x, y], t| ([x + t, y], [1.0, 0.0], REST)) };
    let weight = DENSITY * 0.4 * 9.81;
    assert!((weight - 3924.0).abs() < 1e-9);
    // 400 kg at 1 m/s.
    assert!(kinds(SCENE, pushed(|_| [400.0, 0.0, 0.0])).is_empty());
    let (notes, warnings) = judge(SCENE, &mut pushed(|t| [400.0 + 40.0 * t, 0.0, 0.0]));
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert_eq!((warning.kind.as_str(), &warning.body, notes.len()), ("momentum", &None, 1));
    assert!((warning.worst - 0.1).abs() < 1e-3 && warning.time > 0.1, "{warning:?}");
    // Here it is the block that has more than it was given.
    let faster: BodyMotion = |[x, y], t| ([x + t + 0.05 * t * t, y], [1.0 + 0.1 * t, 0.0], REST);
    let momentum: fn(f64) -> [f64; 3] = |t| [400.0 + 40.0 * t, 0.0, 0.0];
    let warnings = judge(SCENE, &mut Puppet { momentum, ..Puppet::new(faster) }).1;
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert_eq!((warning.kind.as_str(), warning.body.as_deref()), ("momentum", Some("block")));
    let place = warning.position.expect("it is somewhere");
    assert!((place[0] - 1.05).abs() < 1e-9 && place[1].abs() < 1e-9, "{warning:?}");
    assert!(warning.message.contains("; most of it is `block`'s, at (1.05, "), "{warning:?}");
    // Weight explains it, and a mirror takes what it likes across itself.
    let falling = SCENE.replace("space =", "gravity = [0, -9.81]\nspace =");
    let fall: fn(f64) -> [f64; 3] = |t| [400.0, -3924.0 * t, 0.0];
    assert!(kinds(&falling, pushed(fall)).is_empty());
    assert_eq!(kinds(SCENE, pushed(fall)), ["momentum"]);
    let domain = "domain = { min = [-9, -9], max = [9, 9], y_min = \"symmetry\" }, cell";
    assert!(kinds(&SCENE.replace("cell", domain), pushed(fall)).is_empty());
}

#[test]
fn steps_that_shrink_without_end_are_found_though_time_hardly_goes_on() {
    let shrinking = SCENE.replace("end = 1", "end = 0.02");
    let stable: fn(f64) -> f64 = |t| if t < 0.01 { STEP } else { 1e-3 * STEP };
    let mut puppet = Puppet { stable, ..Puppet::new(|x, _| (x, [0.0; 2], REST)) };
    let (_, warnings) = judge(&shrinking, &mut puppet);
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert_eq!((warning.kind.as_str(), warning.worst), ("small-step", 1e3));
    // Seen within 200 of its steps, though the next row is far.
    assert!(warning.time < 0.0112 && warning.count > 10, "{warning:?}");
    // Named where it is known.
    for (particle, who) in [(Some(17), "particle 17 of `block`"), (None, "the rigid body `block`")] {
        let limit = Some(StepLimit { body: 0, particle, position: [0.25, -0.5, 0.0] });
        let mut puppet = Puppet { stable, limit, ..Puppet::new(|x, _| (x, [0.0; 2], REST)) };
        let (_, warnings) = judge(&shrinking, &mut puppet);
        let [warning] = &warnings[..] else { panic!("{warnings:?}") };
        assert_eq!((warning.body.as_deref(), warning.position), (Some("block"), Some([0.25, -0.5, 0.0])));
        assert!(
            warning.message.contains(who) && warning.message.contains("(0.25, -0.5, 0) m"),
            "{warning:?}"
        );
    }
    let steady = Puppet { stable: |t| STEP * (1.0 - 0.9 * t), ..Puppet::new(|x, _| (x, [0.0; 2], REST)) };
    assert!(kinds(SCENE, steady).is_empty());
}

#[test]
fn spin_that_goes_where_nothing_touches_is_found() {
    let slowing: BodyMotion = |x, t| {
        let (position, velocity, f) = turning(x, t);
        (position, [2.0 + (1.0 - 0.1 * t) * (velocity[0] - 2.0), (1.0 - 0.1 * t) * velocity[1]], f)
    };
    let warnings = judge(SCENE, &mut Puppet::new(slowing)).1;
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert_eq!((warning.kind.as_str(), warning.body.as_deref()), ("angular-momentum", Some("block")));
    assert!((warning.worst - 0.1).abs() < 1e-3, "{warning:?}");
    // A push that gravity does not explain is somebody's touch.
    let pushed: BodyMotion = |x, t| {
        let (position, velocity, f) = turning(x, t);
        (position, [2.0 + t + (1.0 - 0.1 * t) * (velocity[0] - 2.0), (1.0 - 0.1 * t) * velocity[1]], f)
    };
    assert!(kinds(SCENE, Puppet::new(pushed)).is_empty());
}

/// The push of one disk on the other has its reaction a period away: angular momentum of both is not conserved, and not
/// looked for. That of the same two without faces is, and momentum is with both.
#[test]
fn bodies_that_push_through_a_periodic_face_are_sound() {
    let kinds = |faces: &str, x: f64| {
        let text = format!(
            r#"
            [space]
            dimension = "plane-strain"
            interior = "grid"
            cell = 0.05
            [space.domain]
            min = [0, -1]
            max = [2.4, 1]
            {faces}
            [time]
            end = 0.5
            [materials.rubber]
            density = 1000
            neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }}
            [[bodies]]
            name = "left"
            material = "rubber"
            shape.ball = {{ center = [{x}, 0], radius = 0.3 }}
            velocity = [-2, 0]
            [[bodies]]
            name = "right"
            material = "rubber"
            shape.ball = {{ center = [{}, 0.3], radius = 0.3 }}
            "#,
            if faces.is_empty() { x - 0.6 } else { x + 1.8 }
        );
        let scene = scene::parse("disks.toml", &text, &[]).unwrap().scene;
        let simulation = &mut *stickslip::step::build(&scene).unwrap();
        let warnings = judge(&text, simulation).1;
        assert!(!simulation.contact_sums().is_empty(), "they touch");
        warnings.into_iter().map(|warning| warning.kind).collect::<Vec<_>>()
    };
    assert_eq!(kinds("", 1.5), [""; 0]);
    assert_eq!(kinds("x_min = \"periodic\"\nx_max = \"periodic\"", 0.4), [""; 0]);
}

#[test]
fn positions_that_leave_their_strain_behind_are_found() {
    let drifting: BodyMotion = |[x, y], t| {
        let stretch = 1.0 + 0.01 * t;
        ([stretch * x, y], [0.0; 2], [[1.0 + 0.006 * t, 0.0], [0.0, 1.0]])
    };
    let warnings = judge(SCENE, &mut Puppet::new(drifting)).1;
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert_eq!((warning.kind.as_str(), warning.body.as_deref()), ("strain", Some("block")));
    assert!(warning.position.is_some() && warning.worst > 0.5, "{warning:?}");
}

/// On the screen a line stands for all of them, with the worst; the record has each.
#[test]
fn of_many_bodies_with_the_same_trouble_the_worst_is_told() {
    let drifting: BodyMotion = |[x, y], t| {
        let stretch = 1.0 + 0.01 * t;
        ([stretch * x, y], [0.0; 2], [[1.0 + 0.006 * t, 0.0], [0.0, 1.0]])
    };
    let scene = SCENE.replace("name = \"block\"", "name = \"block {i + 1}\"\nrepeat.i = 17").replace(
        "min = [-0.5, -0.2], max = [0.5, 0.2]",
        "min = [\"3 * i - 0.5\", -0.2], max = [\"3 * i + 0.5\", 0.2]",
    );
    let mut puppet = Puppet { crowd: 17, ..Puppet::new(drifting) };
    let (notes, recorded, text) = summarized(&scene, &mut puppet);
    assert_eq!(recorded.iter().filter(|warning| warning.kind == "strain").count(), 17);
    let [told] = &notes[..] else { panic!("{notes:?}") };
    assert!(told.ends_with("; 16 more bodies likewise"), "{told}");
    let [line] = &text.lines().filter(|line| line.starts_with("  warning    ")).collect::<Vec<_>>()[..]
    else {
        panic!("{text}")
    };
    assert!(
        line.starts_with("  warning    strain: 17 bodies, all in run.json; the worst from t = "),
        "{line}"
    );
    assert!(line.contains("distances in `block "), "{line}");
}

#[test]
fn noise_of_single_particles_is_no_stretch() {
    let noisy: BodyMotion = |[x, y], t| {
        let scattered = |k: f64| 3e-5 * (1e4 * (x * k).sin() + 1e4 * (y * (k + 1.0)).cos()).sin() * t;
        ([x + scattered(3.0), y + scattered(5.0)], [0.0; 2], REST)
    };
    assert!(kinds(SCENE, Puppet::new(noisy)).is_empty());
}

#[test]
fn a_body_that_tears_is_found_where_it_does() {
    // The right half leaves; 0.15 m is the reach of gimp.
    let torn: BodyMotion = |[x, y], t| ([x + if x > 0.1 { 0.3 * t } else { 0.0 }, y], [0.0; 2], REST);
    let warnings = judge(SCENE, &mut Puppet::new(torn)).1;
    let tearing = warnings.iter().find(|warning| warning.kind == "tearing").expect("it tears");
    assert!(tearing.time > 0.3 && tearing.time < 0.6, "{tearing:?}");
    let place = tearing.position.unwrap();
    assert!((place[0] - 0.165).abs() < 0.02, "{tearing:?}");
    // Halves that slide along each other have others between them.
    let sliding: BodyMotion = |[x, y], t| ([x + if y > 0.0 { 0.4 * t } else { 0.0 }, y], [0.0; 2], REST);
    assert!(!kinds(SCENE, Puppet::new(sliding)).contains(&"tearing".to_owned()));
}

#[test]
fn linear_functions_are_named_where_stress_crosses_cells() {
    let flying: BodyMotion = |[x, y], t| ([x + 0.2 * t, y], [0.2, 0.0], REST);
    let linear = SCENE.replace("gimp", "linear");
    // 2 W / M V = 1e-5 with M = 33.3 kPa and V = 0.4 m^2
    let stressed = || Puppet { energy: |_| [0.0, 0.067], ..Puppet::new(flying) };
    let warnings = judge(&linear, &mut stressed()).1;
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert_eq!((warning.kind.as_str(), warning.body.as_deref()), ("cell-crossing", Some("block")));
    assert!(warning.position.is_some(), "{warning:?}");
    // Where it is strained most.
    let pressed: BodyMotion = |[x, y], t| {
        ([x + 0.2 * t, y], [0.2, 0.0], [[if x > 0.4 && y > 0.1 { 0.999 } else { 1.0 }, 0.0], [0.0, 1.0]])
    };
    let warnings = judge(&linear, &mut Puppet { energy: |_| [0.0, 0.067], ..Puppet::new(pressed) }).1;
    let place = warnings.iter().find(|warning| warning.kind == "cell-crossing").and_then(|it| it.position);
    assert!(place.is_some_and(|place| place[0] > 0.4 && place[1] > 0.1), "{warnings:?}");
    assert!(kinds(SCENE, stressed()).is_empty());
    assert!(kinds(&linear, Puppet::new(flying)).is_empty());
}

#[test]
fn a_part_that_moves_as_fast_as_waves_is_found() {
    // Waves: sqrt(33.3 kPa / 1000 kg/m^3) = 5.8 m/s
    let struck: BodyMotion = |x, _| (x, [if x[0] > 0.4 { 4.0 } else { 0.0 }, 0.0], REST);
    assert_eq!(kinds(SCENE, Puppet::new(struck)), ["speed"]);
    let whole: BodyMotion = |[x, y], t| ([x + 40.0 * t, y], [40.0, 0.0], REST);
    assert!(kinds(SCENE, Puppet::new(whole)).is_empty());
}

/// Of 40,000 particles a few thousand have neighbours that are watched; speed is that of all.
#[test]
fn one_fast_particle_is_found_whichever_it_is() {
    let text = r#"
        space = { dimension = "plane-strain", interior = "grid", cell = 0.01 }
        time.end = 1e-7
        health = { default = "ignore", speed = "warn" }
        materials.gel = { density = 1000, neo_hookean = { bulk_modulus = 2e4, shear_modulus = 1e4 } }
        [[bodies]]
        name = "still"
        material = "gel"
        shape.box = { min = [2, 0], max = [2.1, 0.1] }
        [[bodies]]
        name = "block"
        material = "gel"
        shape.box = { min = [0, 0], max = [1, 1] }
        [outputs]
        particles = "never"
    "#;
    let scene = scene::parse("block.toml", text, &[]).expect("a scene").scene;
    for number in [0, 7_919, 20_011, 31_337, 39_998] {
        let mut simulation = stickslip::step::build(&scene).expect("no problem");
        let column = simulation.column(1, "velocity").expect("all have one");
        let place = column.numbers().iter().position(|&it| it == number).expect("there are so many");
        let mut velocity = vec![0.0; 2 * column.len()];
        // Waves: 5.8 m/s
        velocity[2 * place] = -4.0;
        drop(column);
        simulation.write(1, "velocity", &velocity).expect("velocities can be written");
        let limit = simulation.step_limit().expect("it is the fastest");
        assert_eq!((limit.body, limit.particle), (1, Some(number)));
        let warnings = judge(text, &mut *simulation).1;
        let [warning] = &warnings[..] else { panic!("{number}: {warnings:?}") };
        assert_eq!((warning.kind.as_str(), warning.body.as_deref()), ("speed", Some("block")));
        let found = warning.position.expect("it is somewhere");
        assert!((0..3).all(|k| (found[k] - limit.position[k]).abs() < 1e-6), "{number}: {found:?} {limit:?}");
        assert!((warning.worst - 4.0 / (1e4_f64 / 300.0).sqrt()).abs() < 1e-2, "{warning:?}");
    }
}

/// The fastest point of a free rigid body counts, by its flight and by its turning, and none of a prescribed one.
#[test]
fn free_rigid_bodies_that_run_away_are_found() {
    // Waves in it: sqrt(33.3 kPa / 1000 kg/m^3) = 5.8 m/s
    let kinds = |rigid: &str| -> Vec<(String, Option<String>)> {
        let text = format!(
            r#"
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.05 }}
            time.end = 1e-3
            materials.gel = {{ density = 1000, neo_hookean = {{ bulk_modulus = 2e4, shear_modulus = 1e4 }} }}
            [[bodies]]
            name = "ball"
            material = "gel"
            shape.ball = {{ center = [0, 0], radius = 0.2 }}
            {rigid}
            [outputs]
            particles = "never"
            "#
        );
        let scene = scene::parse("ball.toml", &text, &[]).expect("a scene").scene;
        let warnings = judge(&text, &mut *stickslip::step::build(&scene).expect("no problem")).1;
        warnings.into_iter().map(|warning| (warning.kind, warning.body)).collect()
    };
    let speed = [("speed".to_owned(), Some("ball".to_owned()))];
    assert_eq!(kinds("rigid.free = {}\nvelocity = [4, 0]"), speed);
    assert_eq!(kinds("rigid.free = {}\nspin = 20"), speed);
    assert_eq!(kinds("rigid.free = {}\nvelocity = [2, 0]\nspin = 1"), []);
    assert_eq!(kinds("rigid.velocity = [4, 0]"), []);
}

/// What makes steps short is a particle, a rigid body that turns, or the scene alone.
#[test]
fn who_makes_steps_short_is_known() {
    let limit = |bodies: &str, time: &str| {
        let text = format!(
            r#"
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.05 }}
            time = {{ end = 1{time} }}
            materials.gel = {{ density = 1000, neo_hookean = {{ bulk_modulus = 2e4, shear_modulus = 1e4 }} }}
            {bodies}
            "#
        );
        let scene = scene::parse("bodies.toml", &text, &[]).expect("a scene").scene;
        stickslip::step::build(&scene).expect("no problem").step_limit()
    };
    let ball = |name: &str, x: f64, rest: &str| {
        format!(
            "[[bodies]]\nname = \"{name}\"\nmaterial = \"gel\"\nshape.ball = {{ center = [{x}, 0], radius = 0.2 }}\n\
             {rest}\n"
        )
    };
    let both = ball("slow", 0.0, "") + &ball("fast", 1.0, "velocity = [3, 0]");
    assert_eq!(limit(&both, "").map(|limit| (limit.body, limit.particle.is_some())), Some((1, true)));
    assert_eq!(limit(&both, ", max_step = 1e-6"), None);
    let turning = ball("slow", 0.0, "rigid.free = {}") + &ball("fast", 1.0, "rigid.free = {}\nspin = 1e6");
    let limit = limit(&turning, "").expect("it turns");
    assert_eq!((limit.body, limit.particle, limit.position), (1, None, [1.0, 0.0, 0.0]));
}

/// Two disks that touch by half a cell: the record has it once, by how wide they touched at most, though nothing is
/// doubted; the scene may doubt it.
#[test]
fn contact_that_the_grid_does_not_resolve_is_recorded() {
    let text = |health: &str| {
        format!(
            r#"
            space = {{ dimension = "plane-strain", interior = "grid", cell = "2 cm" }}
            time.end = "0.15 s"
            {health}
            materials.gel = {{ density = 1000, neo_hookean = {{ young_modulus = "1 MPa", poisson_ratio = 0.3 }} }}
            [[bodies]]
            name = "left"
            material = "gel"
            shape.ball = {{ center = [0, 0], radius = "10 cm" }}
            velocity = ["5 cm/s", 0]
            [[bodies]]
            name = "right"
            material = "gel"
            shape.ball = {{ center = ["20.1 cm", 0], radius = "10 cm" }}
            [outputs]
            particles = "never"
            tables = "1 ms"
            "#
        )
    };
    let run = |health: &str| {
        let out = tempfile::tempdir().expect("a folder");
        let scene = scene::parse("disks.toml", &text(health), &[]).expect("a scene").scene;
        let simulation = &mut *stickslip::step::build(&scene).expect("no problem");
        let options = RunOptions { threads: 1, ..RunOptions::new(out.path()) };
        let mut notes = Vec::new();
        let ended =
            run::run(&scene, simulation, &options, &mut |progress| notes.extend(progress.notes.clone()));
        let manifest = Manifest::read(out.path()).expect("a record");
        let told = notes.iter().filter(|note| note.starts_with("contact not resolved: ")).count();
        (ended, told, manifest)
    };
    let of = |found: &[RunWarning]| found.iter().map(|it| (it.kind.clone(), it.count)).collect::<Vec<_>>();
    let contact = [("contact".to_owned(), 1)];
    for health in ["", "health.contact = \"record\""] {
        let (ended, told, manifest) = run(health);
        let summary = ended.expect("it goes through").to_string();
        assert!(
            told == 0 && !summary.contains("  warning  ") && summary.contains("  contact    not resolved")
        );
        assert_eq!(
            (of(&manifest.warnings), &of(&manifest.remarks)[..]),
            (Vec::new(), &contact[..]),
            "{health}"
        );
        let remark = &manifest.remarks[0];
        assert!(remark.message.contains("left and right 0."), "{remark:?}");
        assert!(summary.contains(&format!("left and right {:.2} cells", remark.worst)), "{summary}");
        assert_eq!(remark.time, 0.15, "judged at the end");
    }
    let (ended, told, manifest) = run("health.contact = \"warn\"");
    let summary = ended.expect("it goes through");
    assert_eq!((told, &of(&manifest.warnings)[..], manifest.remarks.len()), (0, &contact[..], 0));
    assert!(summary.to_string().contains("  warning    from t = "), "{summary}");
    let (ended, told, manifest) = run("health.contact = \"ignore\"");
    assert!(ended.is_ok() && told == 0 && manifest.warnings.is_empty() && manifest.remarks.is_empty());
    let (ended, _, manifest) = run("health.contact = \"stop\"");
    let Err(RunError::Unhealthy { warning, time }) = ended else { panic!("{ended:?}") };
    assert_eq!((warning.kind.as_str(), warning.count, manifest.status), ("contact", 1, Status::Stopped));
    assert!(time < 0.149 && manifest.error.is_some_and(|error| error.contains("by health.contact: ")));
}

/// Bars of four cells end to end, the first of which strikes the second: faces that lie flat on each other touch as wide
/// as they are, and how round bodies touch says nothing of them.
#[test]
fn flat_faces_are_not_judged_as_round_ones() {
    let text = r#"
        space = { dimension = "plane-strain", interior = "grid", cell = 0.25 }
        time.end = 0.02
        health.contact = "warn"
        materials.gel = { density = 1000, neo_hookean = { young_modulus = "1 MPa", poisson_ratio = 0 } }
        [[bodies]]
        name = "striker"
        material = "gel"
        shape.box = { min = [-3, 0], max = [0, 1] }
        velocity = [0.1, 0]
        [[bodies]]
        name = "bar"
        material = "gel"
        shape.box = { min = [0, 0], max = [3, 1] }
    "#;
    let (_, _, summary) = of_scene(text);
    assert!(!summary.contains("  contact    "), "{summary}");
    // A face of one cell is no more than marginal, and the summary gives no figures of round contact.
    let (_, warnings, summary) = of_scene(&text.replace("max = [0, 1]", "max = [0, 0.3]"));
    assert!(warnings.is_empty() && summary.contains("  contact    marginal: "), "{summary}");
    assert!(summary.contains("a flat face so narrow bends and tips") && !summary.contains("rolling"));
}

/// What the engine makes of a scene: see [`summarized`].
fn of_scene(text: &str) -> (Vec<String>, Vec<RunWarning>, String) {
    let scene = scene::parse("scene.toml", text, &[]).expect("a scene").scene;
    summarized(text, &mut *stickslip::step::build(&scene).expect("no problem"))
}

/// A free rigid box that rests on a rigid floor, level or inclined, alone or with others on it, pulled by less than
/// friction holds: what moves is round-off, and nothing is doubted.
#[test]
fn bodies_at_rest_are_not_doubted_for_their_round_off() {
    let scene = |gravity: [f64; 2], boxes: usize, rest: &str| {
        let [x, y] = gravity;
        let boxes: String = (0..boxes)
            .map(|i| {
                format!(
                    "[[bodies]]\nname = \"box {i}\"\nmaterial = \"wood\"\nrigid.free = {{}}\n\
                     shape.box = {{ min = [-0.05, {}], max = [0.05, {}] }}\n",
                    0.1 * i as f64,
                    0.1 * (i + 1) as f64
                )
            })
            .collect();
        format!(
            r#"
            gravity = [{x}, {y}]
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.02 }}
            time.end = 0.2
            materials.wood = {{ density = 1000, hypoelastic = {{ young_modulus = 1e7, poisson_ratio = 0.3 }} }}
            contact = [{{ friction = 0.5 }}]
            {boxes}
            [[bodies]]
            name = "floor"
            material = "wood"
            shape.half_space = {{ point = [0, 0], normal = [0, 1] }}
            rigid = {{}}
            {rest}
            "#
        )
    };
    let pull = "loads = [{ body = \"box 0\", on = \"volume\", force = [40, 0] }]";
    let pulled = format!("{pull}\n{}", scene([0.0, -9.81], 1, ""));
    for text in [scene([0.0, -9.81], 1, ""), scene([3.0, -9.0], 1, ""), scene([0.0, -9.81], 3, ""), pulled] {
        let (notes, warnings, summary) = of_scene(&text);
        assert!(notes.is_empty() && warnings.is_empty(), "{notes:?} {warnings:?}\n{text}");
        let drift = summary.lines().find(|line| line.contains("  energy ")).expect("a line");
        let percent = drift.rsplit('(').next().and_then(|last| last.strip_suffix(" %)")).expect("a share");
        assert!(percent.parse::<f64>().expect("a number").abs() < 1.0, "{drift}");
    }
}

/// Energy that is no number ends the run: the record and the tables have what was before.
#[test]
fn a_value_that_is_no_number_ends_the_run() {
    let out = tempfile::tempdir().expect("a folder");
    let scene = scene::parse("puppet.toml", SCENE, &[]).expect("a scene").scene;
    let energy: fn(f64) -> [f64; 2] = |t| [if t > 0.5 { f64::NAN } else { 1.0 }, 1.0];
    let mut puppet = Puppet { energy, ..Puppet::new(|x, _| (x, [0.0; 2], REST)) };
    let options = RunOptions { threads: 1, ..RunOptions::new(out.path()) };
    let error = run::run(&scene, &mut puppet, &options, &mut |_| {}).expect_err("it cannot go on");
    assert!(
        error.to_string().starts_with("`total` of all bodies is not a finite number, t = 5.0"),
        "{error}"
    );
    let results = Results::open(out.path()).expect("results");
    let manifest = results.manifest();
    assert_eq!((manifest.status, manifest.error.as_ref()), (Status::Failed, Some(&error.to_string())));
    let rows = results.energy_table().expect("a table");
    assert!(rows.iter().all(|row| row.ledger.total == 1.0) && rows.last().expect("rows").time > 0.49);
}

/// A body that is cooled below the end of its size: 1 + alpha T = -1. The message names the particle and its place, and
/// the tables hold no row that is not finite.
#[test]
fn a_body_that_heat_leaves_no_size_ends_the_run() {
    let text = r#"
        space = { dimension = "plane-strain", interior = "grid", cell = 0.01 }
        time.end = 1e-3
        loads = [{ body = "a", temperature = -200000 }]
        materials.hot = { density = 1000, thermal_expansion = 1e-5, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }
        [[bodies]]
        name = "a"
        material = "hot"
        shape.box = { min = [0, 0], max = [0.1, 0.1] }
    "#;
    let out = tempfile::tempdir().expect("a folder");
    let scene = scene::parse("hot.toml", text, &[]).expect("a scene").scene;
    let mut simulation = stickslip::step::build(&scene).expect("no problem");
    let options = RunOptions { threads: 1, ..RunOptions::new(out.path()) };
    let error = run::run(&scene, &mut *simulation, &options, &mut |_| {}).expect_err("it cannot go on");
    let RunError::Step {
        error: MarchError::Step(StepError::Shrunk { body, number, position, time }),
        unsaved: None,
    } = &error
    else {
        panic!("{error}")
    };
    assert_eq!((body.as_str(), *number), ("a", 0));
    assert!(position.iter().all(|x| (-0.01..0.11).contains(x)) && *time < 1e-3, "{error}");
    for name in ["energy.csv", "loads.csv", "bodies.csv"] {
        let table = std::fs::read_to_string(out.path().join(name)).expect("a table");
        assert!(!table.contains("NaN") && !table.contains("inf"), "{name}: {table}");
    }
    Results::open(out.path()).expect("results").energy_table().expect("a table");
}

/// Any check can be told to do no more than record.
#[test]
fn what_the_scene_only_records_is_no_warning() {
    let out = tempfile::tempdir().expect("a folder");
    let text = SCENE.replace("[[bodies]]", "health.energy = \"record\"\n[[bodies]]");
    let scene = scene::parse("puppet.toml", &text, &[]).expect("a scene").scene;
    let mut puppet = Puppet { energy: |t| [t * t, 1.0], ..Puppet::new(|x, _| (x, [0.0; 2], REST)) };
    let options = RunOptions { threads: 1, ..RunOptions::new(out.path()) };
    let mut notes = 0;
    let mut progress = |progress: &run::Progress| notes += progress.notes.len();
    let summary = run::run(&scene, &mut puppet, &options, &mut progress).expect("it goes through");
    let manifest = Manifest::read(out.path()).expect("a record");
    assert!(notes == 0 && summary.warnings.is_empty() && manifest.warnings.is_empty());
    let [remark] = &manifest.remarks[..] else { panic!("{:?}", manifest.remarks) };
    assert!(remark.kind == "energy" && remark.count > 2, "{remark:?}");
}

/// The share of impulses that were reduced counts, where there are enough of them to say something; and the scene's
/// bound.
#[test]
fn impulses_that_are_reduced_too_often_are_found() {
    let touching = |pushes| Puppet { pushes, ..Puppet::new(turning) };
    let (notes, warnings) = judge(SCENE, &mut touching([100, 60]));
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert_eq!((warning.kind.as_str(), warning.body.as_deref()), ("max-strain", Some("block")));
    assert!((warning.worst - 0.6).abs() < 1e-12 && notes.len() == 1, "{warning:?}");
    assert!(warning.message.contains("60.0 % of the impulses"), "{warning:?}");
    assert!(kinds(SCENE, touching([100, 40])).is_empty());
    assert!(kinds(SCENE, touching([40, 40])).is_empty());
    let bound = |bound| {
        SCENE.replace("[[bodies]]", &format!("health = {{ max_strain = {{ bound = {bound} }} }}\n[[bodies]]"))
    };
    assert!(kinds(&bound(0.7), touching([100, 60])).is_empty());
    assert_eq!(kinds(&bound(0.3), touching([100, 40])), ["max-strain"]);
}

#[test]
fn steps_below_the_spacing_of_numbers_are_found() {
    // At 1e4 m, single precision has numbers every 1.2 mm; the body moves by 0.5 mm a step.
    let far: BodyMotion = |[x, y], t| ([1e4 + x + 0.5 * t, y], [0.5, 0.0], REST);
    let single = SCENE.replace("basis", "precision = \"single\", basis");
    let kind = |text: &str, motion| kinds(text, Puppet::new(motion));
    assert!(kind(&single, far).contains(&"precision".to_owned()));
    assert!(!kind(SCENE, far).contains(&"precision".to_owned()));
    let near: BodyMotion = |[x, y], t| ([x + 0.5 * t, y], [0.5, 0.0], REST);
    assert!(kind(&single, near).is_empty());
}

/// Their angular momentum about the middle of both is that of round-off.
#[test]
fn blocks_that_fly_side_by_side_are_sound() {
    let block = |name: &str, x: f64| {
        format!(
            "[[bodies]]\nname = {name:?}\nmaterial = \"gel\"\nvelocity = [1, 2]\n\
             shape.box = {{ min = [{x}, 0], max = [{}, 4] }}\n",
            x + 4.0
        )
    };
    let text = format!(
        "space = {{ dimension = \"plane-strain\", interior = \"grid\", cell = 0.1 }}\ntime = {{ end = 0.1 }}\n\
         materials.gel = {{ density = 1000, neo_hookean = {{ young_modulus = 1e4, poisson_ratio = 0.3 }} }}\n{}{}",
        block("one", 0.0),
        block("other", 10.0)
    );
    let scene = scene::parse("blocks", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    let (_, warnings) = judge(&text, &mut *stickslip::step::build(&scene).unwrap());
    assert!(warnings.is_empty(), "{warnings:?}");
}

#[test]
fn two_disks_that_collide_and_ring_are_sound() {
    let text = r#"
        space = { dimension = "plane-strain", interior = "grid", cell = "2 cm", basis = "gimp" }
        time = { end = "0.1 s" }
        materials.gel = { density = 1000, neo_hookean = { young_modulus = "1 MPa", poisson_ratio = 0.3 } }
        [[bodies]]
        name = "left"
        material = "gel"
        shape.ball = { center = [0, 0], radius = "10 cm" }
        velocity = ["0.3 m/s", 0]
        [[bodies]]
        name = "right"
        material = "gel"
        shape.ball = { center = ["20.5 cm", "2 cm"], radius = "10 cm" }
        velocity = ["-0.3 m/s", 0]
    "#;
    let scene = scene::parse("disks.toml", text, &[]).unwrap().scene;
    let mut simulation = stickslip::step::build(&scene).unwrap();
    let warnings = judge(text, &mut *simulation).1;
    assert!(warnings.is_empty(), "{warnings:?}");
}

/// A shaft of four cells across that is held at one end and twists to and fro by 0.2 rad: in ten swings noise takes
/// most of its energy, and the ledger closes. One that twists by 0.001 rad is sound.
#[test]
fn motion_that_becomes_noise_is_found() {
    let kinds = |spin: f64| -> Vec<String> {
        let text = format!(
            r#"
            [space]
            dimension = "3d"
            interior = "grid"
            cell = 0.005
            domain = {{ min = [-0.04, -0.04, 0], max = [0.04, 0.04, 0.12], z_min = "fixed" }}
            [time]
            end = 0.8
            [materials.gel]
            density = 1000
            neo_hookean = {{ young_modulus = 50e3, poisson_ratio = 0.3 }}
            [[bodies]]
            name = "shaft"
            material = "gel"
            shape.box = {{ min = [-0.01, -0.01, 0], max = [0.01, 0.01, 0.08] }}
            spin = [0, 0, {spin}]
            [outputs]
            particles = "never"
            "#
        );
        let scene = scene::parse("shaft.toml", &text, &[]).expect("a scene").scene;
        let mut simulation = stickslip::step::build(&scene).expect("no problem");
        judge(&text, &mut *simulation).1.into_iter().map(|warning| warning.kind).collect()
    };
    assert_eq!(kinds(10.0), ["noise"]);
    assert!(kinds(0.05).is_empty());
}

/// What free rigid bodies lose as they strike each other and the floor is booked as damping, and became no noise, nor
/// does a block beside them change that.
#[test]
fn impacts_of_rigid_bodies_are_no_noise() {
    let text = r#"
        gravity = [0, -9.81]
        space = { dimension = "plane-strain", interior = "grid", cell = 0.05 }
        time.end = 0.6
        [materials.gel]
        density = 1000
        neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
        [[bodies]]
        name = "floor"
        material = "gel"
        rigid = {}
        shape.half_space = { point = [0, 0], normal = [0, 1] }
        [[bodies]]
        name = "grain {i}"
        repeat.i = 3
        material = "gel"
        rigid.free = {}
        shape.ball = { center = [0.02, "0.5 + 0.25 * i"], radius = 0.1 }
        [[bodies]]
        name = "block"
        material = "gel"
        shape.box = { min = [1, 0.2], max = [1.2, 0.4] }
        [[contact]]
        friction = 0.3
        [outputs]
        particles = "never"
    "#;
    let scene = scene::parse("grains.toml", text, &[]).expect("a scene").scene;
    let mut simulation = stickslip::step::build(&scene).expect("no problem");
    let kinds: Vec<String> =
        judge(text, &mut *simulation).1.into_iter().map(|warning| warning.kind).collect();
    let Ledger { damping, impacts, .. } = simulation.ledger();
    assert!(impacts > 100.0 && (damping - impacts).abs() < 0.05 * impacts, "{damping} {impacts}");
    assert!(!kinds.contains(&"noise".to_string()), "{kinds:?}");
}

/// Two rings that meet exactly head on have no angular momentum but that of round-off, of which some may come and go.
#[test]
fn rings_that_meet_head_on_are_not_doubted() {
    let text = r#"
        space = { dimension = "plane-strain", interior = "grid", cell = "4 mm" }
        time.end = "40 ms"
        [materials.rubber]
        density = 1000
        neo_hookean = { young_modulus = "1 MPa", poisson_ratio = 0.3 }
        [[bodies]]
        name = "ring {i}"
        repeat.i = 2
        material = "rubber"
        shape.difference = [
            { ball = { center = ["(2 * i - 1) * 5 cm", 0], radius = "4 cm" } },
            { ball = { center = ["(2 * i - 1) * 5 cm", 0], radius = "2.8 cm" } },
        ]
        velocity = ["(1 - 2 * i) * 2 m/s", 0]
        [outputs]
        particles = "never"
    "#;
    let scene = scene::parse("rings.toml", text, &[]).expect("a scene").scene;
    let mut simulation = stickslip::step::build(&scene).expect("no problem");
    let kinds: Vec<String> =
        judge(text, &mut *simulation).1.into_iter().map(|warning| warning.kind).collect();
    assert!(!kinds.contains(&"angular-momentum".to_string()), "{kinds:?}");
}

/// Local damping is for bodies that come to rest: one that spins loses half of its spin in a third of a turn, and is
/// told. One that settles is not.
#[test]
fn local_damping_of_what_turns_is_told() {
    let found = |gravity: f64, body: &str| -> Vec<String> {
        let text = format!(
            r#"
            gravity = [0, -{gravity}]
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1, domain = {{ min = [-2, -1], max = [2, 1], y_min = "fixed" }} }}
            time = {{ end = 4, max_step = 2e-3 }}
            damping.local = 0.3
            [materials.gel]
            density = 1000
            neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }}
            [[bodies]]
            name = "body"
            material = "gel"
            {body}
            [outputs]
            particles = "never"
            "#
        );
        let scene = scene::parse("turns.toml", &text, &[]).expect("a scene").scene;
        let mut simulation = stickslip::step::build(&scene).expect("no problem");
        judge(&text, &mut *simulation).1.into_iter().map(|warning| warning.message).collect()
    };
    let spins = found(0.0, "shape.ball = { center = [0, 0], radius = 0.5 }\nspin = 1").concat();
    assert!(spins.contains("`body` moves on and on, and local damping slows it"), "{spins}");
    assert!(found(1.0, "shape.box = { min = [-0.5, -1], max = [0.5, -0.4] }").is_empty());
}

/// A body that moves as prescribed and begins at rest: its first step has no bound, and later ones have not shrunk.
#[test]
fn a_first_step_without_bound_is_no_measure() {
    let (_, warnings, summary) = of_scene(
        r#"
        space = { dimension = "plane-strain", cell = 0.01 }
        time.end = 3e-3
        materials.rubber = { density = 1000, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }
        [[bodies]]
        name = "a"
        material = "rubber"
        shape.box = { min = [0, 0], max = [0.1, 0.1] }
        rigid.velocity = ["1 m/s * sin(1000 * t)", 0]
        "#,
    );
    assert!(warnings.is_empty(), "{warnings:?} {summary}");
}

/// A blow of 20 us on a free rigid body: the work of the load is what the body gains, within a step or over many.
#[test]
fn the_work_of_a_load_on_a_free_rigid_body_is_what_it_gains() {
    for max_step in ["1 ms", "2 us"] {
        let text = format!(
            r#"
            space = {{ dimension = "plane-strain", cell = 0.01 }}
            time = {{ end = 3e-3, max_step = "{max_step}" }}
            materials.stone = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
            [[bodies]]
            name = "a"
            material = "stone"
            shape.box = {{ min = [0, 0], max = [0.1, 0.1] }}
            rigid.free = {{}}
            [[loads]]
            body = "a"
            force = [{{ table = [[0, 0], ["10 us", 1e5], ["20 us", 0]] }}, 0]
            "#
        );
        let scene = scene::parse("scene.toml", &text, &[]).expect("a scene").scene;
        let mut simulation = stickslip::step::build(&scene).expect("no problem");
        while simulation.time() < 3e-3 {
            simulation.step(f64::INFINITY).expect("it is sound");
        }
        let ledger = simulation.ledger();
        assert!((simulation.bodies()[0].velocity[0] - 0.1).abs() < 1e-12, "{:?}", simulation.bodies());
        assert!((ledger.external_work / ledger.kinetic - 1.0).abs() < 1e-9, "{ledger:?}");
    }
}
