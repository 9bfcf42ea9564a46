//! Supports and loads do what they say, and their works are in the ledger.
//!
//! Source: Newton's laws and Hooke's; a bar between supports swings with the period 2 L / c.
//!
//! Set-up: small bodies of one elastic material; bars between supports at four places on the grid, with each basis,
//! stress update and transfer; blocks on springs and dashpots, under forces from a table and formulas of time and
//! place; a half model in mirrors; two and five threads.
//!
//! Expected: forces of supports within 3 % of E A eps wherever the bar lies (1.1 % by gimp, 1.7 % by splines, 2.5 % by
//! linear functions); swings over 90 periods whose energy changes by less than 3 % between the first and the last ten,
//! with and without what the supports' springs hold of it; momentum equal to the impulse to round-off; works within
//! 1e-3 of the energy; the period of a mass on a spring within 1e-3; an absorbing end gives back less than 1 % of a
//! pulse's energy; moments of loads and supports at rest within 1 %; the same bits for any number of threads.

use crate::trial::{STRESS_UPDATES, largest_difference, run_to, start, take_steps};
use rayon::ThreadPoolBuilder;
use stickslip::door::{LoadState, Simulation};

/// A bar 8 by 2 cells in plane stress, off the grid by part of a cell, with more tables.
fn bar(offset: f64, (basis, time): (&str, &str), more: &str) -> String {
    let h = 0.01;
    let [x, y, right, top] = [0.0, 0.0, 8.0, 2.0].map(|cells: f64| (cells + offset) * h);
    format!(
        r#"
        time = {{ end = 1, {time} }}
        materials.gel = {{ density = 1000, neo_hookean = {{ young_modulus = 1e7, poisson_ratio = 0.3 }} }}
        [space]
        dimension = "plane-stress"
        interior = "grid"
        cell = {h}
        basis = "{basis}"
        domain = {{ min = [-0.1, -0.1], max = [0.3, 0.2] }}
        [[bodies]]
        name = "bar"
        material = "gel"
        particles = "fitted"
        shape.box = {{ min = [{x}, {y}], max = [{right}, {top}] }}
        {more}
        "#
    )
}

const BASES: [&str; 4] = ["gimp", "linear", "spline", "cubic"];
/// Speed of a wave along the bar [m/s].
const SPEED: f64 = 100.0;

#[test]
fn a_stretched_bar_pulls_with_its_stiffness_wherever_it_lies() {
    let supports = r#"
        velocity = [1e-9, 0]
        [damping]
        local = 0.3
        [[supports]]
        body = "bar"
        on = "x_min"
        displacement = [0, "free"]
        [[supports]]
        name = "machine"
        body = "bar"
        on = "x_max"
        displacement = [{ table = [[0, 0], [8e-3, 8e-5]] }, "free"]
    "#;
    let mut worst = 0.0_f64;
    for basis in BASES {
        for offset in [0.0, 0.1, 0.3, 0.5, 0.9] {
            let mut simulation = start(&bar(offset, (basis, ""), supports));
            run_to(&mut *simulation, 15e-3, |_| {});
            let before = simulation.loads();
            run_to(&mut *simulation, 16e-3, |_| {});
            let after = simulation.loads();
            let exact = 1e7 * 0.02 * 1e-3;
            let force = |i: usize| (after[i].impulse[0] - before[i].impulse[0]) / 1e-3;
            println!("{basis}, {offset}: {:.4} {:.4}", -force(0) / exact, force(1) / exact);
            for force in [-force(0), force(1)] {
                worst = worst.max((force / exact - 1.0).abs());
            }
            assert!((after[1].displacement[0] / 8e-5 - 1.0).abs() < 0.02, "{after:?}");
            let ledger = simulation.ledger();
            let work = after[0].work + after[1].work;
            assert!((ledger.total / work).abs() < 1e-3, "{basis}, {offset}: {ledger:?}");
        }
    }
    println!("worst {worst:.4}");
    assert!(worst < 0.03, "{worst}");
}

#[test]
fn a_bar_swings_between_supports_without_gain() {
    let supports = r#"
        velocity = [1e-3, 0]
        [[supports]]
        body = "bar"
        on = "x_min"
        displacement = [0, "free"]
        [[supports]]
        body = "bar"
        on = "x_max"
        displacement = [0, "free"]
    "#;
    let runs = (BASES.iter().map(|basis| (*basis, ""))).chain(
        ["courant = 0.8", "transfer = \"flip\"", "stress_update = \"first\""].map(|time| ("gimp", time)),
    );
    for (basis, time) in runs {
        for offset in [0.0, 0.1] {
            let mut simulation = start(&bar(offset, (basis, time), supports));
            let first = simulation.ledger().kinetic;
            let period = 0.16 / SPEED;
            // Means over ten periods of the energy of motion and strain, and of what the supports' springs have not.
            let mut mean = |from: f64| {
                let (mut kept, mut total, mut count) = (0.0, 0.0, 0.0);
                run_to(&mut *simulation, from * period, |_| {});
                run_to(&mut *simulation, (from + 10.0) * period, |simulation| {
                    let ledger = simulation.ledger();
                    kept += (ledger.kinetic + ledger.strain) / first;
                    total += ledger.total / first;
                    count += 1.0;
                });
                [kept / count, total / count]
            };
            let [early, late] = [mean(5.0), mean(80.0)];
            println!(
                "{basis} {time}, {offset}: motion and strain {:.4}, {:.4}; with springs {:.4}, {:.4}",
                early[0], late[0], early[1], late[1]
            );
            let drift = [0, 1].map(|i| (late[i] - early[i]).abs());
            assert!(
                (late[1] - 1.0).abs() < 0.05 && drift.iter().all(|&drift| drift < 0.03),
                "{basis} {time}, {offset}"
            );
        }
    }
}

#[test]
fn a_force_over_time_is_the_momentum() {
    let loads = r#"
        [[loads]]
        body = "bar"
        on = "volume"
        force = [{ table = [["0 s", 0], ["1 ms", 200], ["3 ms", -40]] }, "100 N * sin(t / 1 ms)"]
    "#;
    for update in STRESS_UPDATES {
        let mut simulation =
            start(&bar(0.3, ("gimp", &format!("stress_update = \"{update}\", max_step = 1e-5")), loads));
        run_to(&mut *simulation, 4e-3, |_| {});
        let (ledger, load) = (simulation.ledger(), simulation.loads()[0]);
        // The table's area: a triangle, a trapezium, and what it holds beyond its end.
        let exact = [0.1 + 0.16 - 0.04, 0.1 * (1.0 - 4.0_f64.cos())];
        for (i, exact) in exact.into_iter().enumerate() {
            assert!((ledger.momentum[i] - load.impulse[i]).abs() < 1e-12, "{ledger:?} {load:?}");
            assert!((load.impulse[i] / exact - 1.0).abs() < 2e-5, "{load:?}");
        }
        // A point that is pushed has gained half a step of push too much or little: no more.
        assert!((ledger.total / ledger.kinetic).abs() < 2e-2, "{ledger:?}");
    }
}

#[test]
fn an_acceleration_is_a_gravity() {
    let load = "loads = [{ body = \"bar\", acceleration = [3, -5] }]";
    let (by_load, by_gravity) = {
        let text = |load: &str, gravity: &str| {
            format!("{gravity}\n{}", bar(0.3, ("gimp", ""), ""))
                .replace("[space]", &format!("{load}\n[space]"))
        };
        let run = |text: String| {
            let mut simulation = start(&text);
            take_steps(&mut *simulation, 100);
            simulation.snapshot()
        };
        (run(text(load, "")), run(text("", "gravity = [3, -5]")))
    };
    let apart = largest_difference(&by_load.position, &by_gravity.position);
    let fast = largest_difference(&by_load.velocity, &by_gravity.velocity);
    assert!(apart < 1e-12 && fast < 1e-10, "{apart} {fast}");
}

#[test]
fn a_mass_on_a_spring_swings_and_a_dashpot_stops_it() {
    // So soft that the block is as good as rigid.
    let (stiffness, mass) = (400.0_f64, 1000.0 * 0.08 * 0.02);
    let omega = (stiffness / mass).sqrt();
    let spring = |dashpot: f64| {
        format!(
            "velocity = [0.1, 0]\n[[supports]]\nbody = \"bar\"\non = \"volume\"\nstiffness = {stiffness}\n\
             dashpot = {dashpot}\n\
             displacement = [0, \"free\"]"
        )
    };
    let mut simulation = start(&bar(0.3, ("gimp", ""), &spring(1e-9)));
    let mut crossings = Vec::new();
    let mut before = (0.0, 0.0);
    let start_x = simulation.bodies()[0].position[0];
    run_to(&mut *simulation, 4.3 * std::f64::consts::TAU / omega, |simulation| {
        let now = (simulation.time(), simulation.bodies()[0].position[0] - start_x);
        if before.1 < 0.0 && now.1 >= 0.0 {
            crossings.push(before.0 + (now.0 - before.0) * before.1 / (before.1 - now.1));
        }
        before = now;
    });
    let period = (crossings[3] - crossings[0]) / 3.0;
    println!("period {:.6} of the exact", period * omega / std::f64::consts::TAU);
    assert!((period * omega / std::f64::consts::TAU - 1.0).abs() < 1e-3, "{period}");
    let ledger = simulation.ledger();
    assert!((ledger.total / (0.5 * mass * 0.01) - 1.0).abs() < 1e-3, "{ledger:?}");

    // Damping ratio 0.2: an amplitude of exp(-zeta omega t).
    let dashpot = 2.0 * 0.2 * (stiffness * mass).sqrt();
    let mut simulation = start(&bar(0.3, ("gimp", ""), &spring(dashpot)));
    let mut most = 0.0_f64;
    let quarter = 0.5 * std::f64::consts::PI / omega;
    run_to(&mut *simulation, 5.0 * quarter, |simulation| {
        let away = simulation.bodies()[0].position[0] - start_x;
        if simulation.time() > 3.0 * quarter {
            most = most.max(away);
        }
    });
    // x = v/w_d exp(-zeta w t) sin(w_d t), at its second peak to the right.
    let (zeta, damped) = (0.2_f64, omega * 0.96_f64.sqrt());
    let peak = (damped / (zeta * omega)).atan() / damped + std::f64::consts::TAU / damped;
    let exact = 0.1 / damped * (-zeta * omega * peak).exp() * (damped * peak).sin();
    println!("second peak {:.4} of the exact", most / exact);
    assert!((most / exact - 1.0).abs() < 0.01, "{most} {exact}");
}

#[test]
fn an_absorbing_end_lets_waves_go() {
    // A pulse that a push at the left end sends along a bar of 40 cells in plane strain; all of it is out by 12 ms.
    let text = |end: &str| {
        format!(
            r#"
            time = {{ end = 1 }}
            materials.gel = {{ density = 1000, neo_hookean = {{ young_modulus = 1e7, poisson_ratio = 0 }} }}
            [space]
            dimension = "plane-strain"
            interior = "grid"
            cell = 0.01
            domain = {{ min = [-0.1, 0], max = [0.6, 0.04], y_min = "symmetry", y_max = "symmetry" }}
            [[bodies]]
            name = "bar"
            material = "gel"
            shape.box = {{ min = [0, 0], max = [0.4, 0.04] }}
            {end}
            [[loads]]
            body = "bar"
            on = "x_min"
            pressure = "1 kPa * sin(pi * min(t, 2 ms) / 2 ms)^2"
            "#
        )
    };
    let run = |end: &str| {
        let mut simulation = start(&text(end));
        run_to(&mut *simulation, 3e-3, |_| {});
        let sent = simulation.ledger();
        run_to(&mut *simulation, 12e-3, |_| {});
        let left = simulation.ledger();
        (
            (left.kinetic + left.strain) / (sent.kinetic + sent.strain),
            left.total / (sent.kinetic + sent.strain),
        )
    };
    let (kept, _) = run("");
    let (left, total) = run("[[supports]]\nbody = \"bar\"\non = \"x_max\"\ndashpot = \"absorbing\"");
    println!("a free end keeps {kept:.4}, an absorbing one {left:.1e}; ledger {total:.1e}");
    assert!(kept > 0.97 && left < 0.01 && total.abs() < 0.01, "{kept} {left} {total}");
}

/// A cantilever whose end a force and a traction that grows across it bend: the moment of the traction about the middle
/// of the end is its integral, that of a force that is shared out evenly is none, and at rest the support holds against
/// both, and against the force by the length of the bar.
#[test]
fn loads_and_supports_say_their_moments() {
    let rest = r#"
        [[supports]]
        body = "bar"
        on = "x_min"
        [[loads]]
        body = "bar"
        on = "x_max"
        force = [0, -20]
        [[loads]]
        body = "bar"
        on = "x_max"
        traction = ["1 kPa * (y0 - 1 cm) / 1 cm", 0]
        "#;
    let text = bar(0.0, ("gimp", "relax.residual = 1e-6"), rest);
    let mut simulation = start(&text);
    run_to(&mut *simulation, 0.4, |_| {});
    let before = simulation.loads();
    run_to(&mut *simulation, 0.41, |_| {});
    let after = simulation.loads();
    let mean = |(after, before): (&LoadState, &LoadState)| (after.moment[2] - before.moment[2]) / 0.01;
    let still: Vec<f64> = after.iter().zip(&before).map(mean).collect();
    // Per metre of depth: the integral of p (y/c) y over the face from -c to c, as a sum over the middles of its four
    // parts, and the force times 8 cells.
    let (c, length) = (0.01, 0.08);
    let traction = -2.0 / 3.0 * 1e3 * c * c * (1.0 - 1.0 / 16.0);
    let support = 20.0 * length - traction;
    println!("moments {still:?} N m/m, expected {support}, 0, {traction}");
    assert!((still[0] / support - 1.0).abs() < 0.01, "{still:?}");
    assert!(still[1].abs() < 1e-3 * support && (still[2] / traction - 1.0).abs() < 0.01, "{still:?}");
}

/// Loads of every kind on a body that deforms and turns, near a mirror.
fn everything(dimension: &str) -> String {
    let v =
        |x: &str, y: &str| if dimension == "3d" { format!("[{x}, {y}, 0]") } else { format!("[{x}, {y}]") };
    let b = |x: &str, y: &str, z: &str| {
        if dimension == "3d" { format!("[{x}, {y}, {z}]") } else { format!("[{x}, {y}]") }
    };
    format!(
        r#"
        time = {{ end = 1 }}
        materials.gel = {{ density = 1000, neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }} }}
        [space]
        dimension = "{dimension}"
        cell = 0.1
        domain = {{ min = {}, max = {}, x_min = "symmetry" }}
        [[bodies]]
        name = "block"
        material = "gel"
        shape.box = {{ min = {}, max = {} }}
        [[bodies]]
        name = "ball"
        material = "gel"
        shape.ball = {{ center = {}, radius = 0.25 }}
        [[supports]]
        body = "block"
        on = "y_min"
        [[supports]]
        body = "ball"
        on = "volume"
        within.ball = {{ center = {}, radius = 0.15 }}
        velocity = {}
        [[loads]]
        body = "block"
        on = "y_max"
        pressure = "1 kPa * (1 + x0 / 1 m) * min(t / 10 ms, 1)"
        [[loads]]
        body = "block"
        on = "x_max"
        traction = {}
        [[loads]]
        body = "ball"
        acceleration = {}
        "#,
        b("0", "-1", "-1"),
        b("2", "2", "1"),
        b("0", "0", "-0.2"),
        b("0.5", "0.4", "0.2"),
        b("0.3", "0.71", "0.01"),
        b("0.3", "0.71", "0.01"),
        v("\"0.1 m/s * t / 10 ms\"", "-0.5"),
        v("100", "\"50 Pa * cos(t / 1 ms)\""),
        v("\"-x / 1 s^2\"", "1"),
    )
}

#[test]
fn loads_give_the_same_bits_on_any_threads_and_from_the_state_alone() {
    for dimension in ["plane-strain", "3d"] {
        let text = everything(dimension);
        let outcome = |threads: usize, rebuild: bool| {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
            pool.install(|| {
                let mut simulation: Box<dyn Simulation> = start(&text);
                for step in 0..120 {
                    take_steps(&mut *simulation, 1);
                    if rebuild && step % 23 == 5 {
                        simulation.rebuild_workspace();
                    }
                }
                format!("{:?} {:?} {:?}", simulation.snapshot(), simulation.loads(), simulation.ledger())
            })
        };
        let one = outcome(1, false);
        // No assert_eq: the texts are long.
        assert!(outcome(2, false) == one && outcome(5, false) == one, "{dimension}: threads");
        assert!(outcome(1, true) == one, "{dimension}: with its workspace made anew");
    }
}

#[test]
fn half_of_a_held_and_pressed_body_is_as_the_whole() {
    let text = |half: bool| {
        let (low, face) = if half { (0.0, ", x_min = \"symmetry\"") } else { (-0.5, "") };
        format!(
            r#"
            time = {{ end = 1 }}
            materials.gel = {{ density = 1000, neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }} }}
            [space]
            dimension = "plane-strain"
            interior = "grid"
            cell = 0.1
            domain = {{ min = [{}, -1], max = [1, 2]{face} }}
            [[bodies]]
            name = "block"
            material = "gel"
            shape.box = {{ min = [{low}, 0.03], max = [0.5, 0.43] }}
            [[supports]]
            body = "block"
            on = "y_min"
            within.box = {{ min = [-0.3, -1], max = [0.3, 1] }}
            [[loads]]
            body = "block"
            pressure = "3 kPa"
            "#,
            if half { 0.0 } else { -1.0 },
        )
    };
    let run = |half: bool| {
        let mut simulation = start(&text(half));
        for _ in 0..100 {
            simulation.step(1e-3).expect("it runs");
        }
        let all = simulation.snapshot();
        let mut places: Vec<_> = all
            .position
            .iter()
            .zip(&all.velocity)
            .filter(|(x, _)| x[0] > 0.0)
            .map(|(x, v)| (*x, *v))
            .collect();
        places.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        (places, simulation.loads())
    };
    let ((half, half_loads), (whole, whole_loads)) = (run(true), run(false));
    assert_eq!(half.len(), whole.len());
    let of = |all: &[([f64; 3], [f64; 3])]| {
        (all.iter().map(|p| p.0).collect::<Vec<_>>(), all.iter().map(|p| p.1).collect::<Vec<_>>())
    };
    let ((x, v), (x_whole, v_whole)) = (of(&half), of(&whole));
    let apart = [largest_difference(&x, &x_whole), largest_difference(&v, &v_whole)];
    assert!(apart[0] < 1e-10 && apart[1] < 1e-8, "{apart:?}");
    for (half, whole) in half_loads.iter().zip(&whole_loads) {
        assert!((2.0 * half.impulse[1] / whole.impulse[1] - 1.0).abs() < 1e-8, "{half:?} {whole:?}");
        assert!((2.0 * half.work - whole.work).abs() < 1e-8 * whole.work.abs(), "{half:?} {whole:?}");
    }
}
