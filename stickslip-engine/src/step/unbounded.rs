//! Rigid bodies without bounds, such as a half-space: they have particles only where other bodies are near.
//!
//! Contact asks a body's particles where its surface is, no further than shape functions reach. So a layer below the
//! surface, around the blocks that deformable bodies hold, does what the whole body would. It grows when they reach
//! blocks beyond it; memory follows them, not the domain.

use super::Engine;
use super::build::{mirrors, periods, spin};
use super::state::Disorder;
use crate::body::Particle;
use crate::geometry::{Bounds, Mirror, Shape, SiteLattice};
use crate::grid::{Blocks, Periods, SIDE, addressable, locate};
use crate::lanes::Laned;
use crate::particles::{OwnColumns, Particles};
use crate::rigid::{Pose, RigidMotion};
use crate::scene::{BasisKind, Expression, Scene};
use crate::tensor::{Matrix, Symmetric, Vector};

/// Where a rigid body without bounds has particles.
#[derive(Clone, Debug)]
pub(super) struct Unbounded<const D: usize> {
    /// Index of the body.
    pub body: usize,
    /// Its shape at the start.
    pub shape: Shape,
    /// Its particles' sites at the start.
    pub sites: SiteLattice,
    /// Side of a cell [m].
    pub cell: f64,
    /// How far shape functions reach, see [`reach`] [cells].
    pub reach: f64,
    /// After how many blocks the grid repeats: it has particles in the first period.
    pub periods: Periods<D>,
    /// What is behind them is no part of it.
    pub mirrors: Vec<Mirror>,
    /// Blocks around which it has particles, sorted.
    pub served: Vec<[i32; D]>,
    /// Where it was when it got them.
    pub pose: Option<Pose>,
}

/// How far functions of a basis reach at most [cells].
pub(super) fn reach(basis: BasisKind) -> f64 {
    match basis {
        BasisKind::Linear | BasisKind::Gimp | BasisKind::Spline => 1.5,
        BasisKind::Cubic => 2.0,
    }
}

/// The body may move by this before it gets new particles [cells].
const DRIFT: f64 = 0.5;

impl<const D: usize> Unbounded<D> {
    /// Depth of the layer of particles: nodes as deep as functions reach see all that they would see of the whole
    /// body [m].
    fn depth(&self) -> f64 {
        2.0 * self.reach * self.cell
    }

    /// Whether its surface may be met in a block, in its pose.
    fn meets(&self, block: [i32; D], pose: &Pose) -> bool {
        let [min, max] = self.corners(block);
        let center = std::array::from_fn(|k| 0.5 * (min[k] + max[k]));
        let half_diagonal = 0.5 * (Vector(max) - Vector(min)).norm();
        let distance = self.shape.distance(pose.start(center), D);
        distance.abs() <= half_diagonal + self.depth()
    }

    /// Lower and upper corner of a block's cells [m].
    fn corners(&self, block: [i32; D]) -> [[f64; 3]; 2] {
        [0, 1].map(|side| {
            std::array::from_fn(|k| match k < D {
                true => self.sites.origin[k] + f64::from((block[k] + side) * SIDE) * self.cell,
                false => 0.0,
            })
        })
    }

    /// Whether it has moved so far since it got its particles that they may be missed somewhere.
    fn drifted(&self, pose: &Pose) -> bool {
        let Some(before) = &self.pose else { return true };
        if before == pose {
            return false;
        }
        let corners = self.served.iter().flat_map(|&block| self.corners(block));
        let around = Bounds::around(corners);
        let far = |corner: [f64; 3]| {
            let moved = Vector(pose.now(before.start(corner))) - Vector(corner);
            moved.norm() > DRIFT * self.cell
        };
        !around.is_empty() && around.corners().any(far)
    }

    /// The sites at the start of the particles around the served blocks, block by block.
    fn fill(&self, pose: &Pose) -> Vec<[f64; 3]> {
        let position = |site: [f64; 3]| pose.now(site);
        let block_of = |x: [f64; 3]| {
            let cell = std::array::from_fn(|k| ((x[k] - self.sites.origin[k]) / self.cell).floor() as i32);
            (addressable::<D>(cell)).then(|| locate(cell).0)
        };
        // Particles lie this far beyond the blocks that are served.
        let margin = (self.reach + DRIFT) * self.cell;
        let served = |x: [f64; 3]| {
            (0..1_usize << D).any(|corner| {
                let side = |k: usize| if corner >> k & 1 == 1 { margin } else { -margin };
                let near = block_of(std::array::from_fn(|k| if k < D { x[k] + side(k) } else { x[k] }));
                near.is_some_and(|block| self.served.binary_search(&self.periods.wrapped(block)).is_ok())
            })
        };
        let before_mirrors = |x: [f64; 3]| {
            self.mirrors.iter().all(|mirror| (x[mirror.axis] - mirror.position) * mirror.inward >= 0.0)
        };
        let mut found = Vec::new();
        for block in grown(&self.served, self.periods) {
            let [min, max] = self.corners(block);
            let around = Bounds::around((Bounds { min, max }).corners().map(|corner| pose.start(corner)));
            found.extend(self.sites.sites_around(&around).filter(|&site| {
                let x = position(site);
                block_of(x) == Some(block)
                    && served(x)
                    && before_mirrors(x)
                    && self.sites.contains_site(&self.shape, site)
                    && self.shape.distance(site, D) > -self.depth()
            }));
        }
        found
    }
}

/// The blocks and those that touch them, sorted.
fn grown<const D: usize>(blocks: &[[i32; D]], periods: Periods<D>) -> Vec<[i32; D]> {
    let mut all = Vec::with_capacity(blocks.len() * 3_usize.pow(D as u32));
    for block in blocks {
        for i in 0..3_i32.pow(D as u32) {
            let beside = std::array::from_fn(|k| block[k] + i / 3_i32.pow(k as u32) % 3 - 1);
            all.push(periods.wrapped(beside));
        }
    }
    all.sort_unstable();
    all.dedup();
    all
}

/// How many particles a rigid body without bounds has in its pose at the start around bodies that fill these boxes.
pub(crate) fn particles_around(scene: &Scene, body: usize, boxes: &[Bounds]) -> usize {
    match scene.dimension.axes() {
        2 => count::<2>(scene, body, boxes),
        _ => count::<3>(scene, body, boxes),
    }
}

const ONLY_RIGID: &str = "only rigid bodies may be without bounds";

fn count<const D: usize>(scene: &Scene, body: usize, boxes: &[Bounds]) -> usize {
    let cell = scene.discretization.cell;
    let shape = scene.bodies[body].shape.clone();
    let sites = scene.lattice(&scene.bodies[body]);
    let still = || [0.0; 3].map(Expression::Constant);
    let pose = RigidMotion::new(shape.anchor(D), still(), still()).pose();
    let (mirrors, periods) = (mirrors::<D>(scene), periods::<D>(scene));
    let reach = reach(scene.discretization.basis);
    let mut layer = Unbounded::<D> {
        body,
        shape,
        sites,
        cell,
        reach,
        periods,
        mirrors,
        served: Vec::new(),
        pose: Some(pose),
    };
    let mut served = Vec::new();
    for bounds in boxes {
        let block = |k: usize, x: f64| ((x - sites.origin[k]) / (cell * f64::from(SIDE))).floor() as i32;
        let first: [i32; D] = std::array::from_fn(|k| block(k, bounds.min[k] - reach * cell));
        let last: [i32; D] = std::array::from_fn(|k| block(k, bounds.max[k] + reach * cell));
        let count: [i64; D] = std::array::from_fn(|k| i64::from(last[k] - first[k]) + 1);
        for number in 0..count.iter().product() {
            let mut rest = number;
            let block = std::array::from_fn(|k| {
                let along = rest % count[k];
                rest /= count[k];
                first[k] + along as i32
            });
            let block = periods.wrapped(block);
            if layer.meets(block, &pose) {
                served.push(block);
            }
        }
    }
    served.sort_unstable();
    served.dedup();
    layer.served = served;
    layer.fill(&pose).len()
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Motion of a body, if it is rigid and without bounds.
    pub(super) fn without_bounds(&self, body: usize) -> Option<&RigidMotion> {
        let unbounded = self.state.unbounded.iter().any(|unbounded| unbounded.body == body);
        self.state.bodies[body].motion.as_deref().filter(|_| unbounded)
    }

    /// Gives rigid bodies without bounds particles around the blocks that deformable bodies have come to hold.
    pub(super) fn spread(&mut self, blocks: Blocks) -> Blocks {
        let mut changed = Blocks::Same;
        for i in 0..self.state.unbounded.len() {
            if !self.on_any_rank(self.lacks_particles(i, blocks)) {
                continue;
            }
            let mut near: Vec<[i32; D]> = self.near_blocks(i).collect();
            near.sort_unstable();
            near.dedup();
            let near = self.blocks_of_all(near);
            let unbounded = &self.state.unbounded[i];
            let pose = self.without_bounds(unbounded.body).expect(ONLY_RIGID).pose();
            // Those beside them are kept: bodies come back.
            let beside = grown(&near, unbounded.periods);
            let kept = unbounded.served.iter().filter(|block| beside.binary_search(block).is_ok());
            let mut served: Vec<_> = kept.copied().filter(|&block| unbounded.meets(block, &pose)).collect();
            served.extend(&near);
            served.sort_unstable();
            served.dedup();
            let particles = {
                let unbounded = &mut self.state.unbounded[i];
                (unbounded.served, unbounded.pose) = (served, Some(pose));
                unbounded.fill(&pose)
            };
            self.refill(i, &particles);
            changed = Blocks::New;
        }
        changed
    }

    /// Whether a body without bounds has come where it has no particles, or others have. Nobody has who holds the same
    /// blocks as before.
    fn lacks_particles(&self, i: usize, blocks: Blocks) -> bool {
        let unbounded = &self.state.unbounded[i];
        let pose = self.without_bounds(unbounded.body).expect(ONLY_RIGID).pose();
        let moved = blocks == Blocks::New || unbounded.pose != Some(pose);
        let served = |block: &[i32; D]| unbounded.served.binary_search(block).is_ok();
        moved && (unbounded.drifted(&pose) || !self.near_blocks(i).all(|block| served(&block)))
    }

    /// The blocks of deformable bodies in which its surface may be met; some of them several times.
    fn near_blocks(&self, i: usize) -> impl Iterator<Item = [i32; D]> {
        let unbounded = &self.state.unbounded[i];
        let pose = self.without_bounds(unbounded.body).expect(ONLY_RIGID).pose();
        let active = &self.workspace.active;
        let deform = self.bodies_here().filter(|&body| !self.state.bodies[body].is_rigid());
        // Blocks are covered when all ranks have named their tiles: not yet.
        let alone = self.among.is_none();
        let held = deform.flat_map(move |body| {
            let covered = alone.then(|| active.blocks_of(body)).into_iter().flatten();
            covered.chain((!alone).then(|| active.reached_by(body)).into_iter().flatten())
        });
        held.filter(move |&block| unbounded.meets(block, &pose))
    }

    /// Gives a body without bounds these particles, by their sites at the start.
    fn refill(&mut self, i: usize, sites: &[[f64; 3]]) {
        let Unbounded { body, sites: lattice, .. } = &self.state.unbounded[i];
        let (number, volume) = (*body, T::of(lattice.volume()));
        let motion = self.without_bounds(number).expect(ONLY_RIGID);
        let (pose, density) = (motion.pose(), self.state.bodies[number].matter.density);
        let particle = |i: usize| Particle {
            position: Vector::of(sites[i]),
            velocity: Vector::of(motion.velocity_at(pose.now(sites[i]))),
            spin: spin::<T, D>(motion.spin()),
            mass: volume * density,
            volume,
            half_width: T::of(0.5 * lattice.spacing),
            deformation: Matrix::from_fn(|i, j| T::of(pose.orientation.0[i][j])),
            stress: Symmetric::ZERO,
            number: i as u32,
        };
        // They start where they would have been at the start, and are moved from there.
        let mut particles = Particles::from_fn(sites.len(), OwnColumns::default(), particle);
        for (i, &site) in sites.iter().enumerate() {
            particles.set(i, &Particle { position: Vector::of(pose.now(site)), ..particle(i) });
        }
        particles.remove(&self.of_other_ranks(number, &particles));
        let body = &mut self.state.bodies[number];
        body.particles = particles;
        let (particles, grid) = (&body.particles, &self.settings.lattice);
        if let Some(disorder) = self.workspace.disorder.get_mut(number) {
            *disorder = Disorder::any(particles.len());
        }
        let base = |particle: usize| (self.kernels.home)(grid, particles.place(particle));
        let counts = (number, particles.len(), self.kernels.width as i32 - 1);
        self.workspace.active.replace(counts, (base, |particle: usize| particles.numbers()[particle]));
    }
}
