//! Shapes that are none.

use crate::{MINIMAL, check, edited, message};
use stickslip_scene::scene;

/// Each mistake in a shape of a scene in space, with the message that it must give after the place and the shape's key.
fn wrong(cases: &[(&str, &str)]) {
    let shape = MINIMAL.lines().find(|line| line.starts_with("shape")).expect("a body has a shape");
    for (written, expected) in cases {
        check(MINIMAL, &[(shape, &format!("shape.{written}"), &format!("15:{expected}"))]);
    }
}

/// The same in the plane.
fn wrong_in_the_plane(cases: &[(&str, &str)]) {
    let plane = edited(MINIMAL, "3d", "plane-strain");
    let shape = plane.lines().find(|line| line.starts_with("shape")).expect("a body has a shape");
    for (written, expected) in cases {
        check(&plane, &[(shape, &format!("shape.{written}"), &format!("15:{expected}"))]);
    }
}

#[test]
fn solids_that_are_none() {
    wrong(&[
        (
            "ellipsoid = { center = [0, 0, 0], semi_axes = [1, 0, 1] }",
            "53: bodies[0].shape.ellipsoid.semi_axes: found 0 m; allowed: a finite number above 0",
        ),
        (
            "superquadric = { center = [0, 0, 0], semi_axes = [1, 1, 1], exponent = 1.5 }",
            "78: bodies[0].shape.superquadric.exponent: found 1.5; allowed: a number from 2 to 20",
        ),
        (
            "capsule = { start = [0, 0, 0], end = [1, 0, 0], radius = 0 }",
            "64: bodies[0].shape.capsule.radius: found 0; allowed: a length [m] above 0, like \"0.4 m\"",
        ),
        (
            "torus = { center = [0, 0, 0], axis = [0, 0, 1], radius = 1, tube_radius = \"1 m\" }",
            "81: bodies[0].shape.torus.tube_radius: found 1 m; allowed: less than the torus's radius",
        ),
        (
            "torus = { center = [0, 0, 0], axis = [0, 0, 0], radius = 1, tube_radius = 0.2 }",
            "44: bodies[0].shape.torus.axis: found [0.0, 0.0, 0.0]; allowed: a vector of some length",
        ),
        (
            "cone = { start = [0, 0, 0], end = [0, 0, 1], start_radius = -1 }",
            "67: bodies[0].shape.cone.start_radius: found -1; allowed: a length [m] from 0 on",
        ),
        (
            "cone = { start = [0, 0, 0], end = [0, 0, 0], start_radius = 1 }",
            "41: bodies[0].shape.cone.end: found [0, 0, 0]; allowed: another point than start",
        ),
        (
            "rounded_box = { min = [0, 0, 0], max = [1, 1, 1], rounding = \"60 cm\" }",
            "68: bodies[0].shape.rounded_box.rounding: found 0.6 m; allowed: at most half of the shortest side",
        ),
        (
            "ring = { center = [0, 0, 0], inner_radius = 1, outer_radius = 0.5 }",
            "69: bodies[0].shape.ring.outer_radius: found 0.5; allowed: more than the inner radius, 1 m",
        ),
        (
            "ring = { center = [0, 0, 0], inner_radius = 0.5, outer_radius = 1, axis = [0, 0, 1] }",
            "7: bodies[0].shape.ring.width: found nothing, the key is missing; allowed: the extent along the axis, like \"1 m\"",
        ),
    ]);
    wrong_in_the_plane(&[
        (
            "torus = { center = [0, 0], axis = [0, 1], radius = 1, tube_radius = 0.2 }",
            "26: bodies[0].shape.torus.center: found [0, 0]; allowed: shapes other than a torus, as the scene is plane",
        ),
        (
            "ring = { center = [0, 0], inner_radius = 0.5, outer_radius = 1, width = 1 }",
            "79: bodies[0].shape.ring.width: found 1; allowed: no width, as the scene is plane",
        ),
    ]);
}

#[test]
fn outlines_that_are_none() {
    wrong(&[
        (
            "spline = { points = [[0, 0], [1, 0], [1, 0], [0, 1]], height = [0, 1] }",
            "44: bodies[0].shape.spline.points[2]: found [1, 0]; allowed: another point than the one before it",
        ),
        (
            "spline = { points = [[0, 0], [1, 0], [0, 1]] }",
            "7: bodies[0].shape.spline.height: found nothing, the key is missing; allowed: lower and upper z: [0, \"1 m\"]",
        ),
        (
            "revolved = { center = [0, 0, 0], axis = [0, 0, 1] }",
            "7: bodies[0].shape.revolved.polygon: found neither `polygon` nor `spline`; allowed: one of polygon and spline",
        ),
        (
            "revolved = { polygon = [[0, 0], [-1, 0], [0, 1]], center = [0, 0, 0], axis = [0, 0, 1] }",
            "40: bodies[0].shape.revolved.polygon[1][0]: found -1; allowed: a distance from the axis [m] from 0 on",
        ),
        (
            "revolved = { polygon = [[1, 0], [2, 0], [3, 0]], center = [0, 0, 0], axis = [0, 0, 1] }",
            "30: bodies[0].shape.revolved.polygon: found [[1, 0], [2, 0], [3, 0]]; allowed: corners round an area",
        ),
        (
            "revolved = { spline = [[0.01, 0], [1, 0], [0.01, 1]], center = [0, 0, 0], axis = [0, 0, 1] }",
            "29: bodies[0].shape.revolved.spline: found a curve beyond the axis, 0.0033 m at 0.9935 m along it; allowed: a curve on one side of the axis; more points near the axis; a curve from the axis to the axis begins and ends with one on it",
        ),
    ]);
    wrong_in_the_plane(&[(
        "revolved = { polygon = [[1, 0], [2, 0], [2, 1]], center = [0, 0], axis = [0, 1] }",
        "65: bodies[0].shape.revolved.center: found [0, 0]; allowed: shapes other than one that is revolved, as the scene is plane",
    )]);
}

#[test]
fn names_of_shapes_that_are_none() {
    let shape = MINIMAL.lines().find(|line| line.starts_with("shape")).expect("a body has a shape");
    let named = |written: &str| edited(MINIMAL, "[space]", &format!("[shapes]\n{written}\n\n[space]"));
    let ball = named("tip.ball = { center = [0, 0, 0], radius = 1 }");
    check(
        &ball,
        &[(
            shape,
            "shape = \"tipp\"",
            "18:9: bodies[0].shape: found \"tipp\"; allowed: a shape such as shape.ball = { center = [0, 0, 1], \
             radius = 1 }, or the name of one above it in [shapes] (\"tip\"); did you mean `tip`?",
        )],
    );
    // Only those above: so no shape is made of itself.
    let itself = "2:14: shapes.tip.union[0]: found \"tip\"; allowed: a shape such as shape.ball = { center = [0, 0, \
                  1], radius = 1 }, or the name of one above it in [shapes]";
    check(&named("tip.union = [\"tip\"]"), &[("", "", itself)]);
}

/// A few lines that would be more shapes than memory holds, or deeper than the stack.
#[test]
fn named_shapes_are_bounded() {
    let named = |written: &str| edited(MINIMAL, "[space]", &format!("[shapes]\n{written}\n\n[space]"));
    let begin = "s0.ball = { center = [0, 0, 0], radius = 1 }\n".to_string();
    let ten = |k: usize| format!("s{}.union = [{}]\n", k + 1, vec![format!("\"s{k}\""); 10].join(", "));
    let many = named(&(begin.clone() + &(0..8).map(ten).collect::<String>()));
    let found = message(&many);
    assert!(found.ends_with("allowed: names whose shapes take 400 MB of memory at most together"), "{found}");
    let one = |k: usize| format!("s{}.union = [\"s{k}\"]\n", k + 1);
    let deep = named(&(begin + &(0..40).map(one).collect::<String>()));
    let nearer = "18:1: shapes.s16: found a shape that names others 16 deep; allowed: shapes that are nearer to those \
                  they are made of";
    check(&deep, &[("", "", nearer)]);
}

/// A body that a mirror cuts is the one that a half-space cuts there; without a mirror, or without being asked, it is
/// refused.
#[test]
fn mirrors_cut_shapes_on_request() {
    let scene = |space: &str, keys: &str| {
        format!(
            r#"
            space = {{ dimension = "plane-strain", cell = 0.1, domain = {{ min = [0, -2], max = [3, 2], {space} }} }}
            time.end = 1
            materials.gel = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
            [[bodies]]
            name = "disk"
            material = "gel"
            {keys}
            "#
        )
    };
    let parsed =
        |text: &str| scene::parse("a.toml", text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    let ball = "shape.ball = { center = [0.3, 0], radius = 1 }";
    let mirror = "x_min = \"symmetry\", y_max = \"symmetry\"";
    let by_hand = "shape.intersection = [{ ball = { center = [0.3, 0], radius = 1 } }, { half_space = { point = [0, 0], \
                   normal = [-1, 0] } }]";
    let cut = parsed(&scene(mirror, &format!("beyond_mirrors = \"cut\"\n{ball}")));
    let expected = parsed(&scene(mirror, by_hand)).bodies[0].shape.clone();
    assert_eq!(cut.bodies[0].shape, expected, "the mirror above cuts nothing");
    assert_eq!(stickslip_scene::check::problems(&cut), Ok(()));
    let uncut = parsed(&scene(mirror, ball));
    let refused = stickslip_scene::check::problems(&uncut).unwrap_err();
    assert!(refused.found.contains("`disk` leaves the domain"), "{refused}");
    assert!(refused.help.is_some_and(|help| help.contains("beyond_mirrors = \"cut\"")));
    let nothing = message(&scene("x_min = \"fixed\"", &format!("beyond_mirrors = \"cut\"\n{ball}")));
    let told = "bodies[0].beyond_mirrors: found \"cut\"; allowed: \"refused\", as no face of the domain is \"symmetry\"";
    assert!(nothing.contains(told), "{nothing}");
}
