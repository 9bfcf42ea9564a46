//! What the user asks to be measured in a run: probes, arrivals and fronts, and the unit of time that they are told in.

use serde::{Deserialize, Serialize};

/// Measurements of waves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// What non-dimensional time counts in; `None` leaves time in seconds only.
    pub time_unit: Option<TimeUnit>,
    /// Interval between samples of the simulation [s]; 0 samples every step.
    pub samples: f64,
    /// Points at which the material is recorded.
    pub probes: Vec<Probe>,
    /// Thresholds whose first passing is recorded.
    pub arrivals: Vec<Arrival>,
    /// Fronts whose position is recorded.
    pub fronts: Vec<Front>,
    /// Planes through which forces and moments are recorded.
    pub sections: Vec<Section>,
    /// Faces of the domain, by the words of [`FACES`], and rigid bodies by their names, on which forces are recorded.
    pub reactions: Vec<String>,
    /// Bodies whose sums are recorded.
    pub groups: Vec<Group>,
    /// Packings whose stress and fabric are recorded.
    pub fabric: Vec<Fabric>,
    /// Points of contact whose pressure and shear are recorded.
    pub tractions: Option<Tractions>,
}

/// Words for the faces of a domain, by axis, the lower and the upper one.
pub const FACES: [[&str; 2]; 3] = [["x_min", "x_max"], ["y_min", "y_max"], ["z_min", "z_max"]];

impl Measurements {
    /// Faces of the domain, by axis and side, on which forces are recorded.
    pub fn faces(&self) -> impl Iterator<Item = [usize; 2]> {
        let wanted = |&[axis, side]: &[usize; 2]| self.reactions.iter().any(|name| name == FACES[axis][side]);
        (0..3).flat_map(|axis| [[axis, 0], [axis, 1]]).filter(wanted)
    }
}

/// Bodies whose sums are recorded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// Its name, unique among the groups.
    pub name: String,
    /// Names of its bodies.
    pub bodies: Vec<String>,
}

/// A packing whose stress and fabric are recorded, from the forces between its bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fabric {
    /// Its name, unique among the packings that are recorded.
    pub name: String,
    /// Names of its bodies.
    pub bodies: Vec<String>,
    /// Lower and upper corner of the box over which stress is averaged; bodies count whose centres are in it [m].
    pub within: [[f64; 3]; 2],
}

/// Points of contact on bodies on grids of their own, whose pressure and shear are recorded.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tractions {
    /// Time between records [s]; `None`: that between rows of other tables.
    pub interval: Option<f64>,
    /// Names of the bodies whose points they are; `None`: all.
    pub bodies: Option<Vec<String>>,
}

/// A unit of time that belongs to the scene, such as the time in which a wave crosses a disk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeUnit {
    /// Its length [s].
    pub seconds: f64,
    /// How the scene writes it: `"diameter / c_L"`.
    pub name: String,
}

/// A point at which velocity and stress are recorded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Probe {
    /// Its name, unique among the probes.
    pub name: String,
    /// Where it is at the start [m].
    pub at: [f64; 3],
    /// The body that it looks at; without it, whichever is there.
    pub body: Option<String>,
    /// What it stays with.
    pub fixed_in: Anchor,
}

/// A plane of space through which forces and moments are recorded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// Its name, unique among the sections.
    pub name: String,
    /// A point of it, about which moments are taken [m].
    pub point: [f64; 3],
    /// Unit normal [-].
    pub normal: [f64; 3],
    /// Lower and upper corner of the box in which material counts [m]; `None`: everywhere.
    pub within: Option<[[f64; 3]; 2]>,
    /// Names of the bodies that it cuts.
    pub bodies: Vec<String>,
}

/// What a probe stays with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Anchor {
    /// A point of space, through which material may move.
    Space,
    /// A point of the material, with which it moves.
    Material,
}

/// A number at a point of the material, from velocity and stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Observable {
    /// Velocity along x [m/s].
    Vx,
    /// Velocity along y [m/s].
    Vy,
    /// Velocity along z [m/s].
    Vz,
    /// Magnitude of the velocity [m/s].
    Speed,
    /// Normal stress along x, tension positive [Pa].
    Xx,
    /// Normal stress along y, tension positive [Pa].
    Yy,
    /// Normal stress along z, tension positive [Pa].
    Zz,
    /// Shear stress in the plane of x and y [Pa].
    Xy,
    /// Shear stress in the plane of y and z [Pa].
    Yz,
    /// Shear stress in the plane of x and z [Pa].
    Xz,
    /// -tr(sigma) / 3 [Pa].
    Pressure,
    /// Difference of the principal stresses in the plane of x and y, as light along z sees it [Pa].
    StressDifference,
    /// sqrt(3/2 s : s), with s the deviator of the stress [Pa].
    VonMises,
}

/// The first time at which a quantity passes a threshold, at probes and in bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Arrival {
    /// The quantity.
    pub quantity: Observable,
    /// It has arrived once it is this or beyond, seen from zero: a negative threshold is passed downward. Not zero.
    pub threshold: f64,
    /// Names of the probes.
    pub probes: Vec<String>,
    /// Names of the bodies.
    pub bodies: Vec<String>,
    /// What stands for a body.
    pub reading: Reading,
}

/// What stands for a body when one number is asked of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reading {
    /// The material at its centre of mass at the start.
    Center,
    /// The particle in which the quantity is furthest beyond zero, on the side of the threshold.
    Any,
    /// The mean over its mass.
    Mean,
}

/// The furthest point, along a direction, at which a quantity is at a threshold or beyond.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Front {
    /// Its name, unique among the fronts.
    pub name: String,
    /// The quantity.
    pub quantity: Observable,
    /// As that of an [`Arrival`].
    pub threshold: f64,
    /// The point from which its way is measured [m].
    pub from: [f64; 3],
    /// Unit vector along which it is measured [-].
    pub direction: [f64; 3],
    /// Only material within this distance of the line through `from` along `direction` counts [m].
    pub within: Option<f64>,
    /// Names of the bodies in which it runs.
    pub bodies: Vec<String>,
    /// Way over which its speed is fitted [m]; without it, from 10 % to 90 % of the way that it went.
    pub fit: Option<[f64; 2]>,
}

impl Measurements {
    /// Length of the unit of time, if there is one [s].
    pub fn unit(&self) -> Option<f64> {
        self.time_unit.as_ref().map(|unit| unit.seconds)
    }
}

impl Observable {
    /// Its value for a velocity [m/s] and a Cauchy stress xx, yy, zz, xy, yz, xz, tension positive [Pa].
    ///
    /// ```text
    /// stress_difference = sigma_1 - sigma_2 = sqrt((xx - yy)^2 + 4 xy^2)
    /// von_mises         = sqrt(((xx - yy)^2 + (yy - zz)^2 + (zz - xx)^2) / 2 + 3 (xy^2 + yz^2 + xz^2))
    /// ```
    pub fn value(self, velocity: &[f64; 3], stress: &[f64; 6]) -> f64 {
        let [xx, yy, zz, xy, yz, xz] = *stress;
        match self {
            Observable::Vx => velocity[0],
            Observable::Vy => velocity[1],
            Observable::Vz => velocity[2],
            Observable::Speed => velocity.iter().map(|v| v * v).sum::<f64>().sqrt(),
            Observable::Xx => xx,
            Observable::Yy => yy,
            Observable::Zz => zz,
            Observable::Xy => xy,
            Observable::Yz => yz,
            Observable::Xz => xz,
            Observable::Pressure => -(xx + yy + zz) / 3.0,
            Observable::StressDifference => ((xx - yy).powi(2) + 4.0 * xy * xy).sqrt(),
            Observable::VonMises => {
                let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
                (0.5 * normal + 3.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
            }
        }
    }

    /// Its name in scene files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Observable::Vx => "vx",
            Observable::Vy => "vy",
            Observable::Vz => "vz",
            Observable::Speed => "speed",
            Observable::Xx => "xx",
            Observable::Yy => "yy",
            Observable::Zz => "zz",
            Observable::Xy => "xy",
            Observable::Yz => "yz",
            Observable::Xz => "xz",
            Observable::Pressure => "pressure",
            Observable::StressDifference => "stress_difference",
            Observable::VonMises => "von_mises",
        }
    }

    /// Powers of kilogram, metre and second of its unit.
    pub(super) fn powers(self) -> [i8; 3] {
        match self {
            Observable::Vx | Observable::Vy | Observable::Vz | Observable::Speed => [0, 1, -1],
            _ => [1, -1, -2],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariants_of_stresses_that_are_known() {
        let value = |quantity: Observable, stress: [f64; 6]| quantity.value(&[3.0, 4.0, 12.0], &stress);
        let uniaxial = [-5.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(value(Observable::StressDifference, uniaxial), 5.0);
        assert_eq!(value(Observable::VonMises, uniaxial), 5.0);
        assert_eq!(value(Observable::Pressure, uniaxial), 5.0 / 3.0);
        let shear = [0.0, 0.0, 0.0, 2.0, 0.0, 0.0];
        assert_eq!(value(Observable::StressDifference, shear), 4.0);
        assert!((value(Observable::VonMises, shear) - 12.0_f64.sqrt()).abs() < 1e-15);
        let hydrostatic = [7.0, 7.0, 7.0, 0.0, 0.0, 0.0];
        assert_eq!(value(Observable::StressDifference, hydrostatic), 0.0);
        assert_eq!(value(Observable::VonMises, hydrostatic), 0.0);
        assert_eq!(value(Observable::Speed, hydrostatic), 13.0);
    }
}
