//! The pass that ships, in one lane and in several, does what the naive one does.
//!
//! Set-up: a soft ball and a stone that flows, which fly into each other and into a rigid floor before a symmetry face,
//! with friction, gravity and a share of PIC; in the plane and in space, all bases, stress updates and
//! transfers; the stone with means of the change of volume, too, and bulk viscosity.
//!
//! Expected: after 40 steps positions agree within 1e-10 of the bodies' size, velocities within 1e-9 of their speed:
//! sums are taken in another order, and a stiff law turns round-off of strain into forces.

use crate::flying::flying;
use stickslip_engine::Kernels;
use stickslip_engine::door::ParticleSnapshot;
use stickslip_engine::lanes::Processor;
use stickslip_engine::scene::parse;
use stickslip_engine::step::{ParticleLoop, build_by, build_on};

fn outcome(scene: &str, path: Option<ParticleLoop>, steps: usize) -> ParticleSnapshot {
    let loaded = parse("naive.toml", scene, &[]).unwrap_or_else(|e| panic!("{e:?}\n{scene}"));
    let basis = loaded.scene.discretization.basis;
    let built = match path {
        Some(path) => build_on(&loaded.scene, path),
        None => build_by(&loaded.scene, (Kernels::naive(basis), Kernels::naive(basis))),
    };
    let mut simulation = built.unwrap_or_else(|e| panic!("{e:?}\n{scene}"));
    for _ in 0..steps {
        simulation.step(f64::INFINITY).unwrap_or_else(|e| panic!("{e}\n{scene}"));
    }
    simulation.snapshot()
}

fn largest_difference(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

const FLOWS: &str = "von_mises = { young_modulus = 3e5, poisson_ratio = 0.2, yield_stress = 2e3 }";

#[test]
fn one_lane_and_several_do_what_the_equations_say() {
    for dimension in ["plane-strain", "3d"] {
        for (basis, steps) in [("gimp", 40), ("linear", 12), ("spline", 40), ("cubic", 40)] {
            for update in ["first", "last", "modified-last"] {
                let kinds = ["flip", "rflip", "pic", "apic", "xpic"].map(|transfer| (transfer, "own"));
                for (transfer, volume_change) in kinds.into_iter().chain([("rflip", "averaged")]) {
                    let bulk = "damping = { bulk_linear = 0.1, bulk_quadratic = 2 }";
                    let damping = if volume_change == "averaged" || transfer == "apic" { bulk } else { "" };
                    let share = if transfer.ends_with("flip") { ", pic_share = 0.02" } else { "" };
                    let time = format!("stress_update = \"{update}\", transfer = \"{transfer}\"{share}");
                    let rock = format!(
                        "materials.rock = {{ density = 2000, volume_change = \"{volume_change}\", {FLOWS} }}\n{damping}"
                    );
                    let scene = flying(dimension, [&format!("basis = \"{basis}\""), &time, &rock]);
                    // Linear functions do not live long with the others.
                    let lasts = basis != "linear" || (transfer.ends_with("flip") && volume_change == "own");
                    let steps = if lasts { steps } else { 4 };
                    let naive = outcome(&scene, None, steps);
                    for path in [ParticleLoop::OneLane, ParticleLoop::Lanes(Processor::best())] {
                        let found = outcome(&scene, Some(path), steps);
                        let position = largest_difference(&found.position, &naive.position) / 0.3;
                        let velocity = largest_difference(&found.velocity, &naive.velocity);
                        assert!(
                            position < 1e-10 && velocity < 1e-9,
                            "{dimension} {basis} {time} {path:?}: {position:.1e} {velocity:.1e}"
                        );
                    }
                }
            }
        }
    }
}
