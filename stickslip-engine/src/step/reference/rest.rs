//! How far bodies on grids of their own are from rest, and what slows them down.
//!
//! Dynamic relaxation slows all of them by a viscous force, nearly critical for the motion that they have:
//!
//! ```text
//! f = -2 z w M v,   z = 0.9
//! ```
//! with Rayleigh's quotient w^2 of the last step (Underwood 1983, Dynamic relaxation, in Computational Methods for
//! Transient Analysis; Oakley & Knight 1995, Comput. Methods Appl. Mech. Eng. 126). What is fast dies out first, and w
//! falls to the frequency of the slowest swing, which then comes to rest in the fewest steps: a little below critical
//! damping it passes the state at rest by a thousandth.

use super::super::Engine;
use super::super::account::NodeTotals;
use crate::damping::NodeDamping;
use crate::exact::ExactSum;
use crate::lanes::Laned;
use crate::tensor::Vector;
use stickslip_reference::contact::Deforming;
use stickslip_reference::interior::Interior;

/// z: over critical damping. Linear models of cantilevers and hanging bars take a third fewer steps to a residual of
/// 1e-4 than with 1, and fewer than with 0.8.
const DAMPING_RATIO: f64 = 0.9;

/// What nodes have before anything acts on them in a step, of each body.
#[derive(Debug)]
pub(super) struct Begun<const D: usize> {
    /// Velocities [m/s].
    velocities: Vec<Vec<Vector<f64, D>>>,
    /// Forces of the stress [N].
    forces: Vec<Vec<Vector<f64, D>>>,
}

/// What slows bodies down in a step.
#[derive(Debug)]
pub(super) struct Slowing {
    /// Damping that the scene asks for.
    pub damping: NodeDamping<f64>,
    /// What dynamic relaxation adds to it.
    pub relaxing: Relaxing,
    /// How long the step is [s].
    pub dt: f64,
}

/// Rate of the viscous damping by which bodies come to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Relaxing {
    /// That of bodies on the common grid [1/s].
    AsGrid(f64),
    /// By how fast they swing; how long the step before was [s].
    Critical(f64),
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// What slows bodies on grids of their own down in a step of `dt` [s].
    pub(super) fn slowing(&self, dt: f64) -> Slowing {
        Slowing { damping: self.settings.damping.double(), relaxing: self.relaxing(dt), dt }
    }

    fn relaxing(&self, dt: f64) -> Relaxing {
        if self.settings.time.relax.is_some() && self.all_have_grids() {
            Relaxing::Critical(self.state.relaxation.last_step)
        } else {
            Relaxing::AsGrid(self.relaxing_rate(T::of(dt)).f64())
        }
    }
}

impl<const D: usize> Begun<D> {
    pub fn of(nodes: &[Interior<D>]) -> Self {
        Begun {
            velocities: nodes.iter().map(|nodes| nodes.velocities.clone()).collect(),
            forces: nodes.iter().map(gathered_forces).collect(),
        }
    }

    /// Books what is left of the forces on the nodes, and damps the velocities that they give. `accelerations` are
    /// those of the step before, and become those of this one; to the sums goes what is of bodies that are `here`.
    pub fn slow_down(
        &self,
        (bodies, accelerations): (&mut [Deforming<'_, D>], &mut Vec<Vec<Vector<f64, D>>>),
        slowing: &Slowing,
        (sums, here): (&mut [ExactSum; 5], &dyn Fn(usize) -> bool),
    ) {
        let now = self.accelerations(bodies, slowing.dt);
        let rate = match slowing.relaxing {
            Relaxing::AsGrid(rate) => rate,
            Relaxing::Critical(last_step) => {
                2.0 * DAMPING_RATIO * self.frequency(bodies, [accelerations, &now], last_step)
            }
        };
        let damping = slowing.damping.with_viscous(rate);
        for (place, body) in bodies.iter_mut().enumerate() {
            let (nodes, is_here) = (&mut *body.interior, here(body.body));
            for (node, acceleration) in now[place].iter().enumerate() {
                let mass = nodes.masses[node];
                if mass == 0.0 {
                    continue;
                }
                let (start, free) = (self.velocities[place][node], nodes.velocities[node]);
                let left = damping.damped(free, start, slowing.dt);
                nodes.velocities[node] = left;
                if is_here {
                    let unbalanced = *acceleration * mass;
                    let own = totals(mass, [start, free, left], [unbalanced, self.forces[place][node]]);
                    sums.iter_mut().zip(own).for_each(|(sum, own)| sum.add(own));
                }
            }
            nodes.follow_velocities();
        }
        *accelerations = match slowing.relaxing {
            Relaxing::AsGrid(_) => Vec::new(),
            Relaxing::Critical(_) => now,
        };
    }

    /// What all forces gave to the nodes [m/s^2].
    fn accelerations(&self, bodies: &[Deforming<'_, D>], dt: f64) -> Vec<Vec<Vector<f64, D>>> {
        let of_body = |(body, start): (&Deforming<'_, D>, &Vec<Vector<f64, D>>)| {
            let change = |(now, start): (&Vector<f64, D>, &Vector<f64, D>)| (*now - *start) * (1.0 / dt);
            body.interior.velocities.iter().zip(start).map(change).collect()
        };
        bodies.iter().zip(&self.velocities).map(of_body).collect()
    }

    /// Frequency of the motion that the step before was, by Rayleigh's quotient [1/s]:
    ///
    /// ```text
    /// w^2 = v.K v / v.M v = -sum M v.(a - a') / (dt' sum M v.v)        K v dt' = -M (a - a')
    /// ```
    /// v: velocities by which places came from where accelerations were a' to where they are a.
    fn frequency(
        &self,
        bodies: &[Deforming<'_, D>],
        [before, now]: [&[Vec<Vector<f64, D>>]; 2],
        last_step: f64,
    ) -> f64 {
        let (mut stiff, mut inert) = (0.0, 0.0);
        for (((body, velocities), before), now) in bodies.iter().zip(&self.velocities).zip(before).zip(now) {
            for (((mass, v), before), now) in body.interior.masses.iter().zip(velocities).zip(before).zip(now)
            {
                stiff += mass * v.dot(*before - *now);
                inert += mass * v.dot(*v);
            }
        }
        if stiff > 0.0 && inert > 0.0 { (stiff / (inert * last_step)).sqrt() } else { 0.0 }
    }
}

/// Forces of the stress with those on followers.
fn gathered_forces<const D: usize>(nodes: &Interior<D>) -> Vec<Vector<f64, D>> {
    let mut forces = nodes.forces.clone();
    nodes.form.gather(&mut forces);
    forces
}

/// What a node of this mass adds to the sums of a step that it begins, and leaves without and with damping, with these
/// velocities; the forces are the unbalanced one and that of the stress. What stiff supports hold is not unbalanced.
/// Damping takes its impulse times the mean of the velocities that carry the node before and after, as other forces
/// give theirs: so works and energies add up.
fn totals<const D: usize>(
    mass: f64,
    [start, free, left]: [Vector<f64, D>; 3],
    [unbalanced, internal]: [Vector<f64, D>; 2],
) -> NodeTotals {
    [
        unbalanced.norm(),
        internal.norm(),
        (unbalanced - internal).norm(),
        0.5 * mass * start.dot(start),
        0.5 * mass * (free - left).dot(start + left),
    ]
}
