//! Bodies that begin with a stress are at rest under the loads that it balances, and without these give way by it.
//!
//! Source: equilibrium, d sigma_yy/dy = rho g; Hooke's law.
//!
//! Set-up: a column of soil between mirrors under its weight, which begins with the stress of that weight, by every
//! law, with linear functions and gimp; a bar that begins with a stress along it and is let go, in plane stress and in
//! space, by a law of the deformation and one in rate form.
//!
//! Expected: the column, whose stress is exact at the particles, moves by less than 1e-6 of what it would sink by (1e-8
//! at most), and its stress stays within 1e-6. The bar comes to rest longer by sigma/E within 1 %; it begins with the
//! strain energy sigma^2 V / (2 E) within 1 %, and its ledger closes within 1e-3 of that, on a grid of its own within
//! 0.01: there velocities lie half a step before places, and of those damping takes its part (measured 0.006).

use crate::trial::{mean_where, run_to, start};

const OWN: &str = "interior = \"reference\"";

const LAWS: [&str; 5] = [
    "neo_hookean = { MODULI }",
    "hypoelastic = { MODULI }",
    "von_mises = { MODULI, yield_stress = 1e5 }",
    "viscoelastic = { MODULI, prony = [[0.1, 1e6]] }",
    "damage = { MODULI, tensile_strength = 1e6, fracture_energy = 1e5 }",
];

fn with_moduli(law: &str) -> String {
    law.replace("MODULI", "young_modulus = 1e7, poisson_ratio = 0.3")
}

#[test]
fn a_column_at_rest_under_its_weight_stays_so() {
    for (place, most) in [("basis = \"linear\"", 1e-6), ("basis = \"gimp\"", 1e-6), (OWN, 0.01)] {
        let is_own = place == OWN;
        for law in LAWS.into_iter().filter(|law| !(is_own && law.starts_with("damage"))) {
            let text = format!(
                r#"
                gravity = [0, -10]
                time = {{ end = 0.05 }}
                materials.soil = {{ density = 2000, {} }}
                [space]
                dimension = "plane-strain"
                cell = 0.1
                {place}
                domain = {{ min = [0, 0], max = [0.4, 2], x_min = "symmetry", x_max = "symmetry", y_min = "symmetry" }}
                [[bodies]]
                name = "column"
                material = "soil"
                shape.box = {{ min = [0, 0], max = [0.4, 1] }}
                [bodies.stress]
                xx = "-0.4 * 20 kN/m^3 * (1 m - y)"
                yy = "-20 kN/m^3 * (1 m - y)"
                zz = "-0.4 * 20 kN/m^3 * (1 m - y)"
                "#,
                with_moduli(law)
            );
            let mut simulation = start(&text);
            let begun = simulation.snapshot();
            run_to(&mut *simulation, 0.05, |_| {});
            let after = simulation.snapshot();
            // rho g h^2 / (2 M)
            let sinks = 2e4 / (2.0 * 1e7 * 0.7 / (1.3 * 0.4));
            let moved = (0..begun.position.len())
                .map(|p| (after.position[p][1] - begun.position[p][1]).abs())
                .fold(0.0, f64::max);
            let off = (0..begun.position.len())
                .map(|p| (after.stress[p][1] + 2e4 * (1.0 - begun.position[p][1])).abs() / 2e4)
                .fold(0.0, f64::max);
            println!("{place}, {}: moved {:.2e}, stress off {off:.2e}", law, moved / sinks);
            assert!(moved < most * sinks && off < most, "{place} {law}: {moved} {off}");
        }
    }
}

#[test]
fn a_bar_that_is_let_go_gives_way_by_its_stress() {
    let stress = 2e4;
    let plane = ["[0, 0]", "[0.4, 0.1]", "[-0.1, -0.1]", "[0.6, 0.2]"];
    let space = ["[0, 0, 0]", "[0.4, 0.1, 0.1]", "[-0.1, -0.1, -0.1]", "[0.6, 0.2, 0.2]"];
    let bars = [("plane-stress", 0, plane), ("plane-stress", 1, plane), ("3d", 0, space)];
    let all = ["grid", "reference"].into_iter().flat_map(|interior| bars.map(|bar| (interior, bar)));
    for (interior, (dimension, which, sizes)) in all {
        let [min, max, low, high] = sizes;
        let text = format!(
            r#"
            time.end = 0.1
            damping.local = 0.3
            materials.gel = {{ density = 1000, {} }}
            [space]
            dimension = "{dimension}"
            interior = "{interior}"
            cell = 0.05
            domain = {{ min = {low}, max = {high} }}
            [[bodies]]
            name = "bar"
            material = "gel"
            shape.box = {{ min = {min}, max = {max} }}
            stress.xx = "-{stress} Pa"
            "#,
            with_moduli(LAWS[which])
        );
        let mut simulation = start(&text);
        let begun = simulation.ledger();
        let volume = if dimension == "3d" { 4e-3 } else { 0.04 };
        let exact = stress * stress * volume / 2e7;
        println!("{interior}, {dimension}, {}: energy {:.4}", LAWS[which], begun.strain / exact);
        assert!((begun.strain / exact - 1.0).abs() < 0.01, "{begun:?}");
        run_to(&mut *simulation, 0.1, |_| {});
        let (snapshot, ledger) = (simulation.snapshot(), simulation.ledger());
        let mean = |of: &dyn Fn(usize) -> f64| mean_where(&snapshot, |_| true, of);
        let strain = mean(&|p| snapshot.deformation[p][0]) - 1.0;
        let left = mean(&|p| snapshot.stress[p][0].abs());
        println!("  strain {:.4}, stress left {:.1e}", strain / (stress / 1e7), left / stress);
        assert!((strain / (stress / 1e7) - 1.0).abs() < 0.01 && left < 1e-2 * stress, "{strain} {left}");
        let gap = if interior == "grid" { 1e-3 } else { 0.01 };
        assert!((ledger.total - begun.total).abs() < gap * begun.strain, "{ledger:?}");
    }
}
