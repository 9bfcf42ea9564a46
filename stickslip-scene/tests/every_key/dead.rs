//! Keys that do nothing in some scenes: each is refused, or told of where it stands.

use crate::{PLANE, read};

/// What a scene with these keys is told of, or refused for.
fn said(set: &[(&str, &str)]) -> String {
    match read(PLANE, set) {
        Err(error) => format!("refused: {error}"),
        Ok(loaded) => {
            let told = loaded.source.told().iter().filter(|(key, _)| key != "shapes.tip");
            told.map(|(key, why)| format!("{key}: {why}")).collect::<Vec<_>>().join("\n")
        }
    }
}

#[test]
fn keys_of_rules_whose_bodies_are_glued_or_left_alone_are_told_of() {
    for (law, why) in [("glued", "bodies that are glued move as one"), ("none", "bodies do not touch")] {
        for (key, value) in [
            ("friction", "0.5"),
            ("cohesion", "5"),
            ("adhesion", "3"),
            ("viscosity", "2"),
            ("restitution", "0.5"),
            ("normal", "common"),
        ] {
            let (key, rule) = (format!("contact[0].{key}"), format!("[{{ law = '{law}' }}]"));
            let found = said(&[("contact", &rule), (&key, value)]);
            assert!(found.starts_with(&format!("{key}: does not act: ")) && found.contains(why), "{found}");
        }
        let all = format!("[{{ law = '{law}', friction = 0.5, cohesion = 5, adhesion = 3 }}]");
        let found = said(&[("contact", &all)]);
        let start = "contact[0].friction: does not act, nor do `cohesion`, `adhesion`: ";
        assert!(found.starts_with(start), "{found}");
        // What is nothing anyway may stand there: a sweep over laws has it.
        let nothing = format!("[{{ law = '{law}', friction = 0, cohesion = 0 }}]");
        assert_eq!(said(&[("contact", &nothing)]), "");
    }
}

#[test]
fn a_memory_of_no_friction_is_told_of() {
    for (friction, law, why) in [
        ("0", "surface", "does not act, nor does `friction_memory_speed`: the rule has no friction"),
        ("'inf'", "surface", "does not act, nor does `friction_memory_speed`: surfaces that stick"),
        ("0", "none", "does not act: by the law \"none\" bodies do not touch"),
    ] {
        let memory = "friction_memory_length = 1, friction_memory_speed = 1";
        let rule = format!("[{{ law = '{law}', friction = {friction}, {memory} }}]");
        let found = said(&[("contact", &rule)]);
        assert!(found.starts_with(&format!("contact[0].friction_memory_length: {why}")), "{found}");
        let rubs = rule.replace(&format!("friction = {friction},"), "friction = 0.5,");
        assert_eq!(said(&[("contact", &rubs)]).is_empty(), law == "surface");
    }
}

#[test]
fn keys_that_need_another_beside_them_are_refused_without() {
    for (set, expected) in [
        (
            &[("contact", "[{ friction = 0.5, friction_decay_speed = 1 }]")][..],
            "contact[0].friction_decay_speed: found 1; allowed: a `kinetic_friction` beside it",
        ),
        (
            &[("contact", "[{ friction = 0.5, friction_memory_length = 1 }]")],
            "contact[0].friction_memory_length: found 1; allowed: 0, or a `friction_memory_speed` beside it",
        ),
        (
            &[("contact", "[{ friction = 0.5, friction_memory_speed = 1 }]")],
            "contact[0].friction_memory_speed: found 1; allowed: a `friction_memory_length` beside it",
        ),
        (
            &[("contact", "[{ press_time = 1 }]")],
            "contact[0].press_time: found 1; allowed: overlap = \"press\" beside it",
        ),
        (
            &[("contact", "[{ law = 'gap', overlap = 'press' }]")],
            "contact[0].overlap: found \"press\"; allowed: \"press\" with law = \"surface\" only",
        ),
        (
            &[("springs", "[{ from.body = 'a', to.body = 'b', dashpot = 1, length = 2 }]")],
            "springs[0].length: found 2; allowed: a `stiffness` beside it",
        ),
        (
            &[(
                "joints",
                "[{ body = 'c', spring = { from = [0, 0], to = [1, 0], dashpot = 1, length = 2 } }]",
            )],
            "joints[0].spring.length: found 2; allowed: a `stiffness` beside it",
        ),
        (
            &[
                ("outputs.probes", "[{ name = 'p', at = [0, 0] }]"),
                ("outputs.arrivals", "[{ quantity = 'speed', threshold = 1, reading = 'mean' }]"),
            ],
            "outputs.arrivals[0].reading: found \"mean\"; allowed: `bodies` beside it",
        ),
        (
            &[("outputs.arrivals", "[{ quantity = 'vz', threshold = 1, bodies = ['a'] }]")],
            "outputs.arrivals[0].quantity: found \"vz\"; allowed: a quantity that the plane has",
        ),
    ] {
        let found = said(set);
        assert!(found.starts_with("refused: ") && found.contains(expected), "{found}");
    }
}

#[test]
fn outputs_that_nothing_comes_of_are_told_of() {
    for (set, expected) in [
        (
            &[("outputs.particles_at", "[0.5, 2]")][..],
            "outputs.particles_at[1]: this time is after the end of the run, 1 s: no snapshot comes of it",
        ),
        (
            &[("outputs.particles_at", "[3, 2]")],
            "outputs.particles_at[0]: 2 times are after the end of the run, 1 s: no snapshot comes of it",
        ),
        (
            &[("outputs.particles", "never"), ("outputs.snapshots.every", "2")],
            "outputs.snapshots: does not act: the scene has no snapshots of particles, surfaces or the grid",
        ),
        (
            &[("outputs.surface_format", "glb")],
            "outputs.surface_format: does not act: the scene has no outputs.surfaces",
        ),
        (
            &[("outputs.samples", "step")],
            "outputs.samples: does not act: the scene has no probes, arrivals or fronts",
        ),
        (
            &[("outputs.fringes", "{ interval = 0.1, stress_parameter = 1e6, first = 5, bodies = ['a'] }")],
            "outputs.fringes.first: the first frame, at 5 s, is after the end of the run, 1 s",
        ),
    ] {
        assert_eq!(said(set), expected);
    }
}

#[test]
fn what_nothing_uses_is_told_of_once() {
    let told = |set: &[(&str, &str)]| {
        let loaded = read(PLANE, set).unwrap_or_else(|error| panic!("{error}"));
        loaded.source.told().to_vec()
    };
    let line = |key: &str, why: &str| vec![(key.to_string(), why.to_string())];
    assert_eq!(told(&[]), line("shapes.tip", "nothing in the scene uses it"));
    assert_eq!(told(&[("bodies[0].shape", "tip")]), []);
    let more = [
        ("parameters", "{ r = '1 cm', frictoin = 0.3, one = 1 }"),
        ("title", "one of a kind, not {one}"),
        ("materials.n", "{ density = 1, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }"),
    ];
    let why = "nothing in the scene uses it, nor `materials.n`, `shapes.tip`";
    assert_eq!(told(&more), line("parameters.frictoin", why));
}
