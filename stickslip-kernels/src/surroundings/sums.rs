//! Sums over the particles around a node.

use super::ReferenceMap;
use crate::particles::stress_entries;
use crate::tensor::{Matrix, Real, Symmetric, Vector};

/// Which sums are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// Of volume and places.
    Places,
    /// All of them.
    Everything,
}

/// Sums over the particles around a node.
///
/// ```text
/// row 0         sum V grad S [m^2], sum V S [m^3]       with the gradient at the node
/// then          sum V S of place, centre and inverse of F, one number after the other
/// then          sum V S of the stress
/// row MASS      sum m grad S [kg/m], sum m S [kg]       likewise
/// row FORCE     force of the stress on the node [N]
/// ```
/// Places are those of the first node of the block; of a body that flows, of the particles. Where only places are
/// wanted, all from the stress on is zero.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct MaterialSums<T, const D: usize>(pub(super) [[T; 4]; ROWS]);

pub(super) const ROWS: usize = 9;
pub(super) const MASS: usize = 7;
pub(super) const FORCE: usize = 8;
/// First row of what is weighted by volume.
pub(super) const FIRST: usize = 1;

/// Rows of place, centre and inverse of F.
pub(super) const fn placed_rows(dimension: usize) -> usize {
    (2 * dimension + dimension * dimension).div_ceil(4)
}

/// Rows of the stress, which follow.
pub(super) const fn stress_rows(dimension: usize) -> usize {
    stress_entries(dimension).div_ceil(4)
}

impl<T: Real, const D: usize> MaterialSums<T, D> {
    /// Of no particle.
    pub const EMPTY: Self = MaterialSums([[T::ZERO; 4]; ROWS]);

    /// sum V S [m^3]
    pub fn volume(&self) -> T {
        self.0[0][3]
    }

    /// sum m S [kg]
    pub fn mass(&self) -> T {
        self.0[MASS][3]
    }

    /// sum V grad S [m^2]
    pub fn volume_gradient(&self) -> Vector<T, D> {
        Vector::from_fn(|i| self.0[0][i])
    }

    /// sum m grad S [kg/m]
    pub fn mass_gradient(&self) -> Vector<T, D> {
        Vector::from_fn(|i| self.0[MASS][i])
    }

    /// Force of the stress on the node [N].
    pub fn force(&self) -> Vector<T, D> {
        Vector::from_fn(|i| self.0[FORCE][i])
    }

    fn number(&self, k: usize) -> T {
        self.0[FIRST + k / 4][k % 4]
    }

    /// The stress weighted by volume [Pa].
    pub fn stress(&self) -> Symmetric<T> {
        let mut stress = Symmetric::ZERO;
        for (k, entry) in stress.0.iter_mut().enumerate().take(stress_entries(D)) {
            *entry = self.number(4 * placed_rows(D) + k) / self.volume();
        }
        stress
    }

    /// The place weighted by volume, of a body that flows plastically or not.
    pub fn place(&self, flow: bool) -> ReferenceMap<T, D> {
        let share = T::ONE / self.volume();
        let vector = |first: usize| Vector::from_fn(|i| self.number(first + i) * share);
        let inverse = Matrix::from_fn(|i, j| match i < D && j < D {
            true => self.number(2 * D + i * D + j) * share,
            false => T::ZERO,
        });
        let (mut place, center) = (vector(0), vector(D));
        if flow {
            // So far the mean of the places of the particles themselves.
            place = Vector::from_fn(|i| (0..D).fold(place[i], |x, j| x - inverse.0[i][j] * center[j]));
        }
        ReferenceMap { place, inverse, center }
    }
}
