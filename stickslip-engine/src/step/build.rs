//! From a scene to a simulation.

use super::among::{Find, Kinds, Look, SharedOut, Walked, share_out, walk, walk_together};
use super::mechanism::{JointSums, RigidSurfaces};
use super::reference::{CommonPartner, ReferenceBody, References, is_reference, lengths};
use super::relax::RelaxationProgress;
use super::state::{Settings, State, Workspace};
use super::together::over_arrays;
use super::unbounded::{Unbounded, reach};
use super::walls::WallSums;
use super::watch::Stopwatch;
use super::{Engine, ParticleLoop};
use crate::body::{Body, BodyHere, Matter, Particle};
use crate::boundary::{Boundary, Wall};
use crate::check;
use crate::contact::{ContactSums, Rules};
use crate::damping::{BulkViscosity, NodeDamping, viscosity_columns};
use crate::door::{NotTakenUp, SavedState, Simulation};
use crate::geometry::{Curved, Mirror, MirroredShape, ParticleSite, Shape, fill};
use crate::grid::{Lattice, Periods, SIDE, locate};
use crate::initial_stress;
use crate::lanes::{Laned, Processor};
use crate::load::{LoadPoints, LoadSums, SpringPoints};
use crate::material::{BadConstants, Material};
use crate::natural;
use crate::particles::{OwnColumns, Particles, stress_entries};
use crate::ranks::Ranks;
use crate::rigid::{MassProperties, RigidMotion, longest_step};
use crate::scene::{
    self, Action, BasisKind, BodyMotion, Changes, Dimension, Face, Moment, NamedMaterial, Precision, Problem,
    Scene, StartVelocities,
};
use crate::tensor::{Matrix, Real, Symmetric, Vector, cross};
use crate::transfer::{has_spin, pic_share, rotation};
use crate::{Compiled, Kernels};
use std::collections::HashSet;
use std::sync::Arc;
use stickslip_reference::cells::Table;

/// The simulation of a scene.
///
/// # Errors
/// What [`check::problems`] finds.
pub fn build(scene: &Scene) -> Result<Box<dyn Simulation>, Problem> {
    build_on(scene, ParticleLoop::Lanes(Processor::best()))
}

/// The simulation of a scene, with its particles taken one at a time or several.
///
/// # Errors
/// What [`check::problems`] finds.
pub fn build_on(scene: &Scene, path: ParticleLoop) -> Result<Box<dyn Simulation>, Problem> {
    Ok(build_for(scene, path, Keeping::All)?)
}

/// The simulation of a scene in double precision by these kernels of the plane and of space, one particle at a time:
/// for oracles.
///
/// # Errors
/// What [`check::problems`] finds.
pub fn build_by(
    scene: &Scene,
    (plane, space): (&'static Kernels<f64, 2>, &'static Kernels<f64, 3>),
) -> Result<Box<dyn Simulation>, Problem> {
    let (path, keeping) = (ParticleLoop::OneLane, Keeping::All);
    Ok(match scene.dimension {
        Dimension::Space => Box::new(Engine { kernels: space, ..Engine::of(scene, path, keeping)? }),
        _ => Box::new(Engine { kernels: plane, ..Engine::of(scene, path, keeping)? }),
    })
}

/// One rank's part of the simulation of a scene, see [`Ranks`]. All ranks make the same calls of it in the same order:
/// `step`, `bodies`, `ledger` and what else is of the whole ask the others. What is of single particles is of those
/// that this rank has: `particles`, `snapshot`, `grid_snapshot`, `visit`, `fastest`, `trace`, `column`, `save_shares`,
/// `save_columns`; `contact_sums` and `patches`, and these in `save_rest`, are of the pairs whose sums it keeps. Nobody
/// can write to it or give it another state; [`crate::shared`] has what runs need.
///
/// # Errors
/// What [`check::problems`] finds, and what ranks cannot share yet.
pub fn build_among(
    scene: &Scene,
    path: ParticleLoop,
    ranks: Arc<dyn Ranks>,
) -> Result<Box<dyn Simulation>, Problem> {
    Ok(build_share(&Arc::new(scene.clone()), path, ranks)?)
}

/// The same.
pub(crate) fn build_share(
    scene: &Arc<Scene>,
    path: ParticleLoop,
    ranks: Arc<dyn Ranks>,
) -> Result<Box<dyn Shareable>, Problem> {
    super::among::can_be_shared(scene)?;
    build_for(scene, path, Keeping::Share(scene.clone(), ranks))
}

/// A simulation without particles, which can [take up](Shareable::take_up_share) those of a saved state; all ranks
/// build one.
///
/// # Errors
/// What [`check::problems`] finds.
pub(crate) fn build_empty(
    scene: &Arc<Scene>,
    path: ParticleLoop,
    ranks: &dyn Ranks,
) -> Result<Box<dyn Shareable>, Problem> {
    build_for(scene, path, Keeping::None(scene.clone(), ranks))
}

/// Which particles of a scene a simulation begins with.
enum Keeping<'a> {
    All,
    /// None, on any of several ranks, which keep the scene.
    None(Arc<Scene>, &'a dyn Ranks),
    /// Those of one of several ranks.
    Share(Arc<Scene>, Arc<dyn Ranks>),
}

/// A simulation that ranks can share.
pub(crate) trait Shareable: Simulation {
    /// How many particles each body has on all ranks.
    fn counts_of_all(&self) -> Vec<usize>;

    /// Takes up this rank's share of a saved state, with no particles before.
    ///
    /// # Errors
    /// It is of another scene, or a rank does not find its particles: all ranks say so.
    fn take_up_share(
        &mut self,
        of: (&Arc<Scene>, Arc<dyn Ranks>),
        rest: &SavedState,
        find: Find,
    ) -> Result<(), NotTakenUp>;

    /// Lets bodies begin as those of another run, of whose particles each rank finds some, which it also shows.
    ///
    /// # Errors
    /// One is another body there, or a rank does not find its particles: all ranks say so, and have lost some.
    fn begin_share(
        &mut self,
        of: (&Arc<Scene>, Arc<dyn Ranks>),
        from: (&SavedState, StartVelocities),
        found: (Find, Look),
    ) -> Result<(), NotTakenUp>;
}

impl<T: Laned, const D: usize> Shareable for Engine<T, D> {
    fn counts_of_all(&self) -> Vec<usize> {
        Engine::counts_of_all(self)
    }

    fn take_up_share(
        &mut self,
        of: (&Arc<Scene>, Arc<dyn Ranks>),
        rest: &SavedState,
        find: Find,
    ) -> Result<(), NotTakenUp> {
        self.take_up_among(of, rest, find)
    }

    fn begin_share(
        &mut self,
        of: (&Arc<Scene>, Arc<dyn Ranks>),
        from: (&SavedState, StartVelocities),
        found: (Find, Look),
    ) -> Result<(), NotTakenUp> {
        self.begin_among(of, from, found)
    }
}

/// The simulation with these particles.
fn build_for(scene: &Scene, path: ParticleLoop, keeping: Keeping) -> Result<Box<dyn Shareable>, Problem> {
    Ok(match (scene.dimension, scene.precision) {
        (Dimension::PlaneStrain | Dimension::PlaneStress, Precision::Double) => {
            Box::new(Engine::<f64, 2>::of(scene, path, keeping)?)
        }
        (Dimension::PlaneStrain | Dimension::PlaneStress, Precision::Single) => {
            Box::new(Engine::<f32, 2>::of(scene, path, keeping)?)
        }
        (Dimension::Space, Precision::Double) => Box::new(Engine::<f64, 3>::of(scene, path, keeping)?),
        (Dimension::Space, Precision::Single) => Box::new(Engine::<f32, 3>::of(scene, path, keeping)?),
    })
}

impl<T: Compiled<D>, const D: usize> Engine<T, D> {
    /// The simulation of a scene of this dimension and precision with these particles.
    ///
    /// # Errors
    /// What [`check::problems`] finds.
    fn of(scene: &Scene, path: ParticleLoop, keeping: Keeping) -> Result<Self, Problem> {
        check::problems(scene)?;
        let known = |walked: &Option<Walked>| {
            walked.map(|Walked { count, volume, center, .. }| Filled {
                count,
                volume,
                center,
                kept: Vec::new(),
            })
        };
        let (kept, ranks) = match keeping {
            Keeping::All => return Self::filled((scene, None), path, &|number| Filled::of(scene, number)),
            Keeping::None(kept, ranks) => {
                let walked = walk_together(scene, ranks, &mut |_, _| ());
                return Self::filled((scene, Some(kept)), path, &|number| known(&walked[number]));
            }
            Keeping::Share(kept, ranks) => (kept, ranks),
        };
        let (origin, periods) = (origin(scene), periods::<D>(scene));
        let block = |x: [f64; 3]| {
            let cell = scene.discretization.cell;
            let cell = std::array::from_fn(|k| ((x[k] - origin[k]) / cell).floor() as i32);
            periods.wrapped(locate(cell).0)
        };
        let SharedOut { walked, here, partition, homes } = share_out::<D>(scene, &*ranks, (periods, block));
        let own = |body: usize, site: &ParticleSite| match is_reference(scene, body) {
            true => homes[body].rank as usize == ranks.rank(),
            false => partition.owner(block(site.position)) == ranks.rank(),
        };
        let mut engine = Self::filled((scene, Some(kept)), path, &|number| {
            let mut filled = known(&walked[number])?;
            if here.contains(&number) {
                let sites = (0..).zip(walk(scene, &scene.bodies[number]));
                filled.kept = sites.filter(|(_, site)| own(number, site)).collect();
            }
            Some(filled)
        })?;
        engine.join(ranks, (partition, homes));
        Ok(engine)
    }

    /// The simulation with the particles that fill each body, by its number; none fill one without bounds. One of
    /// several ranks keeps the scene.
    fn filled(
        (scene, kept): (&Scene, Option<Arc<Scene>>),
        path: ParticleLoop,
        filled: &dyn Fn(usize) -> Option<Filled>,
    ) -> Result<Self, Problem> {
        let cell = scene.discretization.cell;
        let kernels = T::kernels(scene.discretization.basis);
        let half_side = match scene.discretization.basis {
            BasisKind::Linear | BasisKind::Gimp => None,
            BasisKind::Spline => Some(0.5),
            BasisKind::Cubic => Some(1.0),
        };
        let mut bodies = Vec::with_capacity(scene.bodies.len());
        let mut all_filled = Vec::with_capacity(scene.bodies.len());
        let mut laws: Vec<Option<Arc<Material<T>>>> = vec![None; scene.materials.len()];
        let mut unbounded = Vec::new();
        let heated = heated_bodies(scene);
        let mut kinds: Option<Kinds<T, D>> = kept.map(Kinds::new);
        let (mut references, mut nodes) = (Vec::new(), Vec::new());
        for (number, body) in scene.bodies.iter().enumerate() {
            let sites = scene.lattice(body);
            let filled = filled(number);
            let center = filled.as_ref().map_or(body.shape.anchor(sites.dimension), |filled| filled.center);
            let filled = filled.unwrap_or_else(|| {
                unbounded.push(Unbounded {
                    body: bodies.len(),
                    shape: body.shape.clone(),
                    sites,
                    cell,
                    reach: reach(scene.discretization.basis),
                    periods: periods::<D>(scene),
                    mirrors: mirrors::<D>(scene),
                    served: Vec::new(),
                    pose: None,
                });
                Filled::default()
            });
            let begun = Begun::of(scene, number, (filled.volume, center));
            all_filled.push(filled.count);
            if is_reference(scene, number) {
                let (constants, own) = ReferenceBody::new(scene, number, |x| begun.velocity(0, x))?;
                references.push(constants);
                nodes.push(own);
            }
            let law = &mut laws[body.material];
            if law.is_none() {
                *law = Some(Arc::new(material(scene, body)?));
            }
            let (is_elsewhere, law) = (!body.is_rigid() && filled.kept.is_empty(), law.clone());
            let make = || -> Result<BodyHere<T, D>, Problem> {
                Ok(BodyHere {
                    name: body.name.clone(),
                    matter: Matter {
                        material: law.expect("it has been made"),
                        density: T::of(begun.density),
                        expansion: T::of(scene.materials[body.material].thermal_expansion),
                        thickness: scene.dimension.thickness(),
                        gyration: rotation::gyration(kernels.box_spread, cell, half_side),
                        volume_change: scene.materials[body.material].volume_change,
                    },
                    particles: begun.particles(&filled.kept, heated.contains(&number))?,
                    motion: begun.motion.map(Box::new),
                    whole: whole::<D>(scene, number),
                })
            };
            bodies.push(match kinds.as_mut().filter(|_| is_elsewhere) {
                Some(kinds) => kinds.of(number, make)?,
                None => make()?.into(),
            });
        }
        let tables = Table::of_all(nodes.iter().map(|nodes| &*nodes.form));
        let periods = periods::<D>(scene);
        let origin = origin(scene);
        let tallies = scene.outputs.measurements.faces().next().is_some();
        let all_that =
            |is: &dyn Fn(&Body<T, D>) -> bool| (0..bodies.len()).filter(|&i| is(&bodies[i])).collect();
        let (rigid, together) =
            (all_that(&|body| body.is_rigid()), all_that(&|body| over_arrays(body).is_some()));
        let averages = |i: usize| bodies[i].averages_volume() && !is_reference(scene, i);
        let averages_volume = (0..bodies.len()).any(averages);
        let begins_stressed = scene.bodies.iter().any(|body| body.stress.is_some());
        let loads = loads(scene, (&bodies, &all_filled), kinds.is_some());
        let rules = Rules::new(scene);
        let common = CommonPartner::of_scene::<D>(scene, &rules);
        let mut engine = Engine {
            settings: Settings {
                lattice: Lattice {
                    half_side: half_side.map(T::of),
                    periods,
                    ..Lattice::new(Vector::of(origin), T::of(cell))
                },
                domain: scene.domain.as_ref().map(|domain| [domain.min, domain.max].map(Vector::of)),
                held: scene.domain.as_ref().map(held),
                leaving: scene.domain.as_ref().map_or_else(Default::default, |domain| domain.leaving),
                filled: all_filled,
                gravity: scene.gravity.clone(),
                changes: Changes::of(scene),
                transfer: scene.time.transfer,
                pic_share: T::of(pic_share(scene.time.transfer, scene.time.pic_share)),
                walls: walls::<D>(scene),
                damping: NodeDamping::new(&scene.damping),
                viscosity: BulkViscosity::new(scene.damping.bulk),
                rules,
                loads,
                joints: scene.joints.clone(),
                springs: scene.springs.iter().map(|spring| SpringPoints::new(scene, spring)).collect(),
                surfaces: RigidSurfaces::new::<D>(scene),
                free: free_bodies(scene),
                rigid,
                references,
                common,
                lengths: lengths(scene),
                tables,
                together,
                averages_volume,
                begins_stressed,
                time: scene.time.clone(),
                path,
            },
            state: State {
                bodies,
                unbounded,
                references: References { nodes, ..References::default() },
                longest_rigid: longest_step(scene),
                contact_sums: ContactSums::default(),
                loads: vec![LoadSums::default(); scene.loads.len()],
                joints: vec![JointSums::default(); scene.joints.len()],
                removed: Vec::new(),
                written: Vec::new(),
                touch_forces: Vec::new(),
                springs: vec![JointSums::default(); scene.springs.len()],
                walls: vec![
                    WallSums::default();
                    if tallies { walls::<D>(scene).len() * scene.bodies.len() } else { 0 }
                ],
                damping: 0.0,
                impacts: 0.0,
                gravity_work: 0.0,
                relaxation: RelaxationProgress::default(),
                signal: None,
                time: 0.0,
                steps: 0,
                phase: 0,
            },
            workspace: Workspace::new(
                if tallies {
                    Boundary::new(walls::<D>(scene)).tallied()
                } else {
                    Boundary::new(walls::<D>(scene))
                },
                periods,
            ),
            held: None,
            among: None,
            kinds,
            watch: Stopwatch::default(),
            kernels,
        };
        if begins_stressed {
            engine.begin_stressed();
        }
        Ok(engine)
    }
}

/// The particles that fill a body.
#[derive(Default)]
struct Filled {
    /// How many.
    count: usize,
    /// Their volume [m^3], in the plane area [m^2].
    volume: f64,
    /// Its centre [m].
    center: [f64; 3],
    /// Those that are kept, by their numbers.
    kept: Vec<(u32, ParticleSite)>,
}

impl Filled {
    /// All of a body; none of one without bounds.
    fn of(scene: &Scene, number: usize) -> Option<Self> {
        let body = &scene.bodies[number];
        let filling = fill(&body.shape, &scene.lattice(body), scene.arrangement(body))?;
        let (count, volume, center) = (filling.sites.len(), filling.volume(), filling.center());
        Some(Filled { count, volume, center, kept: (0..).zip(filling.sites).collect() })
    }
}

/// Where the grid begins [m].
fn origin(scene: &Scene) -> [f64; 3] {
    scene.domain.as_ref().map_or([0.0; 3], |domain| domain.min)
}

/// Of each body, whether it is rigid and free; empty where none is.
fn free_bodies(scene: &Scene) -> Vec<bool> {
    let free: Vec<bool> = scene.bodies.iter().map(|body| body.as_free_rigid().is_some()).collect();
    if free.contains(&true) { free } else { Vec::new() }
}

/// The law of a body, for the scene's cells and in the precision of the engine.
fn material<T: Real>(scene: &Scene, body: &scene::Body) -> Result<Material<T>, Problem> {
    let NamedMaterial { name, law, .. } = &scene.materials[body.material];
    let at = |bad: BadConstants| Problem {
        key: format!("materials.{name}.{}", law.name()),
        found: bad.found,
        allowed: bad.allowed,
        help: None,
    };
    law.on_grid(scene.discretization.cell).map(|law| law.cast()).map_err(at)
}

/// The part of an angular velocity that a motion in `D` dimensions has.
pub(super) fn spin<T: Real, const D: usize>([x, y, z]: [f64; 3]) -> Vector<T, 3> {
    Vector::of(if D == 2 { [0.0, 0.0, z] } else { [x, y, z] })
}

/// v + w x (x - c) [m/s]
fn about(center: [f64; 3], velocity: [f64; 3], spin: [f64; 3], x: [f64; 3]) -> [f64; 3] {
    let turn = cross(spin, std::array::from_fn(|i| x[i] - center[i]));
    std::array::from_fn(|i| velocity[i] + turn[i])
}

/// The loads of a scene on bodies that have been filled with so many particles: if ranks share these, with the points
/// that those here carry.
pub(super) fn loads<T: Real, const D: usize>(
    scene: &Scene,
    (bodies, filled): (&[Body<T, D>], &[usize]),
    shared: bool,
) -> Vec<LoadPoints> {
    let load = |load: &scene::Load| {
        let here = shared.then(|| {
            let mut numbers = bodies[load.body].particles.numbers().to_vec();
            numbers.sort_unstable();
            numbers
        });
        LoadPoints::new(scene, load, filled[load.body], here.as_deref())
    };
    scene.loads.iter().map(load).collect()
}

/// How a body of a scene begins.
struct Begun<'a> {
    scene: &'a Scene,
    number: usize,
    /// Of its volume, which its own rotation leaves where it is [m].
    center: [f64; 3],
    /// [kg/m^3]
    density: f64,
    /// If it is rigid.
    motion: Option<RigidMotion>,
}

impl<'a> Begun<'a> {
    /// That of a body with this volume and its centre.
    fn of(scene: &'a Scene, number: usize, (volume, center): (f64, [f64; 3])) -> Self {
        let body = &scene.bodies[number];
        let free = body.as_free_rigid().and_then(|free| {
            let properties = MassProperties::of(scene, body, free)?;
            Some(RigidMotion::free(&properties, free.velocity, free.spin))
        });
        let motion = free.or_else(|| RigidMotion::prescribed(&body.motion, center));
        // The particles of a free rigid body weigh what it weighs, whatever its mass is given as.
        let density = match motion.as_ref().and_then(RigidMotion::as_free) {
            Some(free) => free.mass / volume,
            None => scene.materials[body.material].density,
        };
        Begun { scene, number, center, density, motion }
    }

    /// The part of its velocity that formulas say by place [m/s].
    fn by_place(&self, x: [f64; 3]) -> [f64; 3] {
        let moment = Moment { place: x, start: x, ..Moment::default() };
        let values = self.scene.bodies[self.number].velocity_by_place.as_deref();
        values.map_or([0.0; 3], |values| values.each_ref().map(|value| value.at_moment(&moment)))
    }

    /// Its velocity at a place; the particles of a point cloud may have been given theirs, by their numbers [m/s].
    fn velocity(&self, number: usize, x: [f64; 3]) -> [f64; 3] {
        let body = &self.scene.bodies[self.number];
        let given = match &body.shape {
            Shape::Curved(Curved::PointCloud(cloud)) => cloud.velocities(),
            _ => None,
        };
        match (&body.motion, &self.motion) {
            (BodyMotion::Free { velocity, spin }, _) => {
                let at_start = || Vector(about(self.center, *velocity, *spin, x)) + Vector(self.by_place(x));
                given.map_or_else(|| at_start().0, |given| given[number])
            }
            (_, Some(motion)) => motion.velocity_at(x),
            _ => [0.0; 3],
        }
    }

    /// Some of its particles.
    fn particles<T: Real, const D: usize>(
        &self,
        kept: &[(u32, ParticleSite)],
        heated: bool,
    ) -> Result<Particles<T, D>, Problem> {
        let Begun { scene, number, density, motion, .. } = self;
        let body = &scene.bodies[*number];
        let places = kept.iter().map(|(_, site)| site.position).collect();
        let stresses = initial_stress::at(scene, *number, places)?;
        let is_none =
            |(_, site): &&(u32, ParticleSite)| !self.by_place(site.position).iter().all(|v| v.is_finite());
        if let Some((_, site)) = kept.iter().find(is_none) {
            let place = site.position;
            return Err(Problem {
                key: format!("bodies[{number}].velocity"),
                found: format!("{:?} m/s at {place:?} m in `{}`", self.by_place(place), body.name),
                allowed: "velocities that are numbers".to_string(),
                help: None,
            });
        }
        // Only by some transfers do particles keep a spin; those of rigid bodies have theirs whatever the transfer,
        // and give the nodes their exact velocity.
        let turning = match (&body.motion, motion) {
            (BodyMotion::Free { spin, .. }, _) if has_spin(scene.time.transfer) => *spin,
            (_, Some(motion)) => motion.spin(),
            _ => [0.0; 3],
        };
        let particle = |place: usize| {
            let (number, ref site) = kept[place];
            let number = number as usize;
            Particle {
                position: Vector::of(site.position),
                velocity: Vector::of(self.velocity(number, site.position)),
                spin: spin::<T, D>(turning),
                mass: T::of(site.volume * density),
                volume: T::of(site.volume),
                half_width: T::of(site.half_width),
                deformation: Matrix::IDENTITY,
                stress: stresses
                    .get(place)
                    .map_or(Symmetric::ZERO, |begun| Symmetric(begun.stress.0.map(T::of))),
                number: number as u32,
            }
        };
        let own = own_columns(scene, body, heated);
        let mut particles = Particles::from_fn(kept.len(), own, particle);
        if natural::begins_stretched(own.natural) {
            let first = particles.view().natural_columns().start;
            for k in 0..stress_entries(D) {
                let line = particles.line_mut(first + k).iter_mut();
                line.zip(&stresses).for_each(|(entry, begun)| *entry = T::of(begun.stretch.0[k]));
            }
        }
        Ok(particles)
    }
}

/// The particles of a body with some numbers, in any order, as they fill it; none of a body without bounds.
///
/// # Errors
/// What [`check::problems`] finds.
pub(super) fn particles_with<T: Real, const D: usize>(
    scene: &Scene,
    number: usize,
    numbers: &[u32],
) -> Result<Particles<T, D>, Problem> {
    let body = &scene.bodies[number];
    let walked = (!numbers.is_empty()).then(|| Walked::of(scene, body, &mut |_| ())).flatten();
    let mut wanted = numbers.to_vec();
    wanted.sort_unstable();
    let some = (0..).zip(walk(scene, body)).filter(|(number, _)| wanted.binary_search(number).is_ok());
    let (size, kept) = walked
        .map_or_else(Default::default, |walked| ((walked.volume, walked.center), some.collect::<Vec<_>>()));
    Begun::of(scene, number, size).particles(&kept, heated_bodies(scene).contains(&number))
}

/// Bodies that loads heat.
pub fn heated_bodies(scene: &Scene) -> HashSet<usize> {
    let heats = |load: &&scene::Load| matches!(load.action, Action::Temperature(_));
    scene.loads.iter().filter(heats).map(|load| load.body).collect()
}

/// The columns that the particles of a body have for its law, its transfer, damping, initial stress and heat: rigid
/// ones none.
pub fn own_columns(scene: &Scene, body: &scene::Body, heated: bool) -> OwnColumns {
    if body.is_rigid() {
        return OwnColumns::default();
    }
    let law = &scene.materials[body.material].law;
    let viscosity = viscosity_columns(&scene.damping);
    let natural = natural::columns(body.stress.is_some() && !law.carries_stress(), heated);
    OwnColumns {
        history: law.history(),
        transfer: crate::transfer::columns(scene.time.transfer),
        viscosity,
        natural,
    }
}

/// The undeformed shape of a body with its images.
pub(super) fn whole<const D: usize>(scene: &Scene, number: usize) -> MirroredShape {
    let body = &scene.bodies[number];
    // A mirror does not move along with what is free, unless that slides along it.
    let stays = |mirror: &Mirror| body.as_free_rigid().is_none() || scene.slides_along(number, mirror.axis);
    let mirrors = mirrors::<D>(scene).into_iter().filter(stays).collect();
    let whole = MirroredShape::new(&body.shape, mirrors, D);
    let joined = scene.joined_ends(number).into_iter().enumerate();
    joined.fold(whole, |whole, (axis, ends)| {
        ends.into_iter().fold(whole, |whole, ends| whole.joined(axis, ends))
    })
}

/// After how many blocks the grid of a scene repeats.
pub(super) fn periods<const D: usize>(scene: &Scene) -> Periods<D> {
    let block = scene.discretization.cell * f64::from(SIDE);
    let periods = scene.periods();
    Periods(std::array::from_fn(|k| (periods[k] / block).round() as i32))
}

/// Corners of the box that particles may not leave: the domain, without end where it is periodic [m].
fn held<T: Real, const D: usize>(domain: &scene::Domain) -> [Vector<T, D>; 2] {
    let corner = |corner: [f64; 3], end: f64| {
        Vector::from_fn(|k| T::of(if domain.is_periodic(k) { end } else { corner[k] }))
    };
    [corner(domain.min, f64::NEG_INFINITY), corner(domain.max, f64::INFINITY)]
}

/// The domain's faces that are mirrors.
pub(super) fn mirrors<const D: usize>(scene: &Scene) -> Vec<Mirror> {
    let Some(domain) = &scene.domain else { return Vec::new() };
    let faces = (0..D).flat_map(|axis| [0, 1].map(|side| (axis, side)));
    (faces.filter(|&(axis, side)| domain.faces[axis][side] == Face::Symmetry))
        .map(|(axis, side)| match side {
            0 => Mirror { axis, position: domain.min[axis], inward: 1.0 },
            _ => Mirror { axis, position: domain.max[axis], inward: -1.0 },
        })
        .collect()
}

/// The domain's faces that do something.
fn walls<const D: usize>(scene: &Scene) -> Vec<Wall> {
    let Some(domain) = &scene.domain else { return Vec::new() };
    let mut walls = Vec::new();
    for axis in 0..D {
        let upper = ((domain.max[axis] - domain.min[axis]) / scene.discretization.cell).round() as i32;
        for (face, node, inward) in [(domain.faces[axis][0], 0, 1), (domain.faces[axis][1], upper, -1)] {
            if matches!(face, Face::Symmetry | Face::Fixed) {
                walls.push(Wall { axis, node, inward, face });
            }
        }
    }
    walls
}
