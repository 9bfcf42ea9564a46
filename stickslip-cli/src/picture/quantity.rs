//! What the colour of a particle can stand for.

use crate::drawing::Scale;
use clap::builder::{EnumValueParser, PossibleValue, TypedValueParser};
use clap::{Arg, Command, ValueEnum};
use std::ffi::OsStr;
use stickslip::column::DERIVED;
use stickslip::door::ParticleSnapshot;

/// What the colour of a particle stands for.
#[derive(Clone, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum ColorQuantity {
    /// The body it belongs to; round bodies get quarters, so that turning shows
    Body,
    /// Speed
    #[value(alias = "speed")]
    Velocity,
    /// Velocity along x
    Vx,
    /// Velocity along y
    Vy,
    /// Velocity along z
    Vz,
    /// Pressure, positive in compression
    Pressure,
    /// Equivalent stress of von Mises
    VonMises,
    /// Normal stress along x, tension positive
    Xx,
    /// Normal stress along y, tension positive
    Yy,
    /// Normal stress along z, tension positive
    Zz,
    /// Shear stress in the plane of x and y
    Xy,
    /// Shear stress in the plane of y and z
    Yz,
    /// Shear stress in the plane of x and z
    Xz,
    /// Mass over volume now, which tells materials apart
    Density,
    /// Volume over undeformed volume
    Jacobian,
    /// What a material's law remembers, by the name of its column: a number itself,
    /// of a tensor the root of the sum of its squared entries
    #[value(skip)]
    History(String),
}

/// Reads a [`ColorQuantity`]: a word that stands for one, or else the name of a law's history.
#[derive(Clone, Debug)]
pub struct QuantityParser;

impl TypedValueParser for QuantityParser {
    type Value = ColorQuantity;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<ColorQuantity, clap::Error> {
        let known = EnumValueParser::<ColorQuantity>::new().parse_ref(command, argument, value);
        match value.to_str() {
            Some(name) if known.is_err() && is_name(name) => Ok(ColorQuantity::History(name.to_owned())),
            _ => known,
        }
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let history = PossibleValue::new("NAME").help(
            "A column that a material's law remembers: a number itself, of a tensor the root of the sum of its squared entries",
        );
        let words = ColorQuantity::value_variants().iter().filter_map(ValueEnum::to_possible_value);
        Some(Box::new(words.chain([history])))
    }
}

/// Whether a column could be called so.
fn is_name(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}

/// Numbers that a value is made of: a velocity, a stress xx, yy, zz, xy, yz, xz, or the value first, and zeros.
pub type Parts = [f64; 6];

/// Where the colours of a quantity come from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ColorSource {
    /// From zero up.
    Magnitude,
    /// Both sides of a special value.
    Around(f64),
}

impl ColorQuantity {
    /// What the value at a particle is made of, which can be averaged over neighbours: a velocity, a stress, or the
    /// value itself.
    pub fn parts(&self, particles: &ParticleSnapshot, i: usize) -> Parts {
        match self {
            ColorQuantity::Body => [0.0; 6],
            ColorQuantity::Velocity | ColorQuantity::Vx | ColorQuantity::Vy | ColorQuantity::Vz => {
                let [x, y, z] = particles.velocity[i];
                [x, y, z, 0.0, 0.0, 0.0]
            }
            ColorQuantity::Density => [particles.mass[i] / particles.volume[i], 0.0, 0.0, 0.0, 0.0, 0.0],
            ColorQuantity::Jacobian => [determinant(&particles.deformation[i]), 0.0, 0.0, 0.0, 0.0, 0.0],
            ColorQuantity::History(name) => {
                let value = particles.remembered(name).map_or(0.0, |column| column.magnitude(i));
                [value, 0.0, 0.0, 0.0, 0.0, 0.0]
            }
            _ => particles.stress[i],
        }
    }

    /// The value in SI units that is made of some parts.
    pub fn value_of(&self, parts: Parts) -> f64 {
        match self {
            ColorQuantity::Velocity => parts[..3].iter().map(|v| v * v).sum::<f64>().sqrt(),
            ColorQuantity::Pressure => derived("pressure", &parts),
            ColorQuantity::VonMises => derived("von_mises", &parts),
            ColorQuantity::Body
            | ColorQuantity::Vx
            | ColorQuantity::Xx
            | ColorQuantity::Density
            | ColorQuantity::Jacobian
            | ColorQuantity::History(_) => parts[0],
            ColorQuantity::Vy | ColorQuantity::Yy => parts[1],
            ColorQuantity::Vz | ColorQuantity::Zz => parts[2],
            ColorQuantity::Xy => parts[3],
            ColorQuantity::Yz => parts[4],
            ColorQuantity::Xz => parts[5],
        }
    }

    /// Whether it comes of the stress, which differs between neighbouring particles by more than it means.
    pub fn is_stress(&self) -> bool {
        use ColorQuantity::{Pressure, VonMises, Xx, Xy, Xz, Yy, Yz, Zz};
        matches!(self, Pressure | VonMises | Xx | Yy | Zz | Xy | Yz | Xz)
    }

    /// Words and unit for the colour bar; no unit for a ratio.
    pub fn label(&self, particles: &ParticleSnapshot) -> (String, String) {
        let (words, unit) = match self {
            ColorQuantity::Body => ("body", ""),
            ColorQuantity::Velocity => ("speed", "m/s"),
            ColorQuantity::Vx => ("velocity x", "m/s"),
            ColorQuantity::Vy => ("velocity y", "m/s"),
            ColorQuantity::Vz => ("velocity z", "m/s"),
            ColorQuantity::Pressure => ("pressure", "Pa"),
            ColorQuantity::VonMises => ("von Mises stress", "Pa"),
            ColorQuantity::Xx => ("stress xx", "Pa"),
            ColorQuantity::Yy => ("stress yy", "Pa"),
            ColorQuantity::Zz => ("stress zz", "Pa"),
            ColorQuantity::Xy => ("stress xy", "Pa"),
            ColorQuantity::Yz => ("stress yz", "Pa"),
            ColorQuantity::Xz => ("stress xz", "Pa"),
            ColorQuantity::Density => ("density", "kg/m³"),
            ColorQuantity::Jacobian => ("volume ratio J", ""),
            ColorQuantity::History(name) => {
                let unit = particles.remembered(name).map_or("", |column| &column.unit);
                return (name.replace('_', " "), unit.to_owned());
            }
        };
        (words.to_owned(), unit.to_owned())
    }

    /// Whether a snapshot has it; if not, what there is instead.
    pub fn is_in(&self, particles: &ParticleSnapshot) -> Result<(), String> {
        let ColorQuantity::History(name) = self else { return Ok(()) };
        if particles.remembered(name).is_some() {
            return Ok(());
        }
        let words = ColorQuantity::value_variants().iter().filter_map(ValueEnum::to_possible_value);
        let words: Vec<String> = words.map(|word| word.get_name().to_owned()).collect();
        let history = particles.history.iter().map(|column| column.name.clone());
        let all: Vec<String> = words.into_iter().chain(history).collect();
        Err(format!("found `{name}`, a quantity that the results do not have; allowed: {}", all.join(", ")))
    }

    /// Colours that suit these values. The outermost thousandth of the values at either end do not stretch the scale.
    pub fn scale(&self, values: &[f64]) -> Scale {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| {
            sorted.get((share * sorted.len().saturating_sub(1) as f64) as usize).copied().unwrap_or(0.0)
        };
        let (low, high) = (at(0.001), at(0.999));
        match self.kind(low) {
            ColorSource::Magnitude => {
                Scale { range: [0.0, if high > 0.0 { high } else { 1.0 }], diverging: false, map: None }
            }
            ColorSource::Around(middle) => {
                let half = (high - middle).abs().max((low - middle).abs());
                let half = if half > 0.0 { half } else { 1.0 };
                Scale { range: [middle - half, middle + half], diverging: true, map: None }
            }
        }
    }

    /// Colours between two ends that the user chose.
    pub fn scale_between(&self, range: [f64; 2]) -> Scale {
        Scale { range, diverging: self.kind(range[0]) != ColorSource::Magnitude, map: None }
    }

    /// Where the colours come from if values go down to this.
    fn kind(&self, low: f64) -> ColorSource {
        match self {
            ColorQuantity::Body
            | ColorQuantity::Velocity
            | ColorQuantity::VonMises
            | ColorQuantity::Density => ColorSource::Magnitude,
            ColorQuantity::History(_) if low >= 0.0 => ColorSource::Magnitude,
            ColorQuantity::Jacobian => ColorSource::Around(1.0),
            _ => ColorSource::Around(0.0),
        }
    }
}

/// A number that follows from the stress, as files have it.
fn derived(name: &str, stress: &[f64; 6]) -> f64 {
    let number = DERIVED.iter().find(|derived| derived.column.name == name);
    number.map_or(0.0, |derived| (derived.value)(stress))
}

/// Determinant of a matrix given row by row.
pub fn determinant(f: &[f64; 9]) -> f64 {
    f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6])
        + f[2] * (f[3] * f[7] - f[4] * f[6])
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip::column::Kind as Components;
    use stickslip::door::SnapshotColumn;

    #[test]
    fn von_mises_of_uniaxial_stress_is_the_stress() {
        assert!((derived("von_mises", &[-4.0, 0.0, 0.0, 0.0, 0.0, 0.0]) - 4.0).abs() < 1e-12);
    }

    #[test]
    fn history_is_shown_by_its_name_and_a_tensor_by_its_norm() {
        let column =
            |name: &str, kind, values| SnapshotColumn { name: name.into(), unit: "Pa".into(), kind, values };
        let history = vec![
            column("heat", Components::Number, vec![3.0, -1.0]),
            column(
                "back_stress",
                Components::Symmetric,
                [[3.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 2.0, 0.0]].concat(),
            ),
        ];
        let particles = ParticleSnapshot {
            velocity: vec![[0.0; 3]; 2],
            stress: vec![[0.0; 6]; 2],
            history,
            ..Default::default()
        };
        let [heat, back_stress, none] =
            ["heat", "back_stress", "none"].map(|name| ColorQuantity::History(name.into()));
        let value = |quantity: &ColorQuantity, i: usize| quantity.value_of(quantity.parts(&particles, i));
        assert_eq!([value(&heat, 1), value(&back_stress, 0)], [-1.0, 3.0]);
        assert!((value(&back_stress, 1) - 8.0_f64.sqrt()).abs() < 1e-15);
        assert_eq!(back_stress.label(&particles), ("back stress".into(), "Pa".into()));
        assert!(heat.is_in(&particles).is_ok());
        let error = none.is_in(&particles).unwrap_err();
        assert!(error.contains("`none`") && error.ends_with("jacobian, heat, back_stress"), "{error}");
    }

    #[test]
    fn a_signed_scale_is_symmetric() {
        let scale = ColorQuantity::Pressure.scale(&[-1.0, 0.5, 4.0, 4.0]);
        assert_eq!(scale.range, [-4.0, 4.0]);
    }

    #[test]
    fn a_scale_of_nothing_is_still_a_scale() {
        let [low, high] = ColorQuantity::Velocity.scale(&[]).range;
        assert!(low < high);
    }
}
