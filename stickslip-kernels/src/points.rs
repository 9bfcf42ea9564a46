//! Nodes that move a point of a body which a particle carries.

use crate::basis::Basis;
use crate::grid::Lattice;
use crate::matter::Particle;
use crate::tensor::{Real, Vector};
use crate::transfer::offsets;

/// F (X_s - X_p), where the point was drawn at `drawn` from the particle [m].
pub fn arm<T: Real, const D: usize>(particle: &Particle<T, D>, drawn: &[f64; 3]) -> Vector<T, D> {
    let f = &particle.deformation.0;
    Vector::from_fn(|i| (0..3).fold(T::ZERO, |sum, j| sum + f[i][j] * T::of(drawn[j])))
}

/// How [`nodes_of`] is called.
pub type NodesOf<T, const D: usize> =
    fn(&Lattice<T, D>, &Particle<T, D>, &[f64; 3], &mut dyn FnMut([i32; D], [T; 2]));

/// Takes the nodes that move a point of a particle, each with its S_i and N_i [-]; the point was drawn at `drawn` from
/// the particle.
pub fn nodes_of<T: Real, const D: usize, B: Basis<T>>(
    lattice: &Lattice<T, D>,
    particle: &Particle<T, D>,
    drawn: &[f64; 3],
    take: &mut dyn FnMut([i32; D], [T; 2]),
) {
    let x = lattice.cells(particle.position);
    let half = lattice.seen_half_side(particle.half_width);
    let axes: [_; D] = std::array::from_fn(|i| B::axis(x[i], half));
    let arm = arm::<T, D>(particle, drawn) * lattice.per_cell;
    for offset in offsets::<D>(B::WIDTH) {
        let node = std::array::from_fn(|i| axes[i].base + offset[i] as i32);
        let weight = |i: usize| axes[i].shape.weight[offset[i]];
        let except =
            |skip: usize| (0..D).filter(|&i| i != skip).fold(T::ONE, |product, i| product * weight(i));
        let beside = |i: usize| except(i) * axes[i].shape.slope(offset[i]) * arm[i];
        let own = (0..D).fold(T::ONE, |product, i| product * weight(i));
        take(node, [own, (0..D).fold(own, |sum, i| sum + beside(i))]);
    }
}
