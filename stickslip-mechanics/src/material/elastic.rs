//! Isotropic linear elasticity: any two of its constants give the others.

use super::declaration::{
    Absent, AllowedRange, BadConstants, Constant, ConstantUnit, Form, Given, NOT_NEGATIVE, POSITIVE,
    PRESSURE, Quantity, RATIO,
};
use serde::Serialize;

/// The constants that isotropic laws accept, two of them at a time.
pub(super) const CONSTANTS: [Constant; 5] = [
    modulus("bulk_modulus", "Bulk modulus K.", (PRESSURE, POSITIVE)),
    modulus("shear_modulus", "Shear modulus G.", (PRESSURE, NOT_NEGATIVE)),
    modulus("young_modulus", "Young's modulus E.", (PRESSURE, POSITIVE)),
    modulus("poisson_ratio", "Poisson's ratio nu, above -1 and below 0.5.", (RATIO, STABLE)),
    modulus("p_wave_modulus", "Modulus of a longitudinal wave M = K + 4G/3.", (PRESSURE, POSITIVE)),
];

const STABLE: AllowedRange = AllowedRange::between(-1.0, 0.5).because(", else the material is not stable");

const fn modulus(
    name: &'static str,
    summary: &'static str,
    (unit, bounds): (ConstantUnit, AllowedRange),
) -> Constant {
    Constant { name, summary, form: Form::Number(Quantity { name, unit, bounds }), absent: Absent::Judged }
}

/// The elastic constants and further ones of a law.
pub(super) const fn and<const MORE: usize, const ALL: usize>(more: [Constant; MORE]) -> [Constant; ALL] {
    let mut all = [CONSTANTS[0]; ALL];
    let mut i = 0;
    while i < ALL {
        all[i] = if i < CONSTANTS.len() { CONSTANTS[i] } else { more[i - CONSTANTS.len()] };
        i += 1;
    }
    all
}

/// Isotropic elastic moduli.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Isotropic<T> {
    /// Bulk modulus K [Pa].
    pub bulk_modulus: T,
    /// Shear modulus G [Pa].
    pub shear_modulus: T,
}

impl<T: Copy> Isotropic<T> {
    /// The same moduli in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> Isotropic<U> {
        Isotropic { bulk_modulus: f(self.bulk_modulus), shear_modulus: f(self.shear_modulus) }
    }
}

impl Isotropic<f64> {
    /// From any two of K, G, E, nu, M, in SI units.
    ///
    /// # Errors
    /// Fewer or more than two constants, and values with K <= 0 or G < 0 (not stable).
    pub fn build(given: &Given) -> Result<Self, BadConstants> {
        let get = |name: &str| given.get(name);
        let mut names: Vec<&str> =
            CONSTANTS.iter().map(|constant| constant.name).filter(|name| get(name).is_some()).collect();
        names.sort_unstable();
        let (k, g) = match (
            get("bulk_modulus"),
            get("shear_modulus"),
            get("young_modulus"),
            get("poisson_ratio"),
            get("p_wave_modulus"),
        ) {
            (Some(k), Some(g), None, None, None) => (k, g),
            (Some(k), None, Some(e), None, None) => (k, 3.0 * k * e / (9.0 * k - e)),
            (Some(k), None, None, Some(nu), None) => (k, 1.5 * k * (1.0 - 2.0 * nu) / (1.0 + nu)),
            (Some(k), None, None, None, Some(m)) => (k, 0.75 * (m - k)),
            (None, Some(g), Some(e), None, None) => (e * g / (3.0 * (3.0 * g - e)), g),
            (None, Some(g), None, Some(nu), None) => (2.0 * g * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu)), g),
            (None, Some(g), None, None, Some(m)) => (m - 4.0 / 3.0 * g, g),
            (None, None, Some(e), Some(nu), None) => (e / (3.0 * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu))),
            (None, None, None, Some(nu), Some(m)) => {
                (m * (1.0 + nu) / (3.0 * (1.0 - nu)), m * (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu)))
            }
            _ => {
                let found =
                    if names.is_empty() { "no elastic constant".to_string() } else { names.join(", ") };
                let all = CONSTANTS.map(|constant| constant.name).join(", ");
                return Err(BadConstants::together(found, format!("two of {all} (not E with M)")));
            }
        };
        if !(k > 0.0 && k.is_finite() && g >= 0.0 && g.is_finite()) {
            let found = format!("{} give K = {k:.6e} Pa, G = {g:.6e} Pa", names.join(" and "));
            let allowed = "K above 0 and G at least 0, else the material is not stable";
            return Err(BadConstants::together(found, allowed));
        }
        Ok(Isotropic { bulk_modulus: k, shear_modulus: g })
    }

    /// The moduli by the names under which [`Isotropic::build`] takes them.
    pub fn given(&self) -> Given {
        [("bulk_modulus", self.bulk_modulus), ("shear_modulus", self.shear_modulus)].into()
    }

    /// M = K + 4G/3 [Pa]
    pub fn p_wave_modulus(&self) -> f64 {
        self.bulk_modulus + 4.0 / 3.0 * self.shear_modulus
    }

    /// E = 9KG/(3K + G) [Pa]
    pub fn young_modulus(&self) -> f64 {
        let (k, g) = (self.bulk_modulus, self.shear_modulus);
        9.0 * k * g / (3.0 * k + g)
    }

    /// nu = (3K - 2G)/(2(3K + G)) [-]
    pub fn poisson_ratio(&self) -> f64 {
        let (k, g) = (self.bulk_modulus, self.shear_modulus);
        (3.0 * k - 2.0 * g) / (2.0 * (3.0 * k + g))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_of_constants_gives_the_same_material() {
        let exact = Isotropic { bulk_modulus: 6e6, shear_modulus: 3e6 };
        let all = [
            ("bulk_modulus", exact.bulk_modulus),
            ("shear_modulus", exact.shear_modulus),
            ("young_modulus", exact.young_modulus()),
            ("poisson_ratio", exact.poisson_ratio()),
            ("p_wave_modulus", exact.p_wave_modulus()),
        ];
        for (i, a) in all.iter().enumerate() {
            for b in &all[i + 1..] {
                match Isotropic::build(&[*a, *b].into()) {
                    Ok(found) => {
                        assert!((found.bulk_modulus / 6e6 - 1.0).abs() < 1e-12, "{} {}", a.0, b.0);
                        assert!((found.shear_modulus / 3e6 - 1.0).abs() < 1e-12, "{} {}", a.0, b.0);
                    }
                    Err(_) => assert_eq!((a.0, b.0), ("young_modulus", "p_wave_modulus")),
                }
            }
        }
    }

    #[test]
    fn unstable_constants_are_refused() {
        for (a, b) in [
            (("bulk_modulus", -1.0), ("shear_modulus", 1.0)),
            (("young_modulus", 1.0), ("poisson_ratio", 0.5)),
            (("bulk_modulus", 1.0), ("young_modulus", 10.0)),
            (("shear_modulus", 1.0), ("p_wave_modulus", 1.0)),
        ] {
            assert!(Isotropic::build(&[a, b].into()).is_err(), "{a:?} {b:?}");
        }
    }
}
