//! A thousand bodies simply work.
//!
//! Set-up: 1,000 small disks in a close packing (12 particles each and more), every one a body of its own, thrown
//! together so that they touch their neighbours; 50 steps. The same with 4,000.
//!
//! Expected: momentum constant to 1e-10 of what one half of the disks carries; contacts only between neighbours, at
//! most twelve a disk, its first and second ring. The time for four times the bodies is printed, and near four times as
//! long: nothing is quadratic. It is not asserted, because a test cannot know what else the machine does.

use crate::trial::{distance, start, take_steps};
use std::fmt::Write;
use std::time::Instant;
use stickslip::door::ContactCursor;

/// `columns` x `rows` disks of radius 1, half of them flying up and half of them down.
fn packing(columns: usize, rows: usize) -> String {
    let mut text = String::from(
        r#"
        space = { dimension = "plane-strain", cell = 0.8 }
        time.end = 1
        gravity = [0, -1]
        materials.rubber = { density = 1, neo_hookean = { young_modulus = 100, poisson_ratio = 0.3 } }
        "#,
    );
    for row in 0..rows {
        for column in 0..columns {
            let x = 2.02 * column as f64 + if row % 2 == 0 { 0.0 } else { 1.01 };
            let y = 1.75 * row as f64;
            let v = if row < rows / 2 { 1 } else { -1 };
            writeln!(
                text,
                "[[bodies]]\nname = \"{row}-{column}\"\nmaterial = \"rubber\"\nshape.ball = {{ center = [{x}, {y}], radius = 1 }}\nvelocity = [0, {v}]"
            )
            .expect("a string takes all text");
        }
    }
    text + "[[contact]]\nfriction = 0.3\n"
}

#[test]
fn a_thousand_and_four_thousand() {
    let mut seconds = Vec::new();
    for (columns, rows) in [(40, 25), (80, 50)] {
        let text = packing(columns, rows);
        let begin = Instant::now();
        let mut simulation = start(&text);
        let built = begin.elapsed().as_secs_f64();
        let (before, begin) = (simulation.ledger(), Instant::now());
        take_steps(&mut *simulation, 50);
        let stepped = begin.elapsed().as_secs_f64();
        let (after, contacts) = (simulation.ledger(), ContactCursor::default().read(&*simulation));
        let bodies = columns * rows;
        let mass = simulation.bodies().iter().map(|body| body.mass).sum::<f64>();
        let expected = [0.0, before.momentum[1] - mass * simulation.time(), 0.0];
        let momentum = distance(after.momentum, expected) / (0.5 * mass);
        println!(
            "{bodies} bodies, {} particles: built in {built:.2} s, {:.2} ms a step, {} pairs in contact, momentum {momentum:.1e}",
            simulation.particles(),
            stepped / 50.0 * 1e3,
            contacts.len()
        );
        assert!(momentum < 1e-10, "momentum {momentum:e}");
        assert!(contacts.len() > columns, "the halves meet: {} pairs", contacts.len());
        assert!(contacts.len() <= 6 * bodies, "{} pairs of {bodies} bodies", contacts.len());
        seconds.push((built, stepped));
    }
    println!(
        "four times the bodies: {:.1} times as long to build, {:.1} to step",
        seconds[1].0 / seconds[0].0,
        seconds[1].1 / seconds[0].1
    );
}
