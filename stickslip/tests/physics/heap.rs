//! A heap of rigid disks comes to rest and stays.
//!
//! Set-up: 168 rigid disks of diameter 0.9 to 1 fall into a bin and lie on each other at some three hundred places, with
//! friction. So many contacts are solved with a tolerance, and a step begins with the impulses of the one before.
//!
//! Expected: at rest nothing overlaps by more than 1e-3 of a diameter, the heap sinks by less than 1e-4 in the last
//! seconds, and the floor bears its weight. A run that is taken up in between ends with the same bits. Two packings that
//! strike each other keep their momentum and angular momentum to round-off, gain no energy, and overlap by less than 0.02
//! of a diameter, however early the sweeps over their contacts end.

use crate::trial::{distance, run_to, start, take_steps};
use stickslip::door::{ContactCursor, Simulation};

const COLUMNS: usize = 12;
const COUNT: usize = 14 * COLUMNS;

fn radius(number: usize) -> f64 {
    0.45 + 0.005 * ((7 * (number % COLUMNS) + 5 * (number / COLUMNS)) % 11) as f64
}

fn heap() -> Box<dyn Simulation> {
    start(
        r#"
        gravity = [0, -1]
        space = { dimension = "plane-strain", interior = "grid", cell = 1 }
        time = { end = 40, max_step = 0.02 }
        materials.stone = { density = 1, neo_hookean = { young_modulus = 1e3, poisson_ratio = 0.3 } }
        [[bodies]]
        name = "bin"
        material = "stone"
        rigid = {}
        shape.union = [
            { box = { min = [-8, -1], max = [8, 0] } },
            { box = { min = [-8, -1], max = [-6.4, 40] } },
            { box = { min = [6.4, -1], max = [8, 40] } },
        ]
        [[bodies]]
        name = "disk {j} {i}"
        repeat = { j = 14, i = 12 }
        material = "stone"
        rigid.free = {}
        [bodies.shape.ball]
        center = ["(i - 5.5) * 1.05 + 0.03 * sin(7 * j + 3 * i)", "0.6 + j * 1.02"]
        radius = "0.45 + 0.005 * mod(7 * i + 5 * j, 11)"
        [[contact]]
        friction = 0.5
        "#,
    )
}

fn centers(simulation: &dyn Simulation) -> Vec<[f64; 3]> {
    simulation.bodies().iter().skip(1).map(|body| body.position).collect()
}

#[test]
fn a_heap_of_rigid_disks_rests() {
    let mut simulation = heap();
    run_to(&mut *simulation, 30.0, |_| {});
    let before = centers(&*simulation);
    let mut cursor = ContactCursor::default();
    cursor.read(&*simulation);
    run_to(&mut *simulation, 35.0, |_| {});
    let after = centers(&*simulation);
    let sunk = before.iter().zip(&after).map(|(a, b)| (a[1] - b[1]).abs()).fold(0.0, f64::max);
    // What nothing resists may roll on: a disk on the floor that bears no other, and two there that bear a third, for
    // floor, disk, third and disk are a ring of four, which turns as gears do. Here a disk alone rolls at 0.6 mm/s, and
    // such a ring turns at 0.03 mm/s.
    let moved = before.iter().zip(&after).filter(|(a, b)| distance(**a, **b) > 1e-4).count();
    let mut overlap = 0.0_f64;
    for i in 0..COUNT {
        for j in 0..i {
            overlap = overlap.max(radius(i) + radius(j) - distance(after[i], after[j]));
        }
    }
    let weight: f64 = simulation.bodies().iter().skip(1).map(|body| body.mass).sum();
    let contacts = cursor.read(&*simulation);
    let borne: f64 = contacts.iter().filter(|pair| pair.body_a == 0).map(|pair| pair.mean.force[1]).sum();
    println!(
        "sunk by {sunk:.1e}, {moved} moved, overlap {overlap:.1e}, the bin bears {:.5} of the weight",
        -borne / weight
    );
    assert!(overlap < 1e-3, "{overlap}");
    assert!(sunk < 1e-4 && moved <= 4, "{sunk} {moved}");
    assert!((borne.abs() / weight - 1.0).abs() < 1e-3, "{borne} {weight}");
}

#[test]
fn a_heap_goes_on_as_if_nothing_had_been() {
    let mut simulation = heap();
    run_to(&mut *simulation, 5.0, |_| {});
    let saved = simulation.save().expect("it has a state");
    let mut other = heap();
    other.restore(saved).expect("it is the same scene");
    for simulation in [&mut simulation, &mut other] {
        take_steps(&mut **simulation, 50);
    }
    let [whole, taken_up] = [&simulation, &other].map(|simulation| centers(&**simulation));
    assert_eq!(whole, taken_up);
}

#[test]
fn packings_that_strike_each_other_keep_their_momentum() {
    let mut simulation = start(
        r#"
        space = { dimension = "plane-strain", interior = "grid", cell = 1 }
        time = { end = 5, max_step = 0.02 }
        materials.stone = { density = 1, neo_hookean = { young_modulus = 1e3, poisson_ratio = 0.3 } }
        [[bodies]]
        name = "left {j} {i}"
        repeat = { j = 12, i = 12 }
        material = "stone"
        velocity = [1, 0]
        rigid.free = {}
        shape.ball = { center = ["i - 12 + 0.5 * mod(j, 2)", "0.87 * j"], radius = "0.47 + 0.005 * mod(7 * i + 5 * j, 6)" }
        [[bodies]]
        name = "right {j} {i}"
        repeat = { j = 8, i = 8 }
        material = "stone"
        rigid.free = {}
        shape.ball = { center = ["i + 1.1 + 0.5 * mod(j, 2)", "0.87 * j"], radius = "0.47 + 0.005 * mod(7 * i + 5 * j, 6)" }
        [[contact]]
        friction = 0.5
        restitution = 0.3
        "#,
    );
    let radii: Vec<f64> =
        simulation.bodies().iter().map(|body| (body.mass / std::f64::consts::PI).sqrt()).collect();
    let before = simulation.ledger();
    let mut deepest = 0.0_f64;
    run_to(&mut *simulation, 5.0, |simulation| {
        let places: Vec<[f64; 3]> = simulation.bodies().iter().map(|body| body.position).collect();
        for i in 0..places.len() {
            for j in 0..i {
                deepest = deepest.max(radii[i] + radii[j] - distance(places[i], places[j]));
            }
        }
    });
    let after = simulation.ledger();
    let lost = 1.0 - after.kinetic / before.kinetic;
    println!("overlap {deepest:.1e}, {lost:.3} of the energy lost, unsettled {}", after.unsettled_nodes);
    assert!(deepest < 0.02, "{deepest}");
    assert!(lost > 0.1, "they have struck each other: {lost}");
    assert!((after.total / before.total - 1.0).abs() < 1e-9, "{} {}", before.total, after.total);
    for k in 0..3 {
        let [p, l] =
            [after.momentum[k] - before.momentum[k], after.angular_momentum[k] - before.angular_momentum[k]];
        assert!(p.abs() < 1e-10 * before.momentum[0], "{p}");
        assert!(l.abs() < 1e-10 * before.angular_momentum[2].abs(), "{l}");
    }
}
