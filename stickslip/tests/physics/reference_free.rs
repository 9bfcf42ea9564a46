//! Bodies on grids of their own and free rigid ones.
//!
//! Source: each claim says its own. Set-up: rubber with interior = "reference" (wave speed 36.7 m/s), and rigid bodies
//! that forces move. Expected: momentum and spin to round-off, energy, weight, what a far stiffer body does that
//! deforms, and the same bits.

use crate::trial::{RUBBER, STRESS_UPDATES, run_to, same_bits, start};
use std::f64::consts::PI;
use stickslip::door::{ContactCursor, Simulation};

/// A scene of rubber with cells of this side [m].
fn scene(dimension: &str, cell: f64, rest: &str) -> String {
    format!(
        "space = {{ dimension = '{dimension}', cell = {cell}, interior = 'reference' }}\ntime.end = 1\n{RUBBER}\n{rest}"
    )
}

/// Young's modulus 1 MPa, Poisson's ratio 0.3, 1000 kg/m^3: M = E (1 - nu) / ((1 + nu) (1 - 2 nu)).
const WAVE: f64 = 36.689_968_6;

/// A floor that stays where it is.
const FLOOR: &str = "[[bodies]]\nname = 'floor'\nmaterial = 'rubber'\nrigid = {}\n\
                     shape.half_space = { point = [0, 0], normal = [0, 1] }\n";

fn body(name: &str, shape: &str, rest: &str) -> String {
    format!("[[bodies]]\nname = '{name}'\nmaterial = 'rubber'\nshape.{shape}\n{rest}\n")
}

/// Kinetic energy of all bodies, what they store, and what friction took [J].
fn energy(simulation: &dyn Simulation) -> f64 {
    let bodies: f64 = simulation.bodies().iter().map(|body| body.kinetic + body.strain).sum();
    bodies + simulation.ledger().friction
}

/// Momentum, and angular momentum about the origin.
fn momenta(simulation: &dyn Simulation) -> [f64; 6] {
    let mut sums = [0.0; 6];
    for body in simulation.bodies() {
        for k in 0..3 {
            sums[k] += body.mass * body.velocity[k];
            sums[3 + k] += body.angular_momentum[k];
        }
    }
    sums
}

/// A soft body hits a free rigid one off centre, and a free rigid one a soft one, with friction, in the plane and in
/// space: momentum and spin are kept to round-off by all stress updates, and so is energy with what friction took. What
/// the rigid body gained is what the contact gave.
#[test]
fn bodies_that_meet_off_centre_keep_momentum_spin_and_energy() {
    let speed = 0.04 * WAVE;
    let plane = ["ball = { center = [-1.02, 0.3], radius = 1 }", "box = { min = [0, -1], max = [1, 1] }"];
    let space =
        ["ball = { center = [-1.05, 0.3, 0.1], radius = 1 }", "box = { min = [0, -1, -1], max = [1, 1, 1] }"];
    let updates = STRESS_UPDATES.map(|update| ("plane-strain", 0.125, plane, update));
    for (dimension, cell, [ball, block], update) in
        updates.into_iter().chain([("3d", 0.25, space, STRESS_UPDATES[2])])
    {
        for free in [0, 1] {
            let motion = |number: usize, velocity: &str| match number == free {
                true => format!("rigid.free = {{}}\n{velocity}"),
                false => velocity.to_string(),
            };
            let velocity =
                if dimension == "3d" { format!("[{speed}, 0, 0]") } else { format!("[{speed}, 0]") };
            let rest = body("ball", ball, &motion(0, &format!("velocity = {velocity}")))
                + &body("block", block, &motion(1, ""))
                + "[[contact]]\nfriction = 0.3\n";
            let text = scene(dimension, cell, &rest)
                .replace("time.end = 1", &format!("time = {{ end = 1, stress_update = '{update}' }}"));
            let mut simulation = start(&text);
            let (before, first) = (energy(&*simulation), momenta(&*simulation));
            let scale = simulation.bodies()[0].mass * speed;
            run_to(&mut *simulation, 14.0 / WAVE, |_| ());
            let bodies = simulation.bodies();
            assert!(bodies[0].velocity[0] < bodies[1].velocity[0], "they have parted: {bodies:?}");
            assert!(bodies[1].spin[2].abs() > 0.01 * speed, "it turns: {bodies:?}");
            let off = (0..6).map(|k| (momenta(&*simulation)[k] - first[k]).abs() / scale);
            let off = off.fold(0.0, f64::max);
            let left = energy(&*simulation) / before;
            let given = simulation.contact_sums()[0].impulse[0] / (bodies[1].mass * bodies[1].velocity[0]);
            println!("{dimension}, {update}, free {free}: momenta {off:e}, energy {left}, given {given}");
            assert!(off < 1e-12, "{dimension}, {update}, free {free}: {off:e}");
            assert!((left - 1.0).abs() < 0.01, "{dimension}, {update}, free {free}: {left}");
            assert!((given - 1.0).abs() < 1e-9, "{dimension}, {update}, free {free}: {given}");
            // What layers come to feel of the depth at which points came to touch.
            let work = simulation.ledger().external_work;
            assert!((0.0..1e-3 * before).contains(&work), "{work} of {before}");
        }
    }
}

/// A free rigid disk bounces off a soft block as one does that deforms, a hundred times as stiff.
#[test]
fn a_rigid_disk_bounces_as_a_stiff_one() {
    let speed = 0.02 * WAVE;
    let stiff =
        "materials.stiff = { density = 1000, neo_hookean = { young_modulus = 1e8, poisson_ratio = 0.3 } }\n";
    let left = |rigid: bool| {
        let ball = body(
            "ball",
            "ball = { center = [0, 0.51], radius = 0.5 }",
            &format!("velocity = [0, {}]\n{}", -speed, if rigid { "rigid.free = {}" } else { "" }),
        );
        let rest = format!(
            "{stiff}{}{}",
            ball.replace("rubber", "stiff"),
            body("block", "box = { min = [-1, -1], max = [1, 0] }", "")
        );
        let mut simulation = start(&scene("plane-strain", 0.125, &rest));
        run_to(&mut *simulation, 7.0 / WAVE, |_| ());
        simulation.bodies()[0].velocity[1] / speed
    };
    let [rigid, stiff] = [true, false].map(left);
    println!("velocity left: rigid {rigid}, stiff {stiff}");
    assert!((rigid - stiff).abs() < 0.01, "{rigid} {stiff}");
}

/// A rigid block comes to rest on a soft pad that viscous damping calms: the pad bears the block, and the floor both.
#[test]
fn a_block_rests_by_its_weight() {
    let rest = body("pad", "box = { min = [-1, 0], max = [1, 0.5] }", "")
        + &body("block", "box = { min = [-0.6, 0.5], max = [0.6, 1.3] }", "rigid.free = {}")
        + FLOOR;
    let text =
        "gravity = [0, -9.81]\ndamping.viscous = 300\n".to_string() + &scene("plane-strain", 0.125, &rest);
    let mut simulation = start(&text);
    run_to(&mut *simulation, 1.5, |_| ());
    let mut cursor = ContactCursor::default();
    cursor.read(&*simulation);
    run_to(&mut *simulation, 1.6, |_| ());
    let bears: Vec<f64> =
        cursor.read(&*simulation).iter().map(|contact| contact.mean.force[1].abs()).collect();
    let [pad, block] = [0, 1].map(|body| 9.81 * simulation.bodies()[body].mass);
    println!("borne over weight: {} {}", bears[0] / block, bears[1] / (block + pad));
    assert!((bears[0] / block - 1.0).abs() < 1e-3, "{bears:?}, {block}");
    assert!((bears[1] / (block + pad) - 1.0).abs() < 1e-3, "{bears:?}, {block} {pad}");
}

/// A rigid disk is pressed on a soft block by its weight: half the width of the contact is Hertz's (1882),
/// b^2 = 4 P R / (pi E*), E* = E / (1 - nu^2), within what a width of ten cells resolves.
#[test]
fn the_contact_below_a_rigid_disk_has_the_width_of_hertz() {
    let (radius, width) = (1.0_f64, 0.3_f64);
    let load = PI * (1e6 / 0.91) * width * width / (4.0 * radius);
    let gravity = load / (1000.0 * PI * radius * radius);
    let rest = body("block", "box = { min = [-2, 0], max = [2, 2] }", "")
        + &body("disk", "ball = { center = [0, 3.001], radius = 1 }", "rigid.free = {}")
        + FLOOR;
    let text = format!("gravity = [0, {}]\ndamping.viscous = 100\n", -gravity);
    let mut simulation = start(&(text + &scene("plane-strain", 0.0625, &rest)));
    run_to(&mut *simulation, 1.2, |_| ());
    let mut cursor = ContactCursor::default();
    cursor.read(&*simulation);
    run_to(&mut *simulation, 1.3, |_| ());
    let contact = &cursor.read(&*simulation)[0].mean;
    let (borne, half) = (contact.force[1].abs() / load, 0.5 * contact.area / width);
    println!("borne {borne}, half width over Hertz's {half}");
    assert!((borne - 1.0).abs() < 0.005, "{borne}");
    assert!((half - 1.0).abs() < 0.08, "{half}");
}

/// A soft disk hits a plate of a hundredth of the mass of the cells round it: steps are shorter from the start, and the
/// energy stays.
#[test]
fn a_light_plate_is_stable() {
    let speed = 0.04 * WAVE;
    let plate = |free: &str| {
        body("disk", "ball = { center = [0, 1.02], radius = 1 }", &format!("velocity = [0, {}]", -speed))
            + &body("plate", "box = { min = [-0.5, -0.5], max = [0.5, 0] }", free)
    };
    let mut steps = [0, 1].map(|_| 0);
    for (mass, steps) in [500.0, 4.0].into_iter().zip(&mut steps) {
        let text = scene("plane-strain", 0.125, &plate(&format!("rigid.free.mass = {mass}")));
        let mut simulation = start(&text);
        let before = energy(&*simulation);
        run_to(&mut *simulation, 8.0 / WAVE, |_| *steps += 1);
        let left = energy(&*simulation) / before;
        let plate = &simulation.bodies()[1];
        println!("{mass} kg: energy {left}, {steps} steps, plate {:?}", plate.velocity[1] / speed);
        assert!((left - 1.0).abs() < 0.01, "{mass} kg: {left}");
        assert!(plate.velocity[1] < -0.5 * speed, "{:?}", plate.velocity);
    }
    assert!(steps[1] > 2 * steps[0], "{steps:?}");
}

/// A tool that starts far away meets a body that rests: nothing but the tool moves until then.
#[test]
fn a_tool_from_afar_meets_a_body_at_rest() {
    for motion in ["rigid.velocity = [0, -2]", "rigid.free = {}\nvelocity = [0, -2]"] {
        let rest = body("block", "box = { min = [0, 0], max = [2, 1] }", "")
            + &body("tool", "box = { min = [0.5, 2], max = [1.5, 3] }", motion);
        let mut simulation = start(&scene("plane-strain", 0.125, &rest));
        run_to(&mut *simulation, 0.7, |_| ());
        let block = &simulation.bodies()[0];
        assert!(block.velocity[1] < -0.8, "{motion}: {:?}", block.velocity);
    }
}

/// A soft disk and a free rigid one on a spring swing with the frequency of two masses and keep momentum and energy.
#[test]
fn a_soft_disk_and_a_rigid_one_swing_on_a_spring() {
    let disk = |name: &str, x: f64, rest: &str| {
        let rest = format!("velocity = [{}, 0]\n{rest}", -0.05 * x);
        body(name, &format!("ball = {{ center = [{x}, 0], radius = 1 }}"), &rest)
    };
    let spring = "[[springs]]\nname = 's'\nfrom = { body = 'a', on = 'x_max' }\nto = { body = 'b', on = 'x_min' }\n\
                  stiffness = 2e3\n";
    let rest = disk("a", -2.0, "") + &disk("b", 2.0, "rigid.free = {}") + spring;
    let mut simulation = start(&scene("plane-strain", 0.25, &rest));
    let (before, first) = (energy(&*simulation), momenta(&*simulation));
    let mass = 1000.0 * PI;
    let half = PI * (mass / (2.0 * 2e3)).sqrt();
    run_to(&mut *simulation, half, |_| ());
    let bodies = simulation.bodies();
    assert!((bodies[0].velocity[0] / -0.1 - 1.0).abs() < 0.01, "{bodies:?}");
    let off = (0..6).map(|k| (momenta(&*simulation)[k] - first[k]).abs()).fold(0.0, f64::max);
    assert!(off < 1e-10 * mass, "{off}");
    let work = simulation.ledger().external_work;
    assert!((energy(&*simulation) - work - before).abs() < 1e-3 * before, "{work}");
}

/// Balls, free rigid ones among them, of which one hangs on a spring and one on a hinge.
pub fn several(dimension: &str) -> String {
    let is_flat = dimension != "3d";
    let place = |x: f64, y: f64| if is_flat { format!("[{x}, {y}]") } else { format!("[{x}, {y}, 0.1]") };
    let direction = |x: f64, y: f64| if is_flat { format!("[{x}, {y}]") } else { format!("[{x}, {y}, 0]") };
    let ball = |name: &str, (x, y): (f64, f64), (u, v): (f64, f64), rest: &str| {
        let rest = format!("velocity = {}\n{rest}", direction(u, v));
        body(name, &format!("ball = {{ center = {}, radius = 0.5 }}", place(x, y)), &rest)
    };
    let axis = if is_flat { "" } else { "axis = [0, 0, 1], " };
    let rest = ball("a", (0.0, 0.5), (1.0, -1.0), "")
        + &ball("b", (1.01, 0.6), (-1.0, 0.0), "rigid.free = {}")
        + &ball("c", (2.02, 0.7), (-1.5, 0.0), "")
        + &ball("d", (0.4, 1.5), (0.0, -1.0), "rigid.free.mass = 100")
        + &format!(
            "[[bodies]]\nname = 'floor'\nmaterial = 'rubber'\nrigid = {{}}\n\
             shape.half_space = {{ point = {}, normal = {} }}\n",
            direction(0.0, 0.0),
            direction(0.0, 1.0)
        )
        + &format!("[[joints]]\nbody = 'd'\nhinge = {{ {axis}point = {} }}\n", place(0.9, 1.5))
        + "[[springs]]\nname = 's'\nfrom = { body = 'c', on = 'x_min' }\nto = { body = 'b', on = 'x_max' }\n\
           stiffness = 1e4\ndashpot = 10\n[[contact]]\nfriction = 0.3\n";
    let gravity = format!("gravity = {}\n", direction(0.0, -9.81));
    gravity + &scene(dimension, 0.125, &rest)
}

/// All bits are the same on one, three and five threads, after a state was saved, taken back, and with lists made anew.
#[test]
fn bits_do_not_depend_on_threads_or_resumes() {
    ["plane-strain", "3d"].iter().for_each(|dimension| same_bits(&several(dimension), 60, [3, 5]));
}
