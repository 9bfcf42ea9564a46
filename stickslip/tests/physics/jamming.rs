//! B27: soft disks compressed beyond jamming touch as many others as the square root of the excess says.
//!
//! Source: O'Hern, Silbert, Liu and Nagel (2003), Phys. Rev. E 68, 011306: without friction Z = 4 + z0 (phi - phi_J)^0.5 in
//! the plane, z0 = 3.6 +- 0.5 for disks of two sizes 1 : 1.4, and phi_J = 0.84; flat walls, which order what lies on
//! them, shift it by a little.
//!
//! Set-up: plane strain, disks of two sizes, four cells on the diameter of the smaller, between four walls without
//! friction that close in slower than 1/200 of the speed of waves, slowed by viscous damping. phi is the undeformed area
//! of the disks over that of the box. A disk counts if three others or walls press on it by 2 % of the mean force or more;
//! Z counts a contact with a wall once, as it holds one freedom of the disk, and one with another disk twice. phi_J is
//! where the pressure on the walls, by a straight line, is none: it does not know Z.
//!
//! Expected: of 200 disks the exponent 0.5 within 0.1 and z0 within 20 %; of 36 the exponent within 0.2.

use crate::trial::{run_to, start};
use std::collections::HashMap;
use std::f64::consts::PI;
use stickslip::door::{ContactCursor, ContactState};

/// Solid fraction at the start, at the end, and from one look to the next.
const FRACTIONS: [f64; 3] = [0.76, 0.94, 0.006];

/// What was found at a solid fraction.
struct Look {
    fraction: f64,
    coordination: f64,
    pressure: f64,
}

fn compressed(count: usize, speed: f64) -> Vec<Look> {
    let [first, last, between] = FRACTIONS;
    let side = (count as f64 * PI * (0.25 + 0.49) / 2.0 / first).sqrt();
    let time = |fraction: f64| 0.5 * side * (1.0 - (first / fraction).sqrt()) / speed;
    let wall = |name: &str, point: [f64; 2], normal: [f64; 2]| {
        let velocity = normal.map(|n| n * speed);
        format!(
            "[[bodies]]\nname = \"{name}\"\nmaterial = \"soft\"\nrigid.velocity = {velocity:?}\n\
             shape.half_space = {{ point = {point:?}, normal = {normal:?} }}\n"
        )
    };
    let walls = [
        wall("left", [0.0, 0.0], [1.0, 0.0]),
        wall("right", [side, 0.0], [-1.0, 0.0]),
        wall("below", [0.0, 0.0], [0.0, 1.0]),
        wall("above", [0.0, side], [0.0, -1.0]),
    ];
    let mut simulation = start(&format!(
        r#"
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.25 }}
        time.end = {}
        damping.viscous = 0.2
        materials.soft = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }} }}
        {}
        [[packings]]
        name = "disk"
        material = "soft"
        shape.ball = {{ center = [0, 0], radius = 0.5 }}
        sizes.numbers = [[1, 1], [1.4, 1]]
        within.box = {{ min = [0, 0], max = [{side}, {side}] }}
        solid_fraction = {first}
        seed = 1
        "#,
        time(last),
        walls.concat()
    ));
    let mut cursor = ContactCursor::default();
    let mut looks = Vec::new();
    let mut fraction = first;
    while fraction < last - 0.5 * between {
        run_to(&mut *simulation, time(fraction + between), |_| {});
        let contacts = cursor.read(&*simulation);
        // The mean over the way is that of its middle.
        let now = side * (first / (fraction + 0.5 * between)).sqrt();
        let on_walls = contacts.iter().filter(|contact| contact.body_a < 4);
        let pressure = on_walls.map(|contact| contact.mean.normal).sum::<f64>() / (4.0 * now);
        looks.push(Look {
            fraction: fraction + 0.5 * between,
            coordination: coordination(contacts),
            pressure,
        });
        fraction += between;
    }
    looks
}

/// Mean number of contacts of the disks that are held; walls are the first four bodies.
fn coordination(contacts: Vec<ContactState>) -> f64 {
    let mean = contacts.iter().map(|contact| contact.mean.normal).sum::<f64>() / contacts.len().max(1) as f64;
    let pairs = contacts.into_iter().filter(|contact| contact.mean.normal > 0.02 * mean);
    let mut pairs: Vec<[usize; 2]> = pairs.map(|contact| [contact.body_a, contact.body_b]).collect();
    loop {
        let mut touching: HashMap<usize, usize> = HashMap::new();
        pairs.iter().flatten().for_each(|body| *touching.entry(*body).or_default() += 1);
        let is_held = |body: &usize| *body < 4 || touching[body] >= 3;
        let before = pairs.len();
        pairs.retain(|pair| pair.iter().all(is_held));
        if pairs.len() == before {
            let disks = touching.keys().filter(|body| **body >= 4).count();
            return 2.0 * before as f64 / disks.max(1) as f64;
        }
    }
}

/// Slope of a straight line by least squares, and where it is zero.
fn line(points: impl Iterator<Item = [f64; 2]> + Clone) -> [f64; 2] {
    let count = points.clone().count() as f64;
    let mean = |k: usize| points.clone().map(|point| point[k]).sum::<f64>() / count;
    let [x, y] = [mean(0), mean(1)];
    let moment = |k: usize| points.clone().map(|point| (point[0] - x) * (point[k] - [x, y][k])).sum::<f64>();
    let slope = moment(1) / moment(0);
    [slope, x - y / slope]
}

fn check(looks: &[Look], [exponent_within, z_within]: [f64; 2]) {
    for look in looks {
        println!("phi {:.4}: Z {:.3}, pressure {:.3e}", look.fraction, look.coordination, look.pressure);
    }
    let dense = looks.iter().filter(|look| look.fraction > 0.875);
    let [_, jamming] = line(dense.map(|look| [look.fraction, look.pressure]));
    let beyond = looks.iter().filter(|look| look.fraction > jamming + 0.01 && look.coordination > 4.0);
    let [exponent, _] =
        line(beyond.clone().map(|look| [(look.fraction - jamming).ln(), (look.coordination - 4.0).ln()]));
    let count = beyond.clone().count() as f64;
    let factors = beyond.map(|look| (look.coordination - 4.0) / (look.fraction - jamming).sqrt());
    let factor = factors.sum::<f64>() / count;
    println!("phi_J {jamming:.4}, exponent {exponent:.3}, z0 {factor:.3}");
    assert!((0.82..0.87).contains(&jamming), "{jamming}");
    assert!((exponent - 0.5).abs() < exponent_within, "{exponent}");
    assert!((factor / 3.6 - 1.0).abs() < z_within, "{factor}");
}

#[test]
fn a_few_disks_touch_more_the_more_they_are_compressed() {
    check(&compressed(36, 3e-3), [0.2, 0.3]);
}

#[test]
#[ignore = "slow: two minutes"]
fn two_hundred_disks_touch_by_the_square_root_of_the_excess() {
    check(&compressed(200, 1e-3), [0.1, 0.2]);
}
