//! The particles of a body around one node, one after the other, for laws that look at more than sums.

use super::Near;
use crate::body::Particle;
use crate::grid::SIDE;
use crate::scene::Face;
use crate::tensor::{Matrix, Real, Vector};
use crate::transfer::offsets;

/// Nodes along an axis that a particle reaches which is a point to its functions.
const WIDTH_OF_POINTS: usize = 2;

/// A node or one of its mirror images, with the signs that turn vectors between the two.
struct MirroredNode<T, const D: usize> {
    node: [i32; D],
    sign: [T; D],
}

impl<T: Real, const D: usize> Near<'_, T, D> {
    /// Calls `f(arm, particle, mirror)` for every particle of a body that reaches a node, itself or with its box: `arm`
    /// from the node to it [m], `mirror` turns its vectors into those that the node sees.
    pub fn around(
        &self,
        body: usize,
        node: [i32; D],
        mut f: impl FnMut(Vector<T, D>, &Particle<T, D>, Matrix<T>),
    ) {
        let periods = self.active.images_of(body);
        for image in
            periods.iter().flat_map(|away| self.images(std::array::from_fn(|i| node[i] + away[i] * SIDE)))
        {
            let seen = self.lattice.position(image.node);
            let mirror = Matrix::from_fn(|i, j| match (i == j, i < D) {
                (true, true) => image.sign[i],
                (true, false) => T::ONE,
                _ => T::ZERO,
            });
            for offset in offsets::<D>(self.kernels.width) {
                let cell = std::array::from_fn(|i| image.node[i] - offset[i] as i32);
                for &index in self.active.particles_in(body, cell) {
                    let particle = &self.bodies[body].particles.get(index as usize);
                    let arm = particle.position - seen;
                    let half_box = match self.kernels.width {
                        WIDTH_OF_POINTS => T::ZERO,
                        _ => self.lattice.half_box(particle.half_width),
                    };
                    let reach = self.lattice.cell + half_box;
                    if (0..D).all(|i| arm[i].abs() < reach) {
                        f(Vector::from_fn(|i| arm[i] * image.sign[i]), particle, mirror);
                    }
                }
            }
        }
    }

    /// A node and its images in the mirrors near it, each mirror turning around all that those before it gave.
    fn images(&self, node: [i32; D]) -> impl Iterator<Item = MirroredNode<T, D>> {
        let (walls, reach) = (&self.boundary.walls, self.kernels.width as i32);
        let near = walls.iter().filter(move |wall| wall.face == Face::Symmetry && wall.depth(node) < reach);
        (0..1_usize << near.clone().count()).map(move |turned| {
            let mut image = MirroredNode { node, sign: [T::ONE; D] };
            for (_, wall) in near.clone().enumerate().filter(|(i, _)| turned >> i & 1 == 1) {
                image.sign[wall.axis] = -image.sign[wall.axis];
                image.node = wall.image(image.node);
            }
            image
        })
    }
}
