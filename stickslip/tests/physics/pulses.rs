//! What acts for less than a step acts by its mean, and steps end where something turns.
//!
//! Source: impulse = change of momentum; x = integral of v dt; thermal stress -3 K alpha T of what has no time to move.
//!
//! Set-up: a soft block of 10 kg in cells of 1 cm, whose steps are 100 us long, under pulses of 10 us at 25 times
//! against the steps, by a table, a formula that jumps and a smooth one, as a force, a pressure, gravity, the push of a
//! slider and the speed of a support; the path of rigid bodies by such pulses, and of one that jumps; a block between
//! mirrors that a pulse of 40 us heats.
//!
//! Expected: the impulse over the mass, of tables and jumps to 1e-9, of smooth pulses to 1e-8; paths to 1e-12 m; steps
//! that end at each row and jump to 1e-12 s; at the row where the pulse of heat is highest -3 K alpha T within 1 %.

use crate::trial::{STRESS_UPDATES, run_to, start};
use std::f64::consts::PI;

/// A block with more bodies, tables and settings of time.
fn block(time: &str, more: &str) -> String {
    format!(
        r#"
        time = {{ end = "3 ms", {time} }}
        [space]
        dimension = "plane-strain"
        interior = "grid"
        cell = "1 cm"
        [materials.soft]
        density = "1000 kg/m^3"
        thermal_expansion = 2e-5
        neo_hookean = {{ young_modulus = "1 MPa", poisson_ratio = 0.3 }}
        [[bodies]]
        name = "block"
        material = "soft"
        shape.box = {{ min = [0, 0], max = [0.1, 0.1] }}
        {more}
        "#
    )
}

/// When each of 25 pulses begins [s].
fn beginnings() -> impl Iterator<Item = f64> {
    (0..25).map(|i| 1e-3 + 7.3e-6 * f64::from(i))
}

/// A pulse of a peak for 10 us that begins at a time [s]: as a table of a triangle, as a formula that jumps, and
/// smooth; each with its integral and how near that is met.
fn pulses(peak: f64, at: f64) -> [(String, f64, f64); 3] {
    let end = at + 1e-5;
    let middle = at + 5e-6;
    [
        (
            format!("{{ table = [[0, 0], [{at:e}, 0], [{middle:e}, {peak}], [{end:e}, 0]] }}"),
            5e-6 * peak,
            1e-9,
        ),
        (format!("\"if(t > {at:e} s, if(t < {end:e} s, {peak}, 0), 0)\""), 1e-5 * peak, 1e-9),
        (format!("\"{peak} * exp(-((t - {middle:e} s) / 2 us)^2)\""), PI.sqrt() * 2e-6 * peak, 1e-8),
    ]
}

fn near(found: f64, exact: f64, tolerance: f64, what: &str) {
    assert!((found / exact - 1.0).abs() < tolerance, "{what}: {found} for {exact}");
}

#[test]
fn pulses_between_steps_give_their_impulse() {
    for at in beginnings() {
        for (pulse, impulse, tolerance) in pulses(1e5, at) {
            let load = format!("[[loads]]\nbody = \"block\"\non = \"volume\"\nforce = [{pulse}, 0]");
            let mut simulation = start(&block("", &load));
            run_to(&mut *simulation, 3e-3, |_| {});
            near(simulation.ledger().momentum[0], impulse, tolerance, &pulse);
            near(simulation.loads()[0].impulse[0], impulse, tolerance, &pulse);
        }
    }
    let (pulse, impulse, _) = pulses(1e5, 1.001e-3)[0].clone();
    for update in STRESS_UPDATES {
        let load = format!("[[loads]]\nbody = \"block\"\non = \"volume\"\nforce = [{pulse}, 0]");
        let mut simulation = start(&block(&format!("stress_update = \"{update}\""), &load));
        run_to(&mut *simulation, 3e-3, |_| {});
        near(simulation.ledger().momentum[0], impulse, 1e-9, update);
    }
}

#[test]
fn so_do_pulses_of_gravity_pressure_and_motors() {
    for at in beginnings().step_by(6) {
        for (pulse, impulse, tolerance) in pulses(1e5, at) {
            let mut simulation =
                start(&block("", "").replacen("time =", &format!("gravity = [{pulse}, 0]\ntime ="), 1));
            run_to(&mut *simulation, 3e-3, |_| {});
            let ledger = simulation.ledger();
            near(ledger.momentum[0], 10.0 * impulse, tolerance, &pulse);
            assert!((ledger.total / ledger.kinetic).abs() < 1e-9, "{ledger:?}");
            // On 10 cm, which strain by next to nothing before the pulse is over.
            let load = format!("[[loads]]\nbody = \"block\"\non = \"x_min\"\npressure = {pulse}");
            let mut simulation = start(&block("", &load));
            run_to(&mut *simulation, at + 1e-5, |_| {});
            near(simulation.ledger().momentum[0], 0.1 * impulse, 2e-3, &pulse);
            let slider = format!(
                "[[bodies]]\nname = \"sledge\"\nmaterial = \"soft\"\nrigid.free = {{}}\n\
                 shape.box = {{ min = [0.3, 0], max = [0.4, 0.1] }}\n\
                 [[joints]]\nbody = \"sledge\"\nslider = {{ axis = [1, 0], force = {pulse} }}"
            );
            let mut simulation = start(&block("", &slider));
            run_to(&mut *simulation, 3e-3, |_| {});
            near(simulation.bodies()[1].velocity[0], 0.1 * impulse, tolerance, &pulse);
        }
    }
}

/// Loads and gravity give a body on a grid of its own the same.
#[test]
fn so_do_pulses_on_a_grid_of_its_own() {
    let start_own = |text: String| start(&text.replacen("\"grid\"", "\"reference\"", 1));
    for at in beginnings().step_by(6) {
        for (pulse, impulse, tolerance) in pulses(1e5, at) {
            // Steps end within 1e-13 s of a jump, a hundred-millionth of a pulse.
            let tolerance = tolerance.max(1e-8);
            let load = format!("[[loads]]\nbody = \"block\"\non = \"volume\"\nforce = [{pulse}, 0]");
            let mut simulation = start_own(block("", &load));
            run_to(&mut *simulation, 3e-3, |_| {});
            near(simulation.ledger().momentum[0], impulse, tolerance, &pulse);
            near(simulation.loads()[0].impulse[0], impulse, tolerance, &pulse);
            let gravity = format!("gravity = [{pulse}, 0]\ntime =");
            let mut simulation = start_own(block("", "").replacen("time =", &gravity, 1));
            run_to(&mut *simulation, 3e-3, |_| {});
            near(simulation.ledger().momentum[0], 10.0 * impulse, tolerance, &pulse);
        }
    }
}

/// A body of prescribed velocity, one of prescribed spin, and a support go as far as they are told.
#[test]
fn prescribed_motion_goes_its_whole_way() {
    for at in beginnings().step_by(4) {
        for (pulse, way, tolerance) in pulses(5.0, at) {
            let more = format!(
                "[[supports]]\nbody = \"block\"\non = \"x_min\"\nvelocity = [{pulse}, 0]\n\
                 [[bodies]]\nname = \"pusher\"\nmaterial = \"soft\"\n\
                 shape.box = {{ min = [0.3, 0], max = [0.4, 0.1] }}\nrigid.velocity = [{pulse}, 0]\n\
                 [[bodies]]\nname = \"wheel\"\nmaterial = \"soft\"\n\
                 shape.ball = {{ center = [0.6, 0.05], radius = 0.05 }}\nrigid.spin = {pulse}"
            );
            let mut simulation = start(&block("", &more));
            let (mut end, mut looks) = (0.0, 0.0);
            run_to(&mut *simulation, 2e-3, |_| {});
            run_to(&mut *simulation, 3e-3, |simulation| {
                end += simulation.loads()[0].displacement[0];
                looks += 1.0;
            });
            let bodies = simulation.bodies();
            assert!(
                (bodies[1].position[0] - 0.35 - way).abs() < tolerance * way + 1e-12,
                "{pulse}: {bodies:?}"
            );
            let turn = simulation.poses()[2].expect("it is rigid").orientation.0;
            near(turn[1][0].atan2(turn[0][0]), way, tolerance.max(1e-7), &pulse);
            // The end of the block rings about where the support is.
            println!("{pulse}: the end is at {:.3} of its way", end / looks / way);
            near(end / looks, way, 0.2, &pulse);
        }
    }
}

#[test]
fn steps_end_at_rows_and_jumps() {
    let load = r#"
        [[loads]]
        body = "block"
        on = "volume"
        force = [{ table = [[0, 0], ["0.7 ms", 10], ["0.72 ms", 0]] }, "if(t > 1.234 ms, if(sin(2000 * pi * t) > 0, 5, 1), 0)"]
    "#;
    let mut simulation = start(&block("", load));
    let (mut ends, mut last) = (Vec::new(), 0.0);
    run_to(&mut *simulation, 3e-3, |simulation| {
        let time = simulation.time();
        assert!(time - last > 5e-6, "a step of {} s", time - last);
        last = time;
        ends.push(time);
    });
    for turn in [0.7e-3, 0.72e-3, 1.234e-3, 1.5e-3, 2e-3, 2.5e-3] {
        assert!(ends.iter().any(|end| (end - turn).abs() < 1e-12), "{turn}: {ends:?}");
    }
    let usual = simulation.stable_step();
    assert!((ends.len() as f64) < 3e-3 / usual + 14.0, "{} steps of {usual} s", ends.len());
}

/// No step is short enough for a jump of a displacement: it is taken in one of a thousandth of the usual length at
/// least, before which steps are no shorter, so at most a thousand more than usual lead there.
#[test]
fn a_rigid_body_that_jumps_neither_stops_nor_stalls_the_run() {
    for jump in [0.02, 0.1, 1.0, 1e3] {
        let more = format!(
            "[[bodies]]\nname = \"pusher\"\nmaterial = \"soft\"\n\
             shape.box = {{ min = [0.3, 0], max = [0.4, 0.1] }}\n\
             rigid.displacement = [\"if(t < 1.234 ms, 0, {jump} m)\", 0]"
        );
        let mut simulation = start(&block("", &more));
        let mut steps = 0;
        run_to(&mut *simulation, 3e-3, |_| steps += 1);
        assert!(steps < 1100, "{jump} m: {steps} steps");
        near(simulation.bodies()[1].position[0] - 0.35, jump, 1e-12, "way");
    }
}

#[test]
fn a_pulse_of_heat_is_seen() {
    let load = r#"
        [[loads]]
        body = "block"
        temperature = { table = [[0, 0], ["1.001 ms", 0], ["1.021 ms", 50], ["1.041 ms", 0]] }
    "#;
    let text = block("", load).replace(
        "cell = \"1 cm\"",
        "cell = \"1 cm\"\ndomain = { min = [0, 0], max = [0.1, 0.1], x_min = \"symmetry\", x_max = \"symmetry\", \
         y_min = \"symmetry\", y_max = \"symmetry\" }",
    );
    let mut simulation = start(&text);
    let mut peak = 0.0_f64;
    run_to(&mut *simulation, 3e-3, |simulation| {
        let stress = &simulation.snapshot().stress;
        peak = stress.iter().map(|stress| stress[0]).fold(peak, f64::min);
    });
    // 3 K = E / (1 - 2 nu)
    near(peak, -1e6 / 0.4 * 1e-3, 0.01, "stress at the row of the peak");
}
