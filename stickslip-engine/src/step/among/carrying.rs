//! Bodies that begin as another run left them, of which each rank finds some particles.

use super::Find;
use super::taking_up::first_problem;
use crate::door::{NotTakenUp, RestoreError, SavedBody, SavedColumn, SavedState, Simulation};
use crate::lanes::Laned;
use crate::ranks::{Ranks, combined};
use crate::scene::{self, Scene, StartVelocities};
use crate::step::Engine;
use crate::step::build::{loads, particles_with};
use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Lets bodies begin as those of the same names were in another run, whose state without particles is `rest`:
    /// `find` gives this rank some of the particles, and `look` sees the bodies with them. All of it stands on this
    /// rank's share of the scene, of which new bodies keep their particles.
    ///
    /// # Errors
    /// A body of the same name is another one there, or a rank does not find its particles; then all ranks say so, and
    /// have lost particles.
    pub(in crate::step) fn begin_among(
        &mut self,
        (scene, ranks): (&Arc<Scene>, Arc<dyn Ranks>),
        (rest, velocities): (&SavedState, StartVelocities),
        (find, look): (Find, Look),
    ) -> Result<(), NotTakenUp> {
        let nodes = self.carried_nodes(rest, velocities)?;
        let mut state = rest.clone();
        first_problem(&*ranks, fill(&mut state.bodies, find))?;
        check_found(&*ranks, &mut state.bodies)?;
        look(&mut state.bodies);

        let here: HashSet<&str> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
        let there: HashSet<&str> = rest.bodies.iter().map(|body| body.name.as_str()).collect();
        for left_out in state.bodies.iter_mut().filter(|body| !here.contains(body.name.as_str())) {
            (left_out.numbers, left_out.columns) = Default::default();
        }
        let carried = |i: &usize| there.contains(scene.bodies[*i].name.as_str());
        for i in (0..scene.bodies.len()).filter(carried) {
            if let Some(body) = self.state.bodies[i].here_mut() {
                body.particles.truncate(0);
                body.particles.fit();
            }
            self.let_go(i);
        }
        let fresh = |body: usize, numbers: &[u32]| {
            particles_with(scene, body, numbers).map_err(|problem| RestoreError::new(problem.to_string()))
        };
        let carried = self.carried((&state, velocities), Some(&*ranks), &fresh)?;
        drop(state);
        self.find_overlap(&carried, Some(&*ranks))?;
        self.put_in(carried);
        let (census, of_bodies) = self.counted(&*ranks);
        let gone: HashMap<&str, usize> =
            rest.bodies.iter().map(|saved| (saved.name.as_str(), saved.missing)).collect();
        let missing = |body: &scene::Body| gone.get(body.name.as_str()).copied().unwrap_or_default();
        let missing: Vec<usize> = scene.bodies.iter().map(missing).collect();
        self.check_numbers(&*ranks, (&of_bodies, &missing))?;
        self.join_others(ranks, (census, of_bodies));
        self.send_home();
        self.begin_nodes(nodes);
        self.settings.loads = loads(scene, (&self.state.bodies, &self.settings.filled), true);
        self.begin_points();
        self.begin_sums(rest);
        self.rebuild_workspace();
        Ok(())
    }
}

/// Sees bodies with the particles that this rank has found.
pub(in crate::step) type Look<'a> = &'a mut dyn FnMut(&mut [SavedBody]);

/// Looks whether ranks have found the same columns of each body. The state without particles keeps columns of bodies
/// alone that have none on any rank.
///
/// # Errors
/// They have not: all say so.
fn check_found(ranks: &dyn Ranks, bodies: &mut [SavedBody]) -> Result<(), NotTakenUp> {
    // A number that tells its columns, of each body of which there is something.
    let mut own: (Vec<Option<u64>>, bool) = (Vec::new(), true);
    for SavedBody { numbers, columns, .. } in &*bodies {
        let (count, mut hasher) = (numbers.len(), DefaultHasher::new());
        for SavedColumn { name, width, bytes } in columns.iter().filter(|_| count > 0) {
            let each = width.saturating_mul(count).max(1);
            own.1 &= [4, 8].contains(width) && bytes.len().is_multiple_of(each);
            (name, width, bytes.len() / each).hash(&mut hasher);
        }
        own.0.push((count > 0).then(|| hasher.finish()));
    }
    let (found, same) = combined(ranks, &own, |(mut all, mut same), (others, also)| {
        same &= also;
        for (one, other) in all.iter_mut().zip(others) {
            same &= one.is_none() || other.is_none() || *one == other;
            *one = one.or(other);
        }
        (all, same)
    });
    if !same {
        return Err(NotTakenUp::Unfound("its particles have not all the same columns".to_string()));
    }
    let elsewhere =
        bodies.iter_mut().zip(found).filter(|(body, found)| found.is_some() && body.numbers.is_empty());
    elsewhere.for_each(|(body, _)| body.columns.clear());
    Ok(())
}

/// Gives bodies the particles that `find` has of them.
fn fill(bodies: &mut [SavedBody], find: Find) -> Result<(), NotTakenUp> {
    let mut shares: Vec<Vec<_>> = bodies.iter().map(|_| Vec::new()).collect();
    let mut of_none = false;
    let found = find(&mut |some| {
        for share in some {
            match shares.get_mut(share.body) {
                Some(of_body) => of_body.push(share),
                None => of_none = true,
            }
        }
    });
    found.map_err(NotTakenUp::Unfound)?;
    if of_none {
        return Err(NotTakenUp::Unfound("it has particles of no body".to_string()));
    }
    let with_some = bodies.iter_mut().zip(shares).filter(|(_, shares)| !shares.is_empty());
    for (body, shares) in with_some {
        if !body.fill(shares) {
            return Err(NotTakenUp::Unfound("its particles have not all the same columns".to_string()));
        }
    }
    Ok(())
}
