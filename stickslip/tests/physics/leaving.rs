//! Particles that leave the domain are taken out, and the books close.
//!
//! Set-ups: a block that spins and flies out of the domain through one face, alone or beside one that stays, rests on a
//! rigid floor and is held by a support; two disks that collide and go apart; no gravity, or gravity.
//!
//! Expected: mass, momentum, angular momentum and energy that the particles have and that went are what there was, to
//! what the run without a domain keeps; the same bits for any number of threads, with a workspace made anew and from a
//! saved state; what stays is as if nobody had gone; an emptied body weighs nothing and does no harm.

use crate::trial::{start, take_steps};
use rayon::ThreadPoolBuilder;
use stickslip::door::{Ledger, Simulation, StepError};

/// A block of clay that flies out of the domain, in a dimension, with a face and a gravity.
fn scene(dimension: &str, leaving: &str) -> String {
    let space = dimension == "3d";
    let v = |x: &str, y: &str| if space { format!("[{x}, {y}, 0]") } else { format!("[{x}, {y}]") };
    let corner =
        |x: &str, y: &str, z: &str| if space { format!("[{x}, {y}, {z}]") } else { format!("[{x}, {y}]") };
    let spin = if space { "[0, 0, 4]" } else { "4" };
    format!(
        r#"
        gravity = {}
        [space]
        dimension = "{dimension}"
        cell = 0.1
        interior = "grid"
        domain = {{ min = {}, max = {}{leaving} }}
        [time]
        end = 1
        [materials]
        clay = {{ density = 1000, von_mises = {{ young_modulus = 1e5, poisson_ratio = 0.3, yield_stress = 1e3 }} }}
        rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "runaway"
        material = "clay"
        shape.box = {{ min = {}, max = {} }}
        velocity = {}
        spin = {spin}
        [[bodies]]
        name = "still"
        material = "rubber"
        shape.box = {{ min = {}, max = {} }}
        [[bodies]]
        name = "floor"
        material = "rubber"
        rigid = {{}}
        shape.box = {{ min = {}, max = {} }}
        "#,
        v("0", "-1"),
        corner("-1", "-1", "-1"),
        corner("1", "1", "1"),
        corner("0.2", "0.1", "0"),
        corner("0.6", "0.5", "0.3"),
        v("4", "0"),
        corner("-0.6", "-0.48", "0"),
        corner("-0.2", "-0.1", "0.3"),
        corner("-0.8", "-0.7", "-0.2"),
        corner("0.2", "-0.48", "0.5"),
    )
}

const REMOVE: &str = ", leaving = \"remove\"";

/// What there is and what went: mass, momentum, angular momentum, total energy.
fn all_there_is(simulation: &dyn Simulation) -> ([f64; 8], f64) {
    let Ledger { momentum, angular_momentum, total, removed_mass, .. } = simulation.ledger();
    let Ledger { removed_momentum, removed_angular_momentum, .. } = simulation.ledger();
    let bodies = simulation.bodies();
    let mass = bodies[0].mass + bodies[1].mass + removed_mass;
    let sum = |a: [f64; 3], b: [f64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let (p, l) = (sum(momentum, removed_momentum), sum(angular_momentum, removed_angular_momentum));
    ([mass, p[0], p[1], p[2], l[0], l[1], l[2], total], removed_mass)
}

#[test]
fn books_close_where_particles_leave() {
    for dimension in ["plane-strain", "3d"] {
        let text = scene(dimension, REMOVE);
        let mut simulation = start(&text);
        let (before, _) = all_there_is(&*simulation);
        let mut seen = 0;
        while simulation.time() < 0.3 {
            let (known, _) = all_there_is(&*simulation);
            let gone = simulation.removed()[0].count;
            take_steps(&mut *simulation, 1);
            let (now, _) = all_there_is(&*simulation);
            let removed = simulation.removed()[0];
            if removed.count == gone {
                continue;
            }
            seen += 1;
            // Removal itself changes nothing of the sums but by round-off; the step before it does what steps do.
            assert!((now[0] - before[0]).abs() < 1e-12 * before[0], "{dimension}: {now:?}");
            assert!((now[7] - known[7]).abs() < 0.02 * before[7].abs(), "{dimension}: {now:?} {known:?}");
        }
        assert!(seen > 1, "{dimension}: they leave bit by bit");
        let bodies = simulation.bodies();
        assert_eq!((bodies[0].mass, bodies[0].position, bodies[0].velocity), (0.0, [0.0; 3], [0.0; 3]));
        assert!(bodies[1].mass > 0.0);
        let [removed, still, floor] = simulation.removed()[..] else { panic!("three bodies") };
        assert_eq!([still.count, floor.count], [0, 0]);
        assert!((removed.mass - before[0] + bodies[1].mass).abs() < 1e-12 * before[0]);
        assert!(removed.place[0] > 1.0 && removed.place[0] < 1.5 && removed.time > 0.05, "{removed:?}");
        // 4 m/s along x; gravity pulls for a little while.
        assert!((removed.momentum[0] / (4.0 * removed.mass) - 1.0).abs() < 1e-2, "{removed:?}");
        // It goes on without them, and every question has an answer.
        take_steps(&mut *simulation, 50);
        let snapshot = simulation.snapshot();
        assert_eq!(snapshot.body.len(), simulation.particles());
        assert!(snapshot.body.iter().all(|&body| body != 0));
        assert_eq!(simulation.column(0, "mass").unwrap().by_number::<1>().len(), 0);
        assert!(simulation.ledger().total.is_finite() && simulation.stable_step() > 0.0);
        simulation.grid_snapshot();
        simulation.settle();
    }
}

/// Energy of particles at the instant at which they go, with gravity and plastic flow: the total stays as it is.
#[test]
fn the_total_energy_does_not_jump() {
    let mut simulation = start(&scene("plane-strain", REMOVE));
    let (mut largest_jump, mut largest_step) = (0.0_f64, 0.0_f64);
    while simulation.time() < 0.25 {
        let before = simulation.ledger();
        take_steps(&mut *simulation, 1);
        let after = simulation.ledger();
        let change = (after.total - before.total).abs();
        match after.removed_mass > before.removed_mass {
            true => largest_jump = largest_jump.max(change),
            false => largest_step = largest_step.max(change),
        }
    }
    assert!(simulation.ledger().removed_energy > 100.0, "{:?}", simulation.ledger());
    assert!(largest_jump < 3.0 * largest_step + 1e-9, "{largest_jump} {largest_step}");
}

/// Everything that can be seen, in text that gives the bits back.
fn outcome(text: &str, threads: usize, take: impl Fn(&mut dyn Simulation) + Sync) -> String {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
    pool.install(|| {
        let mut simulation = start(text);
        take(&mut *simulation);
        assert!(simulation.removed()[0].count > 0, "some have left");
        let numbers = simulation.snapshot().number;
        assert!(numbers.len() == simulation.particles());
        format!(
            "{:?} {:?} {:?} {:?} {:?}",
            simulation.time(),
            simulation.snapshot(),
            simulation.ledger(),
            simulation.bodies(),
            simulation.removed()
        )
    })
}

#[test]
fn bits_do_not_depend_on_threads_or_on_what_is_kept() {
    for (dimension, precision) in [("plane-strain", "double"), ("plane-strain", "single"), ("3d", "double")] {
        let text = scene(dimension, REMOVE)
            .replace("cell = 0.1", &format!("cell = 0.1\nprecision = \"{precision}\""));
        let text = text.replace("velocity = [4", "velocity = [3");
        let steps = 180;
        let one = outcome(&text, 1, |simulation| take_steps(simulation, steps));
        assert!(outcome(&text, 3, |simulation| take_steps(simulation, steps)) == one, "{dimension}: threads");
        let rebuilding = |simulation: &mut dyn Simulation| {
            (0..steps).for_each(|_| {
                simulation.rebuild_workspace();
                take_steps(simulation, 1);
            });
        };
        assert!(outcome(&text, 1, rebuilding) == one, "{dimension}: with its workspace made anew");
        let going_back = |simulation: &mut dyn Simulation| {
            for step in 0..steps {
                if step % 13 == 11 {
                    let saved = simulation.save().expect("the engine can be saved");
                    take_steps(simulation, 15);
                    simulation.restore(saved).expect("it is its own state");
                }
                if step % 13 == 3 {
                    simulation.hold();
                    take_steps(simulation, 15);
                    assert!(simulation.take_back());
                }
                take_steps(simulation, 1);
            }
        };
        assert!(outcome(&text, 1, going_back) == one, "{dimension}: from a state that was saved");
        let elsewhere = |simulation: &mut dyn Simulation| {
            take_steps(simulation, steps - 5);
            let saved = simulation.save().expect("the engine can be saved");
            let mut other = start(&text);
            other.restore(saved).expect("it is of the same scene");
            take_steps(&mut *other, 5);
            simulation
                .restore(other.save().expect("the engine can be saved"))
                .expect("it is of the same scene");
        };
        assert!(outcome(&text, 1, elsewhere) == one, "{dimension}: in another simulation");
    }
}

/// Those who stay do not notice: the same bits as in a scene in which the other flies on.
#[test]
fn those_who_stay_move_as_before() {
    let wide = scene("plane-strain", "").replace("max = [1, 1]", "max = [9, 1]");
    let still = |text: &str| {
        let mut simulation = start(text);
        // As long as the steps, which follow from all particles, are the same.
        while simulation.time() < 0.1 {
            simulation.step(1e-3).expect("it goes on");
        }
        let snapshot = simulation.snapshot().only(|body, _| body == 1);
        (snapshot, simulation.removed().first().map(|removed| removed.count))
    };
    let ((flown, none), (removed, some)) = (still(&wide), still(&scene("plane-strain", REMOVE)));
    assert!(none.is_none() && some.is_some_and(|count| count > 0), "{none:?} {some:?}");
    let far = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
    let off = flown.position.iter().zip(&removed.position).map(|(a, b)| far(a, b)).fold(0.0, f64::max);
    assert!(off < 1e-12, "{off}");
}

/// A support whose particles leave holds what is left, and a load does not fall on others.
#[test]
fn loads_go_with_the_particles_that_carry_them() {
    let text = scene("plane-strain", REMOVE)
        + r#"
        [[supports]]
        name = "cart"
        body = "runaway"
        within.box = { min = [0.5, 0], max = [0.7, 0.6] }
        stiffness = 100
        [[loads]]
        name = "push"
        body = "runaway"
        on = "volume"
        force = [20, 0]
        "#;
    let mut simulation = start(&text);
    while simulation.removed()[0].count == 0 {
        take_steps(&mut *simulation, 1);
    }
    let [cart, push] = simulation.loads()[..] else { panic!("two loads") };
    assert!(cart.impulse[0].is_finite() && push.impulse[0] > 0.0);
    while simulation.bodies()[0].mass > 0.0 {
        take_steps(&mut *simulation, 10);
        assert!(simulation.time() < 2.0, "all of it leaves");
    }
    let pushed = simulation.loads()[1].impulse;
    take_steps(&mut *simulation, 20);
    assert_eq!(simulation.loads()[1].impulse, pushed, "there is nothing left to push");
    assert_eq!(simulation.loads()[1].displacement, [0.0; 3]);
}

/// Rigid bodies are what they are as a whole.
#[test]
fn a_rigid_body_that_leaves_stops_the_run() {
    let text = scene("plane-strain", REMOVE).replace("rigid = {}", "rigid = { velocity = [5, 0] }");
    let mut simulation = start(&text);
    let error = loop {
        if let Err(error) = simulation.step(1.0) {
            break error;
        }
        assert!(simulation.time() < 1.0, "the floor must be gone");
    };
    assert!(matches!(&error, StepError::Escaped { body, .. } if body == "floor"), "{error}");
}
