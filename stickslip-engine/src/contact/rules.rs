//! Which rule holds for a pair of bodies, looked up without a table of all pairs.

use super::Friction;
use super::law::{Span, law};
use crate::scene::{ContactLaw, ContactRule, Normal, Scene};
use crate::tensor::Real;
use std::collections::HashMap;

/// A contact rule in the precision of the engine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule<T> {
    /// The contact law.
    pub law: ContactLaw,
    /// Where the direction comes from.
    pub normal: Normal,
    /// Resistance against slip and against parting.
    pub friction: Friction<T>,
    /// Largest strain of a cell by contact in one step, the paper's gamma.
    pub max_strain: T,
}

impl<T: Real> From<&ContactRule> for Rule<T> {
    fn from(rule: &ContactRule) -> Self {
        Rule {
            law: rule.law,
            normal: rule.normal,
            friction: Friction::from(rule),
            max_strain: T::of(rule.max_strain),
        }
    }
}

/// The scene's rules, found by the names of a pair's bodies and materials. Space and time follow the rules,
/// never pairs of bodies.
#[derive(Clone, Debug, Default)]
pub struct Rules<T> {
    /// The scene's rules in their order, and the rule for all other pairs.
    rules: Vec<Rule<T>>,
    /// Each body's names that rules mention: its own, its material's, and `ANY`.
    names: Vec<[Option<u32>; 3]>,
    /// The first rule that mentions two names.
    first: HashMap<[u32; 2], usize>,
    /// The rule for two bodies of which rules mention no name.
    plain: usize,
}

/// Stands for every body.
const ANY: u32 = 0;

impl<T: Real> Rules<T> {
    /// The rules of a scene.
    pub fn new(scene: &Scene) -> Self {
        let mut numbers = HashMap::new();
        let mut first = HashMap::new();
        for (index, rule) in scene.contact.iter().enumerate() {
            let [a, b] = rule.between.each_ref().map(|name| match name {
                Some(name) => {
                    let next = numbers.len() as u32 + 1;
                    *numbers.entry(name.as_str()).or_insert(next)
                }
                None => ANY,
            });
            first.entry([a, b]).or_insert(index);
            first.entry([b, a]).or_insert(index);
        }
        let number = |name: &str| numbers.get(name).copied();
        let names = (scene.bodies.iter())
            .map(|body| [number(&body.name), number(&scene.materials[body.material].name), Some(ANY)])
            .collect();
        let default = ContactRule::default();
        let rules: Vec<_> = scene.contact.iter().chain([&default]).map(Rule::from).collect();
        let plain = first.get(&[ANY; 2]).copied().unwrap_or(rules.len() - 1);
        Rules { rules, names, first, plain }
    }

    /// Rules to be asked for by their numbers; the first holds between all bodies.
    #[cfg(test)]
    pub fn listed(bodies: usize, rules: Vec<Rule<T>>) -> Self {
        let first = HashMap::from([([ANY, ANY], 0)]);
        Rules { rules, names: vec![[None, None, Some(ANY)]; bodies], first, plain: 0 }
    }

    /// Number of the rule for two bodies: the first in the scene that matches, else the last.
    pub fn number(&self, a: usize, b: usize) -> usize {
        if [a, b].iter().all(|&body| self.names[body] == [None, None, Some(ANY)]) {
            return self.plain;
        }
        let pairs = self.names[a]
            .iter()
            .flatten()
            .flat_map(|&x| self.names[b].iter().flatten().map(move |&y| [x, y]));
        pairs.filter_map(|pair| self.first.get(&pair)).min().copied().unwrap_or(self.rules.len() - 1)
    }

    /// Whether a law holds for any pair that there may be.
    pub fn uses(&self, law: ContactLaw) -> bool {
        self.rules.iter().any(|rule| rule.law == law)
    }

    /// Whether any law judges the interpolated velocities by themselves, as the paper's do.
    pub fn judge_interpolated(&self) -> bool {
        let judges =
            |rule: &Rule<T>| rule.law != ContactLaw::None && law::<T, 3>(rule.law).span() == Span::EachUse;
        self.rules.iter().any(judges)
    }

    /// A rule by its number.
    pub fn rule(&self, number: usize) -> &Rule<T> {
        &self.rules[number]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_rule_that_matches_holds_as_in_the_scene() {
        let text = r#"
            space = { dimension = "plane-strain", cell = 1 }
            time.end = 1
            materials.clay = { density = 1, neo_hookean = { young_modulus = 1, poisson_ratio = 0 } }
            materials.iron = { density = 1, neo_hookean = { young_modulus = 9, poisson_ratio = 0 } }
            bodies = [
                { name = "a", material = "clay", shape.ball = { center = [0, 0], radius = 1 } },
                { name = "b", material = "iron", shape.ball = { center = [4, 0], radius = 1 } },
                { name = "c", material = "iron", shape.ball = { center = [8, 0], radius = 1 } },
            ]
            contact = [
                { between = ["c", "a"], friction = 0.1 },
                { between = ["clay", "iron"], friction = 0.2 },
                { between = ["any", "c"], friction = 0.3 },
            ]"#;
        let scene = crate::scene::parse("rules.toml", text, &[]).expect("a scene").scene;
        let rules = Rules::<f64>::new(&scene);
        for (a, b, friction) in [(0, 2, 0.1), (0, 1, 0.2), (1, 2, 0.3), (2, 2, 0.3), (1, 1, 0.0)] {
            for (a, b) in [(a, b), (b, a)] {
                assert_eq!(
                    rules.rule(rules.number(a, b)),
                    &Rule::from(&scene.contact_between(a, b)),
                    "{a} {b}"
                );
                assert_eq!(rules.rule(rules.number(a, b)).friction, Friction::coulomb(friction), "{a} {b}");
            }
        }
    }
}
