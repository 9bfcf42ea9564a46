//! What a scene file only names, and the program that runs the scene gives.

use crate::check;
use std::sync::atomic::{AtomicUsize, Ordering};
use stickslip_scene::outside::{OutsideFault, OutsideFunction, OutsidePoints};
use stickslip_scene::scene::OutsideUse;
use stickslip_scene::{check as checks, scene};

const OUTSIDE: &str = r#"[space]
dimension = "plane-strain"
cell = 0.1
[time]
end = 1
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = "1 MPa", poisson_ratio = 0.3 }
[[bodies]]
name = "block"
material = "rubber"
shape.box = { min = [0, 0], max = [1, 1] }
[[bodies]]
name = "ram"
material = "rubber"
shape.box = { min = [0, 1], max = [1, 2] }
rigid.velocity = { outside = "drive" }
rigid.spin = { outside = "turn" }
[[loads]]
body = "block"
on = "x_max"
pressure = { outside = "wind" }
[[loads]]
body = "block"
force = { outside = "drive" }
"#;

/// Any function.
#[derive(Debug)]
struct Anything;

impl OutsideFunction for Anything {
    fn evaluate(&self, _: OutsidePoints<'_>, values: &mut [[f64; 3]]) -> Result<(), OutsideFault> {
        values.fill([1.0, 2.0, 3.0]);
        Ok(())
    }
}

fn problem(text: &str) -> String {
    let scene = scene::parse("a.toml", text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    checks::problems(&scene).expect_err("a problem").to_string()
}

#[test]
fn names_of_what_comes_from_outside() {
    check(
        OUTSIDE,
        &[
            (
                "outside = \"wind\"",
                "outside = 3",
                "22:24: loads[0].pressure.outside: found 3; allowed: text in quotes",
            ),
            (
                "{ outside = \"wind\" }",
                "{ outside = \"wind\", at = 3 }",
                "22:32: loads[0].pressure.at: found unknown key `at`; allowed: outside",
            ),
            (
                "neo_hookean = {",
                "outside = {",
                "8:1: materials.rubber.outside.law: found nothing, the key is missing; allowed: text in quotes",
            ),
            (
                "neo_hookean = { young_modulus = \"1 MPa\", poisson_ratio = 0.3 }",
                "outside = { law = \"mine\" }",
                "8:1: materials.rubber.outside: found no elastic constant; allowed: two of bulk_modulus, \
                 shear_modulus, young_modulus, poisson_ratio, p_wave_modulus (not E with M)",
            ),
        ],
    );
}

#[test]
fn what_nobody_gives_is_refused_before_the_run() {
    let given = "a name that the program which runs the scene gives, such as that of a function in Python";
    assert_eq!(
        problem(OUTSIDE),
        format!(
            "bodies[1].rigid.velocity.outside: the function `drive`, which is not given; allowed: {given}"
        )
    );
    let still = OUTSIDE.replace(
        "rigid.velocity = { outside = \"drive\" }\nrigid.spin = { outside = \"turn\" }",
        "rigid = {}",
    );
    assert_eq!(
        problem(&still),
        format!("loads[0].pressure: the function `wind`, which is not given; allowed: {given}")
    );
    let law = OUTSIDE.replace("neo_hookean = {", "outside = { law = \"mine\",");
    assert_eq!(
        problem(&law),
        format!("materials.rubber.outside.law: the law `mine`, which is not given; allowed: {given}")
    );
}

#[test]
fn what_is_given_is_taken_for_what_it_stands() {
    let mut scene = scene::parse("a.toml", OUTSIDE, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    let mut asked = Vec::new();
    let outcome: Result<(), ()> = scene.give_functions(|name, purpose| {
        asked.push((name.to_string(), purpose));
        Ok(Some(&Anything))
    });
    outcome.expect("no error");
    let expected = [
        ("drive", OutsideUse::Vector),
        ("turn", OutsideUse::Spin),
        ("wind", OutsideUse::NumberAtPoints),
        ("drive", OutsideUse::VectorAtPoints),
    ];
    assert_eq!(asked, expected.map(|(name, purpose)| (name.to_string(), purpose)));
    checks::problems(&scene).expect("all is given");
    let scene::BodyMotion::Rigid { velocity, spin } = &scene.bodies[1].motion else { panic!("rigid") };
    let at = |values| scene::OutsideValue::vector(values, 0.5).expect("an answer");
    assert_eq!((at(velocity), at(spin)), ([1.0, 2.0, 0.0], [0.0, 0.0, 3.0]));
}

/// A function that grows with time and one that jumps, at t = 1.13 s, and how often they were asked.
#[derive(Debug)]
struct Counted(AtomicUsize, bool);

impl OutsideFunction for Counted {
    fn evaluate(&self, points: OutsidePoints<'_>, values: &mut [[f64; 3]]) -> Result<(), OutsideFault> {
        let Counted(asked, jumps) = self;
        asked.fetch_add(1, Ordering::Relaxed);
        let jump = if points.time > 1.13 { 5.0 } else { 0.0 };
        values.fill([if *jumps { jump } else { points.time }, 2.0, 0.0]);
        Ok(())
    }
}

static GROWS: Counted = Counted(AtomicUsize::new(0), false);
static JUMPS: Counted = Counted(AtomicUsize::new(0), true);

/// Three times in a step, and where it is bent fifteen: the mean of what grows is exact, that of a jump of 5 within a
/// seventh of a quarter of it.
#[test]
fn functions_are_asked_a_few_times_in_a_step() {
    let mean = |function: &'static Counted| {
        let mut scene = scene::parse("a.toml", OUTSIDE, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        let given: Result<(), ()> = scene.give_functions(|_, _| Ok(Some(function)));
        given.expect("no error");
        let scene::BodyMotion::Rigid { velocity, .. } = &scene.bodies[1].motion else { panic!("rigid") };
        let mean = scene::OutsideValue::vector_over_step(velocity, (1.0, 0.4)).expect("an answer");
        (mean, function.0.load(Ordering::Relaxed))
    };
    let ([grows, still, _], asked) = mean(&GROWS);
    assert!((grows - 1.2).abs() < 1e-15 && (still - 2.0).abs() < 1e-15, "{grows} {still}");
    assert_eq!(asked, scene::LEAST_CALLS);
    let ([jumps, still, _], asked) = mean(&JUMPS);
    assert!((jumps - 5.0 * 0.27 / 0.4).abs() < 5.0 / 4.0 * 0.15 && (still - 2.0).abs() < 1e-14, "{jumps}");
    assert_eq!((asked, scene::LEAST_CALLS, scene::MOST_CALLS), (15, 3, 15));
}
