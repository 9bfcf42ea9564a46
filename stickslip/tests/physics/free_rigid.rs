//! Free rigid bodies move as mechanics says, alone, on joints and in contact.
//!
//! Source: rigid-body mechanics. Period of a physical pendulum of amplitude a: T = 4 sqrt(I / (m g s)) K(sin(a/2)), with
//! the complete elliptic integral K by the arithmetic-geometric mean.
//!
//! Set-up: rods, disks and balls that are rigid and free; hinges, sliders, planar joints, balls, welds and springs between them and the
//! ground; contact with blocks of rubber and with stiff floors, in the plane and in space.
//!
//! Expected: the period within 1e-4; joints that hold to 1e-9 of the size and do not drift; momentum and angular
//! momentum with a body that deforms to round-off; the energy of a free mechanism within 1e-4; accelerations down and
//! up slopes within 0.5 % and 1 %; works of motors within 1e-3 of the energies; a body a thousand times lighter than
//! what it strikes leaves as it should; the same bits for any number of threads and from a saved state.

use crate::trial::{distance, run_to, start, take_steps};
use rayon::ThreadPoolBuilder;
use std::f64::consts::PI;
use stickslip::door::{BodyState, Simulation};

const STEEL: &str =
    "materials.steel = { density = 7800, neo_hookean = { young_modulus = 2e11, poisson_ratio = 0.3 } }";
const GEL: &str =
    "materials.gel = { density = 1000, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }";

/// K(k) by the arithmetic-geometric mean.
fn elliptic(k: f64) -> f64 {
    let (mut a, mut b) = (1.0_f64, (1.0 - k * k).sqrt());
    while (a - b).abs() > 1e-15 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    PI / (a + b)
}

fn pendulum(end: f64) -> String {
    format!(
        r#"
        gravity = [0, -9.81]
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
        time = {{ end = {end}, max_step = 5e-4 }}
        {STEEL}
        [[bodies]]
        name = "rod"
        material = "steel"
        rigid.free = {{}}
        [bodies.shape.rotated]
        center = [0, 0]
        angle = 1
        shape.box = {{ min = [-0.1, -1], max = [0.1, 0] }}
        [[joints]]
        body = "rod"
        hinge.point = [0, 0]
        "#
    )
}

#[test]
fn a_pendulum_swings_with_its_period_and_keeps_its_energy() {
    let mut simulation = start(&pendulum(40.0));
    // I about the hinge over m s: (0.2^2 + 1)/12 + 1/4, over 1/2.
    let inertia = ((0.04 + 1.0) / 12.0 + 0.25) / 0.5;
    let period = 4.0 * (inertia / 9.81_f64).sqrt() * elliptic((0.5_f64).sin());
    let energy = simulation.ledger().total;
    let (mut crossings, mut before) = (Vec::new(), simulation.joints()[0].way);
    let (mut time, mut swing, mut loosest) = (0.0, 0.0_f64, 0.0_f64);
    run_to(&mut *simulation, 40.0, |s| {
        // The angle from the start is -1 where the rod hangs.
        let now = s.joints()[0].way + 1.0;
        if before > 0.0 && now <= 0.0 {
            crossings.push(time + (s.time() - time) * before / (before - now));
        }
        (before, time) = (now, s.time());
        let ledger = s.ledger();
        swing = swing.max((ledger.total / energy - 1.0).abs());
        let center = s.bodies()[0].position;
        loosest = loosest.max((distance(center, [0.0; 3]) - 0.5).abs());
    });
    let found = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64;
    println!(
        "period {found:.6} s, off {:.1e} over {} swings; energy within {swing:.1e}, hinge within {loosest:.1e} m",
        found / period - 1.0,
        crossings.len()
    );
    assert!((found / period - 1.0).abs() < 1e-4, "{found} {period}");
    assert!(crossings.len() > 15 && loosest < 1e-9);
    // Positions and velocities are half a step apart.
    assert!(swing < 5e-3, "{swing}");
    let after = simulation.ledger().total;
    assert!((after / energy - 1.0).abs() < 5e-3, "{after} {energy}");
}

/// A brick on a hinge askew to its axes, a ball joint, and a weld, in space: nothing parts, and what turns keeps its
/// energy.
#[test]
fn a_mechanism_in_space_holds_together() {
    let scene = format!(
        r#"
        gravity = [0, 0, -9.81]
        space = {{ dimension = "3d", interior = "grid", cell = 0.1 }}
        time = {{ end = 4, max_step = 5e-4 }}
        {STEEL}
        [[bodies]]
        name = "crank"
        material = "steel"
        shape.box = {{ min = [0, -0.1, -0.1], max = [0.6, 0.1, 0.1] }}
        rigid.free = {{}}
        [[bodies]]
        name = "arm"
        material = "steel"
        shape.box = {{ min = [0.6, -0.1, -0.1], max = [0.8, 0.1, 0.7] }}
        rigid.free = {{}}
        [[bodies]]
        name = "bob"
        material = "steel"
        shape.ball = {{ center = [1.1, 0, 0.7], radius = 0.15 }}
        rigid.free = {{}}
        [[joints]]
        name = "bearing"
        body = "crank"
        hinge = {{ point = [0, 0, 0], axis = [0.3, 1, 0.2] }}
        [[joints]]
        name = "socket"
        body = "arm"
        to = "crank"
        ball.point = [0.6, 0, 0]
        [[joints]]
        name = "glue"
        body = "bob"
        to = "arm"
        weld = {{}}
        "#
    );
    let mut simulation = start(&scene);
    let (energy, before) = (simulation.ledger(), simulation.bodies());
    let apart = distance(before[1].position, before[2].position);
    let (mut loosest, mut swing, mut fastest) = (0.0_f64, 0.0_f64, 0.0_f64);
    run_to(&mut *simulation, 4.0, |s| {
        let bodies = s.bodies();
        loosest = loosest.max((distance(bodies[0].position, [0.0; 3]) - 0.3).abs());
        loosest = loosest.max((distance(bodies[1].position, bodies[2].position) - apart).abs());
        let ledger = s.ledger();
        fastest = fastest.max(ledger.kinetic);
        swing = swing.max((ledger.total - energy.total).abs());
    });
    println!(
        "joints within {loosest:.1e} m, energy within {:.1e} of the largest kinetic one",
        swing / fastest
    );
    assert!(loosest < 1e-8 && swing < 5e-3 * fastest && fastest > 100.0, "{loosest} {swing} {fastest}");
}

/// A rigid disk that spins flies into a block of gel in empty space, off its middle: what one gets, the other loses.
#[test]
fn momentum_is_exchanged_with_a_body_that_deforms() {
    for law in ["surface", "gap", "traction", "glued"] {
        for update in ["first", "last", "modified-last"] {
            let scene = format!(
                r#"
                space = {{ dimension = "plane-strain", interior = "grid", cell = 0.025 }}
                time = {{ end = 2, stress_update = "{update}" }}
                {GEL}
                [[bodies]]
                name = "disk"
                material = "gel"
                shape.ball = {{ center = [-0.26, 0.3], radius = 0.25 }}
                velocity = [0.2, 0]
                spin = 0.5
                rigid.free = {{}}
                [[bodies]]
                name = "block"
                material = "gel"
                shape.box = {{ min = [0, 0], max = [0.5, 0.5] }}
                [[contact]]
                law = "{law}"
                normal = "common"
                friction = 0.4
                "#
            );
            let mut simulation = start(&scene);
            let before = simulation.ledger();
            run_to(&mut *simulation, 0.3, |_| {});
            let (after, bodies) = (simulation.ledger(), simulation.bodies());
            let lost = distance(before.momentum, after.momentum) / before.momentum[0];
            let turned = (after.angular_momentum[2] - before.angular_momentum[2]).abs()
                / before.angular_momentum[2].abs();
            let drift = (after.total - before.total) / before.kinetic;
            println!("{law}, {update}: momentum {lost:.1e}, angular {turned:.1e}, energy {drift:.1e}");
            assert!(lost < 1e-12, "{law}, {update}: {lost}");
            assert!(bodies[1].velocity[0] > 0.01, "{law}, {update}: it was not hit: {bodies:?}");
            if law == "surface" {
                assert!(turned < 1e-4 && (-0.04..0.0).contains(&drift), "{update}: {turned} {drift}");
            }
        }
    }
}

/// A disk a thousand times lighter than the nodes that it strikes, and one a thousand times heavier: contact stays
/// calm, and a light one leaves no faster than it came.
#[test]
fn light_and_heavy_bodies_are_struck_alike() {
    for mass in [1e-2, 1e5] {
        let scene = format!(
            r#"
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.05 }}
            time.end = 0.2
            {GEL}
            [[bodies]]
            name = "disk"
            material = "gel"
            shape.ball = {{ center = [-0.26, 0.25], radius = 0.25 }}
            velocity = [1, 0]
            rigid.free.mass = {mass}
            [[bodies]]
            name = "block"
            material = "gel"
            shape.box = {{ min = [0, 0], max = [0.5, 0.5] }}
            "#
        );
        let mut simulation = start(&scene);
        let before = simulation.ledger();
        run_to(&mut *simulation, 0.06, |_| {});
        let (after, bodies) = (simulation.ledger(), simulation.bodies());
        let speed = bodies[0].velocity[0];
        println!("mass {mass}: speed {speed:.4} m/s, {} nodes unsettled", after.unsettled_nodes);
        assert_eq!(after.unsettled_nodes, 0);
        assert!(distance(before.momentum, after.momentum) < 1e-11 * before.momentum[0]);
        let wanted = if mass < 1.0 { -1.0..0.01 } else { 0.99..1.0 };
        assert!(wanted.contains(&speed), "mass {mass}: {speed}");
    }
}

fn rolling(update: &str) -> String {
    format!(
        r#"
        gravity = ["9.81 * sin(0.3)", "-9.81 * cos(0.3)"]
        [space]
        dimension = "plane-strain"
        interior = "grid"
        cell = 0.05
        domain = {{ min = [-1, -1], max = [5, 3], y_min = "fixed" }}
        [time]
        end = 1
        stress_update = "{update}"
        [materials]
        stone = {{ density = 1000, neo_hookean = {{ young_modulus = 2e7, poisson_ratio = 0.2 }} }}
        [[bodies]]
        name = "floor"
        material = "stone"
        shape.box = {{ min = [-1, -1], max = [5, 0] }}
        [[bodies]]
        name = "disk"
        material = "stone"
        shape.ball = {{ center = [0, 0.8], radius = 0.8 }}
        rigid.free = {{}}
        [[contact]]
        friction = 0.6
        "#
    )
}

/// A rigid disk rolls down a slope with 2/3 of g sin(theta). The floor gives way by 2 mm under it, in a patch that is
/// narrower than a cell, so the disk hops a little from node to node and slips where it does.
#[test]
fn a_rigid_disk_rolls_on_a_floor_that_deforms() {
    let mut simulation = start(&rolling("modified-last"));
    let (mut turned, mut time) = (0.0, 0.0);
    run_to(&mut *simulation, 1.0, |view| {
        turned -= view.bodies()[1].spin[2] * (view.time() - time);
        time = view.time();
    });
    let rolled = simulation.bodies()[1].position[0];
    let exact = 0.5 * (2.0 / 3.0) * 9.81 * 0.3_f64.sin();
    println!("rolled {rolled:.5} m, exact {exact:.5} m; turned {:.5} m", turned * 0.8);
    assert!((rolled / exact - 1.0).abs() < 5e-3, "{rolled} {exact}");
    assert!((turned * 0.8 / rolled - 1.0).abs() < 0.06, "{turned} {rolled}");
}

/// A motor on an axle drives a carriage on a slider; its work is the energy that both have.
#[test]
fn motors_do_the_work_that_bodies_gain() {
    let scene = format!(
        r#"
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
        gravity = [0, -9.81]
        time = {{ end = 2, max_step = 1e-4 }}
        {GEL}
        [[bodies]]
        name = "carriage"
        material = "gel"
        shape.box = {{ min = [-0.5, -0.2], max = [0.5, 0.2] }}
        rigid.free = {{}}
        [[bodies]]
        name = "wheel"
        material = "gel"
        shape.ball = {{ center = [0, 0.7], radius = 0.4 }}
        rigid.free = {{}}
        [[joints]]
        name = "rail"
        body = "carriage"
        slider = {{ axis = [3, 4], force = "5 kN", dashpot = "10 N s/m" }}
        [[joints]]
        name = "motor"
        body = "wheel"
        to = "carriage"
        hinge = {{ point = [0, 0.7], torque = "30 N m" }}
        [[joints]]
        name = "brake"
        body = "wheel"
        to = "carriage"
        hinge = {{ point = [0, 0.7], speed = "20 rad/s", limit = "10 N m" }}
        "#
    );
    let mut simulation = start(&scene);
    let before = simulation.ledger();
    run_to(&mut *simulation, 1.5, |_| {});
    let (after, bodies, joints) = (simulation.ledger(), simulation.bodies(), simulation.joints());
    let drift = (after.total - before.total) / after.kinetic;
    let [mass, wheel] = [bodies[0].mass, bodies[1].mass];
    // The carriage and the wheel along the rail: m a = F - c v - m g 4/5.
    let (m, rate) = (mass + wheel, 10.0 / (mass + wheel));
    let steady = (5000.0 - m * 9.81 * 0.8) / 10.0;
    let exact = steady * (1.0 - (-rate * 1.5_f64).exp());
    let speed = bodies[0].velocity[0] * 0.6 + bodies[0].velocity[1] * 0.8;
    // The wheel: the torque and the brake's limit, until it reaches its speed.
    let spin = (40.0 * 1.5 / (0.5 * wheel * 0.16)).min(20.0);
    println!(
        "speed {speed:.5} m/s ({exact:.5}), spin {:.4} ({spin:.4}), drift {drift:.1e}, {joints:?}",
        bodies[1].spin[2]
    );
    assert!((speed / exact - 1.0).abs() < 2e-3, "{speed} {exact}");
    assert!((bodies[1].spin[2] / spin - 1.0).abs() < 2e-3);
    assert!(bodies[0].spin[2].abs() < 1e-9 && drift.abs() < 1e-3, "{drift}");
    let off = bodies[0].position[0] * 0.8 - bodies[0].position[1] * 0.6;
    assert!(off.abs() < 1e-9, "the carriage left its rail by {off} m");
}

/// Two masses on a spring swing with sqrt(k / m*), and a dashpot damps them.
#[test]
fn a_spring_between_bodies_has_its_period() {
    let scene = format!(
        r#"
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
        time = {{ end = 4, max_step = 1e-4 }}
        {GEL}
        [[bodies]]
        name = "left"
        material = "gel"
        shape.box = {{ min = [-0.7, -0.1], max = [-0.5, 0.1] }}
        rigid.free.mass = 3
        [[bodies]]
        name = "right"
        material = "gel"
        shape.box = {{ min = [0.5, -0.1], max = [0.7, 0.1] }}
        rigid.free.mass = 1
        [[joints]]
        body = "right"
        to = "left"
        spring = {{ from = [0.5, 0], to = [-0.5, 0], stiffness = 75, length = 0.8 }}
        "#
    );
    let mut simulation = start(&scene);
    let period = 2.0 * PI * (0.75_f64 / 75.0).sqrt();
    run_to(&mut *simulation, 3.25 * period, |_| {});
    let joint = simulation.joints()[0];
    println!("a quarter past three periods: {:.6} m of -0.2 m, rate {:.4} m/s", joint.way, joint.speed);
    assert!((joint.way + 0.2).abs() < 2e-3, "{joint:?}");
    let momentum = simulation.ledger().momentum[0];
    assert!(momentum.abs() < 1e-12, "{momentum}");
}

/// The same bits on one, two and five threads, with the workspace dropped, and from a saved state.
#[test]
fn results_depend_on_no_thread_and_on_no_pause() {
    let outcome = |threads: usize, take: fn(&mut dyn Simulation)| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
        pool.install(|| {
            let mut simulation = start(&rolling("last"));
            take(&mut *simulation);
            format!("{:?} {:?} {:?}", simulation.snapshot(), simulation.bodies(), simulation.ledger())
        })
    };
    let plain = |simulation: &mut dyn Simulation| take_steps(simulation, 60);
    let one = outcome(1, plain);
    for threads in [2, 5] {
        assert!(outcome(threads, plain) == one, "{threads} threads differ from one");
    }
    let paused = |simulation: &mut dyn Simulation| {
        for step in 0..60 {
            if step % 17 == 3 {
                let saved = simulation.save().expect("the engine can be saved");
                take_steps(simulation, 3);
                simulation.restore(saved).expect("it is its own state");
            }
            if step % 13 == 5 {
                simulation.rebuild_workspace();
            }
            take_steps(simulation, 1);
        }
    };
    assert!(outcome(1, paused) == one, "a saved state takes other steps");
}

fn rigid_scene(dimension: &str, gravity: &str, [end, step]: [f64; 2], rest: &str) -> String {
    format!(
        r#"
        space = {{ dimension = "{dimension}", interior = "grid", cell = 0.1 }}
        gravity = {gravity}
        time = {{ end = {end}, max_step = {step} }}
        {GEL}
        {rest}
        "#
    )
}

/// B1 and B2 for a rigid ball on a rigid slope: it rolls with 5/7 g sin(theta) where friction lets it, else it slides
/// with g (sin(theta) - mu cos(theta)) and its spin grows with 5/2 mu g cos(theta) / R.
#[test]
fn a_rigid_ball_rolls_and_slides_down_a_rigid_slope() {
    let theta = 0.5_f64;
    for (friction, dimension) in [(0.5, "3d"), (0.1, "3d"), (0.5, "plane-strain"), (0.05, "plane-strain")] {
        let (third, place) = if dimension == "3d" { (", 0", "[0, 0.3, 0]") } else { ("", "[0, 0.3]") };
        let gravity = format!("[{}, {}{third}]", 9.81 * theta.sin(), -9.81 * theta.cos());
        let rest = format!(
            r#"
            bodies = [
                {{ name = "slope", material = "gel", rigid = {{}},
                   shape.half_space = {{ point = [0, 0{third}], normal = [0, 1{third}] }} }},
                {{ name = "ball", material = "gel", rigid = {{ free = {{}} }},
                   shape.ball = {{ center = {place}, radius = 0.3 }} }},
            ]
            contact = [{{ friction = {friction} }}]
            "#
        );
        let mut simulation = start(&rigid_scene(dimension, &gravity, [1.0, 1e-3], &rest));
        let before = simulation.ledger();
        run_to(&mut *simulation, 1.0, |_| {});
        let (after, ball) = (simulation.ledger(), simulation.bodies()[1].clone());
        let share = if dimension == "3d" { 0.4 } else { 0.5 };
        let (sin, cos) = (theta.sin(), theta.cos());
        let rolls = friction * cos * (1.0 + share) >= share * sin;
        let (pull, turning) = match rolls {
            true => (sin / (1.0 + share), sin / (1.0 + share)),
            false => (sin - friction * cos, friction * cos / share),
        };
        let [speed, rolled] = [ball.velocity[0] / (9.81 * pull), -ball.spin[2] * 0.3 / (9.81 * turning)];
        let drift = (after.total - before.total) / after.kinetic;
        println!(
            "{dimension}, mu = {friction}: v {speed:.8}, w R {rolled:.8} of the exact ones, drift {drift:.1e}, off {:.1e} m",
            ball.position[1] - 0.3
        );
        assert!((speed - 1.0).abs() < 1e-6 && (rolled - 1.0).abs() < 1e-6);
        assert!((ball.position[1] - 0.3).abs() < 1e-9 && drift.abs() < 3e-3);
        assert!((ball.position[0] / (0.5 * 9.81 * pull) - 1.0).abs() < 2e-3);
    }
}

/// Two free bodies in oblique impact: momentum to round-off, and where they touch they part along the normal with the
/// restitution of the rule, that many times the speed at which they met, within what two steps move the normal.
#[test]
fn rigid_bodies_bounce_with_the_restitution_of_their_rule() {
    for (dimension, shape) in [
        ("plane-strain", "box = { min = [1, -0.2], max = [1.5, 0.4] }"),
        ("3d", "box = { min = [1, -0.2, -0.3], max = [1.5, 0.4, 0.2] }"),
        ("3d", "ball = { center = [1.2, 0.1, -0.05], radius = 0.25 }"),
    ] {
        for restitution in [0.0, 0.6, 1.0] {
            let third = if dimension == "3d" { ", 0" } else { "" };
            let rest = format!(
                r#"
                bodies = [
                    {{ name = "ball", material = "gel", rigid = {{ free = {{}} }}, velocity = [2, 0.1{third}],
                       shape.ball = {{ center = [0, 0{third}], radius = 0.3 }} }},
                    {{ name = "other", material = "gel", rigid = {{ free = {{}} }}, velocity = [-1, 0{third}],
                       shape.{shape} }},
                ]
                contact = [{{ restitution = {restitution}, friction = 0.2 }}]
                "#
            );
            let mut simulation =
                start(&rigid_scene(dimension, &format!("[0, 0{third}]"), [0.6, 1e-3], &rest));
            let before = simulation.ledger();
            let mut sums = Vec::new();
            let (mut met, mut after_steps) = (simulation.bodies(), 0);
            let mut parted = f64::NAN;
            run_to(&mut *simulation, 0.6, |view| {
                sums = view.contact_sums();
                match sums.iter().any(|sum| sum.magnitude > 0.0) {
                    false => met = view.bodies(),
                    true => after_steps += 1,
                }
                // In the first step they come together, and part from the second on.
                if after_steps == 2 {
                    parted = parting(&met, &view.bodies(), shape.starts_with("ball"));
                }
            });
            let after = simulation.ledger();
            let lost = distance(before.momentum, after.momentum) / before.momentum[0];
            let turned = distance(before.angular_momentum, after.angular_momentum) / before.momentum[0];
            let drift = (after.total - before.total) / before.kinetic;
            let kept = (after.kinetic + after.friction) / before.kinetic;
            println!(
                "{shape}, e = {restitution}: parted with {parted:.6}, momentum {lost:.1e}, angular {turned:.1e}, energy kept {kept:.10}, drift {drift:.1e}, {:?}",
                sums[0].impulse
            );
            assert!(lost < 1e-13 && turned < 1e-3 && drift.abs() < 1e-6);
            assert!(sums[0].magnitude > 1.0);
            assert!((parted - restitution).abs() < 1e-3, "{shape}, e = {restitution}: {parted}");
            match restitution {
                1.0 => assert!((kept - 1.0).abs() < 1e-6),
                _ => assert!(after.damping > 0.01 * before.kinetic),
            }
        }
    }
}

/// The speed at which a ball of 0.3 m and another body part over that at which they met, along the normal where they
/// touch: between the centres of two balls, else along x.
fn parting(before: &[BodyState], after: &[BodyState], balls: bool) -> f64 {
    let centers = [0, 1].map(|i| before[i].position);
    let apart = distance(centers[0], centers[1]);
    let normal: [f64; 3] = match balls {
        true => std::array::from_fn(|k| (centers[1][k] - centers[0][k]) / apart),
        false => [1.0, 0.0, 0.0],
    };
    let place: [f64; 3] = std::array::from_fn(|k| centers[0][k] + 0.3 * normal[k]);
    let approach = |bodies: &[BodyState]| {
        let speed = |i: usize| {
            let (w, arm): (_, [f64; 3]) = (bodies[i].spin, std::array::from_fn(|k| place[k] - centers[i][k]));
            let turning = |k: usize| w[(k + 1) % 3] * arm[(k + 2) % 3] - w[(k + 2) % 3] * arm[(k + 1) % 3];
            (0..3).map(|k| (bodies[i].velocity[k] + turning(k)) * normal[k]).sum::<f64>()
        };
        speed(0) - speed(1)
    };
    -approach(after) / approach(before)
}

/// Balls that hit a wall straight on come back with exactly e times their speed, and one that bounces on a floor without
/// loss comes back to its height for hundreds of times.
#[test]
fn a_ball_bounces_as_high_as_it_should() {
    for restitution in [1.0, 0.5] {
        let rest = format!(
            r#"
            bodies = [
                {{ name = "floor", material = "gel", rigid = {{}},
                   shape.half_space = {{ point = [0, 0], normal = [0, 1] }} }},
                {{ name = "ball", material = "gel", rigid = {{ free = {{}} }},
                   shape.ball = {{ center = [0, 1.3], radius = 0.3 }} }},
            ]
            contact = [{{ restitution = {restitution} }}]
            "#
        );
        let mut simulation = start(&rigid_scene("plane-strain", "[0, -9.81]", [200.0, 1e-3], &rest));
        let (mut highest, mut second) = (0.0_f64, 0.0_f64);
        let period = 2.0 * (2.0_f64 / 9.81).sqrt();
        let end = if restitution == 1.0 { 100.0 * period } else { 5.0 };
        run_to(&mut *simulation, end, |view| {
            let height = view.bodies()[1].position[1] - 0.3;
            if view.time() > end - 1.01 * period {
                highest = highest.max(height);
            }
            if view.time() > 0.55 * period && view.time() < 0.95 * period {
                second = second.max(height);
            }
            assert!(height > -1e-9, "{height} at {}", view.time());
        });
        println!("e = {restitution}: {highest:.6} m high at the end, {second:.6} m after one bounce");
        match restitution {
            1.0 => assert!((highest - 1.0).abs() < 5e-3),
            _ => assert!((second - 0.25).abs() < 5e-3 && highest < 1e-6),
        }
    }
}

/// A box slides on a slope and stops where friction says, a stack of boxes stands still, and a box that is tipped past
/// its edge falls.
#[test]
fn boxes_slide_stand_and_tip() {
    let boxes = |gravity: &str, more: &str| {
        let rest = format!(
            r#"
            bodies = [
                {{ name = "floor", material = "gel", rigid = {{}},
                   shape.half_space = {{ point = [0, 0, 0], normal = [0, 1, 0] }} }},
                {more}
            ]
            contact = [{{ friction = 0.3 }}]
            "#
        );
        rigid_scene("3d", gravity, [2.0, 1e-3], &rest)
    };
    let cube = |name: &str, y: f64, velocity: f64| {
        format!(
            "{{ name = \"{name}\", material = \"gel\", rigid = {{ free = {{}} }}, velocity = [{velocity}, 0, 0],
               shape.box = {{ min = [0, {y}, 0], max = [0.4, {}, 0.4] }} }},",
            y + 0.4
        )
    };
    // v^2 / (2 mu g)
    let mut simulation = start(&boxes("[0, -9.81, 0]", &cube("cube", 0.0, 2.0)));
    run_to(&mut *simulation, 1.0, |_| {});
    let slid = simulation.bodies()[1].position[0] - 0.2;
    let exact = 4.0 / (2.0 * 0.3 * 9.81);
    println!("slid {slid:.5} m, exact {exact:.5} m, turned {:?}", simulation.bodies()[1].spin);
    assert!((slid / exact - 1.0).abs() < 3e-3);
    // Three on each other, on a slope that friction holds.
    let stack: String = (0..3).map(|i| cube(&format!("cube {i}"), 0.4 * f64::from(i), 0.0)).collect();
    let mut simulation = start(&boxes("[1.5, -9.7, 0.5]", &stack));
    run_to(&mut *simulation, 0.3, |_| {});
    let bodies = simulation.bodies();
    println!("the stack: {:?}, unsettled {}", bodies[3].position, simulation.ledger().unsettled_nodes);
    for (i, body) in bodies[1..].iter().enumerate() {
        let start = [0.2, 0.2 + 0.4 * i as f64, 0.2];
        assert!(distance(body.position, start) < 1e-6, "{body:?}");
    }
    assert_eq!(simulation.ledger().unsettled_nodes, 0);
    // Four are higher than their base is wide on the slope: the top one leaves first.
    let higher = stack + &cube("cube 3", 1.2, 0.0);
    let mut simulation = start(&boxes("[2.8, -9.4, 0]", &higher));
    run_to(&mut *simulation, 0.5, |_| {});
    let (moved, spin) = (simulation.bodies()[4].position[0] - 0.2, simulation.bodies()[4].spin[2]);
    println!(
        "the steep stack: {moved:.4} m, spin {spin:.4} rad/s, unsettled {}",
        simulation.ledger().unsettled_nodes
    );
    assert!(moved > 0.02 && spin < -0.02);
}

/// Motors and prescribed motion by tables: the momentum of a sledge is the area under its force's table, a wheel has the
/// speed of its motor's table, and a plate has gone as far as the area under its velocity's.
#[test]
fn motors_and_prescribed_motion_follow_tables() {
    let scene = format!(
        r#"
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
        time = {{ end = 2, max_step = 1e-3 }}
        {GEL}
        [[bodies]]
        name = "sledge"
        material = "gel"
        shape.box = {{ min = [0, 0], max = [1, 1] }}
        rigid.free.mass = 40
        [[bodies]]
        name = "wheel"
        material = "gel"
        shape.ball = {{ center = [0, 5], radius = 0.5 }}
        rigid.free = {{}}
        [[bodies]]
        name = "plate"
        material = "gel"
        shape.box = {{ min = [-5, 8], max = [5, 9] }}
        rigid = {{ velocity = [0, {{ table = [[0, 0], ["1 s", "2 m/s"], [1.5, 0]] }}], spin = {{ table = [[0, 1], [1, 3]] }} }}
        [[joints]]
        body = "sledge"
        slider = {{ axis = [1, 0], force = {{ table = [["0.5 s", 0], ["1 s", "80 N/m"], ["1.25 s", 0]] }} }}
        [[joints]]
        body = "wheel"
        hinge = {{ point = [0, 5], speed = {{ table = [[0, 0], [1, "4 rad/s"], [2, "-4 rad/s"]] }} }}
        "#
    );
    let mut simulation = start(&scene);
    for (time, speed, spin) in [(0.5, 0.0, 2.0), (1.0, 0.5, 4.0), (1.75, 0.75, -2.0)] {
        run_to(&mut *simulation, time, |_| {});
        let bodies = simulation.bodies();
        assert!((bodies[0].velocity[0] - speed).abs() < 1e-5, "{time} s: {:?}", bodies[0].velocity);
        assert!((bodies[1].spin[2] - spin).abs() < 0.01, "{time} s: {:?}", bodies[1].spin);
    }
    let plate = simulation.bodies()[2].clone();
    assert!((plate.position[1] - 8.5 - 1.5).abs() < 2e-3, "{:?}", plate.position);
    assert!((plate.spin[2] - 3.0).abs() < 1e-4, "{:?}", plate.spin);
}

/// A planar joint in space leaves a body in its plane: on a plane that is tilted by the angle a a block slides with
/// g sin(a) down it, whatever else pushes it, and turns about the normal as a moment there wants. What holds it bears
/// m g cos(a).
#[test]
fn a_planar_joint_leaves_a_plane_and_the_turning_in_it() {
    let angle: f64 = 0.4;
    let (sine, cosine) = angle.sin_cos();
    let scene = format!(
        r#"
        gravity = [0, 0, -10]
        space = {{ dimension = "3d", interior = "grid", cell = 0.1 }}
        time = {{ end = 1, max_step = 1e-3 }}
        {STEEL}
        [[bodies]]
        name = "puck"
        material = "steel"
        shape.cylinder = {{ start = [0, 0, -0.1], end = [0, 0, 0.1], radius = 0.3 }}
        velocity = [0, 0.5, 0]
        rigid.free = {{ mass = 2, inertia = [0.1, 0.1, 0.2] }}
        [[joints]]
        name = "ice"
        body = "puck"
        planar = {{ normal = [{sine}, 0, {cosine}], torque = "0.3 N m" }}
        "#
    );
    let mut simulation = start(&scene);
    let normal = [sine, 0.0, cosine];
    let along = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
    let mut loosest = 0.0_f64;
    run_to(&mut *simulation, 1.0, |s| loosest = loosest.max(along(s.bodies()[0].position, normal).abs()));
    let (puck, joint) = (simulation.bodies()[0].clone(), simulation.joints()[0]);
    let down = along(puck.position, [cosine, 0.0, -sine]);
    println!("out of the plane by {loosest:.1e} m, down it {down:.6} m, turned {:.6} rad", joint.way);
    assert!(loosest < 1e-9, "{loosest}");
    // From rest along the slope, and at 0.5 m/s across it.
    // Within the first order of the step: 1e-3 of a second.
    assert!((down / (0.5 * 10.0 * sine) - 1.0).abs() < 2e-3, "{down}");
    assert!((puck.position[1] - 0.5).abs() < 1e-9, "{:?}", puck.position);
    // The moment of inertia about the normal, which the body's axes are not.
    let inertia = 0.1 * sine * sine + 0.2 * cosine * cosine;
    assert!((joint.speed / (0.3 / inertia) - 1.0).abs() < 0.02, "{joint:?}");
    assert!((along(joint.impulse, normal) / (2.0 * 10.0 * cosine) - 1.0).abs() < 1e-3, "{joint:?}");
}

/// In the plane it drives a wheel that is free along x and y, and takes the moment itself: while a motor turns it the
/// wheel falls as a stone and flies on, and its moment is I dw/dt.
#[test]
fn a_planar_joint_in_the_plane_turns_a_wheel_that_is_free() {
    let scene = format!(
        r#"
        gravity = [0, -10]
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
        time = {{ end = 1, max_step = 1e-3 }}
        {STEEL}
        [[bodies]]
        name = "wheel"
        material = "steel"
        shape.ball = {{ center = [0, 0], radius = 0.5 }}
        velocity = [3, 0]
        rigid.free = {{ mass = 8, inertia = 1 }}
        [[joints]]
        name = "axle"
        body = "wheel"
        planar = {{ speed = "4 rad/s^2 * t" }}
        "#
    );
    let mut simulation = start(&scene);
    run_to(&mut *simulation, 1.0, |_| {});
    let (wheel, joint) = (simulation.bodies()[0].clone(), simulation.joints()[0]);
    println!("wheel at {:?}, spin {}, moment {}", wheel.position, wheel.spin[2], joint.moment[2]);
    assert!((wheel.position[0] - 3.0).abs() < 1e-9, "{:?}", wheel.position);
    assert!((wheel.position[1] + 5.0).abs() < 0.01, "{:?}", wheel.position);
    assert!((wheel.spin[2] - 4.0).abs() < 0.01, "{:?}", wheel.spin);
    assert!((joint.way - 2.0).abs() < 0.01 && (joint.moment[2] - 4.0).abs() < 0.01, "{joint:?}");
    assert!(joint.impulse.iter().all(|j| j.abs() < 1e-9), "{joint:?}");
}

/// The scene in the book: two wheels on axles carry a carriage up a slope, one of them driven by a motor.
#[test]
fn a_carriage_climbs_a_slope_by_its_motor() {
    let mut simulation = start(include_str!("../../../scenes/carriage.toml"));
    let before = simulation.ledger();
    run_to(&mut *simulation, 2.0, |_| {});
    let (after, bodies) = (simulation.ledger(), simulation.bodies());
    let slope = 11.31_f64.to_radians();
    let (mass, turning) = (500.0, 0.5 * 50.0 * 2.0);
    let exact = (600.0 / 0.3 - mass * 9.81 * slope.sin()) / (mass + turning);
    let found = bodies[3].velocity[0] / 2.0;
    let drift = (after.total - before.total) / after.external_work;
    println!("acceleration {found:.7} m/s^2, exact {exact:.7}; energy off by {drift:.1e} of the work");
    assert!((found / exact - 1.0).abs() < 1e-4 && drift.abs() < 1e-3, "{found} {exact} {drift}");
    assert!(bodies[3].spin[2].abs() < 1e-6, "the carriage reared up");
}

/// B2 for a rigid ball and a rigid disk: thrown along a level floor with backspin they slide until they roll, with
/// v = (v_0 - s w_0 R) / (1 + s), s = I / (m R^2).
#[test]
fn a_rigid_ball_with_backspin_slides_until_it_rolls() {
    for (dimension, share) in [("3d", 0.4), ("plane-strain", 0.5)] {
        let space = dimension == "3d";
        let third = if space { ", 0" } else { "" };
        let spin = if space { "[0, 0, 5]" } else { "5" };
        let rest = format!(
            r#"
            bodies = [
                {{ name = "floor", material = "gel", rigid = {{}},
                   shape.half_space = {{ point = [0, 0{third}], normal = [0, 1{third}] }} }},
                {{ name = "ball", material = "gel", rigid = {{ free = {{}} }}, velocity = [2, 0{third}], spin = {spin},
                   shape.ball = {{ center = [0, 0.3{third}], radius = 0.3 }} }},
            ]
            contact = [{{ friction = 0.3 }}]
            "#
        );
        let mut simulation =
            start(&rigid_scene(dimension, &format!("[0, -9.81{third}]"), [1.0, 1e-3], &rest));
        run_to(&mut *simulation, 1.0, |_| {});
        let ball = simulation.bodies()[1].clone();
        let (speed, pull) = ((2.0 - share * 1.5) / (1.0 + share), 0.3 * 9.81);
        let slides = (2.0 - speed) / pull;
        let way = 2.0 * slides - 0.5 * pull * slides * slides + speed * (1.0 - slides);
        println!("{dimension}: v {} ({speed}), x {} ({way})", ball.velocity[0], ball.position[0]);
        assert!((ball.velocity[0] / speed - 1.0).abs() < 1e-6, "{:?}", ball.velocity);
        assert!((-ball.spin[2] * 0.3 / speed - 1.0).abs() < 1e-6, "{:?}", ball.spin);
        assert!((ball.position[0] / way - 1.0).abs() < 2e-3, "{:?} {way}", ball.position);
    }
}

/// A hinge and a slider with a spring and a dashpot of their own: x = v_0/w e^(-c t/2) sin(w t), w^2 = k - c^2/4 of a
/// mass, or an inertia, of one.
#[test]
fn springs_and_dashpots_of_joints_have_their_swing() {
    for (joint, velocity) in
        [("hinge = { point = [0, 0]", "spin = 1"), ("slider = { axis = [1, 0]", "velocity = [1, 0]")]
    {
        let rest = format!(
            r#"
            [[bodies]]
            name = "wheel"
            material = "gel"
            shape.ball = {{ center = [0, 0], radius = 0.3 }}
            rigid.free = {{ mass = 1, inertia = 1 }}
            {velocity}
            [[joints]]
            body = "wheel"
            {joint}, stiffness = 9.8696044, dashpot = 0.2 }}
            "#
        );
        let mut simulation = start(&rigid_scene("plane-strain", "[0, 0]", [4.0, 1e-3], &rest));
        let turning = (9.8696044_f64 - 0.01).sqrt();
        let mut worst = 0.0_f64;
        run_to(&mut *simulation, 4.0, |view| {
            let time = view.time();
            let exact = (-0.1 * time).exp() * (turning * time).sin() / turning;
            worst = worst.max((view.joints()[0].way - exact).abs() * turning);
        });
        println!("{joint}: within {worst:.1e} of its swing");
        assert!(worst < 2e-3, "{joint}: {worst}");
    }
}

/// A plate on a slider holds a pressure: a block between it and a floor is strained as by that pressure, in the plane
/// with E / (1 - nu^2).
#[test]
fn a_plate_on_a_slider_holds_its_force() {
    let scene = format!(
        r#"
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
        time = {{ end = 2 }}
        {GEL}
        [[bodies]]
        name = "floor"
        material = "gel"
        shape.box = {{ min = [-0.3, -0.3], max = [1.1, 0] }}
        rigid = {{}}
        [[bodies]]
        name = "block"
        material = "gel"
        shape.box = {{ min = [0, 0], max = [0.8, 1.6] }}
        [[bodies]]
        name = "plate"
        material = "gel"
        shape.box = {{ min = [-0.3, 1.6], max = [1.1, 1.9] }}
        rigid.free = {{}}
        [[joints]]
        body = "plate"
        slider = {{ axis = [0, 1], force = "-16 kN * min(t / 0.5 s, 1)", dashpot = "40 kN s/m" }}
        "#
    );
    let mut simulation = start(&scene);
    run_to(&mut *simulation, 2.0, |_| {});
    let (plate, joint) = (simulation.bodies()[2].clone(), simulation.joints()[0]);
    // 20 kPa on 1 MPa / (1 - nu^2), finite strain aside.
    let exact = -1.6 * 20e3 * (1.0 - 0.09) / 1e6;
    println!("way {:.6} m for {exact:.6}, speed {:.1e} m/s", joint.way, plate.velocity[1]);
    assert!((joint.way / exact - 1.0).abs() < 0.03, "{joint:?}");
}
