//! What a run will be, before it runs.

use super::bodies::{FillingExtent, smallest_extent};
use super::contact::{ContactEstimate, ContactResolution, Estimates, estimates, starting_velocity};
use super::effort::{OwnGridWork, own_grid_work};
use super::loads::{self, LoadReport};
use super::memory::{BodySize, Footprint};
use super::neighbours::pairs_within;
use super::own_grid::own_grids;
use super::rules::RuleReport;
use super::table::short;
use super::warning::{NOT_RESOLVED, Warning, and_more, few};
use super::{
    dead_keys, examine, joint_freedom, joints, locking, mass, memory, overlap, pulses, rigid_pairs, rules,
    slits, soil, supports, thickness,
};
use crate::geometry::{Bounds, Shape};
use crate::rigid::longest_step;
use crate::scene::{Body, BodyMotion, Dimension, Interior, Moment, Problem, Scene, Source};
use crate::tensor::Vector;
use serde::Serialize;

/// How fast the machine is that will run the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MachineSpeed {
    /// Particles times steps that one core does in a second [1/s].
    pub particle_steps_per_second: f64,
    /// Cores in use.
    pub cores: usize,
}

impl Default for MachineSpeed {
    /// All cores of this machine, each at a million particle-steps per second, about what GIMP in space does.
    fn default() -> Self {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        MachineSpeed { particle_steps_per_second: 1e6, cores }
    }
}

/// What a run will be, before it runs. Shown as a table of one screen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The scene's title.
    pub title: String,
    /// Plane or space.
    pub dimension: Dimension,
    /// Side of a grid cell [m].
    pub cell: f64,
    /// Particles along each side of a cell, in the bodies with the fewest and with the most.
    pub particles_per_side: [usize; 2],
    /// Where bodies that deform are computed, and why, if any could be on a grid of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interior: Option<String>,
    /// The bodies, in the order of the scene.
    pub bodies: Vec<BodyReport>,
    /// The materials, in the order of the scene.
    pub materials: Vec<MaterialReport>,
    /// Particles in all bodies, with those that bodies without bounds will have.
    pub particles: usize,
    /// Places at which free rigid bodies touch others at the start, estimated.
    pub rigid_contacts: usize,
    /// What these cost in a step, in particles.
    pub contacts_as_particles: f64,
    /// What bodies on grids of their own take, if there are some.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub own_grids: Option<OwnGridWork>,
    /// Memory of bodies and grids, estimated [bytes].
    pub memory: f64,
    /// Memory beside it while a checkpoint is written: a copy of the bodies, estimated [bytes].
    pub checkpoint_memory: f64,
    /// Simulated time at the end [s].
    pub end: f64,
    /// Time step at the start [s].
    pub time_step: f64,
    /// Steps of that length to the end.
    pub steps: u64,
    /// Whether dynamic relaxation ends the run as soon as the bodies are at rest, mostly long before.
    pub ends_at_rest: bool,
    /// The machine that the expected time is for.
    pub machine: MachineSpeed,
    /// Expected wall time [s].
    pub wall_time: f64,
    /// Which contact rules hold, and between which bodies.
    pub rules: Vec<RuleReport>,
    /// Where supports and loads act.
    pub loads: Vec<LoadReport>,
    /// Whether contacts are resolved, the narrowest first.
    pub contacts: Vec<ContactEstimate>,
    /// Names of pairs that are near each other, or in a contact rule, and whose shapes tell no estimate.
    pub contacts_unknown: Vec<[String; 2]>,
    /// What is doubtful but allowed.
    pub warnings: Vec<Warning>,
}

/// A body as it will start.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyReport {
    /// Its name.
    pub name: String,
    /// Name of its material.
    pub material: String,
    /// It does not deform.
    pub rigid: bool,
    /// Number of particles; of a rigid body without bounds an estimate, of those around bodies that deform.
    pub particles: usize,
    /// Mass of the particles [kg], in the plane per metre of depth.
    pub mass: f64,
    /// Sides of the box round the particles, infinite without bounds [m].
    pub size: [f64; 3],
}

/// A material and its waves at rest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MaterialReport {
    /// Its name.
    pub name: String,
    /// sqrt((K + 4G/3) / rho), in plane stress sqrt(E / (rho (1 - nu^2))) [m/s]
    pub longitudinal_speed: f64,
    /// sqrt(G / rho) [m/s]
    pub shear_speed: f64,
}

/// Finds what is wrong with a scene, else says what the run will be on this machine; see [`Report::on`] for another.
///
/// # Errors
/// As [`super::problems`].
pub fn report(scene: &Scene, footprint: &dyn Footprint) -> Result<Report, Problem> {
    let (extents, loads) = examine(scene)?;
    let near_others = |body| memory::particles_near_others(footprint, (scene, &extents), body);
    let counts: Vec<_> =
        (extents.iter().enumerate()).map(|(body, extent)| extent.particles + near_others(body)).collect();
    let sizes: Vec<BodySize> = (counts.iter().zip(own_grids(scene, &extents)))
        .map(|(&particles, grid)| BodySize { particles, grid })
        .collect();
    let boxes: Vec<_> = extents.iter().map(|extent| extent.bounds).collect();
    let time_step = time_step(scene, &extents);
    let Estimates { found: contacts, unknown: contacts_unknown } = estimates(scene, &extents);
    let places = rigid_contacts(scene, &boxes);
    let report = Report {
        title: scene.title.clone(),
        dimension: scene.dimension,
        cell: scene.discretization.cell,
        particles_per_side: fewest_and_most(scene),
        interior: interior(scene),
        bodies: scene
            .bodies
            .iter()
            .zip(extents.iter().zip(&counts))
            .map(|(body, (extent, &particles))| BodyReport { particles, ..of_body(scene, body, extent) })
            .collect(),
        materials: of_materials(scene),
        particles: counts.iter().sum(),
        rigid_contacts: places.len(),
        contacts_as_particles: places.iter().sum(),
        own_grids: own_grid_work(scene, &sizes, (time_step, fastest(scene, &extents))),
        memory: footprint.memory(scene, &sizes),
        checkpoint_memory: footprint.copy(scene, &sizes),
        end: scene.time.end,
        time_step,
        // A last step that is only round-off is none.
        steps: (scene.time.end / time_step * (1.0 - 1e-12)).ceil() as u64,
        ends_at_rest: scene.time.relax.is_some(),
        machine: MachineSpeed::default(),
        wall_time: 0.0,
        rules: rules::rule_reports(scene, &boxes),
        warnings: warnings(scene, (&extents, &loads), (&contacts, time_step)),
        loads,
        contacts,
        contacts_unknown,
    };
    Ok(report.on(MachineSpeed::default()))
}

/// Where bodies that deform are computed, and why.
fn interior(scene: &Scene) -> Option<String> {
    let count = |of: Interior| {
        let deforms = |&body: &usize| !scene.bodies[body].is_rigid() && scene.interior(body) == of;
        (0..scene.bodies.len()).filter(deforms).count()
    };
    match (count(Interior::Reference), count(Interior::Grid), &scene.discretization.because) {
        (0, _, Some(why)) => Some(format!("the common grid, as {why}")),
        (0, _, None) => None,
        (_, 0, _) => Some("bodies that deform on grids of their own".to_string()),
        (..) => {
            let named = |of: Interior| {
                let deforms = |&body: &usize| !scene.bodies[body].is_rigid() && scene.interior(body) == of;
                let bodies: Vec<usize> = (0..scene.bodies.len()).filter(deforms).collect();
                and_more(&format!("`{}`", scene.bodies[bodies[0]].name), bodies.len() - 1)
            };
            let [own, common] = [Interior::Reference, Interior::Grid].map(named);
            Some(format!("{own} on grids of their own, {common} on the common grid"))
        }
    }
}

impl Report {
    /// The same run on another machine.
    pub fn on(self, machine: MachineSpeed) -> Self {
        let rate = machine.particle_steps_per_second;
        // Contacts are solved for by one core.
        let contacts = self.contacts_as_particles / rate;
        let own = self.own_grids.unwrap_or_default();
        let nothing_deforms = self.loads.is_empty() && self.bodies.iter().all(|body| body.rigid);
        let each = match (nothing_deforms || own.is_all, self.dimension.is_plane()) {
            (true, _) => WITHOUT_GRID,
            (false, true) => IN_PLANE,
            (false, false) => 1.0,
        };
        let particles = (self.particles - own.particles) as f64 * each;
        let a_step = contacts + particles / (rate * machine.cores as f64) + own.step.seconds(&machine);
        Report { machine, wall_time: own.start.seconds(&machine) + a_step * self.steps as f64, ..self }
    }

    /// The part of the expected wall time before the first step [s].
    pub fn start_time(&self) -> f64 {
        self.own_grids.map_or(0.0, |own| own.start.seconds(&self.machine))
    }

    /// The same where so much memory is available [bytes]: with a warning if the run does not fit.
    pub fn in_memory(mut self, available: f64) -> Self {
        let axes = self.dimension.axes();
        let needed = self.memory + self.checkpoint_memory;
        self.warnings.extend(memory::warning(needed, available, self.cell, axes));
        self
    }

    /// The same with the places of warnings in the file that the scene came from, and with keys of it that do nothing.
    pub fn placed(mut self, source: &Source) -> Self {
        let told = source.told().iter().map(|(key, why)| Warning::about(key.as_str(), why.as_str()));
        self.warnings = told.chain(self.warnings).map(|warning| warning.placed(source)).collect();
        self
    }
}

/// What is doubtful with a scene: first what it says, then what the grid makes of it.
fn warnings(
    scene: &Scene,
    (extents, loads): (&[FillingExtent], &[LoadReport]),
    (contacts, time_step): (&[ContactEstimate], f64),
) -> Vec<Warning> {
    few(rules::idle(scene))
        .chain(few(dead_keys::warnings(scene)))
        .chain(few(overlap::warnings(scene)))
        .chain(rigid_pairs::warning(scene, extents))
        .chain(joints::warning(scene))
        .chain(joint_freedom::warning(scene, extents))
        .chain(locking::warning(scene))
        .chain(locking::bending(scene))
        .chain(soil::warning(scene))
        .chain(loads::warning(scene, loads))
        .chain(few(supports::warnings(scene)))
        .chain(pulses::warning(scene, time_step))
        .chain(thin_rigid_bodies(scene))
        .chain(mass::warning(scene, extents))
        .chain(thickness::warning(scene))
        .chain(slits::warning(scene))
        .chain(narrow_contacts(contacts))
        .collect()
}

/// A place where balls touch costs as much in a step as so many particles: half of it where they rest, and twice or
/// more where they fall. One of a face costs so many where nothing moves, and so many where something strikes a
/// stack: then nothing is found by few sweeps.
const PARTICLES_A_CONTACT: f64 = 10.0;
const AT_REST: f64 = 2.0;
const STRUCK: f64 = 6.0;
/// What a particle costs of that where nothing deforms on the common grid, and a step makes none.
const WITHOUT_GRID: f64 = 0.05;
/// What a particle on the common grid costs in the plane, over what it does in space.
const IN_PLANE: f64 = 0.5;
/// Places at which two bodies touch on a face, in the plane and in space.
const PLACES: [usize; 2] = [3, 5];

/// The places at which free rigid bodies touch others where they begin, each with its cost in particles: balls at one.
fn rigid_contacts(scene: &Scene, boxes: &[Bounds]) -> Vec<f64> {
    if scene.bodies.iter().all(|body| body.as_free_rigid().is_none()) {
        return Vec::new();
    }
    let moves = |body: &Body| {
        let spins = body.as_free_rigid().is_some_and(|free| free.spin != [0.0; 3]);
        body.is_rigid() && (spins || starting_velocity(body) != [0.0; 3])
    };
    let of_face = if scene.bodies.iter().any(moves) { STRUCK } else { AT_REST };
    let joined = scene.joined_pairs();
    let touches = |[a, b]: [usize; 2]| {
        let both = [a, b].map(|body| &scene.bodies[body]);
        let reach = both.map(|body| body.shape.bounds(scene.dimension.axes()).filter(Bounds::is_finite));
        // What is endless is near to all: only its surface tells.
        let near = || match reach {
            [Some(_), Some(_)] => true,
            [Some(bounds), None] => near_surface(scene, (b, &bounds)),
            [None, Some(bounds)] => near_surface(scene, (a, &bounds)),
            [None, None] => false,
        };
        both.iter().all(|body| body.is_rigid()) && scene.may_touch([a, b], &joined) && near()
    };
    let is_ball = |&body: &usize| matches!(scene.bodies[body].shape, Shape::Ball { .. });
    let places = |pair: [usize; 2]| match pair.iter().any(is_ball) {
        true => vec![PARTICLES_A_CONTACT],
        false => vec![of_face; PLACES[scene.dimension.axes() - 2]],
    };
    let near = pairs_within(boxes, TOUCH * scene.discretization.cell);
    near.into_iter().filter(|pair| touches(*pair)).flat_map(places).collect()
}

/// Boxes that are less than this apart touch [cells].
const TOUCH: f64 = 0.1;

/// Whether a box reaches the surface of a body, by the point of the box that is nearest to it.
fn near_surface(scene: &Scene, (body, bounds): (usize, &Bounds)) -> bool {
    let (axes, shape) = (scene.dimension.axes(), &scene.bodies[body].shape);
    let nearest = bounds.corners().map(|corner| shape.distance(corner, axes)).fold(f64::INFINITY, f64::min);
    nearest < TOUCH * scene.discretization.cell
}

/// Particles along each side of a cell, in the bodies with the fewest and with the most.
fn fewest_and_most(scene: &Scene) -> [usize; 2] {
    let usual = scene.discretization.particles_per_side;
    let of = || scene.bodies.iter().map(|body| body.particles_per_side.unwrap_or(usual));
    [of().min().unwrap_or(usual), of().max().unwrap_or(usual)]
}

fn of_body(scene: &Scene, body: &Body, extent: &FillingExtent) -> BodyReport {
    BodyReport {
        name: body.name.clone(),
        material: scene.materials[body.material].name.clone(),
        rigid: body.is_rigid(),
        particles: extent.particles,
        mass: body.as_free_rigid().and_then(|free| free.mass).unwrap_or(extent.mass),
        size: extent.bounds.size(),
    }
}

fn of_materials(scene: &Scene) -> Vec<MaterialReport> {
    let speeds = (0..scene.materials.len()).map(|i| MaterialReport {
        name: scene.materials[i].name.clone(),
        longitudinal_speed: scene.materials[i].wave_speed(scene.dimension.thickness()),
        shear_speed: (scene.materials[i].law.elastic().shear_modulus / scene.materials[i].density).sqrt(),
    });
    speeds.collect()
}

/// Half the diagonal of a body's box; of one without bounds, of the box around all that have some [m].
fn half_diagonal(extent: &FillingExtent, extents: &[FillingExtent]) -> f64 {
    let finite = extents.iter().map(|extent| extent.bounds).filter(Bounds::is_finite);
    let bounds = match extent.bounds.is_finite() {
        true => extent.bounds,
        false => finite.fold(Bounds::EMPTY, |all, bounds| all.united(&bounds)),
    };
    0.5 * Vector(bounds.size()).norm()
}

/// How fast a body is at the start by the place, at the corners and in the middle of its box at most [m/s].
fn by_place(body: &Body, extent: &FillingExtent) -> f64 {
    let Some(velocity) = body.velocity_by_place.as_deref() else { return 0.0 };
    let at = |place: [f64; 3]| {
        let moment = Moment { place, start: place, ..Moment::default() };
        Vector(velocity.each_ref().map(|part| part.at_moment(&moment))).norm()
    };
    let places = extent.bounds.corners().chain([extent.center]);
    places.map(at).filter(|speed| speed.is_finite()).fold(0.0, f64::max)
}

/// How fast a body moves at the start, at most [m/s].
fn speed(extents: &[FillingExtent], (body, extent): (&Body, &FillingExtent)) -> f64 {
    let spin = match &body.motion {
        BodyMotion::Free { spin, .. } => *spin,
        BodyMotion::Rigid { spin, .. } => spin.each_ref().map(|s| s.at(0.0)),
        BodyMotion::FreeRigid(free) => free.spin,
    };
    let reach = half_diagonal(extent, extents);
    Vector(starting_velocity(body)).norm() + by_place(body, extent) + Vector(spin).norm() * reach
}

/// How fast anything moves at the start, at most [m/s].
fn fastest(scene: &Scene, extents: &[FillingExtent]) -> f64 {
    scene.bodies.iter().zip(extents).map(|body| speed(extents, body)).fold(0.0, f64::max)
}

/// courant h / max(c + |v|) at the start, at most the longest step that the scene allows [s].
pub(super) fn time_step(scene: &Scene, extents: &[FillingExtent]) -> f64 {
    let signal = |(body, extent): (&Body, &FillingExtent)| {
        let wave = match body.is_rigid() {
            true => 0.0,
            false => scene.materials[body.material].wave_speed(scene.dimension.thickness()),
        };
        (wave + speed(extents, (body, extent))) / scene.cell(body)
    };
    let fastest = scene.bodies.iter().zip(extents).map(signal).fold(0.0, f64::max);
    let step = scene.time.courant / fastest;
    let step = step.min(scene.time.max_step.unwrap_or(f64::INFINITY)).min(longest_step(scene));
    if step.is_finite() { step } else { scene.time.end }
}

/// Particles of a rigid body two deep fill what contact asks of it; bodies that deform need more, see [`thickness`].
fn thin_rigid_bodies(scene: &Scene) -> Option<Warning> {
    let needed = |body: &Body| 2.0 * scene.lattice(body).spacing * (1.0 - 1e-9);
    let thickness = |body: usize| smallest_extent(&scene.bodies[body].shape, scene.dimension.axes());
    let is_thin =
        |&body: &usize| scene.bodies[body].is_rigid() && thickness(body) < needed(&scene.bodies[body]);
    let mut thin = (0..scene.bodies.len()).filter(is_thin);
    let first = thin.next()?;
    let body = &scene.bodies[first];
    let named = and_more(&format!("`{}` ({} m)", body.name, short(thickness(first))), thin.count());
    let cell = short(0.5 * thickness(first) * scene.per_side(body));
    Some(Warning::about(
        format!("bodies[{first}].shape"),
        format!("thinner than two particles: {named}; cells of at most {cell} m give it two"),
    ))
}

/// Of more than two contacts the one in the middle is told: among many there are some that hardly touch.
fn narrow_contacts(contacts: &[ContactEstimate]) -> Option<Warning> {
    let narrow = contacts.iter().filter(|contact| contact.verdict == ContactResolution::NotResolved).count();
    let told = contacts[..narrow].get(narrow.saturating_sub(1) / 2)?;
    let which = if narrow > 2 { "half of them are narrower than that in which" } else { "in the narrowest" };
    let text = format!(
        "{NOT_RESOLVED}{narrow} of {} contacts; {which} {}; it needs cells of {} m to be marginal, {} m to be resolved",
        contacts.len(),
        told.off,
        short(told.patch.radius),
        short(0.25 * told.patch.radius)
    );
    Some(Warning::about("", text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::bodies::measure;
    use crate::check::tests::{at_rest, free, incline, report, scene};
    use crate::geometry::Shape;
    use crate::scene::StressUpdate;

    #[test]
    fn the_papers_incline_is_reported_with_its_waves_and_steps() {
        let report = report(&incline(4.0)).expect("no problem");
        assert_eq!(report.particles, report.bodies[0].particles + 104 * 16 * 8);
        // "Same wave speeds, longitudinal 100 m/s": sqrt((K + 4G/3)/rho) = sqrt(1e7/1e3).
        assert!(report.materials.iter().all(|m| (m.longitudinal_speed - 100.0).abs() < 1e-9));
        assert!((report.time_step - 0.4 * 0.4 / 100.0).abs() < 1e-12);
        assert_eq!(report.steps, 1250);
        let half_sphere = 2.0 / 3.0 * std::f64::consts::PI * 1.6f64.powi(3) * 1000.0;
        assert!((report.bodies[0].mass / half_sphere - 1.0).abs() < 0.02);
        assert_eq!(report.warnings.len(), 1);
        assert!(
            report.warnings[0].text.starts_with("not resolved: 1 of 1 contacts;"),
            "{:?}",
            report.warnings
        );
    }

    #[test]
    fn of_many_narrow_contacts_the_one_in_the_middle_is_told() {
        let contact = estimates(&incline(4.0), &measure(&incline(4.0)).expect("filled")).found[0].clone();
        let narrow = |radius: f64| {
            let mut contact = contact.clone();
            contact.patch.radius = radius;
            contact
        };
        let text = |radii: &[f64]| {
            narrow_contacts(&radii.iter().map(|&radius| narrow(radius)).collect::<Vec<_>>()).unwrap().text
        };
        assert!(text(&[0.125, 0.25]).contains("in the narrowest"));
        assert!(text(&[0.125, 0.25]).contains("cells of 0.125 m to be marginal"), "{}", text(&[0.125, 0.25]));
        let many = text(&[1e-9, 1e-3, 0.25, 0.3, 0.35]);
        assert!(many.contains("half of them are narrower than that in which"), "{many}");
        assert!(many.contains("cells of 0.25 m to be marginal"), "{many}");
    }

    #[test]
    fn the_expected_time_is_that_of_the_machine() {
        let machine = MachineSpeed { particle_steps_per_second: 1e6, cores: 4 };
        let report = report(&incline(4.0)).expect("no problem").on(machine);
        let exact = report.particles as f64 * report.steps as f64 / 4e6;
        assert!((report.wall_time / exact - 1.0).abs() < 1e-12);
    }

    /// Three boxes on each other on a floor touch at three places each; contacts are solved for by one core.
    #[test]
    fn contacts_of_rigid_bodies_count() {
        let text = "space = { dimension = 'plane-strain', cell = 0.02 }\ngravity = [0, -9.81]\ntime.end = 1\n\
             materials.clay = { density = 1, neo_hookean = { young_modulus = 1, poisson_ratio = 0 } }\n\
             bodies = [{ name = 'floor', material = 'clay', rigid = {}, shape.half_space = { point = [0, 0], normal = [0, 1] } },\n\
             { name = 'box {i}', repeat = { i = 3 }, material = 'clay', rigid.free = {}, \
               shape.box = { min = [0, '0.1 * i'], max = [0.2, '0.1 * (i + 1)'] } }]\n";
        let scene = crate::scene::parse("tower.toml", text, &[]).expect("a scene").scene;
        let report = report(&scene).expect("no problem");
        assert_eq!(report.rigid_contacts, 9);
        let [one, eight] = [1, 8].map(|cores| {
            let machine = MachineSpeed { particle_steps_per_second: 1e6, cores };
            report.clone().on(machine).wall_time / report.steps as f64
        });
        let particles = report.particles as f64;
        assert!((one - (9.0 * AT_REST + WITHOUT_GRID * particles) / 1e6).abs() < 1e-12, "{one}");
        assert!((eight - (9.0 * AT_REST + WITHOUT_GRID / 8.0 * particles) / 1e6).abs() < 1e-12, "{eight}");
        // One that falls onto the others makes them move.
        let struck = text.replace("rigid.free = {}", "velocity = [0, -1], rigid.free = {}");
        let scene = crate::scene::parse("tower.toml", &struck, &[]).expect("a scene").scene;
        assert_eq!(
            crate::check::tests::report(&scene).expect("no problem").contacts_as_particles,
            9.0 * STRUCK
        );
    }

    #[test]
    fn a_body_may_have_finer_particles_than_the_scene() {
        let cube = |x: f64| free("cube", 0, Shape::Box { min: [x, 0.0, 0.0], max: [x + 0.3, 0.3, 0.3] });
        let fine = Body { particles_per_side: Some(3), ..cube(0.3) };
        let report = report(&scene(Dimension::Space, 0.1, vec![cube(0.0), fine])).unwrap();
        assert_eq!(report.bodies.iter().map(|body| body.particles).collect::<Vec<_>>(), [216, 729]);
        assert!(
            report.to_string().contains("\nspace, cells of 0.1 m, 8 to 27 particles a cell\n"),
            "{report}"
        );
        assert!((report.bodies[1].mass / report.bodies[0].mass - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_run_larger_than_the_machine_is_a_warning() {
        let report = || report(&incline(4.0)).expect("no problem");
        let needed = report().memory + report().checkpoint_memory;
        assert_eq!(report().in_memory(1.01 * needed), report());
        let warnings = report().in_memory(0.5 * needed).warnings;
        let last = warnings.last().expect("too large").to_string();
        assert!(last.contains("and this machine has ") && last.contains("would fit"), "{last}");
    }

    #[test]
    fn motion_at_the_start_shortens_the_step_and_a_limit_caps_it() {
        let mut scene = incline(4.0);
        scene.bodies[0].motion = BodyMotion::Free { velocity: [60.0, 0.0, 80.0], spin: [0.0; 3] };
        assert!((report(&scene).expect("no problem").time_step - 0.4 * 0.4 / 200.0).abs() < 1e-12);
        scene.time.max_step = Some(1e-4);
        let report = report(&scene).expect("no problem");
        assert_eq!((report.time_step, report.steps), (1e-4, 20_000));
    }

    #[test]
    fn a_thin_rigid_sheet_is_a_warning_even_when_turned() {
        let sheet = |thickness| {
            let shape = Box::new(Shape::Box { min: [0.0; 3], max: [1.0, 1.0, thickness] });
            at_rest("sheet", Shape::Rotated { shape, center: [0.0; 3], axis: [1.0, 0.0, 0.0], angle: 0.5 })
        };
        let of = |thickness| {
            let mut scene = scene(Dimension::Space, 0.1, vec![sheet(thickness)]);
            // Nothing deforms, and so no stress is updated.
            scene.time.stress_update = StressUpdate::default();
            report(&scene).expect("no problem").warnings
        };
        assert!(of(0.1).is_empty());
        assert!(of(0.08)[0].text.contains("`sheet` (0.08 m);"));
    }

    #[test]
    fn a_report_of_thousands_of_bodies_takes_no_time() {
        let disk = |i: usize| {
            let center = [(i % 64) as f64, (i / 64) as f64, 0.0];
            free(&format!("disk {i}"), 0, Shape::Ball { center, radius: 0.5 })
        };
        let mut scene = scene(Dimension::PlaneStrain, 0.1, (0..4096).map(disk).collect());
        scene.gravity = [0.0, -10.0, 0.0].into();
        let report = report(&scene).expect("no problem");
        assert_eq!((report.bodies.len(), report.contacts.len()), (4096, 64 * 63));
    }
}
