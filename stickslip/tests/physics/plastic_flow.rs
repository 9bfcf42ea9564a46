//! A block of metal that yields.
//!
//! Set-up: a unit block, E = rho = 1, nu = 0.3, yield stress Y = 0.005 and hardening H = 0.05, before symmetry faces; a
//! rigid plate without friction comes down on it by 5 %, slowly, and rests. In space its sides are free, in plane
//! strain the block cannot widen along the third axis, in plane stress it is a thin plate. (Without hardening the block
//! would be free to yield in bands.)
//!
//! Expected: the yield stress of von Mises in each state, and volume but for the elastic part: with e the elastic part
//! of the height, the plastic strain a = c (ln(1/0.95) - e), the force c (Y + H a)/0.95, c = 1, in plane strain
//! 2/sqrt(3) (Hill 1950). Force within h/2 (2.5 % at the cells of the plane), the mean of the particles' strains within
//! 2 %; the plate's work is stored or dissipated, but for 0.3 h.

use crate::trial::{run_to, start};
use stickslip::door::ContactCursor;

const YIELD: f64 = 0.005;
const HARDENING: f64 = 0.05;
const DOWN: f64 = 0.05;

fn press(dimension: &str, cell: f64, constraint: f64) {
    let space = dimension == "3d";
    let v = |x: &str, y: &str| if space { format!("[{x}, {y}, {x}]") } else { format!("[{x}, {y}]") };
    let mirrors = if space { r#"x_min = "symmetry", z_min = "symmetry""# } else { r#"x_min = "symmetry""# };
    let (end, ramp) = (60.0, 50.0);
    let mut simulation = start(&format!(
        r#"
        space = {{ dimension = "{dimension}", interior = "grid", cell = {cell}, basis = "gimp", domain = {{ min = {}, max = {}, {mirrors}, y_min = "symmetry" }} }}
        time.end = {end}
        materials.metal = {{ density = 1, von_mises = {{ young_modulus = 1, poisson_ratio = 0.3, yield_stress = {YIELD}, hardening_modulus = {HARDENING} }} }}
        [[bodies]]
        name = "block"
        material = "metal"
        shape.box = {{ min = {}, max = {} }}
        [[bodies]]
        name = "plate"
        material = "metal"
        shape.box = {{ min = {}, max = {} }}
        rigid.velocity = {}
        "#,
        v("0", "0"),
        v("2", "2"),
        v("0", "0"),
        v("1", "1"),
        v("0", "1"),
        v("1.5", "1.4"),
        v("0", &format!("\"-{DOWN} / {ramp} * (1 - cos(2 * pi * min(t / {ramp}, 1)))\"")),
    ));
    run_to(&mut *simulation, ramp, |_| {});
    let mut cursor = ContactCursor::default();
    cursor.read(&*simulation);
    run_to(&mut *simulation, end, |_| {});
    let contacts = cursor.read(&*simulation);
    let height = 1.0 - DOWN;
    // Elastic part of the height, over the pressure.
    let shorter = if constraint > 1.0 { 1.0 - 0.15 } else { 1.0 };
    let (mut pressure, mut strain) = (0.0, 0.0);
    for _ in 0..50 {
        strain = constraint * ((1.0 / height).ln() - shorter * pressure);
        pressure = constraint * (YIELD + HARDENING * strain);
    }
    // The law bounds J sigma, and J over the height is the face.
    let force = contacts[0].mean.normal / (pressure / height);
    let plastic_strain = simulation.column(0, "plastic_strain").expect("a law that flows");
    let sum: f64 = plastic_strain.rows().map(|(_, [strain])| strain).sum();
    let found = sum / plastic_strain.len() as f64;
    println!("{dimension}: force {force} and plastic strain {} of the exact", found / strain);
    assert!((force - 1.0).abs() < 0.5 * cell, "{dimension}: force {force} of the exact");
    assert!((found / strain - 1.0).abs() < 0.02, "{dimension}: {found} {strain}");

    let ledger = simulation.ledger();
    assert!(ledger.plastic > 0.7 * ledger.external_work, "{ledger:?}");
    assert!(ledger.total.abs() < 0.3 * cell * ledger.external_work, "{ledger:?}");
}

#[test]
fn in_plane_strain() {
    press("plane-strain", 0.05, 2.0 / 3.0_f64.sqrt());
}

#[test]
fn in_plane_stress() {
    press("plane-stress", 0.05, 1.0);
}

#[test]
fn in_space() {
    press("3d", 0.1, 1.0);
}
