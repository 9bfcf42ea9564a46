//! `fabric.csv`: the stress of a packing by Love and Weber is the pressure of the walls that hold it.
//!
//! Source: equilibrium. For bodies that rest under the forces of their contacts alone, sum x_i f_j over the forces of
//! the walls is V times the mean stress, whatever is between.
//!
//! Set-up: plane strain, 25 soft disks of two sizes, four cells on the diameter of the smaller, between four walls
//! without friction that close in, stop, and wait; viscous damping brings the disks to rest. The box of the record is
//! that of the walls at the end; a second one is its middle.
//!
//! Expected: xx and yy within 4 % of what the walls bear over their lengths, as the centre of a contact lies at nodes, up
//! to half a cell from the wall: measured 2.3 and 2.2 % lower, a quarter of a cell over half the box; xy below a tenth of
//! these; the trace of the fabric one; the coordination number that of `contacts.csv`, and the share of solid that of
//! `bodies.csv`, exactly; in the middle the stress of the whole within a third, as of seven disks.

use std::collections::HashMap;
use std::f64::consts::PI;
use stickslip::observe::Results;
use stickslip::run::RunOptions;
use stickslip::{run, scene, step};

const COUNT: usize = 25;

#[test]
fn the_stress_of_a_packing_is_the_pressure_of_its_walls() {
    let side = (COUNT as f64 * PI * (0.25 + 0.49) / 2.0 / 0.8).sqrt();
    let (moves, end, way) = (100.0, 160.0, 0.06 * side);
    let wall = |name: &str, point: [f64; 2], normal: [f64; 2]| {
        let velocity =
            normal.map(|n| format!("\"if(t < {moves} s, {} m/s, 0 m/s)\"", n * way / moves)).join(", ");
        format!(
            "[[bodies]]\nname = \"{name}\"\nmaterial = \"soft\"\nrigid.velocity = [{velocity}]\n\
             shape.half_space = {{ point = {point:?}, normal = {normal:?} }}\n"
        )
    };
    let walls = [
        wall("left", [0.0, 0.0], [1.0, 0.0]),
        wall("right", [side, 0.0], [-1.0, 0.0]),
        wall("below", [0.0, 0.0], [0.0, 1.0]),
        wall("above", [0.0, side], [0.0, -1.0]),
    ];
    let (low, high) = (way, side - way);
    let (inner_low, inner_high) = (low + 0.2 * side, high - 0.2 * side);
    let text = format!(
        r#"
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.25 }}
        time.end = {end}
        damping.viscous = 0.5
        materials.soft = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }} }}
        {}
        [[packings]]
        name = "disk"
        material = "soft"
        shape.ball = {{ center = [0, 0], radius = 0.5 }}
        sizes.numbers = [[1, 1], [1.4, 1]]
        within.box = {{ min = [0, 0], max = [{side}, {side}] }}
        count = {COUNT}
        seed = 1
        [outputs]
        particles = "never"
        tables = 5
        reactions = ["left", "right", "below", "above"]
        [[outputs.fabric]]
        name = "whole"
        within = {{ min = [{low}, {low}], max = [{high}, {high}] }}
        [[outputs.fabric]]
        name = "middle"
        bodies = ["disk *"]
        within = {{ min = [{inner_low}, {inner_low}], max = [{inner_high}, {inner_high}] }}
        "#,
        walls.concat()
    );
    let scene = scene::parse("packing.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    let out = tempfile::tempdir().unwrap();
    let options = RunOptions { threads: 1, ..RunOptions::new(out.path()) };
    run::run(&scene, &mut *step::build(&scene).unwrap(), &options, &mut |_| {}).unwrap();
    let results = Results::open(out.path()).unwrap();

    let last = |rows: Vec<(String, f64, [f64; 3])>| -> HashMap<String, [f64; 3]> {
        let time = rows.iter().map(|row| row.1).fold(0.0, f64::max);
        rows.into_iter().filter(|row| row.1 == time).map(|(name, _, force)| (name, force)).collect()
    };
    let reactions = results.reactions_table().unwrap().into_iter();
    let on = last(reactions.map(|row| (row.reaction.clone(), row.time, row.force)).collect());
    let length = high - low;
    let pressure =
        [0.5 * (on["right"][0] - on["left"][0]) / length, 0.5 * (on["above"][1] - on["below"][1]) / length];
    let rows = results.fabric_table().unwrap();
    let [.., whole, middle] = &rows[..] else { panic!("two rows at each time") };
    println!("walls {pressure:?}, Love-Weber {:?}, middle {:?}", whole.stress, middle.stress);
    println!(
        "Z {:.3}, mechanical {:.3}, solid {:.3}, fabric {:?}",
        whole.coordination, whole.mechanical, whole.solid, whole.fabric
    );
    assert_eq!((whole.packing.as_str(), middle.packing.as_str(), whole.bodies), ("whole", "middle", COUNT));
    assert!(pressure.iter().all(|p| *p > 0.01), "the walls press: {pressure:?}");
    for k in 0..2 {
        assert!((-whole.stress[k] / pressure[k] - 1.0).abs() < 0.04, "{:?} {pressure:?}", whole.stress);
        assert!(
            (middle.stress[k] / whole.stress[k] - 1.0).abs() < 0.34,
            "{:?} {:?}",
            middle.stress,
            whole.stress
        );
    }
    assert!(whole.stress[3].abs() < 0.1 * pressure[0], "{:?}", whole.stress);
    assert!((whole.fabric[0] + whole.fabric[1] - 1.0).abs() < 1e-9, "{:?}", whole.fabric);
    let contacts = results.contacts_table().unwrap();
    let time = whole.time;
    let ends = contacts.iter().filter(|row| row.time == time).flat_map(|row| [&row.body_a, &row.body_b]);
    let of_disks = ends.filter(|name| name.starts_with("disk")).count();
    assert_eq!(whole.coordination, of_disks as f64 / COUNT as f64);
    let bodies = results.bodies_table().unwrap();
    let of_disks = bodies.iter().filter(|row| row.time == time && row.body.starts_with("disk"));
    // Their density is one.
    let area: f64 = of_disks.map(|row| row.state.mass).sum();
    assert!((whole.solid * length * length / area - 1.0).abs() < 1e-9, "{}", whole.solid);
    assert_eq!(rows.len(), 2 * (end / 5.0) as usize, "each time but the first");
}
