//! The flags of `stickslip render --fringes`.

use super::render::positive;
use crate::failure::Failure;
use crate::frame_pictures::{FringeChoice, material_sensitivity};
use clap::Args;
use std::f64::consts::PI;
use stickslip::scene::{Light, Overlay, Polariscope, PolariscopeField, Sensitivity};

/// What the user wants of fringes.
#[derive(Debug, Args)]
#[command(next_help_heading = "Photoelastic fringes (without a flag: as in the scene's outputs.fringes)")]
pub struct FringeArguments {
    /// Photoelastic fringes, as a polariscope shows them along the third axis.
    #[arg(long, conflicts_with_all = ["color", "colors", "range", "view", "mirror"])]
    pub fringes: bool,

    /// The paper's s [Pa]: a circular polariscope shows cos((sigma_1 - sigma_2) / s).
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = positive, requires = "fringes")]
    stress_parameter: Option<f64>,

    /// Stress-optic coefficient of the bodies [1/Pa], such as 4e-12; in a plane scene with --thickness.
    #[arg(long, value_name = "C", allow_negative_numbers = true, value_parser = positive, requires = "fringes", conflicts_with = "stress_parameter")]
    stress_optic_coefficient: Option<f64>,

    /// Thickness of the bodies of a plane scene [m].
    #[arg(long, value_name = "T", value_parser = positive, requires = "stress_optic_coefficient")]
    thickness: Option<f64>,

    /// Wavelength of the light [m], 380e-9 to 780e-9; 546.1e-9 without this.
    #[arg(long, value_parser = wavelength, requires = "fringes")]
    wavelength: Option<f64>,

    /// Crossed or parallel polarisers: unloaded bodies are dark or light.
    #[arg(long, value_parser = ["dark", "light"], requires = "fringes")]
    field: Option<String>,

    /// One wavelength without or with its colour, or all visible ones.
    #[arg(long, value_parser = ["grey", "monochrome", "white"], requires = "fringes")]
    light: Option<String>,

    /// A plane polariscope, with isoclinics, its polariser at this angle from x [degrees].
    #[arg(long, value_name = "ANGLE", allow_negative_numbers = true, requires = "fringes")]
    polarizer: Option<f64>,

    /// Average the snapshots in this time from each one's own on [s].
    #[arg(long, value_name = "TIME", value_parser = positive, requires = "fringes")]
    exposure: Option<f64>,

    /// Names of the birefringent bodies, with commas; the others are opaque.
    #[arg(long, value_delimiter = ',', requires = "fringes")]
    bodies: Option<Vec<String>>,

    /// Draw lines between bodies that press on each other, wider for larger forces.
    #[arg(long, requires = "fringes")]
    force_chains: bool,
}

fn wavelength(text: &str) -> Result<f64, String> {
    let visible = |value: &f64| (380e-9..=780e-9).contains(value);
    text.parse().ok().filter(visible).ok_or_else(|| "allowed: 380e-9 to 780e-9".to_owned())
}

#[test]
fn a_wavelength_is_visible() {
    assert_eq!(wavelength("589e-9").unwrap(), 589e-9);
    assert!(wavelength("589").is_err() && wavelength("NaN").is_err() && wavelength("green").is_err());
}

impl FringeArguments {
    /// The choice that the flags make for a scene of so many dimensions and a picture of some size.
    pub fn choice(&self, dimension: usize, size: Option<[usize; 2]>) -> Result<FringeChoice, Failure> {
        let wavelength = self.wavelength.unwrap_or(Polariscope::MERCURY_GREEN);
        let material = self
            .stress_optic_coefficient
            .map(|coefficient| material_sensitivity([coefficient, wavelength], self.thickness, dimension));
        let parameter = self.stress_parameter.map(|s| Sensitivity::StressPerFringe(2.0 * PI * s));
        Ok(FringeChoice {
            sensitivity: material.transpose()?.or(parameter),
            wavelength: self.wavelength,
            field: self
                .field
                .as_deref()
                .map(|field| if field == "dark" { PolariscopeField::Dark } else { PolariscopeField::Light }),
            light: self.light.as_deref().map(|light| match light {
                "monochrome" => Light::Monochrome,
                "white" => Light::White,
                _ => Light::Grey,
            }),
            polarizer: self.polarizer.map(f64::to_radians),
            exposure: self.exposure,
            bodies: self.bodies.clone(),
            overlay: self.force_chains.then_some(Overlay::ForceChains),
            size,
        })
    }
}
