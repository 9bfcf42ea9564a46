//! What the user asks of the virtual polariscope; the room `polariscope` does it.

use serde::{Deserialize, Serialize};

/// A camera that looks through a polariscope along the third axis while a scene runs.
/// Times are in seconds of simulated time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fringes {
    /// When the shutter opens for the first frame [s].
    pub first: f64,
    /// From one opening to the next [s].
    pub interval: f64,
    /// How long the shutter stays open [s]: a frame is the mean of the light in that time; 0 is an instant.
    pub exposure: f64,
    /// Instants, evenly in the open time, whose light is averaged.
    pub samples: usize,
    /// Width of the frames; their height follows what they show [pixels].
    pub width: usize,
    /// Lower and upper corner of what the frames show [m]; without it, the birefringent bodies at the start.
    pub view: Option<[[f64; 2]; 2]>,
    /// Names of the birefringent bodies; the others are opaque.
    pub bodies: Vec<String>,
    /// What is drawn over the fringes.
    pub overlay: Overlay,
    /// The optics.
    pub polariscope: Polariscope,
}

/// The optics of a polariscope.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Polariscope {
    /// How much stress makes a fringe.
    pub sensitivity: Sensitivity,
    /// The wavelength for which `sensitivity` holds, and that of monochromatic light [m].
    pub wavelength: f64,
    /// What unloaded bodies look like.
    pub field: PolariscopeField,
    /// The light.
    pub light: Light,
    /// Angle of the first polariser from the x axis in a plane polariscope [rad]; `None` is a circular polariscope.
    pub polarizer: Option<f64>,
}

/// How much stress makes a fringe; see [`Polariscope::order`](crate::polariscope).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sensitivity {
    /// Principal stress difference, averaged along the light's way through the body, for one fringe: f_sigma / t, or 2
    /// pi s with the s of Bardenhagen et al. (2001) [Pa].
    StressPerFringe(f64),
    /// The same, integrated along the way, for one fringe: f_sigma = wavelength / stress-optic coefficient [Pa m].
    StressThicknessPerFringe(f64),
}

/// What unloaded bodies look like between the polarisers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PolariscopeField {
    /// Black: crossed polarisers, fringes of whole order are black.
    Dark,
    /// Bright: parallel polarisers, fringes of half order are black.
    Light,
}

/// The light of a polariscope.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Light {
    /// Of one wavelength, on a film without colour.
    Grey,
    /// Of one wavelength, in its colour.
    Monochrome,
    /// All visible wavelengths alike.
    White,
}

/// What is drawn over the fringes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Overlay {
    /// Nothing.
    None,
    /// Lines between the centres of bodies that press on each other, wider for larger forces.
    ForceChains,
}

impl Polariscope {
    /// Green light of a mercury lamp, for which most stress-optic coefficients are given [m].
    pub const MERCURY_GREEN: f64 = 546.1e-9;
}
