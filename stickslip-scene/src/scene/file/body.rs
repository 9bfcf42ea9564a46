//! `[[bodies]]`: shape, material, and how a body moves.

use super::Context;
use super::quantity::Velocity;
use super::read::table;
use super::repeat::Repeat;
use super::shape::ShapeInput;
use super::text::{Choice, Count, Text, Word};
use super::vector::{SpinInput, VectorInput};
use crate::geometry::Arrangement;
use crate::scene::error::Fault;
use crate::scene::{self, BodyMotion, Expression, NamedMaterial};
use std::collections::HashSet;

table! {
    /// A body: a shape filled with a material, and how it moves at the start.
    Body {
        /// Its name, unique in the scene.
        name: Text,
        /// Makes many of it: indices, and how many values each has, such as { i = 10, j = 5 }. Formulas use them by
        /// name, text in braces: "grain {i}". By default one.
        repeat: Option<Repeat>,
        /// Name of its material.
        material: Text,
        /// Where it is at the start: shape.ball = { center = [0, 0, 1], radius = 1 }.
        shape: ShapeInput,
        /// How its particles are laid out.
        #[schemars(extend("default" = Arrangement::default()))]
        particles: Option<Word<Arrangement>>,
        /// Particles along each side of a cell, 1 to 8; by default as many as space has.
        particles_per_side: Option<Count>,
        /// Velocity at the start [m/s]; by default none.
        velocity: Option<VectorInput<Velocity>>,
        /// Angular velocity about its centre of mass at the start [rad/s]; in the plane one number. By default none.
        spin: Option<SpinInput>,
        /// Makes the body rigid and prescribes its motion; excludes velocity and spin.
        rigid: Option<Rigid>,
    }
}

table! {
    /// Prescribed motion of a rigid body. Formulas may use `t`, the time; {} is a body at rest.
    Rigid {
        /// Velocity of its centre of mass [m/s]: ["0.1 m/s * min(t / 1 ms, 1)", 0, 0]. By default none.
        velocity: Option<VectorInput<Velocity>>,
        /// Angular velocity about its centre of mass [rad/s]; in the plane one number. By default none.
        spin: Option<SpinInput>,
    }
}

impl Choice for Arrangement {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("lattice", Arrangement::Lattice, "On the lattice of space; curved surfaces become stairs."),
        (
            "fitted",
            Arrangement::Fitted,
            "In rings, shells or boxes that follow the surface, with exact volume: balls, boxes, cylinders, halves of round ones.",
        ),
    ];
}

/// Bodies, and where in the file each is declared.
#[derive(Default)]
pub struct Bodies {
    pub all: Vec<scene::Body>,
    /// Of each, its table in the file: `bodies[3]`.
    pub declared: Vec<String>,
    names: HashSet<String>,
}

impl Bodies {
    /// Takes one more.
    ///
    /// # Errors
    /// A name that it cannot have.
    pub fn add(&mut self, body: scene::Body, name: &Text, declared: &str) -> Result<(), Fault> {
        if body.name == "any" || body.name.trim().is_empty() {
            return Err(name.refused(&body.name, "a name; `any` matches every body"));
        }
        name.is_no_pattern(&body.name)?;
        if !self.names.insert(body.name.clone()) {
            return Err(name.refused(&body.name, "a name that no other body has"));
        }
        self.all.push(body);
        self.declared.push(declared.to_string());
        Ok(())
    }
}

/// The bodies in the order of the file.
pub fn resolve(bodies: &[Body], materials: &[NamedMaterial], context: &Context) -> Result<Bodies, Fault> {
    let mut resolved = Bodies::default();
    for (i, body) in bodies.iter().enumerate() {
        let declared = format!("bodies[{i}]");
        Repeat::each(body.repeat.as_ref(), context, || {
            resolved.add(body.resolve(materials, context)?, &body.name, &declared)
        })?;
    }
    Ok(resolved)
}

/// The number of the material that a text names.
pub fn material_of(text: &Text, materials: &[NamedMaterial], context: &Context) -> Result<usize, Fault> {
    let names: Vec<&str> = materials.iter().map(|material| material.name.as_str()).collect();
    let material = text.name_of(context, "the name of a material", &names)?;
    Ok(names.iter().position(|name| *name == material).expect("name_of found it in names"))
}

impl Body {
    fn resolve(&self, materials: &[NamedMaterial], context: &Context) -> Result<scene::Body, Fault> {
        let material = material_of(&self.material, materials, context)?;
        let mut body = scene::Body::new(&self.name.value(context)?, material, self.shape.resolve(context)?);
        if let Some(word) = &self.particles {
            body.particles = word.value(context)?;
        }
        if let Some(count) = &self.particles_per_side {
            body.particles_per_side = Some(count.value(context, 1..=8)?);
        }
        let keys = BodyKeys { velocity: &self.velocity, spin: &self.spin, rigid: &self.rigid };
        body.motion = keys.motion(context)?;
        Ok(body)
    }
}

/// The keys that say how a body moves.
pub struct BodyKeys<'a> {
    pub velocity: &'a Option<VectorInput<Velocity>>,
    pub spin: &'a Option<SpinInput>,
    pub rigid: &'a Option<Rigid>,
}

impl BodyKeys<'_> {
    /// How it moves.
    pub fn motion(&self, context: &Context) -> Result<BodyMotion, Fault> {
        let Some(rigid) = &self.rigid else {
            return Ok(BodyMotion::Free {
                velocity: self.velocity.as_ref().map_or(Ok([0.0; 3]), |velocity| velocity.value(context))?,
                spin: self.spin.as_ref().map_or(Ok([0.0; 3]), |spin| spin.value(context))?,
            });
        };
        let start = self.velocity.as_ref().map(VectorInput::node).or(self.spin.as_ref().map(SpinInput::node));
        if let Some(node) = start {
            let found = format!("`{}` of a rigid body", node.name);
            let allowed = format!("its motion in rigid = {{ {} = ... }}", node.name);
            return Err(Fault::new(&node.key, found, allowed).at(node.name_span.clone()));
        }
        let rest = || Ok([0.0; 3].map(Expression::Constant));
        Ok(BodyMotion::Rigid {
            velocity: rigid.velocity.as_ref().map_or_else(rest, |velocity| velocity.over_time(context))?,
            spin: rigid.spin.as_ref().map_or_else(rest, |spin| spin.over_time(context))?,
        })
    }
}
