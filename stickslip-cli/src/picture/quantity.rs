//! What the colour of a particle can stand for.

use super::Rgb;
use crate::drawing::Scale;
use clap::ValueEnum;
use stickslip::door::ParticleSnapshot;

/// What the colour of a particle stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum Quantity {
    /// The body it belongs to; round bodies get quarters, so that turning shows
    Body,
    /// Speed
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
    /// Volume over undeformed volume
    Jacobian,
    /// Equivalent plastic strain
    PlasticStrain,
}

/// Where the colours of a quantity come from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// From zero up.
    Magnitude,
    /// Both sides of a special value.
    Around(f64),
}

impl Quantity {
    /// The value at a particle in SI units; 0 for [`Quantity::Body`], which has no value.
    pub fn value(self, particles: &ParticleSnapshot, i: usize) -> f64 {
        let v = &particles.velocity[i];
        let s = &particles.stress[i];
        match self {
            Quantity::Body => 0.0,
            Quantity::Velocity => v.iter().map(|c| c * c).sum::<f64>().sqrt(),
            Quantity::Vx => v[0],
            Quantity::Vy => v[1],
            Quantity::Vz => v[2],
            Quantity::Pressure => -(s[0] + s[1] + s[2]) / 3.0,
            Quantity::VonMises => von_mises(s),
            Quantity::Xx => s[0],
            Quantity::Yy => s[1],
            Quantity::Zz => s[2],
            Quantity::Xy => s[3],
            Quantity::Yz => s[4],
            Quantity::Xz => s[5],
            Quantity::Jacobian => determinant(&particles.deformation[i]),
            // Where nothing flows there is none.
            Quantity::PlasticStrain => particles.plastic_strain.get(i).copied().unwrap_or(0.0),
        }
    }

    /// Words and unit for the colour bar; no unit for a ratio.
    pub fn label(self) -> (&'static str, &'static str) {
        match self {
            Quantity::Body => ("body", ""),
            Quantity::Velocity => ("speed", "m/s"),
            Quantity::Vx => ("velocity x", "m/s"),
            Quantity::Vy => ("velocity y", "m/s"),
            Quantity::Vz => ("velocity z", "m/s"),
            Quantity::Pressure => ("pressure", "Pa"),
            Quantity::VonMises => ("von Mises stress", "Pa"),
            Quantity::Xx => ("stress xx", "Pa"),
            Quantity::Yy => ("stress yy", "Pa"),
            Quantity::Zz => ("stress zz", "Pa"),
            Quantity::Xy => ("stress xy", "Pa"),
            Quantity::Yz => ("stress yz", "Pa"),
            Quantity::Xz => ("stress xz", "Pa"),
            Quantity::Jacobian => ("volume ratio J", ""),
            Quantity::PlasticStrain => ("plastic strain", ""),
        }
    }

    /// Colours that suit these values. The outermost thousandth of the values at either end do not stretch the scale.
    pub fn scale(self, values: &[f64]) -> Scale {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| {
            sorted.get((share * sorted.len().saturating_sub(1) as f64) as usize).copied().unwrap_or(0.0)
        };
        let (low, high) = (at(0.001), at(0.999));
        match self.kind() {
            Kind::Magnitude => Scale { range: [0.0, if high > 0.0 { high } else { 1.0 }], diverging: false },
            Kind::Around(middle) => {
                let half = (high - middle).abs().max((low - middle).abs());
                let half = if half > 0.0 { half } else { 1.0 };
                Scale { range: [middle - half, middle + half], diverging: true }
            }
        }
    }

    /// Colours between two ends that the user chose.
    pub fn scale_between(self, range: [f64; 2]) -> Scale {
        Scale { range, diverging: self.kind() != Kind::Magnitude }
    }

    fn kind(self) -> Kind {
        match self {
            Quantity::Body | Quantity::Velocity | Quantity::VonMises | Quantity::PlasticStrain => {
                Kind::Magnitude
            }
            Quantity::Jacobian => Kind::Around(1.0),
            _ => Kind::Around(0.0),
        }
    }
}

/// sqrt(3/2 s : s) with s the deviator of the Cauchy stress [Pa].
fn von_mises(s: &[f64; 6]) -> f64 {
    let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
    let shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    (0.5 * normal + 3.0 * shear).sqrt()
}

/// Determinant of a matrix given row by row.
pub fn determinant(f: &[f64; 9]) -> f64 {
    f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6])
        + f[2] * (f[3] * f[7] - f[4] * f[6])
}

/// The colour of every particle for a quantity with values.
pub fn colors(quantity: Quantity, scale: &Scale, particles: &ParticleSnapshot) -> Vec<Rgb> {
    (0..particles.body.len()).map(|i| scale.color(quantity.value(particles, i))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn von_mises_of_uniaxial_stress_is_the_stress() {
        assert!((von_mises(&[-4.0, 0.0, 0.0, 0.0, 0.0, 0.0]) - 4.0).abs() < 1e-12);
    }

    #[test]
    fn a_signed_scale_is_symmetric() {
        let scale = Quantity::Pressure.scale(&[-1.0, 0.5, 4.0, 4.0]);
        assert_eq!(scale.range, [-4.0, 4.0]);
    }

    #[test]
    fn a_scale_of_nothing_is_still_a_scale() {
        let [low, high] = Quantity::Velocity.scale(&[]).range;
        assert!(low < high);
    }
}
