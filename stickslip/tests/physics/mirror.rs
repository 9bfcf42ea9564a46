//! Half a model with a symmetry face equals the whole.
//!
//! Source: identity. Set-up: a disk (a ball) that lies with its centre in the face falls on a soft slab, with friction,
//! so that the contact reaches across the face; the whole model has grid nodes in the plane of symmetry.
//! In the plane one face, in space two.
//!
//! Expected: particles of the half as those of the whole, to round-off of the steps taken: 1e-9 of the ball's size and
//! speed (the order of sums differs). With the stress updated last 1e5 times as much, which bounds what was measured
//! (4e-7 m): presumably since that update takes the velocity of nearly massless nodes as it is.

use crate::trial::{RUBBER, STRESS_UPDATES, largest_difference, start, take_steps};
use stickslip::door::{ContactCursor, ParticleSnapshot};

fn scene(dimension: &str, update: &str, half: bool) -> String {
    let low = if half { "0" } else { "-0.8" };
    let faces = match (half, dimension) {
        (false, _) => "",
        (true, "3d") => ", x_min = \"symmetry\", z_min = \"symmetry\"",
        (true, _) => ", x_min = \"symmetry\"",
    };
    let v =
        |x: &str, y: &str| if dimension == "3d" { format!("[{x}, {y}, {x}]") } else { format!("[{x}, {y}]") };
    let ball = format!("{{ ball = {{ center = {}, radius = 0.3 }} }}", v("0", "0.31"));
    let ball = match (half, dimension) {
        (false, _) => format!("shape.union = [{ball}]"),
        (true, _) => format!(
            "shape.intersection = [{ball}, {{ box = {{ min = {}, max = {} }} }}]",
            v("0", "0"),
            v("1", "1")
        ),
    };
    format!(
        r#"
        gravity = {}
        [space]
        dimension = "{dimension}"
        cell = 0.1
        domain = {{ min = {}, max = {}{faces} }}
        [time]
        end = 1
        stress_update = "{update}"
        [materials]
        rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "ball"
        material = "rubber"
        {ball}
        velocity = {}
        [[bodies]]
        name = "slab"
        material = "rubber"
        shape.box = {{ min = {}, max = {} }}
        [[contact]]
        friction = 0.3
        "#,
        v("0", "-10"),
        v(low, "-3"),
        v("0.8", "1"),
        v("0", "-2"),
        v(if half { "0" } else { "-0.5" }, "-0.3"),
        v("0.5", "0"),
    )
}

/// Positions and velocities of the particles that start in the half (the quarter),
/// in the order of their places at the start.
fn arranged(snapshot: &ParticleSnapshot, first: &ParticleSnapshot) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let inside = |x: &[f64; 3]| x[0] > 0.0 && (first.dimension == 2 || x[2] > 0.0);
    let mut order: Vec<usize> = (0..first.body.len()).filter(|&p| inside(&first.position[p])).collect();
    order.sort_by_key(|&p| (first.body[p], first.position[p].map(|x| (x * 1e6).round() as i64)));
    order.iter().map(|&p| (snapshot.position[p], snapshot.velocity[p])).unzip()
}

/// Compares half and whole on the common grid by a stress update.
fn compare(dimension: &str, update: &str, steps: usize) {
    let [whole, half] = [false, true].map(|half| {
        let mut simulation = start(&scene(dimension, update, half));
        let first = simulation.snapshot();
        take_steps(&mut *simulation, steps);
        assert!(!ContactCursor::default().read(&*simulation).is_empty(), "the ball reaches the slab");
        arranged(&simulation.snapshot(), &first)
    });
    let position = largest_difference(&whole.0, &half.0);
    let velocity = largest_difference(&whole.1, &half.1);
    println!("{dimension}, {update}, {steps} steps: position {position:.1e} m, velocity {velocity:.1e} m/s");
    let amplified = if update == "last" { 1e5 } else { 1.0 };
    assert!(position < 0.3e-9 * amplified, "{dimension}, {update}: {position:e} m");
    assert!(velocity < 2e-9 * amplified, "{dimension}, {update}: {velocity:e} m/s");
}

#[test]
fn in_the_plane() {
    for update in STRESS_UPDATES {
        compare("plane-strain", update, 200);
    }
}

#[test]
fn in_space() {
    for update in STRESS_UPDATES {
        compare("3d", update, 100);
    }
}

/// A block that flies and swings, with faces that hold its half (its quarter).
fn block(dimension: &str, half: bool) -> String {
    let (faces, low) = match (half, dimension) {
        (false, _) => ("", "-0.4"),
        (true, "3d") => (", x_min = 'symmetry', z_min = 'symmetry'", "0"),
        (true, _) => (", x_min = 'symmetry'", "0"),
    };
    let v = |x: &str, y: &str, z: &str| match dimension {
        "3d" => format!("[{x}, {y}, {z}]"),
        _ => format!("[{x}, {y}]"),
    };
    let velocity = v("'4 m/s * x / 1 m'", "'0.5 m/s - 3 m/s * y / 1 m'", "'-2 m/s * z / 1 m'");
    let domain_low = if half { "0" } else { "-1" };
    format!(
        "space = {{ dimension = '{dimension}', cell = 0.1, interior = 'reference', domain = {{ min = {}, max = {}{faces} }} }}\n\
         time.end = 1\n{RUBBER}\n[[bodies]]\nname = 'block'\nmaterial = 'rubber'\nshape.box = {{ min = {}, max = {} }}\n\
         velocity = {velocity}\n",
        v(domain_low, "-1", domain_low),
        v("1", "1", "1"),
        v(low, "-0.3", low),
        v("0.4", "0.3", "0.4"),
    )
}

/// Of bodies on grids of their own a half is the whole, folded: one that swings to round-off, one that hits a slab but
/// for the points of its surface and the volume of what is cut, which are sums.
#[test]
fn on_grids_of_their_own() {
    for (dimension, steps, tolerance) in [("plane-strain", 100, 1e-6), ("3d", 60, 5e-5)] {
        let own = |half: bool| {
            scene(dimension, "", half)
                .replace("stress_update = \"\"\n", "")
                .replace("[space]\n", "[space]\ninterior = \"reference\"\n")
        };
        let differences = |text: &dyn Fn(bool) -> String| {
            let [whole, half] = [false, true].map(|half| {
                let mut simulation = start(&text(half));
                let first = simulation.snapshot();
                take_steps(&mut *simulation, steps);
                arranged(&simulation.snapshot(), &first)
            });
            [largest_difference(&whole.0, &half.0), largest_difference(&whole.1, &half.1)]
        };
        let [position, velocity] = differences(&|half| block(dimension, half));
        println!("{dimension}, a block: position {position:.1e} m, velocity {velocity:.1e} m/s");
        assert!(position < 1e-12 && velocity < 1e-10, "{dimension}: {position:e} m, {velocity:e} m/s");
        let [position, velocity] = differences(&own);
        println!("{dimension}, a ball: position {position:.1e} m, velocity {velocity:.1e} m/s");
        assert!(position < tolerance && velocity < 100.0 * tolerance, "{dimension}: {position:e} m");
    }
}
