//! What of a step knows the shape functions: one table of functions, chosen when a simulation is built.
//!
//! Passes call it once a tile, contact detection once a body and block, loads once a point. All else of the engine is
//! compiled once for each dimension and precision, not for each basis as well.

use crate::basis::{Basis, Cubic, Gimp, Linear};
use crate::grid::{Lattice, addressable};
use crate::lanes::Laned;
use crate::matter::{Gyration, Matter};
use crate::particles::Particles;
use crate::pass::{ParticleLoop, Visit, home, is_outside, visit, visit_naively};
use crate::points::{NodesOf, nodes_of};
use crate::scheme::BasisKind;
use crate::surroundings::{SumAround, sum_around};
use crate::tensor::Vector;
use crate::totals::{TotalSums, Totals, TurningSums, total_sums, turning_sums};

/// Position of a particle and half the side of its box [m].
pub type Place<T, const D: usize> = (Vector<T, D>, T);

/// The functions of one basis.
pub struct Kernels<T, const D: usize> {
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
    /// What the particles of a body add up to.
    pub total_sums: fn(&Matter<T>, &Particles<T, D>, bool) -> TotalSums,
    /// Their inertia and angular momentum.
    pub turning_sums: fn(&Particles<T, D>, &Totals, Gyration<f64>) -> TurningSums,
}

/// A dimension and a precision for which kernels are compiled.
pub trait Compiled<const D: usize>: Laned {
    /// Those of a basis.
    fn kernels(basis: BasisKind) -> &'static Kernels<Self, D>;
}

macro_rules! compiled {
    ($($real:ty, $dimension:literal;)*) => {$(
        impl Compiled<$dimension> for $real {
            // Else the compiler copies it, and with it all kernels, into each crate that calls it.
            #[inline(never)]
            fn kernels(basis: BasisKind) -> &'static Kernels<Self, $dimension> {
                Kernels::of(basis)
            }
        }
    )*};
}

compiled! {
    f64, 2;
    f64, 3;
    f32, 2;
    f32, 3;
}

impl<T: Laned, const D: usize> Kernels<T, D> {
    /// Those of a basis.
    fn of(basis: BasisKind) -> &'static Self {
        match basis {
            BasisKind::Linear => const { &Self::by::<Linear>() },
            // Boxes of a cell: see `Gimp`.
            BasisKind::Gimp | BasisKind::Spline => const { &Self::by::<Gimp>() },
            BasisKind::Cubic => const { &Self::by::<Cubic>() },
        }
    }

    /// The same, but for passes as the equations read, one particle and one node after the other: an oracle for tests.
    pub fn naive(basis: BasisKind) -> &'static Self {
        match basis {
            BasisKind::Linear => const { &Self::naive_by::<Linear>() },
            BasisKind::Gimp | BasisKind::Spline => const { &Self::naive_by::<Gimp>() },
            BasisKind::Cubic => const { &Self::naive_by::<Cubic>() },
        }
    }

    const fn naive_by<B: Basis<T>>() -> Self {
        Kernels { visit: visit_naively::<T, D, B>, ..Self::by::<B>() }
    }

    /// Those of shape functions.
    const fn by<B: Basis<T>>() -> Self {
        Kernels {
            width: B::WIDTH,
            box_spread: B::BOX_SPREAD,
            home: home::<T, D, B>,
            visit: visit::<T, D, B>,
            sum_around: sum_around::<T, D, B>,
            nodes_of: nodes_of::<T, D, B>,
            total_sums,
            turning_sums,
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
