//! Stacks of free rigid bodies stand.
//!
//! Set-up: towers of 50, 80 and 100 boxes, 0.2 m by 0.1 m, whose sides are flush, on a rigid floor; and a wall of 100
//! such bricks in ten courses, side by side without a gap, with friction.
//!
//! Expected: nothing moves, as every centre of mass lies above the middle of what bears it. Faces rest on each other
//! within 1e-5 of the distance between points of their surfaces, 1e-7 m here, so boxes may sink by that at each face;
//! kinetic energy is that of what sweeps leave over, 1e-6 of the speed that gravity gives in a step under the whole
//! load.

use crate::trial::{distance, run_to, start};
use stickslip::door::Simulation;

fn stack(bodies: &str) -> Box<dyn Simulation> {
    start(&format!(
        r#"
        gravity = [0, -9.81]
        space = {{ dimension = "plane-strain", cell = 0.02 }}
        time = {{ end = 3, max_step = 0.0018 }}
        materials.stone = {{ density = 2000, hypoelastic = {{ young_modulus = 1e7, poisson_ratio = 0.2 }} }}
        [[bodies]]
        name = "floor"
        material = "stone"
        rigid = {{}}
        shape.half_space = {{ point = [0, 0], normal = [0, 1] }}
        {bodies}
        material = "stone"
        rigid.free = {{}}
        [[contact]]
        friction = 0.5
        "#
    ))
}

/// Runs for 0.6 s; gives how far the body moved that moved most [m], and the kinetic energy then [J].
fn moved(simulation: &mut dyn Simulation) -> [f64; 2] {
    let begun = simulation.bodies();
    run_to(simulation, 0.6, |_| {});
    let after = simulation.bodies();
    let far = begun.iter().zip(&after).skip(1).map(|(a, b)| distance(a.position, b.position));
    let (far, ledger) = (far.fold(0.0, f64::max), simulation.ledger());
    println!("moved by {far:.1e} m, {:.1e} J, unsettled {}", ledger.kinetic, ledger.unsettled_nodes);
    [far, ledger.kinetic]
}

#[test]
fn towers_stand_whatever_their_height() {
    for count in [50_u8, 80, 100] {
        let mut tower = stack(&format!(
            r#"[[bodies]]
            name = "box {{i}}"
            repeat = {{ i = {count} }}
            shape.box = {{ min = [-0.1, "0.1 * i"], max = [0.1, "0.1 * (i + 1)"] }}"#
        ));
        let [far, kinetic] = moved(&mut *tower);
        assert!(far < 1e-7 * f64::from(count), "{count}: {far}");
        assert!(kinetic < 1e-6, "{count}: {kinetic}");
        // The first step begins without forces.
        assert!(tower.ledger().unsettled_nodes <= 1, "{count}");
    }
}

#[test]
fn a_wall_of_bricks_stands() {
    let mut wall = stack(
        r#"[[bodies]]
        name = "brick {i} {j}"
        repeat = { i = 10, j = 10 }
        shape.box = { min = ["0.2 * i + 0.1 * mod(j, 2)", "0.1 * j"], max = ["0.2 * i + 0.1 * mod(j, 2) + 0.2", "0.1 * (j + 1)"] }"#,
    );
    let [far, kinetic] = moved(&mut *wall);
    assert!(far < 10.0 * 1e-6, "{far}");
    assert!(kinetic < 1e-6, "{kinetic}");
}

/// A polygon that falls on another shape by a few centimetres and comes to rest there: where its centre is then [m].
fn landed(shape: &str, on: &str) -> [f64; 3] {
    let mut simulation = start(&format!(
        r#"
        gravity = [0, -9.81]
        space = {{ dimension = "plane-strain", cell = 0.05 }}
        time.end = 1
        materials.m = {{ density = 1000, neo_hookean = {{ young_modulus = 1e7, poisson_ratio = 0.3 }} }}
        contact = [{{ friction = 0.5 }}]
        [[bodies]]
        name = "floor"
        material = "m"
        rigid = {{}}
        shape.{on}
        [[bodies]]
        name = "stone"
        material = "m"
        rigid.free = {{}}
        shape.polygon = {{ points = {shape} }}
        "#
    ));
    run_to(&mut *simulation, 0.35, |_| {});
    simulation.bodies()[1].position
}

/// Corners of more than 160 degrees bear as well: a regular 24-gon (radius .5 m) rests on a side, a boat on its keel of
/// 169 degrees, and a triangle with its side on a bump of as many.
#[test]
fn blunt_corners_bear() {
    let gon: Vec<String> = (0..24)
        .map(|i| (std::f64::consts::TAU * (f64::from(i) + 0.5) / 24.0).sin_cos())
        .map(|(sin, cos)| format!("[{}, {}]", 0.5 * sin, 0.6 - 0.5 * cos))
        .rev()
        .collect();
    let floor = "box = { min = [-3, -1], max = [3, 0] }";
    let side = landed(&format!("[{}]", gon.join(", ")), floor);
    assert!((side[1] - 0.5 * (std::f64::consts::PI / 24.0).cos()).abs() < 1e-3, "{side:?}");
    let ground = "half_space = { point = [0, 0], normal = [0, 1] }";
    let boat = [[0.0, 0.01], [1.0, 0.11], [1.0, 0.5], [-1.0, 0.5], [-1.0, 0.11]];
    let keel = landed(&format!("{boat:?}"), ground);
    // Its centre by the areas of a rectangle of 2 m by .39 m and of a triangle of 2 m by .1 m under it.
    let (rectangle, triangle) = (2.0 * 0.39, 0.1);
    let centre = (rectangle * 0.305 + triangle * (0.11 - 0.1 / 3.0)) / (rectangle + triangle);
    assert!((keel[1] - (centre - 0.01)).abs() < 1e-3, "{keel:?} {centre}");
    let bump = "polygon = { points = [[-2, -1], [2, -1], [2, 0], [0, 0.2], [-2, 0]] }";
    let triangle = landed("[[-1, 0.3], [1, 0.3], [0, 1]]", bump);
    assert!((triangle[1] - (0.2 + 0.7 / 3.0)).abs() < 1e-3, "{triangle:?}");
}
