//! Shapes: which points are inside, how far away they are, and how a shape is filled with particles.
//!
//! `dimension` is 2 or 3 throughout: in the plane only the first two coordinates count, a ball is a disk and a box is a
//! rectangle. Sine and cosine come from `libm`, so that every build fills a turned shape with the same particles.

mod bounds;
mod building;
mod curved;
mod distance;
mod filling;
mod fitted;
pub mod form;
mod from_file;
mod image;
mod inside;
mod mesh;
mod mirrored_shape;
mod moments;
mod outline;
mod polygon;
mod revolved;
mod rings;
mod rotation;
mod round;
mod shells;
pub mod spline;
mod surface;
mod volume;
mod zero_level;

pub use bounds::Bounds;
pub use curved::{Capsule, Curved, Ellipsoid, MOST_EXPONENT, RoundedBox, Superquadric, Torus};
pub use distance::SignedDistance;
pub use filling::{Arrangement, Filling, ParticleSite, SiteLattice, fill, sites};
pub use fitted::{FITTED_SHAPES, fits};
pub use image::{
    CloudPoints, ImagePart, NoCloud, Pixels, PointCloud, Solids, Spread, image_parts, mean_spacing,
    point_clouds,
};
pub use mesh::{Mesh, MeshFault};
pub use mirrored_shape::{Mirror, MirroredShape};
pub use moments::ShapeMoments;
pub use outline::Outline;
pub use revolved::Revolved;
pub use rotation::Rotation;
pub use round::RoundPart;
pub use surface::SurfacePoint;

use serde::Serialize;

/// A region of space. In the plane, the first two coordinates count.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// A ball; in the plane, a disk.
    Ball {
        /// Centre [m].
        center: [f64; 3],
        /// Radius [m].
        radius: f64,
    },
    /// A box with faces across the axes; in the plane, a rectangle.
    Box {
        /// Lower corner [m].
        min: [f64; 3],
        /// Upper corner [m].
        max: [f64; 3],
    },
    /// A solid cylinder between the centres of its two ends; three dimensions only.
    Cylinder {
        /// Centre of one end [m].
        start: [f64; 3],
        /// Centre of the other end [m].
        end: [f64; 3],
        /// Radius [m].
        radius: f64,
    },
    /// All points behind a plane; unbounded: it cuts other shapes, or is a rigid body.
    HalfSpace {
        /// A point on the plane [m].
        point: [f64; 3],
        /// Outward normal, any length [-].
        normal: [f64; 3],
    },
    /// A polygon in the plane of x and y; in three dimensions a prism over it.
    Polygon {
        /// Corners in order [m]; the last joins the first.
        points: Outline,
        /// Lower and upper z of the prism [m]; not used in the plane.
        height: [f64; 2],
    },
    /// What a closed surface of triangles holds; three dimensions only.
    Mesh(Mesh),
    /// What a closed polygon in a half-plane sweeps as that turns around its edge; three dimensions only.
    Revolved(Revolved),
    /// Points in any of the shapes.
    Union(Vec<Shape>),
    /// Points in all of the shapes.
    Intersection(Vec<Shape>),
    /// Points in the first shape and in none of the others.
    Difference(Vec<Shape>),
    /// The shape turned about a point.
    Rotated {
        /// The shape before it is turned.
        shape: Box<Shape>,
        /// A fixed point [m].
        center: [f64; 3],
        /// Axis of the turn, any length; in the plane (0, 0, 1) [-].
        axis: [f64; 3],
        /// Angle, right-handed about the axis [rad].
        angle: f64,
    },
    /// A shape with a curved surface.
    #[serde(untagged)]
    Curved(Curved),
}
