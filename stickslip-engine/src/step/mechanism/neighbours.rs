//! Which surfaces are so near each other that they may touch within the next steps.
//!
//! ```text
//! |c_a - c_b| <= r_a + r_b + s_a + s_b        held as long as   |c - c_0| + w <= s   of each
//! ```
//! c, r: the ball around a surface, c_0 where it was as the list was made, s: the slack that it was given, w: how far
//! from it the step at hand matters (Verlet 1967). The list says where to look and not what is found there: so what is
//! found does not depend on when it was made.

use super::surfaces::{PlacedSurface, RigidSurfaces};
use crate::contact::Rules;
use crate::scene::ContactLaw;
use crate::tensor::{Real, Vector};
use std::collections::HashSet;

/// The slack of a surface over the radius of the ball around it, beside twice of what the step at hand needs.
const SLACK: f64 = 0.2;

/// Pairs of surfaces that are near each other.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    /// In ascending order.
    pub pairs: Vec<Neighbour>,
    /// Where the balls around all surfaces were, and how far each may come [m].
    begun: Vec<([f64; 3], f64)>,
}

/// Two surfaces that may touch soon.
#[derive(Clone, Copy, Debug)]
pub struct Neighbour {
    /// Their ranks among all surfaces, the smaller first.
    pub ranks: [usize; 2],
    /// Whether they resist by their area.
    pub bonds: bool,
}

/// A part of x in which a surface, or an image of it, is.
struct AlongX {
    lower: f64,
    upper: f64,
    /// Rank of the surface among all of them.
    rank: usize,
}

impl Neighbours {
    /// Those among surfaces where they are now.
    pub(super) fn of<T: Real, const D: usize>(
        surfaces: &RigidSurfaces,
        placed: &[PlacedSurface<T, D>],
        rules: &Rules<T>,
    ) -> Self {
        let slack = |one: &PlacedSurface<T, D>| SLACK * one.reach + 2.0 * one.ahead();
        let begun: Vec<_> = placed.iter().map(|one| (one.center, slack(one))).collect();
        let order = along_x(surfaces, placed, &begun);
        let (mut pairs, mut seen) = (Vec::new(), HashSet::new());
        for (rank, one) in order.iter().enumerate() {
            for other in order[rank + 1..].iter().take_while(|other| other.lower <= one.upper) {
                let ranks = [one.rank.min(other.rank), one.rank.max(other.rank)];
                let [a, b] = ranks.map(|rank| &placed[rank]);
                let free = [a, b].iter().any(|placed| placed.motion.as_free().is_some());
                let reach: f64 = ranks.iter().map(|&rank| placed[rank].reach + begun[rank].1).sum();
                let away = Vector(surfaces.nearest([a, b]));
                let off = Vector(a.center) - Vector(b.center) - away;
                if ranks[0] == ranks[1]
                    || !free
                    || (0..D).map(|k| off[k] * off[k]).sum::<f64>() > reach * reach
                {
                    continue;
                }
                let bodies = [a.index(), b.index()];
                let rule = rules.rule(rules.number(bodies[0], bodies[1]));
                // Where there are images, a pair may be met twice.
                let mut met = || surfaces.periods[0] > 0.0 && !seen.insert(ranks);
                if !surfaces.joined.contains(&bodies) && rule.law != ContactLaw::None && !met() {
                    pairs.push(Neighbour { ranks, bonds: rule.friction.bonds() });
                }
            }
        }
        pairs.sort_unstable_by_key(|pair: &Neighbour| pair.ranks);
        Neighbours { pairs, begun }
    }

    /// Whether all that may touch in the step is still among them.
    pub(super) fn hold<T, const D: usize>(&self, placed: &[PlacedSurface<T, D>]) -> bool {
        let near = |(one, (begun, slack)): (&PlacedSurface<T, D>, &([f64; 3], f64))| {
            (Vector(one.center) - Vector(*begun)).norm() + one.ahead() <= *slack
        };
        self.begun.len() == placed.len() && placed.iter().zip(&self.begun).all(near)
    }
}

/// The parts of x that surfaces with their slack and, across its faces, their images take, in ascending order of where
/// they begin.
fn along_x<T: Real, const D: usize>(
    surfaces: &RigidSurfaces,
    placed: &[PlacedSurface<T, D>],
    begun: &[([f64; 3], f64)],
) -> Vec<AlongX> {
    let (period, corner) = (surfaces.periods[0], surfaces.corner[0]);
    let mut all = Vec::with_capacity(placed.len());
    for (rank, (surface, (center, slack))) in placed.iter().zip(begun).enumerate() {
        let half = surface.reach + slack;
        let part = |x: f64| AlongX { lower: x - half, upper: x + half, rank };
        let x = center[0];
        if period == 0.0 || !half.is_finite() {
            all.push(part(x));
        } else if surface.body.whole.is_joined(0) {
            all.push(AlongX { lower: f64::NEG_INFINITY, upper: f64::INFINITY, rank });
        } else {
            let x = corner + (x - corner).rem_euclid(period);
            all.push(part(x));
            all.extend((x - half < corner).then(|| part(x + period)));
            all.extend((x + half > corner + period).then(|| part(x - period)));
        }
    }
    all.sort_by(|a, b| a.lower.total_cmp(&b.lower));
    all
}
