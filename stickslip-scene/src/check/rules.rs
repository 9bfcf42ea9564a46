//! Which contact rule holds between which bodies, and rules that never do.

use super::neighbours::pairs_within;
use super::table::short;
use super::warning::Warning;
use crate::geometry::Bounds;
use crate::scene::{ContactLaw, ContactRule, FrictionMemory, Interior, RuleNames, Scene};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Scenes of so few bodies show all their pairs; others those that are near each other at the start or that a rule
/// names.
const FEW: usize = 5;

/// A contact rule with pairs for which it holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RuleReport {
    /// Its number in the scene's list, from 0; `None` is the default rule, which holds for pairs that no rule names.
    pub rule: Option<usize>,
    /// The contact law.
    pub law: ContactLaw,
    /// Coefficient of friction of surfaces that do not slip.
    pub friction: f64,
    /// Coefficient of friction of surfaces that slip fast.
    pub kinetic_friction: f64,
    /// How friction follows a change of pressure, where the rule says so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction_memory: Option<FrictionMemory>,
    /// Whether it follows as is usual for bodies on grids of their own, between some of the pairs.
    pub usual_memory: bool,
    /// Whether the rule says what its friction is; without, it is 0.
    pub friction_given: bool,
    /// Names of two bodies each, in the order of the scene.
    pub pairs: Vec<[String; 2]>,
}

impl RuleReport {
    /// Whether friction acts at all: bodies that are glued or left alone have none.
    pub fn rubs(&self) -> bool {
        !matches!(self.law, ContactLaw::None | ContactLaw::Glued)
    }

    /// Whether surfaces would rub and have no friction because nobody said how much.
    pub fn lacks_friction(&self) -> bool {
        self.rubs() && !self.friction_given && self.friction == 0.0
    }

    /// The coefficient, and why it is zero where nobody said so.
    pub fn friction(&self) -> String {
        let [rest, slip] = [self.friction, self.kinetic_friction].map(|x| x.to_string());
        match self.rule {
            _ if !self.rubs() => "-".into(),
            None => "0, as no rule names the pair: the default rule holds".into(),
            Some(rule) if !self.friction_given => format!("0, as contact[{rule}] gives none"),
            Some(rule) if rest == slip => format!("{rest}{}, by contact[{rule}]", self.memory()),
            Some(rule) => format!("{rest}, slipping {slip}{}, by contact[{rule}]", self.memory()),
        }
    }

    /// How friction follows a change of pressure, if not at once.
    fn memory(&self) -> String {
        match self.friction_memory {
            Some(FrictionMemory { length: 0.0, .. }) => String::new(),
            Some(FrictionMemory { length, speed }) => {
                format!(", with a memory of {} m and {} m/s", short(length), short(speed))
            }
            None if self.usual_memory => ", with a memory of five transits of a wave".to_string(),
            None => String::new(),
        }
    }
}

/// The rules that hold between bodies of a scene, in its order, the default rule last.
pub(super) fn rule_reports(scene: &Scene, boxes: &[Bounds]) -> Vec<RuleReport> {
    let count = scene.bodies.len();
    let pairs: BTreeSet<[usize; 2]> = if count <= FEW {
        (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b])).collect()
    } else {
        pairs_within(boxes, scene.discretization.cell).into_iter().chain(named_pairs(scene)).collect()
    };
    let (joined, names) = (scene.joined_pairs(), RuleNames::new(scene));
    let mut reports: BTreeMap<usize, RuleReport> = BTreeMap::new();
    for [a, b] in pairs.into_iter().filter(|&pair| scene.may_touch(pair, &joined)) {
        let rule = names.rule(names.class(a), names.class(b));
        let report = reports.entry(rule.unwrap_or(usize::MAX)).or_insert_with(|| {
            let ContactRule { law, friction, kinetic_friction, friction_memory, friction_given, .. } =
                rule.map_or_else(ContactRule::default, |rule| scene.contact[rule].clone());
            let pairs = Vec::new();
            RuleReport {
                rule,
                law,
                friction,
                kinetic_friction,
                friction_memory,
                usual_memory: false,
                friction_given,
                pairs,
            }
        });
        let remembers = [a, b].iter().any(|&body| scene.interior(body) == Interior::Reference);
        report.usual_memory |= remembers && report.friction_memory.is_none() && report.friction.is_normal();
        report.pairs.push([a, b].map(|body| scene.bodies[body].name.clone()));
    }
    reports.into_values().collect()
}

/// Pairs of bodies that have no friction because nobody said how much, by the first of them.
pub fn pairs_without_friction(scene: &Scene) -> Option<String> {
    let axes = scene.dimension.axes();
    let boxes = scene.bodies.iter().map(|body| body.shape.bounds(axes).unwrap_or(Bounds::EVERYTHING));
    let rules = rule_reports(scene, &boxes.collect::<Vec<_>>());
    let pairs = || rules.iter().filter(|rule| rule.lacks_friction()).flat_map(|rule| &rule.pairs);
    let [a, b] = pairs().next()?;
    let others = match pairs().count() - 1 {
        0 => String::new(),
        1 => ", and of 1 more pair,".to_string(),
        more => format!(", and of {more} more pairs,"),
    };
    Some(format!("the friction of `{a}` and `{b}`{others} is 0, as no [[contact]] says what it is"))
}

/// Pairs of bodies, not of materials, that contact rules name.
pub(super) fn named_pairs(scene: &Scene) -> BTreeSet<[usize; 2]> {
    let number: BTreeMap<_, _> = scene.bodies.iter().enumerate().map(|(i, body)| (&body.name, i)).collect();
    let pair = |rule: &ContactRule| {
        let [a, b] = rule.between.each_ref().map(|name| number.get(name.as_ref()?).copied());
        Some([a?.min(b?), a?.max(b?)]).filter(|[a, b]| a != b)
    };
    scene.contact.iter().filter_map(pair).collect()
}

/// How many bodies there are that no rule tells from each other.
#[derive(Clone, Copy, Default)]
struct BodyCount {
    deforming: usize,
    /// Rigid ones that forces move, and those that move as prescribed.
    free: usize,
    prescribed: usize,
    /// Those that deform on grids of their own.
    reference: usize,
}

impl BodyCount {
    fn all(self) -> usize {
        self.deforming + self.free + self.prescribed
    }
}

/// Rules, and how many bodies they mean.
pub(super) struct CountedRules<'a> {
    scene: &'a Scene,
    names: RuleNames,
    /// Of each class of bodies.
    counts: Vec<BodyCount>,
}

impl<'a> CountedRules<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        let names = RuleNames::new(scene);
        let mut counts = vec![BodyCount::default(); names.classes()];
        for (i, body) in scene.bodies.iter().enumerate() {
            let count = &mut counts[names.class(i)];
            *(match body {
                body if body.is_prescribed() => &mut count.prescribed,
                body if body.is_rigid() => &mut count.free,
                _ => &mut count.deforming,
            }) += 1;
            count.reference += usize::from(scene.interior(i) == Interior::Reference);
        }
        CountedRules { scene, names, counts }
    }

    /// Whether a rule matches pairs of rigid bodies of which one can be free, and no body that deforms.
    pub(super) fn is_of_rigid_bodies(&self, rule: usize) -> bool {
        let [first, second] = self.names.sides(rule);
        let mut all = first.chain(second).map(|class| self.counts[class]);
        let none_deforms = all.clone().all(|count| count.deforming == 0);
        none_deforms && all.any(|count| count.free > 0)
    }

    /// Why a rule's restitution does not act, if it does not.
    fn dead_restitution(&self, rule: usize) -> Option<String> {
        let [first, second] = self.names.sides(rule);
        let meet = |a: usize, b: usize| {
            let [p, q] = [a, b].map(|class| self.counts[class]);
            let others = q.free + q.prescribed - usize::from(a == b && p.free > 0);
            p.free * others + p.prescribed * q.free > 0
        };
        let acts = first.clone().any(|a| second.clone().any(|b| meet(a, b)));
        (self.scene.contact[rule].restitution > 0.0 && !acts).then(|| {
            "does not act: it is that of rigid bodies of which one is free, and the rule names none; bodies that deform \
             bounce as their material does"
                .to_string()
        })
    }

    /// Why a rule never holds, if it does not.
    fn idle(&self, rule: usize) -> Option<String> {
        let [first, second] = self.names.sides(rule);
        let (mut before, mut all_rigid) = (BTreeSet::new(), false);
        for a in first.clone() {
            for b in second.clone() {
                let [p, q] = [a, b].map(|class| self.counts[class]);
                let rigid = p.all() + q.all() == p.prescribed + q.prescribed;
                // Parts of one body touch where it has a grid of its own.
                if a == b && p.all() < 2 && p.reference == 0 {
                    continue;
                }
                match self.names.rule(a, b) {
                    _ if rigid => all_rigid = true,
                    Some(holds) if holds < rule => drop(before.insert(holds)),
                    _ => return None,
                }
            }
        }
        let pair = |rule: usize| {
            let between = self.scene.contact[rule].between.each_ref();
            between.map(|name| format!("\"{}\"", name.as_deref().unwrap_or("any"))).join(", ")
        };
        if !before.is_empty() {
            let mut named: Vec<_> =
                before.iter().take(MOST_NAMED).map(|&i| format!("contact[{i}] ([{}])", pair(i))).collect();
            if before.len() > MOST_NAMED {
                named.push(format!("{} more", before.len() - MOST_NAMED));
            }
            let comes = if named.len() == 1 { "comes" } else { "come" };
            return Some(format!(
                "never holds: {} {comes} before it for every pair that [{}] matches, and the first rule that matches \
                 holds; put the special rule first",
                named.join(", "),
                pair(rule)
            ));
        }
        if all_rigid {
            return Some(format!(
                "never acts: [{}] matches rigid bodies with prescribed motion only, and these do not push on each other",
                pair(rule)
            ));
        }
        let names = self.scene.contact[rule].between.iter().zip([first, second]);
        let without =
            names.filter_map(|(name, mut classes)| name.as_ref().filter(|_| classes.next().is_none()));
        let without: BTreeSet<_> = without.map(|name| format!("no body is of `{name}`")).collect();
        let why = match without.len() {
            0 => "it names one body twice, and a body on the common grid is in no contact with itself"
                .to_string(),
            _ => without.into_iter().collect::<Vec<_>>().join(", "),
        };
        Some(format!("never holds: [{}] matches no pair of bodies: {why}", pair(rule)))
    }
}

/// Rules that are named as those that come before another.
const MOST_NAMED: usize = 5;

/// Rules that hold for no pair of bodies, and why.
pub(super) fn idle(scene: &Scene) -> impl Iterator<Item = Warning> {
    let rules = CountedRules::new(scene);
    (0..scene.contact.len()).filter_map(move |rule| {
        let never = rules.idle(rule).map(|why| Warning::about(format!("contact[{rule}]"), why));
        never.or_else(|| {
            Some(Warning::about(format!("contact[{rule}].restitution"), rules.dead_restitution(rule)?))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(bodies: &str, contact: &str) -> Scene {
        let text = format!(
            "space = {{ dimension = 'plane-strain', cell = 0.1, interior = 'grid' }}\ntime.end = 1\n\
             materials.clay = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0 }} }}\n\
             materials.iron = {{ density = 1, neo_hookean = {{ young_modulus = 9, poisson_ratio = 0 }} }}\n\
             bodies = [{bodies}]\ncontact = [{contact}]\n"
        );
        crate::scene::parse("rules.toml", &text, &[]).expect("a scene").scene
    }

    fn ball(name: &str, material: &str, x: f64) -> String {
        format!(
            "{{ name = '{name}', material = '{material}', shape.ball = {{ center = [{x}, 0], radius = 1 }} }},"
        )
    }

    fn three() -> String {
        ball("a", "clay", 0.0) + &ball("b", "iron", 4.0) + &ball("c", "iron", 8.0)
    }

    fn warnings(bodies: &str, contact: &str) -> Vec<String> {
        idle(&scene(bodies, contact)).map(|warning| warning.to_string()).collect()
    }

    #[test]
    fn a_rule_behind_one_that_matches_all_its_pairs_is_named_with_it() {
        let shadowed = "{ friction = 0.1 }, { between = ['a', 'iron'], friction = 0.5 }";
        let found = warnings(&three(), shadowed);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(
            found[0].starts_with("contact[1]: never holds: contact[0] ([\"any\", \"any\"]) comes before it"),
            "{found:?}"
        );
        // By two rules together.
        let both = "{ between = ['a', 'b'] }, { between = ['c', 'a'] }, { between = ['clay', 'iron'] }";
        let found = warnings(&three(), both);
        assert!(
            found[0].contains("contact[0] ([\"a\", \"b\"]), contact[1] ([\"c\", \"a\"]) come "),
            "{found:?}"
        );
        // One pair is left to it.
        let part = "{ between = ['a', 'b'] }, { between = ['clay', 'iron'] }, { friction = 0.1 }";
        assert_eq!(warnings(&three(), part), [""; 0]);
    }

    #[test]
    fn many_rules_before_another_are_counted() {
        let others = ["b", "c", "d", "e", "f", "g", "h"];
        let bodies: String =
            others.iter().zip(1..).map(|(name, i)| ball(name, "iron", 4.0 * f64::from(i))).collect();
        let before: String = others.iter().map(|name| format!("{{ between = ['a', '{name}'] }}, ")).collect();
        let found =
            warnings(&(ball("a", "clay", 0.0) + &bodies), &(before + "{ between = ['clay', 'iron'] }"));
        assert!(found[0].contains("contact[4] ([\"a\", \"f\"]), 2 more come before it"), "{found:?}");
    }

    #[test]
    fn a_rule_whose_names_match_no_pair_says_why() {
        let found = warnings(&three(), "{ between = ['clay', 'clay'] }, { between = ['a', 'a'] }");
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found.iter().all(|text| text.contains("it names one body twice")), "{found:?}");
        let found = warnings(&ball("a", "clay", 0.0), "{ between = ['a', 'iron'] }");
        assert!(found[0].ends_with("matches no pair of bodies: no body is of `iron`"), "{found:?}");
        assert_eq!(warnings(&three(), "{ between = ['iron', 'iron'] }"), [""; 0]);
        // On a grid of its own parts of a body touch.
        let mut folding = scene(&three(), "{ between = ['a', 'a'] }");
        folding.discretization.interior = Interior::Reference;
        assert_eq!(idle(&folding).count(), 0);
    }

    #[test]
    fn a_rule_for_rigid_bodies_never_acts() {
        let rigid = |name: &str, x: f64| ball(name, "iron", x).replace("} },", "}, rigid = {} },");
        let bodies = ball("a", "clay", 0.0) + &rigid("b", 4.0) + &rigid("c", 8.0);
        let found = warnings(&bodies, "{ between = ['b', 'c'] }, { between = ['clay', 'iron'] }");
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(
            found[0].starts_with("contact[0]: never acts: [\"b\", \"c\"] matches rigid bodies"),
            "{found:?}"
        );
    }

    #[test]
    fn restitution_is_that_of_free_rigid_bodies() {
        let stiff = |name: &str, x: f64, free: &str| {
            ball(name, "iron", x).replace("} },", &format!("}}, rigid = {{ {free} }} }},"))
        };
        let bodies = ball("a", "clay", 0.0) + &stiff("b", 4.0, "") + &stiff("c", 8.0, "free = {}");
        let rules =
            "{ between = ['b', 'c'], restitution = 0.5 }, { between = ['a', 'c'], restitution = 0.5 }";
        let found = warnings(&bodies, rules);
        assert!(
            found.len() == 1 && found[0].starts_with("contact[1].restitution: does not act"),
            "{found:?}"
        );
    }

    #[test]
    fn every_pair_is_shown_with_its_rule_and_why_it_has_no_friction() {
        let rules = "{ between = ['a', 'b'], friction = 0.3 }, { between = ['a', 'c'], law = 'gap' }, \
                     { between = ['b', 'b'] }";
        let scene = scene(&three(), rules);
        let boxes = vec![Bounds::EVERYTHING; 3];
        let found = rule_reports(&scene, &boxes);
        let said: Vec<_> =
            found.iter().map(|report| (report.pairs[0].join(" "), report.friction())).collect();
        let expected = [
            ("a b", "0.3, by contact[0]"),
            ("a c", "0, as contact[1] gives none"),
            ("b c", "0, as no rule names the pair: the default rule holds"),
        ];
        assert_eq!(said, expected.map(|(pair, text)| (pair.to_string(), text.to_string())));
        assert_eq!(found[1].law, ContactLaw::Gap);
    }

    /// By the naive loop: the rule of every pair, as the scene has it.
    #[test]
    fn idle_rules_are_those_that_no_pair_has() {
        let names = ["a", "b", "c", "clay", "iron", "any"];
        let rule = |i: usize| format!("{{ between = ['{}', '{}'] }},", names[i % 6], names[i / 6 % 6]);
        for seed in 0..200_usize {
            let numbers: Vec<_> = (0..4).map(|k| (seed * 7919 + k * 104_729) / (k + 1) % 36).collect();
            let scene = scene(&three(), &numbers.iter().map(|&i| rule(i)).collect::<String>());
            let held: BTreeSet<_> = [[0, 1], [0, 2], [1, 2]]
                .into_iter()
                .filter_map(|[a, b]| scene.contact_rule_between(a, b))
                .map(|rule| format!("contact[{rule}]"))
                .collect();
            let all: BTreeSet<_> = (0..4).map(|rule| format!("contact[{rule}]")).collect();
            let found: BTreeSet<_> = idle(&scene).map(|warning| warning.key).collect();
            assert_eq!(found, &all - &held, "{numbers:?}");
        }
    }
}
