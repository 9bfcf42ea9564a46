//! A law from outside the crate, with a history of its own.
//!
//! Set-up: a disk falls on a fixed floor and rebounds, in plane strain and plane stress and, as a ball, in space. Its
//! law is given as an object: the neo-Hookean law one particle at a time, which also counts its steps, sums their
//! duration and remembers the deformation gradient.
//!
//! Expected: particles move as those of the built-in law do, but for round-off (1e-9 of the cell); every particle has
//! counted every step, though particles are sorted anew, and remembers its own F,
//! so that a snapshot's column is the snapshot's deformation. The same law over arrays, which is asked between two passes,
//! gives the same motion for each way to update the stress, the same bits for any number of threads, and ends the step
//! if it has no answer.

use crate::trial::{largest_difference, take_steps};
use stickslip::column::Kind;
use stickslip::door::{Simulation, StepError};
use stickslip::material::{
    CustomLaw, History, Isotropic, Law, LawArrays, LawOverArrays, Material, Motion, NeoHookean,
};
use stickslip::outside::OutsideFault;
use stickslip::scene::{NamedMaterial, Scene, StressUpdate};
use stickslip::tensor::{Matrix, Symmetric};
use stickslip::{scene, step};

const ELASTIC: Isotropic<f64> = Isotropic { bulk_modulus: 6e5, shear_modulus: 3e5 };

const HISTORY: &[History] = &[
    History::new("count", "", Kind::Number),
    History::new("age", "s", Kind::Number),
    History { start: 1.0, ..History::new("remembered", "", Kind::Tensor) },
];

#[derive(Debug)]
struct Counting;

impl CustomLaw for Counting {
    fn name(&self) -> &'static str {
        "counting"
    }

    fn history(&self) -> &'static [History] {
        HISTORY
    }

    fn elastic(&self) -> Isotropic<f64> {
        ELASTIC
    }

    fn respond(&self, motion: &Motion<f64>, history: &mut [f64]) -> Symmetric<f64> {
        history[0] += 1.0;
        history[1] += motion.dt;
        history[2..].copy_from_slice(motion.deformation.0.as_flattened());
        NeoHookean { elastic: ELASTIC }.stress(motion)
    }

    fn strain_energy(&self, deformation: &Matrix<f64>, stress: &Symmetric<f64>, _: &[f64]) -> f64 {
        NeoHookean { elastic: ELASTIC }.strain_energy(deformation, stress, &[])
    }

    fn wave_modulus(&self, deformation: &Matrix<f64>, jacobian: f64, _: &[f64]) -> f64 {
        NeoHookean { elastic: ELASTIC }.wave_modulus(deformation, jacobian, &[])
    }

    fn shear_modulus(&self, deformation: &Matrix<f64>, jacobian: f64, _: &[f64]) -> f64 {
        NeoHookean { elastic: ELASTIC }.shear_modulus(deformation, jacobian, &[])
    }
}

fn scene_of(dimension: &str) -> Scene {
    let space = dimension == "3d";
    let v = |x: &str| if space { format!("[{x}, 0]") } else { format!("[{x}]") };
    let text = format!(
        r#"
        space = {{ dimension = "{dimension}", interior = "grid", cell = 0.1, domain = {{ min = {}, max = {}, y_min = "fixed" }} }}
        time.end = 1
        materials.rubber = {{ density = 1000, neo_hookean = {{ bulk_modulus = 6e5, shear_modulus = 3e5 }} }}
        [[bodies]]
        name = "disk"
        material = "rubber"
        shape.ball = {{ center = {}, radius = 0.35 }}
        velocity = {}
        "#,
        if space { "[-1, 0, -1]" } else { "[-1, 0]" },
        if space { "[1, 2, 1]" } else { "[1, 2]" },
        v("0, 0.45"),
        v("1, -4"),
    );
    scene::parse("trial.toml", &text, &[]).unwrap_or_else(|e| panic!("{e:?}")).scene
}

fn falling(dimension: &str, law: Option<&'static dyn CustomLaw>) -> Box<dyn Simulation> {
    let mut scene = scene_of(dimension);
    if let Some(law) = law {
        scene.materials[0].law = Material::custom(law);
    }
    step::build(&scene).unwrap_or_else(|problem| panic!("{problem:?}"))
}

#[test]
fn a_law_as_an_object_moves_particles_as_the_built_in_one_and_remembers() {
    for dimension in ["plane-strain", "plane-stress", "3d"] {
        let (mut exact, mut found) = (falling(dimension, None), falling(dimension, Some(&Counting)));
        take_steps(&mut *exact, 150);
        take_steps(&mut *found, 150);
        let (exact, now) = (exact.snapshot(), found.snapshot());
        let off = largest_difference(&now.position, &exact.position);
        println!("{dimension}: positions differ by {off:.1e} m");
        assert!(off < 1e-10, "{dimension}: {off:.1e}");
        let of = |name: &str| now.remembered(name).unwrap_or_else(|| panic!("no {name}"));
        assert!(of("count").values.iter().all(|&count| count == 150.0), "{dimension}");
        let age = of("age");
        assert_eq!(age.unit, "s");
        assert!(age.values.iter().all(|age| (age / found.time() - 1.0).abs() < 1e-12), "{dimension}");
        assert_eq!(of("remembered").values, now.deformation.as_flattened(), "{dimension}");
        assert!(exact.history.is_empty());
    }
}

/// A law that remembers what it is told to.
#[derive(Debug)]
struct Remembering(&'static [History]);

impl CustomLaw for Remembering {
    fn name(&self) -> &'static str {
        "remembering"
    }

    fn history(&self) -> &'static [History] {
        self.0
    }

    fn elastic(&self) -> Isotropic<f64> {
        ELASTIC
    }

    fn respond(&self, motion: &Motion<f64>, _: &mut [f64]) -> Symmetric<f64> {
        NeoHookean { elastic: ELASTIC }.stress(motion)
    }

    fn strain_energy(&self, deformation: &Matrix<f64>, stress: &Symmetric<f64>, _: &[f64]) -> f64 {
        NeoHookean { elastic: ELASTIC }.strain_energy(deformation, stress, &[])
    }
}

#[test]
fn a_history_with_a_name_that_is_taken_is_refused_before_the_run() {
    let problem = |laws: &[&'static dyn CustomLaw]| {
        let mut scene = scene_of("plane-strain");
        let first = scene.materials[0].clone();
        let of_law =
            |&law: &&'static dyn CustomLaw| NamedMaterial { law: Material::custom(law), ..first.clone() };
        scene.materials = laws.iter().map(of_law).collect();
        step::build(&scene).err().expect("a problem")
    };
    static PRESSURE: Remembering = Remembering(&[History::new("pressure", "Pa", Kind::Number)]);
    let taken = problem(&[&PRESSURE]);
    assert_eq!(taken.key, "materials.rubber.remembering");
    assert_eq!(taken.found, "a history called `pressure`");
    assert!(taken.allowed.contains("position, velocity, spin, mass"), "{}", taken.allowed);
    static AGE: Remembering = Remembering(&[History::new("age", "s", Kind::Vector)]);
    let unlike = problem(&[&Counting, &AGE]);
    assert_eq!(unlike.found, "a history called `age` of kind Vector");
    assert_eq!(unlike.allowed, "Number, as in `rubber`, or another name");
}

/// The neo-Hookean law over arrays, until it has no answer; what it keeps is the energy.
#[derive(Debug)]
struct Together {
    until: f64,
}

const ENERGY: &[History] = &[History::new("energy", "J/m^3", Kind::Number)];

impl CustomLaw for Together {
    fn name(&self) -> &'static str {
        "together"
    }

    fn history(&self) -> &'static [History] {
        ENERGY
    }

    fn elastic(&self) -> Isotropic<f64> {
        ELASTIC
    }

    fn respond(&self, motion: &Motion<f64>, _: &mut [f64]) -> Symmetric<f64> {
        motion.stress
    }

    fn strain_energy(&self, _: &Matrix<f64>, _: &Symmetric<f64>, history: &[f64]) -> f64 {
        history[0]
    }

    fn over_arrays(&self) -> Option<&dyn LawOverArrays> {
        Some(self)
    }
}

impl LawOverArrays for Together {
    fn respond(&self, particles: LawArrays<'_>) -> Result<(), OutsideFault> {
        let LawArrays { time, dt, deformation, stress, history } = particles;
        if time > self.until {
            return Err(OutsideFault(std::sync::Arc::new(std::io::Error::other("no answer"))));
        }
        for ((f, stress), energy) in deformation.iter().zip(stress).zip(history) {
            let f = Matrix::from_fn(|i, j| f[3 * i + j]);
            let motion =
                Motion { deformation: f, jacobian: f.det(), increment: f, stress: Symmetric(*stress), dt };
            let law = NeoHookean { elastic: ELASTIC };
            *stress = law.stress(&motion).0;
            *energy = law.strain_energy(&f, &Symmetric(*stress), &[]);
        }
        Ok(())
    }
}

fn updated(update: StressUpdate, law: Option<&'static dyn CustomLaw>) -> Box<dyn Simulation> {
    let mut scene = scene_of("plane-strain");
    scene.time.stress_update = update;
    if let Some(law) = law {
        scene.materials[0].law = Material::custom(law);
    }
    step::build(&scene).unwrap_or_else(|problem| panic!("{problem:?}"))
}

#[test]
fn a_law_over_arrays_moves_particles_as_the_built_in_one_whichever_way_the_stress_is_updated() {
    static LAW: Together = Together { until: f64::INFINITY };
    for update in [StressUpdate::First, StressUpdate::Last, StressUpdate::ModifiedLast] {
        let mut exact = updated(update, None);
        let mut found = updated(update, Some(&LAW));
        // Steps of one length: the moduli of waves differ between the two.
        for _ in 0..150 {
            let dt = exact.step(1e-4).expect("a step");
            found.step(dt).expect("a step");
        }
        let off = largest_difference(&found.snapshot().position, &exact.snapshot().position);
        let energies = [&exact, &found].map(|simulation| simulation.ledger().strain);
        println!("{update:?}: positions differ by {off:.1e} m, energies are {energies:?} J");
        assert!(off < 1e-10, "{update:?}: {off:.1e}");
        assert!((energies[0] / energies[1] - 1.0).abs() < 1e-8 && energies[0] > 1.0, "{energies:?}");
    }
}

#[test]
fn a_law_over_arrays_gives_the_same_bits_for_any_number_of_threads() {
    static LAW: Together = Together { until: f64::INFINITY };
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut simulation = falling("3d", Some(&LAW));
            take_steps(&mut *simulation, 60);
            simulation.snapshot().position
        })
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn a_law_over_arrays_without_an_answer_ends_the_step_and_plane_stress_has_none() {
    static LAW: Together = Together { until: 1e-3 };
    let mut simulation = falling("plane-strain", Some(&LAW));
    let error = (0..100).find_map(|_| simulation.step(1e-4).err()).expect("it fails");
    assert!(matches!(&error, StepError::Outside { time, .. } if (1e-3..1.2e-3).contains(time)), "{error:?}");
    let message = error.to_string();
    assert!(message.starts_with("the law `together` of body `disk` failed near t = 1.0"), "{message}");
    assert!(message.ends_with(" s: no answer"), "{message}");
    let mut scene = scene_of("plane-stress");
    scene.materials[0].law = Material::custom(&LAW);
    let problem = step::build(&scene).err().expect("refused");
    assert_eq!(problem.key, "materials.rubber.together");
    assert_eq!(problem.found, "a law over arrays in plane stress, of the material `rubber`");
}
