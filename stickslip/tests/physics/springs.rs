//! Springs and dashpots between parts of bodies.
//!
//! Source: two masses on a spring, omega^2 = k (1/m_1 + 1/m_2); with a dashpot dE/dt = -c (dl/dt)^2.
//!
//! Set-up: two stiff blocks apart, joined by a spring between the faces that look at each other: both deform, on
//! grids of their own or one of them on the common grid, or one is rigid and free, or one is driven; in the plane and
//! in space, with each stress update; along a line that is none of the axes; a spring far stiffer than a step could
//! follow.
//!
//! Expected: the period within 1e-3; momentum and angular momentum to round-off; the ledger with the
//! works of the springs within 1e-3 of the energy; a dashpot takes the energy of its impulse; a stiff spring holds the
//! blocks at their distance, and nothing blows up; the same bits for any number of threads.

use crate::trial::{STRESS_UPDATES, distance, run_to, start, take_steps};
use rayon::ThreadPoolBuilder;
use stickslip::door::Simulation;

/// Two blocks of 4 by 4 cells with a spring between them, the second 1.5 times as dense.
fn blocks((dimension, time): (&str, &str), velocities: [&str; 2], spring: &str) -> String {
    let third = if dimension == "3d" { ", 0" } else { "" };
    let depth = if dimension == "3d" { ", 0.04" } else { "" };
    let [first, second] = velocities;
    format!(
        r#"
        time = {{ end = 10, {time} }}
        materials.light = {{ density = 1000, neo_hookean = {{ young_modulus = 1e7, poisson_ratio = 0.3 }} }}
        materials.heavy = {{ density = 1500, neo_hookean = {{ young_modulus = 1e7, poisson_ratio = 0.3 }} }}
        [space]
        dimension = "{dimension}"
        cell = 0.01
        [[bodies]]
        name = "left"
        material = "light"
        shape.box = {{ min = [0, 0{third}], max = [0.04, 0.04{depth}] }}
        {first}
        [[bodies]]
        name = "right"
        material = "heavy"
        shape.box = {{ min = [0.1, 0{third}], max = [0.14, 0.04{depth}] }}
        {second}
        [[springs]]
        from = {{ body = "left", on = "x_max" }}
        to = {{ body = "right", on = "x_min" }}
        {spring}
        "#
    )
}

/// Mean length of a period over three, from where the length of the spring passes that of the start.
fn period(simulation: &mut dyn Simulation, about: f64) -> f64 {
    let (mut passed, mut before) = (Vec::new(), (0.0, 0.0));
    run_to(simulation, 4.0 * about, |simulation| {
        let now = (simulation.time(), simulation.joints()[0].way);
        if before.1 < 0.0 && now.1 >= 0.0 {
            passed.push(before.0 - before.1 * (now.0 - before.0) / (now.1 - before.1));
        }
        before = now;
    });
    (passed[3] - passed[0]) / 3.0
}

#[test]
fn two_blocks_swing_on_a_spring() {
    let moving = |v: f64, third: &str| format!("velocity = [{v}, 0{third}]");
    let mut cases = vec![("3d", "", "deform"), ("3d", "", "mixed")];
    cases.extend(["free", "driven", "mixed"].map(|kind| ("plane-strain", "", kind)));
    let updates = STRESS_UPDATES.map(|update| format!("stress_update = \"{update}\""));
    cases.extend(updates.iter().map(|update| ("plane-strain", update.as_str(), "deform")));
    for (dimension, time, kind) in cases {
        let third = if dimension == "3d" { ", 0" } else { "" };
        let depth = if dimension == "3d" { 0.04 } else { 1.0 };
        let stiffness = 4e3 * depth;
        let [light, heavy] = [1000.0, 1500.0].map(|density: f64| density * 0.0016 * depth);
        let second = match kind {
            "free" => format!("{}\nrigid.free = {{}}", moving(-0.1, third)),
            // The other is on a grid of its own.
            "mixed" => format!("{}\ninterior = \"grid\"", moving(-0.1, third)),
            "driven" => "rigid = { velocity = [0.05, 0] }".to_string(),
            _ => moving(-0.1, third),
        };
        let scene =
            blocks((dimension, time), [&moving(0.1, third), &second], &format!("stiffness = {stiffness}"));
        let mut simulation = start(&scene);
        let begun = simulation.ledger();
        let inverse = 1.0 / light + if kind == "driven" { 0.0 } else { 1.0 / heavy };
        let exact = std::f64::consts::TAU / (stiffness * inverse).sqrt();
        let found = period(&mut *simulation, exact);
        let ledger = simulation.ledger();
        let off = distance(ledger.momentum, begun.momentum) / (light * 0.1);
        let turned = distance(ledger.angular_momentum, begun.angular_momentum) / (light * 0.1 * 0.1);
        let scale = 0.5 * 0.01 / inverse;
        println!(
            "{dimension} {time} {kind}: period {:.5}, momentum {off:.1e} {turned:.1e}, energy {:.1e}",
            found / exact,
            (ledger.total - begun.total) / scale
        );
        assert!((found / exact - 1.0).abs() < 1e-3, "{dimension} {time} {kind}: {found} {exact}");
        assert!(kind == "driven" || off < 1e-11 && turned < 1e-9, "{ledger:?}");
        assert!((ledger.total - begun.total).abs() < 1e-3 * scale, "{ledger:?} {begun:?}");
    }
}

/// A spring of another length than it is drawn with, across the axes, pulls the blocks together along its line.
#[test]
fn a_spring_pulls_along_its_line() {
    let scene = blocks(("plane-strain", ""), ["", ""], "stiffness = 2e3\nlength = 0.05")
        .replace("min = [0.1, 0], max = [0.14, 0.04]", "min = [0.1, 0.06], max = [0.14, 0.1]");
    let mut simulation = start(&scene);
    take_steps(&mut *simulation, 50);
    let (bodies, joint, time) = (simulation.bodies(), simulation.joints()[0], simulation.time());
    // From (0.04, 0.02) to (0.1, 0.08).
    let force = 2e3 * (0.06 * 2.0_f64.sqrt() - 0.05);
    let along = force / 2.0_f64.sqrt() * time;
    for (body, mass, sign) in [(0, 1.6, 1.0), (1, 2.4, -1.0)] {
        for i in 0..2 {
            let given = sign * along / mass;
            assert!(
                (bodies[body].velocity[i] / given - 1.0).abs() < 0.01,
                "{:?} {given}",
                bodies[body].velocity
            );
        }
    }
    assert!(distance(joint.impulse, [along, along, 0.0]) < 0.01 * along && joint.way < 0.0, "{joint:?}");
}

#[test]
fn a_dashpot_takes_energy_and_a_stiff_spring_holds() {
    let moving = ["velocity = [0.1, 0]", "velocity = [-0.1, 0]"];
    let mut simulation = start(&blocks(("plane-strain", ""), moving, "dashpot = 100"));
    let begun = simulation.ledger();
    run_to(&mut *simulation, 0.05, |_| {});
    let (ledger, bodies) = (simulation.ledger(), simulation.bodies());
    // 1/tau = c (1/m_1 + 1/m_2); what is left of the approach, and the energy that is gone.
    let inverse: f64 = 1.0 / 1.6 + 1.0 / 2.4;
    let left = (-100.0 * inverse * 0.05).exp();
    let closing = bodies[0].velocity[0] - bodies[1].velocity[0];
    let lost = 0.5 * 0.04 / inverse * (1.0 - left * left);
    println!("closing {:.4} of {left:.4}, work {:.5}", closing / 0.2, ledger.external_work / -lost);
    assert!((closing / 0.2 - left).abs() < 2e-3 && (ledger.external_work / -lost - 1.0).abs() < 5e-3);
    // The force is of first order in the step over the time in which the dashpot stops the blocks, 4e-3.
    assert!((ledger.total - begun.total).abs() < 5e-3 * lost, "{ledger:?}");

    // A known miss: blocks that are stopped within a step, whose work is that of the step's end.
    for (interior, most) in [("grid", 0.06), ("reference", 0.09)] {
        let text = blocks(("plane-strain", ""), moving, "stiffness = 1e12\ndashpot = 1e6")
            .replace("[space]", &format!("[space]\ninterior = \"{interior}\""));
        let mut simulation = start(&text);
        let begun = simulation.ledger();
        run_to(&mut *simulation, 0.05, |simulation| assert!(simulation.joints()[0].way.abs() < 1e-4));
        let ledger = simulation.ledger();
        let (drift, off) =
            ((ledger.total - begun.total) / begun.kinetic, distance(ledger.momentum, begun.momentum));
        println!("held, {interior}: drift {drift:.1e}, momentum {off:.1e}");
        assert!(drift.abs() < most && off < 1e-11, "{interior}: {ledger:?}");
    }
}

#[test]
fn springs_are_the_same_for_any_number_of_threads() {
    let scene =
        blocks(("plane-strain", ""), ["velocity = [0.1, 0.2]", "spin = 3"], "stiffness = 2e4\ndashpot = 3");
    let run = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut simulation = start(&scene);
            take_steps(&mut *simulation, 100);
            (simulation.joints(), simulation.snapshot().position)
        })
    };
    assert!(run(1) == run(3));
}
