//! Contacts that the grid does not resolve: judged once, at the end of the run, by how wide they became. A scene that
//! wants to be stopped by them is judged during the run, by contacts that have ceased to grow.

use super::verdict::Noted;
use super::widest::{LargestForces, WidestContacts};
use crate::check::ContactResolution;
use crate::door::{ContactPatch, View};
use crate::scene::{HealthCheck, Response, Scene};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Looks at the widest contact of each pair as often as tables are written.
#[derive(Serialize, Deserialize)]
pub(super) struct ContactWatch {
    next: f64,
    /// Patches when it looked last.
    before: Vec<ContactPatch>,
    forces: LargestForces,
}

/// A contact that has grown by less since the last look has ceased to grow.
const GROWTH: f64 = 0.01;

impl ContactWatch {
    pub(super) fn new(start: f64) -> Self {
        ContactWatch { next: start, before: Vec::new(), forces: LargestForces::default() }
    }

    /// Takes note of what pairs bear, if it is time to; and says what is not resolved and grows no more, where that is to
    /// stop the run.
    pub(super) fn look(&mut self, scene: &Scene, view: &dyn View) -> Option<Noted> {
        if view.time() < self.next {
            return None;
        }
        self.next = view.time() + scene.outputs.tables;
        let touched = self.forces.look(view);
        let patches: Vec<ContactPatch> = touched.iter().map(|touched| touched.patch).collect();
        let grown = self.grown_up(&patches);
        self.before = patches;
        if scene.health.response(HealthCheck::Contact) != Response::Stop {
            return None;
        }
        let name = |body: usize| scene.bodies[body].name.as_str();
        let grown: BTreeSet<_> = grown.iter().map(|patch| [patch.body_a, patch.body_b].map(name)).collect();
        // Weighed against all that the bodies bear. Others may widen yet.
        let mut found = WidestContacts::new(scene, &touched).bearing();
        found.0.retain(|contact| grown.contains(&contact.bodies.each_ref().map(String::as_str)));
        noted(found)
    }

    /// What is not resolved, at the end of the run.
    pub(super) fn conclude(&mut self, scene: &Scene, view: &dyn View) -> Option<Noted> {
        noted(self.widest(scene, view).bearing())
    }

    /// The widest contacts of the whole run, after its last step.
    pub(super) fn widest(&mut self, scene: &Scene, view: &dyn View) -> WidestContacts {
        WidestContacts::new(scene, &self.forces.look(view))
    }

    /// Those that no longer grow.
    fn grown_up(&self, patches: &[ContactPatch]) -> Vec<ContactPatch> {
        let pair = |patch: &ContactPatch| [patch.body_a, patch.body_b];
        let mut before = self.before.iter().peekable();
        let grown = |patch: &&ContactPatch| {
            // Both are ordered by pair, and none is lost.
            while before.next_if(|old| pair(old) < pair(patch)).is_some() {}
            let old = before.next_if(|old| pair(old) == pair(patch));
            old.is_some_and(|old| patch.area <= (1.0 + GROWTH) * old.area)
        };
        patches.iter().filter(grown).filter(|patch| patch.area > 0.0).copied().collect()
    }
}

/// Those that are not resolved, as one finding.
fn noted(mut found: WidestContacts) -> Option<Noted> {
    found.0.retain(|contact| contact.verdict == ContactResolution::NotResolved);
    let narrowest = found.0.first()?;
    Some(Noted {
        check: HealthCheck::Contact,
        message: format!(
            "contact not resolved: {}, {}; {}",
            found.named(),
            found.borne(),
            narrowest.expect()
        ),
        worst: narrowest.cells,
        advice: "take smaller cells where they touch".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patches(areas: &[f64]) -> Vec<ContactPatch> {
        let patch = |(i, &area): (usize, &f64)| ContactPatch {
            body_a: i,
            body_b: i + 1,
            area,
            half_width: 0.5 * area,
            impulse: 1.0,
        };
        areas.iter().enumerate().map(patch).collect()
    }

    /// Only those that were there at the last look and have not grown.
    #[test]
    fn a_contact_counts_when_it_no_longer_grows() {
        let mut contact_watch = ContactWatch::new(0.0);
        let grown = |contact_watch: &ContactWatch, areas: &[f64]| -> Vec<usize> {
            contact_watch.grown_up(&patches(areas)).iter().map(|patch| patch.body_a).collect()
        };
        assert!(grown(&contact_watch, &[1.0, 2.0]).is_empty());
        contact_watch.before = patches(&[1.0, 2.0]);
        assert_eq!(grown(&contact_watch, &[1.5, 2.0, 3.0]), [1]);
        contact_watch.before = patches(&[1.5, 2.0, 3.0]);
        assert_eq!(grown(&contact_watch, &[1.5, 2.0, 3.0]), [0, 1, 2]);
    }
}
