//! `surfaces.pvd` or `surfaces.csv`: the surfaces of bodies through time, for ParaView or as models.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::frames::{FrameFile, Frames};
use super::memory::Memory;
use super::schedule::Schedule;
use super::shared::{Asked, Question, answer};
use super::vtk::{NUMBER, VECTOR, VtkFile};
use super::{Observer, SURFACES};
use crate::column::DERIVED;
use crate::door::{ParticleSnapshot, View};
use crate::geometry::{Bounds, Shape, sites};
use crate::rigid::Pose;
use crate::scene::{Scene, SeriesFormat, SnapshotContent};
use crate::surface::model::{Model, ModelPart, upright};
use crate::surface::{self, CarriedSkin, Skin};
use crate::tensor::{Vector, cross};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Writes `surfaces.pvd` or `surfaces.csv`, and `surfaces/`.
pub(super) struct SurfacesObserver {
    schedule: Schedule,
    frames: Frames,
    surfaces: Arc<Vec<Surface>>,
    labels: Arc<Labels>,
}

/// What files say beside the surfaces, and how they say it.
struct Labels {
    /// Number format and packing of what ParaView reads.
    content: SnapshotContent,
    title: String,
    /// Names of all bodies.
    bodies: Vec<String>,
    /// Of space.
    dimension: usize,
    /// Directions that lead right, up and to the viewer; up is against gravity at the start.
    directions: [[f64; 3]; 3],
}

/// The surface of a body.
struct Surface {
    body: usize,
    moved: Moved,
}

/// With what it moves.
enum Moved {
    /// With the pose of a rigid body.
    Rigidly(Skin),
    /// With the particles of one that deforms.
    ByParticles(CarriedSkin, Carriers),
}

/// The surfaces at one time.
#[derive(Clone, Default)]
struct Corners {
    position: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    von_mises: Vec<f64>,
    body: Vec<i32>,
    triangles: Vec<[u32; 3]>,
}

/// Bytes of a corner with its body, and of two triangles, as many as a surface has for each corner.
const CORNER_BYTES: usize = 7 * size_of::<f64>() + 7 * size_of::<u32>();

impl SurfacesObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        Ok(SurfacesObserver {
            schedule: Schedule::every(scene.outputs.surfaces.unwrap_or(f64::INFINITY)),
            frames: Frames::create(folder, SURFACES, scene.outputs.surface_format)?,
            surfaces: Arc::new(surfaces_of(scene)),
            labels: Arc::new(Labels::of(scene)),
        })
    }
}

impl Observer for SurfacesObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        self.frames.make_room()?;
        let (carriers, poses) = (answer(view, &CarriersQuestion::of(&self.surfaces)), view.poses());
        let spins: Vec<[[f64; 3]; 2]> = view.bodies().iter().map(|body| [body.velocity, body.spin]).collect();
        let corners = self.surfaces.iter().map(|surface| surface.moved.skin().corners.len()).sum::<usize>();
        let (surfaces, labels) = (self.surfaces.clone(), self.labels.clone());
        self.frames.push(time, carriers.0.bytes() + CORNER_BYTES * corners, move |format| {
            let parts = corners_of(&surfaces, &carriers, (&poses, &spins));
            labels.encode(parts, time, format)
        });
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.frames.finish()
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        self.schedule.remember(memory)?;
        self.frames.remember(memory)
    }

    fn replaces(&self) -> bool {
        true
    }
}

/// The surfaces of all bodies that have one and that snapshots hold. What has no bounds ends with the domain; without
/// one it has no surface.
fn surfaces_of(scene: &Scene) -> Vec<Surface> {
    let dimension = scene.dimension.axes();
    let domain = scene.domain.as_ref().map(|domain| Bounds { min: domain.min, max: domain.max });
    let surface = |number: usize| {
        let body = &scene.bodies[number];
        let lattice = scene.lattice(body);
        let bounds = body.shape.bounds(dimension);
        if body.is_rigid() {
            let skin = match (bounds, domain) {
                (Some(_), _) => Skin::of(&body.shape, lattice.spacing, dimension, None)?,
                (None, Some(domain)) => {
                    let within = Shape::cuboid(domain.min, domain.max).and(body.shape.clone());
                    Skin::of(&within, lattice.spacing, dimension, None)?
                }
                (None, None) => return None,
            };
            return Some(Surface { body: number, moved: Moved::Rigidly(skin) });
        }
        let skin = Skin::of(&body.shape, lattice.spacing, dimension, domain)?;
        let reference: Vec<_> =
            sites(&body.shape, &lattice, body.particles)?.map(|site| site.position).collect();
        let of_all = reference.len();
        let (carried, numbers) = CarriedSkin::new(skin, reference, lattice.spacing).thinned();
        Some(Surface { body: number, moved: Moved::ByParticles(carried, Carriers { numbers, of_all }) })
    };
    let held = scene.outputs.snapshots.held(&scene.bodies);
    (0..scene.bodies.len()).into_par_iter().filter(|&body| held[body]).filter_map(surface).collect()
}

impl Moved {
    fn skin(&self) -> &Skin {
        match self {
            Moved::Rigidly(skin) => skin,
            Moved::ByParticles(carried, _) => carried.skin(),
        }
    }
}

/// The particles that carry the surface of a body.
struct Carriers {
    /// They ascend.
    numbers: Vec<u32>,
    /// How many particles the body has in all, before any is lost.
    of_all: usize,
}

/// Where the particles that carry surfaces are now: by body, their numbers.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct CarriersQuestion(BTreeMap<u32, Vec<u32>>);

impl CarriersQuestion {
    fn of(surfaces: &[Surface]) -> Self {
        let numbers = surfaces.iter().filter_map(|surface| match &surface.moved {
            Moved::Rigidly(_) => None,
            Moved::ByParticles(_, carriers) => Some((surface.body as u32, carriers.numbers.clone())),
        });
        CarriersQuestion(numbers.collect())
    }
}

impl Question for CarriersQuestion {
    /// Those particles, without what laws remember, and how many particles each of their bodies has.
    type Answer = (ParticleSnapshot, BTreeMap<u32, usize>);

    fn look(&self, view: &dyn View) -> Self::Answer {
        let (all, mut counts) = (view.snapshot(), BTreeMap::new());
        for body in all.body.iter().filter(|body| self.0.contains_key(body)) {
            *counts.entry(*body).or_default() += 1;
        }
        let wanted = |body: u32, number: u32| {
            self.0.get(&body).is_some_and(|numbers| numbers.binary_search(&number).is_ok())
        };
        (ParticleSnapshot { history: Vec::new(), ..all.only(wanted) }, counts)
    }

    fn join((one, mut counts): Self::Answer, (other, others): Self::Answer) -> Self::Answer {
        others.into_iter().for_each(|(body, count)| *counts.entry(body).or_default() += count);
        (ParticleSnapshot::merged(vec![one, other]), counts)
    }

    fn asked(&self) -> Asked {
        Asked::Carriers(self.clone())
    }
}

/// Each surface as it is now: of rigid bodies by their poses, velocities and spins, of others by the particles that
/// carry them. Bodies that lost particles have none any more.
fn corners_of(
    surfaces: &[Surface],
    (snapshot, counts): &(ParticleSnapshot, BTreeMap<u32, usize>),
    (poses, spins): (&[Option<Pose>], &[[[f64; 3]; 2]]),
) -> Vec<Corners> {
    let part = |surface: &Surface| -> Corners {
        let body = surface.body;
        let skin = surface.moved.skin();
        let mut corners = Corners { triangles: skin.triangles.clone(), ..Corners::default() };
        match &surface.moved {
            Moved::Rigidly(skin) => {
                let Some(Some(pose)) = poses.get(body) else { return Corners::default() };
                let [velocity, spin] = spins[body];
                let center = pose.now(pose.begun());
                for &corner in &skin.corners {
                    let now = pose.now(corner);
                    let arm: [f64; 3] = std::array::from_fn(|k| now[k] - center[k]);
                    let [x, y, z] = cross(spin, arm);
                    corners.position.push(now);
                    corners.velocity.push([velocity[0] + x, velocity[1] + y, velocity[2] + z]);
                    corners.von_mises.push(0.0);
                }
            }
            Moved::ByParticles(carried, carriers) => {
                // Particles are in the order of bodies and numbers.
                let first = snapshot.body.partition_point(|&other| (other as usize) < body);
                let end = snapshot.body.partition_point(|&other| (other as usize) <= body);
                let count = counts.get(&(body as u32)).copied().unwrap_or_default();
                if end - first != carriers.numbers.len() || count != carriers.of_all {
                    return Corners::default();
                }
                let of = first..end;
                corners.position =
                    carried.corners(&snapshot.position[of.clone()], &snapshot.deformation[of.clone()]);
                let part = |k: usize| -> Vec<f32> {
                    carried.at_corners(
                        &snapshot.velocity[of.clone()].iter().map(|v| v[k] as f32).collect::<Vec<_>>(),
                    )
                };
                let [x, y, z] = [part(0), part(1), part(2)];
                corners.velocity = (0..x.len()).map(|i| [x[i], y[i], z[i]].map(f64::from)).collect();
                let stress: Vec<f32> =
                    snapshot.stress[of].iter().map(|stress| von_mises(stress) as f32).collect();
                corners.von_mises = carried.at_corners(&stress).into_iter().map(f64::from).collect();
            }
        }
        corners.body = vec![body as i32; corners.position.len()];
        corners
    };
    surfaces.par_iter().map(part).filter(|part| !part.body.is_empty()).collect()
}

/// All of them together.
fn joined(parts: Vec<Corners>) -> Corners {
    let mut all = Corners::default();
    for part in parts {
        let first = all.position.len() as u32;
        all.triangles.extend(part.triangles.iter().map(|triangle| triangle.map(|corner| first + corner)));
        all.position.extend(part.position);
        all.velocity.extend(part.velocity);
        all.von_mises.extend(part.von_mises);
        all.body.extend(part.body);
    }
    all
}

/// The von Mises stress [Pa].
fn von_mises(stress: &[f64; 6]) -> f64 {
    let derived = DERIVED.iter().find(|derived| derived.column.name == "von_mises");
    (derived.expect("it is a derived column").value)(stress)
}

impl Labels {
    fn of(scene: &Scene) -> Self {
        Labels {
            content: scene.outputs.snapshots.clone(),
            title: scene.title.clone(),
            bodies: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            dimension: scene.dimension.axes(),
            directions: upright(scene.gravity.at(0.0), scene.dimension.axes()),
        }
    }

    /// Surfaces at a time [s] as a file.
    fn encode(&self, parts: Vec<Corners>, time: f64, format: SeriesFormat) -> FrameFile {
        match format {
            SeriesFormat::Vtu => {
                encode_surfaces(&joined(parts), time, (VtkFile::of_triangles, &self.content))
            }
            SeriesFormat::Vtp => encode_surfaces(&joined(parts), time, (VtkFile::of_polygons, &self.content)),
            SeriesFormat::Glb => FrameFile::Model(self.model(&parts, time)),
        }
    }

    /// Surfaces at a time [s] as a model: each body in its colour, and at each corner its velocity [m/s] and the von
    /// Mises stress [Pa].
    fn model(&self, parts: &[Corners], time: f64) -> Model {
        let short = |vectors: &[[f64; 3]]| vectors.iter().map(|v| v.map(|x| x as f32)).collect::<Vec<_>>();
        let part = |corners: &Corners| {
            let body = corners.body[0] as usize;
            let places: Vec<Vector<f64, 3>> = corners.position.iter().copied().map(Vector).collect();
            // Areas in the plane face the viewer; slivers among their triangles may be turned over by rounding.
            let flat = Vector([0.0, 0.0, 1.0]);
            let mut normals = surface::normals(&places, &corners.triangles);
            normals.iter_mut().filter(|n| self.dimension == 2 || **n == Vector::ZERO).for_each(|n| *n = flat);
            let normals: Vec<[f64; 3]> = normals.into_iter().map(|normal| normal.0).collect();
            ModelPart {
                name: self.bodies[body].clone(),
                color: surface::body_color(body),
                positions: short(&corners.position),
                normals: short(&normals),
                colors: Vec::new(),
                triangles: corners.triangles.clone(),
                vectors: vec![("_VELOCITY", short(&corners.velocity))],
                numbers: vec![(
                    "_VON_MISES",
                    corners.von_mises.iter().map(|&stress| stress as f32).collect(),
                )],
            }
        };
        let units = json!({ "POSITION": "m", "_VELOCITY": "m/s", "_VON_MISES": "Pa" });
        let extras = json!({ "title": self.title, "time": time, "units": units });
        Model::new(parts.iter().map(part).collect(), self.directions, extras)
    }
}

/// A file for ParaView of points and triangles at a time [s].
type OfTriangles = fn(f64, (&[[f64; 3]], &[[u32; 3]]), &SnapshotContent) -> VtkFile;

/// Surfaces at a time [s] as a file for ParaView: triangles, and at each corner the `velocity` [m/s], the `von_mises`
/// stress [Pa] and the index of the `body`.
fn encode_surfaces(
    corners: &Corners,
    time: f64,
    (made, content): (OfTriangles, &SnapshotContent),
) -> FrameFile {
    let mut file = made(time, (&corners.position, &corners.triangles), content);
    file.real("velocity", VECTOR, corners.velocity.as_flattened());
    file.real("von_mises", NUMBER, &corners.von_mises);
    file.whole("body", &corners.body);
    file.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::vtk::PointArrays;
    use crate::scene;

    /// A plate of prescribed motion, a free one, a disk that deforms and a floor, after half a second without forces.
    #[test]
    fn surfaces_move_with_their_bodies() {
        let text = r#"
            space = { dimension = "plane-strain", interior = "grid", cell = 0.1, domain = { min = [-2, -1], max = [6, 5] } }
            time.end = 1
            outputs.snapshots.precision = "double"
            materials.gel = { density = 1000, neo_hookean = { young_modulus = 1e4, poisson_ratio = 0.3 } }
            [[bodies]]
            name = "plate"
            material = "gel"
            shape.box = { min = [0, 0], max = [1, 0.5] }
            rigid = { velocity = [1, 2], spin = 3 }
            [[bodies]]
            name = "sledge"
            material = "gel"
            shape.box = { min = [3, 3], max = [4, 4] }
            velocity = [-0.5, 0]
            spin = -2
            rigid.free = {}
            [[bodies]]
            name = "disk"
            material = "gel"
            shape.ball = { center = [-1, 3], radius = 0.5 }
            velocity = [0.25, 0.5]
            [[bodies]]
            name = "floor"
            material = "gel"
            shape.half_space = { point = [0, -0.55], normal = [0, 1] }
            rigid = {}
        "#;
        let scene = scene::parse("a.toml", text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        let mut simulation = stickslip_engine::step::build(&scene).unwrap();
        let end = 0.5;
        while simulation.time() < end {
            simulation.step(end - simulation.time()).unwrap();
        }
        let surfaces = surfaces_of(&scene);
        let motions: Vec<_> = simulation.bodies().iter().map(|body| [body.velocity, body.spin]).collect();
        let carriers = CarriersQuestion::of(&surfaces).look(&*simulation);
        let parts = corners_of(&surfaces, &carriers, (&simulation.poses(), &motions));
        let corners = joined(parts.clone());
        let mut first = 0;
        for (surface, (center, velocity, spin, area)) in surfaces.iter().zip([
            ([0.5, 0.25], [1.0, 2.0], 3.0, 0.5),
            ([3.5, 3.5], [-0.5, 0.0], -2.0, 1.0),
            ([-1.0, 3.0], [0.25, 0.5], 0.0, std::f64::consts::PI * 0.25),
            ([0.0, -0.55], [0.0, 0.0], 0.0, 8.0 * 0.45),
        ]) {
            let skin = surface.moved.skin();
            let (sine, cosine) = (spin * end).sin_cos();
            for (i, corner) in skin.corners.iter().enumerate() {
                let arm = [corner[0] - center[0], corner[1] - center[1]];
                let turned = [cosine * arm[0] - sine * arm[1], sine * arm[0] + cosine * arm[1]];
                let expected: [f64; 2] = std::array::from_fn(|k| center[k] + velocity[k] * end + turned[k]);
                let (found, moving) = (corners.position[first + i], corners.velocity[first + i]);
                let rate = [velocity[0] - spin * turned[1], velocity[1] + spin * turned[0]];
                assert!((0..2).all(|k| (found[k] - expected[k]).abs() < 1e-5), "{found:?} {expected:?}");
                assert!((0..2).all(|k| (moving[k] - rate[k]).abs() < 1e-5), "{moving:?} {rate:?}");
                assert_eq!(corners.body[first + i] as usize, surface.body);
            }
            let of = |triangle: &&[u32; 3]| (triangle[0] as usize).wrapping_sub(first) < skin.corners.len();
            let size = |triangle: &[u32; 3]| {
                let [a, b, c] = triangle.map(|corner| corners.position[corner as usize]);
                0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
            };
            let found: f64 = corners.triangles.iter().filter(of).map(size).sum();
            assert!((found / area - 1.0).abs() < 5e-3, "{found} for {area}");
            first += skin.corners.len();
        }
        assert_eq!(first, corners.position.len(), "all of them");
        // And back from the disk.
        let folder = tempfile::tempdir().unwrap();
        let labels = Labels::of(&scene);
        for (format, kind) in [(SeriesFormat::Vtp, "vtp"), (SeriesFormat::Vtu, "vtu")] {
            let path = folder.path().join("00000").with_extension(kind);
            let FrameFile::Vtk(file) = labels.encode(parts.clone(), end, format) else { panic!("{kind}") };
            file.write(&path).unwrap();
            let file = PointArrays::open(&path).unwrap();
            assert_eq!(file.positions::<3>().unwrap(), corners.position);
            assert_eq!(file.whole::<i32>("body").unwrap(), corners.body);
            FrameFile::check(&path).unwrap();
        }
        let model = labels.model(&parts, end);
        let names: Vec<&str> = model.parts().iter().map(|part| &part.name[..]).collect();
        assert_eq!(names, ["plate", "sledge", "disk", "floor"]);
        for (part, corners) in model.parts().iter().zip(&parts) {
            let places: Vec<[f32; 3]> = corners.position.iter().map(|x| x.map(|x| x as f32)).collect();
            assert_eq!((&part.positions, &part.triangles), (&places, &corners.triangles));
            assert!(
                part.normals.iter().all(|normal| *normal == [0.0, 0.0, 1.0]),
                "plane areas face the viewer"
            );
            assert_eq!(part.vectors[0].1[0], corners.velocity[0].map(|v| v as f32));
        }
        let path = folder.path().join("00000.glb");
        std::fs::write(&path, model.encode().unwrap()).unwrap();
        FrameFile::check(&path).unwrap();
        std::fs::write(&path, &model.encode().unwrap()[..900]).unwrap();
        let error = FrameFile::check(&path).unwrap_err().to_string();
        assert!(error.contains("00000.glb: no model of the length that it says"), "{error}");
    }

    #[test]
    fn a_body_that_lost_particles_has_no_surface_any_more() {
        let text = r#"
            space = { dimension = "3d", interior = "grid", cell = 0.25 }
            time.end = 1
            materials.gel = { density = 1000, neo_hookean = { young_modulus = 1e4, poisson_ratio = 0.3 } }
            [[bodies]]
            name = "ball"
            material = "gel"
            shape.ball = { center = [0, 0, 0], radius = 1 }
            [[bodies]]
            name = "cube"
            material = "gel"
            shape.box = { min = [2, 0, 0], max = [3, 1, 1] }
        "#;
        let scene = scene::parse("a.toml", text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        let simulation = stickslip_engine::step::build(&scene).unwrap();
        let surfaces = surfaces_of(&scene);
        let (poses, motions) = (simulation.poses(), vec![[[0.0; 3]; 2]; 2]);
        let mut carriers = CarriersQuestion::of(&surfaces).look(&*simulation);
        let whole = joined(corners_of(&surfaces, &carriers, (&poses, &motions)));
        // The normals of the triangles look out of the ball.
        let ball = |triangle: &&[u32; 3]| whole.body[triangle[0] as usize] == 0;
        for triangle in whole.triangles.iter().filter(ball) {
            let [a, b, c] = triangle.map(|corner| whole.position[corner as usize]);
            let edge = |to: [f64; 3]| std::array::from_fn(|k| to[k] - a[k]);
            let out: f64 = cross(edge(b), edge(c)).iter().zip(a).map(|(n, x)| n * x).sum();
            assert!(out > 0.0, "{triangle:?}");
        }
        let mut one = scene.clone();
        one.outputs.snapshots.bodies = Some(vec!["cube".to_string()]);
        assert_eq!(surfaces_of(&one).iter().map(|surface| surface.body).collect::<Vec<_>>(), [1]);
        // One of the ball that carries none of its surface.
        carriers.1.entry(0).and_modify(|count| *count -= 1);
        let left = joined(corners_of(&surfaces, &carriers, (&poses, &motions)));
        assert!(left.body.iter().all(|&body| body == 1) && !left.body.is_empty());
        assert!(left.triangles.iter().flatten().all(|&corner| (corner as usize) < left.position.len()));
    }
}
