//! Bodies that meet themselves: the grid joins their parts before they touch, and lets none of them part.

use super::{Check, CheckInputs, Finding, place};
use crate::observe::{Memory, OutputError, counts, meeting};
use crate::scene::{HealthCheck, Scene};

/// Looks for parts of one body that were far apart before it deformed and share nodes now.
#[derive(Default)]
pub(super) struct SelfContactCheck {
    looks: u64,
    /// How many particles there were at the first look.
    particles: Option<usize>,
    /// Bodies that have been told of.
    known: Vec<bool>,
}

/// Cells so wide that particles in one of them share nodes, over those of the grid.
const SIDE: f64 = 1.5;
/// Cells that parts are apart at the start, at least: more than deformation varies over a cell, where stress resists
/// every error of it, and where it does not, as in plastic flow.
const APART: [f64; 2] = [1.5, 5.0];
/// Particles up to which each look looks; of more, one in so many.
const FEW: usize = 50_000;
const SELDOM: u64 = 8;

impl Check for SelfContactCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::SelfContact
    }

    fn advice(&self, _: &Scene) -> &'static str {
        "they are pushed up to a cell early, and stick: take interior = \"reference\" for bodies that stay whole, make \
         bodies of the parts that meet, or take smaller cells"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        self.known.resize(look.bodies.len(), false);
        let turn = self.looks;
        self.looks += 1;
        let all = *self.particles.get_or_insert_with(|| {
            let free: Vec<usize> = look.on_grid().collect();
            counts(look.simulation, &free).into_iter().map(|(count, _)| count).sum()
        });
        if all > FEW && !turn.is_multiple_of(SELDOM) {
            return Vec::new();
        }
        let cell = look.scene.discretization.cell;
        let mut findings = Vec::new();
        for body in look.on_grid().filter(|&body| !self.known[body]).collect::<Vec<_>>() {
            let material = &look.scene.materials[look.scene.bodies[body].material];
            let apart = APART[usize::from(!material.law.trusts_deformation())] * cell;
            let Some(found) = meeting(look.simulation, body, (SIDE * cell, look.scene.dimension.axes()))
                .filter(|met| met.apart > apart)
            else {
                continue;
            };
            self.known[body] = true;
            let message = format!(
                "`{}` meets itself near {}: parts that were {:.3e} m apart share nodes of the grid",
                look.scene.bodies[body].name,
                place(found.place),
                found.apart
            );
            let worst = found.apart / cell;
            findings.push(Finding { body: Some(body), position: Some(found.place), worst, message });
        }
        findings
    }

    fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("looks", &mut self.looks)?;
        memory.keep("known", &mut self.known)?;
        Ok(())
    }
}
