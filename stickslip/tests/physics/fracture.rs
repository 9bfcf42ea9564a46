//! A bar that is torn takes the fracture energy, whatever the cells.
//!
//! Source: crack band of Bazant and Oh (1983): what softens is as wide as a cell,
//! and a cell dissipates G_f over its width.
//!
//! Set-up: the plane, nu = 0. A bar of length L = E = rho = 1 and two cells high between grips, of which one moves away
//! slowly and smoothly. Strength 5e-4, G_f = 4e-7: 2 E G_f/f_t^2 is 3.2 L, so the bar softens without snapping. At the
//! end the crack is open by n = 8 times G_f/f_t, a tenth of a cell or more.
//!
//! Expected: the crack took G_f of the section, but for exp(-n) (1 + n/2) = 0.2 % that is stored yet, and a part in the
//! cells beside it: all are strained alike and begin to soften before the crack chooses one. So at least 0.95 and at
//! most 1.1 G_f, and within 5 % the same on 10, 20 and 40 cells; without regularisation it would be half as much with
//! each. Measured 1.07, 1.05 and 1.04 in plane strain. The ledger closes within 2 % of the work,
//! and at most three columns of cells are broken.

use crate::trial::{mean_where, run_to, start};
use std::f64::consts::PI;
use stickslip::door::ContactCursor;

const STRENGTH: f64 = 5e-4;
const ENERGY: f64 = 4e-7;
const OPENING: f64 = 8.0 * ENERGY / STRENGTH;

/// Energy that a section took over G_f, and what is missing in the ledger over the work.
fn torn(cells: usize, dimension: &str) -> [f64; 3] {
    let h = 1.0 / cells as f64;
    let (height, end) = (2.0 * h, 120.0);
    let pull = format!("{OPENING} / {end} * (1 - cos(2 * pi * t / {end}))");
    let mut simulation = start(&format!(
        r#"
        space = {{ dimension = "{dimension}", interior = "grid", cell = {h} }}
        time.end = {end}
        materials.glass = {{ density = 1, damage = {{ young_modulus = 1, poisson_ratio = 0, tensile_strength = {STRENGTH}, fracture_energy = {ENERGY} }} }}
        [[bodies]]
        name = "bar"
        material = "glass"
        shape.box = {{ min = [0, 0], max = [1, {height}] }}
        [[bodies]]
        name = "left"
        material = "glass"
        shape.box = {{ min = [{}, 0], max = [0, {height}] }}
        rigid.velocity = [0, 0]
        [[bodies]]
        name = "right"
        material = "glass"
        shape.box = {{ min = [1, 0], max = [{}, {height}] }}
        rigid.velocity = ["{pull}", 0]
        [[contact]]
        law = "glued"
        "#,
        -2.0 * h,
        1.0 + 2.0 * h,
    ));
    run_to(&mut *simulation, end, |_| {});
    let ledger = simulation.ledger();
    let damage = simulation.column(0, "damage").expect("a law that breaks");
    let broken = damage.rows().filter(|(_, [damage])| *damage > 0.5).count() as f64 / 8.0;
    [ledger.plastic / (ENERGY * height), ledger.total / ledger.external_work, broken]
}

#[test]
fn a_bar_takes_the_fracture_energy_whatever_the_cells() {
    for dimension in ["plane-strain", "plane-stress"] {
        let all = [10, 20, 40].map(|cells| (cells, torn(cells, dimension)));
        for (cells, [taken, lost, columns]) in all {
            println!(
                "{dimension}, {cells} cells: {taken:.3} G_f in {columns} columns, ledger {lost:.1e} of the work"
            );
        }
        let taken = all.map(|(_, [taken, ..])| taken);
        let spread = taken.iter().fold(0.0, |most: f64, a| most.max((a / taken[1] - 1.0).abs()));
        assert!(spread < 0.05, "{dimension}: {taken:?} G_f");
        for (cells, [taken, lost, columns]) in all {
            assert!((0.95..1.1).contains(&taken), "{dimension}, {cells} cells: {taken} G_f");
            assert!(lost.abs() < 0.02, "{dimension}, {cells} cells: {lost} of the work");
            assert!((1.0..=3.0).contains(&columns), "{dimension}, {cells} cells: {columns} columns");
        }
    }
}

/// What a disk that is split between flat plates bears over Griffith's pi D f_t/2, and the largest stress across in its
/// middle over f_t.
fn split(law: &str) -> [f64; 2] {
    let (cells, speed) = (8, 0.05);
    let text = format!(
        r#"
        space = {{ dimension = "plane-strain", interior = "grid", cell = "25 mm / {cells}" }}
        time.end = "50 um / ({speed} * 1 m/s)"
        materials.concrete = {{ density = 2400, damage = {{ young_modulus = 30e9, poisson_ratio = 0.2, tensile_strength = 3e6, fracture_energy = 20, {law} }} }}
        [[bodies]]
        name = "disk"
        material = "concrete"
        shape.intersection = [{{ ball = {{ center = [0, 0], radius = "25 mm" }} }}, {{ box = {{ min = ["-25 mm", "-24 mm"], max = ["25 mm", "24 mm"] }} }}]
        [[bodies]]
        name = "bottom"
        material = "concrete"
        shape.half_space = {{ point = [0, "-24 mm"], normal = [0, 1] }}
        rigid = {{}}
        [[bodies]]
        name = "top"
        material = "concrete"
        shape.half_space = {{ point = [0, "24 mm"], normal = [0, -1] }}
        rigid = {{ velocity = [0, "-{speed} * 1 m/s"] }}
        [[contact]]
        friction = 0.3
        "#
    );
    let mut simulation = start(&text);
    let mut cursor = ContactCursor::default();
    let (mut bears, mut across) = (0.0_f64, 0.0_f64);
    let end = 50e-6 / speed;
    for look in 1..=50 {
        run_to(&mut *simulation, end * f64::from(look) / 50.0, |_| {});
        let pushed = cursor.read(&*simulation).iter().map(|contact| contact.mean.normal).fold(0.0, f64::max);
        bears = bears.max(pushed);
        let snapshot = simulation.snapshot();
        let middle = |p: usize| snapshot.body[p] == 0 && snapshot.position[p].iter().all(|x| x.abs() < 4e-3);
        across = across.max(mean_where(&snapshot, middle, |p| snapshot.stress[p][0]));
    }
    [bears / (PI * 25e-3 * 3e6), across / 3e6]
}

/// A splitting test: a disk between flat plates breaks where the stress across reaches f_t, by Rankine's criterion. By
/// modified von Mises the pressure along, which is three times as large there, keeps it whole up to 1.8 f_t
/// ([`the_criteria_say_what_stress_breaks`] in `damage.rs`), and it bears as much more.
///
/// Source: Griffith's P = pi D f_t/2 of a line load on what breaks at once. Flats, as here over 16 degrees to either
/// side, bear 4 % more (Wang et al. 2004), and what softens over E G_f/f_t^2, here 1.3 D, bears more yet. Measured with
/// ten cells a radius 1.15 by Rankine, with the middle at 0.99 f_t, and 2.05 and 2.11 by modified von Mises; with
/// eight, as here, 1.24 and 0.99, 2.32 and 2.05.
#[test]
fn a_disk_that_is_split_breaks_by_rankine_at_its_strength() {
    let [bears, across] = split("criterion = \"rankine\"");
    let [bears_more, across_more] = split("criterion = \"modified-von-mises\"");
    println!(
        "rankine: {bears:.3} of Griffith's, {across:.3} f_t across; modified von Mises {bears_more:.3}, {across_more:.3}"
    );
    assert!((0.95..1.35).contains(&bears) && (0.9..1.05).contains(&across), "{bears} {across}");
    assert!(bears_more > 1.5 * bears && across_more > 1.5, "{bears_more} {across_more}");
}
