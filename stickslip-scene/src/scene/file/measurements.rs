//! `outputs.probes`, `outputs.arrivals`, `outputs.fronts`: what is measured while a scene runs.

use super::Context;
use super::outputs::Outputs;
use super::quantity::{Duration, Length, QuantityInput, Ratio, evaluate};
use super::read::{Read, table};
use super::repeat::Repeat;
use super::space::corners;
use super::text::{Choice, Count, Text, Word, names_in};
use super::vector::VectorInput;
use crate::scene::FACES;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::parameters::Dependence;
use crate::scene::units::Powers;
use crate::scene::{self, Anchor, Body, Dimension, Observable, Reading};
use crate::tensor::Vector;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::collections::HashSet;

table! {
    /// A point at which velocity and stress are recorded.
    Probe {
        /// Its name.
        name: Text,
        /// Makes many of it: indices, and how many values each has, as of [[bodies]]. By default one.
        repeat: Option<Repeat>,
        /// Where it is at the start [m].
        at: VectorInput<Length>,
        /// Makes a line of `count` probes, "name 1", "name 2" ..., at equal distances from `at` to this point [m]. By
        /// default one probe.
        to: Option<VectorInput<Length>>,
        /// How many probes that line has.
        count: Option<Count>,
        /// Name of the body that it looks at; by default whichever is there.
        body: Option<Text>,
        /// What it stays with.
        #[schemars(extend("default" = "space"))]
        fixed_in: Option<Word<Anchor>>,
    }
}

table! {
    /// A threshold whose first passing is recorded, at probes and in bodies.
    Arrival {
        /// The quantity.
        quantity: Word<Observable>,
        /// It has arrived once it is this or beyond, seen from zero; a negative threshold is passed downward.
        threshold: Threshold,
        /// Names of probes; by default all of them if no bodies are named.
        probes: Option<Vec<Text>>,
        /// Names of bodies; by default none.
        bodies: Option<Vec<Text>>,
        /// What stands for a body.
        #[schemars(extend("default" = "center"))]
        reading: Option<Word<Reading>>,
    }
}

table! {
    /// A front: the furthest point along a direction at which a quantity is at a threshold or beyond.
    Front {
        /// Its name.
        name: Text,
        /// The quantity.
        quantity: Word<Observable>,
        /// As that of an arrival.
        threshold: Threshold,
        /// The point from which its way is measured [m].
        from: VectorInput<Length>,
        /// The direction along which it is measured; any length.
        direction: VectorInput<Ratio>,
        /// Only material within this distance of the line along `direction` counts [m]; by default all.
        within: Option<QuantityInput<Length>>,
        /// Names of the bodies in which it runs; by default all but rigid ones.
        bodies: Option<Vec<Text>>,
        /// Start and end of the way over which its speed is fitted [m];
        /// by default from 10 % to 90 % of the way that it went.
        fit: Option<WayInput>,
    }
}

table! {
    /// A plane of space through which the force and the moment in the material are recorded.
    Section {
        /// Its name.
        name: Text,
        /// Makes many of it: indices, and how many values each has, as of [[bodies]]. By default one.
        repeat: Option<Repeat>,
        /// A point of the plane, about which moments are taken [m].
        point: VectorInput<Length>,
        /// Normal of the plane, of any length: the force is that of the material on its side on the rest.
        normal: VectorInput<Ratio>,
        /// Only what is in this box counts: within = { min = [0, 0], max = [1, 1] }; by default all.
        within: Option<Room>,
        /// Names of the bodies that it cuts; by default all but rigid ones.
        bodies: Option<Vec<Text>>,
    }
}

table! {
    /// Bodies whose sums are recorded, and the forces between them and other groups.
    Group {
        /// Its name.
        name: Text,
        /// Makes many of it: indices, and how many values each has, as of [[bodies]]. By default one.
        repeat: Option<Repeat>,
        /// Names of its bodies, or patterns in which `*` is any letters.
        bodies: Vec<Text>,
    }
}

table! {
    /// Bodies whose mean stress, contacts and their directions are recorded, from the forces between them.
    Fabric {
        /// Its name.
        name: Text,
        /// Makes many of it: indices, and how many values each has, as of [[bodies]]. By default one.
        repeat: Option<Repeat>,
        /// Names of its bodies, or patterns in which `*` is any letters; by default all that forces move.
        bodies: Option<Vec<Text>>,
        /// The box over which the stress is averaged: within = { min = [0, 0], max = [1, 1] }. Bodies count whose
        /// centres are in it.
        within: Room,
    }
}

table! {
    /// Points of contact whose pressure and shear are recorded: points of the surfaces of bodies on grids of their own.
    Tractions {
        /// Interval between records [s]; by default that of `tables`.
        interval: Option<QuantityInput<Duration>>,
        /// Names of the bodies whose points they are, or patterns in which `*` is any letters; by default all on grids
        /// of their own.
        bodies: Option<Vec<Text>>,
    }
}

table! {
    /// A box.
    Room {
        /// Lower corner [m].
        min: VectorInput<Length>,
        /// Upper corner [m].
        max: VectorInput<Length>,
    }
}

/// A number whose dimension depends on the quantity it is for.
pub struct Threshold(DocumentNode);

/// Start and end of a way.
#[derive(JsonSchema)]
#[schemars(transparent)]
#[schemars(rename = "Way")]
pub struct WayInput([QuantityInput<Length>; 2]);

/// An interval, or every step.
pub enum Sampling {
    /// The word "step".
    EveryStep,
    /// The interval.
    Every(QuantityInput<Duration>),
}

impl Choice for Anchor {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("space", Anchor::Space, "A point of space, through which material may move."),
        ("material", Anchor::Material, "A point of the material, with which it moves."),
    ];
}

impl Choice for Reading {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("center", Reading::Center, "The material at the centre of mass at the start."),
        ("any", Reading::Any, "The particle that is furthest beyond zero."),
        ("mean", Reading::Mean, "The mean over the mass."),
    ];
}

impl Choice for Observable {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("vx", Observable::Vx, "Velocity along x."),
        ("vy", Observable::Vy, "Velocity along y."),
        ("vz", Observable::Vz, "Velocity along z."),
        ("speed", Observable::Speed, "Magnitude of the velocity."),
        ("xx", Observable::Xx, "Normal stress along x, tension positive."),
        ("yy", Observable::Yy, "Normal stress along y."),
        ("zz", Observable::Zz, "Normal stress along z."),
        ("xy", Observable::Xy, "Shear stress in the plane of x and y."),
        ("yz", Observable::Yz, "Shear stress in the plane of y and z."),
        ("xz", Observable::Xz, "Shear stress in the plane of x and z."),
        ("pressure", Observable::Pressure, "Minus a third of the trace of the stress."),
        (
            "stress_difference",
            Observable::StressDifference,
            "Difference of the principal stresses in the plane of x and y, as light along z sees it.",
        ),
        ("von_mises", Observable::VonMises, "Equivalent stress of von Mises."),
    ];
}

/// What is measured in a run of length `end` [s], and of each probe its table in the file.
pub fn resolve(
    outputs: &Outputs,
    (bodies, end): (&[Body], f64),
    context: &Context,
) -> Result<(scene::Measurements, Vec<String>), Fault> {
    let rigid = bodies.iter().filter(|body| body.is_rigid()).map(|body| body.name.as_str());
    let known: Vec<&str> = FACES.into_iter().flatten().chain(rigid).collect();
    let reactions = outputs.reactions.as_deref().unwrap_or_default();
    let what = "a face of the domain or the name of a rigid body";
    let reactions = names_in(reactions, (what, &known), context)?;
    let all: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
    let moved = bodies.iter().filter(|body| !body.is_rigid() || body.as_free_rigid().is_some());
    let moved: Vec<String> = moved.map(|body| body.name.clone()).collect();
    let free = bodies.iter().filter(|body| !body.is_rigid());
    let bodies: Vec<&str> = free.map(|body| body.name.as_str()).collect();
    let (mut probes, mut taken): (Vec<scene::Probe>, _) = (Vec::new(), HashSet::new());
    let mut declared = Vec::new();
    for (i, probe) in outputs.probes.iter().flatten().enumerate() {
        Repeat::each(probe.repeat.as_ref(), context, || {
            let resolved = probe.resolve((&bodies, &mut taken), context)?;
            declared.resize(probes.len() + resolved.len(), format!("outputs.probes[{i}]"));
            probes.extend(resolved);
            Ok(())
        })?;
    }
    let names: Vec<&str> = probes.iter().map(|probe| probe.name.as_str()).collect();
    let arrivals = outputs.arrivals.iter().flatten();
    let arrivals =
        arrivals.map(|arrival| arrival.resolve((&names, &bodies), context)).collect::<Result<_, _>>()?;
    let mut taken = HashSet::new();
    let fronts = outputs.fronts.iter().flatten();
    let fronts =
        fronts.map(|front| front.resolve((&bodies, &mut taken), context)).collect::<Result<_, _>>()?;
    let (mut sections, mut taken) = (Vec::new(), HashSet::new());
    for section in outputs.sections.iter().flatten() {
        Repeat::each(section.repeat.as_ref(), context, || {
            sections.push(section.resolve((&bodies, &mut taken), context)?);
            Ok(())
        })?;
    }
    let (mut groups, mut taken) = (Vec::new(), HashSet::new());
    for group in outputs.groups.iter().flatten() {
        Repeat::each(group.repeat.as_ref(), context, || {
            let bodies = names_in(&group.bodies, ("the name of a body", &all), context)?;
            groups.push(scene::Group { name: group.name.new_name(context, &mut taken)?, bodies });
            Ok(())
        })?;
    }
    let (mut fabric, mut taken) = (Vec::new(), HashSet::new());
    for packing in outputs.fabric.iter().flatten() {
        Repeat::each(packing.repeat.as_ref(), context, || {
            fabric.push(packing.resolve((&all, &moved, &mut taken), context)?);
            Ok(())
        })?;
    }
    let tractions = outputs.tractions.as_ref();
    let tractions = tractions.map(|asked| asked.resolve(&bodies, context)).transpose()?;
    let time_unit = outputs.time_unit.as_ref().map(|unit| time_unit(unit, context)).transpose()?;
    let samples = match &outputs.samples {
        None => scene::Measurements::of_run(end).samples,
        Some(Sampling::EveryStep) => 0.0,
        Some(Sampling::Every(interval)) => interval.positive(context)?,
    };
    Ok((
        scene::Measurements {
            time_unit,
            samples,
            probes,
            arrivals,
            fronts,
            sections,
            reactions,
            groups,
            fabric,
            tractions,
        },
        declared,
    ))
}

fn time_unit(unit: &QuantityInput<Duration>, context: &Context) -> Result<scene::TimeUnit, Fault> {
    let seconds = unit.positive(context)?;
    let name = match &unit.node().value {
        Value::Text(text) => text.clone(),
        _ => format!("{seconds} s"),
    };
    Ok(scene::TimeUnit { seconds, name })
}

/// A quantity that the scene has: in the plane those out of it are zero always.
fn observed(word: &Word<Observable>, context: &Context) -> Result<Observable, Fault> {
    let quantity = word.value(context)?;
    let out_of_plane = matches!(quantity, Observable::Vz | Observable::Yz | Observable::Xz)
        || quantity == Observable::Zz && context.dimension == Dimension::PlaneStress;
    if context.dimension.is_plane() && out_of_plane {
        return Err(word.refused(context, "a quantity that the plane has: this one is zero always"));
    }
    Ok(quantity)
}

const A_BODY: &str = "the name of a body that is not rigid";

impl Probe {
    /// One, or those of a line.
    fn resolve(
        &self,
        (bodies, taken): (&[&str], &mut HashSet<String>),
        context: &Context,
    ) -> Result<Vec<scene::Probe>, Fault> {
        let at = self.at.value(context)?;
        let body = self.body.as_ref().map(|name| name.name_of(context, A_BODY, bodies)).transpose()?;
        let fixed_in = self.fixed_in.as_ref().map_or(Ok(Anchor::Space), |word| word.value(context))?;
        let probe = |name: String, at: [f64; 3]| scene::Probe { name, at, body: body.clone(), fixed_in };
        let (to, count) = match (&self.to, &self.count) {
            (None, None) => return Ok(vec![probe(self.name.new_name(context, taken)?, at)]),
            (Some(to), Some(count)) => (to.value(context)?, count.value(context, 2..=MOST_ON_LINE)?),
            (Some(to), None) => {
                let key = to.node().key().replace(".to", ".count");
                return Err(Fault::new(&key, "nothing, the key is missing", "how many probes the line has"));
            }
            (None, Some(count)) => {
                return Err(count.refused(context, "a count only beside `to`, the end of a line")?);
            }
        };
        let name = self.name.new_name(context, taken)?;
        let place = |i: usize| {
            let share = i as f64 / (count - 1) as f64;
            std::array::from_fn(|k| at[k] + share * (to[k] - at[k]))
        };
        let numbered = |i: usize| {
            let numbered = format!("{name} {}", i + 1);
            let is_new = taken.insert(numbered.clone());
            let refused = || self.name.refused(&numbered, "a name that no other in the list has");
            if is_new { Ok(probe(numbered, place(i))) } else { Err(refused()) }
        };
        (0..count).map(numbered).collect()
    }
}

/// Probes of one line.
const MOST_ON_LINE: usize = 100_000;

impl Arrival {
    fn resolve(
        &self,
        (probes, bodies): (&[&str], &[&str]),
        context: &Context,
    ) -> Result<scene::Arrival, Fault> {
        let quantity = observed(&self.quantity, context)?;
        if let Some(word) = self.reading.as_ref().filter(|_| self.bodies.is_none()) {
            return Err(word.refused(context, "`bodies` beside it, for which it says what stands for them"));
        }
        let at = match (&self.probes, &self.bodies) {
            (Some(list), _) => names_in(list, ("the name of a probe", probes), context)?,
            (None, Some(_)) => Vec::new(),
            (None, None) => probes.iter().map(|name| name.to_string()).collect(),
        };
        let bodies = names_in(self.bodies.as_deref().unwrap_or_default(), (A_BODY, bodies), context)?;
        if at.is_empty() && bodies.is_empty() {
            let mut fault =
                self.quantity.node().fault("probes or bodies to watch: probes = [...], bodies = [...]");
            fault.problem.found = "an arrival that watches no probe and no body".to_string();
            return Err(fault);
        }
        let reading = self.reading.as_ref();
        Ok(scene::Arrival {
            quantity,
            threshold: self.threshold.value(quantity, context)?,
            probes: at,
            bodies,
            reading: reading.map_or(Ok(Reading::Center), |word| word.value(context))?,
        })
    }
}

impl Front {
    fn resolve(
        &self,
        (bodies, taken): (&[&str], &mut HashSet<String>),
        context: &Context,
    ) -> Result<scene::Front, Fault> {
        let quantity = observed(&self.quantity, context)?;
        let direction = self.direction.value(context)?;
        let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        if !(length > 0.0 && length.is_finite()) {
            return Err(self.direction.node().fault("a direction that is not zero, such as [1, 0]"));
        }
        Ok(scene::Front {
            name: self.name.new_name(context, taken)?,
            quantity,
            threshold: self.threshold.value(quantity, context)?,
            from: self.from.value(context)?,
            direction: direction.map(|d| d / length),
            within: self.within.as_ref().map(|width| width.positive(context)).transpose()?,
            bodies: match &self.bodies {
                Some(list) => names_in(list, (A_BODY, bodies), context)?,
                None => bodies.iter().map(|name| name.to_string()).collect(),
            },
            fit: self.fit.as_ref().map(|way| way.value(context)).transpose()?,
        })
    }
}

impl Section {
    fn resolve(
        &self,
        (bodies, taken): (&[&str], &mut HashSet<String>),
        context: &Context,
    ) -> Result<scene::Section, Fault> {
        let Some(normal) = Vector(self.normal.value(context)?).direction() else {
            return Err(self.normal.node().fault("a direction that is not zero, such as [1, 0]"));
        };
        Ok(scene::Section {
            name: self.name.new_name(context, taken)?,
            point: self.point.value(context)?,
            normal: normal.0,
            within: self.within.as_ref().map(|room| room.value(context)).transpose()?,
            bodies: match &self.bodies {
                Some(list) => names_in(list, (A_BODY, bodies), context)?,
                None => bodies.iter().map(|name| name.to_string()).collect(),
            },
        })
    }
}

impl Fabric {
    fn resolve(
        &self,
        (all, moved, taken): (&[&str], &[String], &mut HashSet<String>),
        context: &Context,
    ) -> Result<scene::Fabric, Fault> {
        let name = self.name.new_name(context, taken)?;
        let bodies = match &self.bodies {
            Some(list) => names_in(list, ("the name of a body", all), context)?,
            None => moved.to_vec(),
        };
        Ok(scene::Fabric { name, bodies, within: self.within.value(context)? })
    }
}

impl Tractions {
    fn resolve(&self, bodies: &[&str], context: &Context) -> Result<scene::Tractions, Fault> {
        let names = self.bodies.as_ref().map(|names| names_in(names, (A_BODY, bodies), context));
        Ok(scene::Tractions {
            interval: self.interval.as_ref().map(|interval| interval.positive(context)).transpose()?,
            bodies: names.transpose()?,
        })
    }
}

impl Room {
    fn value(&self, context: &Context) -> Result<[[f64; 3]; 2], Fault> {
        let (min, max) = corners(&self.min, &self.max, context)?;
        Ok([min, max])
    }
}

impl Threshold {
    fn value(&self, quantity: Observable, context: &Context) -> Result<f64, Fault> {
        let powers = Powers::from(quantity.powers());
        let allowed = format!("{} other than 0, like \"{}\"", powers.name(), powers.example());
        let value = evaluate(&self.0, powers, &allowed, (context, Dependence::Constant))?.at(0.0);
        if value != 0.0 && value.is_finite() { Ok(value) } else { Err(self.0.fault(allowed)) }
    }
}

impl WayInput {
    fn value(&self, context: &Context) -> Result<[f64; 2], Fault> {
        let [start, end] = [self.0[0].value(context)?, self.0[1].value(context)?];
        if start < end {
            Ok([start, end])
        } else {
            Err(self.0[1].refused(end, format!("more than {start} m")))
        }
    }
}

impl Read for Threshold {
    fn wanted() -> String {
        "a number with the unit of the quantity, like \"2 MPa\"".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Text(_) | Value::Number(_) => Ok(Threshold(node.clone())),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl Read for WayInput {
    fn wanted() -> String {
        "two lengths: [\"5 mm\", \"30 mm\"]".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match &node.value {
            Value::List(items) if items.len() == 2 => {
                Ok(WayInput([QuantityInput::read(&items[0])?, QuantityInput::read(&items[1])?]))
            }
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl Read for Sampling {
    fn wanted() -> String {
        format!("{}, or \"step\"", QuantityInput::<Duration>::wanted())
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match &node.value {
            Value::Text(text) if text == "step" => Ok(Sampling::EveryStep),
            Value::Text(_) | Value::Number(_) => Ok(Sampling::Every(QuantityInput::new(node))),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl JsonSchema for Threshold {
    fn schema_name() -> Cow<'static, str> {
        "Threshold".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["number", "string"], "examples": ["2 MPa"] })
    }
}

impl JsonSchema for Sampling {
    fn schema_name() -> Cow<'static, str> {
        "Sampling".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["number", "string"], "examples": ["10 ns", "step"] })
    }
}
