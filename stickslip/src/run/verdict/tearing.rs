//! Numerical fracture: particles that parted beyond the reach of their functions.

use super::{Check, CheckInputs, Finding, minus, place};
use crate::door::TracedParticle;
use crate::observe::{Memory, OutputError, has_near};
use crate::scene::{BasisKind, HealthCheck, Scene};

/// Looks for neighbours that no longer share a node of the grid.
#[derive(Default)]
pub(super) struct TearingCheck {
    /// Where each body tore first [m].
    first: Vec<Option<[f64; 3]>>,
}

/// Pairs whose gap is looked into, the widest first.
const LOOKED_INTO: usize = 16;

impl Check for TearingCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::Tearing
    }

    fn advice(&self, _: &Scene) -> &'static str {
        "no law tears it, the grid lost it: try interior = \"reference\" for bodies that stay whole, more \
         particles_per_side, a smaller load"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        self.first.resize(look.bodies.len(), None);
        let of_body = |body: usize| {
            let tear = tear(look, body)?;
            let position = *self.first[body].get_or_insert(tear.position);
            let name = &look.scene.bodies[body].name;
            let message = format!(
                "`{name}` tears, first at {}: {:.2} % of the neighbours watched are up to {:.2} times as far apart \
                 as the grid joins them",
                place(position),
                100.0 * tear.share,
                tear.excess
            );
            Some(Finding { body: Some(body), position: Some(position), worst: tear.share, message })
        };
        look.on_grid().filter_map(of_body).collect()
    }

    fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("first", &mut self.first)?;
        Ok(())
    }
}

/// What is torn of a body.
struct Tear {
    /// Share of the neighbours that parted.
    share: f64,
    /// Distance of those that are farthest apart over the reach of their functions.
    excess: f64,
    /// The middle between them [m].
    position: [f64; 3],
}

/// Neighbours at the start that are so far apart along an axis that no node need reach both, with nothing between them.
fn tear(look: &CheckInputs, body: usize) -> Option<Tear> {
    let now = &look.particles[body];
    let pairs = &look.neighbours[body].pairs;
    let parted = |&[a, b]: &[u32; 2]| {
        let (a, b) = (&now[a as usize], &now[b as usize]);
        let (apart, reach) = (minus(a.position, b.position), reach(look, a, b));
        let excess = (0..3).map(|i| apart[i].abs() / reach).fold(0.0, f64::max);
        (excess > 1.0).then(|| (excess, middle(a.position, b.position)))
    };
    let mut parted: Vec<(f64, [f64; 3])> = pairs.iter().filter_map(parted).collect();
    if parted.is_empty() {
        return None;
    }
    let count = parted.len();
    parted.sort_by(|a, b| b.0.total_cmp(&a.0));
    parted.truncate(LOOKED_INTO);
    // Neighbours that slid apart by plastic flow have others between them.
    let middles: Vec<[f64; 3]> = parted.iter().map(|(_, middle)| *middle).collect();
    let half = 0.5 * look.scene.discretization.cell;
    let filled = has_near(look.simulation, body, (&middles, half));
    let (excess, position) = parted.into_iter().zip(filled).find(|(_, filled)| !*filled)?.0;
    Some(Tear { share: count as f64 / pairs.len() as f64, excess, position })
}

/// Distance along an axis up to which two particles share a node wherever they lie [m].
fn reach(look: &CheckInputs, a: &TracedParticle, b: &TracedParticle) -> f64 {
    let cell = look.scene.discretization.cell;
    match look.scene.discretization.basis {
        BasisKind::Linear => cell,
        BasisKind::Gimp | BasisKind::Spline | BasisKind::Cubic => cell + a.half_side + b.half_side,
    }
}

fn middle(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| 0.5 * (a[i] + b[i]))
}
