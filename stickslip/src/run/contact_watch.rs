//! During a run: contacts that have become as wide as they will be, and are not resolved by the grid.

use super::verdict::Noted;
use super::widest::{LargestForces, WidestContacts};
use crate::check::ContactResolution;
use crate::door::{ContactPatch, View};
use crate::scene::{HealthCheck, Response, Scene};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Looks at the widest contact of each pair as often as tables are written, tells once of each pair that bears a part
/// of the force, and at each look of all that it has told of.
#[derive(Serialize, Deserialize)]
pub(super) struct ContactWatch {
    next: f64,
    /// Patches when it looked last.
    before: Vec<ContactPatch>,
    reported: BTreeSet<[usize; 2]>,
    lines: usize,
    forces: LargestForces,
}

/// A contact that has grown by less since the last look has ceased to grow.
const GROWTH: f64 = 0.01;

/// Lines in a run: beyond, the summary tells.
const MOST_LINES: usize = 5;

impl ContactWatch {
    pub(super) fn new(start: f64) -> Self {
        ContactWatch {
            next: start,
            before: Vec::new(),
            reported: BTreeSet::new(),
            lines: 0,
            forces: LargestForces::default(),
        }
    }

    /// What is new, and what is not resolved, if it is time to look.
    pub(super) fn look(&mut self, scene: &Scene, view: &dyn View) -> (Option<String>, Option<Noted>) {
        if view.time() < self.next {
            return (None, None);
        }
        self.next = view.time() + scene.outputs.tables;
        let touched = self.forces.look(view);
        let patches: Vec<ContactPatch> = touched.iter().map(|touched| touched.patch).collect();
        let new = self.grown_up(&patches);
        self.before = patches;
        // Weighed against all that the bodies bear.
        let mut found = WidestContacts::new(scene, &touched).bearing();
        let name = |body: usize| scene.bodies[body].name.as_str();
        let new_names: BTreeSet<_> = new.iter().map(|patch| [patch.body_a, patch.body_b].map(name)).collect();
        // Others may widen yet.
        let told: BTreeSet<_> = self.reported.iter().map(|pair| pair.map(name)).collect();
        found.0.retain(|contact| {
            let names = contact.bodies.each_ref().map(String::as_str);
            contact.verdict == ContactResolution::NotResolved
                && (new_names.contains(&names) || told.contains(&names))
        });
        let noted = found.0.first().map(|narrowest| Noted {
            check: HealthCheck::Contact,
            message: format!("contact not resolved: {}, {}; {}", found.named(), found.borne(), narrowest.off),
            worst: narrowest.cells,
            advice: "take smaller cells where they touch".to_owned(),
        });
        found.0.retain(|contact| new_names.contains(&contact.bodies.each_ref().map(String::as_str)));
        let poor: BTreeSet<_> =
            found.0.iter().map(|contact| contact.bodies.each_ref().map(String::as_str)).collect();
        let pair = |patch: &ContactPatch| [patch.body_a, patch.body_b];
        let newly = new.iter().map(pair).filter(|pair| poor.contains(&pair.map(name))).collect::<Vec<_>>();
        self.reported.extend(newly);
        // Said without being asked for.
        let is_told = scene.health.response(HealthCheck::Contact) != Response::Ignore;
        let line = found.0.first().filter(|_| is_told && self.lines < MOST_LINES).map(|narrowest| {
            self.lines += 1;
            let last = if self.lines == MOST_LINES { "; no more of this until the summary" } else { "" };
            format!("contact not resolved: {}, {}; {}{last}", found.named(), found.borne(), narrowest.off)
        });
        (line, noted)
    }

    /// The widest contacts of the whole run, after its last step.
    pub(super) fn widest(&mut self, scene: &Scene, view: &dyn View) -> WidestContacts {
        WidestContacts::new(scene, &self.forces.look(view))
    }

    /// Those that have not been told of, and no longer grow.
    fn grown_up(&self, patches: &[ContactPatch]) -> Vec<ContactPatch> {
        let pair = |patch: &ContactPatch| [patch.body_a, patch.body_b];
        let mut before = self.before.iter().peekable();
        let grown = |patch: &&ContactPatch| {
            // Both are ordered by pair, and none is lost.
            while before.next_if(|old| pair(old) < pair(patch)).is_some() {}
            let old = before.next_if(|old| pair(old) == pair(patch));
            old.is_some_and(|old| patch.area <= (1.0 + GROWTH) * old.area)
        };
        let grown: Vec<ContactPatch> = patches.iter().filter(grown).copied().collect();
        grown.into_iter().filter(|patch| patch.area > 0.0 && !self.reported.contains(&pair(patch))).collect()
    }
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

    /// Only those that were there at the last look and have not grown, once.
    #[test]
    fn a_contact_is_told_of_once_and_when_it_no_longer_grows() {
        let mut contact_watch = ContactWatch::new(0.0);
        let grown = |contact_watch: &ContactWatch, areas: &[f64]| -> Vec<usize> {
            contact_watch.grown_up(&patches(areas)).iter().map(|patch| patch.body_a).collect()
        };
        assert!(grown(&contact_watch, &[1.0, 2.0]).is_empty());
        contact_watch.before = patches(&[1.0, 2.0]);
        assert_eq!(grown(&contact_watch, &[1.5, 2.0, 3.0]), [1]);
        contact_watch.reported.insert([1, 2]);
        contact_watch.before = patches(&[1.5, 2.0, 3.0]);
        assert_eq!(grown(&contact_watch, &[1.5, 2.0, 3.0]), [0, 2]);
    }
}
