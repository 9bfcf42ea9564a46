//! What a body's particles say at the nodes of a block where it meets others.
//!
//! Each particle near such nodes is visited once and added to all that it reaches. Behind a mirror its image is added.

use super::{Near, Place};
use crate::basis::{Basis, MAX_WIDTH};
use crate::body::Particle;
use crate::boundary::Wall;
use crate::grid::{SIDE, node_at, nodes_per_block};
use crate::scene::Face;
use crate::tensor::{Matrix, Real, Symmetric, Vector};
use crate::transfer::{Stencil, offsets};

/// Most nodes that a particle reaches.
const MAX_REACHED: usize = MAX_WIDTH.pow(3);

/// Nodes of a block, a bit each.
pub type Nodes = u64;

/// Sums over the particles around a node.
#[derive(Clone, Copy, Debug)]
pub struct Sums<T, const D: usize> {
    /// sum V S [m^3]
    pub volume: T,
    /// sum m S [kg]
    pub mass: T,
    /// sum m grad S, with the gradient at the node [kg/m]
    pub mass_gradient: Vector<T, D>,
    /// sum V grad S, likewise [m^2]
    pub volume_gradient: Vector<T, D>,
    /// sum V sigma S [J]
    pub stress: Symmetric<T>,
    /// Force of the stress on the node [N].
    pub force: Vector<T, D>,
    /// Places weighted by V S, seen from the first node of the block.
    pub place: Place<T, D>,
}

impl<T: Real, const D: usize> Sums<T, D> {
    /// Of no particle.
    pub const EMPTY: Self = Sums {
        volume: T::ZERO,
        mass: T::ZERO,
        mass_gradient: Vector::ZERO,
        volume_gradient: Vector::ZERO,
        stress: Symmetric::ZERO,
        force: Vector::ZERO,
        place: Place::EMPTY,
    };
}

/// For each axis, the mirror that particles are seen in, if any.
type Mirrors<'a, const D: usize> = [Option<&'a Wall>; D];

/// A particle as it counts at nodes.
struct Share<T, const D: usize> {
    mass: T,
    /// Volume on the grid, and the volume that its stress fills [m^3].
    room: T,
    volume: T,
    stress: Symmetric<T>,
    place: Place<T, D>,
    sign: [T; D],
}

impl<T: Real, const D: usize> Near<'_, T, D> {
    /// Adds a body's particles to the wanted nodes of a block.
    pub fn sum_around<B: Basis<T>>(
        &self,
        (body, block): (usize, [i32; D]),
        wanted: Nodes,
        sums: &mut [Sums<T, D>],
    ) {
        for mirrors in &self.mirrors_near::<B>(block) {
            self.sum_seen::<B>((body, block), wanted, (mirrors, &mut *sums));
        }
    }

    /// No mirror, and every mirror and combination of mirrors whose images reach nodes of the block.
    fn mirrors_near<B: Basis<T>>(&self, block: [i32; D]) -> Vec<Mirrors<'_, D>> {
        let mut all: Vec<Mirrors<D>> = vec![[None; D]];
        for wall in self.boundary.walls.iter().filter(|wall| wall.face == Face::Symmetry) {
            let near = if wall.inward > 0 { 0 } else { SIDE - 1 };
            let depth = (block[wall.axis] * SIDE + near - wall.node) * wall.inward;
            if depth < B::WIDTH as i32 {
                for i in 0..all.len() {
                    let mut mirrors = all[i];
                    if mirrors[wall.axis].replace(wall).is_none() {
                        all.push(mirrors);
                    }
                }
            }
        }
        all
    }

    fn sum_seen<B: Basis<T>>(
        &self,
        (body, block): (usize, [i32; D]),
        wanted: Nodes,
        (mirrors, sums): (&Mirrors<D>, &mut [Sums<T, D>]),
    ) {
        let reach = B::WIDTH as i32 - 1;
        // The lowest node, and the lowest cell that reaches it, as the particles are seen.
        let lowest: [i32; D] = std::array::from_fn(|i| match mirrors[i] {
            Some(wall) => 2 * wall.node - block[i] * SIDE - (SIDE - 1),
            None => block[i] * SIDE,
        });
        // The place in the block of a node that is `steps` from the lowest.
        let local = |steps: [i32; D]| {
            (0..D).fold(0, |local, i| {
                let step = if mirrors[i].is_some() { SIDE - 1 - steps[i] } else { steps[i] };
                local * SIDE as usize + step as usize
            })
        };
        let side = (SIDE + reach) as usize;
        for cell in offsets::<D>(side) {
            // Steps from the lowest node to the cell's base node.
            let base: [i32; D] = std::array::from_fn(|i| cell[i] as i32 - reach);
            let mut reached = [([0; D], 0); MAX_REACHED];
            let mut count = 0;
            for offset in offsets::<D>(B::WIDTH) {
                let steps: [i32; D] = std::array::from_fn(|i| base[i] + offset[i] as i32);
                if steps.iter().all(|step| (0..SIDE).contains(step)) && wanted >> local(steps) & 1 == 1 {
                    reached[count] = (offset, local(steps));
                    count += 1;
                }
            }
            if count == 0 {
                continue;
            }
            let home = std::array::from_fn(|i| lowest[i] + base[i]);
            for &index in self.cover.particles_in(body, home) {
                let particle = &self.bodies[body].particles.get(index as usize);
                let stencil = Stencil::<T, D, B>::new(&self.lattice, particle);
                let share = self.share((body, block), particle, mirrors);
                for &(offset, local) in &reached[..count] {
                    share.add_to(&mut sums[local], stencil.at(offset));
                }
            }
        }
    }

    fn share(
        &self,
        (body, block): (usize, [i32; D]),
        particle: &Particle<T, D>,
        mirrors: &Mirrors<D>,
    ) -> Share<T, D> {
        let first = self.lattice.position(node_at(block, 0));
        let sign: [T; D] = std::array::from_fn(|i| if mirrors[i].is_some() { -T::ONE } else { T::ONE });
        let seen = |x: Vector<T, D>| {
            Vector::from_fn(|i| match mirrors[i] {
                Some(wall) => {
                    let position = self.lattice.origin[i] + T::of(f64::from(wall.node)) * self.lattice.cell;
                    position + position - x[i]
                }
                None => x[i],
            })
        };
        let flip = |i: usize, j: usize| {
            let sign = |i: usize| if i < D { sign[i] } else { T::ONE };
            sign(i) * sign(j)
        };
        let inverse = particle.deformation.inverse();
        let inverse = Matrix::from_fn(|i, j| inverse.0[i][j] * flip(i, j));
        let arm = seen(particle.position) - first;
        let start = seen(self.bodies[body].places[particle.number as usize]);
        let place = Vector::from_fn(|i| (0..D).fold(start[i], |x, j| x - inverse.0[i][j] * arm[j]));
        let s = particle.stress.0;
        Share {
            mass: particle.mass,
            room: particle.room(),
            volume: particle.volume * particle.deformation.det(),
            stress: Symmetric([s[0], s[1], s[2], s[3] * flip(0, 1), s[4] * flip(1, 2), s[5] * flip(0, 2)]),
            place: Place { place, inverse, center: arm },
            sign,
        }
    }
}

impl<T: Real, const D: usize> Share<T, D> {
    fn add_to(&self, sums: &mut Sums<T, D>, (weight, gradient): (T, Vector<T, D>)) {
        // The node sees a particle move away as the particle sees the node move: grad at the node = -grad S(x_p).
        let gradient = Vector::from_fn(|i| -gradient[i] * self.sign[i]);
        let share = self.room * weight;
        sums.volume += share;
        sums.mass += self.mass * weight;
        sums.mass_gradient += gradient * self.mass;
        sums.volume_gradient += gradient * self.room;
        sums.stress += self.stress * share;
        sums.force += self.stress.times(gradient) * self.volume;
        sums.place.add(&self.place, share);
    }
}

/// The nodes of a block that a test takes.
pub fn nodes_where<const D: usize>(takes: impl Fn(usize) -> bool) -> Nodes {
    (0..nodes_per_block(D)).filter(|&local| takes(local)).fold(0, |nodes, local| nodes | 1 << local)
}
