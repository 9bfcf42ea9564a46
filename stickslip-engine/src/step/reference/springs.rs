//! Ends of springs on bodies with grids of their own: those of `../springs.rs`, on nodes that persist.
//!
//! ```text
//! g_I = +-e sum_s (a_s/a) N_I(X_s)        v_I += dt f g_I / M_I
//! ```

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

/// g_I of an end that is pulled along a direction.
pub fn pull_of<const D: usize>(
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

/// How fast an end moves along the spring [m/s], and how much it yields to a force there [1/kg].
pub fn feel<const D: usize>(nodes: &Interior<D>, pull: &[Vector<f64, D>]) -> [f64; 2] {
    let (mut rate, mut yields) = (0.0, 0.0);
    for ((pull, velocity), &mass) in pull.iter().zip(&nodes.velocities).zip(&nodes.masses) {
        if mass > 0.0 {
            rate += pull.dot(*velocity);
            yields += pull.dot(*pull) / mass;
        }
    }
    [rate, yields]
}

/// v_I += dt f g_I / M_I, by an impulse dt f [N s].
pub fn push<const D: usize>(nodes: &mut Interior<D>, pull: &[Vector<f64, D>], impulse: f64) {
    for ((pull, velocity), &mass) in pull.iter().zip(&mut nodes.velocities).zip(&nodes.masses) {
        if mass > 0.0 {
            *velocity += *pull * (impulse / mass);
        }
    }
    nodes.follow_velocities();
}
