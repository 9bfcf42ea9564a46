//! Gravity that varies in time moves bodies as Newton says, and its work is in the ledger.
//!
//! Source: v = integral of g; a constant gravity written as a formula is the same gravity.
//!
//! Set-up: a block that deforms and a free rigid one, apart from each other, in the plane and in space, under gravity
//! that grows for a tenth of a second, by a formula and by a table; once more with a constant one, as a number and as a
//! formula; the looking for rest of a block on a fixed face under gravity that grows.
//!
//! Expected: velocities to 1e-10, as steps take the mean of gravity and end where the growth does; the works of a
//! gravity that may vary are what a constant one takes of the potential energy, to half a step of 2000: the places to
//! which that belongs are those half a step later; the ledger of works closes to 1e-10; a run that relaxes does not end
//! while gravity grows.

use crate::trial::{RUBBER, run_to, start};
use stickslip::door::Ledger;

/// Two blocks apart.
fn blocks(dimension: &str, gravity: &str) -> String {
    let [a, b, c, d] = match dimension {
        "3d" => ["[0, 0, 0]", "[0.2, 0.2, 0.2]", "[0.5, 0, 0]", "[0.7, 0.2, 0.2]"],
        _ => ["[0, 0]", "[0.2, 0.2]", "[0.5, 0]", "[0.7, 0.2]"],
    };
    format!(
        r#"
        gravity = {gravity}
        time = {{ end = 0.2, max_step = 1e-4 }}
        {RUBBER}
        [space]
        dimension = "{dimension}"
        cell = 0.1
        [[bodies]]
        name = "soft"
        material = "rubber"
        shape.box = {{ min = {a}, max = {b} }}
        [[bodies]]
        name = "hard"
        material = "rubber"
        shape.box = {{ min = {c}, max = {d} }}
        rigid.free = {{}}
        "#
    )
}

fn fall(dimension: &str, gravity: &str) -> ([f64; 2], Ledger) {
    let mut simulation = start(&blocks(dimension, gravity));
    run_to(&mut *simulation, 0.2, |_| {});
    let bodies = simulation.bodies();
    ([0, 1].map(|body| bodies[body].velocity[1]), simulation.ledger())
}

#[test]
fn gravity_that_grows_gives_its_integral_and_its_work() {
    for (dimension, gravity) in [
        ("plane-strain", "[0, '-10 m/s^2 * min(t / 0.1 s, 1)']"),
        ("3d", "[0, { table = [['0 s', 0], ['100 ms', '-10 m/s^2']] }, 0]"),
    ] {
        let (velocities, ledger) = fall(dimension, &gravity.replace('\'', "\""));
        println!("{dimension}: {velocities:?}, {ledger:?}");
        for velocity in velocities {
            assert!((velocity / -1.5 - 1.0).abs() < 1e-10, "{velocities:?}");
        }
        assert!(ledger.potential == 0.0 && ledger.external_work > 0.0, "{ledger:?}");
        assert!(ledger.total.abs() < 1e-10 * ledger.external_work, "{ledger:?}");
    }
}

#[test]
fn works_of_gravity_are_what_potential_energy_loses() {
    let number = start(&blocks("plane-strain", "[3, -5]")).ledger();
    let (_, by_number) = fall("plane-strain", "[3, -5]");
    let (_, by_formula) = fall("plane-strain", "[3, '-5 - 0 * t']".replace('\'', "\"").as_str());
    let lost = number.potential - by_number.potential;
    println!("potential energy lost {lost}, work {}", by_formula.external_work);
    assert!((by_formula.external_work / lost - 1.0).abs() < 1.1 / 2000.0, "{by_formula:?} {by_number:?}");
    assert!(by_formula.total.abs() < 1e-10 * lost, "{by_formula:?}");
    assert!((by_number.total - number.potential).abs() < 1.1 / 2000.0 * lost, "{by_number:?}");
}

#[test]
fn rest_is_not_found_while_gravity_grows() {
    let text = |gravity: &str| {
        format!(
            r#"
            gravity = [0, "{gravity}"]
            time = {{ end = 0.5, relax = {{ residual = 1e-2 }} }}
            {RUBBER}
            [space]
            dimension = "plane-strain"
            interior = "grid"
            cell = 0.05
            domain = {{ min = [-0.2, 0], max = [0.4, 0.4], y_min = "fixed" }}
            [[bodies]]
            name = "block"
            material = "rubber"
            shape.box = {{ min = [0, 0], max = [0.2, 0.2] }}
            "#
        )
    };
    let rest_at = |gravity: &str| {
        let (mut simulation, mut rest) = (start(&text(gravity)), None);
        run_to(&mut *simulation, 0.5, |simulation| {
            if rest.is_none() && simulation.relaxation().is_some_and(|state| state.at_rest) {
                rest = Some(simulation.time());
            }
        });
        rest.expect("the block comes to rest")
    };
    let (at_once, grown) = (rest_at("-10"), rest_at("-10 * min(t / 0.3, 1)"));
    println!("at rest at {at_once} s, and {grown} s");
    assert!(at_once < 0.25 && grown >= 0.3, "{at_once} {grown}");
}
