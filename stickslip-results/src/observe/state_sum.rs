//! One number for all particles of a state.

use crate::door::{SavedState, Simulation};
use crate::scene::Scene;
use sha2::{Digest, Sha256};

/// A SHA-256 of the particles of a state, in hexadecimal: of each body its name, of each column its name and each entry
/// of the particles in the order of their numbers, then time and steps. Where particles lie in memory does not enter.
pub fn state_sum(state: &SavedState) -> String {
    let mut sum = StateSum::default();
    for body in &state.bodies {
        sum.add(body.name.as_bytes());
        let mut order: Vec<u32> = (0..body.numbers.len() as u32).collect();
        order.sort_unstable_by_key(|&place| body.numbers[place as usize]);
        for column in &body.columns {
            sum.add(column.name.as_bytes());
            column.sorted_lines(&order).for_each(|line| sum.add(&line));
        }
    }
    sum.finish(state.time, state.steps)
}

/// The [`state_sum`] of a simulation of a scene as it is now, for which no more than one column is copied at a time, or
/// where ranks share it a part of the particles; none of a simulation that has no state as data.
pub fn present_state_sum(scene: &Scene, simulation: &dyn Simulation) -> Option<String> {
    let mut sum = StateSum::default();
    let mut names = scene.bodies.iter().enumerate().peekable();
    let has_state = simulation.visit_bytes(0..scene.bodies.len(), &mut |body, bytes| {
        while let Some((_, begun)) = names.next_if(|(number, _)| *number <= body) {
            sum.add(begun.name.as_bytes());
        }
        sum.add(bytes);
    });
    if !has_state {
        return None;
    }
    names.for_each(|(_, body)| sum.add(body.name.as_bytes()));
    Some(sum.finish(simulation.time(), simulation.steps()))
}

#[derive(Default)]
struct StateSum(Sha256);

impl StateSum {
    fn add(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    fn finish(mut self, time: f64, steps: u64) -> String {
        self.add(&time.to_le_bytes());
        self.add(&steps.to_le_bytes());
        self.0.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}
