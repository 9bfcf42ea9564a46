//! One pass over particles: what it does to each of them, and who does it.

use crate::basis::Basis;
use crate::body::{Body, Particle};
use crate::grid::{Disjoint, Lattice, Node, SIDE, Sought, Tile, Window, addressable};
use crate::lanes::{Any, Machine, Processor};
use crate::material::{Motion, Recall};
use crate::particles::Columns;
use crate::scene::Transfer;
use crate::tensor::{Matrix, Real, Vector};
use crate::transfer::{Share, Stencil, turning};
use std::marker::PhantomData;

/// Who does the work on particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// Several particles at a time, by the best that the processor has.
    Lanes(Processor),
    /// One particle at a time: what the other must agree with, but for round-off.
    Reference,
}

/// What a pass does to each particle, in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verbs {
    /// v_p = (1 - a) (v_p + sum S_i (v_i - v_i^0)) + a sum S_i v_i,   a: PIC share; the spin likewise, see [`turning`]
    pub accept: bool,
    /// F = (I + L dt) F,  V = V_0 det F,  sigma = law(F)
    pub strain: bool,
    /// x += v dt
    pub displace: bool,
    /// Gives to the nodes.
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
    /// Where the nodes are.
    pub lattice: Lattice<T, D>,
    /// Lower and upper corner of the domain [m].
    pub domain: Option<[Vector<T, D>; 2]>,
}

impl<T: Real, const D: usize> Pass<T, D> {
    /// What it takes from the nodes.
    pub fn sought(&self) -> Sought {
        let Verbs { accept, strain, displace, .. } = self.verbs;
        Sought { change: accept, integrated: accept && self.pic > T::ZERO, flow: strain || displace }
    }

    /// Whether it takes anything from the nodes.
    pub fn gathers(&self) -> bool {
        self.verbs.accept || self.verbs.strain || self.verbs.displace
    }
}

/// A particle that a pass cannot go on with.
#[derive(Clone, Copy, Debug)]
pub struct Fault {
    /// Index of the body.
    pub body: usize,
    /// Index of the particle in memory.
    pub particle: usize,
    /// What is wrong with it.
    pub kind: FaultKind,
}

/// What can be wrong with a particle.
#[derive(Clone, Copy, Debug)]
pub enum FaultKind {
    /// Its deformation gradient has no positive determinant.
    Inverted,
    /// It left the domain.
    Escaped,
    /// No thickness leaves it without stress out of the plane.
    NoThickness,
    /// A value of it is not a finite number.
    NotFinite,
}

/// What a pass found out.
#[derive(Clone, Copy, Debug)]
pub struct Found<T> {
    /// The first fault by body and particle.
    pub fault: Option<Fault>,
    /// Fastest signal of the particles that it displaced [m/s].
    pub signal: T,
}

impl<T: Real> Found<T> {
    /// Nothing.
    pub const NOTHING: Self = Found { fault: None, signal: T::ZERO };

    /// What two found.
    pub fn and(self, other: Self) -> Self {
        let fault = match (self.fault, other.fault) {
            (Some(a), Some(b)) => Some(if (b.body, b.particle) < (a.body, a.particle) { b } else { a }),
            (a, b) => a.or(b),
        };
        Found { fault, signal: self.signal.max(other.signal) }
    }
}

/// The particles of a tile and what a pass needs to know of them.
pub struct Visit<'a, T, const D: usize, B> {
    /// The pass.
    pub pass: &'a Pass<T, D>,
    /// The tile.
    pub tile: &'a Tile<D>,
    /// Its body.
    pub body: &'a Body<T, D>,
    /// The body's particles.
    pub columns: Columns<T, D>,
    /// Indices of the body's particles, by tile, cell and index.
    pub order: &'a [u32],
    /// Places in the order where the tile's cells begin and end.
    pub cells: &'a [u32],
    /// All nodes.
    pub nodes: &'a Disjoint<'a, Node<T, D>>,
    /// The tile's nodes.
    pub window: &'a mut Window<T, D>,
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
    /// Shape functions.
    pub basis: PhantomData<B>,
}

impl<T: Real, const D: usize, B: Basis<T>> Visit<'_, T, D, B> {
    /// Nodes along a side of the window that particles reach.
    const REACHED: usize = SIDE as usize + B::WIDTH - 1;

    /// Takes from the field what the pass seeks, and makes room for what it scatters.
    ///
    /// # Safety
    /// Nobody may write to the tile's nodes meanwhile.
    #[inline(always)]
    pub unsafe fn open<M: Machine<T>>(&mut self) {
        if self.pass.gathers() {
            // SAFETY: the caller's.
            unsafe { self.window.load::<M>(self.nodes, self.tile, Self::REACHED, self.pass.sought()) };
        }
        if self.pass.verbs.scatter.is_some() {
            self.window.clear();
            self.nodes.fetch(self.tile, Self::REACHED);
        } else if let Some(next) = self.next {
            self.nodes.fetch(next, Self::REACHED);
        }
    }

    /// Adds to the field what particles scattered.
    ///
    /// # Safety
    /// Nobody else may use the tile's nodes meanwhile.
    #[inline(always)]
    pub unsafe fn close<M: Machine<T>>(&mut self) {
        if self.pass.verbs.scatter.is_some() {
            // SAFETY: the caller's.
            unsafe { self.window.add_to::<M>(self.nodes, self.tile, Self::REACHED) };
        }
    }

    /// Takes the tile's particles one by one through the pass.
    ///
    /// # Safety
    /// Nobody else may use the tile's nodes and particles meanwhile.
    pub unsafe fn take_one_by_one(&mut self) {
        // SAFETY: the caller's.
        unsafe {
            self.open::<Any>();
            self.one_by_one();
            self.close::<Any>();
        }
    }

    /// Changes the tile's particles one by one.
    ///
    /// # Safety
    /// Nobody else may use the tile's particles meanwhile.
    unsafe fn one_by_one(&mut self) {
        for (cell, ends) in self.cells.windows(2).enumerate() {
            for place in ends[0]..ends[1] {
                // SAFETY: the caller's.
                unsafe { self.one(self.order[place as usize], cell) };
            }
        }
    }

    /// Takes one particle, whose home is a cell.
    ///
    /// # Safety
    /// Nobody else may use the particle meanwhile.
    pub unsafe fn one(&mut self, index: u32, cell: usize) {
        // SAFETY: the caller's.
        let mut particle = unsafe { self.columns.get(index as usize) };
        let stencil = Stencil::<T, D, B>::new(&self.pass.lattice, &particle);
        let outcome = self.change((&mut particle, index as usize), &stencil);
        // SAFETY: the caller's.
        unsafe { self.columns.set(index as usize, &particle) };
        match outcome {
            Ok(()) => self.scatter(&particle, &stencil),
            Err(kind) => {
                let fault = Fault { body: self.tile.body, particle: index as usize, kind };
                self.found = self.found.and(Found { fault: Some(fault), signal: T::ZERO });
            }
        }
        if self.pass.verbs.displace {
            let moved = Stencil::<T, D, B>::new(&self.pass.lattice, &particle).base() != stencil.base();
            self.left |= u64::from(moved) << cell;
            self.moved += u32::from(moved);
            // SAFETY: the caller's.
            let history = unsafe { self.columns.history_of(index as usize) };
            let signal = signal(self.body, &particle, &history);
            self.found.signal = self.found.signal.max(signal);
        }
    }

    fn change(
        &mut self,
        (particle, index): (&mut Particle<T, D>, usize),
        stencil: &Stencil<T, D, B>,
    ) -> Result<(), FaultKind> {
        let Pass { verbs, dt, transfer, pic, ref lattice, domain } = *self.pass;
        let block = self.tile.block;
        if verbs.accept {
            let kept = T::ONE - pic;
            particle.velocity += stencil.interpolate(&self.window.change, block);
            if transfer == Transfer::Rflip {
                let moment = stencil.moment(&self.window.change, block);
                particle.spin += moment * (T::ONE / self.body.gyration.squared(particle.half_width));
            }
            let before = self.body.kinetic(particle);
            if pic > T::ZERO {
                let mean = stencil.interpolate(&self.window.integrated, block);
                particle.velocity = particle.velocity * kept + mean * pic;
                if transfer == Transfer::Rflip {
                    let gradient = stencil.velocity_gradient(&self.window.integrated, block);
                    particle.spin = turning::toward(particle.spin, &gradient, pic);
                }
            }
            self.damped += (before - self.body.kinetic(particle)).f64();
            let sound = particle.velocity.is_finite() && particle.spin.is_finite();
            sound.then_some(()).ok_or(FaultKind::NotFinite)?;
        }
        if verbs.strain {
            let gradient = stencil.velocity_gradient(&self.window.flow, block);
            if transfer == Transfer::Rflip {
                let before = self.body.kinetic(particle);
                particle.spin = turning::settled::<T, D>(particle.spin, &gradient, dt);
                self.damped += (before - self.body.kinetic(particle)).f64();
            }
            let increment = Matrix::IDENTITY + gradient * dt;
            let deformation = increment * particle.deformation;
            let jacobian = deformation.det();
            if !jacobian.is_finite() {
                return Err(FaultKind::NotFinite);
            }
            let undeformed = particle.mass / self.body.density;
            (particle.deformation, particle.volume) = (deformation, undeformed * jacobian);
            if jacobian <= T::ZERO {
                return Err(FaultKind::Inverted);
            }
            let motion = Motion { deformation, jacobian, increment, stress: particle.stress, dt };
            // SAFETY: the caller of this pass keeps others away from the tile's particles.
            let mut history = unsafe { self.columns.history_of(index) };
            let (motion, stress) = self.body.respond(motion, &mut history).ok_or(FaultKind::NoThickness)?;
            (particle.deformation, particle.volume) = (motion.deformation, undeformed * motion.jacobian);
            particle.stress = stress;
            particle.stress.is_finite().then_some(()).ok_or(FaultKind::NotFinite)?;
        }
        if verbs.displace {
            let position = particle.position + stencil.interpolate(&self.window.flow, block) * dt;
            if !position.is_finite() {
                return Err(FaultKind::NotFinite);
            }
            particle.position = position;
            if escaped::<T, D, B>(particle, lattice, domain) {
                return Err(FaultKind::Escaped);
            }
        }
        Ok(())
    }

    fn scatter(&mut self, particle: &Particle<T, D>, stencil: &Stencil<T, D, B>) {
        let (window, block) = (&mut *self.window, self.tile.block);
        let gradient = turning::gradient::<T, D>(&particle.spin, T::HALF * self.pass.dt);
        match self.pass.verbs.scatter {
            Some(Share::Mass | Share::Everything) => {
                stencil.scatter_momentum(window, block, (particle.mass, particle, &gradient));
            }
            Some(Share::Momentum) => {
                stencil.scatter_momentum(window, block, (T::ZERO, particle, &gradient));
            }
            Some(Share::Force) | None => {}
        }
        if matches!(self.pass.verbs.scatter, Some(Share::Force | Share::Everything)) {
            stencil.scatter_force(window, block, &(particle.stress * particle.volume));
        }
    }
}

/// Wave speed plus particle speed [m/s], see [`crate::clock`].
pub fn signal<T: Real, const D: usize>(
    body: &Body<T, D>,
    particle: &Particle<T, D>,
    history: &impl Recall<T>,
) -> T {
    (body.wave_modulus(particle, history) / body.density).sqrt() + particle.velocity.norm()
}

/// Whether a particle is outside the domain, or so far away that its cell has no number.
pub fn escaped<T: Real, const D: usize, B: Basis<T>>(
    particle: &Particle<T, D>,
    lattice: &Lattice<T, D>,
    domain: Option<[Vector<T, D>; 2]>,
) -> bool {
    let outside = domain.is_some_and(|[min, max]| {
        (0..D).any(|i| particle.position[i] < min[i] || particle.position[i] > max[i])
    });
    outside || !addressable(Stencil::<T, D, B>::new(lattice, particle).base())
}
