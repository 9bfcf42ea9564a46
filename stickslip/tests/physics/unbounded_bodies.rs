//! Rigid bodies without bounds do what bounded ones with the same face do.
//!
//! Source: contact sees a body no further than shape functions reach. Set-ups: a disk or a ball that slides and rolls
//! far along a floor; a block on a belt without end; a punch that rises and turns. The face of the block stands where
//! that of the half-space stands, and so do the particles at it.
//!
//! Expected: the same motion but for round-off, 1e-9 of the way and of the speed; particles of the half-space follow
//! the bodies on it, not the domain. Steps have one length: the fastest particle limits it, and a wide block that turns
//! has faster ones. That a rigid floor is the limit of a stiff one is the benchmark `rigid`; with this,
//! so is a rigid half-space.

use crate::trial::{RUBBER, distance, run_to, start};
use stickslip::door::Simulation;

/// Asserts that the first body moves alike against both shapes: position and velocity over the run,
/// relative to its way and its largest speed.
fn assert_alike(what: &str, of: impl Fn(&str) -> Box<dyn Simulation>, shapes: [&str; 2], end: f64) {
    let paths = shapes.map(|shape| {
        let mut path = Vec::new();
        let mut simulation = of(shape);
        run_to(&mut *simulation, end, |s| path.push(s.bodies()[0].clone()));
        path
    });
    let [a, b] = &paths;
    assert_eq!(a.len(), b.len(), "the same steps");
    let way = distance(a[0].position, a[a.len() - 1].position);
    let speed = a.iter().map(|state| distance(state.velocity, [0.0; 3])).fold(0.0, f64::max);
    let largest = |off: &dyn Fn(usize) -> f64| (0..a.len()).map(off).fold(0.0, f64::max);
    let found = [
        largest(&|i| distance(a[i].position, b[i].position)) / way,
        largest(&|i| distance(a[i].velocity, b[i].velocity)) / speed,
    ];
    println!("{what}: position off by {:.1e}, velocity by {:.1e}", found[0], found[1]);
    assert!(found.iter().all(|off| *off < 1e-9), "{what}: {found:?}");
}

#[test]
fn a_ball_rolls_on_a_half_space_as_on_a_block() {
    for (dimension, zero, extra) in [("plane-strain", "", ""), ("3d", ", 0", ", -0.8")] {
        let scene = |floor: &str| {
            start(&format!(
                r#"
                gravity = [7, -7{zero}]
                space = {{ dimension = "{dimension}", interior = "grid", cell = 0.2 }}
                time.end = 1
                {RUBBER}
                [[bodies]]
                name = "ball"
                material = "rubber"
                shape.ball = {{ center = [0, 0.5{zero}], radius = 0.4 }}
                velocity = [2, 0{zero}]
                [[bodies]]
                name = "floor"
                material = "rubber"
                shape = {floor}
                rigid = {{}}
                [[contact]]
                friction = 0.4
                "#
            ))
        };
        let half_space = format!("{{ half_space = {{ point = [0, 0{zero}], normal = [0, 1{zero}] }} }}");
        let far = extra.replace('-', "");
        let block = format!("{{ box = {{ min = [-2, -1.2{extra}], max = [4, 0{far}] }} }}");
        assert_alike(dimension, scene, [&block, &half_space], 0.45);
    }
}

/// The belt runs 1.2 m under the block: material that was 12 cells away at the start.
#[test]
fn a_belt_without_end_drags_as_a_long_one() {
    let scene = |belt: &str| {
        start(&format!(
            r#"
            gravity = [0, -10]
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
            time = {{ end = 1, max_step = "0.5 ms" }}
            {RUBBER}
            [[bodies]]
            name = "block"
            material = "rubber"
            shape.box = {{ min = [-0.5, 0], max = [0.5, 0.3] }}
            [[bodies]]
            name = "belt"
            material = "rubber"
            shape = {belt}
            rigid = {{ velocity = [-4, 0] }}
            [[contact]]
            friction = 0.3
            "#
        ))
    };
    let long = "{ box = { min = [-2, -0.6], max = [4, 0] } }";
    let endless = "{ half_space = { point = [0, 0], normal = [0, 1] } }";
    assert_alike("belt", scene, [long, endless], 0.3);
}

/// A punch that rises and turns about a point a metre below its face. It meets a round body: next to an edge, round-off
/// decides which way a surface looks.
#[test]
fn a_face_that_rises_and_turns_does_what_that_of_a_block_does() {
    let scene = |punch: &str| {
        start(&format!(
            r#"
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
            time = {{ end = 1, max_step = "0.5 ms" }}
            {RUBBER}
            [[bodies]]
            name = "disk"
            material = "rubber"
            shape.ball = {{ center = [0.1, 0.45], radius = 0.4 }}
            [[bodies]]
            name = "punch"
            material = "rubber"
            shape = {punch}
            rigid = {{ velocity = [0, 3], spin = 2 }}
            [[contact]]
            friction = 0.2
            "#
        ))
    };
    let block = "{ box = { min = [-2, -2], max = [2, 0] } }";
    // It turns about the first of the shapes that make it up.
    let half_space = "{ union = [{ ball = { center = [0, -1], radius = 0.5 } }, { half_space = { point = [0, 0], normal = [0, 1] } }] }";
    assert_alike("punch", scene, [block, half_space], 0.15);
}

/// The layer of particles under one body in a domain of ten thousand cells and more.
#[test]
fn particles_follow_the_bodies_and_not_the_domain() {
    let count = |size: f64, x: f64| {
        let mut simulation = start(&format!(
            r#"
            space = {{ dimension = "3d", interior = "grid", cell = 0.1, domain = {{ min = [0, 0, -{size}], max = [{size}, {size}, {size}] }} }}
            time.end = 1
            {RUBBER}
            [[bodies]]
            name = "ball"
            material = "rubber"
            shape.ball = {{ center = [{x}, 2, 0.4], radius = 0.35 }}
            [[bodies]]
            name = "floor"
            material = "rubber"
            shape.half_space = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
            rigid = {{}}
            "#
        ));
        simulation.step(f64::INFINITY).expect("sound");
        let snapshot = simulation.snapshot();
        snapshot.body.iter().filter(|&&body| body == 1).count()
    };
    let (small, large) = (count(10.0, 2.0), count(10_000.0, 2.0));
    println!("particles of the half-space: {small} in 10 m, {large} in 10 km");
    assert!(small > 0 && small == large, "{small} {large}");
}
