//! `[[bodies]]`: shape, material, and how a body moves.

use super::Context;
use super::array::ArrayKeys;
use super::loads::{VaryingVector, positive};
use super::outside::OrOutside;
use super::quantity::{Length, Mass, MomentOfInertia, Pressure, QuantityInput, Velocity};
use super::read::{Read, table};
use super::repeat::Repeat;
use super::shape::ShapeInput;
use super::text::{Choice, Count, Text, Word};
use super::vector::{SpinInput, VaryingSpin, VectorInput};
use crate::geometry::{Arrangement, Bounds, Mirror, Shape};
use crate::packing::Placement;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::parameters::Dependence;
use crate::scene::{self, BodyMotion, Domain, Expression, Face, FreeRigid, Interior, NamedMaterial};
use schemars::JsonSchema;
use std::collections::HashSet;

table! {
    /// A body: a shape filled with a material, and how it moves at the start.
    Body {
        /// Its name, unique in the scene.
        name: Text,
        /// Makes many of it: indices, and how many values each has, such as { i = 10, j = 5 }. Formulas use them by
        /// name, text in braces: "grain {i}". By default one.
        repeat: Option<Repeat>,
        /// Makes copies of it in a regular array: "grain" makes "grain 1", "grain 2" ..., together "grain *". By default
        /// one body.
        array: Option<ArrayKeys>,
        /// Name of its material.
        material: Text,
        /// Where it is at the start: shape.ball = { center = [0, 0, 1], radius = 1 }.
        shape: ShapeInput,
        /// What becomes of the part of its shape that lies beyond a symmetry face of the domain.
        #[schemars(extend("default" = "refused"))]
        beyond_mirrors: Option<Word<BeyondMirrors>>,
        /// How its particles are laid out.
        #[schemars(extend("default" = Arrangement::default()))]
        particles: Option<Word<Arrangement>>,
        /// Particles along each side of a cell, 1 to 8; by default as many as space has.
        particles_per_side: Option<Count>,
        /// Where it is computed, if it deforms; by default as space says.
        interior: Option<Word<Interior>>,
        /// Side of the cells of its own grid [m], with interior = "reference"; by default that of space.
        cell: Option<QuantityInput<Length>>,
        /// Velocity at the start [m/s]; of a body that deforms also by the place x, y, z:
        /// velocity = [0, "1 m/s * cos(pi * y / 6 m)"]. By default none.
        velocity: Option<VectorInput<Velocity>>,
        /// Angular velocity about its centre of mass at the start [rad/s]; in the plane one number. By default none.
        spin: Option<SpinInput>,
        /// Makes the body rigid: its motion is prescribed, or with rigid.free forces move it.
        rigid: Option<Rigid>,
        /// Stress with which it begins, by the place: stress = { yy = "-18 kN/m^3 * (2 m - y)" }. By default none.
        stress: Option<StressInput>,
    }
}

table! {
    /// Cauchy stress before anything moves, tension positive: numbers, or formulas of the place x, y, z. What is not
    /// named is zero.
    StressInput {
        /// Normal stress along x [Pa].
        xx: Option<QuantityInput<Pressure>>,
        /// Normal stress along y [Pa].
        yy: Option<QuantityInput<Pressure>>,
        /// Normal stress along z [Pa]; not in plane stress, where it is zero.
        zz: Option<QuantityInput<Pressure>>,
        /// Shear stress between x and y [Pa].
        xy: Option<QuantityInput<Pressure>>,
        /// Shear stress between y and z [Pa]; three dimensions only.
        yz: Option<QuantityInput<Pressure>>,
        /// Shear stress between x and z [Pa]; three dimensions only.
        xz: Option<QuantityInput<Pressure>>,
    }
}

impl StressInput {
    fn resolve(&self, context: &Context) -> Result<[Expression; 6], Fault> {
        let StressInput { xx, yy, zz, xy, yz, xz } = self;
        let mut stress = [0.0; 6].map(Expression::Constant);
        for (input, stress) in [xx, yy, zz, xy, yz, xz].into_iter().zip(&mut stress) {
            if let Some(input) = input {
                *stress = input.over_place(context)?;
            }
        }
        Ok(stress)
    }
}

table! {
    /// A rigid body. Its motion is prescribed, by formulas that may use `t`, the time, or by tables; {} is a body at
    /// rest. Or it is free.
    Rigid {
        /// Contact, gravity, loads and joints move it: rigid = { free = {} }. It begins with the velocity and the spin of
        /// the body. By default its motion is prescribed.
        free: Option<FreeInput>,
        /// Velocity of its centre of mass [m/s]: ["0.1 m/s * min(t / 1 ms, 1)", 0, 0]. By default none.
        velocity: Option<OrOutside<VaryingVector<Velocity>>>,
        /// In place of `velocity`, how far its centre of mass is from where it was at the start [m], 0 at first:
        /// ["2 cm * sin(t / 10 ms)", 0, 0].
        displacement: Option<VaryingVector<Length>>,
        /// Angular velocity about its centre of mass [rad/s]; in the plane one number. By default none.
        spin: Option<OrOutside<VaryingSpin>>,
    }
}

table! {
    /// A rigid body that forces move. In the plane mass and inertia are per metre of depth.
    FreeInput {
        /// Its mass [kg]; by default that of its shape, by the density of its material.
        mass: Option<QuantityInput<Mass>>,
        /// Moments of inertia through its centre of mass, about the three axes, which must be principal ones; in the
        /// plane one number [kg m^2]. By default those of its shape.
        inertia: Option<InertiaInput>,
    }
}

/// Moments of inertia: a vector, in the plane a number.
#[derive(JsonSchema)]
#[schemars(transparent)]
pub struct InertiaInput(#[schemars(with = "VectorInput<MomentOfInertia>")] DocumentNode);

impl Read for InertiaInput {
    fn wanted() -> String {
        "a list such as [\"1 kg m^2\", \"1 kg m^2\", \"2 kg m^2\"], one number in the plane".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Number(_) | Value::Text(_) | Value::List(_) => Ok(InertiaInput(node.clone())),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl InertiaInput {
    fn value(&self, context: &Context) -> Result<[f64; 3], Fault> {
        let one = |node: &DocumentNode| positive::<MomentOfInertia>(&QuantityInput::read(node)?, context);
        match (&self.0.value, context.dimension.is_plane()) {
            (Value::List(_), true) => Err(self.0.fault("one number, as the scene is plane")),
            (Value::List(parts), false) if parts.len() == 3 => {
                let [x, y, z] = [one(&parts[0])?, one(&parts[1])?, one(&parts[2])?];
                let solid = 2.0 * x.max(y).max(z) <= (x + y + z) * (1.0 + 1e-9);
                let allowed = "moments of a solid body: none larger than the two others together";
                if solid { Ok([x, y, z]) } else { Err(self.0.fault(allowed)) }
            }
            (_, false) => Err(self.0.fault("3 numbers, as the scene is 3d")),
            (_, true) => Ok([one(&self.0)?; 3]),
        }
    }
}

/// What becomes of a part of a shape that lies beyond a mirror.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeyondMirrors {
    Refused,
    Cut,
}

impl Choice for BeyondMirrors {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("refused", BeyondMirrors::Refused, "It is a mistake."),
        ("cut", BeyondMirrors::Cut, "The mirror cuts it off, and shows what is left as the whole."),
    ];
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

    /// Takes copies of a body, numbered from 1 on: its shape at each of some places.
    ///
    /// # Errors
    /// A name that they cannot have.
    pub fn add_copies(
        &mut self,
        body: &scene::Body,
        places: &[Placement],
        (name, declared): (&Text, &str),
        context: &Context,
    ) -> Result<(), Fault> {
        for (i, place) in places.iter().enumerate() {
            let shape = place.shape(&body.shape, context.dimension.axes());
            let name_of_copy = format!("{} {}", body.name, i + 1);
            self.add(scene::Body { name: name_of_copy, shape, ..body.clone() }, name, declared)?;
        }
        Ok(())
    }
}

/// The bodies in the order of the file.
pub fn resolve(
    bodies: &[Body],
    (materials, domain): (&[NamedMaterial], Option<&Domain>),
    context: &Context,
) -> Result<Bodies, Fault> {
    let mut resolved = Bodies::default();
    for (i, body) in bodies.iter().enumerate() {
        let (declared, first) = (format!("bodies[{i}]"), resolved.all.len());
        Repeat::each(body.repeat.as_ref(), context, || {
            let one = body.resolve(materials, context)?;
            let Some(array) = &body.array else { return resolved.add(one, &body.name, &declared) };
            let places = array.place(&one.shape, &format!("{declared}.array"), context)?;
            resolved.add_copies(&one, &places, (&body.name, &declared), context)
        })?;
        if let Some(mirrors) = body.cutting_mirrors(domain, context)? {
            for one in &mut resolved.all[first..] {
                one.shape = cut(one.shape.clone(), &mirrors, context.dimension.axes());
            }
        }
    }
    Ok(resolved)
}

/// A shape without what of it lies beyond mirrors; one that goes on without an end stays as it is.
fn cut(shape: Shape, mirrors: &[Mirror], axes: usize) -> Shape {
    let Some(bounds) = shape.bounds(axes).filter(Bounds::is_finite) else { return shape };
    let behind = |mirror: &&Mirror| {
        let end = if mirror.inward > 0.0 { bounds.min } else { bounds.max }[mirror.axis];
        mirror.inward * (end - mirror.position) < 0.0
    };
    let half_space = |mirror: &Mirror| {
        let along = |value: f64| std::array::from_fn(|k| if k == mirror.axis { value } else { 0.0 });
        Shape::HalfSpace { point: along(mirror.position), normal: along(-mirror.inward) }
    };
    let mut parts = vec![shape];
    parts.extend(mirrors.iter().filter(behind).map(half_space));
    if parts.len() == 1 { parts.remove(0) } else { Shape::Intersection(parts) }
}

/// The number of the material that a text names.
pub fn material_of(text: &Text, materials: &[NamedMaterial], context: &Context) -> Result<usize, Fault> {
    let names: Vec<&str> = materials.iter().map(|material| material.name.as_str()).collect();
    let material = text.name_of(context, "the name of a material", &names)?;
    Ok(names.iter().position(|name| *name == material).expect("name_of found it in names"))
}

impl Body {
    /// The mirrors that cut its shape, if they do.
    fn cutting_mirrors(
        &self,
        domain: Option<&Domain>,
        context: &Context,
    ) -> Result<Option<Vec<Mirror>>, Fault> {
        let Some(word) = &self.beyond_mirrors else { return Ok(None) };
        if word.value(context)? == BeyondMirrors::Refused {
            return Ok(None);
        }
        let faces = domain.into_iter().flat_map(|domain| {
            (0..context.dimension.axes()).flat_map(move |axis| {
                let [lower, upper] = domain.faces[axis];
                let ends = [(lower, domain.min[axis], 1.0), (upper, domain.max[axis], -1.0)];
                ends.into_iter()
                    .filter(|(face, ..)| *face == Face::Symmetry)
                    .map(move |(_, position, inward)| Mirror { axis, position, inward })
            })
        });
        let mirrors: Vec<Mirror> = faces.collect();
        match mirrors.is_empty() {
            true => Err(word.refused(context, "\"refused\", as no face of the domain is \"symmetry\"")),
            false => Ok(Some(mirrors)),
        }
    }

    fn resolve(&self, materials: &[NamedMaterial], context: &Context) -> Result<scene::Body, Fault> {
        let material = material_of(&self.material, materials, context)?;
        let mut body = scene::Body::new(&self.name.value(context)?, material, self.shape.resolve(context)?);
        if let Some(word) = &self.particles {
            body.particles = word.value(context)?;
        }
        if let Some(count) = &self.particles_per_side {
            body.particles_per_side = Some(count.value(context, 1..=8)?);
        }
        body.interior = self.interior.as_ref().map(|word| word.value(context)).transpose()?;
        body.cell = self.cell.as_ref().map(|cell| cell.positive(context)).transpose()?;
        let keys = BodyKeys { velocity: &self.velocity, spin: &self.spin, rigid: &self.rigid };
        (body.motion, body.velocity_by_place) = keys.motion(context)?;
        body.stress = self.stress.as_ref().map(|stress| stress.resolve(context).map(Box::new)).transpose()?;
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
    /// How it moves, and the part of its velocity at the start that depends on the place.
    pub fn motion(&self, context: &Context) -> Result<(BodyMotion, VelocityByPlace), Fault> {
        match &self.rigid {
            Some(rigid) => Ok((self.rigid_motion(rigid, context)?, None)),
            None => self.free_motion(context),
        }
    }

    fn free_motion(&self, context: &Context) -> Result<(BodyMotion, VelocityByPlace), Fault> {
        let spin = self.spin.as_ref().map_or(Ok([0.0; 3]), |spin| spin.value(context))?;
        let Some(input) = &self.velocity else {
            return Ok((BodyMotion::Free { velocity: [0.0; 3], spin }, None));
        };
        let by_place = input.over_place(context)?;
        if by_place.iter().all(|part| part.constant().is_some()) {
            return Ok((BodyMotion::Free { velocity: input.value(context)?, spin }, None));
        }
        let velocity = by_place.each_ref().map(|part| part.constant().unwrap_or(0.0));
        if velocity.iter().any(|part| !part.is_finite()) {
            return Err(input.node().fault("components that are finite"));
        }
        let by_place = by_place.map(|part| match part {
            Expression::Constant(_) => Expression::Constant(0.0),
            varies => varies,
        });
        Ok((BodyMotion::Free { velocity, spin }, Some(Box::new(by_place))))
    }

    fn rigid_motion(&self, rigid: &Rigid, context: &Context) -> Result<BodyMotion, Fault> {
        let start = self.velocity.as_ref().map(VectorInput::node).or(self.spin.as_ref().map(SpinInput::node));
        if let Some(free) = &rigid.free {
            let displaced = rigid.displacement.as_ref().map(VaryingVector::node);
            let driven = rigid.velocity.as_ref().map(OrOutside::node).or(displaced);
            if let Some(node) = driven.or(rigid.spin.as_ref().map(OrOutside::node)) {
                let found = format!("`{}` prescribed to a free body", node.name());
                let allowed =
                    format!("the {} at the start as the body's own key, beside `rigid`", node.name());
                return Err(Fault::new(&node.key(), found, allowed).at(node.name_span()));
            }
            return Ok(BodyMotion::FreeRigid(FreeRigid {
                velocity: self.velocity.as_ref().map_or(Ok([0.0; 3]), |velocity| velocity.value(context))?,
                spin: self.spin.as_ref().map_or(Ok([0.0; 3]), |spin| spin.value(context))?,
                mass: free.mass.as_ref().map(|mass| positive(mass, context)).transpose()?,
                inertia: free.inertia.as_ref().map(|inertia| inertia.value(context)).transpose()?,
            }));
        }
        if let Some(node) = start {
            let found = format!("`{}` of a rigid body", node.name());
            let allowed = format!("its motion in rigid = {{ {} = ... }}", node.name());
            return Err(Fault::new(&node.key(), found, allowed).at(node.name_span()));
        }
        let rest = || Ok([0.0; 3].map(Expression::Constant));
        let velocity = match (&rigid.velocity, &rigid.displacement) {
            (Some(_), Some(displacement)) => {
                let node = displacement.node();
                return Err(Fault::new(&node.key(), "`displacement` beside `velocity`", "one of the two")
                    .at(node.name_span()));
            }
            (Some(velocity), None) => velocity.resolve(
                context,
                |i| i < context.dimension.axes(),
                |v| v.resolve(context, Dependence::Time),
            ),
            (None, Some(displacement)) => displaced(displacement, context),
            (None, None) => rest(),
        };
        let spin = rigid.spin.as_ref().map_or_else(rest, |spin| {
            spin.resolve(context, |i| i == 2 || !context.dimension.is_plane(), |w| w.resolve(context))
        });
        Ok(BodyMotion::Rigid { velocity: Box::new(velocity?), spin: Box::new(spin?) })
    }
}

/// What of a velocity at the start depends on the place.
pub type VelocityByPlace = Option<Box<[Expression; 3]>>;

/// The velocity of what is displaced.
fn displaced(input: &VaryingVector<Length>, context: &Context) -> Result<[Expression; 3], Fault> {
    let displacement = input.resolve(context, Dependence::Time)?;
    // To round-off of what is a metre.
    if displacement.iter().any(|part| part.at(0.0).is_nan() || part.at(0.0).abs() > 1e-12) {
        return Err(input.node().fault("one that is 0 at t = 0: how far the body is from where it is drawn"));
    }
    Ok(displacement.map(Expression::into_rate))
}
