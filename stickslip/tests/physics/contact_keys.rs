//! Every key of a contact rule changes how two blocks move, or is told of.
//!
//! Set-up: a block slides along another, falls on it or is drawn off it, for some tens of steps; the keys come from the
//! schema, so that one without a case fails.
//!
//! Expected: the velocities of the blocks differ from those without the key by more than round-off, and of a law by
//! which the key does nothing they are the same to the bit, and the reader says so. Keys that act by area do so on
//! grids of their own, too.

use crate::trial::run_to;
use std::collections::BTreeSet;
use stickslip::scene;

/// Velocity of the upper block, key of the rule that is there in both runs, and the key with its value.
const CASES: [([f64; 2], &str, &str); 12] = [
    ([0.5, -0.2], "", "friction = 0.5"),
    ([0.5, -0.2], "friction = 0.5", "kinetic_friction = 0.1"),
    ([0.5, -0.2], "friction = 0.5\nkinetic_friction = 0.1", "friction_decay_speed = 0.5"),
    ([0.5, -0.2], "", "cohesion = 300"),
    ([0.0, 0.3], "", "adhesion = 300"),
    ([0.5, -0.2], "", "viscosity = 300"),
    ([0.5, -0.2], "", "law = \"gap\""),
    ([0.5, -0.2], "law = \"kinematic\"\nfriction = 0.5", "normal = \"common\""),
    ([0.0, -1.5], "", "max_strain = 1e-3"),
    ([0.5, -0.2], "friction = 0.5", "between = [\"upper\", \"upper\"]"),
    ([0.0, 0.0], "", "overlap = \"press\""),
    ([0.0, 0.0], "overlap = \"press\"", "press_time = \"1 ms\""),
];

/// Velocities of both blocks and of single particles after a while, and what the reader tells of.
fn run(velocity: [f64; 2], rule: &str, rigid: &str) -> (Vec<f64>, String) {
    run_in("grid", velocity, rule, rigid)
}

/// The same on grids of some kind.
fn run_in(interior: &str, [vx, vy]: [f64; 2], rule: &str, rigid: &str) -> (Vec<f64>, String) {
    let text = format!(
        r#"
        space = {{ dimension = "plane-strain", interior = "{interior}", cell = 0.1 }}
        time.end = 1
        materials.gel = {{ density = 1000, neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "lower"
        material = "gel"
        shape.box = {{ min = [0, -0.3], max = [0.4, 0] }}
        {rigid}
        [[bodies]]
        name = "upper"
        material = "gel"
        shape.box = {{ min = [0, -1e-4], max = [0.4, 0.3] }}
        velocity = [{vx}, {vy}]
        {rigid}
        [[contact]]
        {rule}
        "#
    );
    let loaded = scene::parse("blocks.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let mut simulation = stickslip::step::build(&loaded.scene).expect("a sound scene");
    run_to(&mut *simulation, 0.1, |_| {});
    let bodies = simulation.bodies().into_iter().flat_map(|body| [body.velocity, body.spin].concat());
    let particles = simulation.snapshot().velocity.into_iter().flatten();
    let told: Vec<String> = loaded.source.told().iter().map(|(key, why)| format!("{key}: {why}")).collect();
    (bodies.chain(particles).collect(), told.join("\n"))
}

fn with(before: &str, key: &str) -> String {
    if before.is_empty() { key.to_string() } else { format!("{before}\n{key}") }
}

fn differ(one: &[f64], other: &[f64]) -> bool {
    one.iter().zip(other).any(|(a, b)| (a - b).abs() > 1e-9)
}

#[test]
fn every_key_of_a_rule_acts() {
    let schema = scene::schema();
    let keys = schema["$defs"]["Contact"]["properties"].as_object().expect("a table of contact rules");
    let mut left: BTreeSet<&str> = keys.keys().map(String::as_str).collect();
    for (velocity, before, key) in CASES {
        let name = key.split(' ').next().expect("a key");
        let (without, _) = run(velocity, before, "");
        let (acts, _) = run(velocity, &with(before, key), "");
        assert!(differ(&without, &acts), "{key} beside `{before}` changes nothing");
        left.remove(name);
    }
    // Of rigid bodies of which one is free.
    let free = "rigid.free = {}";
    let fall = [0.0, -1.0];
    assert!(differ(&run(fall, "friction = 0", free).0, &run(fall, "restitution = 0.5", free).0));
    left.remove("restitution");
    // Of bodies on grids of their own: `reference.rs` has a case.
    left.remove("friction_memory_length");
    left.remove("friction_memory_speed");
    assert!(left.is_empty(), "keys without a case: {left:?}");
}

#[test]
fn keys_by_area_act_on_grids_of_their_own() {
    for (velocity, key) in
        [([0.5, -0.2], "cohesion = 300"), ([0.0, 0.01], "adhesion = 3000"), ([0.5, -0.2], "viscosity = 300")]
    {
        let [without, acts] = ["", key].map(|rule| run_in("reference", velocity, rule, "").0);
        assert!(differ(&without, &acts), "{key} changes nothing");
    }
}

/// The laws that leave bodies alone or make them one have no use for these.
#[test]
fn keys_that_a_law_ignores_change_nothing_and_are_told_of() {
    for law in ["law = \"none\"", "law = \"glued\""] {
        let (without, silent) = run([0.5, -0.2], law, "");
        assert_eq!(silent, "");
        for key in ["friction = 0.5", "cohesion = 300", "adhesion = 300", "viscosity = 300"] {
            let (idle, told) = run([0.5, -0.2], &with(law, key), "");
            assert!(idle == without, "{key} acts with {law}");
            assert!(told.contains("does not act"), "{key} with {law}: {told}");
        }
    }
}
