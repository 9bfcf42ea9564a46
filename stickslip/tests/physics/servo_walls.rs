//! Walls that hold a force: rigid and free plates on sliders, pressures on the mantle, and a plate that is carried
//! along.
//!
//! Source: Hooke's law.
//!
//! Set-up: a bar in plane stress that two plates glued to its ends pull with a force each; a square in plane strain
//! that two plates press against two mirrors with the same pressure, and then one of them is driven on; an eighth of a
//! cube under pressure on its mantle, which a plate presses beyond that (triaxial test); a flat block glued to a floor
//! and to a plate that a carriage pulls sideways while its slider holds the pressure (simple shear).
//!
//! Expected: stresses and strains within 1 %; the plates' forces within 1 %; in simple shear, whose ends are free,
//! stresses of the middle within 2 %.

use crate::trial::{mean_where, run_to, start};
use stickslip::door::{ParticleSnapshot, Simulation};

const YOUNG: f64 = 1e7;
const POISSON: f64 = 0.3;
const SHEAR: f64 = YOUNG / (2.0 * (1.0 + POISSON));

/// Means over the particles of the first body that begin at places which a filter takes.
fn means(
    simulation: &dyn Simulation,
    takes: impl Fn([f64; 3]) -> bool,
) -> impl Fn(&dyn Fn(&ParticleSnapshot, usize) -> f64) -> f64 {
    let snapshot = simulation.snapshot();
    let taken: Vec<bool> =
        (0..snapshot.body.len()).map(|p| snapshot.body[p] == 0 && takes(snapshot.position[p])).collect();
    move |of| mean_where(&snapshot, |p| taken[p], |p| of(&snapshot, p))
}

fn scene((dimension, end): (&str, f64), walls: &str, rest: &str) -> String {
    let domain = match dimension {
        "3d" => "min = [0, 0, 0], max = [0.1, 0.1, 0.1]",
        _ if walls.is_empty() => "min = [-0.1, -0.1], max = [0.3, 0.2]",
        _ => "min = [0, 0], max = [0.3, 0.2]",
    };
    format!(
        r#"
        time.end = {end}
        damping.local = 0.2
        materials.gel = {{ density = 1000, neo_hookean = {{ young_modulus = {YOUNG}, poisson_ratio = {POISSON} }} }}
        materials.plate = {{ density = 100, neo_hookean = {{ young_modulus = {YOUNG}, poisson_ratio = {POISSON} }} }}
        space = {{ dimension = "{dimension}", cell = 0.01, domain = {{ {domain}{walls} }} }}
        {rest}
        "#
    )
}

#[test]
fn a_bar_pulled_by_plates_that_hold_a_force() {
    let force = 0.02 * YOUNG * 1e-3;
    let text = scene(
        ("plane-stress", 0.03),
        "",
        &format!(
            r#"
            bodies = [
                {{ name = "bar", material = "gel", shape.box = {{ min = [0, 0], max = [0.12, 0.02] }} }},
                {{ name = "left", material = "plate", rigid.free = {{}}, shape.box = {{ min = [-0.02, -0.01], max = [0, 0.03] }} }},
                {{ name = "right", material = "plate", rigid.free = {{}}, shape.box = {{ min = [0.12, -0.01], max = [0.14, 0.03] }} }},
            ]
            contact = [{{ law = "glued" }}]
            joints = [
                {{ body = "left", slider = {{ axis = [1, 0], dashpot = 2000, force = {{ table = [[0, 0], [0.01, -{force}]] }} }} }},
                {{ body = "right", slider = {{ axis = [1, 0], dashpot = 2000, force = {{ table = [[0, 0], [0.01, {force}]] }} }} }},
            ]
            "#
        ),
    );
    let mut simulation = start(&text);
    run_to(&mut *simulation, 0.03, |_| {});
    let mean = means(&*simulation, |x| (0.03..0.09).contains(&x[0]));
    let stress = mean(&|snapshot, p| snapshot.stress[p][0]) / (YOUNG * 1e-3);
    let strain = (mean(&|snapshot, p| snapshot.deformation[p][0]) - 1.0) / 1e-3;
    println!("pulled: stress {stress:.4}, strain {strain:.4}");
    assert!((stress - 1.0).abs() < 0.01 && (strain - 1.0).abs() < 0.01, "{stress} {strain}");
}

/// Constant pressure, and then one wall goes on while the other holds it.
#[test]
fn a_square_under_constant_pressure() {
    let (pressure, side) = (0.5e-3 * YOUNG, 0.1);
    let text = scene(
        ("plane-strain", 0.06),
        r#", x_min = "symmetry", y_min = "symmetry""#,
        &format!(
            r#"
            bodies = [
                {{ name = "soil", material = "gel", shape.box = {{ min = [0, 0], max = [{side}, {side}] }} }},
                {{ name = "right", material = "plate", rigid.free = {{}},
                   shape.box = {{ min = [{side}, 0.002], max = [0.12, {side}] }} }},
                {{ name = "top", material = "plate", rigid.free = {{}},
                   shape.box = {{ min = [0.002, {side}], max = [{side}, 0.12] }} }},
            ]
            contact = [{{ between = ["right", "top"], law = "none" }}]
            [[joints]]
            name = "cell"
            body = "right"
            slider = {{ axis = [1, 0], dashpot = 20000, force = {{ table = [[0, 0], [0.01, -{force}]] }} }}
            [[joints]]
            name = "press"
            body = "top"
            slider = {{ axis = [0, 1], dashpot = 20000, force = {{ table = [[0, 0], [0.01, -{force}], [0.03, -{force}], [0.04, -{more}]] }} }}
            "#,
            force = pressure * side,
            more = 2.0 * pressure * side
        ),
    );
    let mut simulation = start(&text);
    let plate = |stress: [f64; 2]| {
        [0, 1].map(|i| {
            ((1.0 - POISSON * POISSON) * stress[i] - POISSON * (1.0 + POISSON) * stress[1 - i]) / YOUNG
        })
    };
    for (time, stress) in [(0.03, [-pressure; 2]), (0.06, [-pressure, -2.0 * pressure])] {
        run_to(&mut *simulation, time, |_| {});
        let mean = means(&*simulation, |_| true);
        let stresses = [0, 1].map(|i| mean(&|snapshot, p| snapshot.stress[p][i]) / stress[i]);
        let strains =
            [0, 1].map(|i| (mean(&|snapshot, p| snapshot.deformation[p][4 * i]) - 1.0) / plate(stress)[i]);
        println!("at {time} s: stresses {stresses:.4?}, strains {strains:.4?}");
        assert!(stresses.iter().chain(&strains).all(|x| (x - 1.0).abs() < 0.02), "{stresses:?} {strains:?}");
    }
}

/// A triaxial test: the mantle has a pressure, the plate on top holds a force beyond it.
#[test]
fn a_triaxial_test() {
    let (cell, axial, side) = (0.5e-3 * YOUNG, 1.5e-3 * YOUNG, 0.04);
    let text = scene(
        ("3d", 0.02),
        r#", x_min = "symmetry", y_min = "symmetry", z_min = "symmetry""#,
        &format!(
            r#"
            bodies = [
                {{ name = "soil", material = "gel", shape.box = {{ min = [0, 0, 0], max = [{side}, {side}, {side}] }} }},
                {{ name = "top", material = "plate", rigid.free = {{}},
                   shape.box = {{ min = [0.002, 0.002, {side}], max = [0.05, 0.05, 0.06] }} }},
            ]
            loads = [
                {{ body = "soil", on = "x_max", pressure = {{ table = [[0, 0], [5e-3, {cell}]] }} }},
                {{ body = "soil", on = "y_max", pressure = {{ table = [[0, 0], [5e-3, {cell}]] }} }},
            ]
            joints = [{{ name = "press", body = "top",
                slider = {{ axis = [0, 0, 1], dashpot = 200, force = {{ table = [[0, 0], [5e-3, -{force}]] }} }} }}]
            "#,
            force = axial * side * side
        ),
    );
    let mut simulation = start(&text);
    run_to(&mut *simulation, 0.02, |_| {});
    let mean = means(&*simulation, |_| true);
    let stress = [0, 1, 2].map(|i| mean(&|snapshot, p| snapshot.stress[p][i]) / [-cell, -cell, -axial][i]);
    let strain = mean(&|snapshot, p| snapshot.deformation[p][8]) - 1.0;
    let exact = (-axial + 2.0 * POISSON * cell) / YOUNG;
    println!("triaxial: stresses {stress:.4?}, strain {:.4}", strain / exact);
    assert!(
        stress.iter().all(|x| (x - 1.0).abs() < 0.02) && (strain / exact - 1.0).abs() < 0.02,
        "{stress:?} {strain}"
    );
}

#[test]
fn simple_shear_under_constant_pressure() {
    let (pressure, shear, height) = (1e-3 * YOUNG, 2e-3, 0.03);
    let text = scene(
        ("plane-strain", 0.03),
        "",
        &format!(
            r#"
            bodies = [
                {{ name = "soil", material = "gel", shape.box = {{ min = [0, 0], max = [0.18, {height}] }} }},
                {{ name = "floor", material = "plate", rigid = {{}}, shape.box = {{ min = [-0.02, -0.02], max = [0.2, 0] }} }},
                {{ name = "top", material = "plate", rigid.free = {{}}, shape.box = {{ min = [-0.01, {height}], max = [0.19, 0.05] }} }},
                {{ name = "carriage", material = "plate", rigid = {{ velocity = ["if(t < 0.01, {speed}, 0)", 0] }},
                   shape.box = {{ min = [0.08, 0.1], max = [0.12, 0.12] }} }},
            ]
            contact = [{{ between = ["carriage", "any"], law = "none" }}, {{ law = "glued" }}]
            [[joints]]
            name = "press"
            body = "top"
            to = "carriage"
            slider = {{ axis = [0, 1], dashpot = 20000, force = {{ table = [[0, 0], [0.01, -{force}]] }} }}
            "#,
            speed = shear * height / 0.01,
            force = pressure * 0.18
        ),
    );
    let mut simulation = start(&text);
    run_to(&mut *simulation, 0.025, |_| {});
    let before = simulation.joints()[0].impulse;
    run_to(&mut *simulation, 0.03, |_| {});
    let joint = simulation.joints()[0].impulse;
    let mean = means(&*simulation, |x| (0.07..0.11).contains(&x[0]));
    let [normal, across] = [1, 3].map(|i| mean(&|snapshot, p| snapshot.stress[p][i]));
    let (normal, across) = (normal / -pressure, across / (SHEAR * shear));
    let held = -(joint[1] - before[1]) / 5e-3 / (pressure * 0.18);
    println!("shear: normal {normal:.4}, shear {across:.4}; the slider holds {held:.4}");
    assert!((normal - 1.0).abs() < 0.02 && (across - 1.0).abs() < 0.02, "{normal} {across}");
    assert!((held - 1.0).abs() < 0.01, "{held}");
}
