//! What a step has to move and to compute at least, whatever the program:
//! what results are held against the machine's limits with.
//!
//! Numbers of a particle that each pass over all particles reads and writes, in space
//! (x, v: 3; m, V: 1; F: 9; sigma: 6):
//!
//! ```text
//! last           P2G x v m V sigma | G2P, stress, advection: x v m F -> x v V F sigma           14 + 16 + 22
//! first          P2G x v m | stress x m F -> V F sigma | P2G x V sigma | x v -> x v             7 + 29 + 10 + 12
//! modified-last  P2G x v m V sigma | x v -> v | P2G x v m | stress x m F -> V F sigma | x -> x  14 + 9 + 7 + 29 + 6
//! ```
//! A node's 26 numbers (mass, momentum and force written and read, two velocities written and read) are shared by the
//! cell's particles. A multiply-add is counted for each product with a sum: 37 for each node that a particle reaches
//! (weights 3, gradient 6, mass 1, momentum 3, force 9, velocity and its change 6, velocity gradient 9) and 150 for the
//! particle itself (F, its determinant, the law).
//!
//! On a grid of its own a neo-Hookean particle keeps nothing that a step reads or writes: all is at the nodes (x and v
//! read and written, f written and read, m read: 19 numbers of a node, shared by the cell's particles). Products of
//! functions are summed axis by axis: 108 multiply-adds of a particle for F, and 108 for the forces.

use super::problems::BenchScheme;

/// Particles a cell of every problem here.
pub const PARTICLES_PER_CELL: f64 = 8.0;
const NODE_NUMBERS: f64 = 26.0;
const NUMBERS_OF_OWN_NODE: f64 = 19.0;
const ADDS_PER_NODE: f64 = 37.0;
const ADDS_ON_OWN_GRID: f64 = 216.0;
const ADDS_PER_PARTICLE: f64 = 150.0;

impl BenchScheme {
    /// Bytes of a number.
    pub fn number_bytes(&self) -> f64 {
        if self.number() == "f32" { 4.0 } else { 8.0 }
    }

    /// Bytes that a particle and a step must move between memory and core.
    pub fn bytes(&self) -> f64 {
        let (particle, node) = match (self.is_reference(), self.stress_update) {
            (true, _) => (0.0, NUMBERS_OF_OWN_NODE),
            (_, "last") => (52.0, NODE_NUMBERS),
            (_, "first") => (58.0, NODE_NUMBERS),
            _ => (65.0, NODE_NUMBERS),
        };
        self.number_bytes() * (particle + node / PARTICLES_PER_CELL)
    }

    /// Multiply-adds of a particle and a step.
    pub fn multiply_adds(&self) -> f64 {
        // GIMP with two particles a side of a cell: 2.5 nodes along an axis in the mean; 3 are computed.
        let nodes = if self.basis == "linear" { 8.0 } else { 27.0 };
        let at_nodes = if self.is_reference() { ADDS_ON_OWN_GRID } else { ADDS_PER_NODE * nodes };
        at_nodes + ADDS_PER_PARTICLE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_model_is_what_its_text_says() {
        let linear = BenchScheme { stress_update: "last", ..BenchScheme::default() };
        assert_eq!(linear.bytes(), 8.0 * 55.25);
        assert_eq!(linear.multiply_adds(), 446.0);
        let single = BenchScheme { precision: "single", ..linear };
        assert_eq!(single.bytes(), 0.5 * linear.bytes());
        let safest = BenchScheme { stress_update: "modified-last", ..linear };
        assert_eq!(safest.bytes() - linear.bytes(), 13.0 * 8.0);
        let own = BenchScheme::reference();
        assert_eq!((own.bytes(), own.multiply_adds()), (19.0, 366.0));
    }
}
