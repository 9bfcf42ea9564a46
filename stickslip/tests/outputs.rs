//! What a run writes: complete, exact, readable by ParaView's reader, and valid whatever ends the run.
//!
//! The simulation here is exact and tiny: two bodies of a few particles fly through gravity,
//! so that every number is known.

mod ballistic;

use ballistic::{Ballistic, scene};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::atomic::Ordering;
use stickslip::door::{ParticleSnapshot, StepError, View};
use stickslip::image::Image;
use stickslip::march::MarchError;
use stickslip::observe::{FolderError, Results, Status};
use stickslip::run::{RunError, RunOptions, Summary, run};
use stickslip::scene::{Fringes, Light, Overlay, Polariscope, PolariscopeField, Sensitivity, Tractions};

fn options(out: &Path) -> RunOptions {
    RunOptions { threads: 2, ..RunOptions::new(out) }
}

fn run_to(out: &Path, simulation: &mut Ballistic) -> Result<Summary, RunError> {
    run(&scene(), simulation, &options(out), &mut |_| {})
}

/// Opens the results and every file in them.
fn read_all(out: &Path) -> (Results, Vec<ParticleSnapshot>) {
    let results = Results::open(out).unwrap();
    let snapshots = results.frames().iter().map(|frame| results.particles(frame).unwrap()).collect();
    results.bodies_table().unwrap();
    results.energy_table().unwrap();
    results.contacts_table().unwrap();
    (results, snapshots)
}

fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn assert_nothing_half_written(out: &Path) {
    for folder in [out.to_path_buf(), out.join("particles"), out.join("grid")] {
        let names = names_in(&folder);
        assert!(!names.iter().any(|name| name.ends_with(".part")), "{names:?}");
    }
}

#[test]
fn a_run_records_its_start_every_interval_and_its_exact_end() {
    let out = tempfile::tempdir().unwrap();
    let mut simulation = Ballistic::new(0.03);
    let summary = run_to(out.path(), &mut simulation).unwrap();
    assert_eq!(simulation.time(), 1.0);
    assert_eq!(summary.status, Status::Finished);

    let (results, snapshots) = read_all(out.path());
    // Particles every 0.25 s: the first steps of 0.03 s at or past it, with their own times.
    let times: Vec<f64> = results.frames().iter().map(|frame| frame.time).collect();
    for (time, expected) in times.iter().zip([0.0, 0.27, 0.51, 0.75, 1.0]) {
        assert!((time - expected).abs() < 1e-12, "{times:?}");
    }
    assert_eq!(times.len(), 5);
    assert_eq!(*snapshots.last().unwrap(), simulation.snapshot());

    let rows = results.bodies_table().unwrap();
    assert_eq!(rows.len(), 2 * 11, "the start, every 0.1 s to the end, two bodies");
    let (last, state) = (rows.last().unwrap(), &simulation.bodies()[1]);
    assert_eq!((last.body.as_str(), last.time, &last.state), ("plane", 1.0, state));
    assert_eq!(results.energy_table().unwrap().len(), 11);

    let contacts = results.contacts_table().unwrap();
    assert_eq!(contacts.len(), 10, "no step, no contact: none at the start");
    assert_eq!((contacts[0].body_a.as_str(), contacts[0].body_b.as_str()), ("sphere", "plane"));
    let friction: f64 = contacts.iter().map(|row| row.mean.friction).sum();
    assert_eq!(friction, 0.75 * simulation.steps() as f64, "each step's contact is in one row");
    assert!(
        contacts
            .iter()
            .all(|row| (row.mean.force[1] - 2.0).abs() < 1e-12 && (row.mean.position[0] - 0.5).abs() < 1e-12)
    );
}

#[test]
fn the_tables_have_the_columns_that_the_manual_lists() {
    let out = tempfile::tempdir().unwrap();
    let mut scene = scene();
    scene.outputs.measurements.tractions = Some(Tractions::default());
    run(&scene, &mut Ballistic::new(0.1), &options(out.path()), &mut |_| {}).unwrap();
    let header =
        |name: &str| fs::read_to_string(out.path().join(name)).unwrap().lines().next().unwrap().to_string();
    assert_eq!(header("bodies.csv"), "time,body,mass,x,y,z,vx,vy,vz,wx,wy,wz,kinetic,strain");
    assert_eq!(
        header("energy.csv"),
        "time,kinetic,strain,potential,external_work,friction,adhesion,plastic,damping,total,px,py,pz,lx,ly,lz"
    );
    assert_eq!(
        header("contacts.csv"),
        "time,body_a,body_b,fx,fy,fz,normal,tangential,nodes,x,y,z,area,gap,slip,friction"
    );
    assert_eq!(header("tractions.csv"), "time,body,partner,x,y,z,x0,y0,z0,nx,ny,nz,area,pressure,tx,ty,tz");
}

#[test]
fn the_record_of_the_run_says_what_was_run_and_how_fast() {
    let out = tempfile::tempdir().unwrap();
    let summary = run_to(out.path(), &mut Ballistic::new(0.1)).unwrap();
    let results = Results::open(out.path()).unwrap();
    let manifest = results.manifest();
    assert_eq!(manifest.status, Status::Finished);
    assert_eq!(
        (manifest.title.as_str(), manifest.dimension, manifest.cell),
        ("two bodies in flight", 3, 0.1)
    );
    assert_eq!(results.body_names(), ["sphere", "plane"]);
    assert_eq!(manifest.performance, summary.performance);
    assert_eq!(manifest.performance.threads, 2);
    assert_eq!(manifest.performance.timings[0].verb, "fly");
    let scene = results.scene().unwrap();
    assert_eq!((scene.time.end, scene.number("speed")), (Some(1.0), 2.0));
    let curve = &manifest.references[0];
    assert_eq!((curve.body.as_str(), curve.quantity.as_str()), ("sphere", "vx"));
    assert_eq!(curve.points.last(), Some(&[1.0, 2.5]));

    let reference = &summary.references[0];
    assert_eq!((reference.value, reference.exact, reference.ratio()), (2.0, 2.5, 0.8));
    assert!(summary.energy_drift().abs() < 1e-9, "{summary}");
    let screen = summary.to_string();
    assert!(screen.lines().count() < 24 && screen.contains("ratio 0.8000"), "{screen}");
}

#[test]
fn the_last_steps_share_the_remainder() {
    let out = tempfile::tempdir().unwrap();
    let mut simulation = Ballistic::new(0.3);
    run_to(out.path(), &mut simulation).unwrap();
    // 0.3, 0.3, then 0.4 in two halves instead of 0.3 and 0.1.
    assert_eq!(simulation.steps(), 4);
    assert!((simulation.last_step() - 0.2).abs() < 1e-12);
}

#[test]
fn a_stopped_run_leaves_its_last_state_and_valid_files() {
    let out = tempfile::tempdir().unwrap();
    let options = options(out.path());
    let stop = options.stop.clone();
    let mut simulation = Ballistic::new(0.03).before_step(5, move || stop.store(true, Ordering::Relaxed));
    let summary = run(&scene(), &mut simulation, &options, &mut |_| {}).unwrap();
    assert_eq!(summary.status, Status::Interrupted);
    assert_eq!(simulation.steps(), 6, "the step under way is completed");

    let (results, snapshots) = read_all(out.path());
    assert_eq!(results.manifest().status, Status::Interrupted);
    assert_eq!(*snapshots.last().unwrap(), simulation.snapshot());
    assert_eq!(results.energy_table().unwrap().last().unwrap().time, simulation.time());
    assert_nothing_half_written(out.path());
}

#[test]
fn a_failing_step_leaves_the_state_in_which_it_failed() {
    let out = tempfile::tempdir().unwrap();
    let mut simulation = Ballistic::new(0.03).failing_at(7);
    let error = run_to(out.path(), &mut simulation).unwrap_err();
    assert!(
        matches!(
            error,
            RunError::Step { error: MarchError::Step(StepError::Inverted { .. }), unsaved: None }
        ),
        "{error}"
    );
    assert!(miette::Diagnostic::help(&error).unwrap().to_string().contains("try"), "{error}");

    let (results, snapshots) = read_all(out.path());
    assert_eq!(results.manifest().status, Status::Failed);
    assert_eq!(results.manifest().error, Some(error.to_string()));
    assert_eq!(*snapshots.last().unwrap(), simulation.snapshot());
    assert_eq!(results.frames().last().unwrap().time, simulation.time());
    assert_eq!(results.bodies_table().unwrap().last().unwrap().time, simulation.time());
    assert_nothing_half_written(out.path());
}

#[test]
fn a_step_that_fails_right_after_a_frame_takes_its_place() {
    let out = tempfile::tempdir().unwrap();
    let mut simulation = Ballistic::new(0.03).failing_at(0);
    run_to(out.path(), &mut simulation).unwrap_err();
    let (results, snapshots) = read_all(out.path());
    assert_eq!(results.frames().len(), 1);
    assert_eq!(snapshots[0], simulation.snapshot(), "the inverted particle is seen");
    assert_eq!(results.bodies_table().unwrap().len(), 2);
}

#[test]
fn time_that_stands_still_is_an_error() {
    let out = tempfile::tempdir().unwrap();
    let error = run_to(out.path(), &mut Ballistic::new(0.0)).unwrap_err();
    assert!(matches!(error, RunError::Step { error: MarchError::Stuck { .. }, .. }), "{error}");
    assert_eq!(Results::open(out.path()).unwrap().manifest().status, Status::Failed);
}

/// The third snapshot finds a folder in its place.
#[test]
fn a_file_that_cannot_be_written_is_an_error_that_names_it_and_spares_earlier_frames() {
    let out = tempfile::tempdir().unwrap();
    let place = out.path().join("particles/00002.vtu");
    let mut simulation = Ballistic::new(0.03).before_step(10, {
        let place = place.clone();
        move || fs::create_dir(&place).unwrap()
    });
    let error = run_to(out.path(), &mut simulation).unwrap_err();
    let RunError::Output(output) = &error else { panic!("{error}") };
    assert_eq!(output.path, place);
    assert!(miette::Diagnostic::help(&error).unwrap().to_string().contains("written before can be read"));

    let (results, snapshots) = read_all(out.path());
    assert_eq!(results.manifest().status, Status::Failed);
    assert!(results.manifest().error.as_ref().unwrap().contains("00002.vtu"));
    assert_eq!(snapshots.len(), 2);
    assert_nothing_half_written(out.path());
}

#[test]
fn a_second_run_replaces_the_first_and_leaves_other_files_alone() {
    let out = tempfile::tempdir().unwrap();
    run_to(out.path(), &mut Ballistic::new(0.01)).unwrap();
    fs::write(out.path().join("notes.txt"), "look at frame 3").unwrap();
    fs::write(out.path().join("particles/mine.vtu"), "").unwrap();
    let mut shorter = scene();
    shorter.time.end = 0.3;
    shorter.outputs.grid = None;
    run(&shorter, &mut Ballistic::new(0.01), &options(out.path()), &mut |_| {}).unwrap();

    assert_eq!(read_all(out.path()).1.len(), 3);
    assert_eq!(names_in(&out.path().join("particles")), ["00000.vtu", "00001.vtu", "00002.vtu", "mine.vtu"]);
    let left =
        ["bodies.csv", "contacts.csv", "energy.csv", "notes.txt", "particles", "particles.pvd", "run.json"];
    assert_eq!(names_in(out.path()), left);
}

#[test]
fn a_folder_that_cannot_be_used_is_an_error_of_its_own_kind() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("thesis.tex"), "").unwrap();
    let foreign = run_to(folder.path(), &mut Ballistic::new(0.1)).unwrap_err();
    assert!(matches!(foreign, RunError::Folder(FolderError::Foreign { .. })), "{foreign}");
    let beyond = folder.path().join("thesis.tex/results");
    let unusable = run_to(&beyond, &mut Ballistic::new(0.1)).unwrap_err();
    assert!(matches!(unusable, RunError::Folder(FolderError::Unusable { .. })), "{unusable}");
    assert!(unusable.to_string().contains("thesis.tex"), "{unusable}");
}

#[test]
fn progress_ends_with_the_end() {
    let out = tempfile::tempdir().unwrap();
    let mut last = None;
    run(&scene(), &mut Ballistic::new(0.1), &options(out.path()), &mut |p| last = Some(p.clone())).unwrap();
    let last = last.unwrap();
    assert_eq!((last.time, last.end, last.particles, last.eta), (1.0, 1.0, 7, 0.0));
}

/// VTK's reader, the one inside ParaView, finds the same numbers, names and times.
///
/// Needs a Python with the package `vtk`: `STICKSLIP_PYTHON`, else `python3`.
#[test]
fn paraview_reads_the_snapshots() {
    let named = std::env::var("STICKSLIP_PYTHON").ok();
    let python = named.clone().unwrap_or_else(|| "python3".into());
    let find = "import importlib.util as i, sys; sys.exit(i.find_spec('vtk') is None)";
    let has_vtk = Command::new(&python).args(["-c", find]).status().is_ok_and(|status| status.success());
    if !has_vtk {
        let required = named.is_some() || std::env::var_os("CI").is_some();
        assert!(!required, "{python} has no package `vtk`: pip install vtk");
        eprintln!("skipped: {python} has no package `vtk`; name one that has it in STICKSLIP_PYTHON");
        return;
    }
    let out = tempfile::tempdir().unwrap();
    // So many particles that arrays of doubles are several blocks, the last of them partial.
    let mut simulation = Ballistic::new(0.07).with_particles([17_001, 3]);
    let mut scene = scene();
    scene.outputs.particles = Some(f64::INFINITY);
    run(&scene, &mut simulation, &options(out.path()), &mut |_| {}).unwrap();

    let (results, snapshots) = read_all(out.path());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/read_with_vtk.py");
    let output = Command::new(&python)
        .arg(script)
        .args(["particles.pvd", "grid.pvd"].map(|series| out.path().join(series)))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let [particles, grid]: [Vec<serde_json::Value>; 2] = serde_json::from_slice(&output.stdout).unwrap();
    for snapshot in particles.iter().chain(&grid) {
        assert_eq!(snapshot["complaints"], serde_json::json!([]));
    }

    assert_eq!((particles.len(), snapshots.len()), (2, 2), "the start and the end");
    for ((found, frame), expected) in particles.iter().zip(results.frames()).zip(&snapshots) {
        assert_eq!(found["time"], frame.time);
        assert_same_particles(found, frame.time, expected);
    }

    assert_eq!(grid.len(), 3, "every 0.5 s");
    assert_eq!(grid[0]["points"], 0, "no step, no nodes");
    let last = simulation.grid_snapshot();
    assert_eq!(grid[2]["points"], last.mass.len());
    assert_eq!(grid[2]["arrays"]["contact_impulse"]["values"][2], last.contact_impulse[0][2]);
    assert_eq!(grid[2]["fields"]["cell"], last.cell);
}

/// Pressure and von Mises stress follow from the stress in `ballistic`, -3 on the diagonal and a shear of 1:
/// 3 and sqrt(3).
fn assert_same_particles(found: &serde_json::Value, time: f64, expected: &ParticleSnapshot) {
    let points: Vec<usize> = (0..expected.mass.len()).collect();
    assert!(found["cells"] == serde_json::json!(points), "each point is a cell");
    assert_eq!(found["cell_types"], serde_json::json!([1]), "VTK_VERTEX");
    assert_eq!(found["fields"]["TimeValue"], time);
    let components = &found["arrays"]["stress"]["components"];
    assert_eq!(*components, serde_json::json!(["XX", "YY", "ZZ", "XY", "YZ", "XZ"]));

    let values =
        |name: &str| -> Vec<f64> { serde_json::from_value(found["arrays"][name]["values"].clone()).unwrap() };
    let numbers = |column: &[u32]| column.iter().map(|&number| f64::from(number)).collect::<Vec<_>>();
    for (name, column) in [
        ("points", expected.position.as_flattened()),
        ("velocity", expected.velocity.as_flattened()),
        ("stress", expected.stress.as_flattened()),
        ("deformation", expected.deformation.as_flattened()),
        ("mass", &expected.mass),
        ("volume", &expected.volume),
        ("body", &numbers(&expected.body)),
        ("number", &numbers(&expected.number)),
        ("pressure", &vec![3.0; expected.mass.len()]),
    ] {
        assert!(values(name) == column, "{name} at {time} s");
    }
    assert!(values("von_mises").iter().all(|value| (value - 3f64.sqrt()).abs() < 1e-15));
}

#[test]
fn a_camera_leaves_its_frames_a_table_and_an_animation() {
    let out = tempfile::tempdir().unwrap();
    let mut scene = scene();
    let polariscope = Polariscope {
        sensitivity: Sensitivity::StressPerFringe(2.0),
        wavelength: Polariscope::MERCURY_GREEN,
        field: PolariscopeField::Dark,
        light: Light::White,
        polarizer: None,
    };
    scene.outputs.fringes = Some(Fringes {
        first: 0.1,
        interval: 0.25,
        exposure: 0.12,
        samples: 3,
        width: 48,
        view: Some([[-1.0, -5.0], [3.0, 5.0]]),
        bodies: vec![scene.bodies[0].name.clone()],
        overlay: Overlay::ForceChains,
        polariscope,
    });
    run(&scene, &mut Ballistic::new(0.01), &options(out.path()), &mut |_| {}).unwrap();
    let frames = names_in(&out.path().join("fringes"));
    assert_eq!(frames, ["00000.png", "00001.png", "00002.png", "00003.png"]);
    let rows = Results::open(out.path()).unwrap().fringes_table().unwrap();
    for (i, row) in rows.iter().enumerate() {
        let opened = 0.1 + 0.25 * i as f64;
        assert_eq!((row.frame, row.samples), (i, 3), "{row:?}");
        // The middles of three parts of the open time, each met by the first step that reaches it.
        for (time, instant) in [(row.from, 0.02), (row.time, 0.06), (row.to, 0.10)] {
            assert!((time - opened - instant).abs() < 0.0051, "{row:?}");
        }
    }
    let images = frames.iter().map(|name| Image::read_png(&out.path().join("fringes").join(name)).unwrap());
    assert!(images.clone().all(|image| image.size == [48, 120]));
    assert!(images.clone().any(|image| image != images.clone().next().unwrap()), "the bodies fly");
    let animation = fs::read(out.path().join("fringes.png")).unwrap();
    let control = animation.windows(4).position(|name| name == b"acTL").unwrap() + 4;
    assert_eq!(animation[control..control + 4], 4u32.to_be_bytes());

    // A second run clears them.
    scene.outputs.fringes = None;
    run(&scene, &mut Ballistic::new(0.1), &options(out.path()), &mut |_| {}).unwrap();
    assert!(names_in(out.path()).iter().all(|name| !name.starts_with("fringes")));
}

#[test]
fn snapshots_hold_what_is_asked_for() {
    let text = r#"
        space = { dimension = "plane-strain", interior = "grid", cell = 0.1 }
        time.end = 0.01
        materials.clay = { density = 1, neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 } }
        [[bodies]]
        name = "disk {i}"
        repeat.i = 3
        material = "clay"
        shape.ball = { center = ["i * 2", 0], radius = 0.5 }
        velocity = [1, 0]
        [outputs.snapshots]
        bodies = ["disk 0", "disk 2"]
        every = 3
    "#;
    let run = |set: &[(&str, &str)]| {
        let set: Vec<_> = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        let scene = stickslip::scene::parse("disks.toml", text, &set).expect("a scene").scene;
        let folder = tempfile::tempdir().unwrap();
        let mut simulation = stickslip::step::build(&scene).unwrap();
        let options = RunOptions::new(folder.path());
        stickslip::run::run(&scene, &mut *simulation, &options, &mut |_| {}).unwrap();
        let results = Results::open(folder.path()).unwrap();
        let last = results.frames().last().expect("a snapshot at the end").clone();
        (results.particles(&last), results.has_whole_snapshots(), simulation.snapshot())
    };
    let (found, whole, all) = run(&[]);
    let found = found.unwrap();
    assert!(!whole && !found.number.is_empty());
    let rows = (0..all.number.len()).filter(|&i| all.body[i] != 1 && all.number[i] % 3 == 0);
    let rows: Vec<usize> = rows.collect();
    assert_eq!(found.number, rows.iter().map(|&i| all.number[i]).collect::<Vec<_>>());
    let single = rows.iter().map(|&i| all.position[i].map(|x| f64::from(x as f32)));
    assert_eq!(found.position, single.collect::<Vec<_>>());
    assert!(run(&[("outputs.snapshots.every", "1")]).1);
    let (found, _, all) = run(&[("outputs.snapshots.precision", "double")]);
    assert_eq!(found.unwrap().stress, rows.iter().map(|&i| all.stress[i]).collect::<Vec<_>>());
    // Without compression a file holds the same.
    let plain = ("outputs.snapshots.compression", "none");
    let (found, _, all) = run(&[("outputs.snapshots.precision", "double"), plain]);
    assert_eq!(found.unwrap().stress, rows.iter().map(|&i| all.stress[i]).collect::<Vec<_>>());
    let (found, whole, _) = run(&[("outputs.snapshots.columns", "[\"velocity\"]")]);
    assert!(!whole && found.unwrap_err().to_string().contains("stress"));
}

/// Of the bodies of choice, and of that of which an answer is known, and of no other.
#[test]
fn the_table_of_bodies_has_rows_of_choice() {
    let text = r#"
        space = { dimension = "plane-strain", interior = "grid", cell = 0.1 }
        time.end = 0.01
        outputs.bodies = ["disk 0", "disk *2"]
        materials.clay = { density = 1, neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 } }
        [[bodies]]
        name = "disk {i}"
        repeat.i = 5
        material = "clay"
        shape.ball = { center = ["i * 2", 0], radius = 0.5 }
        velocity = [1, 0]
        [[references]]
        body = "disk 3"
        quantity = "x"
        value = "6 + t"
        label = "free flight"
    "#;
    let scene = stickslip::scene::parse("disks.toml", text, &[]).expect("a scene").scene;
    let folder = tempfile::tempdir().unwrap();
    let mut simulation = stickslip::step::build(&scene).unwrap();
    let options = RunOptions::new(folder.path());
    stickslip::run::run(&scene, &mut *simulation, &options, &mut |_| {}).unwrap();
    let rows = Results::open(folder.path()).unwrap().bodies_table().unwrap();
    let names: Vec<&str> = rows.iter().take(4).map(|row| row.body.as_str()).collect();
    assert_eq!(names, ["disk 0", "disk 2", "disk 3", "disk 0"]);
    let last = rows.last().unwrap();
    assert!((last.time - 0.01).abs() < 1e-12 && (last.state.position[0] - 6.01).abs() < 1e-9, "{last:?}");
}
