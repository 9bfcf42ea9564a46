//! Several bodies on grids of their own as one: glue between them, and cells of several sizes.
//!
//! Source: of glue, that a body which is cut in two and glued is one body; of cells, what every collision keeps.
//!
//! Set-up: a bar of 16 by 4 cells that swings along its length and across, whole and cut in the middle, in the plane
//! and in space; two disks that meet off centre with friction, with cells of one size and of another half as large.
//!
//! Expected: along its length the cut bar swings as one that is half a cell longer, for so the layer of the glue
//! yields: with 1 + 1/32 of the period within 0.5 %; across within 5 % of the whole one. It keeps its energy within 1
//! %, and momentum to round-off. Disks keep momentum and spin to round-off and energy with what friction took within 1
//! %, in steps of the finer cells.

use crate::trial::{RUBBER, run_to, start};
use std::f64::consts::PI;
use stickslip::door::Simulation;

/// Mean period of the bar over five, and the energy that is left.
fn period(dimension: &str, mode: &str, cut: bool) -> [f64; 2] {
    let (third, depth) = if dimension == "3d" { (", 0", ", 0.4") } else { ("", "") };
    // The first mode of a free bar across: about a cosine with nodes 0.224 L from its ends.
    let velocity = match mode {
        "along" => "\"0.1 m/s * cos(pi * x / 1.6 m)\", 0".to_string(),
        _ => "0, \"0.1 m/s * (cos(2 * pi * (x - 0.8 m) / 2.2 m) - 0.33)\"".to_string(),
    };
    let part = |name: &str, from: f64, to: f64| {
        format!(
            "[[bodies]]\nname = '{name}'\nmaterial = 'rubber'\nvelocity = [{velocity}{third}]\n\
             shape.box = {{ min = [{from}, 0{third}], max = [{to}, 0.4{depth}] }}\n"
        )
    };
    let bodies = if cut { part("left", 0.0, 0.8) + &part("right", 0.8, 1.6) } else { part("bar", 0.0, 1.6) };
    let text = format!(
        "space = {{ dimension = '{dimension}', cell = 0.1, interior = 'reference' }}\ntime.end = 10\n{RUBBER}\n\
         {bodies}[[contact]]\nlaw = 'glued'\n"
    );
    let mut simulation = start(&text);
    let begun = simulation.ledger();
    // How much of the mode is in the velocities: higher ones do not count.
    let axis = usize::from(mode != "along");
    let shape = |x: f64| match mode {
        "along" => (PI * x / 1.6).cos(),
        _ => (2.0 * PI * (x - 0.8) / 2.2).cos() - 0.33,
    };
    let swing = |simulation: &dyn Simulation| -> f64 {
        let of = |body: usize| {
            let [starts, velocities] = ["start", "velocity"]
                .map(|name| simulation.column(body, name).expect("every particle has it").by_number::<3>());
            let all = starts.into_iter().zip(velocities);
            all.map(|(start, velocity)| shape(start[0]) * velocity[axis]).sum::<f64>()
        };
        (0..if cut { 2 } else { 1 }).map(of).sum()
    };
    let (mut passed, mut before) = (Vec::new(), (0.0, 0.0));
    while passed.len() < 6 {
        simulation.step(f64::INFINITY).expect("a step");
        let now = (simulation.time(), swing(&*simulation));
        if before.1 < 0.0 && now.1 >= 0.0 {
            passed.push(before.0 - before.1 * (now.0 - before.0) / (now.1 - before.1));
        }
        before = now;
    }
    let now = simulation.ledger();
    let mass = 1000.0 * 1.6 * 0.4 * if dimension == "3d" { 0.4 } else { 1.0 };
    let off = (0..3).map(|k| (now.momentum[k] - begun.momentum[k]).abs()).fold(0.0, f64::max);
    assert!(off < 1e-11 * mass * 0.1, "{dimension} {mode}: {off:e}");
    [(passed[5] - passed[0]) / 5.0, now.total / begun.total]
}

#[test]
fn a_bar_that_is_cut_and_glued_swings_like_a_whole_one() {
    for (dimension, mode) in [("plane-strain", "along"), ("plane-strain", "across"), ("3d", "along")] {
        let [whole, cut] = [false, true].map(|cut| period(dimension, mode, cut));
        println!(
            "{dimension} {mode}: {:.4} of the period, energy {:.5} {:.5}",
            cut[0] / whole[0],
            cut[1],
            whole[1]
        );
        let [expected, within] = if mode == "along" { [1.0 + 0.5 / 16.0, 0.005] } else { [1.025, 0.025] };
        assert!((cut[0] / whole[0] - expected).abs() < within, "{dimension} {mode}: {cut:?} {whole:?}");
        assert!((cut[1] - 1.0).abs() < 0.01, "{dimension} {mode}: {cut:?} {whole:?}");
    }
}

#[test]
fn disks_with_cells_of_their_own_keep_momentum_spin_and_energy() {
    let speed = 1.5;
    let step = |cells: [f64; 2]| {
        let disk = |name: &str, x: f64, y: f64, u: f64, cell: f64| {
            format!(
                "[[bodies]]\nname = '{name}'\nmaterial = 'rubber'\ncell = {cell}\nvelocity = [{u}, 0]\n\
                 shape.ball = {{ center = [{x}, {y}], radius = 1 }}\n"
            )
        };
        let bodies = disk("a", -1.01, -0.4, speed, cells[0]) + &disk("b", 1.01, 0.4, -speed, cells[1]);
        let mut simulation = start(&format!(
            "space = {{ dimension = 'plane-strain', cell = 0.125 }}\ntime.end = 1\n{RUBBER}\n{bodies}\
             [[contact]]\nfriction = 0.3\n"
        ));
        let (begun, step) = (simulation.ledger(), simulation.stable_step());
        run_to(&mut *simulation, 0.33, |_| ());
        let (now, bodies) = (simulation.ledger(), simulation.bodies());
        let scale = 1000.0 * PI * speed;
        assert!(bodies[0].velocity[0] < 0.0, "they have parted: {bodies:?}");
        let off = (0..2).map(|k| (now.momentum[k] - begun.momentum[k]).abs()).fold(0.0, f64::max);
        let turned = (now.angular_momentum[2] - begun.angular_momentum[2]).abs();
        let left = (now.kinetic + now.strain + now.friction) / begun.kinetic;
        println!("{cells:?}: momentum {:.1e}, spin {:.1e}, energy {left:.4}", off / scale, turned / scale);
        assert!(off < 1e-11 * scale && turned < 1e-9 * scale, "{cells:?}: {off} {turned}");
        assert!((left - 1.0).abs() < 0.01, "{cells:?}: {left}");
        step
    };
    let [coarse, mixed, fine] = [[0.125, 0.125], [0.125, 0.0625], [0.0625, 0.0625]].map(step);
    assert!(
        (mixed / fine - 1.0).abs() < 1e-3 && (coarse / fine - 2.0).abs() < 0.01,
        "{coarse} {mixed} {fine}"
    );
}
