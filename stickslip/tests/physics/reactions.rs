//! Reactions of the domain's faces and of rigid bodies.
//!
//! Source: balance of momentum; Hooke's law.
//!
//! Set-up: two blocks that fall on a fixed face, one of them on the mirror at its side; a square between two mirrors
//! under pressures; a block on a rigid plate off its middle, under its weight.
//!
//! Expected: what the fixed face gave is what gravity gave less the momentum, to round-off, for each body; mirrors bear
//! the pressures, within 1 %; the plate bears the weight, and its moment is that of the weight at its arm, within 1 %.

use crate::trial::{RUBBER, run_to, start, take_steps};
use stickslip::door::WallState;
use stickslip::observe::Results;
use stickslip::run::{RunOptions, run};
use stickslip::scene::parse;

fn on(walls: &[WallState], axis: usize, upper: bool, body: usize) -> WallState {
    let found = walls.iter().find(|wall| (wall.axis, wall.upper, wall.body) == (axis, upper, body));
    *found.unwrap_or_else(|| panic!("nothing on {axis} {upper} by {body}: {walls:?}"))
}

#[test]
fn a_fixed_face_gives_what_momentum_lacks() {
    for update in ["first", "last", "modified-last"] {
        let text = format!(
            r#"
            gravity = [0, -10]
            time = {{ end = 1, stress_update = "{update}" }}
            outputs.reactions = ["y_min", "x_min"]
            {RUBBER}
            [space]
            dimension = "plane-strain"
            interior = "grid"
            cell = 0.05
            domain = {{ min = [0, 0], max = [1, 1], y_min = "fixed", x_min = "symmetry" }}
            [[bodies]]
            name = "half"
            material = "rubber"
            shape.box = {{ min = [0, 0], max = [0.2, 0.3] }}
            velocity = [0, -0.5]
            [[bodies]]
            name = "whole"
            material = "rubber"
            shape.box = {{ min = [0.5, 0], max = [0.7, 0.3] }}
            velocity = [0.2, -0.5]
            "#
        );
        let mut simulation = start(&text);
        let begun = simulation.bodies();
        take_steps(&mut *simulation, 300);
        let (bodies, walls, time) = (simulation.bodies(), simulation.walls(), simulation.time());
        for body in 0..2 {
            let mass = bodies[body].mass;
            let gained = [0, 1].map(|i| mass * (bodies[body].velocity[i] - begun[body].velocity[i]));
            let floor = on(&walls, 1, false, body).impulse;
            let side = if body == 0 { on(&walls, 0, false, 0).impulse[0] } else { 0.0 };
            let off = [gained[0] + floor[0] + side, gained[1] + floor[1] + mass * 10.0 * time];
            println!("{update}, body {body}: floor {floor:?}, mirror {side:.3e}, off {off:.1?}");
            assert!(off.iter().all(|off| off.abs() < 1e-10 * floor[1].abs()), "{update} {body}: {off:?}");
        }
    }
}

#[test]
fn mirrors_bear_pressures() {
    let text = format!(
        r#"
        time.end = 0.2
        damping.local = 0.3
        outputs.reactions = ["x_min", "y_min"]
        {RUBBER}
        [space]
        dimension = "plane-strain"
        interior = "grid"
        cell = 0.05
        domain = {{ min = [0, 0], max = [1, 1], y_min = "symmetry", x_min = "symmetry" }}
        [[bodies]]
        name = "square"
        material = "rubber"
        shape.box = {{ min = [0, 0], max = [0.4, 0.4] }}
        [[loads]]
        body = "square"
        on = "x_max"
        pressure = "1 kPa"
        [[loads]]
        body = "square"
        on = "y_max"
        pressure = "2 kPa"
        "#
    );
    let mut simulation = start(&text);
    run_to(&mut *simulation, 0.15, |_| {});
    let before = simulation.walls();
    run_to(&mut *simulation, 0.2, |_| {});
    let after = simulation.walls();
    for (axis, exact) in [(0, -400.0), (1, -800.0)] {
        let force =
            (on(&after, axis, false, 0).impulse[axis] - on(&before, axis, false, 0).impulse[axis]) / 0.05;
        let moment = (on(&after, axis, false, 0).moment[2] - on(&before, axis, false, 0).moment[2]) / 0.05;
        // The middle of the face is at 0.5 m, and of the square at 0.2 m.
        let arm = moment / (exact * 0.3) * if axis == 0 { 1.0 } else { -1.0 };
        println!("mirror across {axis}: force {:.4}, arm {arm:.4}", force / exact);
        assert!((force / exact - 1.0).abs() < 0.01 && (arm - 1.0).abs() < 0.02, "{axis}: {force} {moment}");
    }
}

/// The rows of `reactions.csv` of a rigid body: its weight's reaction, and the moment of that about its own position.
#[test]
fn a_rigid_plate_bears_a_weight_off_its_middle() {
    let text = format!(
        r#"
        gravity = [0, "-10 * min(t / 0.1, 1)"]
        time.end = 0.4
        damping.local = 0.3
        outputs = {{ reactions = ["pl*"], tables = 0.1, particles = "never" }}
        {RUBBER}
        [space]
        dimension = "plane-strain"
        interior = "grid"
        cell = 0.05
        [[bodies]]
        name = "block"
        material = "rubber"
        shape.box = {{ min = [0.5, 0], max = [0.7, 0.2] }}
        [[bodies]]
        name = "plate"
        material = "rubber"
        shape.box = {{ min = [-1, -0.1], max = [1, 0] }}
        rigid = {{}}
        "#
    );
    let scene = parse("a.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    let folder = tempfile::tempdir().expect("a folder");
    let options = RunOptions::new(folder.path());
    run(&scene, &mut *start(&text), &options, &mut |_| {}).expect("the trial is sound");
    let rows = Results::open(folder.path()).and_then(|results| results.reactions_table()).expect("rows");
    let last = rows.last().expect("a row");
    println!("{last:?}");
    let weight = 1000.0 * 0.04 * 10.0;
    assert_eq!((rows.len(), last.reaction.as_str(), last.body.as_str()), (4, "plate", ""));
    assert!((last.force[1] / -weight - 1.0).abs() < 0.01 && last.force[0].abs() < 0.01 * weight, "{last:?}");
    // The block is 0.6 m beside the plate's middle.
    assert!((last.moment[2] / (-weight * 0.6) - 1.0).abs() < 0.01, "{last:?}");
}
