//! Units that scene files know, and physical dimensions as powers of kilogram, metre and second.
//!
//! Angles have no dimension: `deg` is a number, `rad` is 1.

use std::f64::consts::PI;

/// Powers of kilogram, metre and second; roots make them fractions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Powers([f64; 3]);

/// A unit: `scale 10^decade` in SI units. The decade stands apart so that `0.3 mm` is the number nearest to 0.0003.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unit {
    scale: f64,
    decade: i32,
    pub powers: Powers,
}

impl PartialEq for Powers {
    /// Equal but for round-off in fractional powers.
    fn eq(&self, other: &Self) -> bool {
        self.0.iter().zip(other.0).all(|(a, b)| (a - b).abs() < 1e-9)
    }
}

impl From<[i8; 3]> for Powers {
    fn from(powers: [i8; 3]) -> Self {
        Powers(powers.map(f64::from))
    }
}

impl Powers {
    pub const NONE: Powers = Powers([0.0; 3]);
    pub const LENGTH: Powers = Powers([0.0, 1.0, 0.0]);
    pub const TIME: Powers = Powers([0.0, 0.0, 1.0]);

    /// Powers of a product with the other factor raised to `exponent`.
    pub fn times(self, other: Powers, exponent: f64) -> Powers {
        Powers(std::array::from_fn(|i| self.0[i] + exponent * other.0[i]))
    }

    /// `kg/m^3`, `1/s`, `1`
    pub fn symbol(&self) -> String {
        let factor = |(name, power): (&&str, f64)| match power.abs() {
            1.0 => name.to_string(),
            power => format!("{name}^{power}"),
        };
        let list = |wanted: fn(f64) -> bool| -> Vec<String> {
            ["kg", "m", "s"].iter().zip(self.0).filter(|(_, power)| wanted(*power)).map(factor).collect()
        };
        let (above, below) = (list(|power| power > 1e-9), list(|power| power < -1e-9));
        let above = if above.is_empty() { "1".to_string() } else { above.join("*") };
        std::iter::once(above).chain(below).collect::<Vec<_>>().join("/")
    }

    /// `a length [m]`, `a pressure [Pa]`; dimensions without a name by their units.
    pub fn name(&self) -> String {
        match NAMED.iter().find(|(powers, ..)| Powers::from(*powers) == *self) {
            Some((_, name, "")) => name.to_string(),
            Some((_, name, unit)) => format!("{name} [{unit}]"),
            None => format!("a quantity in {}", self.symbol()),
        }
    }

    /// A value of this dimension as one writes it: `0.4 m`.
    pub fn example(&self) -> String {
        match EXAMPLES.iter().find(|(powers, _)| Powers::from(*powers) == *self) {
            Some((_, example)) => example.to_string(),
            None => format!("1 {}", self.symbol()),
        }
    }
}

/// Dimensions with a name: what it is and its unit.
const NAMED: &[([i8; 3], &str, &str)] = &[
    ([0, 0, 0], "a number without unit", ""),
    ([0, 1, 0], "a length", "m"),
    ([0, 2, 0], "an area", "m^2"),
    ([0, 3, 0], "a volume", "m^3"),
    ([0, 0, 1], "a time", "s"),
    ([1, 0, 0], "a mass", "kg"),
    ([0, 0, -1], "a rate", "1/s"),
    ([0, 1, -1], "a velocity", "m/s"),
    ([0, 1, -2], "an acceleration", "m/s^2"),
    ([1, -3, 0], "a density", "kg/m^3"),
    ([1, -1, -2], "a pressure", "Pa"),
    ([1, -1, -1], "a viscosity", "Pa*s"),
    ([-1, 1, 2], "a compliance", "1/Pa"),
    ([1, 1, -2], "a force", "N"),
    ([1, 0, -2], "a stiffness or an energy per area", "N/m"),
    ([1, 0, -1], "a force per velocity", "N*s/m"),
    ([1, 2, -2], "an energy or a moment", "J"),
    ([1, 2, -3], "a power", "W"),
];

/// How values are written.
const EXAMPLES: &[([i8; 3], &str)] = &[
    ([0, 0, 0], "0.5"),
    ([0, 1, 0], "0.4 m"),
    ([0, 0, 1], "2.5 ms"),
    ([1, 0, 0], "3 kg"),
    ([0, 0, -1], "5 rad/s"),
    ([0, 1, -1], "5 m/s"),
    ([0, 1, -2], "9.81 m/s^2"),
    ([1, -3, 0], "1000 kg/m^3"),
    ([1, -1, -2], "6 MPa"),
    ([1, -1, -1], "1 mPa*s"),
    ([-1, 1, 2], "4e-12 m^2/N"),
    ([1, 1, -2], "10 N"),
    ([1, 0, -2], "100 N/m"),
    ([1, 0, -1], "10 N*s/m"),
    ([1, 2, -2], "10 J"),
];

/// Units that take prefixes: name, decade, powers.
const PREFIXABLE: &[(&str, i32, [i8; 3])] = &[
    ("m", 0, [0, 1, 0]),
    ("g", -3, [1, 0, 0]),
    ("s", 0, [0, 0, 1]),
    ("N", 0, [1, 1, -2]),
    ("Pa", 0, [1, -1, -2]),
    ("J", 0, [1, 2, -2]),
    ("W", 0, [1, 2, -3]),
    ("Hz", 0, [0, 0, -1]),
    ("bar", 5, [1, -1, -2]),
    ("rad", 0, [0, 0, 0]),
];

/// SI prefixes that mechanics uses: name, decade.
const PREFIXES: &[(&str, i32)] = &[
    ("T", 12),
    ("G", 9),
    ("M", 6),
    ("k", 3),
    ("h", 2),
    ("d", -1),
    ("c", -2),
    ("m", -3),
    ("u", -6),
    ("\u{b5}", -6),  // micro sign
    ("\u{3bc}", -6), // Greek mu
    ("n", -9),
    ("p", -12),
];

/// Units that take no prefix: name, scale, powers.
const WHOLE: &[(&str, f64, [i8; 3])] = &[
    ("deg", PI / 180.0, [0, 0, 0]),
    ("min", 60.0, [0, 0, 1]),
    ("h", 3600.0, [0, 0, 1]),
    ("rpm", PI / 30.0, [0, 0, -1]),
    ("in", 0.0254, [0, 1, 0]),
    ("inch", 0.0254, [0, 1, 0]),
    ("ft", 0.3048, [0, 1, 0]),
    ("lb", 0.45359237, [1, 0, 0]),
    ("lbf", 4.4482216152605, [1, 1, -2]),
    ("psi", 6894.757293168361, [1, -1, -2]),
    ("ksi", 6894757.293168361, [1, -1, -2]),
    ("atm", 101325.0, [1, -1, -2]),
    ("dyn", 1e-5, [1, 1, -2]),
    ("tonne", 1000.0, [1, 0, 0]),
];

impl Unit {
    /// The unit 1.
    pub const ONE: Unit = Unit { scale: 1.0, decade: 0, powers: Powers::NONE };

    /// The unit of that name, with or without prefix.
    pub fn named(name: &str) -> Option<Unit> {
        if let Some((_, scale, powers)) = WHOLE.iter().find(|(unit, ..)| *unit == name) {
            return Some(Unit { scale: *scale, decade: 0, powers: (*powers).into() });
        }
        PREFIXABLE.iter().find_map(|(unit, decade, powers)| {
            let prefix = name.strip_suffix(unit)?;
            let shift = match prefix {
                "" => 0,
                _ => PREFIXES.iter().find(|(known, _)| *known == prefix)?.1,
            };
            Some(Unit { scale: 1.0, decade: decade + shift, powers: (*powers).into() })
        })
    }

    /// Names to choose from when one is misspelt.
    pub fn names() -> Vec<String> {
        let usual = ["k", "M", "G", "c", "m", "u"];
        let prefixed = PREFIXABLE.iter().flat_map(|(unit, ..)| usual.map(|prefix| format!("{prefix}{unit}")));
        let plain = PREFIXABLE.iter().map(|(unit, ..)| unit.to_string());
        plain.chain(WHOLE.iter().map(|(unit, ..)| unit.to_string())).chain(prefixed).collect()
    }

    /// The product with another unit raised to `exponent`.
    pub fn times(self, other: Unit, exponent: i32) -> Unit {
        Unit {
            scale: self.scale * libm::pow(other.scale, f64::from(exponent)),
            decade: self.decade + other.decade * exponent,
            powers: self.powers.times(other.powers, f64::from(exponent)),
        }
    }

    /// A number of this unit in SI units.
    pub fn to_si(self, number: f64) -> f64 {
        // Dividing by a power of ten rounds once; its inverse is not a floating-point number.
        let ten = libm::pow(10.0, f64::from(self.decade.abs()));
        let number = number * self.scale;
        if self.decade < 0 { number / ten } else { number * ten }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_have_their_size() {
        for (name, size, powers) in [
            ("MPa", 1e6, [1, -1, -2]),
            ("kg", 1.0, [1, 0, 0]),
            ("us", 1e-6, [0, 0, 1]),
            ("mm", 1e-3, [0, 1, 0]),
            ("min", 60.0, [0, 0, 1]),
            ("mbar", 100.0, [1, -1, -2]),
            ("inch", 0.0254, [0, 1, 0]),
            ("rad", 1.0, [0, 0, 0]),
        ] {
            let unit = Unit::named(name).unwrap_or_else(|| panic!("{name}"));
            assert_eq!(unit.to_si(1.0), size, "{name}");
            assert_eq!(unit.powers, Powers::from(powers), "{name}");
        }
        for name in ["", "M", "t", "kdeg", "Mmin", "pascal"] {
            assert!(Unit::named(name).is_none(), "{name}");
        }
    }

    #[test]
    fn decimal_prefixes_round_once() {
        assert_eq!(Unit::named("mm").map(|unit| unit.to_si(0.3)), Some(0.0003));
        let density = Unit::named("g").zip(Unit::named("cm")).map(|(g, cm)| g.times(cm, -3));
        assert_eq!(density.map(|unit| unit.to_si(7.85)), Some(7850.0));
    }

    #[test]
    fn dimensions_are_named() {
        assert_eq!(Powers::from([1, -1, -2]).name(), "a pressure [Pa]");
        assert_eq!(Powers::from([1, -1, -1]).name(), "a viscosity [Pa*s]");
        assert_eq!(Powers::from([1, -2, -1]).name(), "a quantity in kg/m^2/s");
        assert_eq!(Powers::from([0, 0, -2]).symbol(), "1/s^2");
    }
}
