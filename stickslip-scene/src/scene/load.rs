//! From a scene file to a [`Scene`].

use super::Scene;
use super::error::SceneError;
use super::file::{self, Disk, SceneFiles};
use super::source::Source;
use super::suggestion::did_you_mean;
use super::was_read::{FileRead, Noted, WasRead};
use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

/// A scene and the text that it came from.
#[derive(Debug)]
pub struct Loaded {
    /// What the text says.
    pub scene: Scene,
    /// The text, to show where a mistake that is found later stands.
    pub source: Source,
    /// The files that it names, as they were read.
    pub files: Vec<FileRead>,
}

impl Loaded {
    /// What was read, and what came of it, to be held against what others have read.
    pub fn was_read(&self) -> WasRead {
        WasRead::new(&self.files, &self.scene)
    }
}

/// Reads the scene file at `path`, with `overrides` as [`parse`] takes them.
///
/// # Errors
/// A file that cannot be read, and what [`parse`] finds.
pub fn load(path: &Path, overrides: &[(String, String)]) -> Result<Loaded, SceneError> {
    let text = read_text(path).map_err(|reason| SceneError::Unreadable {
        path: path.to_path_buf(),
        help: neighbour(path),
        reason,
    })?;
    let name = path.display().to_string();
    let source = Source::read(&name, &text, overrides)?;
    resolved(source.beside(path.parent().unwrap_or(Path::new(""))), &Disk)
}

/// Reads a scene from its text; `name` stands for the file in messages.
///
/// Each override is a name and a value. A name without dots is a parameter: `("cells_per_radius", "4")`,
/// `("contact", "gap")`, `("angle", "pi / 6")`; a path with dots is any key: `("time.end", "1 s")`,
/// `("bodies[0].velocity", "[1, 0, 0]")`.
///
/// # Errors
/// The first mistake, with file, line, column, key, what was found, what is allowed and a suggestion.
pub fn parse(name: &str, text: &str, overrides: &[(String, String)]) -> Result<Loaded, SceneError> {
    parse_beside(name, text, overrides, &Disk)
}

/// As [`parse`], with the files that the scene names from elsewhere than the disk.
///
/// # Errors
/// As [`parse`].
pub fn parse_beside(
    name: &str,
    text: &str,
    overrides: &[(String, String)],
    files: &dyn SceneFiles,
) -> Result<Loaded, SceneError> {
    resolved(Source::read(name, text, overrides)?, files)
}

fn resolved(mut source: Source, files: &dyn SceneFiles) -> Result<Loaded, SceneError> {
    let noted = Noted::new(files);
    let file::Resolved { scene, declared, told } =
        file::resolve(&source, &noted).map_err(|fault| source.show(fault))?;
    source.declare(declared);
    source.tell(told);
    Ok(Loaded { scene, source, files: noted.into_read() })
}

/// Bytes of a scene file at most: a million bodies written one by one.
const MOST_BYTES: u64 = 1 << 28;

/// The text of a file, which may be a device that has no end.
fn read_text(path: &Path) -> io::Result<String> {
    let mut text = String::new();
    File::open(path)?.take(MOST_BYTES + 1).read_to_string(&mut text)?;
    if text.len() as u64 > MOST_BYTES {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it has more than 256 MiB"));
    }
    Ok(text)
}

/// A scene beside a missing file with almost its name.
fn neighbour(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let wanted = path.file_name()?.to_str()?;
    let names: Vec<String> = std::fs::read_dir(folder)
        .ok()?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    let scenes = names.iter().map(String::as_str).filter(|name| name.ends_with(".toml") && *name != wanted);
    did_you_mean(wanted, scenes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Shape;
    use crate::scene::{BasisKind, BodyMotion, ContactLaw, Dimension, Face, Normal, Parameter, Precision};

    const ROLLING: &str = include_str!("../../tests/scenes/rolling.toml");
    const WEDGE: &str = include_str!("../../tests/scenes/wedge.toml");
    const MINIMAL: &str = include_str!("../../tests/scenes/minimal.toml");

    fn scene(text: &str, overrides: &[(&str, &str)]) -> Scene {
        let overrides: Vec<_> =
            overrides.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
        parse("scenes/example.toml", text, &overrides).unwrap_or_else(|error| panic!("{error}")).scene
    }

    #[test]
    fn a_scene_in_space() {
        let scene = scene(ROLLING, &[]);
        assert_eq!(scene.title, "Sphere rolling down an inclined plane (gap)");
        assert_eq!(scene.parameters["cell"], Parameter::Number(0.2));
        assert_eq!(scene.parameters["contact"], Parameter::Text("gap".to_string()));
        assert_eq!((scene.dimension, scene.discretization.cell), (Dimension::Space, 0.2));
        let gravity = scene.gravity.constant().expect("a constant");
        assert!((gravity[0] - 50.0_f64.sqrt()).abs() < 1e-14 && gravity[1] == 0.0);
        assert_eq!(scene.domain.as_ref().map(|domain| domain.max), Some([18.0, 2.0, 4.0]));
        assert_eq!(scene.domain.as_ref().map(|domain| domain.faces[1]), Some([Face::Symmetry, Face::Open]));
        assert_eq!(scene.materials[1].density, 2600.0);
        assert_eq!(scene.bodies[0].shape, Shape::Ball { center: [0.0, 0.0, 1.6], radius: 1.6 });
        assert_eq!(scene.bodies[0].motion, BodyMotion::Free { velocity: [0.0; 3], spin: [0.0, 5.0, 0.0] });
        let rule = scene.contact_between(0, 1);
        assert_eq!((rule.law, rule.friction, rule.normal), (ContactLaw::Gap, 0.495, Normal::Common));
        assert_eq!(
            (scene.outputs.tables, scene.outputs.particles, scene.outputs.grid),
            (0.01, Some(0.05), None)
        );
        assert!((scene.references[0].value.at(2.0) - 100.0 * 2.0_f64.sqrt() / 14.0).abs() < 1e-13);
        assert!((scene.references[1].value.at(2.0) - 100.0 / 7.0 * 0.5_f64.sqrt()).abs() < 1e-13);
        assert_eq!(scene.references[1].label, "rigid sphere, radius 1.6 m");
    }

    #[test]
    fn a_scene_in_the_plane() {
        let scene = scene(WEDGE, &[]);
        assert_eq!((scene.dimension, scene.precision), (Dimension::PlaneStrain, Precision::Single));
        assert_eq!(scene.discretization.basis, BasisKind::Linear);
        let BodyMotion::Free { velocity, spin } = scene.bodies[0].motion else { panic!("the ring is free") };
        assert!((velocity[1] + (2.0_f64 * 9.81 * 0.2).sqrt()).abs() < 1e-14);
        assert!((spin[2] - std::f64::consts::PI / 6.0).abs() < 1e-15);
        let BodyMotion::Rigid { velocity, spin } = &scene.bodies[1].motion else {
            panic!("the wedge is rigid")
        };
        assert_eq!([0.0, 0.001, 0.01].map(|t| velocity[1].at(t)), [0.0, -0.05, -0.1]);
        assert_eq!([0.0, 0.009, 0.01].map(|t| spin[2].at(t)), [1.0, 1.0, 0.0]);
        let rule = scene.contact_between(1, 0);
        assert_eq!((rule.law, rule.normal), (ContactLaw::Kinematic, Normal::Own));
        assert_eq!(rule.friction, f64::INFINITY);
        assert_eq!(scene.contact_between(0, 2).law, ContactLaw::Glued);
    }

    #[test]
    fn what_is_not_said_has_its_usual_value() {
        let scene = scene(MINIMAL, &[]);
        assert_eq!((scene.title.as_str(), scene.about.as_str()), ("example", ""));
        assert!(scene.gravity.is_none() && scene.domain.is_none());
        assert_eq!((scene.time.courant, scene.time.pic_share, scene.time.max_step), (0.4, 0.0, None));
        assert_eq!(scene.discretization.particles_per_side, 2);
        assert_eq!((scene.outputs.tables, scene.outputs.particles), (0.005, Some(0.05)));
    }

    #[test]
    fn soil_that_opens_has_volumes_of_its_own() {
        let text = "time.end = 1\nspace = { dimension = 'plane-strain', cell = 0.1 }\n[materials.sand]\ndensity = 1\n\
                    volume_change = 'averaged'\n\
                    [materials.sand.drucker_prager]\nyoung_modulus = 1\npoisson_ratio = 0.3\n\
                    friction_angle = '30 deg'\n\
                    [[bodies]]\nname = 'a'\nmaterial = 'sand'\nshape.ball = { center = [0, 0], radius = 1 }\n";
        let error = parse("a.toml", text, &[]).expect_err("averaged").to_string();
        let wanted = "a.toml:5:17: materials.sand.volume_change: found \"averaged\" of `drucker_prager`; allowed: \
                      \"own\"";
        assert!(error.starts_with(wanted), "{error}");
    }

    /// A named shape is what it is where it is written out.
    #[test]
    fn shapes_have_names() {
        let text = MINIMAL.replace(
            "[space]",
            "[shapes]\nhole.ball = { center = [0, 0, 1], radius = 1 }\n\
             bored.difference = [{ box = { min = [-2, -2, -2], max = [2, 2, 2] } }, \"hole\"]\n[space]",
        );
        let shape =
            text.lines().find(|line| line.starts_with("shape")).expect("a body has a shape").to_string();
        let named = scene(&text.replace(&shape, "shape = \"bored\""), &[]);
        let hole = Shape::Ball { center: [0.0, 0.0, 1.0], radius: 1.0 };
        let cube = Shape::Box { min: [-2.0; 3], max: [2.0; 3] };
        assert_eq!(named.bodies[0].shape, Shape::Difference(vec![cube, hole]));
        let wider = scene(&text.replace(&shape, "shape = \"hole\""), &[("shapes.hole.ball.radius", "3")]);
        assert_eq!(wider.bodies[0].shape, Shape::Ball { center: [0.0, 0.0, 1.0], radius: 3.0 });
    }

    #[test]
    fn overrides_replace_parameters_and_keys() {
        let changed = scene(
            ROLLING,
            &[
                ("cells_per_radius", "4"),
                ("contact", "traction"),
                ("angle", "pi / 6"),
                ("time.end", "500 ms"),
                ("outputs.grid", "0.1"),
                ("bodies[0].velocity[0]", "2 cm/s"),
                ("bodies[0].spin", "[0, 0, 1]"),
            ],
        );
        assert_eq!(changed.discretization.cell, 0.4);
        assert_eq!(changed.contact[0].law, ContactLaw::Traction);
        assert!((changed.gravity.at(0.0)[0] - 5.0).abs() < 1e-14);
        assert_eq!((changed.time.end, changed.outputs.grid), (0.5, Some(0.1)));
        assert_eq!(
            changed.bodies[0].motion,
            BodyMotion::Free { velocity: [0.02, 0.0, 0.0], spin: [0.0, 0.0, 1.0] }
        );
    }

    #[test]
    fn a_word_may_look_like_a_formula() {
        let text = MINIMAL.replace("\"3d\"", "\"{kind}\"");
        let scene = scene(&format!("parameters.kind = \"3d\"\n{text}"), &[]);
        assert_eq!(scene.parameters["kind"], Parameter::Text("3d".to_string()));
    }
}
