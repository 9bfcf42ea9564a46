//! Runs that several ranks share: the files of one, byte by byte, whatever it writes.
//!
//! Set-up: two disks, one viscoelastic and one that flows, fall on each other and on a rigid floor without bounds with
//! friction, beside a driven rigid paddle and a mirror, with every kind of output; a disk that flies through the faces
//! of a periodic domain; a block from a mesh that falls on another one in space; bodies under loads, on supports and
//! springs; bodies that lose particles; free rigid bodies, with joints and without. By one rank, and by two and three
//! that are threads of the test; stopped, and taken up by another number of ranks; and a scene that begins from another
//! run.
//!
//! Expected: every file has the bytes of one rank's. No tolerance.

#[macro_use]
mod same_run;

use same_run::{StopAfter, assert_same_run, box_of_triangles, options, scene_in};
use std::fs;
use std::path::Path;
use std::sync::atomic::Ordering;
use stickslip::door::Simulation;
use stickslip::observe::{Checkpoint, PROGRAM, Results, Status};
use stickslip::run::{RunError, Summary, resume, run, run_with};
use stickslip::scene::Scene;
use stickslip::shared::among_threads;

const PLANE: &str = concat!(
    r#"
gravity = [0, -9.81]
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.1
domain = { min = [-2, -1], max = [3, 4], x_min = "symmetry" }
[time]
end = 0.3
[health]
retries = 2
"#,
    two_disks!(),
    r#"[[contact]]
between = ["any", "any"]
friction = 0.3
[outputs]
tables = 0.004
particles = 0.03
particles_at = [0.1, 0.155]
grid = 0.06
surfaces = 0.1
samples = 0.002
time_unit = 0.01
checkpoints = 0.02
reactions = ["paddle"]
"#,
    every_measurement!(),
    r#"[[outputs.arrivals]]
quantity = "speed"
threshold = 0.1
reading = "mean"
bodies = ["low"]
"#
);

const PERIODIC: &str = r#"
gravity = [0, -9.81]
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.1
precision = "single"
domain = { min = [0, 0], max = [1.2, 2], x_min = "periodic", x_max = "periodic", y_min = "fixed" }
[time]
end = 0.3
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
name = "lid"
material = "slow"
shape.half_space = { point = [0, 1.1], normal = [0, -1] }
rigid = { velocity = [0.2, -1.5] }
[[contact]]
friction = 0.4
[outputs]
tables = 0.01
particles = 0.1
grid = 0.07
checkpoints = 0.05
"#;

const MESHED: &str = r#"
gravity = [0, 0, -9.81]
[space]
dimension = "3d"
interior = "grid"
cell = 0.125
[time]
end = 0.2
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
shape.box = { min = [0, 0, -1], max = [1, 1, 0] }
rigid = {}
[[contact]]
friction = 0.3
[outputs]
tables = 0.005
particles = 0.1
grid = 0.06
surfaces = 0.05
surface_format = "glb"
checkpoints = 0.02
"#;

/// Bodies that begin with a stress between faces whose reactions are asked for, under gravity that changes: one is
/// pressed and hung on a spring, one is warmed, and a strut keeps them apart.
const LOADED: &str = r#"
damping = { local = 0.02 }
gravity = ["2 * sin(30 * t)", { table = [[0, -9.81], ["0.1 s", -2], ["0.3 s", -9.81]] }]
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.1
domain = { min = [-1, 0], max = [1.4, 2.2], y_min = "fixed", x_min = "symmetry" }
[time]
end = 0.2
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
[[springs]]
name = "strut"
from = { body = "post", on = "x_max" }
to = { body = "pier", on = "x_min" }
stiffness = 2e3
dashpot = 20
[[supports]]
name = "hook"
body = "post"
on = "x_min"
stiffness = 2e4
dashpot = 10
[[loads]]
name = "press"
body = "pier"
on = "y_max"
traction = [0, "-3000 * (1 - exp(-t / 0.05))"]
[[loads]]
name = "wind"
body = "bed"
acceleration = ["3 * sin(50 * t)", 0]
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
reactions = ["y_min", "x_min"]
"#;

/// Blocks on each other, one of which is loaded where it touches the other: of two ranks each has one block.
const STACKED: &str = r#"
gravity = [0, -9.81]
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.1
basis = "linear"
[time]
end = 0.3
[materials.gel]
density = 1000
neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
[[bodies]]
name = "low"
material = "gel"
shape.box = { min = [0, 0.03], max = [0.8, 2.43] }
[[bodies]]
name = "high"
material = "gel"
shape.box = { min = [0, 2.43], max = [0.8, 4.83] }
[[supports]]
name = "foot"
body = "low"
on = "y_min"
stiffness = 1e5
[[supports]]
name = "side"
body = "high"
on = "x_min"
stiffness = 2e4
[[loads]]
name = "drive"
body = "high"
acceleration = ["2 * sin(100 * t)", -5]
[[loads]]
name = "sole"
body = "high"
on = "y_min"
traction = ["300 * sin(200 * t)", -200]
[[contact]]
friction = 0.3
[outputs]
tables = 0.002
particles = 0.05
checkpoints = 0.05
"#;

/// A body that a blow drives through an open face, particle by particle, and one that flies through it.
const LOSING: &str = r#"
gravity = [0, -9.81]
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.1
domain = { min = [-1, -1], max = [2, 2], leaving = "remove" }
[time]
end = 0.2
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
traction = ["4e5 * exp(-t / 5e-3)", 0]
[outputs]
tables = 0.002
particles = 0.02
checkpoints = 0.01
"#;

/// Free rigid bodies for the scene above: a flap on a hinge, a pebble that a string holds to it, a plate that is
/// pressed onto a disk, and a nail that a spring pulls to one.
const MECHANISM: &str = r#"
[[bodies]]
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
[[bodies]]
name = "plate"
material = "slow"
shape.box = { min = [-0.4, 2.05], max = [0.9, 2.35] }
rigid.free = { mass = 800 }
[[bodies]]
name = "nail"
material = "slow"
shape.box = { min = [1.6, 1.0], max = [1.9, 1.3] }
rigid.free = {}
[[joints]]
body = "flap"
hinge = { point = [0.62, 0.7], stiffness = 40, dashpot = 2 }
[[joints]]
name = "string"
body = "flap"
to = "pebble"
spring = { from = [0.7, 0.3], to = [1.2, 0.4], stiffness = 300 }
[[loads]]
name = "press"
body = "plate"
on = "y_max"
traction = [0, "-2000 * (1 - exp(-t / 0.05))"]
[[springs]]
name = "pull"
from = { body = "nail", on = "x_min" }
to = { body = "high", on = "x_max" }
stiffness = 3e3
"#;

/// A rigid block and rigid balls that fall on a soft one and on each other.
const DROPPED: &str = r#"
gravity = [0, 0, "-9.81 * (1 + 0.3 * sin(60 * t))"]
[space]
dimension = "3d"
interior = "grid"
cell = 0.125
basis = "linear"
[time]
end = 0.15
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
[[bodies]]
name = "bed"
material = "rubber"
shape.box = { min = [0, 0, 0], max = [1.5, 1, 0.5] }
[[bodies]]
name = "block"
material = "rubber"
shape.box = { min = [0.2, 0.2, 0.52], max = [0.8, 0.7, 0.9] }
velocity = [1, 0, -1]
rigid.free = {}
[[bodies]]
name = "ball {i}"
repeat = { i = 3 }
material = "rubber"
shape.ball = { center = ["0.3 + 0.45 * i", "0.4 + 0.05 * i", 1.15], radius = 0.2 }
velocity = [0, 0, -2]
spin = [0, 3, 1]
rigid.free = {}
[[contact]]
friction = 0.3
[outputs]
tables = 0.005
particles = 0.05
checkpoints = 0.02
[outputs.fringes]
interval = 0.04
exposure = 0.02
samples = 3
stress_optic_coefficient = 1e-8
light = "white"
width = 70
overlay = "force-chains"
"#;

/// Bodies on grids of their own on a floor: one that a support holds and a load drives, one of another law that spins
/// on it with friction that has a memory, a heavy one beside them; and one on the common grid that meets none of them.
const APART: &str = r#"
gravity = [0, -9.81]
damping = { viscous = 0.5 }
[space]
dimension = "plane-strain"
cell = 0.1
interior = "reference"
[time]
end = 0.2
[materials.gel]
density = 1000
neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
[materials.slow]
density = 1500
viscoelastic = { bulk_modulus = 2e5, shear_modulus = 5e4, prony = [[0.4, 0.05]] }
[[bodies]]
name = "base"
material = "gel"
shape.box = { min = [-0.5, 0.01], max = [0.5, 0.41] }
[[bodies]]
name = "roller"
material = "slow"
shape.ball = { center = [0.1, 0.72], radius = 0.3 }
velocity = [0, -1]
spin = 6
[[bodies]]
name = "large"
material = "gel"
shape.ball = { center = [1.5, 0.8], radius = 0.8 }
velocity = [-0.5, -0.5]
[[bodies]]
name = "alone"
interior = "grid"
material = "slow"
shape.ball = { center = [0.0, 2.5], radius = 0.3 }
[[bodies]]
name = "floor"
material = "gel"
shape.half_space = { point = [0, 0], normal = [0, 1] }
rigid = {}
[[supports]]
name = "foot"
body = "base"
on = "x_min"
stiffness = 2e4
dashpot = 10
[[loads]]
name = "wind"
body = "base"
acceleration = ["3 * sin(50 * t)", 0]
[[contact]]
between = ["alone", "any"]
law = "none"
[[contact]]
between = ["any", "any"]
friction = 0.3
friction_memory_length = 0.002
friction_memory_speed = 0.1
[outputs]
tables = 0.004
particles = 0.05
surfaces = 0.1
samples = 0.01
checkpoints = 0.02
tractions.interval = 0.007
"#;

/// A scene beside a mesh of a cube.
fn scene(folder: &Path, text: &str) -> Scene {
    fs::write(folder.join("box.obj"), box_of_triangles(1.0)).unwrap();
    scene_in(folder, text)
}

/// What the first of so many ranks gives, which share the simulation of a scene.
fn among<X: Send>(scene: &Scene, count: usize, act: impl FnOnce(&mut dyn Simulation) -> X + Send) -> X {
    among_threads(scene, (count, PROGRAM), |simulation| act(&mut *simulation.expect("ranks can share it")))
}

fn try_start(scene: &Scene, count: usize, out: &Path) -> Result<Summary, RunError> {
    let go = |simulation: &mut dyn Simulation| run(scene, simulation, &options(out), &mut |_| {});
    match count {
        1 => go(&mut *stickslip::step::build(scene).unwrap()),
        count => among(scene, count, go),
    }
}

fn start(scene: &Scene, count: usize, out: &Path) -> Summary {
    try_start(scene, count, out).unwrap_or_else(|error| panic!("{error}"))
}

/// The scene of a text that begins from a run.
fn begun(folder: &Path, text: &str, (from, more): (&Path, &str)) -> Scene {
    scene(folder, &format!("{text}\n[start]\nfrom = {:?}\n{more}", from.to_str().unwrap()))
}

#[test]
fn ranks_write_what_one_writes() {
    let first = LOADED.replace("end = 0.2", "end = 0.2\nstress_update = \"first\"");
    let unmirrored =
        LOADED.replace(", x_min = \"symmetry\"", "").replace("[\"y_min\", \"x_min\"]", "[\"y_min\"]");
    assert!(!unmirrored.contains("symmetry"));
    let mechanism = [PLANE, MECHANISM].concat();
    // Nothing but rigid bodies: no grid.
    let carriage = include_str!("../../scenes/carriage.toml").replace("end = \"3 s\"", "end = 0.3");
    let scenes = [
        ("plane", PLANE),
        ("periodic", PERIODIC),
        ("meshed", MESHED),
        ("loaded", LOADED),
        ("loaded, first", &first),
        ("loaded, without a mirror", &unmirrored),
        ("stacked", STACKED),
        ("losing", LOSING),
        ("mechanism", &mechanism),
        ("dropped", DROPPED),
        ("carriage", &carriage),
        ("apart", APART),
    ];
    for (name, text) in scenes {
        let folder = tempfile::tempdir().unwrap();
        let scene = scene(folder.path(), text);
        let alone = folder.path().join("1");
        let expected = start(&scene, 1, &alone);
        assert!(expected.performance.steps > 50, "{name}: {expected}");
        for count in 2..=3 {
            let shared = folder.path().join(count.to_string());
            let found = start(&scene, count, &shared);
            assert_same_run(&alone, &shared);
            assert_eq!((found.start, found.end), (expected.start.clone(), expected.end.clone()));
            assert_eq!(found.contacts, expected.contacts);
            let shares = found.performance.ranks;
            assert_eq!(shares.len(), count);
            let particles: usize = shares.iter().map(|share| share.particles).sum();
            assert_eq!(particles, expected.performance.particles);
            assert!(shares.iter().all(|share| share.particles < particles && share.computed > 0.0));
        }
    }
}

/// Stopped on two ranks, taken up by three, and by one; on one, taken up by two.
#[test]
fn a_run_goes_on_with_another_number_of_ranks() {
    [PLANE, APART].into_iter().for_each(goes_on_with_others);
}

fn goes_on_with_others(text: &str) {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), text);
    let whole = folder.path().join("whole");
    start(&scene, 1, &whole);
    for [first, second, third] in [[2, 3, 1], [1, 2, 2]] {
        let parts = folder.path().join(format!("{first} {second} {third}"));
        let stopped = |simulation: &mut dyn Simulation, steps: u64| {
            let options = options(&parts);
            let mut stop = StopAfter(steps, options.clone());
            match steps {
                40 => run_with(&scene, simulation, &options, &mut [&mut stop], &mut |_| {}),
                _ => resume(&scene, simulation, &options, &mut |_| {}),
            }
        };
        let by = |count: usize, steps: u64| -> Result<Summary, RunError> {
            match count {
                1 => stopped(&mut *stickslip::step::build(&scene).unwrap(), steps),
                count => among(&scene, count, |simulation| stopped(simulation, steps)),
            }
        };
        assert_eq!(by(first, 40).unwrap().status, Status::Interrupted);
        // The newest but one, so that another number of ranks goes further.
        assert_eq!(by(second, 0).unwrap().status, Status::Finished);
        assert_same_run(&whole, &parts);
        let checkpoints = Checkpoint::list(&parts).unwrap();
        fs::remove_file(checkpoints.last().unwrap()).unwrap();
        assert_eq!(by(third, 0).unwrap().status, Status::Finished);
        assert_same_run(&whole, &parts);
    }
}

/// Snapshots in several pieces, of all particles and of some, and a checkpoint in several sections of each rank, which
/// another number of ranks takes up.
#[test]
fn ranks_share_files_of_many_particles() {
    let text = |snapshots: &str| {
        let body = |name: &str, x: f64, side: f64| {
            format!(
                "[[bodies]]\nname = {name:?}\nmaterial = \"gel\"\nvelocity = [1, 2]\n\
                 shape.box = {{ min = [{x}, 0], max = [{}, {side}] }}\n",
                x + side
            )
        };
        let bodies = [body("first", 0.0, 14.0), body("middle", 20.0, 14.0), body("last", 40.0, 6.0)].concat();
        format!(
            "space = {{ dimension = \"plane-strain\", interior = \"grid\", cell = 0.1 }}\ntime = {{ end = 0.02 }}\n\
             materials.gel = {{ density = 1000, neo_hookean = {{ young_modulus = 1e4, poisson_ratio = 0.3 }} }}\n\
             outputs = {{ particles = 0.01, snapshots = {{ {snapshots} }}, \
             fringes = {{ interval = 0.005, stress_parameter = 1e3, width = 200 }} }}\n{bodies}"
        )
    };
    let folder = tempfile::tempdir().unwrap();
    for (i, snapshots) in
        ["", "every = 3, bodies = [\"first\", \"last\"], compression = \"none\""].into_iter().enumerate()
    {
        let scene = scene(folder.path(), &text(snapshots));
        let [alone, shared] = ["alone", "shared"].map(|name| folder.path().join(format!("{name} {i}")));
        let expected = start(&scene, 1, &alone);
        assert!(expected.performance.particles > 170_000 && expected.performance.steps > 2, "{expected}");
        let first = fs::read(alone.join("particles/00001.vtu")).unwrap();
        let pieces = String::from_utf8_lossy(&first).matches("<Piece ").count();
        assert_eq!(pieces, [3, 1][i], "{snapshots}");
        among(&scene, 3, |simulation| {
            let options = options(&shared);
            let mut stop = StopAfter(2, options.clone());
            let stopped = run_with(&scene, simulation, &options, &mut [&mut stop], &mut |_| {}).unwrap();
            assert_eq!(stopped.status, Status::Interrupted);
        });
        among(&scene, 2, |simulation| resume(&scene, simulation, &options(&shared), &mut |_| {}).unwrap());
        assert_same_run(&alone, &shared);
    }
}

/// The grid in several pieces: of one body that has more nodes than a piece takes, and of one that has few.
#[test]
fn ranks_share_files_of_many_nodes() {
    let text = r#"
space = { dimension = "plane-strain", interior = "grid", cell = 0.1, basis = "linear" }
time = { end = 0.02 }
materials.gel = { density = 1000, neo_hookean = { young_modulus = 1e4, poisson_ratio = 0.3 } }
outputs = { grid = 0.015 }
[[bodies]]
name = "wide"
material = "gel"
velocity = [1, 2]
particles_per_side = 1
shape.box = { min = [-15, -15], max = [15, 15] }
[[bodies]]
name = "small"
material = "gel"
velocity = [0, -2]
shape.ball = { center = [0, 17.5], radius = 2 }
"#;
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), text);
    let alone = folder.path().join("1");
    start(&scene, 1, &alone);
    let last = fs::read(alone.join("grid/00001.vtu")).unwrap();
    assert_eq!(String::from_utf8_lossy(&last).matches("<Piece ").count(), 2);
    for count in 2..=3 {
        let shared = folder.path().join(count.to_string());
        start(&scene, count, &shared);
        assert_same_run(&alone, &shared);
    }
}

/// Grains that press on each other and on a plate, some of them opaque and some beside the picture: in the light of
/// each polariscope, whoever looks at which.
#[test]
fn ranks_see_the_light_that_one_sees() {
    let text = |camera: &str| {
        format!(
            r#"
gravity = [0, -9.81]
space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
time = {{ end = 0.02 }}
materials.gel = {{ density = 1000, neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }} }}
[[bodies]]
name = "plate"
material = "gel"
shape.box = {{ min = [-0.3, -0.4], max = [3.5, 0] }}
[[bodies]]
name = "grain {{i}} {{j}}"
repeat = {{ i = 4, j = 3 }}
material = "gel"
shape.ball = {{ center = ["0.4 + 0.8 * i", "0.41 + 0.8 * j"], radius = 0.4 }}
velocity = ["1 - i", "-1 - 2 * j"]
[outputs]
tables = 0.005
checkpoints = 0.005
[outputs.fringes]
interval = 0.008
exposure = 0.004
samples = 2
stress_parameter = 1e3
width = 130
overlay = "force-chains"
{camera}"#
        )
    };
    let folder = tempfile::tempdir().unwrap();
    let cameras = [
        "bodies = [\"grain *\"]\n",
        "bodies = [\"plate\", \"grain 1 *\"]\nlight = \"white\"\nfield = \"light\"\n",
        "polarizer = 0.3\nlight = \"monochrome\"\nview = { min = [0.5, -0.2], max = [2, 1.5] }\n",
    ];
    for (i, camera) in cameras.into_iter().enumerate() {
        let scene = scene(folder.path(), &text(camera));
        let out = |count: usize| folder.path().join(format!("{i} {count}"));
        start(&scene, 1, &out(1));
        let pictures: Vec<_> =
            (0..2).map(|n| fs::read(out(1).join(format!("fringes/{n:05}.png"))).unwrap()).collect();
        assert_ne!(pictures[0], pictures[1]);
        for count in [2, 3, 5] {
            start(&scene, count, &out(count));
            assert_same_run(&out(1), &out(count));
        }
    }
}

/// A run at its end, and one that is stopped before its first step, go on without a step: with the grid of the last
/// one, which no frame had when the checkpoint was written, whoever wrote it and whoever takes it up.
#[test]
fn a_run_goes_on_with_the_grid_that_it_had() {
    let folder = tempfile::tempdir().unwrap();
    // The end is no multiple.
    let scene = scene(folder.path(), &PLANE.replace("grid = 0.06", "grid = 0.07"));
    let frames_beside_checkpoints = |out: &Path| {
        let names = fs::read_dir(out.join("checkpoints")).unwrap().map(|entry| entry.unwrap().path());
        let frames: Vec<_> = names.filter(|path| path.extension().unwrap() == "vtu").collect();
        assert!(frames.iter().all(|path| path.with_extension("checkpoint").is_file()), "{frames:?}");
        frames.len()
    };
    let go = |simulation: &mut dyn Simulation, out: &Path, steps: Option<u64>| {
        let options = options(out);
        let mut stop = StopAfter(steps.unwrap_or_default(), options.clone());
        let ended = match steps {
            Some(1..) => run_with(&scene, simulation, &options, &mut [&mut stop], &mut |_| {}),
            Some(0) => {
                options.stop.store(true, Ordering::Relaxed);
                resume(&scene, simulation, &options, &mut |_| {})
            }
            None => resume(&scene, simulation, &options, &mut |_| {}),
        };
        ended.unwrap_or_else(|error| panic!("{error}")).status
    };
    let by = |count: usize, out: &Path, steps: Option<u64>| match count {
        1 => go(&mut *stickslip::step::build(&scene).unwrap(), out, steps),
        count => among(&scene, count, |simulation| go(simulation, out, steps)),
    };
    let ways = [[1, 1, 1], [2, 3, 2], [3, 1, 2], [1, 2, 3]];
    let runs = ways.map(|[first, second, third]| {
        let [whole, stopped, halted] =
            ["whole", "stopped", "halted"].map(|name| folder.path().join(format!("{name} {first}{second}")));
        start(&scene, first, &whole);
        assert_eq!(frames_beside_checkpoints(&whole) > 0, first > 1);
        for count in [second, third] {
            assert_eq!(by(count, &whole, None), Status::Finished);
        }
        assert_eq!(by(first, &stopped, Some(40)), Status::Interrupted);
        assert_eq!(by(second, &stopped, Some(0)), Status::Interrupted);
        copy_all(&stopped, &halted);
        assert_eq!(by(third, &stopped, None), Status::Finished);
        frames_beside_checkpoints(&stopped);
        assert_same_run(&whole, &stopped);
        [whole, halted]
    });
    for run in &runs[1..] {
        (runs[0].iter().zip(run)).for_each(|(expected, found)| assert_same_run(expected, found));
    }
    let never_resumed = folder.path().join("never resumed");
    start(&scene, 1, &never_resumed);
    assert_same_run(&never_resumed, &runs[0][0]);
}

fn copy_all(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let (path, target) = (entry.path(), to.join(entry.file_name()));
        match path.is_dir() {
            true => copy_all(&path, &target),
            false => assert!(fs::copy(&path, &target).is_ok()),
        }
    }
}

/// A checkpoint whose shares fit the head but not each other is refused by ranks as by one.
#[test]
fn ranks_refuse_what_one_refuses() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), PLANE);
    let refused = |count: usize, damage: &(dyn Fn(&mut stickslip::door::SavedState) + Sync)| -> String {
        let mut simulation = stickslip::step::build(&scene).unwrap();
        simulation.step(f64::INFINITY).unwrap();
        let mut state = simulation.save().unwrap();
        damage(&mut state);
        let path = folder.path().join("0000000001.checkpoint");
        let memory = stickslip::observe::Memory::keeping(&path);
        let checkpoint = Checkpoint::new(&stickslip::observe::SceneRecord::new(&scene), state, memory);
        checkpoint.write(&path, stickslip::observe::CheckpointForm::Plain).unwrap();
        let take_up = |simulation: &mut dyn Simulation| {
            let restored = Checkpoint::open(&path).unwrap().restore(&path, simulation);
            restored.unwrap().unwrap_err().to_string()
        };
        match count {
            1 => take_up(&mut *stickslip::step::build(&scene).unwrap()),
            count => among(&scene, count, take_up),
        }
    };
    for count in 1..=2 {
        let twice = refused(count, &|state| state.bodies[0].numbers[1] = state.bodies[0].numbers[0]);
        assert!(twice.contains("numbered twice"), "{twice}");
        let moved = refused(count, &|state| {
            let column = state.bodies[0].columns.iter_mut().find(|column| column.name == "start").unwrap();
            column.bytes[3] ^= 1;
        });
        assert!(moved.contains("began elsewhere"), "{moved}");
        let lacks = refused(count, &|state| drop(state.bodies[0].columns.pop()));
        assert!(lacks.contains("other columns"), "{lacks}");
    }
}

/// From a checkpoint, and from a snapshot; with free rigid bodies; with loads, supports, a spring and a stress at the
/// start; and with particles that are gone, a body that is left out, and a new one.
#[test]
fn ranks_begin_from_another_run() {
    let mechanism = [PLANE, MECHANISM].concat();
    let at_rest = "velocities = \"zero\"\n";
    let snapshot = "at = 0.155\n";
    let cases = [
        ("plane", PLANE, &["", snapshot][..]),
        ("mechanism", &mechanism, &[at_rest, snapshot]),
        ("loaded", LOADED, &["", at_rest]),
        ("losing", LOSING, &[""]),
        ("apart", APART, &["", at_rest, "at = 0.15\n"]),
    ];
    for (name, text, starts) in cases {
        let folder = tempfile::tempdir().unwrap();
        let before = folder.path().join("before");
        start(&scene(folder.path(), text), 2, &before);
        let text = text.replace("velocity = [0, -2]\nspin = 3\n", "").replace("\"gone\"", "\"new\"");
        for more in starts {
            let scene = begun(folder.path(), &text, (&before, more));
            let runs = [1, 2, 3].map(|count| {
                let out = folder.path().join(format!("{count} {}", more.len()));
                start(&scene, count, &out);
                let record = Results::open(&out).unwrap().manifest().begun_from.clone().unwrap();
                (out, record)
            });
            let [(alone, record), shared @ ..] = &runs;
            for (out, found) in shared {
                assert_same_run(alone, out);
                assert_eq!((found.time, &found.state_sum), (record.time, &record.state_sum), "{name} {more}");
            }
        }
    }
}

/// What ranks say of a run from which a scene cannot begin is what one says.
#[test]
fn ranks_do_not_begin_from_what_one_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let [packing, losing, out] = ["packing", "losing", "out"].map(|name| folder.path().join(name));
    start(&scene(folder.path(), PLANE), 1, &packing);
    start(&scene(folder.path(), LOSING), 1, &losing);
    let plunger = "[[bodies]]\nname = \"plunger\"\nmaterial = \"slow\"\nrigid = {}\n\
                   shape.box = { min = [0, 0.3], max = [0.5, 1.0] }\n[[contact]]";
    let flows = "von_mises = { young_modulus = 2e5, poisson_ratio = 0.3, yield_stress = 2e3 }";
    let smaller = PLANE.replace("1.52], radius = 0.5", "1.52], radius = 0.4");
    let within = PLANE.replacen("[[contact]]", plunger, 1);
    let elastic = PLANE.replace(flows, "neo_hookean = { young_modulus = 2e5, poisson_ratio = 0.3 }");
    let elsewhere = PLANE.replace("center = [0.2, 1.52]", "center = [0.27, 1.52]");
    let others = PLANE.replace("\"paddle\"", "\"oar\"").replace("\"floor\"", "\"ground\"");
    let others = others.replace("\"low\"", "\"lower\"").replace("\"high\"", "\"higher\"");
    for (text, from, more, why) in [
        (&smaller[..], &packing, "", "its shape or its filling is another"),
        (&smaller, &packing, "at = 0.155\n", "another shape or another filling"),
        (&within, &packing, "", "`plunger` overlaps `low` in"),
        (&within, &packing, "at = 0.155\n", "`plunger` overlaps `low` in"),
        (&elastic, &packing, "", "spring back"),
        (&elsewhere, &packing, "", "its shape or its filling is another"),
        (&others, &packing, "", "no body with the name"),
        (LOSING, &losing, "at = 0.1\n", "its shape or its filling is another"),
    ] {
        let scene = begun(folder.path(), text, (from, more));
        let [alone, shared] = [1, 3].map(|count| {
            let Err(error) = try_start(&scene, count, &out) else { panic!("{why}: {more}") };
            assert!(!out.exists());
            error.to_string()
        });
        assert!(alone.contains(why), "{why}: {alone}");
        assert_eq!(alone, shared);
    }
}

/// A particle that leaves the domain: steps are taken again from memory, with loads where they were, then the run ends
/// with what one rank says.
#[test]
fn a_run_that_fails_says_what_one_says() {
    let folder = tempfile::tempdir().unwrap();
    let text =
        PLANE.replace("max = [3, 4]", "max = [3, 3]").replace("velocity = [0, -2]", "velocity = [0, 9]");
    let loads = r#"
[[loads]]
name = "wind"
body = "high"
acceleration = ["30 * sin(50 * t)", 0]
[[loads]]
name = "grip"
body = "high"
on = "surface"
traction = ["200 * sin(300 * t)", 0]
"#;
    let text = text + loads;
    let scene = scene(folder.path(), &text);
    let ended = |simulation: &mut dyn Simulation, out: &Path| {
        let error = run(&scene, simulation, &options(out), &mut |_| {}).unwrap_err();
        error.to_string()
    };
    let [alone, shared] = ["alone", "shared"].map(|name| folder.path().join(name));
    let expected = ended(&mut *stickslip::step::build(&scene).unwrap(), &alone);
    assert!(expected.contains("`high` left the domain"), "{expected}");
    assert_eq!(among(&scene, 3, |simulation| ended(simulation, &shared)), expected);
    // The last record shows how far the step came that failed, and ranks end that together.
    let rows = |out: &Path| {
        let results = Results::open(out).unwrap();
        assert!(results.frames().iter().all(|frame| results.particles(frame).is_ok()));
        let rows = results.bodies_table().unwrap();
        let last = rows.last().unwrap().time;
        rows.into_iter().filter(|row| row.time < last).collect::<Vec<_>>()
    };
    let [alone, shared] = [alone, shared].map(|out| rows(&out));
    assert!(alone.len() > 40 && alone == shared, "{} rows and {}", alone.len(), shared.len());
}
