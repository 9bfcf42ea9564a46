//! Walls that hold a force: rigid and free plates on sliders.
//!
//! Source: Hooke's law.
//!
//! | set-up | expected |
//! |---|---|
//! | a bar in plane stress that two plates glued to its ends pull with a force each, which grows for 10 ms | stress and strain in its middle within 1 % (0.05 and 0.08 %) |
//! | an eighth of a cube, cut by three mirrors; plates that slide along the mirrors hold a pressure on two of its sides, and one presses the third in: a triaxial test | the pressure, and E eps + 2 nu p, within 2 % (1.4 and 0.9 %) |
//! | a periodic layer, glued to two plates, of which one moves along and the other holds a pressure: simple shear to 5 % | in its middle third the pressure, at all times, and G gamma within 1 % (0.3 and 0.2 %) |
//!
//! Glue joins nodes, and the nodes at a glued face belong to both bodies: within a cell of it the layer carries less,
//! so the mean over all of its rows is 7 % below the pressure.

use crate::trial::{mean_where, run_to, start};
use stickslip::door::ParticleSnapshot;

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
        interior = "grid"
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

/// Mean of an entry of the stress of the first body [Pa].
fn mean_stress(snapshot: &ParticleSnapshot, entry: usize) -> f64 {
    mean_where(snapshot, |p| snapshot.body[p] == 0, |p| snapshot.stress[p][entry])
}

#[test]
#[ignore = "slow: a minute"]
fn a_triaxial_test_on_an_eighth_of_a_cube() {
    let (young, poisson, pressure, strain, side) = (1e6, 0.3, 1e4, 0.01, 0.4);
    let plate = |axis: usize| {
        let corner =
            |x: f64, along: f64| -> [f64; 3] { std::array::from_fn(|k| if k == axis { along } else { x }) };
        let name = ["plate x", "plate y", "plate z"][axis];
        let direction = corner(0.0, 1.0);
        let held = if axis < 2 {
            let force = pressure * side * side;
            format!(
                r#"
                rigid.free.mass = 2
                [[joints]]
                body = "{name}"
                slider = {{ axis = {direction:?}, force = "-{force} * min(t / 0.05, 1)", dashpot = 1000 }}
                "#
            )
        } else {
            format!(
                "rigid.velocity = [0, 0, \"if(t < 0.1, -{} * (1 - cos(20 * pi * t)), 0)\"]",
                strain * side / 0.1
            )
        };
        format!(
            r#"
            [[bodies]]
            name = "{name}"
            material = "gel"
            shape.box = {{ min = {:?}, max = {:?} }}
            {held}
            "#,
            corner(0.0, side),
            corner(side, side + 0.1)
        )
    };
    let text = format!(
        r#"
        damping.local = 0.2
        [space]
        dimension = "3d"
        interior = "grid"
        cell = 0.05
        [space.domain]
        min = [0, 0, 0]
        max = [0.6, 0.6, 0.6]
        x_min = "symmetry"
        y_min = "symmetry"
        z_min = "symmetry"
        [time]
        end = 0.2
        [materials]
        gel = {{ density = 1000, neo_hookean = {{ young_modulus = {young}, poisson_ratio = {poisson} }} }}
        [[bodies]]
        name = "cube"
        material = "gel"
        shape.box = {{ min = [0, 0, 0], max = [{side}, {side}, {side}] }}
        # Plates that lean on each other would carry a part of the force.
        [[contact]]
        between = ["plate *", "plate *"]
        law = "none"
        {}{}{}
        "#,
        plate(0),
        plate(1),
        plate(2),
    );
    let mut simulation = start(&text);
    run_to(&mut *simulation, 0.2, |_| {});
    let snapshot = simulation.snapshot();
    let [x, y, z] = [0, 1, 2].map(|entry| mean_stress(&snapshot, entry));
    let axial = -young * strain - 2.0 * poisson * pressure;
    println!("lateral {:.4} and {:.4}, axial {:.4}", -x / pressure, -y / pressure, z / axial);
    for off in [-x / pressure, -y / pressure, z / axial] {
        assert!((off - 1.0).abs() < 0.02, "{x} {y} {z}");
    }
}

/// A layer without end between two plates that are glued to it: the lower one moves along, the upper one holds a
/// pressure (`scenes/sheared_layer.toml`).
#[test]
fn a_layer_sheared_at_constant_pressure() {
    let mut simulation = start(include_str!("../../../scenes/sheared_layer.toml"));
    let (pressure, shear_modulus) = (4e3, 1e6 / 2.6);
    let (mut worst, mut steps) = ([0.0_f64; 2], 0);
    run_to(&mut *simulation, 0.8, |simulation| {
        steps += 1;
        if simulation.time() < 0.2 || steps % 20 != 0 {
            return;
        }
        let snapshot = simulation.snapshot();
        let middle = |p: usize| snapshot.body[p] == 0 && (0.2..0.4).contains(&snapshot.position[p][1]);
        let mean = |quantity: &dyn Fn(usize) -> f64| mean_where(&snapshot, middle, quantity);
        let held = mean(&|p| -snapshot.stress[p][1]) / pressure;
        worst[0] = worst[0].max((held - 1.0).abs());
        // The slope of the way over the height, by least squares; at the start x is as spread in every row.
        let [x, y] = [0, 1].map(|axis| mean(&|p| snapshot.position[p][axis]));
        let spread = |axis: usize, from: f64| {
            mean(&|p| (snapshot.position[p][axis] - from) * (snapshot.position[p][1] - y))
        };
        let gamma = spread(0, x) / spread(1, y);
        if gamma.abs() > 0.01 {
            let shear = mean(&|p| snapshot.stress[p][3]) / (shear_modulus * gamma);
            worst[1] = worst[1].max((shear - 1.0).abs());
        }
    });
    println!(
        "the pressure is off by {:.2} %, the shear stress by {:.2} %",
        100.0 * worst[0],
        100.0 * worst[1]
    );
    assert!(worst[1] > 0.0 && worst.iter().all(|&worst| worst < 0.01), "{worst:?}");
}
