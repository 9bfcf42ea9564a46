//! Scenes that begin as another run left its bodies.
//!
//! Set-up: disks of two materials settle in a box with a gate, in the plane; then, from their checkpoint, scenes with
//! the gate removed, a plunger added, other materials and loads.
//!
//! Expected: particles begin where they were, to the bit, and go on from there as if nothing had happened where nothing
//! is new.

mod same_run;

use same_run::{options, scene};
use std::path::Path;
use stickslip::door::{ParticleSnapshot, Simulation};
use stickslip::observe::Results;
use stickslip::run::{ResumeError, RunError, RunOptions, Summary, resume, run};
use stickslip::scene::{Scene, StartVelocities};

const PACKING: &str = r#"
gravity = [0, -9.81]
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.1
[time]
end = 0.3
[materials.rubber]
density = 1000
viscoelastic = { young_modulus = 3e5, poisson_ratio = 0.3, prony = [[0.4, 0.05]] }
[materials.clay]
density = 1000
von_mises = { young_modulus = 3e5, poisson_ratio = 0.3, yield_stress = 2e3 }
[[bodies]]
name = "low"
material = "clay"
shape.ball = { center = [0, 0.5], radius = 0.5 }
[[bodies]]
name = "high"
material = "rubber"
shape.ball = { center = [0.1, 1.55], radius = 0.5 }
[[bodies]]
name = "floor"
material = "rubber"
shape.half_space = { point = [0, 0], normal = [0, 1] }
rigid = {}
[[bodies]]
name = "gate"
material = "rubber"
shape.box = { min = [0.6, 0.2], max = [0.8, 2.2] }
rigid = { velocity = ["-0.1 * t", 0] }
[[contact]]
between = ["any", "any"]
friction = 0.4
"#;

/// The same with a table that says where bodies begin.
fn from(text: &str, folder: &Path, more: &str) -> Scene {
    scene(&format!("{text}\n[start]\nfrom = {:?}\n{more}", folder.to_str().unwrap()))
}

fn make(scene: &Scene, out: &Path) -> Result<(Summary, Box<dyn Simulation>), RunError> {
    let mut simulation = stickslip::step::build(scene).unwrap();
    let summary = run(scene, &mut *simulation, &options(out), &mut |_| {})?;
    Ok((summary, simulation))
}

fn frame(out: &Path, number: usize) -> ParticleSnapshot {
    let results = Results::open(out).unwrap();
    results.particles(&results.frames()[number]).unwrap()
}

fn last(out: &Path) -> ParticleSnapshot {
    frame(out, Results::open(out).unwrap().frames().len() - 1)
}

/// Places, deformations and stresses of a body, by number.
fn of_body(particles: &ParticleSnapshot, body: u32) -> Vec<([f64; 3], [f64; 9], [f64; 6])> {
    let here = (0..particles.body.len()).filter(|&i| particles.body[i] == body);
    here.map(|i| (particles.position[i], particles.deformation[i], particles.stress[i])).collect()
}

fn without(text: &str, name: &str) -> String {
    let parts: Vec<&str> = text.split("[[bodies]]\n").collect();
    let kept = parts.iter().filter(|part| !part.contains(&format!("name = \"{name}\"")));
    let text = kept.copied().collect::<Vec<_>>().join("[[bodies]]\n");
    if text.contains("[[contact]]") {
        text
    } else {
        text + "[[contact]]\nbetween = [\"any\", \"any\"]\nfriction = 0.4\n"
    }
}

#[test]
fn bodies_begin_where_they_were_beside_new_ones_and_without_others() {
    let folder = tempfile::tempdir().unwrap();
    let [packing, press] = ["packing", "press"].map(|name| folder.path().join(name));
    make(&scene(PACKING), &packing).unwrap();
    let plunger = "[[bodies]]\nname = \"plunger\"\nmaterial = \"rubber\"\nrigid = { velocity = [0, -1] }\n\
                   shape.box = { min = [-0.5, 2.4], max = [0.7, 2.7] }\n[[contact]]";
    let text = without(PACKING, "gate")
        .replace("[[contact]]", plunger)
        .replace("yield_stress = 2e3", "yield_stress = 1e4");
    make(&from(&text, &packing, ""), &press).unwrap();
    let (before, after) = (last(&packing), frame(&press, 0));
    for body in [0, 1] {
        assert!(of_body(&before, body) == of_body(&after, body), "body {body}");
    }
    assert_eq!(before.velocity[..50], after.velocity[..50]);
    let moved = |particles: &ParticleSnapshot| particles.position[5][0] - particles.position[0][0];
    assert!(moved(&last(&press)) != moved(&before));
    let columns =
        |particles: &ParticleSnapshot| particles.history.iter().map(|c| c.name.clone()).collect::<Vec<_>>();
    assert_eq!(columns(&before), columns(&after));
    assert!(before.history.iter().zip(&after.history).all(|(a, b)| a.values[..100] == b.values[..100]));
}

/// But for the length of single steps: the fastest signal is looked for anew, and formulas of time begin anew.
#[test]
fn what_begins_from_a_run_goes_on_as_the_run_does() {
    let text = PACKING.replace("\"-0.1 * t\"", "0");
    let folder = tempfile::tempdir().unwrap();
    let [packing, again] = ["packing", "again"].map(|name| folder.path().join(name));
    let mut scene = scene(&text);
    make(&scene, &packing).unwrap();
    let (mut second, _) = (from(&text, &packing, ""), ());
    second.time.end = 0.1;
    make(&second, &again).unwrap();
    scene.time.end = 0.4;
    resume(&scene, &mut *stickslip::step::build(&scene).unwrap(), &options(&packing), &mut |_| {}).unwrap();
    let (expected, found) = (last(&packing), last(&again));
    let bodies = |particles: &ParticleSnapshot| [0, 1].map(|body| of_body(particles, body)).concat();
    for ((a, f, _), (b, g, _)) in bodies(&expected).iter().zip(&bodies(&found)) {
        assert!(a.iter().zip(b).chain(f.iter().zip(g)).all(|(a, b)| (a - b).abs() < 1e-9), "{a:?} {b:?}");
    }
}

/// A grid elsewhere fills bodies in places that differ by round-off: the run goes on with those of its own scene.
#[test]
fn a_run_that_began_on_another_grid_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let [packing, whole, stopped] = ["packing", "whole", "stopped"].map(|name| folder.path().join(name));
    let on = |corner: &str| {
        let domain = format!("cell = 0.1\ndomain.min = {corner}\ndomain.max = [3, 3]\n");
        without(&without(&PACKING.replace("cell = 0.1\n", &domain), "gate"), "floor")
    };
    make(&scene(&on("[-1.03, -1.07]").replace("end = 0.3", "end = 0.05")), &packing).unwrap();
    let elsewhere = on("[-1.33, -1.97]");
    let of_end = |end: &str| from(&elsewhere.replace("end = 0.3", &format!("end = {end}")), &packing, "");
    make(&of_end("0.08"), &whole).unwrap();
    make(&of_end("0.04"), &stopped).unwrap();
    let scene = of_end("0.08");
    let mut simulation = stickslip::step::build(&scene).unwrap();
    resume(&scene, &mut *simulation, &options(&stopped), &mut |_| {}).unwrap();
    let [whole, stopped] = [whole, stopped].map(|out| last(&out).position);
    // Its steps end at its first end, too.
    let off = whole.as_flattened().iter().zip(stopped.as_flattened()).map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-3);
}

#[test]
fn bodies_may_begin_at_rest_and_with_another_density() {
    let folder = tempfile::tempdir().unwrap();
    let [packing, rest] = ["packing", "rest"].map(|name| folder.path().join(name));
    make(&scene(PACKING), &packing).unwrap();
    let text = PACKING.replacen("density = 1000", "density = 3000", 1);
    make(&from(&text, &packing, "velocities = \"zero\""), &rest).unwrap();
    let (before, after) = (last(&packing), frame(&rest, 0));
    for i in 0..after.body.len() {
        match after.body[i] {
            0 => assert_eq!((after.velocity[i], after.mass[i]), ([0.0; 3], before.mass[i])),
            1 => {
                assert_eq!(after.velocity[i], [0.0; 3]);
                assert!((after.mass[i] / before.mass[i] - 3.0).abs() < 1e-9);
            }
            _ => {}
        }
    }
    assert_eq!(from(PACKING, &packing, "").start.unwrap().velocities, StartVelocities::Kept);
}

/// Whatever the basis of the run that left it.
#[test]
fn the_basis_may_be_another() {
    let folder = tempfile::tempdir().unwrap();
    let with = |basis: &str| PACKING.replacen("cell = 0.1", &format!("cell = 0.1\nbasis = \"{basis}\""), 1);
    for [first, second] in [["gimp", "spline"], ["spline", "gimp"]] {
        let [packing, next] = ["packing", "next"].map(|name| folder.path().join(format!("{first}-{name}")));
        make(&scene(&with(first)), &packing).unwrap();
        let mut begun = from(&with(second), &packing, "");
        begun.time.end = 0.02;
        make(&begun, &next).unwrap();
        let [before, after] = [last(&packing), frame(&next, 0)];
        (0..2).for_each(|body| assert_eq!(of_body(&before, body), of_body(&after, body), "{first}"));
    }
}

/// A fixed support holds bodies where they are now, and a run that began so goes on, with its packing gone.
#[test]
fn supports_hold_what_begins_from_a_run_where_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let [packing, whole, parts] = ["packing", "whole", "parts"].map(|name| folder.path().join(name));
    make(&scene(PACKING), &packing).unwrap();
    let held = PACKING.replace("end = 0.3", "end = 0.05")
        + "[[supports]]\nname = \"hold\"\nbody = \"high\"\non = \"volume\"\n";
    let held = from(&held, &packing, "velocities = \"zero\"");
    make(&held, &whole).unwrap();
    let rows = Results::open(&whole).unwrap().loads_table().unwrap();
    let (first, last_row) = (&rows[0], rows.last().unwrap());
    assert!(
        first.displacement.iter().chain(&last_row.displacement).all(|u| u.abs() < 0.02),
        "{first:?} {last_row:?}"
    );
    let shift = |i: usize| (frame(&whole, 0).position[i][1] - last(&whole).position[i][1]).abs();
    let high = frame(&whole, 0).body.iter().position(|&body| body == 1).unwrap();
    assert!((high..high + 100).all(|i| shift(i) < 0.03), "it stays");

    let brief = RunOptions { max_time: Some(std::time::Duration::from_millis(5)), ..options(&parts) };
    run(&held, &mut *stickslip::step::build(&held).unwrap(), &brief, &mut |_| {}).unwrap();
    std::fs::remove_dir_all(&packing).unwrap();
    resume(&held, &mut *stickslip::step::build(&held).unwrap(), &options(&parts), &mut |_| {}).unwrap();
    assert!(last(&whole) == last(&parts));
}

/// By where bodies begin, not by where they are drawn: a plunger may stand where a disk was, and not where one is.
#[test]
fn bodies_may_not_begin_in_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let [packing, press] = ["packing", "press"].map(|name| folder.path().join(name));
    make(&scene(PACKING), &packing).unwrap();
    let settled = last(&packing);
    let top = settled.position.iter().zip(&settled.body).filter(|(_, body)| **body < 2);
    let top = top.map(|(x, _)| x[1]).fold(0.0, f64::max);
    let plunger = |low: f64| {
        let box_ = format!("min = [-0.3, {low}], max = [0.5, {}]", low + 0.3);
        let body = format!(
            "[[bodies]]\nname = \"plunger\"\nmaterial = \"rubber\"\nrigid = {{}}\nshape.box = {{ {box_} }}\n"
        );
        from(&PACKING.replacen("[[contact]]", &(body + "[[contact]]"), 1), &packing, "")
    };
    let above = top + 0.06;
    assert!(above < 2.05, "where the packing was drawn: {above}");
    make(&plunger(above), &press).unwrap();
    let Err(error) = make(&plunger(top - 0.3), &press) else { panic!("it stands in the disk") };
    assert!(error.to_string().contains("`plunger` overlaps `high` in"), "{error}");
}

/// A grid that begins elsewhere rounds places otherwise; and results may not go where the packing lies.
#[test]
fn a_domain_may_be_new_and_the_folder_must_be() {
    let folder = tempfile::tempdir().unwrap();
    let [packing, wide] = ["packing", "wide"].map(|name| folder.path().join(name));
    make(&scene(PACKING), &packing).unwrap();
    let text =
        PACKING.replacen("cell = 0.1", "cell = 0.1\ndomain = { min = [-5.3, -5.1], max = [5.3, 5.1] }", 1);
    make(&from(&text, &packing, ""), &wide).unwrap();
    let Err(error) = make(&from(PACKING, &packing, ""), &packing) else { panic!("it is its own packing") };
    assert!(matches!(error, RunError::Resume(ResumeError::Itself { .. })), "{error}");
    assert!(!last(&packing).body.is_empty(), "it is still there");
}

/// What flowed would spring back with a law that does not know of it; and a floor stands where it is drawn.
#[test]
fn plastic_strain_is_not_forgotten_and_a_floor_may_be_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let [packing, next] = ["packing", "next"].map(|name| folder.path().join(name));
    make(&scene(PACKING), &packing).unwrap();
    let elastic = PACKING.replace(
        "von_mises = { young_modulus = 3e5, poisson_ratio = 0.3, yield_stress = 2e3 }",
        "neo_hookean = { young_modulus = 3e5, poisson_ratio = 0.3 }",
    );
    let Err(error) = make(&from(&elastic, &packing, ""), &next) else { panic!("it flowed") };
    assert!(
        error.to_string().contains("does not remember") && error.to_string().contains("`low`"),
        "{error}"
    );
    let lower = PACKING
        .replace("point = [0, 0], normal", "point = [0, -0.2], normal")
        .replace("end = 0.3", "end = 0.1");
    make(&from(&lower, &packing, "velocities = \"zero\""), &next).unwrap();
    let [first, end] = [frame(&next, 0), last(&next)];
    let low = |particles: &ParticleSnapshot| {
        let of_low = (0..particles.body.len()).filter(|&i| particles.body[i] == 0);
        of_low.map(|i| particles.position[i][1]).fold(f64::INFINITY, f64::min)
    };
    // g t^2 / 2 is 0.049 m.
    assert!(low(&first) - low(&end) > 0.03, "it falls: {} {}", low(&first), low(&end));
}

#[test]
fn a_body_of_another_shape_is_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let [packing, other] = ["packing", "other"].map(|name| folder.path().join(name));
    make(&scene(PACKING), &packing).unwrap();
    for (from_text, to, why) in [
        (
            "center = [0.1, 1.55], radius = 0.5",
            "center = [0.1, 1.55], radius = 0.4",
            "particles in the scene",
        ),
        ("center = [0.1, 1.55]", "center = [0.1, 1.65]", "began elsewhere"),
        ("cell = 0.1", "cell = 0.05", "particles in the scene"),
    ] {
        let Err(error) = make(&from(&PACKING.replace(from_text, to), &packing, ""), &other) else {
            panic!("{to}")
        };
        assert!(matches!(error, RunError::Resume(ResumeError::Begin { .. })), "{error}");
        assert!(error.to_string().contains(why), "{error}");
        assert!(!other.exists());
    }
    let Err(error) = make(&from(PACKING, &folder.path().join("nowhere"), ""), &other) else {
        panic!("nothing there")
    };
    assert!(error.to_string().contains("nowhere"), "{error}");
}

/// A plunger that has come down, and a rigid ball that fell, turned and rolled.
const RIGID: &str = r#"
[[bodies]]
name = "plunger"
material = "rubber"
rigid = { velocity = [0, "-0.3"], spin = "0.5" }
shape.box = { min = [-0.5, 2.6], max = [0.5, 2.8] }
[[bodies]]
name = "pebble"
material = "rubber"
shape.ball = { center = [-0.9, 0.4], radius = 0.25 }
velocity = [0.2, 0]
spin = -2
rigid.free = {}
[[contact]]"#;

/// The packing with all rigid bodies, and snapshots of this kind.
fn packing_with(snapshots: &str) -> String {
    PACKING.replacen("[[contact]]", RIGID.trim_start(), 1) + "[outputs]\nparticles = 0.05\n" + snapshots
}

/// The last snapshot of a run, and one of its times.
fn last_frame(out: &Path) -> (std::path::PathBuf, f64) {
    let frame = Results::open(out).unwrap().frames().last().unwrap().clone();
    (frame.path, frame.time)
}

/// A snapshot without compression has no sums of its own; the newest checkpoint has them.
#[test]
fn a_changed_snapshot_is_no_beginning() {
    let plain =
        packing_with("[outputs.snapshots]\ncompression = \"none\"\n").replace("end = 0.3", "end = 0.1");
    let folder = tempfile::tempdir().unwrap();
    let [packing, next] = ["packing", "next"].map(|name| folder.path().join(name));
    make(&scene(&plain), &packing).unwrap();
    let file = Results::open(&packing).unwrap().frames()[1].path.clone();
    make(&from(&plain, &file, ""), &next).unwrap();
    let mut bytes = std::fs::read(&file).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&file, bytes).unwrap();
    for scene in [from(&plain, &file, ""), from(&plain, &packing, "at = 0.05")] {
        let error = make(&scene, &folder.path().join("last")).map(drop).unwrap_err().to_string();
        assert!(error.contains("00001.vtu") && error.contains("bytes of it have changed"), "{error}");
    }
}

/// From the snapshot of the end as from the checkpoint there: bodies that deform to the bit in double precision, rigid
/// ones as their particles say; in single precision to that. At rest nothing else is missing, and the runs stay together.
#[test]
fn a_snapshot_begins_as_the_checkpoint_of_its_time_does() {
    let double = "[outputs.snapshots]\nprecision = \"double\"\n";
    let short = packing_with(double).replace("end = 0.3", "end = 0.02").replace("s = 0.05", "s = 0.01");
    let rest = "velocities = \"zero\"";
    for (snapshots, near, later) in [(double, 1e-12, 1e-11), ("", 1e-6, 1e-5)] {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        let packing = place("packing");
        make(&scene(&packing_with(snapshots)), &packing).unwrap();
        let (file, time) = last_frame(&packing);
        make(&from(&short, &packing, ""), &place("exact")).unwrap();
        make(&from(&short, &file, ""), &place("rounded")).unwrap();
        // The nearest is taken.
        make(&from(&short, &packing, &format!("at = {}", time - 0.01)), &place("timed")).unwrap();
        assert!(last(&place("rounded")) == last(&place("timed")));

        let [expected, found] = ["exact", "rounded"].map(|name| frame(&place(name), 0));
        assert_eq!((&expected.body, &expected.number), (&found.body, &found.number));
        let columns = expected.columns().zip(found.columns()).map(|((c, a), (_, b))| (c.name, c.kind, a, b));
        let history = expected.history.iter().zip(&found.history);
        let history = history.map(|(a, b)| (a.name.as_str(), a.kind, &a.values[..], &b.values[..]));
        let mut checked = 0;
        for (name, kind, expected_values, found_values) in columns.chain(history) {
            let largest = expected_values.iter().fold(1e-9, |largest: f64, x| largest.max(x.abs()));
            for (i, (a, b)) in expected_values.iter().zip(found_values).enumerate() {
                // How a free rigid body moves follows from its particles, which are moved by steps.
                let near = if expected.body[i / kind.components()] < 2 { near } else { f64::max(near, 1e-9) };
                assert!((a - b).abs() <= near * largest, "{name}: {a} {b} of {largest}");
            }
            checked += 1;
        }
        assert!(checked >= 8, "{checked} columns");

        make(&from(&short, &packing, rest), &place("exact at rest")).unwrap();
        make(&from(&short, &file, rest), &place("rounded at rest")).unwrap();
        let deformed = |particles: &ParticleSnapshot| [0, 1].map(|body| of_body(particles, body)).concat();
        let off = |runs: [&str; 2]| {
            let [expected, found] = runs.map(|name| deformed(&last(&place(name))));
            let off = expected.iter().zip(&found);
            let off = off.flat_map(|((a, ..), (b, ..))| (0..3).map(|k| (a[k] - b[k]).abs()));
            off.fold(0.0, f64::max)
        };
        let (off, going_on) = (off(["exact at rest", "rounded at rest"]), off(["exact", "rounded"]));
        println!("after 0.02 s places are within {off:.1e} m of those from the checkpoint");
        println!("and with all velocities kept within {going_on:.1e} m");
        assert!(going_on < 5e-3, "{going_on}");
        assert!(off < later, "{off}");
    }
}

/// Bodies that spin go on with all of their angular momentum: a disk and a ball of 2.5 cells radius, whose particles
/// have a ninth of it themselves, and a rod that is one particle thick, whose particles stand on a line.
#[test]
fn bodies_spin_on_from_a_snapshot() {
    let bodies = [
        ("plane-strain", "ball = { center = [0, 0], radius = 0.25 }", "spin = 3"),
        ("3d", "ball = { center = [0, 0, 0], radius = 0.25 }", "spin = [1, -2, 3]"),
        ("3d", "box = { min = [-0.3, -0.05, -0.05], max = [0.3, 0.05, 0.05] }", "spin = [0, 2, 3]"),
    ];
    for (dimension, shape, spin) in bodies {
        let text = format!(
            r#"
            [space]
            dimension = "{dimension}"
            cell = 0.1
            [time]
            end = 0.02
            [materials.rubber]
            density = 1000
            neo_hookean = {{ bulk_modulus = "1 MPa", shear_modulus = "0.5 MPa" }}
            [[bodies]]
            name = "top"
            material = "rubber"
            shape.{shape}
            {spin}
            {}
            [outputs]
            particles = 0.02
            [outputs.snapshots]
            precision = "double"
            "#,
            if shape.starts_with("box") { "particles_per_side = 1" } else { "" }
        );
        let folder = tempfile::tempdir().unwrap();
        let [whole, onward] = ["whole", "onward"].map(|name| folder.path().join(name));
        let left = make(&scene(&text), &whole).unwrap().1.ledger().angular_momentum;
        let soon = text.replace("end = 0.02", "end = 1e-9");
        let found =
            make(&from(&soon, &last_frame(&whole).0, ""), &onward).unwrap().1.ledger().angular_momentum;
        let size = left.iter().map(|x| x * x).sum::<f64>().sqrt();
        for (a, b) in left.into_iter().zip(found) {
            assert!((a - b).abs() < 2e-3 * size, "{shape}: {left:?} was left, {found:?} found");
        }
    }
}

/// What a snapshot was not asked to have is listed with the key that left it out; nothing is written.
#[test]
fn a_snapshot_that_lacks_something_is_refused_with_all_that_it_lacks() {
    let folder = tempfile::tempdir().unwrap();
    let other = folder.path().join("other");
    for (i, (snapshots, scene_edit, missing)) in [
        (
            "columns = [\"velocity\", \"stress\", \"plastic_strain\"]",
            "",
            &["`deformation`", "`mass`", "snapshots.columns"][..],
        ),
        (
            "columns = [\"velocity\", \"stress\", \"deformation\", \"mass\", \"volume\"]",
            "",
            &["`plastic_strain`"],
        ),
        (
            "columns = [\"velocity\", \"stress\", \"deformation\", \"mass\", \"volume\"]",
            "neo_hookean = { young_modulus = 3e5, poisson_ratio = 0.3 }",
            &["all that the law of `low` remembered"],
        ),
        ("every = 3", "", &["each 3th particle", "snapshots.every"]),
        ("bodies = [\"low\", \"gate\", \"floor\"]", "", &["the body `high`", "snapshots.bodies"]),
    ]
    .into_iter()
    .enumerate()
    {
        let packing = folder.path().join(format!("packing {i}"));
        let text = PACKING.to_owned() + "[outputs.snapshots]\n" + snapshots + "\n";
        make(&scene(&text.replace("end = 0.3", "end = 0.03")), &packing).unwrap();
        let law = "von_mises = { young_modulus = 3e5, poisson_ratio = 0.3, yield_stress = 2e3 }";
        let text = if scene_edit.is_empty() { PACKING.to_owned() } else { PACKING.replace(law, scene_edit) };
        let Err(error) = make(&from(&text, &last_frame(&packing).0, ""), &other) else {
            panic!("{snapshots}")
        };
        assert!(matches!(error, RunError::Resume(ResumeError::Lacks { .. })), "{error}");
        assert!(missing.iter().all(|what| error.to_string().contains(what)), "{error}");
        assert!(!other.exists());
    }
}

/// Where a body began is in no snapshot: the record of the run says what it was.
#[test]
fn a_snapshot_of_another_shape_or_of_nowhere_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [packing, other] = ["packing", "other"].map(|name| folder.path().join(name));
    let text = PACKING.replace("end = 0.3", "end = 0.03");
    make(&scene(&text), &packing).unwrap();
    let (file, _) = last_frame(&packing);
    let stray = folder.path().join("00000.vtu");
    std::fs::copy(&file, &stray).unwrap();
    let grid = packing.join("particles/00077.vtu");
    std::fs::copy(&file, &grid).unwrap();
    for (text, place, more, why) in [
        (text.replace("center = [0.1, 1.55]", "center = [0.1, 1.65]"), &file, "", "another shape"),
        (text.replace("cell = 0.1", "cell = 0.05"), &file, "", "another filling"),
        (text.replace("rigid = {}", "rigid = { velocity = [0, 1] }"), &file, "", "no bounds and moves"),
        (text.clone(), &stray, "", "run.json"),
        (text.clone(), &grid, "", "none of the snapshots"),
        (text.clone(), &packing, "at = 7", "allowed: 0 s to"),
    ] {
        let Err(error) = make(&from(&text, place, more), &other) else { panic!("{why}") };
        assert!(error.to_string().contains(why), "{why}: {error}");
        assert!(!other.exists());
    }
}

/// The largest stretch so far counts where positions are held against it: it goes with the bodies.
#[test]
fn the_stretch_of_bodies_so_far_goes_with_them() {
    let folder = tempfile::tempdir().unwrap();
    let [packing, next] = ["packing", "next"].map(|name| folder.path().join(name));
    // With free rigid bodies a run has steps enough to be looked at.
    let text = packing_with("");
    make(&scene(&text), &packing).unwrap();
    let text = without(&text, "gate").replace("end = 0.3", "end = 1e-5");
    make(&from(&text, &packing, "velocities = \"zero\""), &next).unwrap();
    let [before, after] = [&packing, &next].map(|out| {
        let (mut checkpoint, path, _) = stickslip::observe::Checkpoint::newest(out).unwrap();
        let mut largest: Vec<f64> = Vec::new();
        checkpoint
            .memory(&path)
            .part("verdict", |memory| memory.part("strain", |memory| memory.keep("largest", &mut largest)))
            .unwrap();
        largest
    });
    assert!(before[..2].iter().all(|&stretch| stretch > 1e-3), "{before:?}");
    // The first look adds what has stretched since.
    let grown = before[..2].iter().zip(&after[..2]).map(|(before, after)| after / before - 1.0);
    assert!(grown.clone().all(|grown| (0.0..1e-6).contains(&grown)), "{before:?} {after:?}");
}
