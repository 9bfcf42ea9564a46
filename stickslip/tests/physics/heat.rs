//! Heated bodies grow where they can, and press where they cannot.
//!
//! Source: thermal strain alpha T; with it Hooke's law. Timoshenko (1925), Analysis of bi-metal thermostats, J. Opt.
//! Soc. Am. 11, for the strip of two metals.
//!
//! Set-up: a bar between two mirrors, and a free block, that a formula and a table warm by 50 K and make grow by 1e-3,
//! in plane strain, plane stress and space, by a law of the deformation and one in rate form, with each stress update,
//! on the common grid and on grids of their own; the same bar, warmer at one end than at the other; a strip of two
//! layers glued to each other, held at one end.
//!
//! Expected: the held bar has the stress -E alpha T, in plane strain over 1 - nu, within 1 %; the free block grows by
//! alpha T, in plane strain by 1 + nu of that, within 1 %, and has next to no stress; the work of the heat is the
//! energy that is there, within 1e-3; the end of the strip moves by 3/4 (alpha_2 - alpha_1) T L^2/h within 5 %.

use crate::trial::{STRESS_UPDATES, mean_where, run_to, start};

const STRAIN: f64 = 1e-3;
const YOUNG: f64 = 1e7;

/// A block 8 by 4 cells, with walls or not.
fn block(
    (dimension, law, time): (&str, &str, &str),
    interior: &str,
    walls: &str,
    temperature: &str,
) -> String {
    let [min, max, low, high] = match dimension {
        "3d" => ["[0, 0, 0]", "[0.08, 0.04, 0.04]", "[0, -0.04, -0.04]", "[0.08, 0.08, 0.08]"],
        _ => ["[0, 0]", "[0.08, 0.04]", "[0, -0.04]", "[0.08, 0.08]"],
    };
    let domain = if walls.is_empty() {
        String::new()
    } else {
        format!("domain = {{ min = {low}, max = {high}, {walls} }}")
    };
    format!(
        r#"
        time = {{ end = 20e-3, {time} }}
        damping.local = 0.2
        [materials.gel]
        density = 1000
        thermal_expansion = 2e-5
        {law} = {{ young_modulus = {YOUNG}, poisson_ratio = 0.3 }}
        [space]
        dimension = "{dimension}"
        interior = "{interior}"
        cell = 0.01
        {domain}
        [[bodies]]
        name = "block"
        material = "gel"
        shape.box = {{ min = {min}, max = {max} }}
        [[loads]]
        body = "block"
        temperature = {temperature}
        "#
    )
}

const MIRRORS: &str = r#"x_min = "symmetry", x_max = "symmetry""#;
const FORMULA: &str = r#""50 * min(t / 10 ms, 1)""#;
const TABLE: &str = r#"{ table = [["0 s", 0], ["10 ms", 50]] }"#;

#[test]
fn a_held_bar_presses_and_a_free_block_grows() {
    let mut cases = Vec::new();
    for interior in ["grid", "reference"] {
        cases.push((interior, "3d", "neo_hookean", "", FORMULA));
        for dimension in ["plane-strain", "plane-stress"] {
            cases.push((interior, dimension, "neo_hookean", "", TABLE));
            cases.push((interior, dimension, "hypoelastic", "", FORMULA));
        }
    }
    let updates = STRESS_UPDATES.map(|update| format!("stress_update = \"{update}\""));
    cases.extend(updates.iter().map(|time| ("grid", "plane-strain", "hypoelastic", time.as_str(), FORMULA)));
    for (interior, dimension, law, time, temperature) in cases {
        let across = if dimension == "plane-strain" { 0.7 } else { 1.0 };
        let mut held = start(&block((dimension, law, time), interior, MIRRORS, temperature));
        run_to(&mut *held, 20e-3, |_| {});
        let (snapshot, ledger) = (held.snapshot(), held.ledger());
        let stress = mean_where(&snapshot, |_| true, |p| snapshot.stress[p][0]) / (-YOUNG * STRAIN / across);
        let along = mean_where(&snapshot, |_| true, |p| snapshot.stress[p][1].abs()) / (YOUNG * STRAIN);
        let closed = ledger.total / ledger.external_work;
        println!(
            "{interior}, {dimension}, {law} {time}: held, stress {stress:.4}, across {along:.1e}; ledger {closed:.1e}"
        );
        assert!((stress - 1.0).abs() < 0.01 && along < 0.01, "{dimension} {law}: {stress} {along}");
        assert!(ledger.external_work > 0.0 && closed.abs() < 1e-3, "{ledger:?}");

        let mut free = start(&block((dimension, law, time), interior, "", temperature));
        run_to(&mut *free, 20e-3, |_| {});
        let (snapshot, ledger) = (free.snapshot(), free.ledger());
        let growth = if dimension == "plane-strain" { 1.3 } else { 1.0 } * STRAIN;
        let grown = [0, 1].map(|i| mean_where(&snapshot, |_| true, |p| snapshot.deformation[p][4 * i]) - 1.0);
        let stress =
            mean_where(&snapshot, |_| true, |p| snapshot.stress[p][0].abs().max(snapshot.stress[p][1].abs()));
        println!(
            "  free, grown {:.4} {:.4}, stress {:.1e}",
            grown[0] / growth,
            grown[1] / growth,
            stress / YOUNG / STRAIN
        );
        assert!(grown.iter().all(|grown| (grown / growth - 1.0).abs() < 0.01), "{grown:?}");
        assert!(stress < 0.01 * YOUNG * STRAIN, "{stress}");
        // In plane strain there is a stress along z, on which the heat works.
        let scale = YOUNG * STRAIN * STRAIN * 0.08 * 0.04;
        assert!(ledger.total.abs() < 1e-3 * scale, "{ledger:?}");
    }
}

/// In equilibrium the force is the same all along the bar: that of the mean temperature.
#[test]
fn a_bar_that_is_warmer_at_one_end_presses_by_the_mean() {
    let temperature = r#""100 * x0 / 8 cm * min(t / 10 ms, 1)""#;
    for interior in ["grid", "reference"] {
        let mut held = start(&block(("plane-stress", "neo_hookean", ""), interior, MIRRORS, temperature));
        run_to(&mut *held, 20e-3, |_| {});
        let snapshot = held.snapshot();
        let stress = |from: f64| {
            let near = |p: usize| (from..from + 0.04).contains(&snapshot.position[p][0]);
            mean_where(&snapshot, near, |p| snapshot.stress[p][0]) / (-YOUNG * STRAIN)
        };
        println!("{interior}: cold half {:.4}, warm half {:.4}", stress(0.0), stress(0.04));
        for part in [stress(0.0), stress(0.04)] {
            assert!((part - 1.0).abs() < 0.02, "{interior}: {part}");
        }
        let column = snapshot.history.iter().find(|column| column.name == "temperature");
        let most = column.expect("it is heated").values.iter().copied().fold(0.0, f64::max);
        assert!((most - 100.0 * (1.0 - 0.0025 / 0.08)).abs() < 1e-6, "{interior}: {most}");
    }
}

/// The strip, `cells` to a layer, and how far its end moves over what Timoshenko says.
fn bend(interior: &str, cells: f64) -> f64 {
    let [layer, length] = [0.01, 0.2];
    let text = format!(
        r#"
        time = {{ end = 1, relax = {{ residual = 1e-3 }} }}
        [materials.steel]
        density = 1000
        thermal_expansion = 1e-5
        hypoelastic = {{ young_modulus = {YOUNG}, poisson_ratio = 0 }}
        [materials.brass]
        density = 1000
        thermal_expansion = 3e-5
        hypoelastic = {{ young_modulus = {YOUNG}, poisson_ratio = 0 }}
        [space]
        dimension = "plane-stress"
        interior = "{interior}"
        cell = {cell}
        domain = {{ min = [0, {low}], max = [0.25, {high}], x_min = "symmetry" }}
        [[bodies]]
        name = "lower"
        material = "steel"
        shape.box = {{ min = [0, 0], max = [{length}, {layer}] }}
        [[bodies]]
        name = "upper"
        material = "brass"
        shape.box = {{ min = [0, {layer}], max = [{length}, {top}] }}
        [[contact]]
        law = "glued"
        [[supports]]
        body = "lower"
        displacement = ["free", 0]
        within.ball = {{ center = [0, {layer}], radius = {cell} }}
        [[loads]]
        body = "lower"
        temperature = "25 * min(t / 10 ms, 1)"
        [[loads]]
        body = "upper"
        temperature = "25 * min(t / 10 ms, 1)"
        "#,
        cell = layer / cells,
        low = -5.0 * layer,
        high = 5.0 * layer,
        top = 2.0 * layer,
    );
    let mut simulation = start(&text);
    let mut rest = false;
    run_to(&mut *simulation, 1.0, |simulation| {
        rest |= simulation.relaxation().is_some_and(|state| state.at_rest)
    });
    assert!(rest, "the strip comes to rest");
    let snapshot = simulation.snapshot();
    let end = |p: usize| snapshot.position[p][0] > length - 1.01 * layer / cells;
    let middle = length - 0.5 * layer / cells;
    let start_of = |p: usize| snapshot.position[p][1] - layer;
    let moved = mean_where(&snapshot, end, start_of);
    // kappa = 3/2 (alpha_2 - alpha_1) T / h of two equal layers, h: both
    let curvature = -1.5 * 2e-5 * 25.0 / (2.0 * layer);
    println!("{interior}, {cells} cells to a layer: {:.4}", moved / (0.5 * curvature * middle * middle));
    moved / (0.5 * curvature * middle * middle)
}

#[test]
#[ignore = "slow: 20 s"]
fn a_strip_of_two_metals_bends() {
    let bent = bend("grid", 4.0);
    assert!((bent - 1.0).abs() < 0.05, "{bent}");
}

#[test]
fn a_strip_of_two_metals_bends_on_grids_of_their_own() {
    let bent = bend("reference", 4.0);
    assert!((bent - 1.0).abs() < 0.05, "{bent}");
}
