//! `outputs.fringes`: a camera behind a polariscope.

use super::Context;
use super::quantity::{Angle, Compliance, Duration, Length, Pressure, QuantityInput};
use super::read::table;
use super::text::{Choice, Count, Text, Word, names_in};
use super::vector::VectorInput;
use crate::scene::error::Fault;
use crate::scene::{self, Body, Dimension, Light, Overlay, Polariscope, PolariscopeField, Sensitivity};
use std::f64::consts::PI;

table! {
    /// A camera behind a virtual polariscope, which looks along the third axis. Either `stress_optic_coefficient` (in
    /// the plane with `thickness`) or `stress_parameter` says how much stress makes a fringe.
    Fringes {
        /// When the shutter opens for the first frame [s].
        #[schemars(extend("default" = 0))]
        first: Option<QuantityInput<Duration>>,
        /// From one opening of the shutter to the next [s].
        interval: QuantityInput<Duration>,
        /// How long the shutter stays open [s]; a frame is the mean of the light in that time.
        #[schemars(extend("default" = 0))]
        exposure: Option<QuantityInput<Duration>>,
        /// Instants in the open time whose light is averaged, 1 to 64; by default 8, without exposure 1.
        samples: Option<Count>,
        /// Stress-optic coefficient C: the refractive indices differ by C times the principal stress difference [1/Pa].
        stress_optic_coefficient: Option<QuantityInput<Compliance>>,
        /// Thickness that light crosses in a plane scene [m].
        thickness: Option<QuantityInput<Length>>,
        /// The paper's parameter s: a circular polariscope shows cos((sigma_1 - sigma_2) / s) [Pa].
        stress_parameter: Option<QuantityInput<Pressure>>,
        /// Wavelength of the light, and the one that the coefficient or the parameter holds for [m];
        /// by default 546.1 nm.
        wavelength: Option<QuantityInput<Length>>,
        /// What unloaded bodies look like.
        #[schemars(extend("default" = "dark"))]
        field: Option<Word<PolariscopeField>>,
        /// The light.
        #[schemars(extend("default" = "grey"))]
        light: Option<Word<Light>>,
        /// Angle of the polariser from x [rad]: a plane polariscope, with isoclinics; by default it is circular.
        polarizer: Option<QuantityInput<Angle>>,
        /// Names of the birefringent bodies; by default all but rigid ones. The others are opaque.
        bodies: Option<Vec<Text>>,
        /// What the frames show; by default the birefringent bodies at the start.
        view: Option<View>,
        /// Width of the frames in pixels, 16 to 8000; by default 1280.
        width: Option<Count>,
        /// What is drawn over the fringes.
        #[schemars(extend("default" = "none"))]
        overlay: Option<Word<Overlay>>,
    }
}

table! {
    /// A rectangle of the plane.
    View {
        /// Lower corner: [x, y] [m].
        min: VectorInput<Length>,
        /// Upper corner: [x, y] [m].
        max: VectorInput<Length>,
    }
}

impl Choice for PolariscopeField {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        (
            "dark",
            PolariscopeField::Dark,
            "Crossed polarisers: unloaded bodies and fringes of whole order are black.",
        ),
        ("light", PolariscopeField::Light, "Parallel polarisers: fringes of half order are black."),
    ];
}

impl Choice for Light {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("grey", Light::Grey, "One wavelength on a film without colour."),
        ("monochrome", Light::Monochrome, "One wavelength in its colour."),
        ("white", Light::White, "All visible wavelengths: coloured fringes."),
    ];
}

impl Choice for Overlay {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("none", Overlay::None, "Nothing."),
        ("force-chains", Overlay::ForceChains, "Lines between bodies that press on each other."),
    ];
}

/// Instants in an exposure where the scene does not say.
const SAMPLES: usize = 8;
/// Frames that the run of a scene may ask for.
const MOST_FRAMES: f64 = 1e6;
/// Width of frames where the scene does not say [pixels].
const WIDTH: usize = 1280;

impl Fringes {
    /// The camera and its optics.
    pub fn resolve(&self, (bodies, end): (&[Body], f64), context: &Context) -> Result<scene::Fringes, Fault> {
        let exposure = at_least_zero(self.exposure.as_ref(), context)?;
        let interval = self.interval.positive(context)?;
        if interval < end / MOST_FRAMES {
            let least =
                format!("at least {:e} s: a run has at most {MOST_FRAMES:e} frames", end / MOST_FRAMES);
            return Err(self.interval.refused(interval, least));
        }
        if let Some(quantity) = self.exposure.as_ref().filter(|_| exposure > interval) {
            return Err(quantity.refused(exposure, format!("at most the interval, {interval} s")));
        }
        let samples = self.samples.as_ref().map(|count| count.value(context, 1..=64)).transpose()?;
        Ok(scene::Fringes {
            first: at_least_zero(self.first.as_ref(), context)?,
            interval,
            exposure,
            samples: samples.unwrap_or(if exposure > 0.0 { SAMPLES } else { 1 }),
            width: self.width.as_ref().map_or(Ok(WIDTH), |count| count.value(context, 16..=8000))?,
            view: self.view.as_ref().map(|view| view.resolve(context)).transpose()?,
            bodies: self.names(bodies, context)?,
            overlay: self.overlay.as_ref().map_or(Ok(Overlay::None), |word| word.value(context))?,
            polariscope: self.polariscope(context)?,
        })
    }

    fn polariscope(&self, context: &Context) -> Result<Polariscope, Fault> {
        let wavelength = self.wavelength.as_ref().map(|length| {
            let visible = "a visible wavelength, \"380 nm\" to \"780 nm\"";
            length.checked(context, visible, |value| (380e-9..=780e-9).contains(&value))
        });
        let wavelength = wavelength.transpose()?.unwrap_or(Polariscope::MERCURY_GREEN);
        Ok(Polariscope {
            sensitivity: self.sensitivity(wavelength, context)?,
            wavelength,
            field: self.field.as_ref().map_or(Ok(PolariscopeField::Dark), |word| word.value(context))?,
            light: self.light.as_ref().map_or(Ok(Light::Grey), |word| word.value(context))?,
            polarizer: self.polarizer.as_ref().map(|angle| angle.value(context)).transpose()?,
        })
    }

    /// f_sigma = wavelength / C, and f_sigma / t = 2 pi s.
    fn sensitivity(&self, wavelength: f64, context: &Context) -> Result<Sensitivity, Fault> {
        let space = context.dimension == Dimension::Space;
        match (&self.stress_optic_coefficient, &self.stress_parameter, &self.thickness) {
            (None, Some(_), Some(thickness)) => {
                Err(thickness.node().fault("no thickness beside stress_parameter, which holds for the stress itself"))
            }
            (None, Some(parameter), None) => {
                Ok(Sensitivity::StressPerFringe(2.0 * PI * parameter.positive(context)?))
            }
            (Some(_), Some(parameter), _) => {
                Err(parameter.node().fault("either stress_optic_coefficient or stress_parameter"))
            }
            (Some(_), None, Some(thickness)) if space => {
                Err(thickness.node().fault("no thickness in 3d, where light crosses the bodies as thick as they are"))
            }
            (Some(coefficient), None, thickness) => {
                let material_fringe = wavelength / coefficient.positive(context)?;
                match thickness {
                    Some(thickness) => {
                        Ok(Sensitivity::StressPerFringe(material_fringe / thickness.positive(context)?))
                    }
                    None if space => Ok(Sensitivity::StressThicknessPerFringe(material_fringe)),
                    None => Err(coefficient.node().fault("in a plane scene together with a thickness")),
                }
            }
            (None, None, _) => Err(self.interval.node().fault(
                "fringes with stress_optic_coefficient and thickness, or with stress_parameter, such as \"20 MPa\"",
            )),
        }
    }

    fn names(&self, bodies: &[Body], context: &Context) -> Result<Vec<String>, Fault> {
        let known: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
        match &self.bodies {
            Some(names) if names.is_empty() => {
                Err(self.interval.node().fault("fringes with one body or more in bodies"))
            }
            Some(names) => names_in(names, ("the name of a body", &known), context),
            None => {
                let free = bodies.iter().filter(|body| !body.is_rigid());
                Ok(free.map(|body| body.name.clone()).collect())
            }
        }
    }
}

impl View {
    fn resolve(&self, context: &Context) -> Result<[[f64; 2]; 2], Fault> {
        let (min, max) = (self.min.pair(context)?, self.max.pair(context)?);
        match (0..2).find(|axis| min[*axis] >= max[*axis]) {
            None => Ok([min, max]),
            Some(axis) => {
                let allowed = format!("more than {} m, the {} of min", min[axis], ["x", "y"][axis]);
                Err(self.max.part(axis).refused(max[axis], allowed))
            }
        }
    }
}

fn at_least_zero(time: Option<&QuantityInput<Duration>>, context: &Context) -> Result<f64, Fault> {
    let allowed = "a time [s] of 0 or more, like \"2.5 ms\"";
    time.map_or(Ok(0.0), |time| time.checked(context, allowed, |value| value >= 0.0))
}
