//! Runs that go on: bit for bit as if nothing had happened, or not at all, and then with the reason.
//!
//! Set-up: two disks, one viscoelastic and one that flows, fall on each other and on a rigid floor without bounds, with
//! friction, a support, a load, a driven rigid paddle, free rigid bodies on joints, and every kind of output; in the
//! plane in both precisions, and balls in space with relaxation.
//!
//! Expected: every file of an interrupted run, but the times in its record and its checkpoints, has the bytes of one
//! that was never interrupted.

#[macro_use]
mod same_run;

use same_run::{StopAfter, assert_same_run, box_of_triangles, files, options, scene, scene_in};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;
use stickslip::observe::{
    Checkpoint, FolderError, Manifest, OutputError, Patience, Results, Status, Waiting, Writer,
};
use stickslip::run::{Progress, ResumeError, RunError, RunOptions, Summary, resume, run, run_with};
use stickslip::scene::Scene;

const PLANE: &str = concat!(
    r#"
gravity = [0, -9.81]
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.1
precision = "double"
[time]
end = 0.4
"#,
    two_disks!(),
    r#"[[bodies]]
name = "flap"
material = "slow"
shape.box = { min = [0.52, 0.1], max = [0.72, 0.7] }
rigid.free = {}
[[bodies]]
name = "pebble"
material = "slow"
shape.ball = { center = [1.2, 0.4], radius = 0.2 }
velocity = [-1.5, -1]
rigid.free = {}
[[joints]]
body = "flap"
hinge = { point = [0.62, 0.7], stiffness = 40, dashpot = 2 }
[[joints]]
name = "string"
body = "flap"
to = "pebble"
spring = { from = [0.7, 0.3], to = [1.2, 0.4], stiffness = 300 }
[[contact]]
between = ["any", "any"]
friction = 0.3
restitution = 0.4
[[supports]]
name = "hook"
body = "high"
within.ball = { center = [0.2, 2.0], radius = 0.15 }
stiffness = 2e3
[[loads]]
name = "wind"
body = "low"
acceleration = ["3 * sin(50 * t)", 0]
[outputs]
tables = 0.004
particles = 0.03
particles_at = [0.1, 0.155]
grid = 0.06
samples = 0.002
time_unit = 0.01
checkpoints = 0.02
"#,
    every_measurement!()
);

const SPACE: &str = r#"
gravity = [0, 0, -9.81]
[space]
dimension = "3d"
interior = "grid"
cell = 0.25
basis = "spline"
domain = { min = [-1, -1, 0], max = [1, 1, 3], z_min = "fixed", y_min = "symmetry" }
[time]
end = 1.6
relax = { residual = 1e-2 }
transfer = "apic"
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
[[bodies]]
name = "low"
material = "rubber"
shape.ball = { center = [0, 0, 0.5], radius = 0.5 }
[[bodies]]
name = "high"
material = "rubber"
shape.ball = { center = [0, 0, 1.5], radius = 0.5 }
[[contact]]
between = ["any", "any"]
friction = 0.3
[outputs]
tables = 0.01
particles = 0.05
checkpoints = 0.05
"#;

/// A block that is struck so hard that steps fail and are taken again, and one that flies out of the domain.
const LOSING: &str = r#"
gravity = [0, -9.81]
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.1
domain = { min = [-1, -2], max = [2, 2], leaving = "remove" }
[time]
end = 0.18
[health]
retries = 6
energy = { then = "cut-step", bound = 0.01 }
[materials.gel]
density = 1000
neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
[[bodies]]
name = "struck"
material = "gel"
shape.box = { min = [-0.95, -0.4], max = [-0.15, 0.4] }
[[bodies]]
name = "gone"
material = "gel"
shape.box = { min = [1.2, 1.0], max = [1.7, 1.5] }
velocity = [6, 0]
spin = 3
[[loads]]
name = "blow"
body = "struck"
on = "x_min"
traction = ["4e6 * exp(-t / 5e-3)", 0]
[outputs]
tables = 0.002
particles = 0.02
checkpoints = 0.01
[[outputs.probes]]
name = "heart"
at = [1.4, 1.3]
fixed_in = "material"
[[outputs.arrivals]]
quantity = "speed"
threshold = 0.2
bodies = ["gone"]
"#;

/// Bodies that begin with a stress between fixed faces, under gravity that changes; one is warmed, a plate is pressed
/// on them by a force, and a strut with a dashpot keeps two apart.
const LOADED: &str = r#"
damping = { local = 0.02 }
gravity = ["2 * sin(30 * t)", { table = [[0, -9.81], ["0.1 s", -2], ["0.3 s", -9.81]] }]
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.1
domain = { min = [-1, 0], max = [1.4, 2.2], y_min = "fixed", x_min = "symmetry" }
[time]
end = 0.3
[materials.soil]
density = 1000
neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
thermal_expansion = 2e-4
[[bodies]]
name = "bed"
material = "soil"
shape.box = { min = [-1, 0], max = [1, 0.5] }
stress = { yy = "-9810 * (0.5 - y)", xx = "-4000 * (0.5 - y)" }
[[bodies]]
name = "post"
material = "soil"
shape.box = { min = [-0.6, 0.5], max = [-0.2, 1.1] }
[[bodies]]
name = "pier"
material = "soil"
shape.box = { min = [0.2, 0.5], max = [0.6, 1.1] }
[[bodies]]
name = "plate"
material = "soil"
shape.box = { min = [-0.7, 1.1], max = [0.7, 1.3] }
rigid.free = {}
[[springs]]
name = "strut"
from = { body = "post", on = "x_max" }
to = { body = "pier", on = "x_min" }
stiffness = 2e3
dashpot = 20
[[joints]]
body = "plate"
slider = { axis = [0, 1] }
[[loads]]
name = "press"
body = "plate"
on = "y_max"
force = [0, "-300 * (1 - exp(-t / 0.05))"]
[[loads]]
name = "sun"
body = "pier"
temperature = "100 * t"
[[contact]]
between = ["any", "any"]
friction = 0.4
[outputs]
tables = 0.005
particles = 0.05
checkpoints = 0.02
reactions = ["y_min", "x_min", "plate"]
"#;

/// A disk flies through the faces, against a layer that has no end between them.
const PERIODIC: &str = r#"
gravity = [0, -9.81]
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.1
[space.domain]
min = [0, -0.5]
max = [1.2, 2]
x_min = "periodic"
x_max = "periodic"
[time]
end = 0.5
[materials.slow]
density = 1000
viscoelastic = { bulk_modulus = 2e5, shear_modulus = 5e4, prony = [[0.4, 0.05]] }
[[bodies]]
name = "disk"
material = "slow"
shape.ball = { center = [1.0, 0.75], radius = 0.25 }
velocity = [3, -2]
[[bodies]]
name = "layer"
material = "slow"
shape.box = { min = [0, 0], max = [1.2, 0.5] }
[[bodies]]
name = "floor"
material = "slow"
shape.half_space = { point = [0, 0], normal = [0, 1] }
rigid.velocity = [0.2, 0]
[[contact]]
friction = 0.4
"#;

/// A plate that a load tears off a fixed face, and a disk that falls on it, in plane stress.
const TORN: &str = r#"
gravity = [0, -9.81]
[space]
dimension = "plane-stress"
interior = "grid"
cell = 0.05
domain = { min = [0, -1], max = [4, 2], x_min = "fixed" }
[time]
end = 0.044
[materials.plaster]
density = 1000
[materials.plaster.damage]
young_modulus = 1e6
poisson_ratio = 0.2
tensile_strength = 5e3
fracture_energy = 4
[[bodies]]
name = "plate"
material = "plaster"
shape.box = { min = [0, 0], max = [0.6, 0.2] }
[[bodies]]
name = "disk"
material = "plaster"
shape.ball = { center = [0.35, 0.33], radius = 0.12 }
velocity = [0, -1]
[[loads]]
name = "pull"
body = "plate"
on = "x_max"
traction = ["8e3 * (1 - exp(-t / 0.01))", 0]
[[contact]]
friction = 0.3
[outputs]
tables = 0.002
particles = 0.02
surfaces = 0.01
checkpoints = 0.01
"#;

/// A block from a file falls on a rigid slab from the same file.
const MESHED: &str = r#"
gravity = [0, 0, -9.81]
[space]
dimension = "3d"
interior = "grid"
cell = 0.125
[time]
end = 0.5
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
[[bodies]]
name = "block"
material = "rubber"
shape.mesh = { file = "box.obj", scale = 0.5, translation = [0.25, 0.25, 0.02] }
velocity = [0.5, 0, -1]
spin = [0, 2, 0]
[[bodies]]
name = "slab"
material = "rubber"
shape.mesh = { file = "box.obj", translation = [0, 0, -1] }
rigid = {}
[[contact]]
friction = 0.3
[outputs]
tables = 0.005
particles = 0.1
surfaces = 0.05
surface_format = "glb"
checkpoints = 0.02
"#;

/// A disk on a grid of its own rolls on a block on one, which lies on a closed face and is squeezed by rigid walls.
const PRESSED: &str = r#"
gravity = [0, -9.81]
[space]
dimension = "plane-strain"
interior = "reference"
cell = 0.1
domain = { min = [-2, 0], max = [2, 3], y_min = "fixed" }
[time]
end = 1
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
[[bodies]]
name = "low"
material = "rubber"
shape.box = { min = [-0.5, 0.01], max = [0.5, 0.41] }
[[bodies]]
name = "high"
material = "rubber"
shape.ball = { center = [0.1, 0.72], radius = 0.3 }
velocity = [0, -1]
spin = 6
[[bodies]]
name = "wall"
material = "rubber"
shape.half_space = { point = [-0.51, 0], normal = [1, 0] }
rigid.velocity = [0.05, 0]
[[bodies]]
name = "stop"
material = "rubber"
shape.half_space = { point = [0.51, 0], normal = [-1, 0] }
rigid = {}
[[contact]]
friction = 0.3
[outputs]
tables = 0.01
particles = 0.2
surfaces = 0.2
checkpoints = 0.1
tractions = { interval = 0.017, bodies = ["low", "high"] }
"#;

fn start(scene: &Scene, out: &Path) -> Result<Summary, RunError> {
    run(scene, &mut *stickslip::step::build(scene).unwrap(), &options(out), &mut |_| {})
}

fn go_on(scene: &Scene, out: &Path) -> Result<Summary, RunError> {
    resume(scene, &mut *stickslip::step::build(scene).unwrap(), &options(out), &mut |_| {})
}

/// Runs a scene and stops it after so many steps.
fn start_and_stop(scene: &Scene, out: &Path, steps: u64) -> Summary {
    let options = options(out);
    let mut stop = StopAfter(steps, options.clone());
    let mut simulation = stickslip::step::build(scene).unwrap();
    run_with(scene, &mut *simulation, &options, &mut [&mut stop], &mut |_| {}).unwrap()
}

#[test]
fn a_stopped_run_goes_on_bit_for_bit() {
    let single = PLANE.replace("double", "single");
    let scenes = [
        (PLANE, 1),
        (PLANE, 97),
        (&single, 40),
        (SPACE, 30),
        (LOSING, 3),
        (LOADED, 50),
        (PERIODIC, 110),
        (PRESSED, 80),
    ];
    for (text, first) in scenes {
        let scene = scene(text);
        let folder = tempfile::tempdir().unwrap();
        let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
        let expected = start(&scene, &whole).unwrap();
        assert!(expected.performance.steps > 150, "{expected}");
        let mut found = start_and_stop(&scene, &parts, first);
        assert_eq!((found.status, found.performance.steps), (Status::Interrupted, first));
        while found.status != Status::Finished {
            let brief = RunOptions { max_time: Some(Duration::from_millis(30)), ..options(&parts) };
            let mut simulation = stickslip::step::build(&scene).unwrap();
            found = resume(&scene, &mut *simulation, &brief, &mut |_| {}).unwrap();
        }
        assert_same_run(&whole, &parts);
        assert_eq!(
            (found.start, found.end, found.energy_scale),
            (expected.start, expected.end, expected.energy_scale)
        );
        assert_eq!(found.contacts, expected.contacts);
        assert!(!Manifest::read(&parts).unwrap().resumed.is_empty());
        let touches = text == PRESSED;
        let last = Results::open(&whole).unwrap().tractions_table().unwrap().pop();
        assert_eq!(last.map(|row| row.time), touches.then_some(expected.performance.time));
        // Once more from its end: there is nothing left to do, and nothing changes.
        go_on(&scene, &parts).unwrap();
        assert_same_run(&whole, &parts);
    }
}

/// With surfaces, meshes, a law that breaks, plane stress, and points of contact.
#[test]
fn a_stopped_run_goes_on_bit_for_bit_with_other_numbers_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("box.obj"), box_of_triangles(1.0)).unwrap();
    for (name, text, first) in [("torn", TORN, 30), ("meshed", MESHED, 55), ("pressed", PRESSED, 60)] {
        let scene = scene_in(folder.path(), text);
        let [whole, parts] = ["whole", "parts"].map(|part| folder.path().join(name).join(part));
        let on = |threads: usize, act: &(dyn Fn() -> Summary + Sync)| {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(act)
        };
        let expected = on(1, &|| start(&scene, &whole).unwrap());
        assert!(expected.performance.steps > 2 * first, "{expected}");
        on(3, &|| start_and_stop(&scene, &parts, first));
        let brief = RunOptions { max_time: Some(Duration::from_millis(20)), ..options(&parts) };
        on(5, &|| {
            let mut simulation = stickslip::step::build(&scene).unwrap();
            resume(&scene, &mut *simulation, &brief, &mut |_| {}).unwrap()
        });
        let found = on(2, &|| go_on(&scene, &parts).unwrap());
        assert_same_run(&whole, &parts);
        assert_eq!((&found.end, found.contacts), (&expected.end, expected.contacts));
        // It did what it is here for.
        assert!(files(&whole).iter().any(|(path, _)| path.starts_with("surfaces")));
        assert!(
            found.end.friction > 0.0 && (found.end.plastic > 0.0 || name != "torn"),
            "{name}: {:?}",
            found.end
        );
    }
}

/// The scene reads the same, and the body is another, if only by a thousandth of a cell at its surface.
#[test]
fn a_mesh_that_has_changed_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (mesh, out) = (folder.path().join("box.obj"), folder.path().join("out"));
    let scene = || scene_in(folder.path(), MESHED);
    fs::write(&mesh, box_of_triangles(1.0)).unwrap();
    start_and_stop(&scene(), &out, 60);
    let before = (files(&out), Manifest::read(&out).unwrap());
    for x in [1.5, 0.75, 1.0001] {
        fs::write(&mesh, box_of_triangles(x)).unwrap();
        let error = go_on(&scene(), &out).unwrap_err();
        let RunError::Resume(ResumeError::Changed { key, .. }) = &error else { panic!("{x}: {error}") };
        assert!(key.starts_with("bodies[0].shape") && key.ends_with("sha256"), "{x}: {key}");
        let help = miette::Diagnostic::help(&error).unwrap().to_string();
        assert!(help.contains("sha256"), "{help}");
        assert!((files(&out), Manifest::read(&out).unwrap()) == before, "{x}: something changed");
    }
    fs::write(&mesh, box_of_triangles(1.0)).unwrap();
    go_on(&scene(), &out).unwrap();
}

#[test]
fn a_run_that_loses_particles_and_takes_steps_again_says_so() {
    let scene = scene(LOSING);
    let folder = tempfile::tempdir().unwrap();
    let summary = start(&scene, folder.path()).unwrap();
    let of = |kind: &str, body: Option<&str>| {
        let mut found = summary.warnings.iter();
        let found = found.find(|warning| warning.kind == kind && warning.body.as_deref() == body);
        found.unwrap_or_else(|| panic!("{kind}: {:?}", summary.warnings)).clone()
    };
    let leaving = of("leaving", Some("gone"));
    assert!(leaving.message.contains("all that there were") && leaving.count > 1, "{leaving:?}");
    assert_eq!(leaving.worst, 100.0, "five by five cells of four particles");
    assert!(leaving.message.contains("the first at t = 5.") && leaving.time > 0.05, "{leaving:?}");
    let failed = of("failed-step", None);
    assert!(failed.message.contains("inverted") && failed.worst >= 2.0, "{failed:?}");
    assert!(failed.time > 0.0 && failed.time < 0.01, "{failed:?}");
    let results = stickslip::observe::Results::open(folder.path()).unwrap();
    let removed = results.removed_table().unwrap();
    let last = removed.last().unwrap();
    assert_eq!((last.body.as_str(), last.particles), ("gone", 100));
    assert!((last.mass - 250.0).abs() < 1e-9 && (last.momentum[0] / 1500.0 - 1.0).abs() < 0.05, "{last:?}");
    let bodies = results.bodies_table().unwrap();
    let masses: Vec<f64> = bodies.iter().filter(|row| row.body == "gone").map(|row| row.state.mass).collect();
    let falls = masses.windows(2).all(|pair| pair[1] <= pair[0] + 1e-9);
    assert!((masses[0] - 250.0).abs() < 1e-9 && falls, "{masses:?}");
    assert_eq!(*masses.last().unwrap(), 0.0);
    assert!(bodies.iter().all(|row| row.state.position.iter().all(|x| x.is_finite())));
    // Snapshots are read back, and the last has none of them.
    let frame = results.frames().last().unwrap().clone();
    assert!(results.particles(&frame).unwrap().body.iter().all(|&body| body != 1));
}

#[test]
fn a_scene_begins_with_what_another_run_has_left() {
    let folder = tempfile::tempdir().unwrap();
    let first = folder.path().join("first");
    let mut short = scene(LOSING);
    short.time.end = 0.06;
    start(&short, &first).unwrap();
    let left = stickslip::observe::Results::open(&first).unwrap().bodies_table().unwrap();
    let mass = left.iter().rfind(|row| row.body == "gone").unwrap().state.mass;
    assert!(mass > 0.0 && mass < 250.0, "{mass}");
    let text = format!("{LOSING}\n[start]\nfrom = {:?}\n", first.display().to_string());
    let out = folder.path().join("second");
    start(&scene(&text), &out).unwrap();
    let bodies = stickslip::observe::Results::open(&out).unwrap().bodies_table().unwrap();
    assert_eq!(bodies.iter().find(|row| row.body == "gone").unwrap().state.mass, mass);
}

#[test]
fn a_finished_run_goes_on_to_a_later_end() {
    let mut scene = scene(PLANE);
    let out = tempfile::tempdir().unwrap();
    scene.time.end = 0.1;
    let first = start(&scene, out.path()).unwrap();
    let rows = |name: &str| fs::read_to_string(out.path().join(name)).unwrap();
    let before = rows("energy.csv");
    scene.time.end = 0.2;
    scene.outputs.tables = 0.002;
    let second = go_on(&scene, out.path()).unwrap();
    assert!(second.performance.steps > first.performance.steps && second.performance.time == 0.2);
    let after = rows("energy.csv");
    // The row at the first end stands there only if it was due.
    let whole: Vec<&str> = before.lines().collect();
    assert!(after.starts_with(&whole[..whole.len() - 1].join("\n")));
    let times: Vec<f64> =
        after.lines().skip(1).map(|row| row.split(',').next().unwrap().parse().unwrap()).collect();
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "no row is lost or doubled");
    assert!(times.len() > 65, "rows come at the new interval: {}", times.len());
    assert_eq!(*times.last().unwrap(), 0.2);
    scene.time.end = 0.15;
    let past = go_on(&scene, out.path()).unwrap_err();
    assert!(matches!(past, RunError::Resume(ResumeError::Past { .. })), "{past}");
}

#[test]
fn another_scene_is_refused_and_nothing_is_changed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    start_and_stop(&scene(PLANE), &out, 60);
    let before = (files(&out), Manifest::read(&out).unwrap());
    for (from, to, key) in [
        ("yield_stress = 2e3", "yield_stress = 3e3", "materials[1].law"),
        ("friction = 0.3", "friction = 0.4", "contact[0].friction"),
        ("cell = 0.1", "cell = 0.05", "discretization.cell"),
        ("time_unit = 0.01", "time_unit = 0.02", "outputs.time_unit"),
        ("width = 90", "width = 80", "outputs.fringes"),
        ("stiffness = 2e3", "stiffness = 3e3", "loads"),
    ] {
        let error = go_on(&scene(&PLANE.replace(from, to)), &out).unwrap_err();
        let RunError::Resume(ResumeError::Changed { key: found, .. }) = &error else {
            panic!("{to}: {error}")
        };
        assert!(found.starts_with(key), "{found} for {key}");
        assert_eq!((files(&out), Manifest::read(&out).unwrap()), before, "{to}");
    }
    let empty = folder.path().join("empty");
    fs::create_dir(&empty).unwrap();
    assert!(matches!(go_on(&scene(PLANE), &empty), Err(RunError::Resume(ResumeError::Unread(_)))));
}

#[test]
fn a_damaged_checkpoint_is_told_of_and_the_one_before_is_taken() {
    let scene = scene(PLANE);
    let folder = tempfile::tempdir().unwrap();
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    start(&scene, &whole).unwrap();
    start_and_stop(&scene, &parts, 120);
    let all = Checkpoint::list(&parts).unwrap();
    assert_eq!(all.len(), 2, "the newest are kept: {all:?}");
    let bytes = fs::read(&all[0]).unwrap();
    let mut told = Vec::new();
    let mut flipped = bytes.clone();
    flipped[bytes.len() / 2] ^= 4;
    for damage in [&flipped[..], &bytes[..bytes.len() / 2], &[]] {
        fs::write(&all[0], damage).unwrap();
        assert!(Checkpoint::read(&all[0]).is_err());
    }
    let mut progress = |progress: &Progress| told.extend(progress.notes.clone());
    let simulation = &mut *stickslip::step::build(&scene).unwrap();
    let summary = resume(&scene, simulation, &options(&parts), &mut progress).unwrap();
    let name = all[0].file_name().unwrap().to_str().unwrap();
    assert!(told[0].contains(name), "{told:?}");
    let warning =
        summary.warnings.iter().find(|warning| warning.kind == "checkpoint").expect("it is recorded");
    assert!(warning.message.contains(name) && warning.count == 1, "{warning:?}");
    assert_same_run(&whole, &parts);

    // It is out of the way, and does not count among those that are kept.
    assert!(!all[0].exists() || Checkpoint::read(&all[0]).is_ok());
    assert!(Checkpoint::list(&parts).unwrap().iter().all(|path| Checkpoint::read(path).is_ok()));

    for path in Checkpoint::list(&parts).unwrap() {
        fs::write(path, "stickslip checkpoint\0no more than that, and too short to be one").unwrap();
    }
    let error = go_on(&scene, &parts).unwrap_err();
    assert!(error.to_string().contains(".checkpoint") && error.to_string().contains("damaged"), "{error}");
}

/// Of a table that was edited, and of a snapshot that was removed: nothing is changed.
#[test]
fn outputs_that_are_not_as_they_were_are_named() {
    let scene = scene(PLANE);
    let out = tempfile::tempdir().unwrap();
    start_and_stop(&scene, out.path(), 100);
    for (name, keep, why) in [("bodies.csv", 3, "bytes where"), ("particles/00000.vtu", usize::MAX, "empty")]
    {
        let path = out.path().join(name);
        let kept = fs::read(&path).unwrap();
        fs::write(&path, &kept[..kept.len() / keep]).unwrap();
        let before = (files(out.path()), Manifest::read(out.path()).unwrap());
        let error = go_on(&scene, out.path()).unwrap_err();
        assert!(matches!(error, RunError::Resume(ResumeError::Misfit(_))), "{error}");
        let file = name.rsplit('/').next().unwrap();
        assert!(error.to_string().contains(file) && error.to_string().contains(why), "{error}");
        assert!(
            (files(out.path()), Manifest::read(out.path()).unwrap()) == before,
            "{name}: something changed"
        );
        fs::write(&path, kept).unwrap();
    }
    go_on(&scene, out.path()).unwrap();
}

#[test]
fn outputs_that_are_left_out_for_a_while_come_back_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    let mut full = scene(PLANE);
    start(&full, &whole).unwrap();
    start_and_stop(&full, &parts, 320);
    let mut bare = full.clone();
    (bare.outputs.particles, bare.outputs.grid, bare.outputs.fringes) = (None, None, None);
    bare.outputs.particles_at.clear();
    bare.outputs.measurements.arrivals.clear();
    bare.time.end = 0.3;
    go_on(&bare, &parts).unwrap();
    full.time.end = 0.4;
    go_on(&full, &parts).unwrap();
    let frames = |out: &Path| stickslip::observe::Results::open(out).unwrap().frames().len();
    assert!(frames(&parts) > 8 && frames(&parts) < frames(&whole), "{}", frames(&parts));
    let [first, second] = [&whole, &parts].map(|out| fs::read(out.join("particles/00003.vtu")).unwrap());
    assert!(first == second, "earlier snapshots are as they were");
    assert_eq!(fs::read(whole.join("arrivals.csv")).unwrap(), fs::read(parts.join("arrivals.csv")).unwrap());
    let table = fs::read_to_string(parts.join("fringes.csv")).unwrap();
    let numbers: Vec<usize> =
        table.lines().skip(1).map(|row| row.split(',').next().unwrap().parse().unwrap()).collect();
    assert_eq!(numbers, (0..numbers.len()).collect::<Vec<_>>());
}

/// Outputs that the checkpoint does not know begin there, also where a run that had them was killed before its own.
/// The format of the scene is for runs that begin.
#[test]
fn surfaces_go_on_in_the_format_that_they_have() {
    let folder = tempfile::tempdir().unwrap();
    let formatted = |format: &str| {
        let surfaces = format!("surfaces = 0.01\nsurface_format = \"{format}\"");
        scene(&TORN.replace("surfaces = 0.01", &surfaces))
    };
    for (first, then) in [("vtu", "glb"), ("glb", "vtp")] {
        let [whole, parts] = ["whole", "parts"].map(|part| folder.path().join(first).join(part));
        start(&formatted(first), &whole).unwrap();
        start_and_stop(&formatted(first), &parts, 30);
        go_on(&formatted(then), &parts).unwrap();
        assert_same_run(&whole, &parts);
        let verified = stickslip::observe::verify(&parts).unwrap();
        assert!(verified.wrong.is_empty(), "{verified:?}");
        let damaged = parts.join(format!("surfaces/00001.{first}"));
        let mut bytes = fs::read(&damaged).unwrap();
        *bytes.last_mut().unwrap() ^= 1;
        fs::write(&damaged, bytes).unwrap();
        assert_eq!(stickslip::observe::verify(&parts).unwrap().wrong[0].path, damaged);
    }
}

#[test]
fn outputs_that_the_checkpoint_does_not_know_begin_there() {
    let folder = tempfile::tempdir().unwrap();
    let parts = folder.path().join("parts");
    let full = scene(PLANE);
    let mut bare = full.clone();
    (bare.outputs.particles, bare.outputs.grid, bare.outputs.fringes) = (None, None, None);
    bare.outputs.particles_at.clear();
    (bare.outputs.measurements.probes, bare.outputs.measurements.arrivals) = (Vec::new(), Vec::new());
    start_and_stop(&bare, &parts, 320);
    let kept: Vec<(PathBuf, Vec<u8>)> = Checkpoint::list(&parts)
        .unwrap()
        .into_iter()
        .map(|path| (path.clone(), fs::read(path).unwrap()))
        .collect();
    let mut outcomes = Vec::new();
    for _ in 0..2 {
        // As if killed before the first checkpoint of what had the outputs.
        for path in Checkpoint::list(&parts).unwrap() {
            fs::remove_file(path).unwrap();
        }
        kept.iter().for_each(|(path, bytes)| fs::write(path, bytes).unwrap());
        go_on(&full, &parts).unwrap();
        outcomes.push(files(&parts));
    }
    assert!(outcomes[0] == outcomes[1]);
    let arrivals = fs::read_to_string(parts.join("arrivals.csv")).unwrap();
    let begun = Manifest::read(&parts).unwrap().resumed[0];
    let times = arrivals.lines().skip(1).map(|row| row.split(',').next().unwrap().parse::<f64>().unwrap());
    assert!(times.clone().all(|time| time > begun + 0.002), "what had come has no row: {arrivals}");
}

/// Of a table with other columns, and of one that is gone: the record of a finished run stays.
#[test]
fn a_resumption_that_fails_changes_nothing() {
    let scene = scene(PLANE);
    let out = tempfile::tempdir().unwrap();
    start(&scene, out.path()).unwrap();
    let before = (files(out.path()), Manifest::read(out.path()).unwrap());
    let table = out.path().join("contacts.csv");
    let text = fs::read_to_string(&table).unwrap();
    for (broken, why) in [(Some(text.replace("normal", "normel")), "other columns"), (None, "No such file")] {
        match broken {
            Some(broken) => fs::write(&table, broken).unwrap(),
            None => fs::remove_file(&table).unwrap(),
        }
        let error = go_on(&scene, out.path()).unwrap_err();
        assert!(matches!(error, RunError::Resume(ResumeError::Misfit(_))), "{error}");
        assert!(error.to_string().contains(why) && error.to_string().contains("contacts.csv"), "{error}");
        fs::write(&table, &text).unwrap();
        assert!((files(out.path()), Manifest::read(out.path()).unwrap()) == before, "{why}");
    }
    // A snapshot that is to be made again may be gone.
    let frames = stickslip::observe::Results::open(out.path()).unwrap().frames().to_vec();
    fs::remove_file(&frames.last().unwrap().path).unwrap();
    go_on(&scene, out.path()).unwrap();
    assert!(files(out.path()) == before.0);
}

/// What was passed before the run went on has no row: nobody knows when.
#[test]
fn an_arrival_that_is_new_must_come_and_others_do_not_come_again() {
    let mut scene = scene(PLANE);
    let out = tempfile::tempdir().unwrap();
    start_and_stop(&scene, out.path(), 120);
    let rows = || fs::read_to_string(out.path().join("arrivals.csv")).unwrap().lines().count();
    let before = rows();
    assert!(before >= 3, "{before}");
    let arrivals = &mut scene.outputs.measurements.arrivals;
    let passed = stickslip::scene::Arrival { threshold: 1e-3, ..arrivals[0].clone() };
    arrivals.push(passed);
    scene.time.end = 0.26;
    go_on(&scene, out.path()).unwrap();
    let text = fs::read_to_string(out.path().join("arrivals.csv")).unwrap();
    assert!(!text.contains(",0.001,"), "{text}");
    let mut keys: Vec<String> = text.lines().map(|row| row.split(',').skip(1).take(4).collect()).collect();
    keys.sort();
    let count = keys.len();
    keys.dedup();
    assert_eq!(keys.len(), count, "{text}");
}

/// Numbers of bodies and lengths that no run has are refused, not used.
#[test]
fn a_state_that_is_none_is_refused() {
    let scene = scene(PLANE);
    let mut simulation = stickslip::step::build(&scene).unwrap();
    for _ in 0..60 {
        simulation.step(1.0).unwrap();
    }
    let saved = serde_json::to_value(simulation.save().unwrap()).unwrap();
    let mut fresh = stickslip::step::build(&scene).unwrap();
    let mut refused = |pointer: &str, value: serde_json::Value| {
        let mut changed = saved.clone();
        *changed.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}")) = value;
        let state = serde_json::from_value(changed).unwrap();
        assert!(fresh.restore(state).is_err(), "{pointer}");
    };
    refused("/contact_sums/pairs/0/bodies", serde_json::json!([98, 99]));
    refused("/contact_sums/pairs/0/largest/body_b", serde_json::json!(77));
    refused("/bodies/3/motion", serde_json::json!(null));
    refused("/bodies/0/numbers/0", serde_json::json!(100_000));
    refused("/bodies/0/numbers", serde_json::json!([0, 1, 2]));
    refused("/bodies/0/columns/0/bytes", serde_json::json!([0, 1, 2]));
    refused("/bodies/0/columns", serde_json::json!([]));
    refused("/bodies/0/columns/0/width", serde_json::json!(0));
    refused("/time", serde_json::json!(-1.0));
    refused("/loads", serde_json::json!([]));
    fresh.restore(serde_json::from_value(saved).unwrap()).unwrap();
    assert_eq!(fresh.snapshot(), simulation.snapshot());
}

/// A frame finds a folder in its place, which is then removed.
#[test]
fn a_run_that_could_not_write_goes_on_once_it_can() {
    let scene = scene(PLANE);
    let folder = tempfile::tempdir().unwrap();
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    start(&scene, &whole).unwrap();
    let place = parts.join("particles/00005.vtu");
    let mut obstacle = Obstacle { place: place.clone(), after: 60 };
    let mut simulation = stickslip::step::build(&scene).unwrap();
    let error = run_with(&scene, &mut *simulation, &options(&parts), &mut [&mut obstacle], &mut |_| {});
    let error = error.unwrap_err();
    assert!(matches!(error, RunError::Output(_)) && error.to_string().contains("00005.vtu"), "{error}");
    fs::remove_dir(&place).unwrap();
    go_on(&scene, &parts).unwrap();
    assert_same_run(&whole, &parts);
}

/// A checkpoint that cannot be written costs the run nothing but a warning.
#[test]
fn a_checkpoint_that_cannot_be_written_is_told_of_and_the_run_goes_on() {
    let mut scene = scene(PLANE);
    // None is due at the end but the last.
    scene.outputs.checkpoints = Some(0.07);
    let folder = tempfile::tempdir().unwrap();
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    let expected = start(&scene, &whole).unwrap();
    let steps = expected.performance.steps;
    let place = Checkpoint::path(&parts, steps);
    let mut obstacle = Obstacle { place: place.clone(), after: steps - 5 };
    let mut simulation = stickslip::step::build(&scene).unwrap();
    let found = run_with(&scene, &mut *simulation, &options(&parts), &mut [&mut obstacle], &mut |_| {});
    let found = found.unwrap();
    assert_eq!(found.status, Status::Finished);
    let warning = found.warnings.iter().find(|warning| warning.kind == "checkpoint").expect("it is told");
    assert!(warning.message.contains(".checkpoint") && warning.message.contains("irectory"), "{warning:?}");
    assert_eq!(files(&whole), files(&parts));
    fs::remove_dir(&place).unwrap();
    let left = fs::read_dir(Checkpoint::folder(&parts)).unwrap().map(|entry| entry.unwrap().path());
    let left: Vec<_> = left.collect();
    assert!(
        !left.is_empty() && left.iter().all(|path| path.extension().unwrap() == "checkpoint"),
        "{left:?}"
    );
    go_on(&scene, &parts).unwrap();
    assert_same_run(&whole, &parts);
}

/// Puts a folder in the place of a file to come.
struct Obstacle {
    place: PathBuf,
    after: u64,
}

impl stickslip::observe::Observer for Obstacle {
    fn next(&self) -> f64 {
        0.0
    }

    fn observe(&mut self, view: &dyn stickslip::door::View) -> Result<(), OutputError> {
        if view.steps() >= self.after {
            fs::create_dir_all(&self.place).unwrap();
        }
        Ok(())
    }
}

#[test]
fn two_runs_do_not_share_a_folder() {
    let scene = scene(PLANE);
    let out = tempfile::tempdir().unwrap();
    let mut inner = None;
    let mut progress = |_: &Progress| {
        inner.get_or_insert_with(|| start(&scene, out.path()));
    };
    run(&scene, &mut *stickslip::step::build(&scene).unwrap(), &options(out.path()), &mut progress).unwrap();
    let error = inner.unwrap().unwrap_err();
    assert!(matches!(error, RunError::Folder(FolderError::InUse { .. })), "{error}");
    start(&scene, out.path()).unwrap();
}

#[test]
fn a_run_stops_when_its_time_is_up_and_goes_on() {
    let scene = scene(PLANE);
    let folder = tempfile::tempdir().unwrap();
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    start(&scene, &whole).unwrap();
    let short = RunOptions { max_time: Some(Duration::from_millis(1)), ..options(&parts) };
    let mut summary =
        run(&scene, &mut *stickslip::step::build(&scene).unwrap(), &short, &mut |_| {}).unwrap();
    assert_eq!(summary.status, Status::OutOfTime);
    for _ in 0..3 {
        summary = resume(&scene, &mut *stickslip::step::build(&scene).unwrap(), &short, &mut |_| {}).unwrap();
    }
    assert!(summary.performance.steps >= 4, "each takes a step at least");
    go_on(&scene, &parts).unwrap();
    assert_same_run(&whole, &parts);
}

/// A writer of its own gets nothing onto the disk: the user is told once, and the end of the run's time holds. Once the
/// disk is back, the run goes on.
#[test]
fn a_disk_that_stands_still_is_told_of_and_does_not_hold_a_run_that_is_to_stop() {
    use std::sync::atomic::AtomicUsize;
    use std::sync::mpsc::{Receiver, channel};
    static TOLD: AtomicUsize = AtomicUsize::new(0);
    struct Stuck(Writer<Receiver<()>>);
    impl stickslip::observe::Observer for Stuck {
        fn next(&self) -> f64 {
            0.0
        }

        fn observe(&mut self, view: &dyn stickslip::door::View) -> Result<(), OutputError> {
            // Until the other end is dropped.
            let write = |disk: &mut Receiver<()>| {
                let _ = disk.recv();
                Ok(())
            };
            if view.steps() >= 60 { self.0.ask(write) } else { Ok(()) }
        }
    }
    let scene = scene(PLANE);
    let folder = tempfile::tempdir().unwrap();
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    start(&scene, &whole).unwrap();
    let patience = Patience {
        told_after: Duration::from_millis(100),
        given_up_after: Duration::from_millis(300),
        tell: |path, _| {
            assert!(path.ends_with("stuck"));
            TOLD.fetch_add(1, Ordering::Relaxed);
        },
        ..Patience::default()
    };
    for interrupted in [false, true] {
        TOLD.store(0, Ordering::Relaxed);
        let (disk, writes) = channel();
        let longest = Duration::from_secs(3);
        let max_time = (!interrupted).then_some(longest);
        let stuck = RunOptions { patience: patience.clone(), max_time, ..options(&parts) };
        let stop = stuck.stop.clone();
        let begun = std::time::Instant::now();
        let until = max_time.map(|longest| begun + longest);
        let waiting = Arc::new(Waiting::new(patience.clone(), stop.clone(), until));
        let mut observer = Stuck(Writer::start(writes, &parts.join("stuck"), &waiting).unwrap());
        let mut simulation = stickslip::step::build(&scene).unwrap();
        let error = std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(longest);
                stop.store(interrupted, Ordering::Relaxed);
            });
            run_with(&scene, &mut *simulation, &stuck, &mut [&mut observer], &mut |_| {}).unwrap_err()
        });
        // An end of time that comes before the sixtieth step is no fault of the disk.
        assert!(error.to_string().contains("stuck: the disk has taken nothing for"), "{error}");
        assert_eq!(TOLD.load(Ordering::Relaxed), 1);
        assert!(begun.elapsed() < Duration::from_secs(20), "{:?}", begun.elapsed());
        assert_eq!(Manifest::read(&parts).unwrap().status, Status::Failed);
        drop(disk);
    }
    go_on(&scene, &parts).unwrap();
    assert_same_run(&whole, &parts);
}

/// The folder is moved away, and another takes its name: the run ends, and writes into neither.
#[test]
#[cfg(unix)]
fn a_folder_that_is_another_now_is_left_alone() {
    struct Move(PathBuf, PathBuf);
    impl stickslip::observe::Observer for Move {
        fn next(&self) -> f64 {
            0.0
        }

        fn observe(&mut self, view: &dyn stickslip::door::View) -> Result<(), OutputError> {
            if view.steps() >= 60 && !self.1.exists() {
                // One from which the run can go on may still be in the hands of the thread that writes.
                while Checkpoint::newest(&self.0).is_err() {
                    std::thread::sleep(Duration::from_millis(1));
                }
                fs::rename(&self.0, &self.1).unwrap();
                fs::create_dir(&self.0).unwrap();
            }
            Ok(())
        }
    }
    let scene = scene(PLANE);
    let folder = tempfile::tempdir().unwrap();
    let [whole, parts, moved] = ["whole", "parts", "moved"].map(|name| folder.path().join(name));
    start(&scene, &whole).unwrap();
    let mut mover = Move(parts.clone(), moved.clone());
    let mut simulation = stickslip::step::build(&scene).unwrap();
    let error =
        run_with(&scene, &mut *simulation, &options(&parts), &mut [&mut mover], &mut |_| {}).unwrap_err();
    assert!(error.to_string().contains("is not where the run began to write"), "{error}");
    assert_eq!(fs::read_dir(&parts).unwrap().count(), 0, "nothing is made in it");
    go_on(&scene, &moved).unwrap();
    assert_same_run(&whole, &moved);
}
