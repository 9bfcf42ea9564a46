//! From pairs to a whole node: any number of bodies, each pair by its own law.

use super::{Change, Rules, Site, Survey};
use crate::grid::Field;
use crate::scene::ContactLaw;
use crate::tensor::{Real, Vector};
use rayon::prelude::*;

/// What contact did between two bodies at a node in one use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulse<T, const D: usize> {
    /// Indices of the bodies, the first smaller.
    pub bodies: [usize; 2],
    /// Nodes of the bodies in the field.
    pub nodes: [usize; 2],
    /// The impulses on them [N s].
    pub change: Change<T, D>,
    /// Changes of their velocities [m/s].
    pub velocity: [Vector<T, D>; 2],
    /// Work that friction took from the two bodies [J].
    pub friction: T,
    /// Work that a rigid body's prescribed motion did on the other [J].
    pub work: T,
}

/// Sweeps over the pairs of a node until no velocity changes by more than this fraction of the largest.
const TOLERANCE: f64 = 1e-14;
const MAX_SWEEPS: usize = 200;

/// The impulses at every site, ordered by site and pair. `strain_rate` is h/dt [m/s].
///
/// Where more than two bodies meet, each pair's impulse is solved in turn with the others held until none changes
/// (block Gauss-Seidel), so that every pair obeys its own law and momentum is conserved pair by pair.
pub fn solve<T: Real, const D: usize>(
    survey: &Survey<T, D>,
    rules: &Rules<T>,
    field: &Field<T, D>,
    strain_rate: T,
) -> Vec<Impulse<T, D>> {
    (survey.sites.par_iter().with_min_len(64))
        .flat_map_iter(|site| solve_site(survey, rules, site, (field, strain_rate)))
        .collect()
}

fn solve_site<T: Real, const D: usize>(
    survey: &Survey<T, D>,
    rules: &Rules<T>,
    site: &Site<D>,
    (field, strain_rate): (&Field<T, D>, T),
) -> Vec<Impulse<T, D>> {
    let sides = &survey.sides[site.sides.clone()];
    let mut velocity: Vec<Vector<T, D>> = sides.iter().map(|side| field.nodes[side.index].velocity).collect();
    let encounters = &survey.encounters[site.encounters.clone()];
    let mut impulses: Vec<Impulse<T, D>> = (encounters.iter())
        .map(|encounter| {
            let [a, b] = encounter.sides.map(|side| &survey.sides[side]);
            Impulse {
                bodies: [a.body, b.body],
                nodes: [a.index, b.index],
                change: Change::NONE,
                velocity: [Vector::ZERO; 2],
                friction: T::ZERO,
                work: T::ZERO,
            }
        })
        .collect();
    for _ in 0..MAX_SWEEPS {
        let (mut largest, mut moved) = (T::ZERO, T::ZERO);
        for (encounter, impulse) in encounters.iter().zip(&mut impulses) {
            let pair = survey.pair(encounter, rules, strain_rate);
            let places = encounter.sides.map(|side| side - site.sides.start);
            let old = impulse.velocity;
            let free = [0, 1].map(|i| velocity[places[i]] - old[i]);
            impulse.change = pair.change(free);
            impulse.work = T::ZERO;
            for i in 0..2 {
                let inverse_mass = pair.surfaces[i].inverse_mass;
                let new = impulse.change.impulse[i] * inverse_mass;
                impulse.velocity[i] = new;
                velocity[places[i]] = free[i] + new;
                moved = moved.max((new - old[i]).norm());
                largest = largest.max(new.norm());
                if inverse_mass == T::ZERO {
                    impulse.work += impulse.change.impulse[1 - i].dot(free[i]);
                }
            }
            let slip = velocity[places[0]] - velocity[places[1]];
            impulse.friction = match pair.rule.law {
                ContactLaw::Glued => T::ZERO,
                _ => -impulse.change.tangential.dot(slip),
            };
        }
        if encounters.len() == 1 || moved <= T::of(TOLERANCE.max(T::EPSILON.f64() * 4.0)) * largest {
            break;
        }
    }
    impulses
}
