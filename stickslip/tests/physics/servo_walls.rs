//! Walls that hold a force: rigid and free plates on sliders.
//!
//! Source: Hooke's law.
//!
//! Set-up: a bar in plane stress that two plates glued to its ends pull with a force each, which grows for 10 ms.
//!
//! Expected: stress and strain in its middle within 1 % (0.05 and 0.08 %).

use crate::trial::{mean_where, run_to, start};

#[test]
fn a_bar_pulled_by_plates_that_hold_a_force() {
    let force = 0.02 * 1e7 * 1e-3;
    let plate = |name: &str, min: f64, force: f64| {
        format!(
            r#"
            [[bodies]]
            name = "{name}"
            material = "plate"
            shape.box = {{ min = [{min}, -0.01], max = [{max}, 0.03] }}
            rigid.free = {{}}
            [[joints]]
            body = "{name}"
            slider = {{ axis = [1, 0], dashpot = 2000, force = "{force} * min(t / 0.01, 1)" }}
            "#,
            max = min + 0.02
        )
    };
    let text = format!(
        r#"
        time.end = 0.03
        damping.local = 0.2
        materials.gel = {{ density = 1000, neo_hookean = {{ young_modulus = 1e7, poisson_ratio = 0.3 }} }}
        materials.plate = {{ density = 100, neo_hookean = {{ young_modulus = 1e7, poisson_ratio = 0.3 }} }}
        contact = [{{ law = "glued" }}]
        [space]
        dimension = "plane-stress"
        cell = 0.01
        domain = {{ min = [-0.1, -0.1], max = [0.3, 0.2] }}
        [[bodies]]
        name = "bar"
        material = "gel"
        shape.box = {{ min = [0, 0], max = [0.12, 0.02] }}
        {}{}
        "#,
        plate("left", -0.02, -force),
        plate("right", 0.12, force)
    );
    let mut simulation = start(&text);
    run_to(&mut *simulation, 0.03, |_| {});
    let snapshot = simulation.snapshot();
    let middle = |p: usize| snapshot.body[p] == 0 && (0.03..0.09).contains(&snapshot.position[p][0]);
    let stress = mean_where(&snapshot, middle, |p| snapshot.stress[p][0]) / 1e4;
    let strain = (mean_where(&snapshot, middle, |p| snapshot.deformation[p][0]) - 1.0) / 1e-3;
    println!("stress {stress:.4}, strain {strain:.4}");
    assert!((stress - 1.0).abs() < 0.01 && (strain - 1.0).abs() < 0.01, "{stress} {strain}");
}
