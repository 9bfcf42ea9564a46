//! `[[packings]]`: many bodies at once, at random places in a container, without overlap.

use super::Context;
use super::body::{Bodies, BodyKeys, Rigid, material_of};
use super::quantity::{Length, QuantityInput, Ratio, Velocity};
use super::read::{Read, table};
use super::shape::ShapeInput;
use super::text::{Choice, Count, Text, Word};
use super::vector::{SpinInput, VectorInput, direction};
use crate::geometry::{Arrangement, Shape, fits};
use crate::packing::{self, Amount, MOST_GRAINS, NoPacking, Sizes};
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::{self, Domain, Interior, NamedMaterial};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;

table! {
    /// Bodies of one shape at random places in a container, without overlap, the same for the same seed.
    Packing {
        /// What the bodies are called: "grain" makes "grain 1", "grain 2" ..., together "grain *".
        name: Text,
        /// Name of their material.
        material: Text,
        /// A grain, wherever it is: shape.ball = { center = [0, 0], radius = "1 mm" }.
        shape: ShapeInput,
        /// Sizes over that of `shape`: a number, or a distribution; by default all are as it is.
        sizes: Option<SizesInput>,
        /// The container: within.box = { min = [0, 0], max = [1, 1] }. Bodies touch it at most; where it goes from one
        /// periodic face of the domain to the other, they lie across these.
        within: ShapeInput,
        /// How many; or else solid_fraction.
        count: Option<Count>,
        /// Volume of the grains over that of the container; to meet it, all sizes change by a little. Random packings
        /// of balls jam near 0.64, of disks of several sizes near 0.84, less beside walls.
        solid_fraction: Option<QuantityInput<Ratio>>,
        /// Distance that grains keep at least from each other and from the container [m].
        #[schemars(extend("default" = 0))]
        gap: Option<QuantityInput<Length>>,
        /// Lets the grains fall along this direction, of any length, and come to rest on each other and on the container,
        /// without friction: settle = [0, -1]. By default they stay at their random places.
        settle: Option<VectorInput<Ratio>>,
        /// Whether each grain is turned at random.
        #[schemars(extend("default" = "random"))]
        orientation: Option<Word<Orientation>>,
        /// A whole number; another one makes another packing.
        #[schemars(extend("default" = 0))]
        seed: Option<Count>,
        /// How their particles are laid out; by default "fitted" where the shape can be, else "lattice".
        particles: Option<Word<Arrangement>>,
        /// Particles along each side of a cell, 1 to 8; by default as many as space has.
        particles_per_side: Option<Count>,
        /// Where they are computed, if they deform; by default as space says.
        interior: Option<Word<Interior>>,
        /// Side of the cells of their own grids [m], with interior = "reference"; by default that of space.
        cell: Option<QuantityInput<Length>>,
        /// Velocity of each at the start [m/s]; by default none.
        velocity: Option<VectorInput<Velocity>>,
        /// Angular velocity of each about its centre of mass at the start [rad/s]; by default none.
        spin: Option<SpinInput>,
        /// Makes the grains rigid: rigid.free = {} lets forces move each of them, by the mass and the moments of
        /// inertia of its shape and the material's density; without free their motion is prescribed. By default they
        /// deform.
        rigid: Option<Rigid>,
    }
}

/// How grains are turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    Random,
    Kept,
}

impl Choice for Orientation {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("random", Orientation::Random, "Each as likely as any other."),
        ("kept", Orientation::Kept, "As the shape is given."),
    ];
}

/// Sizes of grains as the file has them.
pub struct SizesInput(DocumentNode);

/// Keys of distributions.
const DISTRIBUTIONS: &[&str] = &["uniform", "normal", "lognormal", "numbers", "volumes"];

/// What a seed may be.
const MOST_SEED: usize = 1_000_000_000;

impl Packing {
    /// Takes the bodies of the packing.
    pub fn add_to(
        &self,
        bodies: &mut Bodies,
        (materials, declared): (&[NamedMaterial], &str),
        (domain, context): (Option<&Domain>, &Context),
    ) -> Result<(), Fault> {
        let dimension = context.dimension.axes();
        let (name, material) = (self.name.value(context)?, material_of(&self.material, materials, context)?);
        let (grain, container) = (self.shape.resolve(context)?, self.within.resolve(context)?);
        let orientation =
            self.orientation.as_ref().map_or(Ok(Orientation::Random), |word| word.value(context))?;
        let not_negative =
            |gap: &QuantityInput<Length>| gap.checked(context, "a length [m] from 0 on", |gap| gap >= 0.0);
        let request = packing::Packing {
            container: &container,
            grain: &grain,
            sizes: self.sizes.as_ref().map_or(Ok(Sizes::One(1.0)), |sizes| sizes.value(context))?,
            amount: self.amount(context, declared)?,
            turned: orientation == Orientation::Random && !matches!(grain, Shape::Ball { .. }),
            gap: self.gap.as_ref().map_or(Ok(0.0), not_negative)?,
            settle: self.settle.as_ref().map(|along| direction(along, context)).transpose()?,
            seed: self.seed.as_ref().map_or(Ok(0), |seed| seed.value(context, 0..=MOST_SEED))? as u64,
            dimension,
            repeats: [0, 1, 2].map(|k| repeats(&container, domain?, (k, dimension))),
        };
        let placements = request.find_or_place().map_err(|problem| self.fault(problem, declared))?;
        let fitted = match &self.particles {
            Some(word) => word.value(context)?,
            None if fits(&grain, dimension) => Arrangement::Fitted,
            None => Arrangement::Lattice,
        };
        let keys = BodyKeys { velocity: &self.velocity, spin: &self.spin, rigid: &self.rigid };
        let (motion, by_place) = keys.motion(context)?;
        let per_side =
            self.particles_per_side.as_ref().map(|count| count.value(context, 1..=8)).transpose()?;
        let mut body = scene::Body::new(&name, material, grain.clone());
        (body.particles, body.particles_per_side) = (fitted, per_side);
        body.interior = self.interior.as_ref().map(|word| word.value(context)).transpose()?;
        body.cell = self.cell.as_ref().map(|cell| cell.positive(context)).transpose()?;
        (body.motion, body.velocity_by_place) = (motion, by_place);
        bodies.add_copies(&body, &placements, (&self.name, declared), context)
    }

    fn amount(&self, context: &Context, declared: &str) -> Result<Amount, Fault> {
        let allowed = "one of count and solid_fraction";
        match (&self.count, &self.solid_fraction) {
            (Some(count), None) => Ok(Amount::Count(count.value(context, 1..=MOST_GRAINS)?)),
            (None, Some(fraction)) => {
                let between = |value: f64| value > 0.0 && value < 1.0;
                Ok(Amount::Fraction(fraction.checked(context, "a number above 0 and below 1", between)?))
            }
            (Some(_), Some(fraction)) => {
                let node = fraction.node();
                Err(Fault::new(&node.key(), "`solid_fraction` beside `count`", allowed).at(node.name_span()))
            }
            (None, None) => Err(Fault::new(declared, "neither `count` nor `solid_fraction`", allowed)),
        }
    }

    fn fault(&self, problem: NoPacking, declared: &str) -> Fault {
        let key = |key: &str| format!("{declared}.{key}");
        let at = if self.count.is_some() { "count" } else { "solid_fraction" };
        match problem {
            NoPacking::Grain => {
                Fault::new(&key("shape"), "a shape without bounds, or in which nothing is", "a grain")
            }
            NoPacking::Container => Fault::new(
                &key("within"),
                "a shape without bounds, or in which almost nothing is",
                "a container",
            ),
            NoPacking::Short { axis, least } => {
                let axis = ["x", "y", "z"][axis];
                Fault::new(
                    &key("within"),
                    format!(
                        "a container that repeats along {axis} and is shorter than two of the largest grains"
                    ),
                    format!("at least {least:.4} m between the periodic faces"),
                )
            }
            NoPacking::TooMany(count) => {
                let help = "are the units of the grain and the container right?".to_string();
                Fault::new(declared, format!("about {count:.1e} grains"), format!("at most {MOST_GRAINS}"))
                    .help(Some(help))
            }
            NoPacking::Far => {
                let help = "are the units right?".to_string();
                Fault::new(
                    &key("within"),
                    "a container more than 1e8 grains from the origin",
                    "one that is nearer",
                )
                .help(Some(help))
            }
            NoPacking::Restless(left) => Fault::new(
                &key("settle"),
                format!("grains that do not come to rest: a force of {left:.2} weights is left on one"),
                "grains that rest: some thousands of balls, some hundreds of other shapes; more settle in a run of \
                 their own, see [start]",
            ),
            NoPacking::Overfull(ratio) => {
                let gap = if self.gap.is_some() { ", with half of the gap around each" } else { "" };
                let found = format!("grains of {ratio:.3} times the volume of the container{gap}");
                let allowed = "less than about 0.6 of it in space, 0.8 in the plane";
                let help = "fewer or smaller grains, or a larger container; are the units right?".to_string();
                Fault::new(&key(at), found, allowed).help(Some(help))
            }
            NoPacking::Jammed { asked, room } => {
                let found = format!("grains that fill {asked:.3} of the container, and jam");
                Fault::new(&key(at), found, format!("about {room:.2} of it for these shapes")).help(Some(
                    "fewer or smaller grains, more sizes of them, or a larger container".to_string(),
                ))
            }
        }
    }
}

/// The ends of a container along an axis, if it goes from one periodic face of the domain to the other.
fn repeats(container: &Shape, domain: &Domain, (axis, dimension): (usize, usize)) -> Option<[f64; 2]> {
    /// Over the period.
    const ROUND_OFF: f64 = 1e-9;
    let bounds = container.bounds(dimension).filter(|_| domain.is_periodic(axis))?;
    let (ends, period) = ([domain.min[axis], domain.max[axis]], domain.periods()[axis]);
    let on = |x: f64, end: f64| (x - end).abs() <= ROUND_OFF * period;
    (on(bounds.min[axis], ends[0]) && on(bounds.max[axis], ends[1])).then_some(ends)
}

impl SizesInput {
    fn value(&self, context: &Context) -> Result<Sizes, Fault> {
        let number = |node: &DocumentNode| QuantityInput::<Ratio>::new(node).positive(context);
        let Value::Table(children) = &self.0.value else { return Ok(Sizes::One(number(&self.0)?)) };
        let [kind] = &children[..] else { return Err(self.0.fault(Self::wanted())) };
        let pair = |node: &DocumentNode, allowed: &str| match node.children() {
            [a, b] => Ok([number(a)?, number(b)?]),
            _ => Err(node.fault(allowed)),
        };
        let share = |node: &DocumentNode| pair(node, "a size and its share, such as [1.5, 0.3]");
        let sizes = match kind.name() {
            "numbers" | "volumes" => {
                let shares = kind.children().iter().map(share).collect::<Result<Vec<_>, _>>()?;
                if shares.is_empty() {
                    return Err(kind.fault("a list of sizes and shares: [[1, 0.7], [1.5, 0.3]]"));
                }
                if kind.name() == "numbers" { Sizes::Numbers(shares) } else { Sizes::Volumes(shares) }
            }
            "uniform" | "normal" | "lognormal" => {
                let [a, b] = pair(kind, "two numbers: [0.8, 1.2]")?;
                match kind.name() {
                    "uniform" if a > b => return Err(kind.fault("the smallest size first")),
                    "uniform" => Sizes::Uniform(a, b),
                    "normal" => Sizes::Normal(a, b),
                    _ => Sizes::LogNormal(a, b),
                }
            }
            _ => return Err(super::read::unknown_key(kind, DISTRIBUTIONS)),
        };
        let [least, most] = sizes.range();
        if least > 0.0 && most <= MOST_RATIO * least {
            return Ok(sizes);
        }
        Err(kind
            .fault(format!("sizes above 0, the largest at most {MOST_RATIO} times the smallest"))
            .remark(&format!("these are from {least:.3} to {most:.3}")))
    }
}

/// The largest size over the smallest.
const MOST_RATIO: f64 = 10.0;

impl Read for SizesInput {
    fn wanted() -> String {
        format!("a number, or one of {}, such as {{ uniform = [0.8, 1.2] }}", DISTRIBUTIONS.join(", "))
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Number(_) | Value::Text(_) | Value::Table(_) => Ok(SizesInput(node.clone())),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl JsonSchema for SizesInput {
    fn schema_name() -> Cow<'static, str> {
        "Sizes".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let number = json_schema!({ "type": ["number", "string"] });
        let pair = json_schema!({ "type": "array", "items": number, "minItems": 2, "maxItems": 2 });
        let about = |schema: &Schema, text: &str| {
            let mut schema = schema.clone();
            schema.insert("description".into(), text.into());
            schema
        };
        let list = json_schema!({ "type": "array", "items": pair, "minItems": 1 });
        json_schema!({
            "anyOf": [
                number,
                {
                    "type": "object",
                    "properties": {
                        "uniform": about(&pair, "Each size between two as likely."),
                        "normal": about(&pair, "Mean and standard deviation; cut at three of those."),
                        "lognormal": about(&pair, "Median, and standard deviation of the logarithm; cut at three of those."),
                        "numbers": about(&list, "Sizes, each with its share in the number of grains."),
                        "volumes": about(&list, "Sizes, each with its share in the volume of all grains."),
                    },
                    "additionalProperties": false,
                    "minProperties": 1,
                    "maxProperties": 1
                }
            ]
        })
    }
}
