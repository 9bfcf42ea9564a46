//! What of a step knows the shape functions: one table of functions, chosen when a simulation is built.
//!
//! Passes call it once a tile, contact detection once a body and block, loads once a point. All else of the engine is
//! compiled once for each dimension and precision, not for each basis as well.

use crate::basis::{Basis, Cpdi, Cubic, Gimp, Linear};
use crate::contact::{SumAround, sum_around};
use crate::grid::{Lattice, addressable};
use crate::lanes::Laned;
use crate::load::{NodesOf, nodes_of};
use crate::scene::BasisKind;
use crate::step::{ParticleLoop, Visit, visit};
use crate::tensor::{Real, Vector};

/// Position of a particle and half the sides of its box [m].
pub type Place<T, const D: usize> = (Vector<T, D>, Vector<T, D>);

/// The functions of one basis.
pub struct Kernels<T: 'static, const D: usize> {
    /// Nodes that a particle reaches along an axis.
    pub width: usize,
    /// What a particle's own box adds to its spread over the nodes, see [`Basis::BOX_SPREAD`].
    pub box_spread: f64,
    /// Base node of a particle: the first that it reaches along each axis.
    pub home: fn(&Lattice<T, D>, Place<T, D>) -> [i32; D],
    /// Takes the particles of a tile through a pass.
    ///
    /// # Safety
    /// Nobody else may use the tile's nodes and particles meanwhile.
    pub visit: unsafe fn(ParticleLoop, &mut Visit<'_, T, D>),
    /// Adds a body's particles to nodes of a block.
    pub sum_around: SumAround<T, D>,
    /// The nodes that move a point of a particle.
    pub nodes_of: NodesOf<T, D>,
}

impl<T: Laned, const D: usize> Kernels<T, D> {
    /// Those of a basis.
    pub fn of(basis: BasisKind) -> &'static Self {
        match basis {
            BasisKind::Linear => const { &Self::by::<Linear>() },
            // Boxes of a cell: see `Gimp`.
            BasisKind::Gimp | BasisKind::Spline => const { &Self::by::<Gimp>() },
            BasisKind::Cubic => const { &Self::by::<Cubic>() },
            BasisKind::Cpdi => const { &Self::by::<Cpdi>() },
        }
    }

    /// Those of shape functions.
    pub const fn by<B: Basis<T>>() -> Self {
        Kernels {
            width: B::WIDTH,
            box_spread: B::BOX_SPREAD,
            home: home::<T, D, B>,
            visit: visit::<T, D, B>,
            sum_around: sum_around::<T, D, B>,
            nodes_of: nodes_of::<T, D, B>,
        }
    }

    /// Whether a particle is outside the domain, or so far away that its cell has no number.
    pub fn escaped(
        &self,
        place: Place<T, D>,
        lattice: &Lattice<T, D>,
        domain: Option<[Vector<T, D>; 2]>,
    ) -> bool {
        is_outside(place.0, domain) || !addressable((self.home)(lattice, place))
    }
}

/// Base node of a particle: the first that it reaches along each axis.
pub fn home<T: Real, const D: usize, B: Basis<T>>(
    lattice: &Lattice<T, D>,
    (position, half_sides): Place<T, D>,
) -> [i32; D] {
    let (x, half) = (lattice.cells(position), lattice.half_sides(half_sides));
    std::array::from_fn(|i| B::reach(x[i], half[i]).floor())
}

/// Whether a position is outside the domain.
pub fn is_outside<T: Real, const D: usize>(
    position: Vector<T, D>,
    domain: Option<[Vector<T, D>; 2]>,
) -> bool {
    domain.is_some_and(|[min, max]| (0..D).any(|i| position[i] < min[i] || position[i] > max[i]))
}
