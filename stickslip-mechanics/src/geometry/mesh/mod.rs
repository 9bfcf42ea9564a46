//! Closed surfaces of triangles: how far away they are, and what is inside.
//!
//! The sign of the distance comes from the angle-weighted normal of the nearest face, edge or corner (Baerentzen and
//! Aanaes 2005, IEEE Trans. Vis. Comput. Graph. 11, 243-253); what is inside, from how often a line of sight leaves the
//! surface more than it enters it.

mod fault;
mod section;
mod tree;
mod triangle;

pub use fault::MeshFault;

use super::from_file::FromFile;
use super::rotation::Rotation;
use super::{Bounds, Mirror, SignedDistance};
use crate::tensor::{Vector, cross};
use serde::{Serialize, Serializer};
use std::collections::HashMap;
use std::sync::Arc;
use tree::Tree;
use triangle::Feature;
pub(super) use triangle::closest;

/// A closed surface of triangles, whose corners go round counterclockwise where they are seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh(Arc<MeshParts>);

#[derive(Debug, PartialEq)]
struct MeshParts {
    /// Where it came from, for records.
    name: String,
    /// [m]
    corners: Vec<[f64; 3]>,
    triangles: Vec<Triangle>,
    /// Sums of the unit normals around each corner, weighted by the triangles' angles there.
    corner_normals: Vec<[f64; 3]>,
    bounds: Bounds,
    tree: Tree,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Triangle {
    corners: [u32; 3],
    /// Unit normal.
    normal: [f64; 3],
    /// Sums of the unit normals on both sides of the edge from each corner to the next.
    edge_normals: [[f64; 3]; 3],
}

/// Nearer to an edge or a corner than this share of the mesh's size, the normal there is the direction out.
const NEAR: f64 = 1e-7;

/// Triangles as far from a mirror as this share of the mesh's size lie on it: files have seven digits.
const ON_MIRROR: f64 = 1e-6;

impl Mesh {
    /// The mesh of triangles, each given by its corners [m]. Corners in exactly one place are one corner;
    /// a triangle with two of them is left out.
    ///
    /// # Errors
    /// No triangle; triangles without area; edges that have not one triangle on either side,
    /// facing the same way; triangles that face inward.
    pub fn new(name: &str, triangles: impl IntoIterator<Item = [[f64; 3]; 3]>) -> Result<Self, MeshFault> {
        let (corners, triangles) = welded(triangles);
        if triangles.is_empty() {
            return Err(MeshFault::Empty);
        }
        let bounds = Bounds::around(corners.iter().copied());
        let size = Vector(bounds.size()).norm();
        let place = |corner: u32| Vector(corners[corner as usize]);
        let across = |&[a, b, c]: &[u32; 3]| Vector(cross((place(b) - place(a)).0, (place(c) - place(a)).0));
        let flat = |triangle: &&[u32; 3]| across(triangle).norm() <= f64::EPSILON * size * size;
        if let Some(&[a, b, c]) = triangles.iter().find(flat) {
            let near = ((place(a) + place(b) + place(c)) / 3.0).0;
            return Err(MeshFault::Flat { count: triangles.iter().filter(flat).count(), near });
        }
        let normals: Vec<_> =
            triangles.iter().map(|triangle| across(triangle) / across(triangle).norm()).collect();
        let sides = sides(&triangles, |edge| ((place(edge[0]) + place(edge[1])) * 0.5).0)?;
        let mut corner_normals = vec![Vector::ZERO; corners.len()];
        for (triangle, normal) in triangles.iter().zip(&normals) {
            for i in 0..3 {
                let [here, next, last] = [0, 1, 2].map(|step| place(triangle[(i + step) % 3]));
                let (ahead, back) = (next - here, last - here);
                let angle = libm::acos((ahead.dot(back) / (ahead.norm() * back.norm())).clamp(-1.0, 1.0));
                corner_normals[triangle[i] as usize] += *normal * angle;
            }
        }
        let full = triangles.iter().zip(&normals).map(|(triangle, normal)| {
            let opposite = edges(triangle).map(|[from, to]| normals[sides[&[to, from]]]);
            Triangle {
                corners: *triangle,
                normal: normal.0,
                edge_normals: opposite.map(|other| (other + *normal).0),
            }
        });
        let around =
            |triangle: &[u32; 3]| Bounds::around(triangle.iter().map(|&corner| corners[corner as usize]));
        let boxes: Vec<_> = triangles.iter().map(around).collect();
        let parts = MeshParts {
            name: name.to_string(),
            triangles: full.collect(),
            corner_normals: corner_normals.into_iter().map(|normal| normal.0).collect(),
            bounds,
            tree: Tree::new(&boxes),
            corners,
        };
        let mesh = Mesh(Arc::new(parts));
        let volume = mesh.volume();
        if volume > 0.0 { Ok(mesh) } else { Err(MeshFault::InsideOut { volume }) }
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.0.triangles.len()
    }

    /// The corners of each triangle [m].
    pub fn triangle_corners(&self) -> impl Iterator<Item = [[f64; 3]; 3]> {
        self.0.triangles.iter().map(|triangle| self.corners(triangle))
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Bounds {
        self.0.bounds
    }

    /// Volume inside [m^3]: the sum of a . (b x c) / 6 over the triangles, by the divergence theorem.
    pub fn volume(&self) -> f64 {
        // From a corner, so that a small mesh far from the origin keeps its digits.
        let origin = Vector(self.0.corners[0]);
        let of = |triangle: &Triangle| {
            let [a, b, c] = self.corners(triangle).map(|corner| Vector(corner) - origin);
            a.dot(Vector(cross(b.0, c.0))) / 6.0
        };
        self.0.triangles.iter().map(of).sum()
    }

    /// Whether a point [m] is inside: along x, more faces let the line of sight out than in.
    pub fn contains(&self, point: [f64; 3]) -> bool {
        let mut left = 0;
        self.0.tree.along_x(point, |number| {
            let triangle = &self.0.triangles[number];
            // Which side of each edge's image in the plane of y and z the point is on. Edges are walked one way by both
            // of their triangles, so that no ray slips through between the two or meets both.
            let side = edges(&triangle.corners).map(|[from, to]| {
                let [low, high] = if from < to { [from, to] } else { [to, from] };
                let [a, b] = [low, high].map(|corner| self.0.corners[corner as usize]);
                let turn = (b[1] - a[1]) * (point[2] - a[2]) - (b[2] - a[2]) * (point[1] - a[1]);
                // On the edge the point counts as moved a hair along y, and by less along z.
                let tie = if b[2] == a[2] { b[1] - a[1] } else { a[2] - b[2] };
                ((if turn == 0.0 { tie } else { turn }) > 0.0) == (from < to)
            });
            let [nx, ny, nz] = triangle.normal;
            if side == [nx > 0.0; 3] && nx != 0.0 {
                let a = self.0.corners[triangle.corners[0] as usize];
                let above = nx * (point[0] - a[0]) + ny * (point[1] - a[1]) + nz * (point[2] - a[2]);
                // The face is met ahead.
                if (above < 0.0) == (nx > 0.0) && above != 0.0 {
                    left += if nx > 0.0 { 1 } else { -1 };
                }
            }
        });
        left > 0
    }

    /// Signed distance and its gradient.
    pub(super) fn level(&self, point: [f64; 3]) -> SignedDistance {
        let (mut squared, mut found) = (f64::INFINITY, (0, [0.0; 3], Feature::Face));
        self.0.tree.nearest(point, |number| {
            let (nearest, feature) = closest(self.corners(&self.0.triangles[number]), point);
            let away = Vector(point) - Vector(nearest);
            let here = away.dot(away);
            if here < squared {
                (squared, found) = (here, (number, nearest, feature));
            }
            here
        });
        let (number, nearest, feature) = found;
        let triangle = &self.0.triangles[number];
        let away = Vector(point) - Vector(nearest);
        let normal = match feature {
            Feature::Face => {
                let distance = away.dot(Vector(triangle.normal));
                return SignedDistance { distance, gradient: triangle.normal };
            }
            Feature::Edge(i) => triangle.edge_normals[i],
            Feature::Corner(i) => self.0.corner_normals[triangle.corners[i] as usize],
        };
        let (normal, length) = (Vector(normal), squared.sqrt());
        let sign = if away.dot(normal) < 0.0 { -1.0 } else { 1.0 };
        let out = if length > NEAR * Vector(self.0.bounds.size()).norm() {
            away * (sign / length)
        } else {
            normal.direction().unwrap_or(Vector(triangle.normal))
        };
        SignedDistance { distance: sign * length, gradient: out.0 }
    }

    /// The mesh after a turn.
    pub(super) fn turned(&self, rotation: &Rotation) -> Mesh {
        self.moved(|corner| rotation.forward(corner)).expect("a turn leaves a closed surface closed")
    }

    /// The mesh after a change of size and place that `point` makes of each of its corners.
    pub(super) fn copied(&self, point: impl Fn([f64; 3]) -> [f64; 3]) -> Mesh {
        self.moved(point).expect("a copy of a closed surface is closed")
    }

    /// The mesh with its image behind a mirror on which some of its triangles lie: those are no surface.
    /// `None` where none does.
    pub(super) fn continued(&self, mirror: &Mirror) -> Option<Mesh> {
        let near = ON_MIRROR * Vector(self.0.bounds.size()).norm();
        let on = |x: [f64; 3]| (x[mirror.axis] - mirror.position).abs() <= near;
        let kept: Vec<_> = (self.0.triangles.iter())
            .map(|triangle| self.corners(triangle))
            .filter(|corners| !corners.iter().all(|&corner| on(corner)))
            .collect();
        if kept.len() == self.triangles() {
            return None;
        }
        let snapped = |mut x: [f64; 3]| {
            if on(x) {
                x[mirror.axis] = mirror.position;
            }
            x
        };
        let image = |mut x: [f64; 3]| {
            x[mirror.axis] = 2.0 * mirror.position - x[mirror.axis];
            x
        };
        let near = kept.iter().map(|corners| corners.map(snapped));
        let far = kept.iter().map(|&[a, b, c]| [a, c, b].map(snapped).map(image));
        Mesh::new(&self.0.name, near.chain(far)).ok()
    }

    fn moved(&self, f: impl Fn([f64; 3]) -> [f64; 3]) -> Result<Mesh, MeshFault> {
        Mesh::new(&self.0.name, self.0.triangles.iter().map(|triangle| self.corners(triangle).map(&f)))
    }

    fn corners(&self, triangle: &Triangle) -> [[f64; 3]; 3] {
        triangle.corners.map(|corner| self.0.corners[corner as usize])
    }
}

impl Serialize for Mesh {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let MeshParts { name, corners, triangles, .. } = &*self.0;
        let ends = triangles.iter().flat_map(|triangle| triangle.corners).map(f64::from);
        FromFile::new(name, corners.iter().flatten().copied().chain(ends)).serialize(serializer)
    }
}

/// The edges of a triangle, from each corner to the next.
fn edges(&[a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Corners without doubles, and the triangles between them that have three.
fn welded(triangles: impl IntoIterator<Item = [[f64; 3]; 3]>) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut corners = Vec::new();
    let mut numbers = HashMap::new();
    let mut number = |corner: [f64; 3]| {
        // The two zeros are one place.
        let corner = corner.map(|x| x + 0.0);
        *numbers.entry(corner.map(f64::to_bits)).or_insert_with(|| {
            corners.push(corner);
            corners.len() as u32 - 1
        })
    };
    let triangles = triangles.into_iter().map(|corners| corners.map(&mut number));
    let triangles = triangles.filter(|&[a, b, c]| a != b && b != c && c != a).collect();
    (corners, triangles)
}

/// The triangle to the left of each edge, seen from outside.
fn sides(
    triangles: &[[u32; 3]],
    middle: impl Fn([u32; 2]) -> [f64; 3],
) -> Result<HashMap<[u32; 2], usize>, MeshFault> {
    let mut sides = HashMap::new();
    let (mut crossed, mut open) = (Vec::new(), Vec::new());
    for (i, triangle) in triangles.iter().enumerate() {
        crossed.extend(edges(triangle).into_iter().filter(|&edge| sides.insert(edge, i).is_some()));
    }
    for triangle in triangles {
        open.extend(edges(triangle).into_iter().filter(|&[from, to]| !sides.contains_key(&[to, from])));
    }
    match (crossed.first(), open.first()) {
        // Triangles that face opposite ways also leave an edge without its other side.
        (Some(&first), _) => Err(MeshFault::Crossed { count: crossed.len(), near: middle(first) }),
        (None, Some(&first)) => Err(MeshFault::Open { count: open.len(), near: middle(first) }),
        _ => Ok(sides),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::geometry::Shape;
    use proptest::prelude::*;

    /// The triangles of a box.
    pub fn cube(min: [f64; 3], max: [f64; 3]) -> Vec<[[f64; 3]; 3]> {
        let at = |i: usize| std::array::from_fn(|k| if i >> k & 1 == 1 { max[k] } else { min[k] });
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]].map(|corners| corners.map(at))).collect()
    }

    /// The triangles of a unit ball: an octahedron's, halved along each edge so many times.
    fn ball(halvings: usize) -> Vec<[[f64; 3]; 3]> {
        let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        let minus = |a: [f64; 3]| a.map(|a| -a);
        let mut triangles = Vec::new();
        for [a, b] in [[x, y], [y, minus(x)], [minus(x), minus(y)], [minus(y), x]] {
            triangles.extend([[a, b, z], [b, a, minus(z)]]);
        }
        for _ in 0..halvings {
            let middle = |a: [f64; 3], b: [f64; 3]| {
                let sum = Vector(a) + Vector(b);
                (sum / sum.norm()).0
            };
            let parts = |[a, b, c]: [[f64; 3]; 3]| {
                let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            };
            triangles = triangles.into_iter().flat_map(parts).collect();
        }
        triangles
    }

    fn mesh(triangles: Vec<[[f64; 3]; 3]>) -> Mesh {
        Mesh::new("test", triangles).expect("closed")
    }

    proptest! {
        /// A box of triangles is a box: the same distance, direction and inside.
        #[test]
        fn a_meshed_box_is_a_box(
            point in prop::array::uniform3(-2.0..2.0f64),
            size in prop::array::uniform3(0.2..1.5f64),
        ) {
            let max = size.map(|s| s - 0.7);
            let (exact, meshed) = (Shape::Box { min: [-0.7; 3], max }, mesh(cube([-0.7; 3], max)));
            let (a, b) = (exact.level(point, 3), meshed.level(point));
            prop_assert!((a.distance - b.distance).abs() < 1e-14, "{a:?} {b:?}");
            prop_assert_eq!(meshed.contains(point), exact.contains(point, 3));
            // Two faces may be equally near inside.
            if a.distance > 1e-6 {
                prop_assert!((Vector(a.gradient) - Vector(b.gradient)).norm() < 1e-9, "{a:?} {b:?}");
            }
        }

        /// The tree finds what looking at all triangles finds, and both ways to tell inside agree.
        #[test]
        fn the_nearest_triangle_is_nearest(point in prop::array::uniform3(-1.5..1.5f64)) {
            let ball = mesh(ball(2));
            let level = ball.level(point);
            let of = |triangle: &Triangle| {
                (Vector(closest(ball.corners(triangle), point).0) - Vector(point)).norm()
            };
            let nearest = ball.0.triangles.iter().map(of).fold(f64::INFINITY, f64::min);
            prop_assert!((level.distance.abs() - nearest).abs() < 1e-14);
            prop_assert_eq!(level.distance < 0.0, ball.contains(point));
        }
    }

    #[test]
    fn rays_through_edges_and_corners_meet_the_surface_once() {
        let ball = mesh(ball(2));
        for triangle in &ball.0.triangles {
            for corner in ball.corners(triangle) {
                assert!(
                    ball.contains(corner.map(|x| 0.9 * x)) && !ball.contains(corner.map(|x| 1.1 * x)),
                    "{corner:?}"
                );
            }
        }
        assert!(ball.contains([0.0; 3]) && !ball.contains([-2.0, 0.0, 0.0]));
    }

    /// A corner's normals must not let a point outside look inside: a thin spike.
    #[test]
    fn a_spike_has_an_outside_all_round_its_tip() {
        let tip = [0.0, 0.0, 5.0];
        let base = [[0.0; 3], [0.2, 0.0, 0.0], [0.1, 0.2, 0.0]];
        let [a, b, c] = base;
        let spike = mesh(vec![[a, c, b], [a, b, tip], [b, c, tip], [c, a, tip]]);
        for i in 0..100 {
            let angle = f64::from(i) * 0.628;
            let point = [0.03 * angle.cos(), 0.03 * angle.sin(), 5.0 + 0.001 * f64::from(i)];
            assert_eq!(spike.level(point).distance < 0.0, spike.contains(point), "{point:?}");
        }
    }

    /// The volume of an inscribed polyhedron falls short by the square of its edges.
    #[test]
    fn the_volume_of_a_meshed_ball_converges() {
        let exact = 4.0 / 3.0 * std::f64::consts::PI;
        let short: Vec<f64> = (2..5).map(|halvings| 1.0 - mesh(ball(halvings)).volume() / exact).collect();
        assert!(
            short[2] < 0.01 && short.windows(2).all(|pair| (pair[0] / pair[1] - 4.0).abs() < 0.3),
            "{short:?}"
        );
    }

    #[test]
    fn what_is_no_closed_surface_is_told() {
        let whole = || cube([0.0; 3], [1.0; 3]);
        assert_eq!(Mesh::new("", []), Err(MeshFault::Empty));
        let mut open = whole();
        open.pop();
        assert!(matches!(Mesh::new("", open), Err(MeshFault::Open { count: 3, .. })));
        let mut turned = whole();
        turned[3].swap(0, 1);
        assert!(matches!(Mesh::new("", turned), Err(MeshFault::Crossed { count: 3, .. })));
        let inside_out = whole().into_iter().map(|[a, b, c]| [a, c, b]);
        assert!(matches!(Mesh::new("", inside_out), Err(MeshFault::InsideOut { volume }) if volume < -0.99));
        let mut flat = whole();
        let [a, b, _] = flat[0];
        flat.push([a, b, std::array::from_fn(|k| 0.5 * (a[k] + b[k]))]);
        assert!(matches!(Mesh::new("", flat), Err(MeshFault::Flat { count: 1, .. })));
    }

    /// Half a ball on a mirror is a whole one.
    #[test]
    fn triangles_on_a_mirror_are_no_surface() {
        let mirror = Mirror { axis: 1, position: 0.0, inward: 1.0 };
        let half = mesh(cube([-1.0, 0.0, -1.0], [1.0, 0.5, 1.0])).continued(&mirror).expect("two lie on it");
        assert!((half.volume() - 4.0).abs() < 1e-12);
        let level = half.level([0.0, 0.1, 0.0]);
        assert!((level.distance + 0.4).abs() < 1e-12 && level.gradient == [0.0, 1.0, 0.0], "{level:?}");
        let aside = Mirror { position: -3.0, ..mirror };
        assert_eq!(half.continued(&aside), None);
    }
}
