//! Cameras behind a polariscope, and measurements.

use crate::{MINIMAL, ROLLING, check, edited, message};
use stickslip_scene::scene;

#[test]
fn a_camera_behind_a_polariscope() {
    let plane = MINIMAL
        .replace("\"3d\"", "\"plane-strain\"")
        .replace("[0, 0, 0]", "[0, 0]")
        .replace("shape.ball", "\nshape.ball");
    let scene = format!(
        "{plane}\n[outputs.fringes]\ninterval = \"1 ms\"\nexposure = \"0.5 ms\"\nstress_optic_coefficient = \"4e-12 m^2/N\"\nthickness = \"6 mm\"\n"
    );
    scene::parse("a.toml", &scene, &[]).unwrap_or_else(|error| panic!("{error}"));
    let space = scene.replace("\"plane-strain\"", "\"3d\"").replace("[0, 0]", "[0, 0, 0]");
    check(
        &scene,
        &[
            (
                "interval = \"1 ms\"",
                "interval = 0",
                "19:12: outputs.fringes.interval: found 0; allowed: a time [s] above 0, like \"2.5 ms\"",
            ),
            (
                "interval = \"1 ms\"",
                "",
                "18:10: outputs.fringes.interval: found nothing, the key is missing; allowed: a time [s], like \"2.5 ms\"",
            ),
            (
                "exposure = \"0.5 ms\"",
                "exposure = \"2 ms\"",
                "20:12: outputs.fringes.exposure: found \"2 ms\"; allowed: at most the interval, 0.001 s",
            ),
            (
                "exposure = \"0.5 ms\"",
                "exposure = \"-1 ms\"",
                "20:12: outputs.fringes.exposure: found \"-1 ms\"; allowed: a time [s] of 0 or more, like \"2.5 ms\"",
            ),
            (
                "thickness = \"6 mm\"",
                "samples = 0.5\nthickness = 1",
                "22:11: outputs.fringes.samples: found 0.5; allowed: a whole number from 1 to 64",
            ),
            (
                "thickness = \"6 mm\"",
                "",
                "21:28: outputs.fringes.stress_optic_coefficient: found \"4e-12 m^2/N\"; allowed: in a plane scene together with a thickness",
            ),
            (
                "thickness = \"6 mm\"",
                "stress_parameter = \"1 MPa\"",
                "22:20: outputs.fringes.stress_parameter: found \"1 MPa\"; allowed: either stress_optic_coefficient or stress_parameter",
            ),
            (
                "stress_optic_coefficient = \"4e-12 m^2/N\"",
                "stress_parameter = \"1 MPa\"",
                "22:13: outputs.fringes.thickness: found \"6 mm\"; allowed: no thickness beside stress_parameter, which holds for the stress itself",
            ),
            (
                "stress_optic_coefficient = \"4e-12 m^2/N\"",
                "",
                "19:12: outputs.fringes.interval: found \"1 ms\"; allowed: fringes with stress_optic_coefficient and thickness, or with stress_parameter, such as \"20 MPa\"",
            ),
            (
                "4e-12 m^2/N",
                "4 MPa",
                "21:28: outputs.fringes.stress_optic_coefficient: found \"4 MPa\", a pressure [Pa]; allowed: a compliance [1/Pa], like \"4e-12 m^2/N\"",
            ),
            (
                "thickness",
                "wavelength = \"1 um\"\nthickness",
                "22:14: outputs.fringes.wavelength: found \"1 um\"; allowed: a visible wavelength, \"380 nm\" to \"780 nm\"",
            ),
            (
                "thickness",
                "light = \"gray\"\nthickness",
                "22:9: outputs.fringes.light: found \"gray\"; allowed: \"grey\", \"monochrome\" or \"white\"; did you mean `grey`?",
            ),
            (
                "thickness",
                "bodies = [\"bal\"]\nthickness",
                "22:11: outputs.fringes.bodies[0]: found \"bal\"; allowed: the name of a body (\"ball\"); did you mean `ball`?",
            ),
            (
                "thickness",
                "view = { min = [0, 0], max = [1, 0] }\nthickness",
                "22:34: outputs.fringes.view.max[1]: found 0; allowed: more than 0 m, the y of min",
            ),
        ],
    );
    check(
        &space,
        &[(
            "thickness = \"6 mm\"",
            "thickness = \"7 mm\"",
            "22:13: outputs.fringes.thickness: found \"7 mm\"; allowed: no thickness in 3d, where light crosses the bodies as thick as they are",
        )],
    );
}

#[test]
fn measurements() {
    let cases = [
        ("time_unit = \"1 m\"", "outputs.time_unit: found \"1 m\"", "a time [s]"),
        ("time_unit = 0", "outputs.time_unit: found 0", "a time [s] above 0"),
        ("samples = \"steps\"", "outputs.samples: found unknown name `steps`", "a parameter"),
        ("probes = [{ name = \"p\", at = [0, 0] }]", "outputs.probes[0].at: found", "3 numbers"),
        (
            "probes = [{ name = \"p\", at = [0, 0, 0] }, { name = \"p\", at = [0, 0, 0] }]",
            "outputs.probes[1].name: found \"p\"",
            "a name that no other in the list has",
        ),
        (
            "probes = [{ name = \"p\", at = [0, 0, 0], body = \"plane\" }]",
            "\"plane\"",
            "a body that is not rigid (\"sphere\")",
        ),
        (
            "probes = [{ name = \"p\", at = [0, 0, 0], fixed_in = \"materiel\" }]",
            "outputs.probes[0].fixed_in: found \"materiel\"",
            "did you mean `material`?",
        ),
        (
            "arrivals = [{ quantity = \"vx\", threshold = \"1 Pa\", bodies = [\"sphere\"] }]",
            "outputs.arrivals[0].threshold: found \"1 Pa\", a pressure [Pa]",
            "a velocity [m/s] other than 0",
        ),
        (
            "arrivals = [{ quantity = \"vx\", threshold = 0, bodies = [\"sphere\"] }]",
            "outputs.arrivals[0].threshold: found 0",
            "other than 0",
        ),
        (
            "arrivals = [{ quantity = \"vx\", threshold = 1 }]",
            "watches no probe and no body",
            "probes = [...]",
        ),
        (
            "arrivals = [{ quantity = \"vx\", threshold = 1, probes = [\"p\"] }]",
            "outputs.arrivals[0].probes[0]: found \"p\"",
            "allowed: the name of a probe",
        ),
        (
            "fronts = [{ name = \"f\", quantity = \"xx\", threshold = 1, from = [0, 0, 0], direction = [0, 0, 0] }]",
            "outputs.fronts[0].direction: found",
            "a direction that is not zero",
        ),
        (
            "fronts = [{ name = \"f\", quantity = \"xx\", threshold = 1, from = [0, 0, 0], direction = [1, 0, 0], fit = [2, 1] }]",
            "outputs.fronts[0].fit[1]: found 1",
            "more than 2 m",
        ),
    ];
    for (text, found, allowed) in cases {
        let message = message(&edited(ROLLING, "grid = \"never\"", text));
        assert!(message.contains(found) && message.contains(allowed), "`{text}`\n  gives {message}");
    }
}
