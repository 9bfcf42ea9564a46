//! Which rule holds for a pair of bodies, looked up without a table of all pairs.

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
    /// Coefficient of friction; infinity sticks.
    pub friction: T,
    /// Largest strain of a cell by contact in one step, the paper's gamma.
    pub max_strain: T,
}

impl<T: Real> From<&ContactRule> for Rule<T> {
    fn from(rule: &ContactRule) -> Self {
        Rule {
            law: rule.law,
            normal: rule.normal,
            friction: T::of(rule.friction),
            max_strain: T::of(rule.max_strain),
        }
    }
}

/// Rules between classes of bodies. Bodies of one class match the same names in the scene's rules, so the table grows with the
/// rules of the scene and not with its bodies.
#[derive(Clone, Debug, Default)]
pub struct Rules<T> {
    class: Vec<usize>,
    classes: usize,
    table: Vec<Rule<T>>,
}

impl<T: Real> Rules<T> {
    /// The rules of a scene.
    pub fn new(scene: &Scene) -> Self {
        let named = |name: &str| {
            scene.contact.iter().flat_map(|rule| &rule.between).any(|n| n.as_deref() == Some(name))
        };
        let mut members: Vec<usize> = Vec::new();
        let mut known = HashMap::new();
        let class = (scene.bodies.iter().enumerate())
            .map(|(i, body)| {
                let signature = (named(&body.name).then_some(&body.name), body.material);
                *known.entry(signature).or_insert_with(|| {
                    members.push(i);
                    members.len() - 1
                })
            })
            .collect();
        let pair = |&a: &usize| members.iter().map(move |&b| Rule::from(&scene.contact_between(a, b)));
        Rules { class, classes: members.len(), table: members.iter().flat_map(pair).collect() }
    }

    /// One rule between all bodies.
    #[cfg(test)]
    pub fn of_all(bodies: usize, rule: Rule<T>) -> Self {
        Rules { class: vec![0; bodies], classes: 1, table: vec![rule] }
    }

    /// The rule for two bodies.
    #[inline]
    pub fn between(&self, a: usize, b: usize) -> &Rule<T> {
        &self.table[self.class[a] * self.classes + self.class[b]]
    }
}
