//! Particles taken several at a time do what particles taken one by one do, and all processors do the same.
//!
//! Set-up: a soft ball and a stone that fly into each other and a rigid floor before a symmetry face, with friction,
//! gravity, and a share of PIC; both round, for next to an edge round-off decides which way a surface looks; in the
//! plane and in space, both precisions, both bases, all stress updates, with one lane and on every path that this
//! processor has. A naive pass of its own is held against both in `stickslip-engine/tests/engine/naive.rs`.
//!
//! Expected: after 60 steps (15 with linear functions) positions agree within 1e-10 of the bodies' size and velocities
//! within 1e-9 of their speed in double precision, 1e-5 and 1e-3 in single: a product and a sum are rounded once or
//! twice, and a stiff law turns round-off of strain into forces. All paths that take several at a time and round a
//! product and a sum once agree bit for bit with each other: they sum in one order, whatever the processor has.

#[path = "../../../stickslip-engine/tests/engine/flying.rs"]
mod flying;

use crate::trial::{STRESS_UPDATES, largest_difference, start_on, take_steps};
use flying::flying;
use stickslip::door::{ContactCursor, ParticleSnapshot};
use stickslip::lanes::Processor;
use stickslip::step::ParticleLoop;

fn scene(dimension: &str, precision: &str, basis: &str, update: &str) -> String {
    let space = format!("interior = \"grid\", basis = \"{basis}\", precision = \"{precision}\"");
    let time = format!("stress_update = \"{update}\", pic_share = 0.02");
    let rock =
        "materials.rock = { density = 2000, hypoelastic = { young_modulus = 3e5, poisson_ratio = 0.2 } }";
    flying(dimension, [&space, &time, rock])
}

fn outcome(scene: &str, path: ParticleLoop, steps: usize) -> (ParticleSnapshot, f64) {
    let mut simulation = start_on(scene, path);
    take_steps(&mut *simulation, steps);
    assert!(ContactCursor::default().read(&*simulation).len() >= 2, "bodies touch");
    (simulation.snapshot(), simulation.time())
}

fn compare(dimension: &str, precision: &str, basis: &str, update: &str) {
    let scene = scene(dimension, precision, basis, update);
    // Linear functions do not live long.
    let steps = if basis == "linear" { 15 } else { 60 };
    compare_paths(&scene, steps, &format!("{dimension} {precision} {basis} {update}"));
}

fn compare_paths(scene: &str, steps: usize, name: &str) {
    let (reference, time) = outcome(scene, ParticleLoop::OneLane, steps);
    for (processor, found, found_time) in outcomes_with_the_same_bits(scene, steps) {
        let position = largest_difference(&found.position, &reference.position) / 0.3;
        let velocity = largest_difference(&found.velocity, &reference.velocity);
        println!("{name} {processor:?}: position {position:.1e}, velocity {velocity:.1e}");
        let [most, fastest] = if scene.contains("double") { [1e-10, 1e-9] } else { [1e-5, 1e-3] };
        assert!(position < most && velocity < fastest, "{processor:?} differs");
        for (found, reference) in found.history.iter().zip(&reference.history) {
            let values = found.values.iter().zip(&reference.values);
            let scale = reference.values.iter().fold(1.0, |largest: f64, x| largest.max(x.abs()));
            let off = values.fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs())) / scale;
            // The thickness of what is broken is free but for a millionth of the stiffness.
            let most = if found.name.starts_with("damage") { 1e3 * fastest } else { fastest };
            assert!(off < most, "{processor:?}: {} differs by {off:.1e}", found.name);
        }
        // Steps follow the fastest signal of any particle.
        assert!((found_time / time - 1.0).abs() < most, "{processor:?}: {found_time} s, {time} s");
    }
}

/// What the processors that this one can be make of a scene: the same bits where they round products and sums alike.
fn outcomes_with_the_same_bits(scene: &str, steps: usize) -> Vec<(Processor, ParticleSnapshot, f64)> {
    let mut outcomes: Vec<(Processor, ParticleSnapshot, f64)> = Vec::new();
    for processor in Processor::available() {
        let (found, time) = outcome(scene, ParticleLoop::Lanes(processor), steps);
        if let Some((first, other, _)) =
            outcomes.iter().find(|(first, ..)| first.fuses() == processor.fuses())
        {
            assert!(other == &found, "{processor:?} has other bits than {first:?}");
        }
        outcomes.push((processor, found, time));
    }
    outcomes
}

/// Where an edge lets round-off decide which way a surface looks, the paths that round alike still agree.
#[test]
fn edges() {
    for dimension in ["plane-strain", "3d"] {
        for precision in ["double", "single"] {
            let round = scene(dimension, precision, "gimp", "last");
            let (min, max) = match dimension {
                "3d" => ("[0, 0, -0.2]", "[0.2, 0.4, 0.2]"),
                _ => ("[0, 0]", "[0.2, 0.4]"),
            };
            let (before, rest) = round.split_at(round.rfind("shape.ball").expect("the stone is round"));
            let (_, after) = rest.split_once('\n').expect("a line of its own");
            outcomes_with_the_same_bits(
                &format!("{before}shape.box = {{ min = {min}, max = {max} }}\n{after}"),
                60,
            );
        }
    }
}

#[test]
fn in_the_plane() {
    for precision in ["double", "single"] {
        for basis in ["linear", "gimp", "cubic"] {
            // Linear functions with the stress updated last tear the ball apart at once, on any path.
            let lives = |update: &&str| basis != "linear" || *update != "last";
            for update in STRESS_UPDATES.into_iter().filter(lives) {
                compare("plane-strain", precision, basis, update);
            }
        }
    }
}

/// Groups take particles of several cells, and few fill the lanes.
#[test]
fn in_the_plane_with_one_particle_a_cell() {
    for update in STRESS_UPDATES {
        let scene = scene("plane-strain", "double", "gimp", update);
        let sparse = scene.replace("cell = 0.1,", "cell = 0.1, particles_per_side = 1,");
        assert_ne!(sparse, scene);
        compare_paths(&sparse, 60, &format!("one particle a cell, {update}"));
    }
}

/// The stone yields: its particles have a column more.
#[test]
fn metal() {
    let spaces = [("plane-strain", 2), ("plane-strain", 1), ("plane-stress", 2), ("3d", 2)];
    for (dimension, particles) in spaces {
        let elastic = "hypoelastic = { young_modulus = 3e5, poisson_ratio = 0.2 }";
        let metal = "von_mises = { young_modulus = 3e5, poisson_ratio = 0.2, yield_stress = 2e3, hardening_modulus = 1e4 }";
        let scene = scene(dimension, "double", "gimp", "modified-last")
            .replace(elastic, metal)
            .replace("cell = 0.1,", &format!("cell = 0.1, particles_per_side = {particles},"));
        let (found, _) = outcome(&scene, ParticleLoop::OneLane, 60);
        let plastic_strain = found.remembered("plastic_strain").expect("a law that flows");
        let most = plastic_strain.values.iter().fold(0.0, |a: f64, &b| a.max(b));
        assert!(most > 1e-3, "{dimension}: {most}");
        compare_paths(&scene, 60, &format!("metal, {dimension}, {particles} a side"));
    }
}

/// Histories of several tensors, and of a law that breaks.
#[test]
fn histories() {
    let elastic = "hypoelastic = { young_modulus = 3e5, poisson_ratio = 0.2 }";
    let relaxing =
        "viscoelastic = { young_modulus = 3e5, poisson_ratio = 0.2, prony = [[0.3, 0.003], [0.2, 0.05]] }";
    let breaking =
        "damage = { young_modulus = 3e5, poisson_ratio = 0.2, tensile_strength = 2e3, fracture_energy = 20 }";
    for (dimension, particles) in [("plane-strain", 2), ("plane-strain", 1), ("plane-stress", 2), ("3d", 2)] {
        for (law, name) in [(relaxing, "viscous_dissipation"), (breaking, "damage")] {
            let scene = scene(dimension, "double", "gimp", "modified-last")
                .replace(elastic, law)
                .replace("cell = 0.1,", &format!("cell = 0.1, particles_per_side = {particles},"));
            let (found, _) = outcome(&scene, ParticleLoop::OneLane, 60);
            let history = found.remembered(name).expect("a law with history");
            let most = history.values.iter().fold(0.0, |a: f64, &b| a.max(b));
            assert!(most > 1e-3, "{dimension}, {name}: {most}");
            compare_paths(&scene, 60, &format!("{name}, {dimension}, {particles} a side"));
        }
    }
}

#[test]
fn in_space() {
    for update in STRESS_UPDATES {
        compare("3d", "double", "gimp", update);
    }
    compare("3d", "double", "linear", "modified-last");
    compare("3d", "double", "cubic", "modified-last");
    compare("3d", "single", "gimp", "modified-last");
}
