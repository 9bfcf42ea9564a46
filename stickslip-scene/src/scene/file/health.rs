//! `[health]`: what a run watches, and what it does where something is wrong.

use super::Context;
use super::quantity::{QuantityInput, Ratio};
use super::read::{Read, table};
use super::text::{Choice, Count, Word};
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::{self, HealthCheck, HealthRule, Response};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;

table! {
    /// What a run watches while it goes on, and what it does where something is wrong: a check is "warn", "stop",
    /// "record" or "ignore", or a table of that and a bound, { then = "stop", bound = 0.05 }.
    Health {
        /// What holds for all that is not named here; by default "warn", of `contact` "record".
        default: Option<Word<Response>>,
        /// Energy that comes from nowhere or is lost; the bound is the drift of the total over the largest energy that
        /// moved, was stored or turned to heat, by default `time.energy_drift`.
        energy: Option<Rule>,
        /// Motion that becomes noise and is damped though the scene asks for no damping; the bound is what damping
        /// took, over the same energy, by default half of `time.energy_drift`.
        noise: Option<Rule>,
        /// Momentum of all bodies that nothing from outside explains; the bound is the difference over the largest
        /// momentum so far, by default 0.01.
        momentum: Option<Rule>,
        /// Angular momentum of bodies that no torque acts on; the bound is its relative change, by default 0.02.
        angular_momentum: Option<Rule>,
        /// Distances of particles against their deformation gradients; the bound is the difference over the body's
        /// stretch, by default 0.1, and twice that where material flows.
        strain: Option<Rule>,
        /// Numerical fracture: neighbours further apart than the grid joins them.
        tearing: Option<Rule>,
        /// Linear functions whose cells stressed particles cross; the bound is the share of a body's particles that
        /// did, by default 0.1.
        cell_crossing: Option<Rule>,
        /// Motion within a body; the bound is its speed over that of waves, by default 0.5.
        speed: Option<Rule>,
        /// Steps that have become far shorter than the first; the bound is the stable step over the first one, by
        /// default 0.01.
        small_step: Option<Rule>,
        /// Steps that failed and were taken again, see `retries`.
        failed_step: Option<Rule>,
        /// Contacts that the grid does not resolve, of which summaries tell in any case; by default "record".
        contact: Option<Rule>,
        /// Impulses of contact that were reduced to the rule's `max_strain`; the bound is their share of all that two
        /// bodies gave each other, by default 0.5.
        max_strain: Option<Rule>,
        /// Steps that are lost in rounding; the bound is how far bodies move so [cells], by default 0.1.
        precision: Option<Rule>,
        /// Bodies that are not at rest at the end of dynamic relaxation.
        relaxation: Option<Rule>,
        /// Particles that left the domain and were taken out, see `space.domain.leaving`.
        leaving: Option<Rule>,
        /// Checkpoints that could not be written, or could not be read where a run goes on from an earlier one.
        checkpoint: Option<Rule>,
        /// Probes and sections that never had material around them, fronts and arrivals that never were.
        probe: Option<Rule>,
        /// Parts of one body that meet: they share nodes, are pushed a cell early, and stick.
        self_contact: Option<Rule>,
        /// How often a step that fails is taken again from memory, with half of its length and half of that, before
        /// the run gives up: 0 to 20. Steps grow back after it. The particles are copied before each step.
        #[schemars(extend("default" = 0))]
        retries: Option<Count>,
    }
}

table! {
    /// What to do beyond a bound.
    RuleTable {
        /// What to do.
        then: Option<Word<Response>>,
        /// Beyond what; above 0.
        bound: Option<QuantityInput<Ratio>>,
    }
}

/// What to do, as a word alone or with the bound.
pub enum Rule {
    /// The word.
    Word(Word<Response>),
    /// Both.
    Table(Box<RuleTable>),
}

impl Choice for Response {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("warn", Response::Warn, "The run says so and goes on."),
        ("stop", Response::Stop, "The run ends there, with all records, a checkpoint and exit code 1."),
        (
            "cut-step",
            Response::CutStep,
            "The run says so, and halves its steps for as long as it gets worse; for energy and momentum only.",
        ),
        (
            "record",
            Response::Record,
            "It stands in the record of the run with its count; there is no warning.",
        ),
        ("ignore", Response::Ignore, "There is no warning, and nothing is looked for."),
    ];
}

impl Health {
    fn rules(&self) -> [(HealthCheck, &Option<Rule>); HealthCheck::ALL.len()] {
        [
            (HealthCheck::Energy, &self.energy),
            (HealthCheck::Noise, &self.noise),
            (HealthCheck::Momentum, &self.momentum),
            (HealthCheck::AngularMomentum, &self.angular_momentum),
            (HealthCheck::Strain, &self.strain),
            (HealthCheck::Tearing, &self.tearing),
            (HealthCheck::CellCrossing, &self.cell_crossing),
            (HealthCheck::Speed, &self.speed),
            (HealthCheck::SmallStep, &self.small_step),
            (HealthCheck::FailedStep, &self.failed_step),
            (HealthCheck::Contact, &self.contact),
            (HealthCheck::MaxStrain, &self.max_strain),
            (HealthCheck::Precision, &self.precision),
            (HealthCheck::Relaxation, &self.relaxation),
            (HealthCheck::Leaving, &self.leaving),
            (HealthCheck::Checkpoint, &self.checkpoint),
            (HealthCheck::Probe, &self.probe),
            (HealthCheck::SelfContact, &self.self_contact),
        ]
    }

    /// What each check does.
    pub fn resolve(&self, context: &Context) -> Result<scene::Health, Fault> {
        let default = self.default.as_ref().map(|word| allowed_for((None, word), context)).transpose()?;
        let mut health = scene::Health::default();
        if let Some(retries) = &self.retries {
            health.retries = retries.value(context, 0..=MOST_RETRIES)?;
        }
        for (check, written) in self.rules() {
            let usual = HealthRule { then: check.usual_response(), bound: None };
            let default = HealthRule { then: default.unwrap_or(usual.then), ..usual };
            let rule = match written {
                Some(rule) => rule.resolve((check, default.then), context)?,
                None => default,
            };
            if rule != usual {
                health.rules.insert(check, rule);
            }
        }
        Ok(health)
    }
}

impl Rule {
    fn resolve(
        &self,
        (check, default): (HealthCheck, Response),
        context: &Context,
    ) -> Result<HealthRule, Fault> {
        let (word, bound) = match self {
            Rule::Word(word) => (Some(word), None),
            Rule::Table(table) => (table.then.as_ref(), table.bound.as_ref()),
        };
        let then = word.map_or(Ok(default), |word| allowed_for((Some(check), word), context))?;
        let bound = bound.map(|bound| match check.usual_bound() {
            Some(_) => bound.checked(context, "a number above 0", |value| value > 0.0),
            None => Err(bound.refused(bound.value(context)?, "`then` alone: this check has no bound")),
        });
        Ok(HealthRule { then, bound: bound.transpose()? })
    }
}

/// What to do; shorter steps help few.
fn allowed_for(
    (check, word): (Option<HealthCheck>, &Word<Response>),
    context: &Context,
) -> Result<Response, Fault> {
    let then = word.value(context)?;
    if then == Response::CutStep && !check.is_some_and(HealthCheck::can_cut_step) {
        let allowed =
            "\"cut-step\" for `energy` and `momentum` only; \"warn\", \"stop\", \"record\" or \"ignore\"";
        return Err(word.refused(context, allowed));
    }
    Ok(then)
}

/// A step of a millionth of the stable one would take for ever.
const MOST_RETRIES: usize = 20;

impl Read for Rule {
    fn wanted() -> String {
        format!("{}, or {}", Word::<Response>::wanted(), RuleTable::wanted())
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Text(_) => Word::read(node).map(Rule::Word),
            Value::Table(_) => RuleTable::read(node).map(|table| Rule::Table(Box::new(table))),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl JsonSchema for Rule {
    fn schema_name() -> Cow<'static, str> {
        "HealthRule".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (word, table) =
            (generator.subschema_for::<Word<Response>>(), generator.subschema_for::<RuleTable>());
        json_schema!({ "anyOf": [word, table] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A check is written as it is recorded.
    #[test]
    fn keys_are_the_words_of_records() {
        let keys: Vec<String> = HealthCheck::ALL.iter().map(|check| check.word().replace('-', "_")).collect();
        assert!(keys.iter().all(|key| Health::KEYS.contains(&key.as_str())), "{keys:?}");
        for check in HealthCheck::ALL {
            assert_eq!(serde_json::to_value(check).expect("a word"), check.word());
        }
    }
}
