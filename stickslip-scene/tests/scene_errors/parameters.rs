//! Parameters and overrides.

use crate::{ROLLING, check, edited, message, message_with};

#[test]
fn parameters() {
    check(
        ROLLING,
        &[
            (
                "\"radius / cells_per_radius\"",
                "\"raduis / 8\"",
                "12:9: parameters.cell: found unknown name `raduis`; allowed: a parameter (cells_per_radius, contact, cell, radius, angle), pi or inf; did you mean `radius`?",
            ),
            (
                "radius = \"1.6 m\"",
                "radius = \"8 * cell\"",
                "12:8: parameters.cell: found the circle cell -> radius -> cell; allowed: parameters that do not need each other in a circle",
            ),
            (
                "angle = \"pi / 4\"",
                "angle = true",
                "14:9: parameters.angle: found `true`; allowed: a number, or a formula or a word in quotes",
            ),
            (
                "angle = \"pi / 4\"",
                "t = 1",
                "14:1: parameters.t: found the name `t`, which formulas use already; allowed: another name",
            ),
            (
                "angle = \"pi / 4\"",
                "my-angle = 1",
                "14:1: parameters.my-angle: found the name `my-angle`; allowed: letters, digits and _, not beginning with a digit",
            ),
            (
                "radius = \"1.6 m\"",
                "radius = \"1.6 s\"",
                "44:32: bodies[0].shape.ball.center[2]: found \"radius\", a time [s]; allowed: a length [m], like \"0.4 m\"",
            ),
        ],
    );
    let circle = message(&edited(ROLLING, "cell = \"radius / cells_per_radius\"", "cell = \"cell\""));
    assert!(circle.contains("parameters.cell: found the circle cell -> cell;"), "{circle}");
}

#[test]
fn overrides() {
    let parameters = "(cells_per_radius, contact, cell, radius, angle)";
    for (name, value, expected) in [
        ("cels_per_radius", "4", format!("--set cels_per_radius:1:1: found no parameter `cels_per_radius`; allowed: a parameter of the scene {parameters}; did you mean `cells_per_radius`?")),
        ("colour", "4", format!("--set colour:1:1: found no parameter `colour`; allowed: a parameter of the scene {parameters}; other keys are set by their path with dots: time.end=\"1 s\"")),
        ("radius", "2 kgg", "--set radius:1:10: parameters.radius: found `kgg` after a number; allowed: a unit such as m, mm, kg, ms, MPa, deg; did you mean `kg`?".to_string()),
        ("time.end", "-1 s", "--set time.end:1:10: time.end: found \"-1 s\"; allowed: a time [s] above 0, like \"2.5 ms\"".to_string()),
        ("time.ende", "1 s", "--set time.ende:1:1: time.ende: found unknown key `ende`; allowed: end, courant, max_step, stress_update, transfer, pic_share, xpic_order, relax, energy_drift; did you mean `end`?".to_string()),
        ("bodies[7].name", "x", "--set bodies[7].name:1:1: bodies: found number 7 of a list of 2; allowed: a number in the list, from 0".to_string()),
        ("title.x", "x", "--set title.x:1:1: title: found `.x` in \"Sphere rolling down an inclined plane ({contact})\"; allowed: a name in a table".to_string()),
    ] {
        assert_eq!(message_with(ROLLING, &[(name, value)]), expected);
    }
}
