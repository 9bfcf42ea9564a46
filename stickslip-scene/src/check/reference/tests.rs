//! Each refusal with its key, what was found and what is allowed, and what is next to it and allowed.

use super::*;
use crate::check::problems;
use crate::material::{CustomLaw, Isotropic, LawArrays, LawOverArrays, Motion};
use crate::outside::OutsideFault;
use crate::scene::{ContactRule, parse_beside};
use crate::tensor::{Matrix, Symmetric};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A disk on its undeformed places, one on the grid, and a plate that moves as prescribed.
const BODIES: &str = r#"
[space]
dimension = "plane-strain"
cell = 0.1
interior = "grid"
[time]
end = 1
[materials.rubber]
density = 1000
thermal_expansion = 1e-5
neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 }
[[bodies]]
name = "a"
material = "rubber"
shape.ball = { center = [0, 0], radius = 0.5 }
interior = "reference"
[[bodies]]
name = "b"
material = "rubber"
shape.ball = { center = [2, 0], radius = 0.5 }
[[bodies]]
name = "plate"
material = "rubber"
shape.box = { min = [-1, -2], max = [3, -1] }
rigid = {}
"#;

/// They do not touch.
const APART: &str = "contact = [{ law = 'none' }]";

const GLASS: &str = "{ density = 1, damage = { tensile_strength = 1e4, fracture_energy = 900, \
                     young_modulus = 1e6, poisson_ratio = 0.2 } }";

const WALLS: &str = "{ min = [-0.5, -2], max = [3, 2], x_min = 'WORD' }";

/// The scene with these tables above it, and these keys set.
fn scene(top: &str, set: &[(&str, &str)]) -> Scene {
    let cloud: String = (0..64).map(|n| format!("{},{},1\n", n % 8, n / 8)).collect();
    let files = BTreeMap::from([(PathBuf::from("cloud.csv"), format!("x,y,volume\n{cloud}").into_bytes())]);
    let set: Vec<_> = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    let text = format!("{top}\n{BODIES}");
    parse_beside("a.toml", &text, &set, &files).unwrap_or_else(|error| panic!("{error}")).scene
}

fn refused(scene: &Scene) -> String {
    problems(scene).expect_err("a problem").to_string()
}

#[test]
fn what_a_body_on_the_grid_may_have_is_refused() {
    let of_a = "where `a` has interior = \"reference\"; allowed: ";
    let [cut, fixed, periodic] =
        ["symmetry", "fixed", "periodic', x_max = 'periodic"].map(|word| WALLS.replace("WORD", word));
    let [cut, fixed] = [cut, fixed].map(|walls| walls.replace("-0.5", "-0.49"));
    for (top, set, key, found, allowed) in [
        (
            APART,
            &[("bodies[0].particles_per_side", "3")][..],
            "bodies[0].particles_per_side",
            "3",
            "2, the default",
        ),
        (APART, &[("space.particles_per_side", "1")], "space.particles_per_side", "1", "2, the default"),
        (
            APART,
            &[("bodies[0].shape", "{ box = { min = [0, 0], max = [1, 0.19] } }")],
            "bodies[0].shape",
            "a shape 0.19 m across",
            "at least 2 cells, 0.2 m",
        ),
        (
            APART,
            &[("bodies[0].shape.ball.radius", "2400"), ("bodies[0].shape.ball.center", "[9000, 0]")],
            "space.cell",
            "2.3e9 cells of 0.1 m in the box round a body",
            "at most 2.1e9",
        ),
        (
            APART,
            &[("materials.glass", GLASS), ("bodies[0].material", "glass")],
            "materials.glass.damage",
            "a law by which material parts",
            "a law that leaves material in one piece",
        ),
        (
            APART,
            &[("space.domain", cut.as_str())],
            "bodies[0].shape",
            "a body that reaches beyond the face `x_min` of the domain",
            "a body that ends there, or x_min = \"open\"",
        ),
        (
            APART,
            &[("space.domain", &fixed)],
            "bodies[0].shape",
            "a body that reaches beyond the face `x_min` of the domain",
            "a body that ends there, or x_min = \"open\"",
        ),
        (
            APART,
            &[
                ("space.domain", &periodic),
                ("space.domain.max", "[3.5, 2]"),
                ("bodies[0].shape", "{ box = { min = [-0.5, 0], max = [3.5, 1] } }"),
            ],
            "bodies[0].shape",
            "a body that is joined to its own images along x",
            "one that ends between the periodic faces",
        ),
    ] {
        let expected = format!("{key}: {found}, {of_a}{allowed}; or interior = \"grid\" for `a`");
        assert_eq!(refused(&scene(top, set)), expected);
        // A body on the grid may have it, however it comes to be there.
        let grid: Vec<_> = set.iter().copied().chain([("bodies[0].interior", "grid")]).collect();
        let found = problems(&scene(top, &grid)).map_err(|problem| problem.to_string());
        assert!(found.as_ref().map_or_else(|text| !text.contains("interior"), |()| true), "{found:?}");
    }
}

/// Cells of its own are for a body with a grid of its own: fewer than two across are too few, whatever the scene's are.
#[test]
fn cells_of_bodies_without_a_grid_are_refused() {
    assert_eq!(problems(&scene(APART, &[("bodies[0].cell", "0.05")])), Ok(()));
    let expected = "bodies[0].shape: a shape 1 m across, where `a` has interior = \"reference\"; allowed: at least 2 \
                    cells, 1.2 m; or interior = \"grid\" for `a`";
    assert_eq!(refused(&scene(APART, &[("bodies[0].cell", "0.6")])), expected);
    for (body, why) in [("1", "`b` is on the grid that all share"), ("2", "`plate` is rigid")] {
        let key = format!("bodies[{body}].cell");
        let expected = format!(
            "{key}: 0.05 m, where {why}; allowed: none; or interior = \"reference\" for a body that deforms"
        );
        assert_eq!(refused(&scene(APART, &[(&key, "0.05")])), expected);
    }
}

#[test]
fn refusals_point_to_the_line() {
    let text = format!("{APART}\n{BODIES}")
        .replace("interior = \"reference\"", "particles_per_side = 3\ninterior = \"reference\"");
    let loaded = crate::scene::parse("a.toml", &text, &[]).expect("a scene");
    let error = loaded.source.locate(problems(&loaded.scene).expect_err("3 a side")).to_string();
    assert!(
        error.starts_with("a.toml:17:22: bodies[0].particles_per_side: found 3, where `a` has "),
        "{error}"
    );
}

#[test]
fn a_point_cloud_has_no_undeformed_places() {
    let cloud = "contact = [{ law = 'none' }]\n\
                 point_clouds = [{ name = 'c', material = 'rubber', file = 'cloud.csv', unit = 0.05 }]";
    let away = ("bodies[0].shape.ball.center", "[0, 9]");
    assert_eq!(problems(&scene(cloud, &[away])), Ok(()));
    let problem = problems(&scene(cloud, &[away, ("space.interior", "reference")])).expect_err("a cloud");
    assert_eq!(problem.key, "space.interior");
    assert!(problem.found.starts_with("a body of a point cloud, where `c"), "{problem}");
    assert_eq!(problem.allowed, "interior = \"grid\" in [space], and \"reference\" for other bodies");
    let met = cloud.replace("law = 'none'", "between = ['a', 'b'], law = 'none'");
    let problem = problems(&scene(&met, &[away])).expect_err("`a` may touch it");
    assert!(problem.found.ends_with("that has interior = \"grid\" and is a point cloud"), "{problem}");
}

#[derive(Debug)]
struct OverArrays;

impl LawOverArrays for OverArrays {
    fn respond(&self, _: LawArrays<'_>) -> Result<(), OutsideFault> {
        Ok(())
    }
}

impl CustomLaw for OverArrays {
    fn name(&self) -> &'static str {
        "arrays"
    }

    fn over_arrays(&self) -> Option<&dyn LawOverArrays> {
        Some(self)
    }

    fn elastic(&self) -> Isotropic<f64> {
        Isotropic { bulk_modulus: 1e6, shear_modulus: 1e6 }
    }

    fn respond(&self, _: &Motion<f64>, _: &mut [f64]) -> Symmetric<f64> {
        Symmetric::isotropic(0.0)
    }

    fn strain_energy(&self, _: &Matrix<f64>, _: &Symmetric<f64>, _: &[f64]) -> f64 {
        0.0
    }
}

#[test]
fn laws_over_arrays_are_refused() {
    let mut scene = scene(APART, &[]);
    scene.materials[0].law = Material::custom(&OverArrays);
    let problem = problems(&scene).expect_err("a law over arrays");
    assert_eq!(problem.key, "materials.rubber.arrays");
    assert!(problem.found.starts_with("a law over arrays, where `a` has "), "{problem}");
    assert!(problem.allowed.starts_with("a law that takes one particle at a time; or "), "{problem}");
    scene.bodies[0].interior = None;
    assert_eq!(problems(&scene), Ok(()));
}

/// Files name rigid bodies in joints; scenes in code may name others.
#[test]
fn joints_of_such_bodies_are_refused() {
    let joint = "contact = [{ law = 'none' }]\njoints = [{ body = 'b', weld = {} }]";
    let mut scene = scene(joint, &[("bodies[1].rigid", "{ free = {} }")]);
    assert_eq!(problems(&scene), Ok(()));
    scene.joints[0].to = Some(0);
    let expected = "joints[0].to: a joint, where `a` has interior = \"reference\"; allowed: rigid bodies; or \
                    interior = \"grid\" for `a`";
    assert_eq!(refused(&scene), expected);
}

#[test]
fn rigid_bodies_have_no_interior() {
    let rigid = scene(APART, &[("space.interior", "reference"), ("bodies[0].rigid", "{}")]);
    assert_eq!(
        [0, 1, 2].map(|body| rigid.interior(body)),
        [Interior::Grid, Interior::Reference, Interior::Grid]
    );
    let own = scene(APART, &[("space.interior", "reference"), ("bodies[0].interior", "grid")]);
    assert_eq!([0, 1].map(|body| own.interior(body)), [Interior::Grid, Interior::Reference]);
}

#[test]
fn such_bodies_meet_each_other_and_all_others() {
    let both = ("bodies[1].interior", "reference");
    assert_eq!(problems(&scene("", &[both])), Ok(()));
    assert_eq!(problems(&scene("contact = [{ friction = 0.5 }]", &[both])), Ok(()));
    assert_eq!(problems(&scene("", &[])), Ok(()));
    assert_eq!(problems(&scene("contact = [{ friction = 0.5 }]", &[])), Ok(()));
    let free = ("bodies[1].rigid", "{ free = {} }");
    assert_eq!(problems(&scene("contact = [{ friction = 0.5 }]", &[free])), Ok(()));
}

/// What of a body on the grid has no surface that such a body could find.
#[test]
fn some_bodies_on_the_grid_cannot_meet_such_bodies() {
    let periodic = "{ min = [-0.5, -2], max = [3.5, 2], x_min = 'periodic', x_max = 'periodic' }";
    let brittle = "{ density = 1, johnson_cook = { young_modulus = 1e6, poisson_ratio = 0.3, \
                   yield_stress = 1e3, d1 = 0.1 } }";
    let soft = "{ density = 1, neo_hookean = { bulk_modulus = 1e6, shear_modulus = 0 } }";
    for (top, set, is, allowed) in [
        (
            "",
            &[("time.stress_update", "last")][..],
            "is strained by time.stress_update",
            "\"modified-last\", the default",
        ),
        ("", &[("space.domain", periodic)], "lies between periodic faces", "open, mirror or fixed faces"),
        (
            &format!("materials.glass = {GLASS}"),
            &[("bodies[1].material", "glass")],
            "may part by its law",
            "a law that leaves material in one piece",
        ),
        (
            &format!("materials.steel = {brittle}"),
            &[("bodies[1].material", "steel")],
            "may part by its law",
            "a law that leaves material in one piece",
        ),
        (&format!("materials.water = {soft}"), &[("bodies[1].material", "water")], "is a fluid", "a solid"),
    ] {
        let expected = format!(
            "bodies[0].interior: \"reference\" of `a`, which may touch `b`, as no rule names the pair; that has \
             interior = \"grid\" and {is}; allowed: {allowed}; or the same interior for both"
        );
        let said = refused(&scene(top, set));
        assert_eq!(said, expected, "{top}");
        assert_eq!(problems(&scene(&format!("{APART}\n{top}"), set)), Ok(()), "{top}");
    }
}

/// What is as heavy as the layer of cells that it may touch is heavy enough: 2 pi r h rho is some 300 kg. A millionth
/// is not, unless it touches nobody.
#[test]
fn bodies_that_steps_would_wait_for_are_refused() {
    let light = |mass: &str| format!("{{ free.mass = {mass} }}");
    let free = |mass: &str, top: &str| problems(&scene(top, &[("bodies[1].rigid", &light(mass))]));
    assert_eq!(free("300", ""), Ok(()));
    assert_eq!(free("3e-4", APART), Ok(()));
    let problem = free("3e-4", "").expect_err("it is light");
    assert_eq!(problem.key, "bodies[1].rigid.free.mass");
    assert!(problem.found.starts_with("3.000e-4 kg of `b`, so light that contact would"), "{problem}");
    // r_z^2/I_z = 4/3 of 1/m in the box round the disk, 4 m of which a layer of 0.1 m weighs 400 kg.
    assert!(problem.allowed.starts_with("at least 1.333 kg; or "), "{problem}");
}

#[test]
fn rules_of_such_bodies_have_what_acts_at_points() {
    let laws = "\"surface\", the default, \"none\", or \"glued\" to a rigid body or another such body";
    for (rule, key, found, allowed) in [
        ("law = 'gap'", "law", "\"gap\"", laws),
        ("law = 'glued'", "law", "\"glued\"", laws),
        ("restitution = 0.5", "restitution", "0.5", "0, the default"),
        ("overlap = 'press'", "overlap", "\"press\"", "\"kept\", the default"),
    ] {
        for (names, other, grid) in [("['a', 'b']", "b", "both"), ("['a', 'plate']", "plate", "`a`")] {
            let top = format!("contact = [{{ between = {names}, {rule} }}]");
            // Glue is refused to a body on the common grid alone.
            let mut interior = "reference";
            if rule.contains("glued") {
                assert_eq!(problems(&scene(&top, &[("space.interior", interior)])), Ok(()), "{top}");
                if other == "plate" {
                    continue;
                }
                interior = "grid";
            }
            let found = format!("{found} between `a` and `{other}`, where `a` has interior = \"reference\"");
            let expected =
                format!("contact[0].{key}: {found}; allowed: {allowed}; or interior = \"grid\" for {grid}");
            assert_eq!(refused(&scene(&top, &[("space.interior", interior)])), expected);
            assert_eq!(problems(&scene(&top, &[("bodies[0].interior", "grid")])), Ok(()), "{top}");
        }
    }
    for interior in ["grid", "reference"] {
        let top = "contact = [{ friction = 0.5, cohesion = 2, adhesion = 2, viscosity = 2 }]";
        assert_eq!(problems(&scene(top, &[("bodies[1].interior", interior)])), Ok(()), "{interior}");
    }
}

#[test]
fn friction_remembers_pressure_on_such_bodies_only() {
    let memory = |between: &str| {
        let keys = "friction = 0.5, friction_memory_length = 1e-4, friction_memory_speed = 0.01";
        format!("contact = [{{ between = {between}, {keys} }}, {{ law = 'none' }}]")
    };
    assert_eq!(problems(&scene(&memory("['a', 'plate']"), &[])), Ok(()));
    assert_eq!(problems(&scene(&memory("['a', 'b']"), &[("bodies[1].interior", "reference")])), Ok(()));
    for between in ["['b', 'plate']", "['b', 'any']"] {
        let grid = refused(&scene(&memory(between), &[("bodies[0].interior", "grid")]));
        let start = "contact[0].friction_memory_length: a memory of friction between `";
        let end = "allowed: one of whose bodies one has interior = \"reference\"";
        assert!(grid.starts_with(start) && grid.ends_with(end), "{grid}");
    }
}

#[test]
fn many_grains_take_no_longer_than_few() {
    let mut scene = scene("", &[("bodies[1].interior", "reference")]);
    let grain = scene.bodies[0].clone();
    let copies = (0..20_000).map(|i| crate::scene::Body { name: format!("grain {i}"), ..grain.clone() });
    scene.bodies.extend(copies);
    assert_eq!(check(&scene), Ok(()));
    scene.contact.push(ContactRule { restitution: 0.5, ..ContactRule::default() });
    assert_eq!(check(&scene).expect_err("restitution").key, "contact[0].restitution");
}

/// Elastic bodies are on grids of their own where the scene leaves it open, and nothing speaks against it.
#[test]
fn scenes_that_leave_it_open_have_what_fits_their_bodies() {
    let chosen = |bodies: &str| {
        let text = format!(
            r#"
            space.dimension = "plane-strain"
            space.cell = 0.1
            materials.rubber = {{ density = 1, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
            materials.clay = {{ density = 1, von_mises = {{ young_modulus = 1e6, poisson_ratio = 0.3, yield_stress = 1e3 }} }}
            materials.water = {{ density = 1, neo_hookean = {{ bulk_modulus = 1e6, shear_modulus = 0 }} }}
            {bodies}
            "#
        );
        let parsed = crate::scene::parse("a.toml", &text, &[]);
        let scene = parsed.unwrap_or_else(|error| panic!("{error}\n{text}")).scene;
        (scene.interior(0), scene.discretization.because)
    };
    let disk = |name: &str, material: &str, more: &str| {
        format!(
            "[[bodies]]\nname = '{name}'\nmaterial = '{material}'\nshape.ball = {{ center = [0, 0], radius = 1 }}\n{more}\n"
        )
    };
    let time = "time.end = 1";
    let own = chosen(&format!("{time}\n{}", disk("a", "rubber", "")));
    assert_eq!(own, (Interior::Reference, None));
    let clay = chosen(&format!("{time}\n{}{}", disk("a", "rubber", ""), disk("b", "clay", "")));
    assert_eq!(clay, (Interior::Reference, None), "a body that flows is on the common grid beside it");
    let water = chosen(&format!("{time}\n{}{}", disk("a", "rubber", ""), disk("b", "water", "")));
    let why = "`b` is of a material that may flow or part, `neo_hookean`";
    assert_eq!(water, (Interior::Grid, Some(why.to_string())), "a fluid has no surface that it could find");
    let ruled = |rule: &str| {
        let both = disk("a", "rubber", "") + &disk("b", "clay", "");
        chosen(&format!("{time}\ncontact = [{{ {rule} }}]\n{both}"))
    };
    assert_eq!(ruled("cohesion = 1, adhesion = 1, viscosity = 1"), (Interior::Reference, None));
    assert_eq!(
        ruled("law = 'gap'").1.as_deref(),
        Some("`contact[0].law` is \"gap\" between `a` and `b`"),
        "what stands in the way"
    );
    let rigid = disk("b", "clay", "rigid = {}");
    assert_eq!(chosen(&format!("{time}\n{}{rigid}", disk("a", "rubber", ""))).0, Interior::Reference);
    let [far, near, beyond] = ["-2", "-1", "-0.99"].map(|low| {
        let domain = format!("[space.domain]\nmin = [-2, {low}]\nmax = [2, 2]\ny_min = 'fixed'");
        chosen(&format!("{time}\n{domain}\n{}", disk("a", "rubber", "")))
    });
    assert_eq!(far, (Interior::Reference, None));
    assert_eq!(near, (Interior::Reference, None));
    assert_eq!(beyond.0, Interior::Grid);
    assert!(beyond.1.as_ref().is_some_and(|why| why.contains("beyond the face `y_min`")), "{beyond:?}");
    for (top, body, why) in [
        (time, disk("a", "clay", ""), "`a` is of a material that may flow or part, `von_mises`"),
        (time, disk("a", "water", ""), "`a` is of a material that may flow or part, `neo_hookean`"),
        ("time = { end = 1, transfer = 'apic' }", disk("a", "rubber", ""), "`time.transfer` is written"),
    ] {
        let (interior, because) = chosen(&format!("{top}\n{body}"));
        assert_eq!((interior, because.as_deref()), (Interior::Grid, Some(why)));
    }
}
