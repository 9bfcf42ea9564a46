//! Which rule holds for a pair of bodies, looked up without a table of all pairs.

use super::law::{Span, law};
use super::{Friction, Growth};
use crate::check::{Interference, interferences};
use crate::scene::{ContactLaw, ContactRule, FrictionMemory, Normal, RuleNames, Scene};
use crate::tensor::Real;

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
    /// Coefficient of restitution between rigid bodies.
    pub restitution: f64,
    /// How friction remembers pressure, if the scene says.
    pub friction_memory: Option<FrictionMemory>,
    /// How bodies that overlap at the start are pressed apart, if they are.
    pub press: Option<Interference>,
}

impl<T: Real> From<&ContactRule> for Rule<T> {
    fn from(rule: &ContactRule) -> Self {
        Rule {
            law: rule.law,
            normal: rule.normal,
            friction: Friction::from(rule),
            max_strain: T::of(rule.max_strain),
            restitution: rule.restitution,
            friction_memory: rule.friction_memory,
            press: None,
        }
    }
}

/// The scene's rules, found by the names of a pair's bodies and materials. Space and time follow the rules,
/// never pairs of bodies.
#[derive(Clone, Debug, Default)]
pub struct Rules<T> {
    /// The scene's rules in their order, and the rule for all other pairs.
    rules: Vec<Rule<T>>,
    /// Which bodies they name.
    names: RuleNames,
    /// The rule for two classes of bodies, the classes of the first body in rows.
    by_class: Vec<usize>,
}

/// Of so many classes of bodies, all pairs are listed.
const FEW: usize = 256;

impl<T: Real> Rules<T> {
    /// The rules of a scene.
    pub fn new(scene: &Scene) -> Self {
        let default = ContactRule::default();
        let mut rules: Vec<Rule<T>> = scene.contact.iter().chain([&default]).map(Rule::from).collect();
        for (rule, press) in rules.iter_mut().zip(interferences(scene)) {
            rule.press = press;
        }
        Rules::named(RuleNames::new(scene), rules)
    }

    fn named(names: RuleNames, rules: Vec<Rule<T>>) -> Self {
        let classes = names.classes();
        let few = if classes <= FEW { classes } else { 0 };
        let pairs = (0..few).flat_map(|a| (0..few).map(move |b| [a, b]));
        let by_class = pairs.map(|[a, b]| names.rule(a, b).unwrap_or_else(|| rules.len() - 1)).collect();
        Rules { rules, names, by_class }
    }

    /// Rules to be asked for by their numbers; the first holds between all bodies.
    #[cfg(test)]
    pub fn listed(bodies: usize, rules: Vec<Rule<T>>) -> Self {
        Rules::named(RuleNames::alike(bodies), rules)
    }

    /// Number of the rule for two bodies: the first in the scene that matches, else the last.
    pub fn number(&self, a: usize, b: usize) -> usize {
        let ([a, b], classes) = ([a, b].map(|body| self.names.class(body)), self.names.classes());
        match self.by_class.get(a * classes + b) {
            Some(&rule) => rule,
            None => self.names.rule(a, b).unwrap_or(self.rules.len() - 1),
        }
    }

    /// Whether a law holds for any pair that there may be.
    pub fn uses(&self, law: ContactLaw) -> bool {
        self.rules.iter().any(|rule| rule.law == law)
    }

    /// Whether surfaces resist slip or parting by their area under any rule.
    pub fn bond(&self) -> bool {
        self.rules.iter().any(|rule| match rule.law {
            ContactLaw::None => false,
            ContactLaw::Glued => true,
            _ => rule.friction.bonds(),
        })
    }

    /// Whether any law judges the interpolated velocities by themselves, as the paper's do.
    pub fn judge_interpolated(&self) -> bool {
        let judges =
            |rule: &Rule<T>| rule.law != ContactLaw::None && law::<T, 3>(rule.law).span() == Span::EachUse;
        self.rules.iter().any(judges)
    }

    /// Whether all laws look at nothing of particles but places, shapes and volumes.
    pub fn judge_by_place(&self) -> bool {
        let by_place = |rule: &Rule<T>| rule.law == ContactLaw::None || law::<T, 3>(rule.law).by_place();
        self.rules.iter().all(by_place)
    }

    /// Whether surfaces of an interference fit still grow at a time [s].
    pub fn grow(&self, time: f64) -> bool {
        let grows = |fit: &Interference| Growth::<T>::of(fit, time, 1.0).recovery > T::ZERO;
        self.rules.iter().filter_map(|rule| rule.press.as_ref()).any(grows)
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
            space = { dimension = "plane-strain", interior = "grid", cell = 1 }
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
