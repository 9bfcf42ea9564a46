//! Energy that became noise and was damped, though the scene asks for no damping; and bodies that move on and on while
//! local damping, which is for bodies at rest, slows them.

use super::{Check, CheckInputs, Finding, asks_for_damping, exceeds, norm, on_grid, share};
use crate::geometry::Bounds;
use crate::observe::{Memory, OutputError};
use crate::scene::{BasisKind, Damping, HealthCheck, Scene};
use crate::transfer::pic_share;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Holds what damping took from bodies that deform against the bound on it; what rigid bodies lose in impacts, which is
/// booked with it, became no noise. `rflip` takes noise from particles' own rotation;
/// what it takes came from motion that the grid did not carry on, so the ledger closes and the swing is gone.
#[derive(Default)]
pub(super) struct NoiseCheck {
    moved: Vec<Moved>,
    /// Largest kinetic energy so far [J].
    fastest: f64,
}

/// How far a body has moved.
#[derive(Clone, Copy, Default, Serialize, Deserialize)]
struct Moved {
    /// Time of the last look [s].
    time: f64,
    /// Its way so far over its size, and its turns [-].
    sizes: f64,
    turns: f64,
}

/// A body that has come so many times its size, or turned so often, flows or rolls: what settles does not.
const FLOWS: f64 = 3.0;
const ROLLS: f64 = 0.25;
/// Kinetic energy over the largest so far: below, what moved has come to rest.
const MOVES: f64 = 0.1;

impl Check for NoiseCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::Noise
    }

    fn advice(&self, scene: &Scene) -> &'static str {
        if scene.damping.local > 0.0 {
            return "local damping is for bodies that come to rest: leave it out, or take [damping] viscous of a known \
                    rate";
        }
        if on_grid(scene).next().is_none() {
            return "what moves loses its motion to it: try smaller cells; see the column `damping` of energy.csv";
        }
        match scene.discretization.basis {
            BasisKind::Gimp | BasisKind::Linear | BasisKind::Cubic => {
                "what bends, twists, spins or rolls loses its motion to it: try interior = \"reference\" for bodies \
                 that stay whole, smaller cells; see the column `damping` of energy.csv"
            }
            BasisKind::Spline => {
                "what bends, twists, spins or rolls loses its motion to it: try interior = \"reference\" for bodies \
                 that stay whole, smaller cells, space.basis = \"gimp\", by which what rolls or swings loses less than \
                 by splines; see the column `damping` of energy.csv"
            }
        }
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let damping = look.ledger.damping - look.ledger.impacts;
        let scale = look.balance.scale;
        let part = share(damping, scale);
        let is_large = exceeds(part.abs(), look.bound(self.kind()));
        let Damping { viscous, local, .. } = look.scene.damping;
        if local > 0.0 && viscous == 0.0 && look.scene.time.relax.is_none() {
            return self.goes_on(look).filter(|_| is_large).map_or(Vec::new(), |body| {
                let message = format!(
                    "`{}` moves on and on, and local damping slows it: it took {damping:.2e} J, {:.1} % of the most \
                     that there was; it acts wherever a velocity changes, in bodies that turn or flow all the time",
                    look.scene.bodies[body].name,
                    100.0 * part
                );
                vec![Finding { body: Some(body), position: None, worst: part, message }]
            });
        }
        let time = &look.scene.time;
        let takes_velocities = pic_share(time.transfer, time.pic_share) > 0.0;
        let wanted = takes_velocities || asks_for_damping(look.scene);
        if wanted || !is_large {
            return Vec::new();
        }
        let message = format!(
            "energy becomes noise: damping, which the scene does not ask for, {} {:.2e} J, {:.1} % of the most that \
             there was",
            if damping > 0.0 { "took" } else { "gave" },
            damping.abs(),
            100.0 * part.abs()
        );
        vec![Finding { body: None, position: None, worst: part, message }]
    }

    fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("moved", &mut self.moved)?;
        memory.keep("fastest", &mut self.fastest)?;
        Ok(())
    }
}

impl NoiseCheck {
    /// The body that has moved furthest of those that flow or roll, if one does and they have not come to rest.
    fn goes_on(&mut self, look: &CheckInputs) -> Option<usize> {
        self.fastest = self.fastest.max(look.ledger.kinetic);
        let moves = look.ledger.kinetic > MOVES * self.fastest;
        let time = look.simulation.time();
        let axes = look.scene.dimension.axes();
        self.moved.resize_with(look.bodies.len(), || Moved { time, ..Moved::default() });
        for body in look.free() {
            let (moved, state) = (&mut self.moved[body], &look.bodies[body]);
            let bounds = look.scene.bodies[body].shape.bounds(axes).filter(Bounds::is_finite);
            let size = bounds.map_or(f64::INFINITY, |bounds| norm(bounds.size()));
            let elapsed = time - std::mem::replace(&mut moved.time, time);
            moved.turns += norm(state.spin) * elapsed / TAU;
            moved.sizes += norm(state.velocity) * elapsed / size;
        }
        let far = |body: &usize| (self.moved[*body].sizes / FLOWS).max(self.moved[*body].turns / ROLLS);
        look.free().filter(|body| moves && far(body) > 1.0).max_by(|a, b| far(a).total_cmp(&far(b)))
    }
}
