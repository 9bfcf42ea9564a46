//! A step that fails is taken again with half of its length, and what comes of it is right.
//!
//! Set-up: a block of gel is struck on a face by 2 MPa, twenty times its Young's modulus, that fades within 5 ms. The
//! step that is stable at rest turns its corners inside out.
//!
//! Expected: the failure without retries. With them the block moves as with steps of a twentieth, its velocity within
//! 1 % and its way within 2 %: the impulse is the load's, whatever the steps. Steps grow back to the stable one. The same
//! bits for any number of threads. A step that fails however short it is gives the failure, and leaves what it saw.

use crate::trial::start;
use rayon::ThreadPoolBuilder;
use stickslip::door::{Simulation, StepError};
use stickslip::march::{FailedStep, March, MarchError, Pace};

const BLOW: &str = r#"
    [space]
    dimension = "plane-strain"
    interior = "grid"
    cell = 0.1
    [time]
    end = 0.04
    courant = 0.4
    [materials.gel]
    density = 1000
    neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
    [[bodies]]
    name = "block"
    material = "gel"
    shape.box = { min = [0, -0.4], max = [0.8, 0.4] }
    [[loads]]
    body = "block"
    on = "x_min"
    traction = ["2e6 * exp(-t / 5e-3)", 0]
"#;

const END: f64 = 0.04;

/// Steps to the end, and what failed on the way.
fn march(simulation: &mut dyn Simulation, retries: usize) -> Result<Vec<FailedStep>, MarchError> {
    let mut march = March::to(END).with_retries(Pace::default(), retries);
    let mut failed = Vec::new();
    while march.step(simulation)?.is_some() {
        failed.extend(march.failed().cloned());
    }
    assert_eq!((simulation.time(), march.pace()), (END, Pace::default()), "steps grow back");
    Ok(failed)
}

#[test]
fn a_step_that_fails_is_taken_again_and_the_answer_is_right() {
    let error = march(&mut *start(BLOW), 0).expect_err("the corners fold");
    assert!(matches!(error, MarchError::Step(StepError::Inverted { .. })), "{error}");

    let mut simulation = start(BLOW);
    let failed = march(&mut *simulation, 4).expect("it goes on");
    assert!(!failed.is_empty() && failed.len() < 20, "{failed:?}");
    assert!(
        failed.iter().all(|failed| matches!(failed.error, StepError::Inverted { .. }) && failed.part <= 0.5)
    );

    let mut fine = start(&BLOW.replace("courant = 0.4", "courant = 0.02"));
    assert_eq!(march(&mut *fine, 0), Ok(Vec::new()));
    let [coarse, fine] = [simulation, fine].map(|simulation| simulation.bodies()[0].clone());
    let [way, expected] = [&coarse, &fine].map(|state| state.position[0] - 0.4);
    println!("velocity {} of {}, way {way} of {expected} m", coarse.velocity[0], fine.velocity[0]);
    assert!((coarse.velocity[0] / fine.velocity[0] - 1.0).abs() < 0.01);
    assert!((way / expected - 1.0).abs() < 0.02);
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let outcome = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
        pool.install(|| {
            let mut simulation = start(BLOW);
            let failed = march(&mut *simulation, 4).expect("it goes on");
            format!(
                "{failed:?} {:?} {:?} {:?}",
                simulation.steps(),
                simulation.snapshot(),
                simulation.ledger()
            )
        })
    };
    assert!(outcome(1) == outcome(3), "threads differ from one");
}

#[test]
fn a_step_that_fails_however_short_it_is_ends_the_march() {
    // At 1 GPa no step in reach is short enough.
    let mut simulation = start(&BLOW.replace("2e6", "1e9"));
    let error = march(&mut *simulation, 2).expect_err("the corners fold");
    assert!(matches!(error, MarchError::Step(StepError::Inverted { .. })), "{error}");
    assert!(simulation.time() < 1e-3, "{}", simulation.time());
    let folded = simulation.snapshot().deformation.iter().any(|f| f[0] * f[4] - f[1] * f[3] <= 0.0);
    assert!(folded, "it can still be looked at");
}
