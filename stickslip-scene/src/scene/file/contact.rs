//! `[[contact]]`: rules for how bodies touch.

use super::Context;
use super::quantity::{
    Duration, Length, Measure, Pressure, QuantityInput, Ratio, SurfaceViscosity, Velocity, plain_unit,
};
use super::read::{Read, table};
use super::text::{Choice, Text, Word};
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::{Body, ContactLaw, ContactRule, FrictionMemory, NamedMaterial, Normal, Press};
use schemars::JsonSchema;
use std::collections::HashSet;

table! {
    /// How bodies touch.
    Contact {
        /// The pair it holds for: two names of bodies or materials, or patterns in which `*` is any letters, such as
        /// "grain*"; "any", the default for both, matches every body.
        between: Option<NamePair>,
        /// When the bodies push on each other.
        #[schemars(extend("default" = ContactRule::default().law))]
        law: Option<Word<ContactLaw>>,
        /// Coefficient of friction; inf sticks, 0 is frictionless.
        #[schemars(extend("default" = 0))]
        friction: Option<QuantityInput<Ratio>>,
        /// Coefficient of friction once the surfaces slip, at most `friction`; by default the same.
        kinetic_friction: Option<QuantityInput<Ratio>>,
        /// Speed of slip over which friction falls from `friction` to `kinetic_friction`; 0: as soon as they slip.
        #[schemars(extend("default" = 0))]
        friction_decay_speed: Option<QuantityInput<Velocity>>,
        /// Slip over which friction follows a change of pressure [m], with `friction_memory_speed` beside it; between
        /// bodies with interior = "reference"; 0: at once. By default within five transits of a wave through the slower
        /// body.
        friction_memory_length: Option<QuantityInput<Length>>,
        /// Speed at which surfaces that do not slip follow a change of pressure, as slip does [m/s]; with
        /// `friction_memory_length`.
        friction_memory_speed: Option<QuantityInput<Velocity>>,
        /// Shear traction that the contact bears beside friction, pressed or not, where the surfaces touch.
        #[schemars(extend("default" = 0))]
        cohesion: Option<QuantityInput<Pressure>>,
        /// Tensile traction that the contact bears before the surfaces part.
        #[schemars(extend("default" = 0))]
        adhesion: Option<QuantityInput<Pressure>>,
        /// Viscous shear traction over speed of slip, beside friction.
        #[schemars(extend("default" = 0))]
        viscosity: Option<QuantityInput<SurfaceViscosity>>,
        /// Where the direction of contact comes from; by default "own" for the laws kinematic and traction, as the
        /// paper has it, "common" for the others; surface, separation and regression find one direction for the pair
        /// and take no "own".
        normal: Option<Word<Normal>>,
        /// Largest strain of a cell by contact in one step, the paper's gamma, above 0 and up to 1.
        #[schemars(extend("default" = ContactRule::default().max_strain))]
        max_strain: Option<QuantityInput<Ratio>>,
        /// Speed at which rigid bodies part over the speed at which they met, 0 to 1; where one of them is free.
        #[schemars(extend("default" = 0))]
        restitution: Option<QuantityInput<Ratio>>,
        /// What becomes of an overlap with which bodies that deform start; "press" is of the law surface.
        #[schemars(extend("default" = "kept"))]
        overlap: Option<Word<OverlapUse>>,
        /// Within which time surfaces grow by overlap = "press" [s]; by default ten times that in which a wave runs
        /// through the largest of the bodies that overlap.
        press_time: Option<QuantityInput<Duration>>,
    }
}

/// What becomes of an overlap at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OverlapUse {
    Kept,
    Press,
}

impl Choice for OverlapUse {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        (
            "kept",
            OverlapUse::Kept,
            "Of bodies on the grid it stays, without stress: contact only keeps it from growing; those on grids of \
             their own are pressed apart within some transits of a wave.",
        ),
        (
            "press",
            OverlapUse::Press,
            "An interference fit: surfaces grow from no overlap to all of it, and press the bodies apart.",
        ),
    ];
}

/// Two names.
#[derive(JsonSchema)]
#[schemars(transparent)]
#[schemars(rename = "Pair")]
pub struct NamePair([Text; 2]);

impl Choice for ContactLaw {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        (
            "surface",
            ContactLaw::Surface,
            "When their exact surfaces touch: the undeformed shapes, carried along by the deformation.",
        ),
        (
            "gap",
            ContactLaw::Gap,
            "When they approach or push on each other, once their surfaces touch: the bodies fill the room around the node.",
        ),
        (
            "separation",
            ContactLaw::Separation,
            "When they approach or push on each other, once their extrapolated positions are close (Nairn 2013).",
        ),
        (
            "regression",
            ContactLaw::Regression,
            "When they approach, once their particles touch across the plane that logistic regression finds (2020).",
        ),
        ("traction", ContactLaw::Traction, "When the traction between them is compressive (2001)."),
        ("kinematic", ContactLaw::Kinematic, "When they approach (2000)."),
        (
            "glued",
            ContactLaw::Glued,
            "Always and in every direction: one velocity for both; of a body on a grid of its own, a layer \
             that holds its points.",
        ),
        ("none", ContactLaw::None, "Never."),
    ];
}

impl ContactLaw {
    /// Every law: its word in scene files, the law, and when its bodies push on each other, in a sentence.
    pub fn words() -> impl Iterator<Item = (&'static str, Self, &'static str)> {
        Self::WORDS.iter().copied()
    }
}

impl Choice for Normal {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("common", Normal::Common, "One direction for the pair; conserves momentum."),
        ("own", Normal::Own, "Each body's own mass gradient, as the paper prints it."),
    ];
}

/// The rules in the order of the file.
pub fn resolve(
    rules: &[Contact],
    (bodies, materials): (&[Body], &[NamedMaterial]),
    context: &Context,
) -> Result<Vec<ContactRule>, Fault> {
    let own: HashSet<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
    let others = materials.iter().map(|material| material.name.as_str()).filter(|name| !own.contains(name));
    let names: Vec<&str> =
        bodies.iter().map(|body| body.name.as_str()).chain(others).chain(["any"]).collect();
    rules.iter().map(|rule| rule.resolve(&names, context)).collect()
}

impl Contact {
    fn resolve(&self, names: &[&str], context: &Context) -> Result<ContactRule, Fault> {
        let law = self.law.as_ref().map_or(Ok(ContactRule::default().law), |word| word.value(context))?;
        let default = ContactRule::new(law);
        let mut between = default.between;
        if let Some(NamePair(pair)) = &self.between {
            for (side, text) in between.iter_mut().zip(pair) {
                let (name, _) = text.names_of(context, "the name of a body or a material, or any", names)?;
                *side = (name != "any").then_some(name);
            }
        }
        for coefficient in [&self.friction, &self.kinetic_friction].into_iter().flatten() {
            if plain_unit(coefficient.node()).is_some_and(|unit| matches!(unit, "deg" | "rad")) {
                return Err(coefficient
                    .node()
                    .fault("a coefficient: the tangent of an angle, \"tan(30 deg)\""));
            }
        }
        let friction = self.friction.as_ref().map_or(Ok(default.friction), |friction| {
            let value = friction.extended(context)?;
            let allowed = "a number from 0 on, or inf";
            if value >= 0.0 { Ok(value) } else { Err(friction.refused(value, allowed)) }
        })?;
        let max_strain = self.max_strain.as_ref().map_or(Ok(default.max_strain), |strain| {
            strain.checked(context, "a number above 0 and up to 1", |value| value > 0.0 && value <= 1.0)
        })?;
        let normal =
            self.normal.as_ref().map_or(Ok(default.normal), |word| match (law, word.value(context)?) {
                (ContactLaw::Surface | ContactLaw::Separation | ContactLaw::Regression, Normal::Own) => {
                    let name = ContactLaw::words().find(|word| word.1 == law).map_or("", |word| word.0);
                    let allowed =
                        format!("\"common\" with law = {name:?}, which finds one direction for the pair");
                    Err(word.refused(context, allowed))
                }
                (_, normal) => Ok(normal),
            })?;
        let kinetic_friction = self.kinetic_friction.as_ref().map_or(Ok(friction), |kinetic| {
            let value = kinetic.extended(context)?;
            let allowed = format!("a number from 0 to the rule's friction, {friction}");
            if (0.0..=friction).contains(&value) { Ok(value) } else { Err(kinetic.refused(value, &allowed)) }
        })?;
        if let Some(speed) = self.friction_decay_speed.as_ref().filter(|_| self.kinetic_friction.is_none()) {
            let allowed = "a `kinetic_friction` beside it, to which friction falls over that speed";
            return Err(speed.node().fault(allowed));
        }
        self.tell_of_dead_keys(law, context)?;
        Ok(ContactRule {
            between,
            law,
            friction,
            friction_given: self.friction.is_some(),
            kinetic_friction,
            friction_decay_speed: not_negative(&self.friction_decay_speed, context)?,
            friction_memory: self.friction_memory((law, friction), context)?,
            cohesion: bond(&self.cohesion, normal, context)?,
            adhesion: bond(&self.adhesion, normal, context)?,
            viscosity: bond(&self.viscosity, normal, context)?,
            normal,
            max_strain,
            restitution: self.restitution.as_ref().map_or(Ok(0.0), |restitution| {
                restitution.checked(context, "a number from 0 to 1", |value| (0.0..=1.0).contains(&value))
            })?,
            press: self.press(law, context)?,
        })
    }

    /// How friction follows a change of pressure, if not at once.
    fn friction_memory(
        &self,
        (law, friction): (ContactLaw, f64),
        context: &Context,
    ) -> Result<Option<FrictionMemory>, Fault> {
        let (length, speed) = match (&self.friction_memory_length, &self.friction_memory_speed) {
            (Some(length), Some(speed)) => (length, speed),
            (Some(length), None) if length.value(context)? == 0.0 => {
                return Ok(Some(FrictionMemory { length: 0.0, speed: 0.0 }));
            }
            (Some(length), None) => {
                return Err(length.node().fault("0, or a `friction_memory_speed` beside it"));
            }
            (None, Some(speed)) => {
                return Err(speed.node().fault("a `friction_memory_length` beside it"));
            }
            (None, None) => return Ok(None),
        };
        let memory = FrictionMemory { length: length.positive(context)?, speed: speed.positive(context)? };
        let why = match (law, friction) {
            (ContactLaw::None | ContactLaw::Glued, _) => return Ok(Some(memory)),
            (_, 0.0) => "the rule has no friction",
            (_, f64::INFINITY) => "surfaces that stick in any case have no strength to remember",
            _ => return Ok(Some(memory)),
        };
        context.tell(&length.node().key(), format!("does not act, nor does `friction_memory_speed`: {why}"));
        Ok(Some(memory))
    }

    /// How overlaps are pressed apart, if they are.
    fn press(&self, law: ContactLaw, context: &Context) -> Result<Option<Press>, Fault> {
        let wanted = self.overlap.as_ref().map_or(Ok(OverlapUse::Kept), |word| word.value(context))?;
        let time = self.press_time.as_ref();
        match (wanted, &self.overlap) {
            (OverlapUse::Press, Some(word)) if law != ContactLaw::Surface => Err(word.refused(
                context,
                "\"press\" with law = \"surface\" only, which knows how deep bodies overlap",
            )),
            (OverlapUse::Press, _) => {
                let time = time.map(|time| time.positive(context)).transpose()?;
                Ok(Some(Press { time }))
            }
            (OverlapUse::Kept, _) => match time {
                Some(time) => Err(time.node().fault("overlap = \"press\" beside it")),
                None => Ok(None),
            },
        }
    }

    /// Tells of keys of a rule whose bodies are glued or left alone, where they do nothing.
    fn tell_of_dead_keys(&self, law: ContactLaw, context: &Context) -> Result<(), Fault> {
        let why = match law {
            ContactLaw::None => "by the law \"none\" bodies do not touch",
            ContactLaw::Glued => "bodies that are glued move as one",
            _ => return Ok(()),
        };
        fn acts<M: Measure>(
            key: &Option<QuantityInput<M>>,
            context: &Context,
        ) -> Result<Option<DocumentNode>, Fault> {
            let Some(quantity) = key else { return Ok(None) };
            Ok((quantity.extended(context)? != 0.0).then(|| quantity.node().clone()))
        }
        let dead = [
            acts(&self.friction, context)?,
            acts(&self.kinetic_friction, context)?,
            acts(&self.friction_decay_speed, context)?,
            acts(&self.friction_memory_length, context)?,
            acts(&self.cohesion, context)?,
            acts(&self.adhesion, context)?,
            acts(&self.viscosity, context)?,
            acts(&self.restitution, context)?,
            acts(&self.max_strain, context)?.filter(|_| law == ContactLaw::None),
            self.normal.as_ref().map(|word| word.node().clone()),
        ];
        let dead: Vec<DocumentNode> = dead.into_iter().flatten().collect();
        let Some((first, others)) = dead.split_first() else { return Ok(()) };
        let others: Vec<String> = others.iter().map(|node| format!("`{}`", node.name())).collect();
        let others =
            if others.is_empty() { String::new() } else { format!(", nor do {}", others.join(", ")) };
        context.tell(&first.key(), format!("does not act{others}: {why}"));
        Ok(())
    }
}

/// A quantity from zero on; zero where the file is silent.
fn not_negative<M: Measure>(quantity: &Option<QuantityInput<M>>, context: &Context) -> Result<f64, Fault> {
    quantity
        .as_ref()
        .map_or(Ok(0.0), |quantity| quantity.checked(context, "a quantity from 0 on", |value| value >= 0.0))
}

/// What surfaces bear over the contact's area, for which a pair needs one direction; zero where the file is silent.
fn bond<M: Measure>(
    quantity: &Option<QuantityInput<M>>,
    normal: Normal,
    context: &Context,
) -> Result<f64, Fault> {
    match (quantity, normal) {
        (Some(quantity), Normal::Own) => quantity.checked(
            context,
            "0 with each body's own normal; normal = \"common\" gives the pair one direction and an area",
            |value| value == 0.0,
        ),
        _ => not_negative(quantity, context),
    }
}

impl Read for NamePair {
    fn wanted() -> String {
        "two names of bodies or materials: [\"sphere\", \"any\"]".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match &node.value {
            Value::List(items) if items.len() == 2 => {
                Ok(NamePair([Text::read(&items[0])?, Text::read(&items[1])?]))
            }
            _ => Err(node.fault(Self::wanted())),
        }
    }
}
