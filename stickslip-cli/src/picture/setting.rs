//! What a picture takes from the scene as it was run: names, where up is, which bodies are round, where mirrors stand.

use serde_json::Value;

/// What a picture takes from the scene; see [`Setting::of_json`].
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
}

/// A plane of symmetry across an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SymmetryPlane {
    /// 0, 1 or 2.
    pub axis: usize,
    /// Where it stands on the axis [m].
    pub position: f64,
}

impl Setting {
    /// The setting in a scene as `run.json` keeps it; what is missing there keeps its default.
    pub fn of_json(scene: &Value) -> Self {
        let bodies = scene["bodies"].as_array().map(Vec::as_slice).unwrap_or_default();
        Setting {
            title: scene["title"].as_str().unwrap_or_default().to_owned(),
            end: scene["time"]["end"].as_f64().unwrap_or_default(),
            gravity: triple(&scene["gravity"]).unwrap_or_default(),
            bodies: bodies.iter().map(|body| body["name"].as_str().unwrap_or_default().to_owned()).collect(),
            round: bodies.iter().map(|body| round(&body["shape"])).collect(),
            mirrors: mirrors(&scene["domain"]),
        }
    }

    /// The name of a body, or its number if the scene is not known.
    pub fn body_name(&self, body: usize) -> String {
        self.bodies.get(body).cloned().unwrap_or_else(|| format!("body {body}"))
    }

    /// The plane of symmetry to mirror the picture at when the user asks for nothing else: the only one there is.
    pub fn only_mirror(&self) -> Option<SymmetryPlane> {
        match self.mirrors.as_slice() {
            [mirror] => Some(*mirror),
            _ => None,
        }
    }
}

fn triple(value: &Value) -> Option<[f64; 3]> {
    let list = value.as_array()?;
    Some([list.first()?.as_f64()?, list.get(1)?.as_f64()?, list.get(2)?.as_f64()?])
}

/// The centre of a ball or a cylinder, also where other shapes are cut from it.
fn round(shape: &Value) -> Option<[f64; 3]> {
    if let Some(ball) = shape.get("ball") {
        return triple(&ball["center"]);
    }
    if let Some(cylinder) = shape.get("cylinder") {
        let (a, b) = (triple(&cylinder["start"])?, triple(&cylinder["end"])?);
        return Some(std::array::from_fn(|i| 0.5 * (a[i] + b[i])));
    }
    let parts = shape.get("intersection").or_else(|| shape.get("difference"))?;
    parts.as_array()?.iter().find_map(round)
}

fn mirrors(domain: &Value) -> Vec<SymmetryPlane> {
    let face = |axis: usize, side: usize| {
        let corner = if side == 0 { "min" } else { "max" };
        let symmetric = domain["faces"][axis][side] == "symmetry";
        symmetric
            .then(|| domain[corner][axis].as_f64())
            .flatten()
            .map(|position| SymmetryPlane { axis, position })
    };
    (0..6).filter_map(|i| face(i / 2, i % 2)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_half_ball_is_round_and_its_cut_is_a_mirror() {
        let scene = json!({
            "title": "a ball",
            "gravity": [0.0, 0.0, -9.81],
            "bodies": [{
                "name": "ball",
                "shape": { "intersection": [
                    { "half-space": { "point": [0, 0, 0], "normal": [0, -1, 0] } },
                    { "ball": { "center": [1.0, 0.0, 2.0], "radius": 1.0 } }
                ]}
            }],
            "domain": {
                "min": [0, 0, 0], "max": [4, 4, 4],
                "faces": [["open", "open"], ["symmetry", "open"], ["fixed", "open"]]
            }
        });
        let setting = Setting::of_json(&scene);
        assert_eq!(setting.round, vec![Some([1.0, 0.0, 2.0])]);
        assert_eq!(setting.only_mirror(), Some(SymmetryPlane { axis: 1, position: 0.0 }));
        assert_eq!(setting.body_name(0), "ball");
        assert_eq!(setting.body_name(7), "body 7");
    }

    #[test]
    fn an_unknown_scene_still_makes_a_setting() {
        assert_eq!(Setting::of_json(&Value::Null), Setting::default());
    }
}
