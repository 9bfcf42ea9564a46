//! Sums over the particles around a node.

use crate::contact::Place;
use crate::particles::stress_entries;
use crate::tensor::{Matrix, Real, Symmetric, Vector};

/// Sums over the particles around a node.
///
/// ```text
/// row 0     sum V grad S [m^2], sum V S [m^3]       with the gradient at the node
/// row 1     sum m grad S [kg/m], sum m S [kg]       likewise
/// row 2     force of the stress on the node [N]
/// beyond    sum V S of place, centre, inverse of F, and stress, one number after the other
/// ```
/// Places are seen from the first node of the block.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct Sums<T, const D: usize>(pub(super) [[T; 4]; ROWS]);

pub(super) const ROWS: usize = 9;
/// Rows before those that are weighted by volume.
pub(super) const FIRST: usize = 3;

/// Numbers of a particle that are weighted by volume.
const fn weighted(dimension: usize) -> usize {
    2 * dimension + dimension * dimension + stress_entries(dimension)
}

pub(super) const fn weighted_rows(dimension: usize) -> usize {
    weighted(dimension).div_ceil(4)
}

impl<T: Real, const D: usize> Sums<T, D> {
    /// Of no particle.
    pub const EMPTY: Self = Sums([[T::ZERO; 4]; ROWS]);

    /// sum V S [m^3]
    pub fn volume(&self) -> T {
        self.0[0][3]
    }

    /// sum m S [kg]
    pub fn mass(&self) -> T {
        self.0[1][3]
    }

    /// sum V grad S [m^2]
    pub fn volume_gradient(&self) -> Vector<T, D> {
        Vector::from_fn(|i| self.0[0][i])
    }

    /// sum m grad S [kg/m]
    pub fn mass_gradient(&self) -> Vector<T, D> {
        Vector::from_fn(|i| self.0[1][i])
    }

    /// Force of the stress on the node [N].
    pub fn force(&self) -> Vector<T, D> {
        Vector::from_fn(|i| self.0[2][i])
    }

    fn number(&self, k: usize) -> T {
        self.0[FIRST + k / 4][k % 4]
    }

    /// The stress weighted by volume [Pa].
    pub fn stress(&self) -> Symmetric<T> {
        let mut stress = Symmetric::ZERO;
        for (k, entry) in stress.0.iter_mut().enumerate().take(stress_entries(D)) {
            *entry = self.number(2 * D + D * D + k) / self.volume();
        }
        stress
    }

    /// The place weighted by volume.
    pub fn place(&self) -> Place<T, D> {
        let share = T::ONE / self.volume();
        let vector = |first: usize| Vector::from_fn(|i| self.number(first + i) * share);
        let inverse = Matrix::from_fn(|i, j| match i < D && j < D {
            true => self.number(2 * D + i * D + j) * share,
            false => T::ZERO,
        });
        Place { place: vector(0), inverse, center: vector(D) }
    }
}
