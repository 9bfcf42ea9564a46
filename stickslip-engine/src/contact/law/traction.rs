//! The paper's rule of 2001: contact where the normal traction is compressive.
//!
//! ```text
//! n . sigma . n < 0               eq. (9) of Bardenhagen et al. (2001)
//! ```
//! Bodies that are stress free are judged by approach alone. Bodies that rebound so give back their strain energy.

use super::PairLaw;
use crate::contact::{Change, Pair, SurfaceEstimate, common_normal, own_normals};
use crate::scene::Normal;
use crate::tensor::{Real, Vector};

/// Contact under compression.
pub struct Traction;

impl<T: Real, const D: usize> PairLaw<T, D> for Traction {
    fn change(&self, pair: &Pair<T, D>, velocities: [Vector<T, D>; 2]) -> Change<T, D> {
        match pair.rule.normal {
            Normal::Common => common_normal(pair, velocities, |approach, n| {
                joint(pair, n).map_or(approach > T::ZERO, |traction| traction < T::ZERO)
            }),
            Normal::Own => {
                own_normals(pair, velocities, |surface, approach, n| pressed(surface, approach, n))
            }
        }
    }
}

/// Whether a body alone is in contact by its own traction.
pub(super) fn pressed<T: Real, const D: usize>(
    surface: &SurfaceEstimate<T, D>,
    approach: T,
    n: Vector<T, D>,
) -> bool {
    loaded(n.dot(surface.stress.times(n)), surface.modulus).map_or(approach > T::ZERO, |t| t < T::ZERO)
}

/// n . sigma . n of both bodies together [Pa]; `None` where they are stress free.
pub(super) fn joint<T: Real, const D: usize>(pair: &Pair<T, D>, n: Vector<T, D>) -> Option<T> {
    let [a, b] = pair.surfaces;
    let stress = (a.stress * a.volume + b.stress * b.volume) * (T::ONE / (a.volume + b.volume));
    loaded(n.dot(stress.times(n)), a.modulus.min(b.modulus))
}

/// Stress below this fraction of the modulus is round-off and counts as none.
fn stress_free<T: Real>() -> T {
    T::of(1e-12).max(T::of(16.0) * T::EPSILON)
}

fn loaded<T: Real>(traction: T, modulus: T) -> Option<T> {
    (traction.abs() > stress_free::<T>() * modulus).then_some(traction)
}
