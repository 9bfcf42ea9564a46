//! Springs between bodies on grids of their own, or such a body and a rigid one: those of `../springs.rs`, on nodes
//! that persist.
//!
//! ```text
//! g_I = +-e sum_s (a_s/a) N_I(X_s)        v_I += dt f g_I / M_I
//! ```

use super::super::Engine;
use super::super::springs::{SpringStep, along, direction};
use crate::lanes::Laned;
use crate::load::SpringPoints;
use crate::part::PartPoints;
use crate::tensor::Vector;
use stickslip_reference::interior::Interior;

/// Mean place of the points of an end of a spring [m].
pub fn center<const D: usize>(spring: &SpringPoints, side: usize, nodes: &Interior<D>) -> [f64; 3] {
    let end = &spring.ends[side];
    let of_point = |point: &crate::part::PartPoint| {
        let weights = nodes.form.weights(Vector::of(point.position));
        nodes.at(&weights, &nodes.places) * (point.measure / end.measure)
    };
    end.points.iter().map(of_point).sum::<Vector<f64, D>>().space()
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// What a spring does in a step of `dt` [s], after all else that acts on the nodes. The bodies of its ends are
    /// those of these places; `None` is rigid.
    pub(in super::super) fn pull_nodes(
        &mut self,
        number: usize,
        places: [Option<usize>; 2],
        dt: f64,
    ) -> SpringStep {
        let (spring, grown) = (&self.settings.springs[number], self.state.springs[number].way);
        let nodes = &self.state.references.nodes;
        let motion = |side: usize| {
            self.state.bodies[spring.ends[side].body].motion.as_deref().expect("no other body deforms")
        };
        let centers = [0, 1].map(|side| match places[side] {
            Some(place) => center(spring, side, &nodes[place]),
            None => motion(side).pose().now(spring.ends[side].center),
        });
        let Some(direction) = direction(&Some(centers)) else { return SpringStep::default() };
        let (mut rate, mut yields, mut driven) = (0.0, 0.0, 0.0);
        let mut pulls: [Vec<Vector<f64, D>>; 2] = Default::default();
        for side in 0..2 {
            let along = along(direction, side);
            let Some(place) = places[side] else {
                let motion = motion(side);
                let speed = Vector(motion.velocity_at(centers[side])).dot(along);
                rate += speed;
                if motion.as_free().is_some() {
                    let arm = (Vector(centers[side]) - Vector(motion.center)).0;
                    yields += self.workspace.mechanism.yields(spring.ends[side].body, arm, along.0);
                } else {
                    driven += dt * speed;
                }
                continue;
            };
            let nodes = &nodes[place];
            pulls[side] = pull_of(&spring.ends[side], along, nodes);
            for ((pull, velocity), mass) in pulls[side].iter().zip(&nodes.velocities).zip(&nodes.masses) {
                if *mass > 0.0 {
                    rate += pull.dot(*velocity);
                    yields += pull.dot(*pull) / mass;
                }
            }
        }
        let softer = 1.0 / (1.0 + dt * (dt * spring.stiffness + spring.dashpot) * yields);
        let stretch = spring.drawn + grown - spring.rest;
        let force = -(spring.stiffness * stretch + spring.dashpot * rate) * softer;
        for (side, (pull, place)) in pulls.iter().zip(places).enumerate() {
            let Some(place) = place else {
                let (body, impulse) = (spring.ends[side].body, along(direction, side) * (dt * force));
                let push = (centers[side], impulse.0);
                self.workspace.mechanism.push(&mut self.state.bodies, (body, dt), push);
                continue;
            };
            let nodes = &mut self.state.references.nodes[place];
            for ((pull, velocity), mass) in pull.iter().zip(&mut nodes.velocities).zip(&nodes.masses) {
                if *mass > 0.0 {
                    *velocity += *pull * (dt * force / mass);
                }
            }
            nodes.follow_velocities();
        }
        SpringStep { direction: direction.0, force, stiffness: spring.stiffness * softer, driven, gone: 0.0 }
    }
}

/// g_I of an end that is pulled along a direction.
fn pull_of<const D: usize>(
    end: &PartPoints,
    along: Vector<f64, 3>,
    nodes: &Interior<D>,
) -> Vec<Vector<f64, D>> {
    let mut pull = vec![Vector::ZERO; nodes.masses.len()];
    for point in &end.points {
        let weights = nodes.form.weights(Vector::of(point.position));
        let share = Vector::<f64, D>::of(along.0) * (point.measure / end.measure);
        weights.each(|k, value, _| pull[weights.node + nodes.form.offsets[k] as usize] += share * value);
    }
    nodes.form.gather(&mut pull);
    pull
}
