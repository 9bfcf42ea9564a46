//! Faces of the domain: mirrors and walls that material sticks to.
//!
//! Behind a mirror the particles' images are summed: nodes behind it give their share to the nodes before it and take
//! their values back with the sign of the normal component turned, as if the other half of the bodies were there.

mod tally;

pub use tally::WallTally;

use crate::grid::{ActiveBlocks, Disjoint, Field, Node, SIDE, node_at, nodes_per_block};
use crate::scheme::Face;
use crate::tensor::{Real, Vector};
use crate::threads::each_range;
use crate::transfer::Share;

/// A face of the domain that does something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wall {
    /// Axis across the face.
    pub axis: usize,
    /// Node on the face.
    pub node: i32,
    /// Which way the domain lies: 1 above a lower face, -1 below an upper one.
    pub inward: i32,
    /// Symmetry or fixed.
    pub face: Face,
}

impl Wall {
    /// Nodes from the face into the domain; negative behind it.
    #[inline]
    pub fn depth<const D: usize>(&self, node: [i32; D]) -> i32 {
        (node[self.axis] - self.node) * self.inward
    }

    /// The mirror image of a node.
    #[inline]
    pub fn image<const D: usize>(&self, mut node: [i32; D]) -> [i32; D] {
        node[self.axis] = 2 * self.node - node[self.axis];
        node
    }
}

/// A vector's mirror image across an axis.
#[inline]
pub fn reflect<T: Real, const D: usize>(mut v: Vector<T, D>, axis: usize) -> Vector<T, D> {
    v[axis] = -v[axis];
    v
}

/// The domain's walls and the field's nodes that they govern.
#[derive(Clone, Debug, Default)]
pub struct Boundary {
    /// Faces that are not open.
    pub walls: Vec<Wall>,
    /// Nodes behind each wall that is a mirror, with their images before it.
    mirrored: Vec<Vec<(usize, usize)>>,
    /// Nodes on a mirror, and its axis.
    on_mirror: Vec<(usize, usize)>,
    /// Nodes on or behind a fixed face.
    fixed: Vec<usize>,
    /// What walls give to nodes, where somebody wants to know.
    tally: Option<WallTally>,
}

impl Boundary {
    /// The boundary with these walls.
    pub fn new(walls: Vec<Wall>) -> Self {
        Boundary { walls, ..Boundary::default() }
    }

    /// The same, which keeps count of what walls give to nodes.
    pub fn tallied(self) -> Self {
        Boundary { tally: Some(WallTally::default()), ..self }
    }

    /// Whether a node lies behind a mirror, where it only repeats the one before it.
    pub fn is_mirrored<const D: usize>(&self, node: [i32; D]) -> bool {
        self.walls.iter().any(|wall| wall.face == Face::Symmetry && wall.depth(node) < 0)
    }

    /// Whether a node lies on or behind a fixed face.
    pub fn is_fixed<const D: usize>(&self, node: [i32; D]) -> bool {
        self.walls.iter().any(|wall| wall.face == Face::Fixed && wall.depth(node) <= 0)
    }

    /// The mirrors on which a node lies, a bit each.
    pub fn mirrors_through<const D: usize>(&self, node: [i32; D]) -> u32 {
        let on = |(_, wall): &(usize, &Wall)| wall.face == Face::Symmetry && wall.depth(node) == 0;
        self.walls.iter().enumerate().filter(on).fold(0, |mirrors, (i, _)| mirrors | 1 << i)
    }

    /// Finds the nodes that walls govern.
    pub fn find_nodes<const D: usize>(&mut self, active: &ActiveBlocks<D>) {
        self.mirrored.resize_with(self.walls.len(), Vec::new);
        self.on_mirror.clear();
        self.fixed.clear();
        if let Some(tally) = &mut self.tally {
            tally.clear();
        }
        let n = nodes_per_block(D);
        for (number, (wall, mirrored)) in self.walls.iter().zip(&mut self.mirrored).enumerate() {
            mirrored.clear();
            for (slot, &(body, block)) in active.slots.iter().enumerate() {
                let first = block[wall.axis] * SIDE;
                let nearest = if wall.inward > 0 { first } else { first + SIDE - 1 };
                if (nearest - wall.node) * wall.inward > 0 {
                    continue;
                }
                for local in 0..n {
                    let node = node_at(block, local);
                    let (depth, index) = (wall.depth(node), slot * n + local);
                    if let Some(tally) = self.tally.as_mut().filter(|_| depth <= 0) {
                        tally.add(&self.walls, number, (index, body, node));
                    }
                    match wall.face {
                        Face::Fixed if depth <= 0 => self.fixed.push(index),
                        Face::Symmetry if depth == 0 => self.on_mirror.push((index, wall.axis)),
                        Face::Symmetry if depth < 0 => {
                            if let Some(image) = active.node_index(body as usize, wall.image(node)) {
                                mirrored.push((index, image));
                            }
                        }
                        _ => {}
                    }
                }
            }
        }
        if let Some(tally) = &mut self.tally {
            tally.begin();
        }
    }

    /// Adds what was scattered behind the mirrors to the nodes before them.
    pub fn add_images<T: Real, const D: usize>(&mut self, field: &mut Field<T, D>, share: Share) {
        for (wall, mirrored) in self.walls.iter().zip(&self.mirrored) {
            each_image(mirrored, field, |image, node| add_image(image, node, wall.axis, share));
        }
        if let Some(tally) = self.tally.as_mut().filter(|_| share.has_force()) {
            tally.take_forces(&self.walls, &field.nodes);
        }
        for &(node, axis) in &self.on_mirror {
            field.nodes[node].velocity[axis] = T::ZERO;
            field.nodes[node].force[axis] = T::ZERO;
        }
    }

    /// Makes the velocities obey the walls.
    pub fn impose<T: Real, const D: usize>(&mut self, field: &mut Field<T, D>) {
        if let Some(tally) = &mut self.tally {
            tally.take_momentum(&self.walls, &field.nodes);
        }
        for &node in &self.fixed {
            field.nodes[node].velocity = Vector::ZERO;
        }
        for &(node, axis) in &self.on_mirror {
            field.nodes[node].velocity[axis] = T::ZERO;
        }
        for (wall, mirrored) in self.walls.iter().zip(&self.mirrored).rev() {
            each_image(mirrored, field, |image, node| repeat(image, node, wall.axis));
        }
    }

    /// Gives nodes behind mirrors the values of those before them.
    pub fn repeat_values<T: Real>(&self, values: &mut [T]) {
        for &(behind, before) in self.mirrored.iter().rev().flatten() {
            values[behind] = values[before];
        }
    }
}

/// Adds what was scattered into a node behind a mirror to the one before it.
fn add_image<T: Real, const D: usize>(image: &Node<T, D>, node: &mut Node<T, D>, axis: usize, share: Share) {
    if share.has_mass() {
        node.mass += image.mass;
    }
    // Nodes without mass keep the velocity that they had.
    if share.has_momentum() && image.mass > T::ZERO {
        node.velocity += reflect(image.velocity, axis);
    }
    if share.has_force() {
        node.force += reflect(image.force, axis);
    }
}

/// Gives a node behind a mirror the velocities of the one before it.
fn repeat<T: Real, const D: usize>(image: &mut Node<T, D>, node: &Node<T, D>, axis: usize) {
    image.start = reflect(node.start, axis);
    image.velocity = reflect(node.velocity, axis);
}

/// Nodes that a thread takes at a time.
const NODES: usize = 1024;

/// Does something to each node behind a mirror and its image before it.
fn each_image<T: Real, const D: usize>(
    mirrored: &[(usize, usize)],
    field: &mut Field<T, D>,
    f: impl Fn(&mut Node<T, D>, &mut Node<T, D>) + Sync,
) {
    let nodes = Disjoint::new(&mut field.nodes);
    each_range(mirrored.len(), NODES, &|range| {
        for &(behind, before) in &mirrored[range] {
            // SAFETY: no node lies behind a mirror and before it, and each has one image.
            let (image, node) = unsafe { (nodes.get(behind), nodes.get(before)) };
            f(image, node);
        }
    });
}
