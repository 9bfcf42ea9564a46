//! Shapes: `shape.ball = { center = [0, 0, 1], radius = 1 }`.

use super::Context;
use super::mesh::Mesh;
use super::outline::{Polygon, Revolved, Spline};
use super::quantity::{Angle, Length, QuantityInput, Ratio};
use super::read::{Read, table};
use super::solid::{Capsule, Cone, Ellipsoid, Ring, RoundedBox, Superquadric, Torus};
use super::space::corners;
use super::text::Text;
use super::vector::VectorInput;
use crate::geometry;
use crate::scene::Dimension;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::suggestion::did_you_mean;
use schemars::JsonSchema;

/// A region of space: one of the shapes.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[schemars(rename = "Shape")]
pub enum ShapeInput {
    /// A ball; in the plane, a disk.
    Ball(Ball),
    /// A box with faces across the axes; in the plane, a rectangle.
    Box(Cuboid),
    /// A solid cylinder; three dimensions only.
    Cylinder(Cylinder),
    /// A cone, whole or truncated; three dimensions only.
    Cone(Cone),
    /// A disk with a hole in its middle; in three dimensions a cylinder with a bore.
    Ring(Ring),
    /// A cylinder with half a ball on each end; in the plane, a rectangle with half a disk on each end.
    Capsule(Capsule),
    /// A box with rounded edges and corners; in the plane, a rectangle with rounded corners.
    RoundedBox(RoundedBox),
    /// An ellipsoid with axes along those of space; in the plane, an ellipse.
    Ellipsoid(Ellipsoid),
    /// A superquadric, between ellipsoid, cylinder and box; in the plane, a superellipse.
    Superquadric(Superquadric),
    /// A torus: a round tube around an axis; three dimensions only.
    Torus(Torus),
    /// All points behind a plane; unbounded: it cuts other shapes, or is a rigid body.
    HalfSpace(HalfSpace),
    /// A polygon in the plane of x and y; in three dimensions a prism over it.
    Polygon(Polygon),
    /// What a smooth closed curve through points holds, in the plane of x and y; in three dimensions a prism over it.
    Spline(Spline),
    /// What a polygon or a curve sweeps that is turned around an axis; three dimensions only.
    Revolved(Revolved),
    /// What a closed surface of triangles holds, read from a file; in the plane a section of it.
    Mesh(Mesh),
    /// Points in any of the shapes.
    Union(Vec<ShapeInput>),
    /// Points in all of the shapes.
    Intersection(Vec<ShapeInput>),
    /// Points in the first shape and in none of the others.
    Difference(Vec<ShapeInput>),
    /// A shape turned about a point.
    Rotated(Rotated),
    /// The name of one of [shapes].
    #[schemars(untagged)]
    Named(Text),
}

/// Keys of the shapes.
const KINDS: &[&str] = &[
    "ball",
    "box",
    "cylinder",
    "cone",
    "ring",
    "capsule",
    "rounded_box",
    "ellipsoid",
    "superquadric",
    "torus",
    "half_space",
    "polygon",
    "spline",
    "revolved",
    "mesh",
    "union",
    "intersection",
    "difference",
    "rotated",
];

table! {
    /// A ball; in the plane, a disk.
    Ball {
        /// Centre [m].
        center: VectorInput<Length>,
        /// Radius [m].
        radius: QuantityInput<Length>,
    }
}

table! {
    /// A box with faces across the axes; in the plane, a rectangle.
    Cuboid {
        /// Lower corner [m].
        min: VectorInput<Length>,
        /// Upper corner [m].
        max: VectorInput<Length>,
    }
}

table! {
    /// A solid cylinder between the centres of its two ends; three dimensions only.
    Cylinder {
        /// Centre of one end [m].
        start: VectorInput<Length>,
        /// Centre of the other end [m].
        end: VectorInput<Length>,
        /// Radius [m].
        radius: QuantityInput<Length>,
    }
}

table! {
    /// All points behind a plane.
    HalfSpace {
        /// A point on the plane [m].
        point: VectorInput<Length>,
        /// Direction out of the half-space, of any length.
        normal: VectorInput<Ratio>,
    }
}

table! {
    /// A shape turned about a point.
    Rotated {
        /// The shape before it is turned.
        shape: Box<ShapeInput>,
        /// The point that stays in place [m].
        center: VectorInput<Length>,
        /// Axis of the turn, of any length; three dimensions only.
        axis: Option<VectorInput<Ratio>>,
        /// Angle, right-handed about the axis, in the plane counterclockwise: "30 deg".
        angle: QuantityInput<Angle>,
    }
}

impl ShapeInput {
    /// The shape in SI units.
    pub fn resolve(&self, context: &Context) -> Result<geometry::Shape, Fault> {
        let all = |shapes: &[ShapeInput]| -> Result<Vec<_>, Fault> {
            shapes.iter().map(|shape| shape.resolve(context)).collect()
        };
        Ok(match self {
            ShapeInput::Ball(ball) => geometry::Shape::Ball {
                center: ball.center.value(context)?,
                radius: ball.radius.positive(context)?,
            },
            ShapeInput::Box(cuboid) => {
                let (min, max) = corners(&cuboid.min, &cuboid.max, context)?;
                geometry::Shape::Box { min, max }
            }
            ShapeInput::Cylinder(cylinder) => cylinder.resolve(context)?,
            ShapeInput::Cone(cone) => cone.resolve(context)?,
            ShapeInput::Ring(ring) => ring.resolve(context)?,
            ShapeInput::Capsule(capsule) => capsule.resolve(context)?,
            ShapeInput::RoundedBox(cuboid) => cuboid.resolve(context)?,
            ShapeInput::Ellipsoid(ellipsoid) => ellipsoid.resolve(context)?,
            ShapeInput::Superquadric(superquadric) => superquadric.resolve(context)?,
            ShapeInput::Torus(torus) => torus.resolve(context)?,
            ShapeInput::HalfSpace(half) => geometry::Shape::HalfSpace {
                point: half.point.value(context)?,
                normal: direction(&half.normal, context)?,
            },
            ShapeInput::Polygon(polygon) => polygon.resolve(context)?,
            ShapeInput::Spline(spline) => spline.resolve(context)?,
            ShapeInput::Revolved(revolved) => revolved.resolve(context)?,
            ShapeInput::Mesh(mesh) => mesh.resolve(context)?,
            ShapeInput::Union(shapes) => geometry::Shape::Union(all(shapes)?),
            ShapeInput::Intersection(shapes) => geometry::Shape::Intersection(all(shapes)?),
            ShapeInput::Difference(shapes) => geometry::Shape::Difference(all(shapes)?),
            ShapeInput::Rotated(rotated) => rotated.resolve(context)?,
            ShapeInput::Named(name) => context.shapes.named(name, context)?,
        })
    }
}

impl Cylinder {
    fn resolve(&self, context: &Context) -> Result<geometry::Shape, Fault> {
        if context.dimension.is_plane() {
            return Err(self.start.node().fault("shapes other than a cylinder, as the scene is plane"));
        }
        let (start, end) = (self.start.value(context)?, self.end.value(context)?);
        if start == end {
            return Err(self.end.node().fault("another point than start"));
        }
        Ok(geometry::Shape::Cylinder { start, end, radius: self.radius.positive(context)? })
    }
}

impl Rotated {
    fn resolve(&self, context: &Context) -> Result<geometry::Shape, Fault> {
        let axis = match (&self.axis, context.dimension) {
            (None, plane) if plane.is_plane() => [0.0, 0.0, 1.0],
            (Some(axis), Dimension::Space) => direction(axis, context)?,
            (Some(axis), _) => {
                return Err(axis.node().fault("no axis, as the scene is plane"));
            }
            (None, _) => {
                let key = self.angle.node().key().replace("angle", "axis");
                return Err(Fault::new(
                    &key,
                    "nothing, the key is missing",
                    "the axis of the turn: [0, 0, 1]",
                ));
            }
        };
        Ok(geometry::Shape::Rotated {
            shape: Box::new(self.shape.resolve(context)?),
            center: self.center.value(context)?,
            axis,
            angle: self.angle.value(context)?,
        })
    }
}

/// A vector that is not zero.
pub(super) fn direction(vector: &VectorInput<Ratio>, context: &Context) -> Result<[f64; 3], Fault> {
    let value = vector.value(context)?;
    if value == [0.0; 3] { Err(vector.node().fault("a direction, not zero")) } else { Ok(value) }
}

impl Read for ShapeInput {
    fn wanted() -> String {
        format!(
            "a shape ({}), like shape.ball = {{ center = [0, 0, 1], radius = 1 }}, or a name from [shapes]",
            KINDS.join(", ")
        )
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        if let Value::Text(_) = node.value {
            return Text::read(node).map(ShapeInput::Named);
        }
        let Value::Table(children) = &node.value else { return Err(node.fault(Self::wanted())) };
        let child = match &children[..] {
            [child] => child,
            [] => return Err(Fault::new(&node.key(), "no shape", Self::wanted())),
            [_, second, ..] => {
                let found = format!("a second shape, `{}`", second.name());
                let help = Some("union = [...] joins shapes".to_string());
                return Err(Fault::new(&second.key(), found, "one shape").help(help).at(second.name_span()));
            }
        };
        Ok(match child.name() {
            "ball" => ShapeInput::Ball(Ball::read(child)?),
            "box" => ShapeInput::Box(Cuboid::read(child)?),
            "cylinder" => ShapeInput::Cylinder(Cylinder::read(child)?),
            "cone" => ShapeInput::Cone(Cone::read(child)?),
            "ring" => ShapeInput::Ring(Ring::read(child)?),
            "capsule" => ShapeInput::Capsule(Capsule::read(child)?),
            "rounded_box" => ShapeInput::RoundedBox(RoundedBox::read(child)?),
            "ellipsoid" => ShapeInput::Ellipsoid(Ellipsoid::read(child)?),
            "superquadric" => ShapeInput::Superquadric(Superquadric::read(child)?),
            "torus" => ShapeInput::Torus(Torus::read(child)?),
            "half_space" => ShapeInput::HalfSpace(HalfSpace::read(child)?),
            "polygon" => ShapeInput::Polygon(Polygon::read(child)?),
            "spline" => ShapeInput::Spline(Spline::read(child)?),
            "revolved" => ShapeInput::Revolved(Revolved::read(child)?),
            "mesh" => ShapeInput::Mesh(Mesh::read(child)?),
            "union" => ShapeInput::Union(several(child, 1)?),
            "intersection" => ShapeInput::Intersection(several(child, 1)?),
            "difference" => ShapeInput::Difference(several(child, 2)?),
            "rotated" => ShapeInput::Rotated(Rotated::read(child)?),
            name => {
                let help = did_you_mean(name, KINDS.iter().copied());
                let fault = Fault::new(&child.key(), format!("unknown shape `{name}`"), KINDS.join(", "));
                return Err(fault.help(help).at(child.name_span()));
            }
        })
    }
}

/// At least so many shapes.
fn several(node: &DocumentNode, least: usize) -> Result<Vec<ShapeInput>, Fault> {
    let shapes = Vec::<ShapeInput>::read(node)?;
    if shapes.len() < least {
        return Err(node.fault(format!("a list of at least {least}")));
    }
    Ok(shapes)
}
