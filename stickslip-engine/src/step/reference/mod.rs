//! Bodies on grids of their own undeformed places: their part of a step.
//!
//! They share neither nodes nor momentum with the grid of the others: their nodes persist, and contact, loads and
//! supports act on these. See [`stickslip_reference`] for the equations.
//!
//! ```text
//! find_touches            points of surfaces inside partners
//! press                   f_I += N_I A (p n + tau)
//! load                    supports and loads, on points of bodies
//! accelerate              v_I += dt (f_I / M_I + g)
//! ...                     free rigid bodies, springs
//! slip                    what the layer stores in shear
//! advance                 x_I += dt v_I
//! strain                  F from places, sigma = law(F), f_I = -sum V P grad N_I
//! ```

mod books;
mod common;
mod loads;
mod rest;
mod rigid;
mod springs;
mod walls;

pub(super) use springs::{center as center_of, feel, pull_of, push};

use super::Engine;
use super::among::Among;
use super::state::{Settings, Workspace};
use super::walls::middle;
use crate::body::{Body, Particle, Totals};
use crate::contact::Rules;
use crate::door::{RestoreError, SavedState, StepError};
use crate::geometry::form::{Form, HeldFaces, NoForm};
use crate::geometry::{MirroredShape, Shape};
use crate::grid::Disjoint;
use crate::lanes::{Laned, Processor};
use crate::load::LoadSums;
use crate::pass::{FaultKind, Found, ParticleFault, ParticleLoop};
use crate::scene::{ContactLaw, FrictionMemory, Interior as Kind, Problem, Scene, StartVelocities};
use crate::tensor::{Matrix, Vector, cross};
use crate::threads::each;
use common::{CommonBody, CommonGrid};
pub(super) use common::{CommonPartner, Skin};
use loads::ReferenceLoads;
use rest::{Begun, Slowing};
use rigid::RigidBody;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Instant;
use stickslip_reference::contact::{
    Bond, Deforming, Friction, Memory, Met, Neighbours, Obstacle, Partner, PeriodLengths, STIFFNESS, Search,
    Touch, approach, begin, find, follow, parted, press, slip,
};
use stickslip_reference::interior::{Asked, Interior, Straining, strain};
use stickslip_reference::surface::{SurfacePoint, points};
use walls::RigidWall;

/// What of such a body never changes.
pub struct ReferenceBody<const D: usize> {
    /// Its number among all bodies.
    pub body: usize,
    /// Its undeformed shape, with its images behind faces that hold it.
    shape: MirroredShape,
    surface: Vec<SurfacePoint<D>>,
    /// Moduli of its longitudinal and its shear wave at rest [Pa].
    moduli: [f64; 2],
    /// Speed of its longitudinal wave at rest [m/s].
    wave: f64,
    /// What of a cell this wave may cross in a step while it touches others, see [`in_contact`].
    courant: f64,
    /// Transit of this wave through its narrowest side [s].
    transit: f64,
    /// How long its layers take to feel the depth at which its points came to touch [s].
    settling: f64,
    /// How friction on it follows a change of pressure where its rule does not say so.
    memory: FrictionMemory,
}

/// What such bodies are between two steps.
#[derive(Clone, Debug, Default)]
pub struct References<const D: usize> {
    /// The nodes of each.
    pub nodes: Vec<Interior<D>>,
    /// Whether particles may be where the nodes were in a step before.
    pub behind: bool,
    /// What is known of points that touch.
    pub touching: Vec<Memory>,
    /// What each body's part of the layers is.
    pub layers: Vec<Layers>,
    /// Accelerations of each one's nodes in the last step of dynamic relaxation, before damping [m/s^2].
    pub accelerations: Vec<Vec<Vector<f64, D>>>,
}

/// The points that touch in a step.
#[derive(Debug, Default)]
pub struct Touching<const D: usize> {
    /// Those that touch.
    pub touches: Vec<Touch<D>>,
    /// Those that came to touch in a step which is too long for their layers.
    waiting: Vec<Touch<D>>,
    /// How fast points of each body come deeper into their partners, at most [m/s].
    approach: Vec<f64>,
    /// Those that did before.
    parted: Vec<Memory>,
    /// Forces that layers have yet to feel, of which body [N].
    unfelt: Vec<(usize, f64)>,
    /// What the layers on free rigid bodies add to the square of the fastest motion [1/s^2].
    pub rate: f64,
    /// What the nodes had before, where it is asked for.
    begun: Option<(Begun<D>, Slowing)>,
    loads: ReferenceLoads<D>,
}

/// The layers of a body's contact after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Layers {
    /// Energy that its part of the layers stores [J].
    energy: f64,
    /// Whether it begins with the stress of another run, and what it touches is pressed as deep as it lies there.
    carried: bool,
    /// For how long its steps are as short as in contact yet [s]: a surface that bounces off and on under steps that
    /// jump takes energy from nowhere.
    lingers: f64,
}

/// The nodes of such a body as data: numbers one behind the other.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct SavedNodes {
    /// Number of the body among all.
    body: usize,
    places: Vec<f64>,
    velocities: Vec<f64>,
    forces: Vec<f64>,
    layers: Layers,
    /// None where nothing relaxes.
    accelerations: Vec<f64>,
}

/// What a rank tells the others in a step.
#[derive(Default, Serialize, Deserialize)]
struct Homeward {
    /// Bodies that are here: the velocities of the nodes after forces [m/s].
    bodies: Vec<(usize, Vec<f64>)>,
    /// What loads on them did.
    loads: Vec<(usize, LoadSums)>,
}

/// What of a cell the fastest wave may cross in a step of a body alone.
const ALONE: f64 = 0.9;

/// What of that it does cross, over what it does where bodies are on the common grid.
const LARGER_STEPS: f64 = 1.5;

/// How deep a layer may be pressed [cells]: a body is two cells thick at least, and a point beyond its middle leaves by
/// the other face.
const PIERCED: f64 = 1.0;

/// How much of a cell a point comes deeper into its partner in a step, at most: what strikes is stiffer within a step
/// than waves said.
const LANDING: f64 = 0.05;

/// Transits of a wave for which steps stay short once a body has touched, or will soon: each time that steps jump while
/// a body bounces it gains what it moves in the difference, v dt times its weight.
const LINGERS: f64 = 1000.0;

/// The usual Courant number, which bounds are measured by.
const USUAL: f64 = 0.4;

/// What of the step that the layer of contact allows is taken.
const SAFE: f64 = 0.8;

/// What of a cell a wave may cross in a step of a body whose surface is pressed on a rigid one everywhere, by a bound
/// of its fastest motion (Gershgorin's theorem):
///
/// ```text
/// dt = 2/w,   w^2 <= w_i^2 + max_I sum_s k A_s |N_I(X_s)| / M_I,   w_i = 2 c / (0.9 h)
/// ```
fn in_contact<const D: usize>(form: &Form<D>, surface: &[SurfacePoint<D>]) -> f64 {
    let mut held = vec![0.0; form.nodes()];
    for point in surface {
        let weights = &point.weights;
        weights.each(|k, value, _| held[weights.node + form.offsets[k] as usize] += point.area * value.abs());
    }
    for (node, masters, shares) in form.followers.iter() {
        let own = std::mem::take(&mut held[node]);
        masters.iter().zip(shares).for_each(|(&master, share)| held[master as usize] += own * share.abs());
    }
    let ratios = held.iter().zip(&form.node_volumes).filter(|(_, volume)| **volume > 0.0);
    let most = ratios.map(|(area, volume)| area / volume).fold(0.0, f64::max);
    2.0 / ((2.0 / ALONE).powi(2) + STIFFNESS * most * form.cell).sqrt()
}

impl<const D: usize> ReferenceBody<D> {
    /// That of a body of a scene, and its nodes before anything moves, with velocities by place [m/s].
    ///
    /// # Errors
    /// Its shape has no grid.
    pub fn new(
        scene: &Scene,
        number: usize,
        velocity: impl Fn([f64; 3]) -> [f64; 3],
    ) -> Result<(Self, Interior<D>), Problem> {
        let body = &scene.bodies[number];
        let material = &scene.materials[body.material];
        let no_grid = |why: NoForm| Problem {
            key: format!("bodies[{number}].shape"),
            found: format!("a shape without a grid of its own: {why}"),
            allowed: "shapes of two cells and more; or interior = \"grid\"".to_string(),
            help: None,
        };
        let (cell, faces) = (scene.cell(body), scene.held_faces(body));
        let form = Arc::new(Form::<D>::new(&body.shape, cell, faces).map_err(no_grid)?);
        let moduli = layer_moduli(scene, number);
        let width = width::<D>(&body.shape, &faces);
        let nodes =
            Interior::new(form.clone(), material.density, |place| Vector::of(velocity(place.space())));
        let surface = points(&body.shape, &form);
        let wave = (moduli[0] / material.density).sqrt();
        let constants = ReferenceBody {
            body: number,
            shape: MirroredShape::new(&body.shape, faces.mirrors(), D),
            wave,
            transit: width / wave,
            settling: width / wave * if scene.time.relax.is_some() { 1.0 } else { SETTLING },
            courant: in_contact(&form, &surface),
            surface,
            moduli,
            memory: FrictionMemory { length: width, speed: wave / TRANSITS },
        };
        Ok((constants, nodes))
    }
}

/// Moduli of the longitudinal and the shear wave at rest of a body, by which a layer on it is stiff [Pa].
fn layer_moduli(scene: &Scene, body: usize) -> [f64; 2] {
    let law = &scene.materials[scene.bodies[body].material].law;
    let wave = law.wave_modulus_at_rest(scene.dimension.thickness());
    [wave, law.elastic().shear_modulus.max(LEAST_SHEAR * wave)]
}

/// Shear over longitudinal modulus of a layer, at least.
const LEAST_SHEAR: f64 = 1e-3;

/// Narrowest side of a body, of half a model that of the whole [m].
fn width<const D: usize>(shape: &Shape, faces: &HeldFaces) -> f64 {
    let sides = shape.bounds(D).map_or([f64::INFINITY; 3], |bounds| faces.cut(bounds).size());
    let narrowest = |images: &dyn Fn(usize) -> f64| {
        (0..D).fold(f64::INFINITY, |least, axis| least.min(sides[axis] * images(axis)))
    };
    let whole = narrowest(&|axis| faces.images(axis));
    if whole.is_finite() { whole } else { narrowest(&|_| 1.0) }
}

/// Transits of a longitudinal wave through the narrowest side of a body in which friction on it follows pressure, where
/// no rule says how: a block that a spring drags slowly rubs by its coefficient from some four on.
const TRANSITS: f64 = 5.0;
/// Transits of a wave until most of the depth at which points came to touch is felt: longer than flat bodies bounce, or
/// they would gain by it. Bodies that are to come to rest take one.
const SETTLING: f64 = 10.0;

/// After which lengths everything is there again for the bodies of a scene.
pub(super) fn lengths<const D: usize>(scene: &Scene) -> PeriodLengths<D> {
    PeriodLengths(Vector::of(scene.periods()))
}

/// Whether a body of a scene is one.
pub(super) fn is_reference(scene: &Scene, body: usize) -> bool {
    scene.interior(body) == Kind::Reference
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// The place of a body among those on grids of their own, if it is one.
    pub(super) fn reference_of(&self, body: usize) -> Option<usize> {
        self.settings.references.binary_search_by_key(&body, |reference| reference.body).ok()
    }

    /// Finds where bodies on grids of their own touch, and gives their nodes the velocities that contact, loads and
    /// stress give them. Free rigid bodies and springs feel what touches later in the step.
    ///
    /// # Errors
    /// A function from outside that has no answer.
    pub(super) fn push_references(&mut self, dt: T) -> Result<(), StepError> {
        self.workspace.reference_signal = None;
        if self.settings.references.is_empty() {
            return Ok(());
        }
        let start = Instant::now();
        self.touch_references(dt.f64())?;
        self.watch.lap("contact", start);
        Ok(())
    }

    /// Moves them, once the velocities of all bodies are known: what the layers store in shear follows from these.
    ///
    /// # Errors
    /// A particle of theirs has a fault.
    pub(super) fn move_references(&mut self, dt: T) -> Result<(), StepError> {
        if self.settings.references.is_empty() {
            return Ok(());
        }
        let start = Instant::now();
        self.state.references.behind = true;
        self.slow_references(dt.f64());
        self.slip_references(dt.f64());
        self.pierced_reference().map_or(Ok(()), Err)?;
        self.watch.lap("contact", start);
        let start = Instant::now();
        let found = self.strain_references(dt, Asked::Forces);
        self.watch.lap("stress update", start);
        found.iter().for_each(|(_, damped)| self.workspace.sums.damped().add(*damped));
        let found: Vec<_> = found.into_iter().map(|(found, _)| found).collect();
        self.judge(found.iter().copied().fold(Found::NOTHING, Found::and).fault)?;
        let escaped = self.escaped_reference();
        if escaped.is_some() {
            self.show_references();
        }
        self.judge(escaped)?;
        self.workspace.reference_signal = Some(self.fastest_reference(&found));
        Ok(())
    }

    /// Forces of contact and loads, and the velocities that follow.
    fn touch_references(&mut self, dt: f64) -> Result<(), StepError> {
        let gravity = Vector::<f64, D>::of(self.settings.gravity.over_step(self.state.time, dt));
        let begun =
            self.measures_balance().then(|| (Begun::of(&self.state.references.nodes), self.slowing(dt)));
        let mut loads = self.feel_reference_loads(dt)?;
        let walls = self.rigid_walls();
        let Engine { settings, state, workspace, among, kernels, .. } = self;
        let Workspace { active, boundary, field, neighbours, skin, reference_walls, .. } = workspace;
        let grid = CommonGrid { active, boundary, lattice: &settings.lattice, kernels };
        let count = state.bodies.len();
        let mut bodies = deforming(&settings.references, &mut state.references.nodes);
        let meets = |body: usize, other: usize| {
            let rules = &settings.rules;
            other >= count || rules.rule(rules.number(body, other)).law != ContactLaw::None
        };
        if !settings.common.is_empty() {
            let seen = (&settings.common[..], &state.bodies[..], &field.nodes[..]);
            *skin = Skin::new(grid, seen, (&bodies, &meets), among.as_ref());
        }
        let rigid = rigid_bodies(&settings.rigid, &state.bodies, settings.lengths);
        let common = common_bodies(&settings.common, (grid, skin));
        let obstacles = all_obstacles((&rigid, &common), &walls);
        let numbers = |a: usize, partner: Partner| {
            let other = match partner {
                Partner::Deforming(b) => settings.references[b].body,
                Partner::Obstacle(r) => obstacles[r].body(),
            };
            [settings.references[a].body, other]
        };
        let meet = |a: usize, partner: Partner| {
            let [body, other] = numbers(a, partner);
            meets(body, other)
        };
        let starts = state.steps == 0;
        let bond = |a: usize, partner: Partner| {
            let [body, other] = numbers(a, partner);
            if other < count { bond(&settings.rules, [body, other], starts) } else { Bond::default() }
        };
        let bond = settings.rules.bond().then_some(&bond as &(dyn Fn(usize, Partner) -> Bond + Sync));
        let known = &state.references.touching;
        let layers = &mut state.references.layers;
        layers.resize(bodies.len(), Layers::default());
        let before = layers.clone();
        let ready: Vec<bool> = before.iter().map(|layers| layers.lingers > 0.0).collect();
        let search = Search { known, meet: &meet, bond, lengths: settings.lengths, ready: &ready, dt };
        let (mut touches, soon) = find((&bodies, &obstacles), search, neighbours);
        let lingers = |side: usize| LINGERS * settings.references[side].transit + dt;
        soon.into_iter().for_each(|side| layers[side].lingers = lingers(side));
        // Where it comes unforeseen, a step in which a body comes to touch is too long for its layer: that presses from
        // the next one on.
        let mut waiting: Vec<Touch<D>> = Vec::new();
        touches.retain_mut(|touch| {
            let sides = touch.sides();
            if touch.memory.age == 0.0 && sides.iter().any(|&side| before[side].carried) {
                touch.memory.age = f64::MIN_POSITIVE;
            }
            sides.iter().for_each(|&side| layers[side].lingers = lingers(side));
            let presses = sides.iter().all(|&side| ready[side]) || touch.memory.age > 0.0;
            if !presses {
                waiting.push(*touch);
            }
            presses
        });
        let parted: Vec<Memory> = parted(known, &touches).copied().collect();
        begin(&bodies, &obstacles, &mut touches, dt);
        follow(&bodies, &obstacles, &mut touches, dt);
        let pressed = waiting.iter().map(|touch| (touch.side, touch.area * touch.pressure()));
        let unfelt = touches.iter().map(|touch| (touch.side, touch.unfelt_force()));
        let unfelt = pressed.chain(unfelt).collect();
        press(&mut bodies, (&mut touches, dt), &|touch| friction(settings, touch, count));
        drop(obstacles);
        grid.push((&settings.common, skin), &mut field.nodes, &touches);
        reference_walls.clear();
        // Velocities lie half a step before places, but at the start they do not: what begins with a stress would get
        // twice the push that it gives in half a step.
        let kick = if state.steps == 0 && settings.begins_stressed { 0.5 * dt } else { dt };
        let mut own = Homeward::default();
        for (place, (body, loads)) in bodies.iter_mut().zip(&loads.bodies).enumerate() {
            // Of several ranks one moves the nodes of a body, that with its particles.
            if state.bodies[body.body].particles.is_empty() {
                continue;
            }
            let is_held = body.interior.form.held.is_some() && !state.walls.is_empty();
            let before = is_held.then(|| body.interior.velocities.clone());
            body.interior.accelerate(kick, gravity, &loads.inertia);
            if let Some(before) = before {
                let reactions = body.interior.reactions(&before, gravity, &loads.inertia, kick);
                RigidWall::book_held(&walls, reference_walls, (body.body, &reactions), count);
            }
            if among.is_some() {
                own.bodies.push((place, flat(&body.interior.velocities)));
            }
        }
        for (place, velocities) in gathered(among.as_ref(), own).into_iter().flat_map(|one| one.bodies) {
            bodies[place].interior.velocities = vectors(&velocities);
        }
        loads.keep(&bodies, dt);
        workspace.reference_touching =
            Touching { touches, waiting, parted, unfelt, begun, loads, ..Touching::default() };
        Ok(())
    }

    /// Slows the nodes down once all has acted on them, and books what loads did.
    fn slow_references(&mut self, dt: f64) {
        let Engine { settings, state, workspace, among, .. } = self;
        let Touching { unfelt, begun, loads, .. } = &workspace.reference_touching;
        let mut bodies = deforming(&settings.references, &mut state.references.nodes);
        if let Some((begun, slowing)) = begun {
            let here = |body: usize| !state.bodies[body].particles.is_empty();
            // Bodies do not rest before their layers have felt all.
            let unbalanced = &mut workspace.sums.nodes[0];
            let own = unfelt.iter().filter(|(side, _)| here(bodies[*side].body));
            own.for_each(|(_, force)| unbalanced.add(*force));
            let accelerations = &mut state.references.accelerations;
            begun.slow_down((&mut bodies, accelerations), slowing, (&mut workspace.sums.nodes, &here));
        }
        if !settings.loads.is_empty() {
            let own = Homeward { loads: loads.booked(&bodies, dt), ..Homeward::default() };
            let mut booked: Vec<_> =
                gathered(among.as_ref(), own).into_iter().flat_map(|one| one.loads).collect();
            booked.sort_by_key(|(load, _)| *load);
            booked.into_iter().for_each(|(load, sums)| state.loads[load].add(&sums));
        }
    }

    /// What the layers store and lose by the velocities of the step, which then moves the nodes.
    fn slip_references(&mut self, dt: f64) {
        let walls = self.rigid_walls();
        let Engine { settings, state, workspace, among, kernels, .. } = self;
        let Workspace { active, boundary, field, neighbours, skin, reference_touching, .. } = workspace;
        let Touching { touches, waiting, parted, approach: fastest, .. } = reference_touching;
        let grid = CommonGrid { active, boundary, lattice: &settings.lattice, kernels };
        if !settings.common.is_empty() {
            skin.follow(grid, &field.nodes, among.as_ref());
        }
        let rigid = rigid_bodies(&settings.rigid, &state.bodies, settings.lengths);
        let common = common_bodies(&settings.common, (grid, skin));
        let obstacles = all_obstacles((&rigid, &common), &walls);
        let count = state.bodies.len();
        let bodies = deforming(&settings.references, &mut state.references.nodes);
        let layers = &mut state.references.layers;
        layers.iter_mut().for_each(|own| {
            *own = Layers { lingers: (own.lingers - dt).max(0.0), ..Layers::default() };
        });
        let mut store = |side: usize, energy: f64| {
            layers[side].energy += energy;
            layers[side].lingers = LINGERS * settings.references[side].transit;
        };
        for touch in &*touches {
            match touch.met {
                Met::Deforming(b, _) => {
                    [touch.side, b].iter().for_each(|&side| store(side, 0.5 * touch.energy()))
                }
                Met::Obstacle(_) => store(touch.side, touch.energy()),
            }
        }
        fastest.resize(bodies.len(), 0.0);
        for touch in touches.iter().chain(&*waiting) {
            let speed = approach(&bodies, &obstacles, touch);
            touch.sides().iter().for_each(|&side| fastest[side] = fastest[side].max(speed));
        }
        let touching = &mut state.references.touching;
        *touching = slip(&bodies, &obstacles, (touches, dt), &|touch| friction(settings, touch, count));
        touching.extend(waiting.iter().map(|touch| touch.memory));
        touching.sort_by_key(Memory::key);
        neighbours.moved((&bodies, &obstacles), dt);
        books::book(&mut workspace.reference_touches, &obstacles, (touches, parted, dt), count);
        if !state.walls.is_empty() {
            let here = |body: usize| !state.bodies[body].particles.is_empty();
            RigidWall::book(&walls, &mut workspace.reference_walls, (touches, dt), (here, count));
        }
        if let Some(among) = among {
            workspace.reference_touches.retain(|touch| among.keeps(touch.bodies));
        }
        bodies.into_iter().for_each(|body| body.interior.advance(dt));
    }

    /// The closed faces of the domain.
    fn rigid_walls(&self) -> Vec<RigidWall<D>> {
        let Some(corners) = self.settings.domain else { return Vec::new() };
        let (lattice, bodies) = (&self.settings.lattice, self.state.bodies.len());
        let walls = self.settings.walls.iter().zip(bodies..);
        let rigid = |(wall, number)| {
            RigidWall::new(number, wall, middle(wall, lattice, corners), self.settings.lengths)
        };
        walls.map(rigid).collect()
    }

    /// Lets particles that a step has left behind take what the nodes say.
    pub(super) fn show_references(&mut self) {
        if self.state.references.behind {
            self.strain_references(T::ZERO, Asked::State);
            self.state.references.behind = false;
        }
    }

    /// Gives the nodes the forces of the stress with which their bodies begin.
    pub(super) fn begin_stressed(&mut self) {
        self.strain_references(T::ZERO, Asked::Forces);
    }

    /// Lets particles take the deformation that the nodes say, and adds up the forces of their stress: what that found
    /// of each body, and what bulk viscosity took of it [J].
    fn strain_references(&mut self, dt: T, asked: Asked) -> Vec<(Found<T>, f64)> {
        let processor = match self.settings.path {
            ParticleLoop::Lanes(processor) => processor,
            ParticleLoop::OneLane => Processor::Any,
        };
        let Engine { settings, state, .. } = self;
        let mut found = vec![(Found::NOTHING, 0.0); settings.references.len()];
        let viscosity = settings.viscosity;
        let (bodies, nodes) = (Disjoint::new(&mut state.bodies), Disjoint::new(&mut state.references.nodes));
        each(&mut found, 1, |place, found| {
            let (body, table) = (&settings.references[place].body, &settings.tables[place]);
            // SAFETY: every body and its nodes belong to one entry.
            let (here, interior) = unsafe { (bodies.get(*body), nodes.get(place)) };
            let Body::Here(here) = here else { return };
            if here.particles.is_empty() {
                return;
            }
            let straining = Straining { body: *body, dt, viscosity, processor, asked };
            *found = strain(interior, table, (&here.matter, &mut here.particles), straining);
        });
        found
    }

    /// How many cells of the grid of a body make one of the common grid; one where it has none of its own.
    pub(super) fn finer(&self, body: usize) -> f64 {
        self.reference_of(body).map_or(1.0, |place| {
            self.settings.lattice.cell.f64() / T::of(self.state.references.nodes[place].form.cell).f64()
        })
    }

    /// The signal by which the common grid's cells give the step that these bodies allow [m/s], from the fastest wave
    /// in undeformed lengths of each. Those that touch others, or did so just now, have shorter steps.
    fn fastest_reference(&self, found: &[Found<T>]) -> f64 {
        let courant = self.settings.time.courant;
        // Nothing is asked of the way to rest: its steps are the longest that are stable.
        let least = if self.settings.time.relax.is_some() { 0.0 } else { 1.0 / LARGER_STEPS };
        let of_body = |place: usize| {
            let (own, wave) = (&self.settings.references[place], found[place].signal.f64());
            let finer = self.finer(own.body);
            let alone = wave * least.max(courant / ALONE);
            if self.state.references.layers[place].lingers == 0.0 {
                return finer * alone;
            }
            let landing = self.workspace.reference_touching.approach.get(place).map_or(0.0, |v| v / LANDING);
            let waves = wave.max(own.wave) * (USUAL / SAFE).max(courant) / own.courant;
            finer * alone.max(waves).max(landing * courant)
        };
        let waves = (0..found.len()).map(of_body).fold(0.0, f64::max);
        // Both share the same w = 2/dt: squares add up.
        let rocking = 0.5 * self.workspace.reference_touching.rate.sqrt() * self.settings.lattice.cell.f64();
        let waves = waves.hypot(rocking * (USUAL / SAFE).max(courant));
        let speed_of = |(own, nodes): (&ReferenceBody<D>, &Interior<D>)| {
            let square = nodes.velocities.iter().fold(0.0, |most: f64, v| most.max(v.dot(*v)));
            self.finer(own.body) * square.sqrt()
        };
        let bodies = self.settings.references.iter().zip(&self.state.references.nodes);
        let speed = bodies.map(speed_of).fold(0.0, f64::max);
        // Two bodies come nearer by twice that.
        waves.max(2.0 * speed)
    }

    /// Angular velocity of such a body, by its nodes: I w = L about the centre [rad/s].
    pub(super) fn spin_of(&self, place: usize, totals: &Totals) -> [f64; 3] {
        let nodes = &self.state.references.nodes[place];
        let (center, momentum) = (totals.first_moment.map(|x| x / totals.mass), totals.momentum);
        let orbit = cross(center, momentum);
        let turn = [0, 1, 2].map(|k| totals.angular_momentum[k] - orbit[k]);
        let mut inertia = Matrix([[0.0; 3]; 3]);
        for (mass, at, _) in nodes.carried() {
            let arm = Vector(at.space()) - Vector(center);
            for i in 0..3 {
                for j in 0..3 {
                    let square = if i == j { arm.dot(arm) } else { 0.0 };
                    inertia.0[i][j] += mass * (square - arm[i] * arm[j]);
                }
            }
        }
        if D == 2 {
            return [0.0, 0.0, turn[2] / inertia.0[2][2]];
        }
        let inverse = inertia.inverse();
        [0, 1, 2].map(|i| (0..3).map(|j| inverse.0[i][j] * turn[j]).sum())
    }

    /// A point that its layer feels too deep to keep the bodies apart.
    fn pierced_reference(&self) -> Option<StepError> {
        let Touching { touches, .. } = &self.workspace.reference_touching;
        let depth = |touch: &Touch<D>| -touch.gap / self.state.references.nodes[touch.side].form.cell;
        let touch = touches.iter().find(|touch| depth(touch) > PIERCED)?;
        let [body, partner] = [touch.memory.body as usize, touch.memory.partner as usize];
        Some(StepError::Pierced {
            body: self.name_of(body).to_string(),
            partner: match partner < self.state.bodies.len() {
                true => format!("`{}`", self.name_of(partner)),
                false => "a face of the domain".to_string(),
            },
            depth: depth(touch),
            position: touch.at.space(),
            time: self.state.time,
        })
    }

    /// The first particle that has left the domain through an open face.
    fn escaped_reference(&self) -> Option<ParticleFault> {
        let [mut min, mut max] = self.settings.held?;
        for wall in &self.settings.walls {
            match wall.inward {
                1 => min[wall.axis] = T::of(f64::NEG_INFINITY),
                _ => max[wall.axis] = T::of(f64::INFINITY),
            }
        }
        let [min, max] = [min, max].map(Vector::space);
        let outside = |x: [f64; 3]| (0..D).any(|k| x[k] < min[k] || x[k] > max[k]);
        let nodes = &self.state.references.nodes;
        self.settings.references.iter().zip(nodes).find_map(|(reference, nodes)| {
            // Particles lie in the hull of the nodes that they see.
            let seen = |node: &u32| outside(nodes.places[*node as usize].space());
            let moved = nodes.places.iter().zip(&nodes.masses).filter(|(_, mass)| **mass > 0.0);
            if !moved.map(|(place, _)| place).any(|place| outside(place.space()))
                && !nodes.form.followers.nodes.iter().any(seen)
            {
                return None;
            }
            let numbers = self.state.bodies[reference.body].particles.numbers();
            let place = |start: &Vector<f64, D>| nodes.at(&nodes.form.weights(*start), &nodes.places);
            let mut places = nodes.form.places.iter().take(numbers.len()).map(place);
            let particle = places.position(|place| outside(place.space()))?;
            let number = numbers[particle];
            Some(ParticleFault { body: reference.body, particle, number, kind: FaultKind::Escaped })
        })
    }

    /// What stress and weight do to these bodies in half of the next step, each counted as it is or the other way
    /// round: by so much kinetic and strain energy, which are half a step apart, do not add up [J].
    ///
    /// ```text
    /// sum M_I v_I(t - dt/2) . v_I(t + dt/2) / 2 = sum M_I v_I^2 / 2 + dt/2 sum v_I . (f_I + M_I g)
    /// ```
    /// With the strain energy the left side stays as it is where a body swings freely.
    pub(super) fn work_of_half_a_step(&self) -> f64 {
        if self.settings.references.is_empty() {
            return 0.0;
        }
        let gravity = Vector::of(self.settings.gravity.constant().unwrap_or_default());
        let half = self.state.signal.map_or(0.0, |_| 0.5 * self.stable());
        let here = self.settings.references.iter().zip(&self.state.references.nodes).enumerate();
        let here = here.filter(|(_, (of, _))| !self.state.bodies[of.body].particles.is_empty());
        let own: Vec<(usize, f64)> =
            here.map(|(place, (_, nodes))| (place, (half * nodes.power(gravity)).abs())).collect();
        let mut all = match &self.among {
            Some(among) => among.gathered(&own).concat(),
            None => own,
        };
        // One order of sums, however many ranks there are.
        all.sort_by_key(|(place, _)| *place);
        all.into_iter().map(|(_, work)| work).sum()
    }

    /// What a body adds up to, of its nodes what is known better there: momentum, spin and kinetic energy; and what its
    /// part of the layer stores where it touches.
    pub(super) fn with_nodes(&self, body: usize, mut totals: Totals) -> Totals {
        let Some(place) = self.reference_of(body) else { return totals };
        let nodes = &self.state.references.nodes[place];
        totals.kinetic = nodes.kinetic();
        totals.strain += self.state.references.layers.get(place).map_or(0.0, |layers| layers.energy);
        totals.momentum = nodes.momentum().space();
        let mut sums = [[0.0; 3]; 2];
        for (mass, place, velocity) in nodes.carried() {
            let turn = cross(place.space(), velocity.space());
            for k in 0..3 {
                sums[0][k] += mass * turn[k];
                sums[1][k] += mass * place.space()[k];
            }
        }
        (totals.angular_momentum, totals.first_moment) = (sums[0], sums[1]);
        totals
    }

    /// The nodes of these bodies as data, and the points that touch. Of several ranks the first knows the forces on
    /// all.
    pub(super) fn saved_nodes(&self) -> (Vec<SavedNodes>, Vec<Memory>) {
        // Particles are saved only when none is behind.
        let References { nodes, behind: _, touching, layers, accelerations } = &self.state.references;
        let mut saved: Vec<SavedNodes> = (nodes.iter().enumerate())
            .map(|(place, nodes)| SavedNodes {
                body: self.settings.references[place].body,
                places: flat(&nodes.places),
                velocities: flat(&nodes.velocities),
                forces: flat(&nodes.forces),
                layers: layers.get(place).copied().unwrap_or_default(),
                accelerations: accelerations.get(place).map_or(Vec::new(), |all| flat(all)),
            })
            .collect();
        if self.among.is_some() && !saved.is_empty() {
            let own = saved.iter().zip(&self.settings.references).enumerate();
            let own = own.filter(|(_, (_, of))| !self.state.bodies[of.body].particles.is_empty());
            let own: Vec<_> = own.map(|(place, (saved, _))| (place, saved.forces.clone())).collect();
            for (place, forces) in self.told_first(own).into_iter().flatten() {
                saved[place].forces = forces;
            }
        }
        (saved, touching.clone())
    }

    /// Whether saved nodes are those of these bodies.
    pub(super) fn are_nodes(&self, saved: &[SavedNodes]) -> bool {
        let nodes = &self.state.references.nodes;
        saved.len() == nodes.len() && saved.iter().zip(nodes).all(|(saved, nodes)| saved.fits(nodes))
    }

    /// What begins as it was in another run: nodes of bodies of the same names, by their places here, and points that
    /// touched.
    ///
    /// # Errors
    /// A body is on a grid of its own in one of the two only, or is another.
    pub(super) fn carried_nodes(
        &self,
        saved: &SavedState,
        velocities: StartVelocities,
    ) -> Result<CarriedNodes, RestoreError> {
        let named: HashMap<&str, usize> =
            saved.bodies.iter().zip(0..).map(|(body, number)| (body.name.as_str(), number)).collect();
        let mut carried = CarriedNodes::default();
        let mut numbers: HashMap<u32, u32> = HashMap::new();
        for number in 0..self.state.bodies.len() {
            let Some(&there) = named.get(self.name_of(number)) else { continue };
            numbers.insert(there as u32, number as u32);
            let off = |what: &str| Err(RestoreError::new(format!("body `{}` {what}", self.name_of(number))));
            let nodes = saved.nodes.iter().find(|nodes| nodes.body == there);
            match (self.reference_of(number), nodes) {
                (None, None) => {}
                (Some(place), None) if saved.of_snapshot => carried.fitted.push(place),
                (Some(_), None) => {
                    return off("has interior = \"reference\" in the scene, and \"grid\" in it");
                }
                (None, Some(_)) => {
                    return off("has interior = \"grid\" in the scene, and \"reference\" in it");
                }
                (Some(place), Some(nodes)) if !nodes.fits(&self.state.references.nodes[place]) => {
                    return off("has other nodes in it: its shape or its cell is another");
                }
                (Some(place), Some(nodes)) => {
                    let mut nodes = nodes.clone();
                    if velocities == StartVelocities::Zero {
                        nodes.velocities.fill(0.0);
                    }
                    carried.nodes.push((place, nodes));
                }
            }
        }
        // Faces of the domain have the numbers behind those of the bodies.
        let [there, here] = [saved.bodies.len(), self.state.bodies.len()].map(|count| count as u32);
        let walls = (0..self.settings.walls.len() as u32).map(|wall| (there + wall, here + wall));
        numbers.extend(walls);
        let here = |memory: &Memory| {
            let [body, partner] = [memory.body, memory.partner].map(|number| numbers.get(&number).copied());
            Some(Memory { body: body?, partner: partner?, ..*memory })
        };
        carried.touching = saved.touching.iter().filter_map(here).collect();
        carried.touching.sort_by_key(Memory::key);
        Ok(carried)
    }

    /// Begins with these nodes.
    pub(super) fn begin_nodes(&mut self, carried: CarriedNodes) {
        let References { nodes, behind, touching, layers, accelerations } = &mut self.state.references;
        *behind = false;
        accelerations.clear();
        layers.resize(nodes.len(), Layers::default());
        for (place, saved) in &carried.nodes {
            saved.put_in(&mut nodes[*place]);
            layers[*place] = saved.layers;
        }
        for &place in &carried.fitted {
            layers[place].carried = true;
        }
        *touching = carried.touching;
        self.workspace.neighbours = Neighbours::default();
        for place in 0..self.settings.references.len() {
            self.order_by_number(self.settings.references[place].body);
        }
        self.fit_nodes(&carried.fitted);
    }

    /// Gives a body the velocities of its particles [m/s], as nearly as its functions can.
    pub(super) fn put_velocities(&mut self, place: usize, values: &[f64]) {
        let body = self.settings.references[place].body;
        let nodes = &mut self.state.references.nodes[place];
        nodes.velocities = nodes.fitted(&vectors(values));
        let particles = &mut self.state.bodies[body].particles;
        for (i, &start) in nodes.form.places.iter().enumerate() {
            let velocity = nodes.at(&nodes.form.weights(start), &nodes.velocities);
            let particle = particles.get(i);
            particles.set(i, &Particle { velocity: Vector::from_fn(|k| T::of(velocity[k])), ..particle });
        }
    }

    /// Finds the nodes of bodies whose particles alone are known, where these are here.
    fn fit_nodes(&mut self, places: &[usize]) {
        for &place in places {
            let particles = &self.state.bodies[self.settings.references[place].body].particles;
            if particles.is_empty() {
                continue;
            }
            let nodes = &mut self.state.references.nodes[place];
            let of = |what: &dyn Fn(&Particle<T, D>) -> Vector<T, D>| -> Vec<Vector<f64, D>> {
                particles.iter().map(|p| Vector::from_fn(|k| what(&p)[k].f64())).collect()
            };
            let ways =
                of(&|p| p.position).into_iter().zip(&nodes.form.places).map(|(now, start)| now - *start);
            let moved = nodes.fitted(&ways.collect::<Vec<_>>());
            nodes.places = (0..moved.len()).map(|node| nodes.form.node_place(node) + moved[node]).collect();
            nodes.velocities = nodes.fitted(&of(&|p| p.velocity));
            nodes.follow();
        }
        if let Some(among) = &self.among {
            let nodes = &self.state.references.nodes;
            let here = |place: &&usize| {
                !self.state.bodies[self.settings.references[**place].body].particles.is_empty()
            };
            let own = places.iter().filter(here);
            let own: Vec<(usize, Vec<f64>, Vec<f64>)> = own
                .map(|&place| (place, flat(&nodes[place].places), flat(&nodes[place].velocities)))
                .collect();
            for (place, found, velocities) in among.gathered(&own).into_iter().flatten() {
                let nodes = &mut self.state.references.nodes[place];
                (nodes.places, nodes.velocities) = (vectors(&found), vectors(&velocities));
            }
        }
        if !places.is_empty() {
            // Forces of the stress that this is.
            self.strain_references(T::ZERO, Asked::Forces);
            self.state.references.behind = true;
            self.show_references();
        }
    }

    /// Goes on with these nodes.
    pub(super) fn take_up_nodes(&mut self, saved: &[SavedNodes], touching: Vec<Memory>) {
        self.state.references.nodes.iter_mut().zip(saved).for_each(|(nodes, saved)| saved.put_in(nodes));
        self.state.references.layers = saved.iter().map(|saved| saved.layers).collect();
        self.state.references.accelerations = if saved.iter().all(|saved| saved.accelerations.is_empty()) {
            Vec::new()
        } else {
            saved.iter().map(|saved| vectors(&saved.accelerations)).collect()
        };
        self.state.references.touching = touching;
        self.state.references.behind = false;
    }
}

impl SavedNodes {
    /// Whether they are those of such a body.
    fn fits<const D: usize>(&self, nodes: &Interior<D>) -> bool {
        let fits = |all: &[f64]| all.len() == D * nodes.places.len() && all.iter().all(|x| x.is_finite());
        [&self.places, &self.velocities, &self.forces].iter().all(|all| fits(all))
            && (self.accelerations.is_empty() || fits(&self.accelerations))
    }

    fn put_in<const D: usize>(&self, nodes: &mut Interior<D>) {
        nodes.places = vectors(&self.places);
        nodes.velocities = vectors(&self.velocities);
        nodes.forces = vectors(&self.forces);
    }
}

/// Nodes of bodies as they were in another run, by their places here, and points that touched there.
#[derive(Debug, Default)]
pub struct CarriedNodes {
    nodes: Vec<(usize, SavedNodes)>,
    touching: Vec<Memory>,
    /// Those of which the other run has particles alone.
    fitted: Vec<usize>,
}

fn flat<const D: usize>(all: &[Vector<f64, D>]) -> Vec<f64> {
    all.iter().flat_map(|v| v.0).collect()
}

fn vectors<const D: usize>(all: &[f64]) -> Vec<Vector<f64, D>> {
    all.as_chunks().0.iter().map(|v| Vector(*v)).collect()
}

/// What each rank says; what one says that is alone.
fn gathered<T: Laned>(among: Option<&Among<T>>, own: Homeward) -> Vec<Homeward> {
    match among {
        Some(among) => among.gathered(&own),
        None => vec![own],
    }
}

/// Bodies as contact sees them, with their nodes.
fn deforming<'a, const D: usize>(
    references: &'a [ReferenceBody<D>],
    nodes: &'a mut [Interior<D>],
) -> Vec<Deforming<'a, D>> {
    let of = |(constants, interior): (&'a ReferenceBody<D>, &'a mut Interior<D>)| Deforming {
        body: constants.body,
        interior,
        shape: &constants.shape,
        surface: &constants.surface,
        moduli: constants.moduli,
        settling: constants.settling,
    };
    references.iter().zip(nodes).map(of).collect()
}

/// Rigid bodies as contact sees them.
fn rigid_bodies<'a, T, const D: usize>(
    rigid: &[usize],
    bodies: &'a [Body<T, D>],
    lengths: PeriodLengths<D>,
) -> Vec<RigidBody<'a>> {
    rigid.iter().filter_map(|&body| RigidBody::new(body, &bodies[body], lengths)).collect()
}

/// Bodies on the common grid as contact sees them.
fn common_bodies<'a, T: Laned, const D: usize>(
    common: &'a [CommonPartner],
    near: (CommonGrid<'a, T, D>, &'a Skin),
) -> Vec<CommonBody<'a, T, D>> {
    common.iter().map(|partner| CommonBody::new(partner, near)).collect()
}

/// Rigid bodies and those on the common grid, in their order, and closed faces.
fn all_obstacles<'a, T: Laned, const D: usize>(
    (rigid, common): (&'a [RigidBody<'_>], &'a [CommonBody<'_, T, D>]),
    walls: &'a [RigidWall<D>],
) -> Vec<&'a dyn Obstacle> {
    let rigid = rigid.iter().map(|body| body as &dyn Obstacle);
    let mut bodies: Vec<_> = rigid.chain(common.iter().map(|body| body as &dyn Obstacle)).collect();
    bodies.sort_by_key(|body| body.body());
    bodies.into_iter().chain(walls.iter().map(|wall| wall as &dyn Obstacle)).collect()
}

/// How two bodies touch where they do not press, in the first step or a later one.
fn bond<T: Laned>(rules: &Rules<T>, [a, b]: [usize; 2], starts: bool) -> Bond {
    let rule = rules.rule(rules.number(a, b));
    let friction = &rule.friction;
    Bond {
        forms: starts && (friction.adhesion > T::ZERO || rule.law == ContactLaw::Glued),
        is_glue: rule.law == ContactLaw::Glued,
        resists: friction.cohesion > T::ZERO || friction.viscosity > T::ZERO,
    }
}

/// What a point bears, by its face or the rule of its pair, where there are so many bodies; without a memory of
/// friction there, with that of the body that is slower.
fn friction<T: Laned, const D: usize>(
    settings: &Settings<T, D>,
    touch: &Touch<D>,
    bodies: usize,
) -> Friction {
    let [a, b] = [touch.memory.body as usize, touch.memory.partner as usize];
    if let Some(wall) = b.checked_sub(bodies) {
        return walls::friction(settings.walls[wall].face);
    }
    let (rules, references) = (&settings.rules, &settings.references);
    let rule = rules.rule(rules.number(a, b));
    if rule.law == ContactLaw::Glued {
        return Friction::GLUE;
    }
    let double = rule.friction.double();
    let own = references[touch.side].memory;
    let usual = match touch.met {
        Met::Deforming(b, _) if references[b].memory.time() > own.time() => references[b].memory,
        _ => own,
    };
    let memory = rule.friction_memory.unwrap_or(usual);
    Friction {
        at_rest: double.at_rest,
        kinetic: double.kinetic,
        decay_speed: double.decay_speed,
        memory: (memory.length > 0.0).then_some(memory),
        cohesion: double.cohesion,
        adhesion: double.adhesion,
        viscosity: double.viscosity,
    }
}
