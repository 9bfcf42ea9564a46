//! Solids beside balls, boxes and cylinders: `shape.capsule = { start = [0, 0], end = [1, 0], radius = "10 cm" }`.

use super::Context;
use super::quantity::{Length, QuantityInput, Ratio};
use super::read::table;
use super::vector::VectorInput;
use crate::geometry::{MOST_EXPONENT, Shape};
use crate::scene::Dimension;
use crate::scene::document_node::{DocumentNode, joined};
use crate::scene::error::Fault;

table! {
    /// An ellipsoid with axes along those of space; in the plane, an ellipse.
    Ellipsoid {
        /// Centre [m].
        center: VectorInput<Length>,
        /// Half of its extent along each axis [m].
        semi_axes: VectorInput<Length>,
    }
}

table! {
    /// A superquadric, ((x/a)^m + (y/b)^m)^(n/m) + (z/c)^n = 1; in the plane, a superellipse.
    Superquadric {
        /// Centre [m].
        center: VectorInput<Length>,
        /// Half of its extent along each axis: a, b and c [m].
        semi_axes: VectorInput<Length>,
        /// m, from 2 (an ellipsoid) to 20 (nearly a box).
        exponent: QuantityInput<Ratio>,
        /// n, from 2 to 20; three dimensions only. By default as exponent.
        exponent_along_z: Option<QuantityInput<Ratio>>,
    }
}

table! {
    /// A cylinder with half a ball on each end; in the plane, a rectangle with half a disk on each end.
    Capsule {
        /// Centre of the half ball at one end [m].
        start: VectorInput<Length>,
        /// Centre of the half ball at the other end [m].
        end: VectorInput<Length>,
        /// Radius [m].
        radius: QuantityInput<Length>,
    }
}

table! {
    /// A torus: a round tube around an axis; three dimensions only.
    Torus {
        /// Centre [m].
        center: VectorInput<Length>,
        /// The axis, of any length.
        axis: VectorInput<Ratio>,
        /// Radius of the circle in the middle of the tube [m].
        radius: QuantityInput<Length>,
        /// Radius of the tube [m], below the other.
        tube_radius: QuantityInput<Length>,
    }
}

table! {
    /// A cone, whole or truncated; three dimensions only.
    Cone {
        /// Centre of one end [m].
        start: VectorInput<Length>,
        /// Centre of the other end [m].
        end: VectorInput<Length>,
        /// Radius at the start [m].
        start_radius: QuantityInput<Length>,
        /// Radius at the end [m]. By default 0, a tip.
        end_radius: Option<QuantityInput<Length>>,
    }
}

table! {
    /// A box with rounded edges and corners; in the plane, a rectangle with rounded corners.
    RoundedBox {
        /// Lower corner, as if it were sharp [m].
        min: VectorInput<Length>,
        /// Upper corner, as if it were sharp [m].
        max: VectorInput<Length>,
        /// Radius of edges and corners [m], at most half of the shortest side.
        rounding: QuantityInput<Length>,
    }
}

table! {
    /// A disk with a hole in its middle; in three dimensions a cylinder with a bore.
    Ring {
        /// Centre [m].
        center: VectorInput<Length>,
        /// Radius of the hole [m].
        inner_radius: QuantityInput<Length>,
        /// Radius of the rim [m].
        outer_radius: QuantityInput<Length>,
        /// The axis of the hole, of any length; three dimensions only.
        axis: Option<VectorInput<Ratio>>,
        /// Extent along the axis [m]; three dimensions only.
        width: Option<QuantityInput<Length>>,
    }
}

impl Ellipsoid {
    /// The shape in SI units.
    pub fn resolve(&self, context: &Context) -> Result<Shape, Fault> {
        let shape = Shape::ellipsoid(self.center.value(context)?, self.semi_axes.value(context)?);
        sound(shape, self.center.node(), context)
    }
}

impl Superquadric {
    /// The shape in SI units.
    pub fn resolve(&self, context: &Context) -> Result<Shape, Fault> {
        let range = |value: f64| (2.0..=MOST_EXPONENT).contains(&value);
        let checked =
            |exponent: &QuantityInput<Ratio>| exponent.checked(context, "a number from 2 to 20", range);
        if let (Some(along), true) = (&self.exponent_along_z, context.dimension.is_plane()) {
            return Err(along.node().fault("no exponent along z, as the scene is plane"));
        }
        let across = checked(&self.exponent)?;
        let along = self.exponent_along_z.as_ref().map_or(Ok(across), checked)?;
        let shape =
            Shape::superquadric(self.center.value(context)?, self.semi_axes.value(context)?, [across, along]);
        sound(shape, self.center.node(), context)
    }
}

impl Capsule {
    /// The shape in SI units.
    pub fn resolve(&self, context: &Context) -> Result<Shape, Fault> {
        let (start, end) = (self.start.value(context)?, self.end.value(context)?);
        Ok(Shape::capsule(start, end, self.radius.positive(context)?))
    }
}

impl Torus {
    /// The shape in SI units.
    pub fn resolve(&self, context: &Context) -> Result<Shape, Fault> {
        space_only(self.center.node(), "a torus", context)?;
        let radii = [self.radius.positive(context)?, self.tube_radius.positive(context)?];
        let shape = Shape::torus(self.center.value(context)?, self.axis.value(context)?, radii);
        sound(shape, self.center.node(), context)
    }
}

impl Cone {
    /// The shape in SI units.
    pub fn resolve(&self, context: &Context) -> Result<Shape, Fault> {
        space_only(self.start.node(), "a cone", context)?;
        let (start, end) = (self.start.value(context)?, self.end.value(context)?);
        if start == end {
            return Err(self.end.node().fault("another point than start"));
        }
        let not_negative = |radius: &QuantityInput<Length>| {
            radius.checked(context, "a length [m] from 0 on", |radius| radius >= 0.0)
        };
        let radii =
            [not_negative(&self.start_radius)?, self.end_radius.as_ref().map_or(Ok(0.0), not_negative)?];
        if radii == [0.0; 2] {
            return Err(self.start_radius.refused(0.0, "a length [m] above 0 at one end at least"));
        }
        Ok(Shape::cone(start, end, radii))
    }
}

impl RoundedBox {
    /// The shape in SI units.
    pub fn resolve(&self, context: &Context) -> Result<Shape, Fault> {
        let corners = super::space::corners(&self.min, &self.max, context)?;
        let shape = Shape::rounded_box(corners, self.rounding.positive(context)?);
        sound(shape, self.min.node(), context)
    }
}

impl Ring {
    /// The shape in SI units.
    pub fn resolve(&self, context: &Context) -> Result<Shape, Fault> {
        let center = self.center.value(context)?;
        let inner = self.inner_radius.positive(context)?;
        let allowed = format!("more than the inner radius, {inner} m");
        let outer = self.outer_radius.checked(context, &allowed, |outer| outer > inner)?;
        match (&self.axis, &self.width, context.dimension) {
            (None, None, plane) if plane.is_plane() => {
                Ok(Shape::ring([center[0], center[1]], [inner, outer]))
            }
            (Some(axis), Some(width), Dimension::Space) => {
                let axis = super::shape::direction(axis, context)?;
                Ok(Shape::tube(center, axis, ([inner, outer], width.positive(context)?)))
            }
            (Some(axis), _, plane) if plane.is_plane() => {
                Err(axis.node().fault("no axis, as the scene is plane"))
            }
            (_, Some(width), plane) if plane.is_plane() => {
                Err(width.node().fault("no width, as the scene is plane"))
            }
            (axis, _, _) => {
                let (key, allowed) = match axis {
                    None => ("axis", "the axis of the hole: [0, 0, 1]"),
                    Some(_) => ("width", "the extent along the axis, like \"1 m\""),
                };
                Err(Fault::new(&beside(self.center.node(), key), "nothing, the key is missing", allowed))
            }
        }
    }
}

/// The path of another key of the table that `node` is in.
pub(super) fn beside(node: &DocumentNode, key: &str) -> String {
    joined(node.key().rsplit_once('.').map_or("", |(table, _)| table), key)
}

/// Refuses what has no meaning in the plane.
pub(super) fn space_only(node: &DocumentNode, what: &str, context: &Context) -> Result<(), Fault> {
    let plane = context.dimension.is_plane();
    let allowed = format!("shapes other than {what}, as the scene is plane");
    if plane { Err(node.fault(allowed)) } else { Ok(()) }
}

/// The shape, if there is such a one; `node` is of a key of its table.
fn sound(shape: Shape, node: &DocumentNode, context: &Context) -> Result<Shape, Fault> {
    let fault = match &shape {
        Shape::Curved(curved) => curved.fault(context.dimension.axes()),
        _ => None,
    };
    fault.map_or(Ok(shape), |(key, found, allowed)| Err(Fault::new(&beside(node, key), found, allowed)))
}
