//! Springs between bodies on grids of their own, or such a body and a rigid one whose motion is prescribed: those of
//! `../springs.rs`, on nodes that persist.
//!
//! ```text
//! g_I = +-e sum_s (a_s/a) N_I(X_s)        v_I += dt f g_I / M_I
//! ```

use super::super::springs::{Line, SpringStep, along, direction};
use crate::body::Body;
use crate::load::SpringPoints;
use crate::tensor::Vector;
use stickslip_reference::contact::Deforming;
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

/// What a spring does in a step of `dt` [s], after all else that acts on the nodes; `grown` is by how much it is longer
/// than at the start [m]. The bodies of its ends are those of these places; `None` is rigid.
pub fn pull<T, const D: usize>(
    (spring, grown): (&SpringPoints, f64),
    places: [Option<usize>; 2],
    (all, bodies): (&[Body<T, D>], &mut [Deforming<'_, D>]),
    dt: f64,
) -> SpringStep {
    let motion = |side: usize| all[spring.ends[side].body].motion.as_deref().expect("no other body deforms");
    let centers = [0, 1].map(|side| match places[side] {
        Some(place) => center(spring, side, bodies[place].interior),
        None => motion(side).pose().now(spring.ends[side].center),
    });
    let Some(direction) = direction(&Some(centers)) else { return SpringStep::default() };
    let line = Line { centers, direction };
    let (mut rate, mut yields, mut driven) = (0.0, 0.0, 0.0);
    let mut pulls: [Vec<Vector<f64, D>>; 2] = Default::default();
    for side in 0..2 {
        let along = along(line.direction, side);
        let Some(place) = places[side] else {
            let speed = Vector(motion(side).velocity_at(line.centers[side])).dot(along);
            (rate, driven) = (rate + speed, driven + dt * speed);
            continue;
        };
        let (nodes, end) = (&*bodies[place].interior, &spring.ends[side]);
        let pull = &mut pulls[side];
        pull.resize(nodes.masses.len(), Vector::ZERO);
        for point in &end.points {
            let weights = nodes.form.weights(Vector::of(point.position));
            let share = Vector::<f64, D>::of(along.0) * (point.measure / end.measure);
            weights.each(|k, value, _| pull[weights.node + nodes.form.offsets[k] as usize] += share * value);
        }
        nodes.form.gather(pull);
        for ((pull, velocity), mass) in pull.iter().zip(&nodes.velocities).zip(&nodes.masses) {
            if *mass > 0.0 {
                rate += pull.dot(*velocity);
                yields += pull.dot(*pull) / mass;
            }
        }
    }
    let softer = 1.0 / (1.0 + dt * (dt * spring.stiffness + spring.dashpot) * yields);
    let stretch = spring.drawn + grown - spring.rest;
    let force = -(spring.stiffness * stretch + spring.dashpot * rate) * softer;
    for (pull, place) in pulls.iter().zip(places) {
        let Some(place) = place else { continue };
        let nodes = &mut *bodies[place].interior;
        for ((pull, velocity), mass) in pull.iter().zip(&mut nodes.velocities).zip(&nodes.masses) {
            if *mass > 0.0 {
                *velocity += *pull * (dt * force / mass);
            }
        }
        nodes.follow();
    }
    SpringStep { direction: line.direction.0, force, stiffness: spring.stiffness * softer, driven, gone: 0.0 }
}
