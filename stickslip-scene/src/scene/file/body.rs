//! `[[bodies]]`: shape, material, and how a body moves.

use super::Context;
use super::quantity::Velocity;
use super::read::table;
use super::shape::ShapeInput;
use super::text::{Choice, Count, Text, Word};
use super::vector::{SpinInput, VectorInput};
use crate::geometry::Arrangement;
use crate::scene::error::Fault;
use crate::scene::{self, BodyMotion, Expression, NamedMaterial};

table! {
    /// A body: a shape filled with a material, and how it moves at the start.
    Body {
        /// Its name, unique in the scene.
        name: Text,
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

/// The bodies in the order of the file.
pub fn resolve(
    bodies: &[Body],
    materials: &[NamedMaterial],
    context: &Context,
) -> Result<Vec<scene::Body>, Fault> {
    if bodies.is_empty() {
        return Err(Fault::new("bodies", "no body", "at least one [[bodies]]"));
    }
    let names: Vec<&str> = materials.iter().map(|material| material.name.as_str()).collect();
    let mut resolved: Vec<scene::Body> = Vec::new();
    for body in bodies {
        let name = body.name.value(context)?;
        if name == "any" || name.is_empty() {
            return Err(body.name.refused(&name, "a name; `any` matches every body"));
        }
        if resolved.iter().any(|other| other.name == name) {
            return Err(body.name.refused(&name, "a name that no other body has"));
        }
        let material = body.material.name_of(context, "the name of a material", &names)?;
        let material = names.iter().position(|name| *name == material).expect("name_of found it in names");
        let mut whole = scene::Body::new(&name, material, body.shape.resolve(context)?);
        if let Some(word) = &body.particles {
            whole.particles = word.value(context)?;
        }
        if let Some(count) = &body.particles_per_side {
            whole.particles_per_side = Some(count.value(context, 1..=8)?);
        }
        whole.motion = body.motion(context)?;
        resolved.push(whole);
    }
    Ok(resolved)
}

impl Body {
    fn motion(&self, context: &Context) -> Result<BodyMotion, Fault> {
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
