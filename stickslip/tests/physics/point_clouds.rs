//! A disk of particles from a file rolls as the exact disk does, and particles begin with the velocities of the file.
//!
//! Source: identity. Set-up: a disk of rubber, eight cells to its radius, is set on a half-space and rolls down a slope
//! of 0.2 rad for three quarters of a turn: the exact disk on its lattice, and one from a file of the same particles,
//! whose surface is known by these only. Then a cloud without contact, with a velocity of its own for each particle.
//!
//! Expected: the way within 2 % of that of the exact disk at all times, as a disk's surface is off by a quarter of the
//! particles' distance, 1.5 % of the radius; mass, momentum and angular momentum of the file's particles to round-off.

use crate::trial::{RUBBER, run_to, start_in};
use std::fmt::Write as _;
use stickslip::geometry::{Arrangement, ParticleSite, Shape, SiteLattice, fill};

/// The particles of a disk of radius 1 m on the slope.
fn sites() -> Vec<ParticleSite> {
    let lattice = SiteLattice { origin: [0.0; 3], spacing: 0.0625, dimension: 2 };
    fill(&Shape::disk([0.0, 1.0], 1.0), &lattice, Arrangement::Lattice).expect("bounded").sites
}

#[test]
fn a_disk_of_particles_rolls_as_the_exact_disk() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut rows = "x,y,volume\n".to_string();
    for ParticleSite { position: [x, y, _], volume, .. } in sites() {
        writeln!(rows, "{},{},{}", 100.0 * x, 100.0 * y, 1e4 * volume).expect("text");
    }
    std::fs::write(folder.path().join("disk.csv"), rows).expect("written");
    let ways = |disk: &str| -> Vec<f64> {
        let text = format!(
            r#"
            gravity = ["8 * sin(0.2)", "-8 * cos(0.2)"]
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.125 }}
            time.end = 3
            {RUBBER}
            [[bodies]]
            name = "slope"
            material = "rubber"
            shape.half_space = {{ point = [0, 0], normal = [0, 1] }}
            rigid = {{}}
            {disk}
            [[contact]]
            friction = 0.5
            "#
        );
        let mut simulation = start_in(folder.path(), &text);
        let way = |i: u32| {
            run_to(&mut *simulation, 0.25 * f64::from(i), |_| {});
            simulation.bodies()[1].position[0]
        };
        (1..=12).map(way).collect()
    };
    let exact = ways(
        "[[bodies]]\nname = \"disk\"\nmaterial = \"rubber\"\nshape.ball = { center = [0, 1], radius = 1 }",
    );
    let found = ways(
        "[[point_clouds]]\nname = \"disk\"\nfile = \"disk.csv\"\nunit = \"1 cm\"\nmaterial = \"rubber\"",
    );
    let off: Vec<f64> = found.iter().zip(&exact).map(|(found, exact)| found / exact - 1.0).collect();
    println!("off by {off:.4?} of the way");
    assert!(off.iter().all(|off| off.abs() < 0.02), "{off:?}");
}

#[test]
fn particles_begin_with_velocities_of_their_own() {
    let folder = tempfile::tempdir().expect("a folder");
    // A body that turns by 3 rad/s about its middle, moves, and is stretched along x.
    let velocity = |[x, y, _]: [f64; 3]| [0.5 - 3.0 * (y - 1.0) + 0.2 * x, -0.25 + 3.0 * x];
    let (mut rows, sites) = ("vx,vy,x,y,mass\n".to_string(), sites());
    for site in &sites {
        let ([x, y, _], [vx, vy]) = (site.position, velocity(site.position));
        writeln!(rows, "{vx},{vy},{x},{y},{}", 1000.0 * site.volume).expect("text");
    }
    std::fs::write(folder.path().join("disk.csv"), rows).expect("written");
    let text = format!(
        r#"
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.125 }}
        time.end = 0.01
        {RUBBER}
        [[point_clouds]]
        name = "disk"
        file = "disk.csv"
        material = "rubber"
        "#
    );
    let mut simulation = start_in(folder.path(), &text);
    let density = simulation.bodies()[0].mass / sites.iter().map(|site| 1000.0 * site.volume).sum::<f64>();
    assert!((density - 1.0).abs() < 1e-12, "the masses are those of the file: {density}");
    let kinetic: f64 = sites
        .iter()
        .map(|site| {
            let [vx, vy] = velocity(site.position);
            0.5 * 1000.0 * site.volume * (vx * vx + vy * vy)
        })
        .sum();
    let snapshot = simulation.snapshot();
    for (site, (at, found)) in sites.iter().zip(snapshot.position.iter().zip(&snapshot.velocity)) {
        let [vx, vy] = velocity(site.position);
        assert!((0..2).all(|k| (at[k] - site.position[k]).abs() < 1e-12));
        assert!((found[0] - vx).abs() < 1e-12 && (found[1] - vy).abs() < 1e-12);
    }
    run_to(&mut *simulation, 0.01, |_| {});
    let (body, ledger) = (simulation.bodies()[0].clone(), simulation.ledger());
    assert!((body.velocity[0] - 0.5).abs() < 1e-10 && (body.velocity[1] + 0.25).abs() < 1e-10, "{body:?}");
    assert!((ledger.total / kinetic - 1.0).abs() < 0.01, "{} of {kinetic}", ledger.total);
}
