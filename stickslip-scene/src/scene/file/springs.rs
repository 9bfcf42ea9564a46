//! `[[springs]]`: springs and dashpots between parts of bodies.

use super::Context;
use super::joints::spring_length;
use super::loads::positive;
use super::quantity::{ForceOverVelocity, Length, QuantityInput, Stiffness};
use super::read::table;
use super::repeat::Repeat;
use super::shape::ShapeInput;
use super::text::{Text, Word};
use crate::scene::error::Fault;
use crate::scene::{self, Body, Extent, Part};
use std::collections::HashSet;

table! {
    /// A spring with a dashpot between parts of two bodies, along the line between the centres of the parts.
    SpringBetween {
        /// Its name in joints.csv; by default "spring 1", "spring 2" ...
        name: Option<Text>,
        /// Makes many of it: indices, and how many values each has, as of [[bodies]]. By default one.
        repeat: Option<Repeat>,
        /// The part at which it begins: from = { body = "hub", on = "x_max" }.
        from: SpringEnd,
        /// The part at which it ends.
        to: SpringEnd,
        /// Force over the change of length [N/m]. By default none.
        stiffness: Option<QuantityInput<Stiffness>>,
        /// Force over the speed at which the length changes [N s/m]. By default none.
        dashpot: Option<QuantityInput<ForceOverVelocity>>,
        /// Length without a force [m]; by default that of the start.
        length: Option<QuantityInput<Length>>,
    }
}

table! {
    /// A part of a body at which a spring ends. The force is shared out evenly over it.
    SpringEnd {
        /// Name of the body, one that deforms or is rigid.
        body: Text,
        /// Where on the body: its surface, a face of it, or all its particles.
        #[schemars(extend("default" = "surface"))]
        on: Option<Word<Extent>>,
        /// Only what lies in this shape at the start: within.ball = { center = [0, 0], radius = 1 }.
        within: Option<ShapeInput>,
    }
}

/// Springs, and where in the file each is declared.
#[derive(Default)]
pub struct Springs {
    pub all: Vec<scene::Spring>,
    /// Of each, its table in the file: `springs[3]`.
    pub declared: Vec<String>,
}

/// The springs in the order of the file.
pub fn resolve(
    springs: &[SpringBetween],
    joints: &[scene::Joint],
    (bodies, context): (&[Body], &Context),
) -> Result<Springs, Fault> {
    let mut resolved = Springs::default();
    let mut taken: HashSet<String> = joints.iter().map(|joint| joint.name.clone()).collect();
    for (table, spring) in springs.iter().enumerate() {
        let declared = format!("springs[{table}]");
        Repeat::each(spring.repeat.as_ref(), context, || {
            let number = resolved.all.len() + 1;
            let name =
                Text::name_or(spring.name.as_ref(), ("spring", number), (&declared, &mut taken), context)?;
            resolved.all.push(spring.resolve(&declared, name, (bodies, context))?);
            resolved.declared.push(declared.clone());
            Ok(())
        })?;
    }
    Ok(resolved)
}

impl SpringBetween {
    fn resolve(
        &self,
        declared: &str,
        name: String,
        (bodies, context): (&[Body], &Context),
    ) -> Result<scene::Spring, Fault> {
        let [from, to] = [&self.from, &self.to].map(|end| end.resolve(bodies, context));
        let ends = [from?, to?];
        let stiffness = self.stiffness.as_ref().map_or(Ok(0.0), |stiffness| positive(stiffness, context))?;
        let dashpot = self.dashpot.as_ref().map_or(Ok(0.0), |dashpot| positive(dashpot, context))?;
        if stiffness == 0.0 && dashpot == 0.0 {
            let allowed = "a `stiffness`, a `dashpot` or both";
            return Err(Fault::new(declared, "a spring that does nothing", allowed));
        }
        let length = spring_length(&self.length, stiffness, context)?;
        Ok(scene::Spring { name, ends, stiffness, dashpot, length })
    }
}

impl SpringEnd {
    fn resolve(&self, bodies: &[Body], context: &Context) -> Result<scene::SpringEnd, Fault> {
        let names: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
        let found = self.body.name_of(context, "the name of a body", &names)?;
        let body = names.iter().position(|name| *name == found).expect("name_of found it in names");
        let on = self.on.as_ref().map_or(Ok(Extent::default()), |word| word.value(context))?;
        if let (Some(word), Extent::Face { axis: 2, .. }, true) = (&self.on, on, context.dimension.is_plane())
        {
            return Err(word.refused(context, "another face, as the scene is plane"));
        }
        let within = self.within.as_ref().map(|shape| shape.resolve(context)).transpose()?;
        Ok(scene::SpringEnd { body, part: Part { on, within } })
    }
}
