//! The state before a step, kept so that a step that fails can be taken again.

use super::Engine;
use super::state::State;
use crate::body::Body;
use crate::lanes::Laned;
use crate::part::PartPoint;
use crate::tensor::Real;
use crate::threads::each;
use stickslip_reference::contact::Neighbours;

impl<T: Real, const D: usize> State<T, D> {
    /// Becomes a copy of another state of the same simulation, in the memory that is there.
    fn become_copy_of(&mut self, other: &Self) {
        // Each field by name: a new one cannot be forgotten.
        let &State {
            ref bodies,
            ref unbounded,
            ref references,
            ref contact_sums,
            ref loads,
            ref joints,
            ref springs,
            ref touch_forces,
            ref walls,
            ref removed,
            ref written,
            longest_rigid,
            damping,
            impacts,
            gravity_work,
            relaxation,
            signal,
            time,
            steps,
            phase,
        } = other;
        each(&mut self.bodies, 1, |i, body| match (body.here_mut(), &bodies[i]) {
            (Some(body), Body::Here(other)) => {
                body.particles.become_copy_of(&other.particles);
                body.motion.clone_from(&other.motion);
            }
            (_, other) => body.clone_from(other),
        });
        self.unbounded.clone_from(unbounded);
        self.references.clone_from(references);
        self.contact_sums.clone_from(contact_sums);
        self.loads.clone_from(loads);
        self.joints.clone_from(joints);
        self.springs.clone_from(springs);
        self.touch_forces.clone_from(touch_forces);
        self.walls.clone_from(walls);
        self.removed.clone_from(removed);
        self.written.clone_from(written);
        (self.longest_rigid, self.damping, self.relaxation) = (longest_rigid, damping, relaxation);
        (self.impacts, self.gravity_work, self.signal) = (impacts, gravity_work, signal);
        (self.time, self.steps, self.phase) = (time, steps, phase);
    }
}

/// The state before a step.
pub(super) struct Held<T, const D: usize> {
    state: State<T, D>,
    /// Where ranks share particles, of each load the points that are here: they go with these.
    points: Vec<Vec<PartPoint>>,
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Copies the state.
    pub(super) fn hold_state(&mut self) {
        let loads = self.settings.loads.iter().filter(|_| self.among.is_some());
        match &mut self.held {
            Some(held) => {
                held.state.become_copy_of(&self.state);
                held.points.iter_mut().zip(loads).for_each(|(points, load)| points.clone_from(&load.points));
            }
            None => {
                let points = loads.map(|load| load.points.clone()).collect();
                self.held = Some(Held { state: self.state.clone(), points });
            }
        }
    }

    /// Goes back to the copy, if there is one.
    pub(super) fn take_back_state(&mut self) -> bool {
        let Some(held) = &self.held else { return false };
        self.state.become_copy_of(&held.state);
        self.workspace.neighbours = Neighbours::default();
        for (load, points) in self.settings.loads.iter_mut().zip(&held.points) {
            load.points.clone_from(points);
        }
        true
    }
}
