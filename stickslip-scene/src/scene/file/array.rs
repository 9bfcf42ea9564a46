//! `array`: copies of a body on a lattice, in a ring, or along a path.

use super::Context;
use super::quantity::{Angle, Length, QuantityInput, Ratio};
use super::read::table;
use super::shape::{ShapeInput, direction};
use super::text::{Choice, Count, Word};
use super::vector::VectorInput;
use crate::geometry::{Shape, spline};
use crate::packing::Placement;
use crate::packing::array::{Array, Extent, Lattice, MOST_COPIES, NoArray};
use crate::scene::Dimension;
use crate::scene::document_node::{DocumentNode, joined};
use crate::scene::error::Fault;
use std::f64::consts::TAU;

table! {
    /// How copies of a body are arranged: one of these.
    ArrayKeys {
        /// On a square lattice, in space a cubic one.
        square: Option<LatticeInput>,
        /// On a hexagonal lattice, every other row shifted by half of the spacing; in space in layers of these, as balls
        /// lie closest.
        hexagonal: Option<LatticeInput>,
        /// Around a point, in space around an axis.
        ring: Option<RingInput>,
        /// At equal distances along a path.
        path: Option<PathInput>,
    }
}

table! {
    /// A lattice: so many copies from the body's shape on, or all that lie in a container.
    LatticeInput {
        /// Distance between the middles of neighbours [m].
        spacing: QuantityInput<Length>,
        /// How many along each axis, [10, 5]; the first is the shape itself.
        counts: Option<Vec<Count>>,
        /// Or the container of all copies, a shape: within.box = { min = [0, 0], max = [1, 1] }. The lattice begins in its
        /// lower corner, wherever the body's shape is.
        within: Option<ShapeInput>,
    }
}

table! {
    /// A ring; the first copy is the shape itself.
    RingInput {
        /// The point around which they are [m].
        center: VectorInput<Length>,
        /// The axis through it, of any length; three dimensions only.
        axis: Option<VectorInput<Ratio>>,
        /// How many.
        count: Count,
        /// Angle from each to the next, right-handed about the axis; by default they share a full turn.
        angle: Option<QuantityInput<Angle>>,
        /// Whether they are turned by that angle, too.
        #[schemars(extend("default" = "turned"))]
        orientation: Option<Word<Facing>>,
    }
}

table! {
    /// A path, from whose first point on the middles of copies lie.
    PathInput {
        /// Its points [m]; if the last is the first, the path is closed.
        points: Vec<VectorInput<Length>>,
        /// Whether it is smooth at its points.
        #[schemars(extend("default" = "straight"))]
        curve: Option<Word<Curve>>,
        /// Distance along it between copies [m]; on a closed path changed by a little, so that they come out even.
        spacing: QuantityInput<Length>,
        /// Whether they are turned with the path.
        #[schemars(extend("default" = "turned"))]
        orientation: Option<Word<Facing>>,
    }
}

/// How copies are turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    Turned,
    Kept,
}

/// How a path leads from point to point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curve {
    Straight,
    Smooth,
}

impl Choice for Facing {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("turned", Facing::Turned, "In a ring with it; along a path what lies along x lies along the path."),
        ("kept", Facing::Kept, "As the shape is given."),
    ];
}

impl Choice for Curve {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("straight", Curve::Straight, "By straight lines."),
        ("smooth", Curve::Smooth, "By a smooth curve."),
    ];
}

impl ArrayKeys {
    /// Each copy of a shape; `key` is that of the array.
    pub fn place(&self, shape: &Shape, key: &str, context: &Context) -> Result<Vec<Placement>, Fault> {
        let allowed = "one of square, hexagonal, ring and path";
        let container;
        let (kind, array) = match (&self.square, &self.hexagonal, &self.ring, &self.path) {
            (Some(lattice), None, None, None) => {
                container = lattice.container(context)?;
                ("square", lattice.resolve((Lattice::Square, &container), &joined(key, "square"), context)?)
            }
            (None, Some(lattice), None, None) => {
                container = lattice.container(context)?;
                let key = joined(key, "hexagonal");
                ("hexagonal", lattice.resolve((Lattice::Hexagonal, &container), &key, context)?)
            }
            (None, None, Some(ring), None) => ("ring", ring.resolve(&joined(key, "ring"), context)?),
            (None, None, None, Some(path)) => ("path", path.resolve(context)?),
            (None, None, None, None) => return Err(Fault::new(key, "an array of no kind", allowed)),
            _ => return Err(Fault::new(key, "an array of several kinds", allowed)),
        };
        let key = joined(key, kind);
        array.place(shape, context.dimension.axes()).map_err(|problem| match problem {
            NoArray::Shape => Fault::new(
                &key,
                "an array of a shape without bounds, or in which nothing is",
                "a shape with bounds",
            ),
            NoArray::Container => {
                Fault::new(&joined(&key, "within"), "a shape without bounds", "a container with bounds")
            }
            NoArray::NoRoom => Fault::new(
                &joined(&key, "within"),
                "a container in which the shape has no room",
                "one that holds a copy at least",
            ),
            NoArray::TooMany(count) => {
                Fault::new(&key, format!("about {count:.1e} copies"), format!("at most {MOST_COPIES}"))
                    .help(Some("are the units right?".to_string()))
            }
        })
    }
}

impl LatticeInput {
    fn container(&self, context: &Context) -> Result<Option<Shape>, Fault> {
        self.within.as_ref().map(|within| within.resolve(context)).transpose()
    }

    fn resolve<'a>(
        &self,
        (kind, container): (Lattice, &'a Option<Shape>),
        key: &str,
        context: &Context,
    ) -> Result<Array<'a>, Fault> {
        let allowed = "one of counts and within";
        let extent = match (&self.counts, container) {
            (Some(counts), None) => {
                let axes = context.dimension.axes();
                let mut each = [1; 3];
                if counts.len() != axes {
                    let found = format!("{} numbers", counts.len());
                    return Err(Fault::new(&joined(key, "counts"), found, format!("{axes} whole numbers")));
                }
                for (one, count) in each.iter_mut().zip(counts) {
                    *one = count.value(context, 1..=MOST_COPIES)?;
                }
                Extent::Counts(each)
            }
            (None, Some(container)) => Extent::Within(container),
            (Some(_), Some(_)) => {
                return Err(Fault::new(&joined(key, "within"), "`within` beside `counts`", allowed));
            }
            (None, None) => return Err(Fault::new(key, "neither `counts` nor `within`", allowed)),
        };
        Ok(Array::Lattice { kind, spacing: self.spacing.positive(context)?, extent })
    }
}

impl RingInput {
    fn resolve(&self, key: &str, context: &Context) -> Result<Array<'static>, Fault> {
        let axis = match (&self.axis, context.dimension) {
            (None, plane) if plane.is_plane() => [0.0, 0.0, 1.0],
            (Some(axis), Dimension::Space) => direction(axis, context)?,
            (Some(axis), _) => return Err(axis.node().fault("no axis, as the scene is plane")),
            (None, _) => {
                let allowed = "the axis of the ring: [0, 0, 1]";
                return Err(Fault::new(&joined(key, "axis"), "nothing, the key is missing", allowed));
            }
        };
        let count = self.count.value(context, 1..=MOST_COPIES)?;
        let share = TAU / count as f64;
        Ok(Array::Ring {
            center: self.center.value(context)?,
            axis,
            count,
            angle: self.angle.as_ref().map_or(Ok(share), |angle| angle.value(context))?,
            turned: is_turned(&self.orientation, context)?,
        })
    }
}

impl PathInput {
    fn resolve(&self, context: &Context) -> Result<Array<'static>, Fault> {
        let corners = self.points.iter().map(|point| point.value(context)).collect::<Result<Vec<_>, _>>()?;
        let node = |i: usize| -> &DocumentNode { self.points[i].node() };
        if let Some(i) = (1..corners.len()).find(|&i| corners[i] == corners[i - 1]) {
            return Err(node(i).fault("another point than the one before it"));
        }
        let is_closed = corners.first() == corners.last();
        if corners.len() < if is_closed { 4 } else { 2 } {
            let key = self.spacing.node().key().replace("spacing", "points");
            let found = format!("{} points", corners.len());
            return Err(Fault::new(&key, found, "at least 2 points, 4 if the last is the first"));
        }
        let curve = self.curve.as_ref().map_or(Ok(Curve::Straight), |word| word.value(context))?;
        let points = match (curve, is_closed) {
            (Curve::Straight, _) => corners,
            (Curve::Smooth, false) => spline::open(&corners),
            (Curve::Smooth, true) => {
                let mut points = spline::closed(&corners[..corners.len() - 1]);
                points.push(points[0]);
                points
            }
        };
        let turned = is_turned(&self.orientation, context)?;
        Ok(Array::Path { points, spacing: self.spacing.positive(context)?, turned })
    }
}

fn is_turned(orientation: &Option<Word<Facing>>, context: &Context) -> Result<bool, Fault> {
    Ok(orientation.as_ref().map_or(Ok(Facing::Turned), |word| word.value(context))? == Facing::Turned)
}
