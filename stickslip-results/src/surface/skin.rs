//! A shape as triangles: in space its surface, in the plane its area.

use crate::geometry::{Bounds, Shape};
use rayon::prelude::*;
use std::collections::HashMap;

/// Triangles with corners that they share.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// Corners [m].
    pub corners: Vec<[f64; 3]>,
    /// Three corners each, counterclockwise seen from outside, in the plane from the third axis.
    pub triangles: Vec<[u32; 3]>,
}

/// A shape on more nodes than this is too fine for its triangles to be of use.
const MOST_NODES: f64 = 3e7;
/// Points nearer to the surface than this share of the spacing lie inside: so do faces of a box, which nodes lie on.
const ON: f64 = 1e-6;
/// Steps along the gradient by which a corner is brought onto the surface.
const STEPS: usize = 2;

/// A lattice over a shape, with a layer of nodes around it, and how far each node is from the surface.
struct Levels<'a> {
    shape: &'a Shape,
    dimension: usize,
    low: [f64; 3],
    step: [f64; 3],
    nodes: [usize; 3],
    /// Negative inside, over the spacing.
    levels: Vec<f64>,
}

impl Skin {
    /// The triangles of a shape, with sides of about `spacing` [m]; `None` for a shape without bounds, or with too many
    /// triangles.
    ///
    /// In space by surface nets (Gibson 1998): a corner in each cell of a lattice that the surface crosses, at the mean
    /// of where it crosses the sides of the cell, then brought onto the surface; four of them around each such side. In
    /// the plane the part of each cell that lies inside. Faces of the shape's box lie on nodes, so boxes along the axes
    /// keep their edges; other edges are blunted by less than the spacing.
    pub fn of(shape: &Shape, spacing: f64, dimension: usize, within: Option<Bounds>) -> Option<Skin> {
        let mut bounds = shape.bounds(dimension)?;
        if let Some(within) = within {
            for axis in 0..dimension {
                bounds.min[axis] = bounds.min[axis].max(within.min[axis]);
                bounds.max[axis] = bounds.max[axis].min(within.max[axis]);
            }
        }
        let size = bounds.size();
        if !(0..dimension).all(|axis| size[axis] > 0.0) {
            return None;
        }
        let levels = Levels::of(shape, (bounds, spacing), dimension)?;
        Some(if dimension == 2 { levels.area() } else { levels.surface() })
    }
}

impl<'a> Levels<'a> {
    fn of(shape: &'a Shape, (bounds, spacing): (Bounds, f64), dimension: usize) -> Option<Self> {
        let size = bounds.size();
        let cells =
            [0, 1, 2].map(|axis| if axis < dimension { (size[axis] / spacing).ceil().max(1.0) } else { 0.0 });
        if cells.iter().map(|cells| cells + 3.0).product::<f64>() > MOST_NODES {
            return None;
        }
        let step = [0, 1, 2].map(|axis| if axis < dimension { size[axis] / cells[axis] } else { 1.0 });
        let low = [0, 1, 2].map(|axis| if axis < dimension { bounds.min[axis] - step[axis] } else { 0.0 });
        let nodes = [0, 1, 2].map(|axis| if axis < dimension { cells[axis] as usize + 3 } else { 1 });
        let mut levels = Levels { shape, dimension, low, step, nodes, levels: Vec::new() };
        let count = nodes.iter().product::<usize>();
        let level = |node: usize| {
            let x = levels.place(node);
            // What is cut off by the bounds is as if the shape ended there.
            let outside = (0..dimension).map(|k| (bounds.min[k] - x[k]).max(x[k] - bounds.max[k]));
            outside.fold(shape.distance(x, dimension), f64::max) / spacing - ON
        };
        levels.levels = (0..count).into_par_iter().map(level).collect();
        Some(levels)
    }

    fn indices(&self, node: usize) -> [usize; 3] {
        let [nx, ny, _] = self.nodes;
        [node % nx, node / nx % ny, node / nx / ny]
    }

    fn node(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.nodes[1] + j) * self.nodes[0] + i
    }

    fn place(&self, node: usize) -> [f64; 3] {
        let indices = self.indices(node);
        [0, 1, 2].map(|axis| self.low[axis] + self.step[axis] * indices[axis] as f64)
    }

    fn is_inside(&self, node: usize) -> bool {
        self.levels[node] < 0.0
    }

    /// Where the surface crosses the line between two nodes.
    fn crossing(&self, a: usize, b: usize) -> [f64; 3] {
        let share = self.levels[a] / (self.levels[a] - self.levels[b]);
        let (x, y) = (self.place(a), self.place(b));
        [0, 1, 2].map(|axis| x[axis] + share * (y[axis] - x[axis]))
    }

    /// A point near the surface, brought onto it.
    fn settled(&self, mut x: [f64; 3]) -> [f64; 3] {
        let near = self.step.iter().take(self.dimension).copied().fold(f64::INFINITY, f64::min);
        for _ in 0..STEPS {
            let level = self.shape.level(x, self.dimension);
            if level.distance.abs() > near {
                break;
            }
            x = [0, 1, 2].map(|axis| x[axis] - level.distance * level.gradient[axis]);
        }
        x
    }

    /// The surface in space.
    fn surface(&self) -> Skin {
        let mut skin = Skin::default();
        let mut corner_of: HashMap<usize, u32> = HashMap::new();
        let mut corner = |cell: [usize; 3], skin: &mut Skin| {
            *corner_of.entry(self.node(cell)).or_insert_with(|| {
                skin.corners.push(self.middle(cell));
                (skin.corners.len() - 1) as u32
            })
        };
        for node in 0..self.levels.len() {
            let at = self.indices(node);
            for axis in 0..3 {
                let mut next = at;
                next[axis] += 1;
                // Around a side at the rim of the lattice there are no four cells, and nothing is inside there.
                let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
                if next[axis] >= self.nodes[axis] || at[u] == 0 || at[v] == 0 {
                    continue;
                }
                let inside = self.is_inside(node);
                if inside == self.is_inside(self.node(next)) {
                    continue;
                }
                let around = [[1, 1], [0, 1], [0, 0], [1, 0]].map(|[du, dv]| {
                    let mut cell = at;
                    cell[u] -= du;
                    cell[v] -= dv;
                    corner(cell, &mut skin)
                });
                let [a, b, c, d] = around;
                let faces = if inside { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
                skin.triangles.extend(faces);
            }
        }
        skin
    }

    /// The corner in a cell: the mean of where the surface crosses its sides, brought onto the surface.
    fn middle(&self, cell: [usize; 3]) -> [f64; 3] {
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for corner in 0..8 {
            let offset = |axis: usize| corner >> axis & 1;
            let from = [0, 1, 2].map(|axis| (cell[axis] + offset(axis)).min(self.nodes[axis] - 1));
            for axis in (0..3).filter(|&axis| offset(axis) == 0) {
                let mut to = from;
                to[axis] += 1;
                if to[axis] >= self.nodes[axis] {
                    continue;
                }
                let (a, b) = (self.node(from), self.node(to));
                if self.is_inside(a) != self.is_inside(b) {
                    let x = self.crossing(a, b);
                    sum = [0, 1, 2].map(|k| sum[k] + x[k]);
                    count += 1.0;
                }
            }
        }
        self.settled(sum.map(|sum| sum / count))
    }

    /// The area in the plane.
    fn area(&self) -> Skin {
        let mut skin = Skin::default();
        // Corners by the nodes that they lie on or between.
        let mut corner_of: HashMap<(usize, usize), u32> = HashMap::new();
        let mut corner = |key: (usize, usize), skin: &mut Skin| {
            *corner_of.entry(key).or_insert_with(|| {
                let (a, b) = key;
                skin.corners.push(if a == b { self.place(a) } else { self.settled(self.crossing(a, b)) });
                (skin.corners.len() - 1) as u32
            })
        };
        let [nx, ny, _] = self.nodes;
        for j in 0..ny - 1 {
            for i in 0..nx - 1 {
                let around =
                    [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[i, j]| self.node([i, j, 0]));
                let mut polygon = Vec::with_capacity(8);
                for k in 0..4 {
                    let (a, b) = (around[k], around[(k + 1) % 4]);
                    if self.is_inside(a) {
                        polygon.push(corner((a, a), &mut skin));
                    }
                    if self.is_inside(a) != self.is_inside(b) {
                        polygon.push(corner((a.min(b), a.max(b)), &mut skin));
                    }
                }
                let fan = polygon.windows(2).skip(1).map(|pair| [polygon[0], pair[0], pair[1]]);
                skin.triangles.extend(fan);
            }
        }
        skin
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Area of the triangles, and volume inside them by Gauss's theorem.
    fn measures(skin: &Skin) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for triangle in &skin.triangles {
            let [a, b, c] = triangle.map(|corner| skin.corners[corner as usize]);
            let [u, v] = [b, c].map(|x| [0, 1, 2].map(|k| x[k] - a[k]));
            let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            sums[0] += 0.5 * n.iter().map(|c| c * c).sum::<f64>().sqrt();
            sums[1] += (a[0] * n[0] + a[1] * n[1] + a[2] * n[2]) / 6.0;
        }
        sums
    }

    #[test]
    fn a_ball_has_its_area_and_volume_and_its_corners_lie_on_it() {
        let ball = Shape::ball([1.0, 2.0, 3.0], 0.5);
        let skin = Skin::of(&ball, 0.05, 3, None).unwrap();
        // Flat triangles of 0.07 across lie 0.07^2 / (8 0.5) below the surface: 0.2 % of the area, 0.4 % of the volume.
        let [area, volume] = measures(&skin);
        assert!((area / PI - 1.0).abs() < 0.01, "{area}");
        assert!((volume / (4.0 / 3.0 * PI * 0.125) - 1.0).abs() < 0.01, "{volume}");
        assert!(skin.corners.iter().all(|x| ball.distance(*x, 3).abs() < 1e-6));
        // Closed, without holes and handles: V - E + F = 2 with three sides for two triangles.
        assert_eq!(skin.corners.len() as i64 - skin.triangles.len() as i64 / 2, 2);
    }

    #[test]
    fn boxes_keep_their_edges_and_what_is_out_of_bounds_is_cut() {
        let shape = Shape::cuboid([0.0; 3], [1.0, 0.5, 0.3]);
        let [area, volume] = measures(&Skin::of(&shape, 0.07, 3, None).unwrap());
        assert!((area - 1.9).abs() < 1e-4 && (volume - 0.15).abs() < 1e-4, "{area} {volume}");
        let half = Bounds { min: [0.0, 0.0, 0.0], max: [0.5, 1.0, 1.0] };
        let [_, volume] = measures(&Skin::of(&shape, 0.07, 3, Some(half)).unwrap());
        assert!((volume - 0.075).abs() < 1e-4, "{volume}");
        assert!(Skin::of(&Shape::half_space([0.0; 3], [0.0, 0.0, 1.0]), 0.1, 3, None).is_none());
    }

    #[test]
    fn a_disk_in_the_plane_has_its_area() {
        let disk = Shape::disk([0.3, -0.2], 0.5);
        let skin = Skin::of(&disk, 0.05, 2, None).unwrap();
        let [area, _] = measures(&skin);
        assert!((area / (PI * 0.25) - 1.0).abs() < 5e-3, "{area}");
        let plate = Skin::of(&Shape::rectangle([0.0, 0.0], [1.0, 0.2]), 0.03, 2, None).unwrap();
        assert!((measures(&plate)[0] - 0.2).abs() < 1e-5);
    }
}
