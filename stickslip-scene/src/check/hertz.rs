//! How wide elastic bodies touch (Hertz 1882; Johnson 1985, Contact Mechanics, chapters 4, 5 and 11).
//!
//! ```text
//! 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2,   in plane stress 1/E1 + 1/E2;   1/R* = 1/R1 + 1/R2
//! space:  a = (3 F R* / (4 E*))^(1/3),      d = a^2 / R*
//! plane:  b = sqrt(4 P' R* / (pi E*)),      d = P' / (pi E*) (2 ln(4 R* / b) - 1)
//! ```

use crate::material::Isotropic;
use crate::scene::Dimension;
use serde::Serialize;
use std::f64::consts::PI;

/// Two round or flat elastic surfaces that touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    /// Effective modulus E* [Pa].
    pub modulus: f64,
    /// Effective radius R* [m].
    pub radius: f64,
    /// 2 or 3.
    pub dimension: usize,
}

/// Where two bodies touch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct HertzPatch {
    /// Radius of the circle, in the plane half-width of the strip, in which they touch [m].
    pub radius: f64,
    /// By how much the bodies' centres come closer [m].
    pub depth: f64,
}

impl Hertz {
    /// E* of two materials; `None` is a rigid one. Infinite for two rigid ones.
    pub fn effective_modulus(materials: [Option<Isotropic<f64>>; 2], dimension: Dimension) -> f64 {
        let compliance = |elastic: Isotropic<f64>| match dimension {
            Dimension::PlaneStress => 1.0 / elastic.young_modulus(),
            _ => (1.0 - elastic.poisson_ratio().powi(2)) / elastic.young_modulus(),
        };
        1.0 / materials.into_iter().flatten().map(compliance).fold(0.0, |sum, c| sum + c)
    }

    /// At rest under a load [N], in the plane per metre of depth [N/m].
    pub fn under_load(&self, load: f64) -> HertzPatch {
        if load <= 0.0 {
            return HertzPatch::default();
        }
        if self.dimension == 2 {
            let half_width = (4.0 * load * self.radius / (PI * self.modulus)).sqrt();
            let depth = load / (PI * self.modulus) * (2.0 * (4.0 * self.radius / half_width).ln() - 1.0);
            return HertzPatch { radius: half_width, depth };
        }
        let radius = libm::cbrt(0.75 * load * self.radius / self.modulus);
        HertzPatch { radius, depth: radius * radius / self.radius }
    }

    /// At the largest compression after an approach at `speed` [m/s]; `mass` = m1 m2 / (m1 + m2) [kg],
    /// in the plane [kg/m].
    ///
    /// ```text
    /// space:  d = (15 m v^2 / (16 E* sqrt(R*)))^(2/5)
    /// plane:  m v^2 / 2 = integral of P' dd = P'^2 / (pi E*) (ln(4 R* / b) - 3/4)
    /// ```
    /// Quasi-static: waves within the bodies are ignored. In the plane an estimate, as compression there depends on the
    /// bodies' size, taken as R*.
    pub fn at_impact(&self, mass: f64, speed: f64) -> HertzPatch {
        if mass <= 0.0 || speed <= 0.0 {
            return HertzPatch::default();
        }
        if self.dimension == 2 {
            return self.under_load(self.impact_load_in_plane(0.5 * mass * speed * speed));
        }
        let energy = 15.0 * mass * speed * speed / (16.0 * self.modulus * self.radius.sqrt());
        let depth = energy.powf(0.4);
        HertzPatch { radius: (self.radius * depth).sqrt(), depth }
    }

    /// The load at which the contact holds an energy [J/m]; the energy grows with it while b < R*.
    fn impact_load_in_plane(&self, energy: f64) -> f64 {
        let held = |load: f64| {
            let half_width = self.under_load(load).radius;
            load * load / (PI * self.modulus) * ((4.0 * self.radius / half_width).ln() - 0.75)
        };
        // b = R* at the upper end: theory ends there.
        let (mut low, mut high) = (0.0, 0.25 * PI * self.modulus * self.radius);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if held(middle) < energy { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn isotropic(young: f64, nu: f64) -> Isotropic<f64> {
        Isotropic {
            bulk_modulus: young / (3.0 * (1.0 - 2.0 * nu)),
            shear_modulus: young / (2.0 * (1.0 + nu)),
        }
    }

    /// NAFEMS contact benchmark: a steel roller of 50 mm on aluminium, 35 kN/mm: b = 6.2146 mm.
    #[test]
    fn the_nafems_roller_has_its_half_width() {
        let materials = [Some(isotropic(210e9, 0.3)), Some(isotropic(70e9, 0.3))];
        let roller = Hertz {
            modulus: Hertz::effective_modulus(materials, Dimension::PlaneStrain),
            radius: 0.05,
            dimension: 2,
        };
        let half_width = roller.under_load(35e6).radius;
        assert!((half_width - 6.2146e-3).abs() < 1e-7, "{half_width}");
    }

    #[test]
    fn an_impact_turns_the_kinetic_energy_into_compression() {
        for dimension in [2, 3] {
            let hertz = Hertz { modulus: 1e7, radius: 0.3, dimension };
            let (mass, speed) = (40.0, 1.5);
            let end = hertz.at_impact(mass, speed);
            // Work of the static load over the depth, by the trapezoidal rule in the load.
            let load_end = match dimension {
                2 => 0.25 * PI * hertz.modulus * end.radius.powi(2) / hertz.radius,
                _ => 4.0 / 3.0 * hertz.modulus * end.radius.powi(3) / hertz.radius,
            };
            let (mut work, mut before, n) = (0.0, 0.0, 20_000);
            for i in 0..n {
                let [low, high] = [i, i + 1].map(|i| load_end * f64::from(i) / f64::from(n));
                let depth = hertz.under_load(high).depth;
                work += 0.5 * (low + high) * (depth - before);
                before = depth;
            }
            let kinetic = 0.5 * mass * speed * speed;
            assert!((work / kinetic - 1.0).abs() < 1e-4, "{dimension}: {work} of {kinetic}");
        }
    }

    #[test]
    fn a_rigid_partner_doubles_the_modulus_of_equals() {
        let soft = isotropic(1e6, 0.25);
        let modulus = |materials| Hertz::effective_modulus(materials, Dimension::Space);
        let both = modulus([Some(soft), Some(soft)]);
        assert!((modulus([Some(soft), None]) / both - 2.0).abs() < 1e-14);
        assert_eq!(modulus([None, None]), f64::INFINITY);
    }
}
