//! Glued bodies interpolate as one.

use super::Engine;
use crate::lanes::Laned;
use crate::scene::ContactLaw;
use crate::tensor::Vector;

impl<T: Laned, const D: usize> Engine<T, D> {
    /// One interpolated velocity for deformable bodies that are glued at a node.
    ///
    /// ```text
    /// v_a = v_a^0 = sum_b p_b / sum_b m_b   over the bodies b that glue joins with a at the node
    /// ```
    /// A particle takes what changes at a node after interpolation, v - v^0. With v^0 of the part alone it would be
    /// drawn toward the velocity of the whole in each step, which damps; as one body the parts' particles would not be.
    pub(super) fn join_glued_bodies(&mut self) {
        if !self.settings.rules.uses(ContactLaw::Glued) {
            return;
        }
        let groups = &mut self.workspace.groups;
        for part in self.workspace.survey.parts() {
            for site in &part.sites {
                groups.clear();
                groups.extend(site.sides.clone());
                for encounter in &part.encounters[site.encounters.clone()] {
                    let bodies = encounter.sides.map(|side| part.sides[side].body);
                    let glued = self.settings.rules.rule(encounter.rule).law == ContactLaw::Glued;
                    if glued && bodies.iter().all(|&body| !self.state.bodies[body].is_rigid()) {
                        let [a, b] = encounter.sides.map(|side| groups[side - site.sides.start]);
                        groups.iter_mut().filter(|group| **group == b).for_each(|group| *group = a);
                    }
                }
                for first in site.sides.clone() {
                    let members =
                        || groups.iter().zip(site.sides.clone()).filter(|(group, _)| **group == first);
                    if members().count() < 2 {
                        continue;
                    }
                    let (mut mass, mut velocity, mut start) = (T::ZERO, Vector::ZERO, Vector::ZERO);
                    for (_, side) in members() {
                        let node = &self.workspace.field.nodes[part.sides[side].index];
                        mass += node.mass;
                        velocity += node.velocity * node.mass;
                        start += node.start * node.mass;
                    }
                    for (_, side) in members() {
                        let node = &mut self.workspace.field.nodes[part.sides[side].index];
                        (node.velocity, node.start) = (velocity / mass, start / mass);
                    }
                }
            }
        }
    }
}
