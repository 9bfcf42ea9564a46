//! The scene in `run.json`: what reports and pictures read of it again.

use crate::scene::{Domain, Fringes, Parameter, TimeUnit};
use serde::de::IgnoredAny;
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;

/// A scene as it was run, in SI units, parameters resolved. The record holds all of the scene; this is what has a
/// reader.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct RecordedScene {
    /// Its title.
    pub title: String,
    /// Its parameters; `None` for a number that was infinite.
    pub parameters: BTreeMap<String, Option<Parameter>>,
    /// Where material may be; `None` is unbounded space.
    pub domain: Option<Domain>,
    /// When it ends.
    pub time: RecordedTime,
    /// Acceleration of every body [m/s^2]: where that varies, of a table its largest value, and 0 of a formula.
    #[serde(deserialize_with = "largest")]
    pub gravity: [f64; 3],
    /// Its bodies, in the order of the numbers in snapshots.
    pub bodies: Vec<RecordedBody>,
    /// What was written.
    pub outputs: RecordedOutputs,
}

/// A number as a scene writes it that may vary.
#[derive(Deserialize)]
#[serde(untagged)]
enum RecordedNumber {
    Constant(f64),
    Table { table: Vec<[f64; 2]> },
    Formula(IgnoredAny),
}

fn largest<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 3], D::Error> {
    let numbers = <[RecordedNumber; 3]>::deserialize(deserializer)?;
    Ok(numbers.map(|number| match number {
        RecordedNumber::Constant(value) => value,
        RecordedNumber::Table { table } => {
            let values = table.into_iter().map(|[_, value]| value);
            values.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or_default()
        }
        RecordedNumber::Formula(_) => 0.0,
    }))
}

/// When a recorded scene ends.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct RecordedTime {
    /// Simulated time at which the run was to end [s]; `None` if it was infinite.
    pub end: Option<f64>,
}

/// A body of a recorded scene.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct RecordedBody {
    /// Its name.
    pub name: String,
    /// Where it is at the start.
    pub shape: RecordedShape,
    motion: RecordedMotion,
}

/// The parts of a shape that may be round. A shape is written as what it is called and what belongs to it.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct RecordedShape {
    ball: Option<RecordedBall>,
    cylinder: Option<RecordedCylinder>,
    intersection: Vec<RecordedShape>,
    difference: Vec<RecordedShape>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
struct RecordedBall {
    center: [f64; 3],
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
struct RecordedCylinder {
    start: [f64; 3],
    end: [f64; 3],
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum RecordedMotion {
    Free(IgnoredAny),
    Rigid(IgnoredAny),
    FreeRigid(IgnoredAny),
}

/// What a recorded scene wrote.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct RecordedOutputs {
    /// Its photoelastic fringes.
    pub fringes: Option<Fringes>,
    /// How it measured.
    pub measurements: RecordedMeasurements,
}

/// How a recorded scene measured.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct RecordedMeasurements {
    /// What non-dimensional time counts in.
    pub time_unit: Option<TimeUnit>,
}

impl RecordedScene {
    /// A parameter, in SI units; NaN where there is no such number.
    pub fn number(&self, parameter: &str) -> f64 {
        self.parameters.get(parameter).and_then(|value| value.as_ref()?.number()).unwrap_or(f64::NAN)
    }
}

impl RecordedBody {
    /// Whether it is rigid.
    pub fn is_rigid(&self) -> bool {
        !matches!(self.motion, RecordedMotion::Free(_))
    }
}

impl RecordedShape {
    /// The centre of a ball or a cylinder, also where other shapes are cut from it [m].
    pub fn round_center(&self) -> Option<[f64; 3]> {
        let ball = self.ball.as_ref().map(|ball| ball.center);
        let cylinder =
            || self.cylinder.as_ref().map(|part| [0, 1, 2].map(|i| 0.5 * (part.start[i] + part.end[i])));
        let part = || self.intersection.iter().chain(&self.difference).find_map(RecordedShape::round_center);
        ball.or_else(cylinder).or_else(part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    #[test]
    fn what_has_a_reader_comes_back_from_any_scene() {
        let text = r#"
            title = "a half ball over a floor"
            gravity = [0, 0, -9.81]
            parameters = { speed = 2, word = "gap" }
            time.end = 1
            outputs.time_unit = "3 / speed"

            [space]
            dimension = "3d"
            interior = "grid"
            cell = 1
            domain = { min = [-4, 0, 0], max = [4, 4, 4], y_min = "symmetry" }

            [materials.iron]
            density = 1
            neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 }

            [[bodies]]
            name = "ball"
            material = "iron"
            shape.intersection = [
                { half_space = { point = [0, 0, 0], normal = [0, -1, 0] } },
                { ball = { center = [1, 0, 2], radius = 1 } },
            ]

            [[bodies]]
            name = "floor"
            material = "iron"
            shape.half_space = { point = [0, 0, 1], normal = [0, 0, 1] }
            rigid = {}

            [[bodies]]
            name = "hammer"
            material = "iron"
            shape.ball = { center = [1, 0, 5], radius = 1 }
            rigid.free = {}
        "#;
        let scene = scene::parse("scene", text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        let json = serde_json::to_value(&scene).unwrap();
        let read: RecordedScene = serde_json::from_value(json).unwrap();
        assert_eq!(
            (&read.title, read.time.end, read.gravity),
            (&scene.title, Some(1.0), scene.gravity.at(0.0))
        );
        let varies = text.replace("[0, 0, -9.81]", "['9 * t', 0, { table = [[0, 0], [1, -9.81], [2, -3]] }]");
        let scene = scene::parse("scene", &varies, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        let read: RecordedScene = serde_json::from_value(serde_json::to_value(&scene).unwrap()).unwrap();
        assert_eq!(read.gravity, [0.0, 0.0, -9.81]);
        assert_eq!((read.number("speed"), read.number("word").is_nan()), (2.0, true));
        assert_eq!(read.domain, scene.domain);
        assert_eq!(read.outputs.measurements.time_unit, scene.outputs.measurements.time_unit);
        let [ball, floor, hammer] = &read.bodies[..] else { panic!("{:?}", read.bodies) };
        assert_eq!((ball.shape.round_center(), ball.is_rigid()), (Some([1.0, 0.0, 2.0]), false));
        assert_eq!((floor.shape.round_center(), floor.is_rigid()), (None, true));
        assert!(hammer.is_rigid());
    }
}
