//! Two free bodies collide obliquely: momentum stays, and contact gains no energy.
//!
//! Source: conservation laws; set-up of Sulsky, Chen and Schreyer (1994), section 5.2: elastic disks of radius 0.2 in
//! the unit square at (.2, .2) and (.8, .8), v = +-(.1, .1), rho = 1000, E = 1000, nu = .3, plane strain, 20 x 20
//! cells. They touch at t = 1.58579. The oblique cases give the second disk an offset,
//! so that the bodies slide and turn.
//!
//! Expected: with one common normal, momentum constant to 1e-10 of one disk's (round-off); angular momentum within 2 %
//! of one disk's momentum times its radius without friction, and 6 % with it: the grid keeps it, but lumped mass gives
//! an impulse at a node back to particles that lie about 0.3 cells inside, so friction should lose some mu 0.3 h of
//! each disk's arm, an estimate (measured 0.9 % and 4.5 %). With the
//! traction rule and GIMP, energy (kinetic + strain + dissipated by friction) never above 1.001 of the start, with own
//! and with common normals, with and without friction; the same for the laws `surface` and `gap`. Rebound no faster
//! than approach (the kinematic rule gains a quarter of the energy, as the paper says). `surface` touches within 0.1
//! cells of travel of the exact time (measured 0.06), `gap` within half a cell (0.37). How much energy is left is
//! printed only: `surface` loses 10 % head on, `gap` 7 %, where the benchmark asks 1 %: nodes that meet collide
//! inelastically, and the loss shrinks with the cell (`surface`: 3.6 % at half, 1.3 % at a quarter).

use crate::trial::{distance, run_to, start, take_steps};
use stickslip::door::ContactCursor;

const RULES: [(&str, &str); 6] = [
    ("surface", "common"),
    ("gap", "common"),
    ("traction", "common"),
    ("traction", "own"),
    ("kinematic", "common"),
    ("kinematic", "own"),
];

struct Collision {
    /// Change of momentum over the momentum of one body at the start.
    momentum: f64,
    /// Change of angular momentum over momentum of one body times its radius.
    angular: f64,
    /// Largest energy over the energy of the start, less one.
    gain: f64,
    /// Energy at the end over the energy of the start, less one.
    rest: f64,
    /// Relative speed at the end over that of the start.
    restitution: f64,
    first_contact: f64,
}

fn collide(scene: &str, end: f64) -> Collision {
    let mut simulation = start(scene);
    let (before, bodies) = (simulation.ledger(), simulation.bodies());
    let momentum = bodies[0].mass * distance(bodies[0].velocity, [0.0; 3]);
    let approach = distance(bodies[0].velocity, bodies[1].velocity);
    let mut seen = Collision {
        momentum: 0.0,
        angular: 0.0,
        gain: 0.0,
        rest: 0.0,
        restitution: 0.0,
        first_contact: f64::INFINITY,
    };
    let mut cursor = ContactCursor::default();
    run_to(&mut *simulation, end, |s| {
        let now = s.ledger();
        seen.momentum = seen.momentum.max(distance(now.momentum, before.momentum) / momentum);
        let angular = distance(now.angular_momentum, before.angular_momentum);
        seen.angular = seen.angular.max(angular / (momentum * 0.2));
        seen.rest = (now.kinetic + now.strain + now.friction) / before.kinetic - 1.0;
        seen.gain = seen.gain.max(seen.rest);
        if !cursor.read(s).is_empty() {
            seen.first_contact = seen.first_contact.min(s.time());
        }
    });
    let bodies = simulation.bodies();
    seen.restitution = distance(bodies[0].velocity, bodies[1].velocity) / approach;
    seen
}

fn check(name: &str, (law, normal, friction): (&str, &str, f64), seen: &Collision) {
    println!(
        "{name}, {law} {normal}: momentum {:.1e}, angular {:.1e}, gain {:.1e}, at the end {:.4}, restitution {:.4}, first contact {:.4}",
        seen.momentum, seen.angular, seen.gain, seen.rest, seen.restitution, seen.first_contact
    );
    if normal == "common" {
        assert!(seen.momentum < 1e-10, "{name}, {law}: momentum {:e}", seen.momentum);
        let angular = if friction > 0.0 { 0.06 } else { 0.02 };
        assert!(seen.angular < angular, "{name}, {law}: angular momentum {:e}", seen.angular);
    }
    if law != "kinematic" {
        assert!(seen.gain < 1e-3, "{name}, {law} {normal}: gain {:e}", seen.gain);
    }
    assert!(seen.first_contact.is_finite(), "{name}, {law} {normal}: they meet");
}

fn disks(second: [f64; 2], (law, normal): (&str, &str), friction: f64) -> String {
    let [x, y] = second;
    format!(
        r#"
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.05 }}
        time.end = 3
        materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1000, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "first"
        material = "rubber"
        shape.ball = {{ center = [0.2, 0.2], radius = 0.2 }}
        velocity = [0.1, 0.1]
        [[bodies]]
        name = "second"
        material = "rubber"
        shape.ball = {{ center = [{x}, {y}], radius = 0.2 }}
        velocity = [-0.1, -0.1]
        [[contact]]
        law = "{law}"
        normal = "{normal}"
        friction = {friction}
        "#
    )
}

#[test]
fn head_on_disks() {
    for rule in RULES {
        let seen = collide(&disks([0.8, 0.8], rule, 0.0), 3.5);
        check("head on", (rule.0, rule.1, 0.0), &seen);
        let cells = match rule.0 {
            "surface" => 0.1,
            "gap" => 0.5,
            _ => f64::INFINITY,
        };
        let late = (seen.first_contact - 1.58579) * 0.2828 / 0.05;
        assert!(late.abs() < cells, "{rule:?}: {late} cells late");
        if rule.0 != "kinematic" {
            assert!(seen.restitution <= 1.0, "{rule:?}: {}", seen.restitution);
        }
    }
}

#[test]
fn oblique_disks() {
    for friction in [0.0, 0.3] {
        for rule in RULES {
            let seen = collide(&disks([0.95, 0.65], rule, friction), 3.5);
            check(&format!("oblique, friction {friction}"), (rule.0, rule.1, friction), &seen);
        }
    }
}

#[test]
fn oblique_balls() {
    for rule in RULES {
        let (law, normal) = rule;
        let scene = format!(
            r#"
            space = {{ dimension = "3d", interior = "grid", cell = 0.05 }}
            time.end = 3
            materials.rubber = {{ density = 1000, hypoelastic = {{ young_modulus = 1000, poisson_ratio = 0.3 }} }}
            [[bodies]]
            name = "first"
            material = "rubber"
            shape.ball = {{ center = [0, 0, 0], radius = 0.2 }}
            velocity = [0.1, 0, 0]
            [[bodies]]
            name = "second"
            material = "rubber"
            shape.ball = {{ center = [0.42, 0.13, 0.07], radius = 0.2 }}
            velocity = [-0.1, 0, 0]
            [[contact]]
            law = "{law}"
            normal = "{normal}"
            friction = 0.3
            "#
        );
        check("balls", (law, normal, 0.3), &collide(&scene, 1.5));
    }
}

/// Every law counts the impulses that it reduces, so that no cell strains by more than `max_strain`; `surface` does so
/// for the velocities that strain, whose impulses stand in no table. They are counted by pair as well.
#[test]
fn reduced_impulses_are_counted() {
    for rule in RULES {
        let reduced = |max_strain: f64| {
            let scene = format!("{}max_strain = {max_strain}\n", disks([0.6, 0.3], rule, 0.0));
            let mut simulation = start(&scene);
            take_steps(&mut *simulation, 20);
            let scaled = simulation.ledger().scaled_impulses;
            let sums = simulation.contact_sums();
            assert!(sums.iter().all(|sum| sum.reduced <= sum.pushes), "{rule:?}: {sums:?}");
            assert_eq!(sums.iter().map(|sum| sum.reduced).sum::<u64>(), scaled, "{rule:?}");
            scaled
        };
        let (never, often) = (reduced(1.0), reduced(1e-6));
        assert!(never < often, "{rule:?}: {never} at 1, {often} at 1e-6");
    }
}
