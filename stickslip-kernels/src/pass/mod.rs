//! One pass over particles: what it does to each of them, and who does it.

mod group;
pub mod members;
mod naive;
#[cfg(test)]
mod tests;
mod tile;

pub use naive::visit_naively;
pub use tile::visit;

use crate::basis::Basis;
use crate::grid::{Disjoint, Lattice, Node, NodeSums, Sought, Tile, Window};
use crate::lanes::{Machine, Processor};
use crate::matter::Matter;
use crate::particles::Columns;
use crate::scheme::Transfer;
use crate::tensor::{Real, Vector};
use crate::transfer::{Share, filters};
use crate::viscosity::BulkViscosity;
use serde::{Deserialize, Serialize};

/// Who does the work on particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParticleLoop {
    /// Several particles at a time, by the best that the processor has.
    Lanes(Processor),
    /// One particle at a time, by the same code: what finds out what is wrong with whom, and serves processors that
    /// hold no numbers side by side.
    OneLane,
}

/// What a pass does to each particle, in this order: one verb of a recipe may ask for several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verbs {
    /// G2P of u = sum S_i u_i, to be given back to the nodes in the place of v_p, see [`crate::transfer::Xpic`].
    pub smooth: bool,
    /// G2P:  v_p = (1 - a) (v_p + sum S_i (v_i - v_i^0)) + a sum S_i v_i,   a: PIC share, or as else the transfer says.
    pub update_velocity: bool,
    /// G2P:  F = (I + L dt) F,  V = V_0 det F,  sigma = law(F)
    pub update_stress: bool,
    /// With that, spins take their part of the rotation around them, for as many steps as lie between two times, see
    /// [`crate::transfer::Rflip`].
    pub settle: bool,
    /// G2P:  x += dt sum S_i v_i
    pub advect: bool,
    /// P2G: gives this share to the nodes.
    pub scatter: Option<Share>,
}

/// A pass.
#[derive(Clone, Copy, Debug)]
pub struct Pass<T, const D: usize> {
    /// What it does.
    pub verbs: Verbs,
    /// How far the step takes the particles, 0 where it has not begun to [s].
    pub dt: T,
    /// What particles take.
    pub transfer: Transfer,
    /// PIC share.
    pub pic: T,
    /// Bulk viscosity.
    pub viscosity: Option<BulkViscosity<T>>,
    /// Where the nodes are.
    pub lattice: Lattice<T, D>,
    /// Lower and upper corner of the domain [m].
    pub domain: Option<[Vector<T, D>; 2]>,
}

impl<T: Real, const D: usize> Pass<T, D> {
    /// What it takes from the nodes.
    pub fn sought(&self) -> Sought {
        let Verbs { smooth, update_velocity, update_stress, advect, scatter, .. } = self.verbs;
        Sought {
            change: update_velocity,
            integrated: smooth || (update_velocity && self.pic > T::ZERO),
            filtered: update_velocity && filters(self.transfer),
            flow: update_stress || advect || scatter == Some(Share::Dilatation),
        }
    }

    /// Whether it takes anything from the nodes.
    pub fn gathers(&self) -> bool {
        let Verbs { smooth, update_velocity, update_stress, advect, scatter, .. } = self.verbs;
        smooth || update_velocity || update_stress || advect || scatter == Some(Share::Dilatation)
    }
}

/// A particle that a pass cannot go on with.
#[derive(Clone, Copy, Debug)]
pub struct ParticleFault {
    /// Index of the body.
    pub body: usize,
    /// Index of the particle in memory.
    pub particle: usize,
    /// Its number in the body.
    pub number: u32,
    /// What is wrong with it.
    pub kind: FaultKind,
}

/// What there is to say of a fault, wherever the particle is.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct FaultReport {
    /// Index of the body.
    pub body: usize,
    /// Number of the particle in it.
    pub number: u32,
    /// What is wrong with it.
    pub kind: FaultKind,
    /// Where it is [m].
    pub position: [f64; 3],
    /// Determinant of its deformation gradient [-].
    pub determinant: f64,
}

/// What can be wrong with a particle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum FaultKind {
    /// Its deformation gradient has no positive determinant.
    Inverted,
    /// It left the domain.
    Escaped,
    /// No thickness leaves it without stress out of the plane.
    NoThickness,
    /// A value of it is not a finite number.
    NotFinite,
    /// Heat leaves it no size.
    Shrunk,
}

/// What a pass found out.
#[derive(Clone, Copy, Debug)]
pub struct Found<T> {
    /// The first fault by body and number of the particle.
    pub fault: Option<ParticleFault>,
    /// Fastest signal of the particles that it displaced [m/s].
    pub signal: T,
}

impl<T: Real> Found<T> {
    /// Nothing.
    pub const NOTHING: Self = Found { fault: None, signal: T::ZERO };

    /// What two found.
    pub fn and(self, other: Self) -> Self {
        let fault = match (self.fault, other.fault) {
            (Some(a), Some(b)) => Some(if (b.body, b.number) < (a.body, a.number) { b } else { a }),
            (a, b) => a.or(b),
        };
        Found { fault, signal: self.signal.max(other.signal) }
    }
}

/// The particles of a tile and what a pass needs to know of them.
pub struct Visit<'a, T, const D: usize> {
    /// The pass.
    pub pass: &'a Pass<T, D>,
    /// The tile.
    pub tile: &'a Tile<D>,
    /// What its body is made of.
    pub matter: &'a Matter<T>,
    /// The body's particles.
    pub columns: Columns<T, D>,
    /// Their numbers.
    pub numbers: &'a [u32],
    /// Indices of the body's particles, by tile, cell and number.
    pub order: &'a [u32],
    /// Places in the order where the tile's cells begin and end.
    pub cells: &'a [u32],
    /// All nodes.
    pub nodes: &'a Disjoint<'a, Node<T, D>>,
    /// Filtered velocities of the nodes, if there are any.
    pub filtered: &'a [Vector<T, D>],
    /// Means at the nodes, if the body takes them in this pass.
    pub means: &'a [T],
    /// The tile's nodes.
    pub window: &'a mut Window<T, D>,
    /// Where what it scatters is kept, of a tile that other ranks have to do with: it is added to the field later.
    pub kept: Option<&'a mut [NodeSums<T>]>,
    /// The tile that is likely to come next.
    pub next: Option<&'a Tile<D>>,
    /// Which cells have particles that left them, from the lowest bit on.
    pub left: u64,
    /// How many did.
    pub moved: u32,
    /// What it took from the particles' kinetic energy beyond the work of forces [J].
    pub damped: f64,
    /// What it found.
    pub found: Found<T>,
}

impl<T: Real, const D: usize> Visit<'_, T, D> {
    /// Takes note of what is wrong with a particle.
    fn find_fault(&mut self, particle: u32, kind: FaultKind) {
        let (body, particle) = (self.tile.body, particle as usize);
        let fault = ParticleFault { body, particle, number: self.numbers[particle], kind };
        self.found = self.found.and(Found { fault: Some(fault), signal: T::ZERO });
    }

    /// Takes from the field what the pass seeks, and makes room for what it scatters, in a window of so many nodes
    /// along a side.
    ///
    /// # Safety
    /// Nobody may write to the tile's nodes meanwhile.
    #[inline(always)]
    pub unsafe fn open<M: Machine<T>>(&mut self, side: usize) {
        if self.pass.gathers() || !self.means.is_empty() {
            // SAFETY: the caller's.
            unsafe {
                let field = (self.nodes, self.filtered, self.means);
                self.window.load::<M>(field, self.tile, side, self.pass.sought());
            }
        }
        if self.pass.verbs.scatter.is_some() {
            self.window.clear(side);
            self.nodes.fetch(self.tile, side);
        } else if let Some(next) = self.next {
            self.nodes.fetch(next, side);
        }
    }

    /// Adds to the field what particles scattered.
    ///
    /// # Safety
    /// Nobody else may use the tile's nodes meanwhile.
    #[inline(always)]
    pub unsafe fn close<M: Machine<T>>(&mut self, side: usize) {
        if self.pass.verbs.scatter.is_some() {
            match &mut self.kept {
                Some(kept) => kept.copy_from_slice(&self.window.sums[..kept.len()]),
                // SAFETY: the caller's.
                None => unsafe { self.window.add_to::<M>(self.nodes, self.tile, side) },
            }
        }
    }
}

/// Base node of a particle: the first that it reaches along each axis.
pub fn home<T: Real, const D: usize, B: Basis<T>>(
    lattice: &Lattice<T, D>,
    (position, half_width): (Vector<T, D>, T),
) -> [i32; D] {
    let (x, half) = (lattice.cells(position), lattice.seen_half_side(half_width));
    std::array::from_fn(|i| B::reach(x[i], half).floor())
}

/// Whether a position is outside the domain.
pub fn is_outside<T: Real, const D: usize>(
    position: Vector<T, D>,
    domain: Option<[Vector<T, D>; 2]>,
) -> bool {
    domain.is_some_and(|[min, max]| (0..D).any(|i| position[i] < min[i] || position[i] > max[i]))
}
