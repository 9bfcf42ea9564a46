//! Impulses of contact that were reduced so that no cell strains by more than its rule's `max_strain`, eq. (22).

use super::{Check, CheckInputs, Finding};
use crate::door::ContactSum;
use crate::scene::{HealthCheck, Scene};

/// Holds those of two bodies against all that they gave each other since the start. A reduced impulse leaves a part of
/// the approach, and bodies go into each other.
pub(super) struct MaxStrainCheck;

/// Impulses between two bodies below which a share says nothing: at the first touch there are few.
const FEWEST: u64 = 50;

impl Check for MaxStrainCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::MaxStrain
    }

    fn advice(&self, _: &Scene) -> &'static str {
        "what is left of the approach drives the bodies into each other: try a smaller time.courant, a slower impact, \
         or a larger max_strain in [[contact]]"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let bound = look.bound(self.kind());
        let of_pair = |sum: ContactSum| {
            let share = sum.reduced as f64 / sum.pushes as f64;
            if sum.pushes < FEWEST || share <= bound {
                return None;
            }
            let [a, b] = sum.bodies.map(|body| &look.scene.bodies[body].name);
            let message = format!(
                "{:.1} % of the impulses at nodes between `{a}` and `{b}` were reduced to max_strain, {} of them, \
                 where {} % is allowed",
                100.0 * share,
                sum.reduced,
                100.0 * bound
            );
            Some((
                sum.bodies[0],
                Finding { body: Some(sum.bodies[0]), position: None, worst: share, message },
            ))
        };
        // Pairs are ordered by their first bodies, and of each of these the worst is told.
        let mut worst: Vec<(usize, Finding)> = Vec::new();
        for (body, finding) in look.simulation.contact_sums().into_iter().filter_map(of_pair) {
            match worst.last_mut().filter(|(last, _)| *last == body) {
                Some((_, known)) if known.worst >= finding.worst => {}
                Some((_, known)) => *known = finding,
                None => worst.push((body, finding)),
            }
        }
        worst.into_iter().map(|(_, finding)| finding).collect()
    }
}
