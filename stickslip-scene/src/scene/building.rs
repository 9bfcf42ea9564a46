//! Scenes in code: a constructor asks for what has no default, and all else begins as in a scene file that does not
//! name it.
//!
//! The defaults of scene files stand here, in [`ContactRule`] and in the enums' `Default`, and nowhere else: scene
//! files and their schema take them from here.

use super::{
    BasisKind, Body, BodyList, BodyMotion, ContactLaw, ContactRule, Damping, Dimension, Discretization,
    Domain, Expression, Face, FreeRigid, Gravity, Health, Interior, Leaving, Measurements, NamedMaterial,
    Normal, Outputs, Precision, Problem, Relaxation, Scene, SeriesFormat, SnapshotContent, StressUpdate,
    Time, Transfer, VolumeChange,
};
use crate::geometry::{Arrangement, Shape};
use crate::material::LAWS;

/// Rows of each body in the tables of a run: as many where bodies are few, and down to so many where they are many, so
/// that they make up no more than [`ALL_ROWS`].
const ROWS: [f64; 2] = [200.0, 30.0];
const ALL_ROWS: f64 = 6_000.0;
/// Snapshots of the particles in a run, likewise: of all bodies together no more than [`ALL_SNAPSHOTS`].
const SNAPSHOTS: [f64; 2] = [20.0, 4.0];
const ALL_SNAPSHOTS: f64 = 800.0;
/// Steps from one row of the tables to the next where the run ends at rest, long before its end, of few bodies.
const ROW_STEPS: f64 = 100.0;
/// Samples of probes, arrivals and fronts in a run.
const SAMPLES: f64 = 1000.0;

impl Scene {
    /// An empty scene with cells of side `cell` [m] that runs until `end` [s].
    pub fn new(dimension: Dimension, cell: f64, end: f64) -> Self {
        Scene {
            title: String::new(),
            about: String::new(),
            parameters: Default::default(),
            dimension,
            precision: Precision::default(),
            discretization: Discretization::new(cell),
            domain: None,
            time: Time::until(end),
            start: None,
            damping: Damping::default(),
            health: Health::default(),
            gravity: Gravity::default(),
            materials: Vec::new(),
            bodies: BodyList::default(),
            loads: Vec::new(),
            joints: Vec::new(),
            springs: Vec::new(),
            contact: Vec::new(),
            outputs: Outputs::of_run(end),
            references: Vec::new(),
        }
    }

    /// Adds a material and returns its index, by which bodies name it.
    pub fn add_material(&mut self, material: NamedMaterial) -> usize {
        self.materials.push(material);
        self.materials.len() - 1
    }

    /// Adds a body and returns its index, by which a simulation's states name it.
    pub fn add_body(&mut self, body: Body) -> usize {
        self.bodies.push(body);
        self.bodies.len() - 1
    }
}

impl Discretization {
    /// Cells of this side [m].
    pub fn new(cell: f64) -> Self {
        Discretization {
            cell,
            particles_per_side: 2,
            basis: BasisKind::default(),
            interior: Interior::default(),
            because: None,
        }
    }
}

impl Time {
    /// Steps as long as is stable until `end` [s].
    pub fn until(end: f64) -> Self {
        Time {
            end,
            courant: 0.4,
            max_step: None,
            stress_update: StressUpdate::default(),
            transfer: Transfer::default(),
            xpic_order: 2,
            pic_share: 0.0,
            relax: None,
            energy_drift: 0.1,
        }
    }
}

impl Default for Relaxation {
    /// To a thousandth of the forces.
    fn default() -> Self {
        Relaxation { residual: 1e-3 }
    }
}

impl Domain {
    /// A box that is open on all sides, between its lower and its upper corner [m].
    pub fn new(min: [f64; 3], max: [f64; 3]) -> Self {
        Domain { min, max, faces: [[Face::default(); 2]; 3], leaving: Leaving::default() }
    }
}

impl Outputs {
    /// Tables and snapshots of the particles, evenly over a run of this length [s].
    pub fn of_run(end: f64) -> Self {
        Outputs {
            tables: end / ROWS[0],
            bodies: None,
            particles: Some(end / SNAPSHOTS[0]),
            particles_at: Vec::new(),
            snapshots: SnapshotContent::default(),
            surfaces: None,
            surface_format: SeriesFormat::default(),
            grid: None,
            fringes: None,
            checkpoints: None,
            measurements: Measurements::of_run(end),
        }
    }

    /// The same of a run of so many bodies: where they are many, tables have fewer rows of each, and there are fewer
    /// snapshots.
    pub fn of_bodies(bodies: usize, end: f64) -> Self {
        let count = |all: f64, [most, least]: [f64; 2]| (all / bodies as f64).clamp(least, most);
        Outputs {
            tables: end / count(ALL_ROWS, ROWS),
            particles: Some(end / count(ALL_SNAPSHOTS, SNAPSHOTS)),
            ..Outputs::of_run(end)
        }
    }
}

impl Scene {
    /// Time between rows of tables of a run that ends at rest [s]: some hundred steps, as nobody knows before when that
    /// is; at most that of [`Outputs::of_bodies`].
    pub(super) fn rows_of_relaxation(&self) -> f64 {
        let Outputs { tables, .. } = Outputs::of_bodies(self.bodies.len(), self.time.end);
        let deforming = self.bodies.iter().filter(|body| !body.is_rigid());
        let wave = |body: &Body| self.materials[body.material].wave_speed(self.dimension.thickness());
        let crosses = |body: &Body| wave(body) / self.cell(body);
        let step = self.time.courant / deforming.map(crosses).fold(0.0, f64::max);
        let step = step.min(self.time.max_step.unwrap_or(f64::INFINITY));
        // As many times as long as those of few bodies.
        let longer = tables * ROWS[0] / self.time.end;
        tables.min(ROW_STEPS * longer * step)
    }
}

impl Measurements {
    /// Nothing to measure, evenly over a run of this length [s].
    pub fn of_run(end: f64) -> Self {
        Measurements { samples: end / SAMPLES, ..Default::default() }
    }
}

impl NamedMaterial {
    /// A material of this density [kg/m^3] whose law and constants have the names of scene files, in SI units.
    ///
    /// # Errors
    /// There is no such law or constant, or no stable material has these constants.
    pub fn new(
        name: &str,
        density: f64,
        law: &str,
        constants: &[(&str, f64)],
    ) -> Result<NamedMaterial, Problem> {
        let problem = |key: &str, found: String, allowed: String| {
            let key = format!("materials.{name}{key}");
            Problem { key, found, allowed, help: None }
        };
        let Some(description) = LAWS.iter().find(|description| description.name == law) else {
            let laws: Vec<&str> = LAWS.iter().map(|description| description.name).collect();
            return Err(problem("", format!("no law `{law}`"), laws.join(", ")));
        };
        let names: Vec<&str> = description.constants.iter().map(|constant| constant.name).collect();
        if let Some((unknown, _)) = constants.iter().find(|(constant, _)| !names.contains(constant)) {
            return Err(problem(&format!(".{law}"), format!("no constant `{unknown}`"), names.join(", ")));
        }
        let values = constants.iter().copied().collect();
        let law = description.build(&values).map_err(|bad| {
            let constant = bad.key.map(|key| format!(".{key}")).unwrap_or_default();
            problem(&format!(".{law}{constant}"), bad.found, bad.allowed)
        })?;
        Ok(NamedMaterial {
            name: name.to_string(),
            density,
            law,
            volume_change: VolumeChange::Own,
            thermal_expansion: 0.0,
        })
    }
}

impl Body {
    /// A body at rest that deforms and moves under forces. `material` is what [`Scene::add_material`] returned.
    pub fn new(name: &str, material: usize, shape: Shape) -> Self {
        Body {
            name: name.to_string(),
            material,
            shape,
            particles: Arrangement::default(),
            particles_per_side: None,
            interior: None,
            cell: None,
            motion: BodyMotion::default(),
            stress: None,
            velocity_by_place: None,
        }
    }

    /// The same body with its particles along its surface, see [`Arrangement::Fitted`].
    pub fn fitted(self) -> Self {
        Body { particles: Arrangement::Fitted, ..self }
    }

    /// The same body, deformable, with this velocity of its centre of mass [m/s] and this angular velocity about it
    /// [rad/s].
    pub fn moving(self, velocity: [f64; 3], spin: [f64; 3]) -> Self {
        Body { motion: BodyMotion::Free { velocity, spin }, ..self }
    }

    /// The same body with this Cauchy stress everywhere before anything moves: xx, yy, zz, xy, yz, xz, tension positive
    /// [Pa].
    pub fn stressed(self, stress: [f64; 6]) -> Self {
        Body { stress: Some(Box::new(stress.map(Expression::Constant))), ..self }
    }

    /// The same body, rigid, moved at this velocity [m/s] and turned at this angular velocity [rad/s] whatever pushes
    /// it.
    pub fn rigid(self, velocity: [f64; 3], spin: [f64; 3]) -> Self {
        let [velocity, spin] = [velocity, spin].map(|vector| Box::new(vector.map(Expression::Constant)));
        Body { motion: BodyMotion::Rigid { velocity, spin }, ..self }
    }
}

impl Body {
    /// The same body, rigid, moved by forces from this velocity of its centre [m/s] and this angular velocity [rad/s]
    /// on.
    pub fn free_rigid(self, velocity: [f64; 3], spin: [f64; 3]) -> Self {
        Body { motion: BodyMotion::FreeRigid(FreeRigid { velocity, spin, ..FreeRigid::default() }), ..self }
    }
}

impl Default for BodyMotion {
    /// It is at rest at the start.
    fn default() -> Self {
        BodyMotion::Free { velocity: [0.0; 3], spin: [0.0; 3] }
    }
}

impl Default for ContactRule {
    /// The law of exact surfaces without friction for every pair.
    fn default() -> Self {
        ContactRule::new(ContactLaw::Surface)
    }
}

impl ContactRule {
    /// A law without friction for every pair, with the normal that the law's papers use.
    pub fn new(law: ContactLaw) -> Self {
        let normal = match law {
            ContactLaw::Kinematic | ContactLaw::Traction => Normal::Own,
            ContactLaw::None
            | ContactLaw::Separation
            | ContactLaw::Regression
            | ContactLaw::Gap
            | ContactLaw::Surface
            | ContactLaw::Glued => Normal::Common,
        };
        ContactRule {
            between: [None, None],
            law,
            friction: 0.0,
            friction_given: false,
            kinetic_friction: 0.0,
            friction_decay_speed: 0.0,
            friction_memory: None,
            cohesion: 0.0,
            adhesion: 0.0,
            viscosity: 0.0,
            normal,
            max_strain: 0.5,
            restitution: 0.0,
            press: None,
        }
    }

    /// The same rule with this coefficient of friction, at rest and in motion; infinity sticks.
    pub fn with_friction(self, friction: f64) -> Self {
        ContactRule { friction, friction_given: true, kinetic_friction: friction, ..self }
    }

    /// The same rule for pairs of these two alone, each the name of a body or of a material.
    pub fn between(self, first: &str, second: &str) -> Self {
        ContactRule { between: [first, second].map(|name| Some(name.to_string())), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::parse;

    #[test]
    fn a_scene_in_code_is_that_of_the_file_which_says_no_more() {
        let text = r#"
gravity = [0, -9.81]
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.1
domain = { min = [-1, -1], max = [4, 4] }
[time]
end = 2
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 }
[[bodies]]
name = "disk"
material = "rubber"
shape.ball = { center = [0, 1], radius = 1 }
spin = -2
[[bodies]]
name = "floor"
material = "rubber"
shape.half_space = { point = [0, 0], normal = [0, 1] }
rigid = {}
[[contact]]
between = ["disk", "floor"]
friction = 0.3
[[contact]]
law = "traction"
"#;
        let mut scene = Scene::new(Dimension::PlaneStrain, 0.1, 2.0);
        scene.title = "written".to_string();
        scene.gravity = [0.0, -9.81, 0.0].into();
        scene.domain = Some(Domain::new([-1.0, -1.0, 0.0], [4.0, 4.0, 0.0]));
        let constants = [("young_modulus", 1e6), ("poisson_ratio", 0.3)];
        let rubber = NamedMaterial::new("rubber", 1000.0, "neo_hookean", &constants).unwrap();
        let rubber = scene.add_material(rubber);
        let disk = Body::new("disk", rubber, Shape::disk([0.0, 1.0], 1.0));
        scene.add_body(disk.moving([0.0; 3], [0.0, 0.0, -2.0]));
        let floor = Body::new("floor", rubber, Shape::half_space([0.0; 3], [0.0, 1.0, 0.0]));
        scene.add_body(floor.rigid([0.0; 3], [0.0; 3]));
        scene.contact.push(ContactRule::default().with_friction(0.3).between("disk", "floor"));
        scene.contact.push(ContactRule::new(ContactLaw::Traction));
        assert_eq!(scene, parse("written.toml", text, &[]).unwrap().scene);
    }

    #[test]
    fn a_material_that_cannot_be_says_what_is_allowed() {
        let say =
            |law, constants: &[_]| NamedMaterial::new("rubber", 1.0, law, constants).unwrap_err().to_string();
        assert!(
            say("neo_hokean", &[])
                .starts_with("materials.rubber: no law `neo_hokean`; allowed: neo_hookean, ")
        );
        let unknown = say("neo_hookean", &[("young_modul", 1.0)]);
        assert!(
            unknown.starts_with("materials.rubber.neo_hookean: no constant `young_modul`; allowed: "),
            "{unknown}"
        );
        let unstable = say("neo_hookean", &[("young_modulus", 1.0), ("poisson_ratio", 0.5)]);
        assert!(unstable.starts_with("materials.rubber.neo_hookean.poisson_ratio: 0.5; "), "{unstable}");
    }
}
