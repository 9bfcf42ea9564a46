//! What a picture takes from the scene as it was run: names, where up is, which bodies are round, where mirrors stand.

use serde_json::Value;
use stickslip::observe::RecordedScene;
use stickslip::scene::{Domain, Face};

/// What a picture takes from the scene; see [`Setting::of`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Setting {
    /// The scene's title.
    pub title: String,
    /// Simulated time at which the run is to end [s].
    pub end: f64,
    /// Acceleration [m/s^2].
    pub gravity: [f64; 3],
    /// Names of the bodies.
    pub bodies: Vec<String>,
    /// Centres at the start of the bodies that are round [m].
    pub round: Vec<Option<[f64; 3]>>,
    /// The planes of symmetry.
    pub mirrors: Vec<SymmetryPlane>,
    /// Half-spaces that rest.
    pub floors: Vec<Floor>,
}

/// A half-space of a rigid body at rest: particles of it are only where other bodies are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floor {
    /// Index of the body.
    pub body: u32,
    /// A point of its plane [m].
    pub point: [f64; 3],
    /// Its outward normal, of any length.
    pub normal: [f64; 3],
}

impl Floor {
    /// Its mirror image.
    pub fn mirrored(&self, SymmetryPlane { axis, position }: SymmetryPlane) -> Self {
        let mut image = *self;
        image.point[axis] = 2.0 * position - self.point[axis];
        image.normal[axis] = -self.normal[axis];
        image
    }

    /// Whether a point lies in it.
    pub fn holds(&self, x: [f64; 2]) -> bool {
        (0..2).map(|i| (x[i] - self.point[i]) * self.normal[i]).sum::<f64>() < 0.0
    }
}

/// A plane of symmetry across an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SymmetryPlane {
    /// 0, 1 or 2.
    pub axis: usize,
    /// Where it stands on the axis [m].
    pub position: f64,
}

impl SymmetryPlane {
    /// Where a place is in the mirror [m].
    pub fn image(self, mut place: [f64; 3]) -> [f64; 3] {
        place[self.axis] = 2.0 * self.position - place[self.axis];
        place
    }
}

impl Setting {
    /// The setting of a scene that was run.
    pub fn of(scene: &RecordedScene) -> Self {
        Setting {
            title: scene.title.clone(),
            end: scene.time.end.unwrap_or_default(),
            gravity: scene.gravity,
            bodies: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            round: scene.bodies.iter().map(|body| body.shape.round_center()).collect(),
            mirrors: scene.domain.as_ref().map(mirrors).unwrap_or_default(),
            floors: Vec::new(),
        }
    }

    /// With the half-spaces at rest of the scene as `run.json` has it.
    pub fn with_floors(self, scene: &Value) -> Self {
        let bodies = scene["bodies"].as_array().map_or(&[][..], Vec::as_slice);
        let found = bodies.iter().enumerate().flat_map(|(i, body)| floors_of(i as u32, body));
        Setting { floors: found.collect(), ..self }
    }

    /// Without the half-spaces of bodies that are not shown.
    pub fn with_bodies(mut self, shown: &[bool]) -> Self {
        self.floors.retain(|floor| shown.get(floor.body as usize) != Some(&false));
        self
    }

    /// The name of a body, or its number if the scene is not known.
    pub fn body_name(&self, body: usize) -> String {
        self.bodies.get(body).cloned().unwrap_or_else(|| format!("body {body}"))
    }

    /// Whether a body is made of half-spaces that rest.
    pub fn has_floor(&self, body: u32) -> bool {
        self.floors.iter().any(|floor| floor.body == body)
    }

    /// The plane of symmetry to mirror the picture at when the user asks for nothing else: the only one there is.
    pub fn only_mirror(&self) -> Option<SymmetryPlane> {
        match self.mirrors.as_slice() {
            [mirror] => Some(*mirror),
            _ => None,
        }
    }
}

/// The half-spaces of a recorded body, if it is made of such alone and rests.
fn floors_of(body: u32, recorded: &Value) -> Vec<Floor> {
    let motion = &recorded["motion"]["rigid"];
    let rests = |key: &str| {
        motion[key].as_array().is_some_and(|values| values.iter().all(|value| value.as_f64() == Some(0.0)))
    };
    let shape = &recorded["shape"];
    let parts = shape["union"].as_array().map_or(std::slice::from_ref(shape), Vec::as_slice);
    let vector = |part: &Value, key: &str| {
        let numbers = part["half-space"][key].as_array()?;
        Some([0, 1, 2].map(|i| numbers.get(i).and_then(Value::as_f64).unwrap_or(0.0)))
    };
    let floor =
        |part: &Value| Some(Floor { body, point: vector(part, "point")?, normal: vector(part, "normal")? });
    let floors: Option<Vec<Floor>> = parts.iter().map(floor).collect();
    floors.filter(|_| rests("velocity") && rests("spin")).unwrap_or_default()
}

fn mirrors(domain: &Domain) -> Vec<SymmetryPlane> {
    let face = |(axis, side): (usize, usize)| {
        let position = [domain.min, domain.max][side][axis];
        (domain.faces[axis][side] == Face::Symmetry).then_some(SymmetryPlane { axis, position })
    };
    (0..6).filter_map(|i| face((i / 2, i % 2))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_spaces_at_rest_are_floors() {
        let text = r#"
            space = { dimension = "plane-strain", interior = "grid", cell = 0.1 }
            time.end = 1
            materials.iron = { density = 1, neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 } }
            bodies = [
                { name = "ball", material = "iron", shape.ball = { center = [0, 1], radius = 1 } },
                { name = "floor", material = "iron", shape.half_space = { point = [0, 0], normal = [0, 1] }, rigid = {} },
                { name = "lid", material = "iron", shape.half_space = { point = [0, 9], normal = [0, -1] },
                  rigid.velocity = [0, "-1 * t"] },
                { name = "walls", material = "iron", rigid = {}, shape.union = [
                    { half_space = { point = [-5, 0], normal = [1, 0] } },
                    { half_space = { point = [5, 0], normal = [-1, 0] } },
                ] },
            ]
        "#;
        let loaded = stickslip::scene::parse("a.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"));
        let setting = Setting::default().with_floors(&stickslip::observe::Manifest::record(&loaded.scene));
        let bodies: Vec<u32> = setting.floors.iter().map(|floor| floor.body).collect();
        assert_eq!(bodies, [1, 3, 3]);
        let holds = |x: [f64; 2]| setting.floors.iter().any(|floor| floor.holds(x));
        let mut shown = [true; 4];
        shown[3] = false;
        let bodies = setting.clone().with_bodies(&shown).floors;
        assert_eq!(bodies, setting.floors[..1]);
        let image = setting.floors[1].mirrored(SymmetryPlane { axis: 0, position: 2.0 });
        assert!(image.holds([9.5, 0.0]) && !image.holds([8.5, 0.0]));
        assert!(holds([0.0, -0.1]) && holds([-6.0, 3.0]) && holds([6.0, 3.0]) && !holds([0.0, 0.1]));
    }

    #[test]
    fn a_cut_is_a_mirror() {
        let mut domain = Domain::new([0.5; 3], [4.0; 3]);
        domain.faces[1] = [Face::Symmetry, Face::Fixed];
        let setting = Setting { mirrors: mirrors(&domain), ..Setting::default() };
        assert_eq!(setting.only_mirror(), Some(SymmetryPlane { axis: 1, position: 0.5 }));
        domain.faces[2][1] = Face::Symmetry;
        let setting = Setting { mirrors: mirrors(&domain), ..setting };
        assert_eq!(
            (setting.mirrors[1], setting.only_mirror()),
            (SymmetryPlane { axis: 2, position: 4.0 }, None)
        );
    }
}
