//! One number for all particles of a state.

use crate::door::{SavedState, Simulation};
use crate::scene::Scene;
use sha2::{Digest, Sha256};
use std::iter::{Enumerate, Peekable};

/// A SHA-256 of the particles of a state, in hexadecimal: of each body its name, of each column its name and each entry
/// of the particles in the order of their numbers, then time and steps. Where particles lie in memory does not enter.
pub fn state_sum(state: &SavedState) -> String {
    let mut sum = StateSum::new(state.bodies.iter().map(|body| &body.name[..]));
    for (number, body) in state.bodies.iter().enumerate() {
        let mut order: Vec<u32> = (0..body.numbers.len() as u32).collect();
        order.sort_unstable_by_key(|&place| body.numbers[place as usize]);
        for column in &body.columns {
            sum.add(number, column.name.as_bytes());
            column.sorted_lines(&order).for_each(|line| sum.add(number, &line));
        }
    }
    sum.finish(state.time, state.steps)
}

/// The [`state_sum`] of a simulation of a scene as it is now, for which no more than one column is copied at a time, or
/// where ranks share it a part of the particles; none of a simulation that has no state as data.
pub fn present_state_sum(scene: &Scene, simulation: &dyn Simulation) -> Option<String> {
    let mut sum = StateSum::new(scene.bodies.iter().map(|body| &body.name[..]));
    let has_state = simulation.visit_bytes(0..scene.bodies.len(), &mut |body, bytes| sum.add(body, bytes));
    has_state.then(|| sum.finish(simulation.time(), simulation.steps()))
}

/// The sum of a state of bodies with these names, whose bytes come one body after the other.
pub(super) struct StateSum<'a, I: Iterator<Item = &'a str>> {
    names: Peekable<Enumerate<I>>,
    sum: Sha256,
}

impl<'a, I: Iterator<Item = &'a str>> StateSum<'a, I> {
    pub(super) fn new(names: I) -> Self {
        StateSum { names: names.enumerate().peekable(), sum: Sha256::new() }
    }

    /// Adds bytes of a body, which may be several.
    pub(super) fn add(&mut self, body: usize, bytes: &[u8]) {
        while let Some((_, name)) = self.names.next_if(|(number, _)| *number <= body) {
            self.sum.update(name);
        }
        self.sum.update(bytes);
    }

    /// The sum, in hexadecimal.
    pub(super) fn finish(mut self, time: f64, steps: u64) -> String {
        self.names.for_each(|(_, name)| self.sum.update(name));
        self.sum.update(time.to_le_bytes());
        self.sum.update(steps.to_le_bytes());
        self.sum.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}
