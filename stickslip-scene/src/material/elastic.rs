//! Isotropic linear elasticity: any two of its constants give the others.

use super::{BadConstants, Constant, PRESSURE};
use serde::Serialize;
use std::collections::BTreeMap;

/// The constants that isotropic laws accept, two of them at a time.
pub(super) const CONSTANTS: [Constant; 5] = [
    Constant { name: "bulk_modulus", summary: "Bulk modulus K.", dimension: PRESSURE },
    Constant { name: "shear_modulus", summary: "Shear modulus G.", dimension: PRESSURE },
    Constant { name: "young_modulus", summary: "Young's modulus E.", dimension: PRESSURE },
    Constant {
        name: "poisson_ratio",
        summary: "Poisson's ratio nu, above -1 and below 0.5.",
        dimension: [0, 0, 0],
    },
    Constant {
        name: "p_wave_modulus",
        summary: "Modulus of a longitudinal wave M = K + 4G/3.",
        dimension: PRESSURE,
    },
];

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
    pub fn from_constants(values: &BTreeMap<String, f64>) -> Result<Self, BadConstants> {
        let get = |name: &str| values.get(name).copied();
        let names: Vec<&str> = values.keys().map(String::as_str).collect();
        let bad = |key: Option<&str>, found: String, allowed: &str| {
            Err(BadConstants { key: key.map(str::to_string), found, allowed: allowed.to_string() })
        };
        for (name, &value) in values {
            if name != "poisson_ratio"
                && !(value.is_finite() && (value > 0.0 || name == "shear_modulus" && value == 0.0))
            {
                return bad(Some(name), format!("{value} Pa"), "a positive number");
            }
        }
        if let Some(nu) = get("poisson_ratio")
            && !(nu > -1.0 && nu < 0.5)
        {
            return bad(
                Some("poisson_ratio"),
                format!("{nu}"),
                "above -1 and below 0.5, else the material is not stable",
            );
        }
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
                return bad(
                    None,
                    found,
                    "two of bulk_modulus, shear_modulus, young_modulus, poisson_ratio, p_wave_modulus (not E with M)",
                );
            }
        };
        if !(k > 0.0 && k.is_finite() && g >= 0.0 && g.is_finite()) {
            let found = format!("{} give K = {k:.6e} Pa, G = {g:.6e} Pa", names.join(" and "));
            return bad(None, found, "K above 0 and G at least 0, else the material is not stable");
        }
        Ok(Isotropic { bulk_modulus: k, shear_modulus: g })
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
                let values = [*a, *b].map(|(name, value)| (name.to_string(), value)).into();
                match Isotropic::from_constants(&values) {
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
            let values = [a, b].map(|(name, value)| (name.to_string(), value)).into();
            assert!(Isotropic::from_constants(&values).is_err(), "{a:?} {b:?}");
        }
    }
}
