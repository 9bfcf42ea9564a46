//! Whom bodies with interior "reference" may touch, and by which rules.

use super::{interior_key, is_reference, is_solid, material, may_part};
use crate::geometry::{Curved, Shape};
use crate::scene::{ContactLaw, ContactRule, Problem, RuleNames, Scene, StressUpdate};
use std::collections::BTreeMap;

/// What a rule of such bodies cannot say yet: a key, what the rule says there if that is refused, and what is allowed.
type Refusal = (&'static str, fn(&ContactRule) -> Option<String>, &'static str);

const OF_RULE: &[Refusal] = &[
    (
        "law",
        |rule| (!matches!(rule.law, ContactLaw::Surface | ContactLaw::Glued)).then(|| law(rule)),
        "\"surface\", the default, \"none\", or \"glued\" to a rigid body or another such body",
    ),
    ("restitution", |rule| above_zero(rule.restitution), "0, the default"),
    ("overlap", |rule| rule.press.map(|_| "\"press\"".to_string()), "\"kept\", the default"),
];

fn law(rule: &ContactRule) -> String {
    let word = ContactLaw::words().find(|word| word.1 == rule.law).map_or("", |word| word.0);
    format!("{word:?}")
}

fn above_zero(value: f64) -> Option<String> {
    (value > 0.0).then(|| value.to_string())
}

/// Which sides of a contact the engine tells apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Side {
    /// It deforms on its own undeformed places.
    Reference,
    /// It deforms on the grid.
    Grid,
    /// It is rigid, and forces move it.
    FreeRigid,
    /// It is rigid, and moves as prescribed.
    Prescribed,
}

impl Side {
    fn of(scene: &Scene, body: usize) -> Side {
        match &scene.bodies[body] {
            body if body.is_prescribed() => Side::Prescribed,
            body if body.is_rigid() => Side::FreeRigid,
            _ if is_reference(scene, body) => Side::Reference,
            _ => Side::Grid,
        }
    }
}

/// # Errors
/// Two bodies of which one has interior "reference" and that meet in a way which the engine does not know, or two
/// without it whose friction has a memory.
pub(super) fn check(scene: &Scene) -> Result<(), Problem> {
    let none = (0..scene.bodies.len()).all(|body| !is_reference(scene, body));
    if none && scene.contact.iter().all(|rule| rule.friction_memory.is_none()) {
        return Ok(());
    }
    let names = RuleNames::new(scene);
    // Bodies that neither rules nor the engine tell from each other: pairs of these are few where bodies are many.
    let mut alike: BTreeMap<(Side, usize), Vec<usize>> = BTreeMap::new();
    for body in 0..scene.bodies.len() {
        alike.entry((Side::of(scene, body), names.class(body))).or_default().push(body);
    }
    let joined = scene.joined_pairs();
    let groups: Vec<_> = alike.iter().collect();
    for (i, (first, of_first)) in groups.iter().enumerate() {
        for (second, of_second) in &groups[i..] {
            if [first.0, second.0] == [Side::Prescribed; 2] {
                continue;
            }
            let mut pairs = of_first.iter().flat_map(|&a| of_second.iter().map(move |&b| [a, b]));
            let Some(pair) = pairs.find(|&[a, b]| a != b && scene.may_touch([a, b], &joined)) else {
                continue;
            };
            let rule = names.rule(first.1, second.1);
            let found = match (first.0, second.0) {
                (Side::Reference, Side::Grid) => {
                    refused(scene, pair, rule).or_else(|| unlike(scene, pair, rule))
                }
                (Side::Reference, _) => refused(scene, pair, rule),
                _ => memory(scene, pair, rule),
            };
            found.map_or(Ok(()), Err)?;
        }
    }
    Ok(())
}

/// The first thing that the rule of two bodies that may meet cannot say.
fn refused(scene: &Scene, [a, b]: [usize; 2], rule: Option<usize>) -> Option<Problem> {
    let number = rule?;
    let rule = &scene.contact[number];
    if rule.law == ContactLaw::None {
        return None;
    }
    // Glue makes one body of two on the common grid, to which no layer belongs.
    let joins = rule.law == ContactLaw::Glued && Side::of(scene, b) == Side::Grid;
    let (key, found, allowed) = OF_RULE.iter().find_map(|(key, found, allowed)| {
        let found = if joins && *key == "law" { Some(law(rule)) } else { found(rule) };
        Some((key, found?, allowed))
    })?;
    let [name, other] = [a, b].map(|body| &scene.bodies[body].name);
    let grid = if scene.bodies[b].is_rigid() { format!("`{name}`") } else { "both".to_string() };
    Some(Problem {
        key: format!("contact[{number}].{key}"),
        found: format!("{found} between `{name}` and `{other}`, where `{name}` has interior = \"reference\""),
        allowed: format!("{allowed}; or interior = \"grid\" for {grid}"),
        help: None,
    })
}

/// What a body on the grid cannot be that touches one with interior "reference": what it is, and what is allowed.
type Unlike = (fn(&Scene, usize) -> bool, &'static str, &'static str);

const ON_GRID: &[Unlike] = &[
    (
        |scene, _| scene.time.stress_update != StressUpdate::ModifiedLast,
        "is strained by time.stress_update",
        "\"modified-last\", the default",
    ),
    (|scene, _| scene.periods() != [0.0; 3], "lies between periodic faces", "open, mirror or fixed faces"),
    (
        |scene, body| matches!(scene.bodies[body].shape, Shape::Curved(Curved::PointCloud(_))),
        "is a point cloud",
        "a shape that has a surface",
    ),
    (
        |scene, body| may_part(material(scene, body)),
        "may part by its law",
        "a law that leaves material in one piece",
    ),
    (|scene, body| !is_solid(material(scene, body)), "is a fluid", "a solid"),
];

/// What a body on the grid cannot be that one with interior "reference" may touch.
fn unlike(scene: &Scene, [a, b]: [usize; 2], rule: Option<usize>) -> Option<Problem> {
    if rule.is_some_and(|rule| scene.contact[rule].law == ContactLaw::None) {
        return None;
    }
    let (_, is, allowed) = ON_GRID.iter().find(|(is, ..)| is(scene, b))?;
    let [name, with] = [a, b].map(|body| &scene.bodies[body].name);
    let by = rule.map_or("as no rule names the pair".to_string(), |rule| format!("by contact[{rule}]"));
    Some(Problem {
        key: interior_key(scene, a),
        found: format!(
            "\"reference\" of `{name}`, which may touch `{with}`, {by}; that has interior = \"grid\" and {is}"
        ),
        allowed: format!("{allowed}; or the same interior for both"),
        help: Some("if the two never meet, a rule between them with law = \"none\" says so".to_string()),
    })
}

/// A rule with a memory of friction that holds between two bodies on the grid.
fn memory(scene: &Scene, [a, b]: [usize; 2], rule: Option<usize>) -> Option<Problem> {
    let number = rule?;
    let rule = &scene.contact[number];
    rule.friction_memory.filter(|memory| memory.length > 0.0)?;
    let [name, other] = [a, b].map(|body| &scene.bodies[body].name);
    // Those that are glued or left alone have no friction at all.
    (!matches!(rule.law, ContactLaw::None | ContactLaw::Glued)).then(|| Problem {
        key: format!("contact[{number}].friction_memory_length"),
        found: format!("a memory of friction between `{name}` and `{other}`"),
        allowed: "one of whose bodies one has interior = \"reference\"".to_string(),
        help: Some("a rule without a memory for this pair, before that one".to_string()),
    })
}
