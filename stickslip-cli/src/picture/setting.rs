//! What a picture takes from the scene as it was run: names, where up is, which bodies are round, where mirrors stand.

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
    /// The setting of a scene that was run.
    pub fn of(scene: &RecordedScene) -> Self {
        Setting {
            title: scene.title.clone(),
            end: scene.time.end.unwrap_or_default(),
            gravity: scene.gravity,
            bodies: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            round: scene.bodies.iter().map(|body| body.shape.round_center()).collect(),
            mirrors: scene.domain.as_ref().map(mirrors).unwrap_or_default(),
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
