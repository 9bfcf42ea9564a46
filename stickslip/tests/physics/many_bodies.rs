//! A thousand bodies simply work.
//!
//! Set-up: 1,000 small disks in a close packing (12 particles each and more), every one a body of its own, thrown
//! together so that they touch their neighbours; 50 steps. The same with 4,000.
//!
//! Expected: momentum constant to 1e-10 of what one half of the disks carries; contacts only between neighbours, at
//! most twelve a disk, its first and second ring. The time for four times the bodies is printed, and near four times as
//! long: nothing is quadratic. It is not asserted, because a test cannot know what else the machine does.
//!
//! A hundred thousand disks of one table are read, checked and filled with particles in seconds, of 1.9 million
//! particles in 0.5 s, 3.9 s and 3.6 s on two cores of an EPYC that had other work. Asserted is a minute, which a
//! machine that does much else keeps, and which what is quadratic does not.

use crate::trial::{distance, start, take_steps};
use std::fmt::Write;
use std::time::Instant;
use stickslip::door::ContactCursor;
use stickslip::{check, scene, step};

/// `columns` x `rows` disks of radius 1, half of them flying up and half of them down.
fn packing(columns: usize, rows: usize) -> String {
    let mut text = String::from(
        r#"
        space = { dimension = "plane-strain", interior = "grid", cell = 0.8 }
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
fn a_hundred_thousand_are_ready_in_seconds() {
    let text = r#"
        space = { dimension = "plane-strain", interior = "grid", cell = 0.8 }
        time.end = 1
        gravity = [0, -1]
        materials.rubber = { density = 1, neo_hookean = { young_modulus = 100, poisson_ratio = 0.3 } }
        contact = [{ friction = 0.3 }]
        [[bodies]]
        name = "disk"
        material = "rubber"
        shape.ball = { center = [0, 0], radius = 1 }
        array.square = { spacing = 2.02, counts = [400, 250] }
        "#;
    let begin = Instant::now();
    let scene = scene::parse("many.toml", text, &[]).expect("it is sound").scene;
    let read = begin.elapsed().as_secs_f64();
    let report = check::report(&scene).expect("nothing overlaps");
    let checked = begin.elapsed().as_secs_f64() - read;
    let simulation = step::build(&scene).expect("it fits");
    let all = begin.elapsed().as_secs_f64();
    let filled = all - checked - read;
    println!(
        "{} particles: read in {read:.1} s, checked in {checked:.1} s, filled in {filled:.1} s",
        simulation.particles()
    );
    assert_eq!((report.bodies.len(), simulation.bodies().len()), (100_000, 100_000));
    assert!(simulation.particles() > 300_000);
    assert!(all < 60.0, "{all:.1} s");
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
