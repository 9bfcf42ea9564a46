//! The state in which a particle has no stress, where that is not the one in which its body is drawn: initial stress
//! and heat.
//!
//! ```text
//! F_e = F A / q,   q = 1 + alpha T          what a law sees of the deformation F; of a step, dF / (q / q_0)
//! ```
//! A: what gives the initial stress ([`crate::initial_stress`]), T: by how much the particle is warmer than at the
//! start, alpha: expansion by temperature, alike in all directions. The law's volumes are those without stress: its
//! energies per volume count with q^3 / det A of the particle's undeformed volume.

use crate::column::{INITIAL_STRETCH, Kind, TEMPERATURE, THERMAL_STRAIN_STEP};
use crate::material::{History, Motion};
use crate::tensor::{Matrix, Number, Symmetric};

/// A.
const STRETCH: History = History { start: 1.0, ..History::new(INITIAL_STRETCH, "", Kind::Symmetric) };
/// T.
const WARMER: History = History::new(TEMPERATURE, "K", Kind::Number);
/// q / q_0 - 1 of the last step.
const STEP: History = History::new(THERMAL_STRAIN_STEP, "", Kind::Number);
static HEAT: [History; 2] = [WARMER, STEP];
static STRETCH_AND_HEAT: [History; 3] = [STRETCH, WARMER, STEP];
const HEAT_ENTRIES: usize = 2;

/// The columns of bodies that begin with a stress, and of those that loads heat.
pub fn columns(stretched: bool, heated: bool) -> &'static [History] {
    match (stretched, heated) {
        (false, false) => &[],
        (true, false) => &STRETCH_AND_HEAT[..1],
        (false, true) => &HEAT,
        (true, true) => &STRETCH_AND_HEAT,
    }
}

/// Whether A is among these columns.
pub fn begins_stretched(columns: &[History]) -> bool {
    columns.first().is_some_and(|first| first.column.name == INITIAL_STRETCH)
}

/// Entries of them at most.
pub const fn most_entries(dimension: usize) -> usize {
    Kind::Symmetric.entries(dimension) + HEAT_ENTRIES
}

/// Where among them those of heat begin, of so many.
#[inline(always)]
pub const fn heat_in<const D: usize>(count: usize) -> Option<usize> {
    let stretch = Kind::Symmetric.entries(D);
    match count {
        0 => None,
        HEAT_ENTRIES => Some(0),
        count if count > stretch => Some(stretch),
        _ => None,
    }
}

/// The state without stress of particles.
#[derive(Clone, Copy, Debug)]
pub struct Natural<V> {
    /// A / q.
    map: Matrix<V>,
    /// Its determinant.
    pub volume: V,
    /// q / q_0 of the last step.
    growth: V,
}

impl<V: Number> Natural<V> {
    /// From the entries of the columns, so many, and alpha.
    #[inline(always)]
    pub fn new<const D: usize>((entries, count): (&[V], usize), expansion: V) -> Self {
        let (mut map, mut growth) = (Symmetric::isotropic(V::ONE), V::ONE);
        let stretch = Kind::Symmetric.entries(D);
        if count >= stretch {
            map.0[..stretch].copy_from_slice(&entries[..stretch]);
        }
        if let Some(first) = heat_in::<D>(count) {
            map = map * (V::ONE / expansion.times_plus(entries[first], V::ONE));
            growth = V::ONE + entries[first + 1];
        }
        let map = map.matrix();
        Natural { map, volume: map.det(), growth }
    }

    /// F_e and its determinant.
    #[inline(always)]
    pub fn elastic(&self, deformation: &Matrix<V>, jacobian: V) -> (Matrix<V>, V) {
        (*deformation * self.map, jacobian * self.volume)
    }

    /// What the law sees of a motion.
    #[inline(always)]
    pub fn seen(&self, motion: &Motion<V>) -> Motion<V> {
        let (deformation, jacobian) = self.elastic(&motion.deformation, motion.jacobian);
        let increment = motion.increment * (V::ONE / self.growth);
        Motion { deformation, jacobian, increment, ..*motion }
    }

    /// What the law sees of a motion whose thickness is free: of that, what it was before the step.
    #[inline(always)]
    pub fn seen_with_free_thickness(&self, motion: &Motion<V>) -> Motion<V> {
        let mut seen = self.seen(motion);
        seen.deformation.0[2][2] *= self.growth;
        seen.jacobian *= self.growth;
        seen.increment.0[2][2] = V::ONE;
        seen
    }

    /// By how much a free thickness grows in a step in which the law sees this stretch of it.
    #[inline(always)]
    pub fn thickening(&self, stretch: V) -> V {
        stretch * self.growth
    }
}
