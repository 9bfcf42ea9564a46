//! Outlines: `shape.spline = { points = [[0, 0], [2, 0], [1, 1]] }`, extruded along z or revolved around an axis.

use super::Context;
use super::quantity::{Length, Ratio};
use super::read::{Read, table};
use super::shape::direction;
use super::solid::{beside, space_only};
use super::vector::VectorInput;
use crate::geometry::{Shape, spline};
use crate::scene::Dimension;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use schemars::JsonSchema;

table! {
    /// A polygon in the plane of x and y; in three dimensions a prism over it.
    Polygon {
        /// Corners in order, [[0, 0], [1, 0], [0, 1]] [m]; the last joins the first.
        points: CornersInput,
        /// Lower and upper z of the prism, [0, "1 m"]; three dimensions only.
        height: Option<VectorInput<Length>>,
    }
}

table! {
    /// What a smooth closed curve through points holds, in the plane of x and y; in three dimensions a prism over it.
    Spline {
        /// Points in order, [[0, 0], [1, 0], [0, 1]] [m]; from the last the curve leads to the first.
        points: CornersInput,
        /// Lower and upper z of the prism, [0, "1 m"]; three dimensions only.
        height: Option<VectorInput<Length>>,
    }
}

table! {
    /// What an outline sweeps that is turned around an axis; three dimensions only.
    Revolved {
        /// Corners of a polygon in order, each its distance from the axis and its place along it from the centre [m];
        /// or else spline.
        polygon: Option<CornersInput>,
        /// Points of a smooth curve, each as a corner of polygon. If the first and the last are on the axis, it leads
        /// from one to the other and is smooth there, too; else it is closed.
        spline: Option<CornersInput>,
        /// The point on the axis from which places along it count [m].
        center: VectorInput<Length>,
        /// The axis, of any length.
        axis: VectorInput<Ratio>,
    }
}

/// Corners of a polygon, with the place of their list.
#[derive(JsonSchema)]
#[schemars(transparent)]
#[schemars(rename = "Corners")]
pub struct CornersInput(Vec<VectorInput<Length>>, #[schemars(skip)] DocumentNode);

impl Polygon {
    /// The shape in SI units.
    pub fn resolve(&self, context: &Context) -> Result<Shape, Fault> {
        let points = self.points.value(context)?;
        Ok(Shape::Polygon { points: points.into(), height: height(&self.height, &self.points.1, context)? })
    }
}

impl Spline {
    /// The shape in SI units.
    pub fn resolve(&self, context: &Context) -> Result<Shape, Fault> {
        let points = self.points.apart(context)?;
        let height = height(&self.height, &self.points.1, context)?;
        Ok(Shape::Polygon { points: spline::closed(&points).into(), height })
    }
}

impl Revolved {
    /// The shape in SI units.
    pub fn resolve(&self, context: &Context) -> Result<Shape, Fault> {
        space_only(self.center.node(), "one that is revolved", context)?;
        let allowed = "one of polygon and spline";
        let (outline, corners) = match (&self.polygon, &self.spline) {
            (Some(corners), None) => (corners.value(context)?, corners),
            (None, Some(corners)) => (corners.apart(context)?, corners),
            (Some(_), Some(corners)) => {
                let node = &corners.1;
                return Err(
                    Fault::new(&node.key(), "`spline` beside `polygon`", allowed).at(node.name_span())
                );
            }
            (None, None) => {
                let key = beside(self.center.node(), "polygon");
                return Err(Fault::new(&key, "neither `polygon` nor `spline`", allowed));
            }
        };
        if let Some(i) = outline.iter().position(|point| point[0] < 0.0) {
            return Err(corners.0[i]
                .part(0)
                .refused(outline[i][0], "a distance from the axis [m] from 0 on"));
        }
        let ends_on_axis = outline[0][0] == 0.0 && outline[outline.len() - 1][0] == 0.0;
        let points = match self.spline {
            None => outline,
            Some(_) if ends_on_axis => spline::from_axis_to_axis(&outline),
            Some(_) => spline::closed(&outline),
        };
        if let Some([rho, z]) = points.iter().find(|point| point[0] < 0.0) {
            let found = format!("a curve beyond the axis, {:.4} m at {z:.4} m along it", -rho);
            let help =
                "more points near the axis; a curve from the axis to the axis begins and ends with one on it";
            return Err(Fault::new(&corners.1.key(), found, "a curve on one side of the axis")
                .at(corners.1.span())
                .help(Some(help.to_string())));
        }
        let shape = Shape::revolved(points, self.center.value(context)?, direction(&self.axis, context)?);
        match shape.volume(3).is_some_and(|volume| volume > 0.0) {
            true => Ok(shape),
            false => Err(corners.1.fault("corners round an area")),
        }
    }
}

impl CornersInput {
    fn value(&self, context: &Context) -> Result<Vec<[f64; 2]>, Fault> {
        let points = self.0.iter().map(|point| point.pair(context)).collect::<Result<Vec<_>, _>>()?;
        if points.len() < 3 { Err(self.1.fault("at least 3 corners")) } else { Ok(points) }
    }

    /// The points of a curve, of which no two in a row are one.
    fn apart(&self, context: &Context) -> Result<Vec<[f64; 2]>, Fault> {
        let points = self.value(context)?;
        let count = points.len();
        match (0..count).find(|&i| points[i] == points[(i + 1) % count]) {
            Some(i) => Err(self.0[(i + 1) % count].node().fault("another point than the one before it")),
            None => Ok(points),
        }
    }
}

fn height(
    height: &Option<VectorInput<Length>>,
    points: &DocumentNode,
    context: &Context,
) -> Result<[f64; 2], Fault> {
    match (height, context.dimension) {
        (None, plane) if plane.is_plane() => Ok([0.0, 0.0]),
        (Some(height), Dimension::Space) => {
            let [lower, upper] = height.pair(context)?;
            if lower >= upper {
                return Err(height.part(1).refused(upper, format!("more than the lower end, {lower} m")));
            }
            Ok([lower, upper])
        }
        (Some(height), _) => Err(height.node().fault("no height, as the scene is plane")),
        (None, _) => {
            let key = beside(points, "height");
            Err(Fault::new(&key, "nothing, the key is missing", "lower and upper z: [0, \"1 m\"]"))
        }
    }
}

impl Read for CornersInput {
    fn wanted() -> String {
        "a list of corners: [[0, 0], [1, 0], [0, 1]]".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::List(_) => Ok(CornersInput(Vec::read(node)?, node.clone())),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}
