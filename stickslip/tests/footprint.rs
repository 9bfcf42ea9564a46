//! The memory that is told before a run is what the simulation then holds, and not half as much again.
//!
//! Bodies on grids of their own hold most beside their particles: their grids, and the functions at the particles of
//! each cell. Steps are taken, so that what contact holds counts.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use stickslip::check::report;
use stickslip::scene::parse;

/// The system's allocator, which knows how much is taken.
struct Weighing;

static TAKEN: AtomicUsize = AtomicUsize::new(0);
/// One simulation at a time is weighed.
static ALONE: Mutex<()> = Mutex::new(());

// SAFETY: everything is the system's doing.
unsafe impl GlobalAlloc for Weighing {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        TAKEN.fetch_add(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        TAKEN.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        TAKEN.fetch_add(size, Ordering::Relaxed);
        TAKEN.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's.
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Weighing = Weighing;

/// What is told of a scene over what its simulation holds after some steps.
fn told_over_held(dimension: &str, bodies: &str) -> f64 {
    let _alone = ALONE.lock();
    let text = format!(
        r#"
        gravity = {gravity}
        space = {{ dimension = "{dimension}", cell = 0.1 }}
        time.end = 1
        materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
        materials.clay.density = 1000
        materials.clay.von_mises = {{ young_modulus = 1e6, poisson_ratio = 0.3, yield_stress = 1e5 }}
        contact = [{{ friction = 0.3 }}]
        {bodies}
        "#,
        gravity = if dimension == "3d" { "[0, 0, -9.81]" } else { "[0, -9.81]" },
    );
    let scene = parse("footprint.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    let told = report(&scene).expect("no problem").memory;
    let before = TAKEN.load(Ordering::Relaxed);
    let mut simulation = stickslip::step::build(&scene).expect("no problem");
    (0..5).for_each(|_| _ = simulation.step(f64::INFINITY).expect("a step"));
    let held = TAKEN.load(Ordering::Relaxed) - before;
    println!("{} bodies in {dimension}: told {told:.0} B, held {held} B", scene.bodies.len());
    told / held as f64
}

fn is_right(told_over_held: f64) {
    assert!((1.0..1.5).contains(&told_over_held), "{told_over_held}");
}

/// A floor below all.
const FLOOR: &str = r#"
    [[bodies]]
    name = "floor"
    material = "rubber"
    rigid = {}
"#;

/// Balls that differ by size, in rows so far apart.
fn balls(counts: [usize; 3], apart: f64) -> String {
    let axes = if counts[2] == 0 { 2 } else { 3 };
    let [rows, columns, layers] = counts.map(|count| count.max(1));
    let number = |i: usize, j: usize, k: usize| (k * columns + j) * rows + i;
    let ball = |[i, j, k]: [usize; 3]| {
        // Diameters of four to eight cells.
        let radius = 0.2 + 0.2 * (number(i, j, k) * 37 % 101) as f64 / 101.0;
        let center = [i, j, k].map(|n| apart * (n as f64 + 0.5));
        format!(
            "[[bodies]]\nname = 'ball {}'\nmaterial = 'rubber'\nshape.ball = {{ center = {:?}, radius = {radius} }}\n",
            number(i, j, k),
            &center[..axes]
        )
    };
    let all = (0..layers).flat_map(|k| (0..columns).flat_map(move |j| (0..rows).map(move |i| [i, j, k])));
    all.map(ball).collect()
}

#[test]
fn many_disks() {
    let floor = format!("{FLOOR}shape.half_space = {{ point = [0, 0], normal = [0, 1] }}\n");
    is_right(told_over_held("plane-strain", &(balls([12, 12, 0], 0.8) + &floor)));
}

/// Equal disks share what their cells look like. Each lies beside four others, and more of its points are near these
/// than touch.
#[test]
fn equal_disks_side_by_side() {
    let disk = |i: usize| {
        let [x, y] = [i % 10, i / 10].map(|n| 0.6 * n as f64);
        format!(
            "[[bodies]]\nname = 'disk {i}'\nmaterial = 'rubber'\nshape.ball = {{ center = [{x}, {y}], radius = 0.3 }}\n"
        )
    };
    let told = told_over_held("plane-strain", &(0..100).map(disk).collect::<String>());
    assert!((1.0..2.0).contains(&told), "{told}");
}

#[test]
fn one_large_square() {
    let square =
        "[[bodies]]\nname = 'square'\nmaterial = 'rubber'\nshape.box = { min = [0, 0], max = [6, 6] }\n";
    is_right(told_over_held("plane-strain", square));
}

#[test]
fn balls_in_space() {
    is_right(told_over_held("3d", &balls([2, 2, 2], 0.8)));
}

#[test]
fn a_cube_in_space() {
    let cube =
        "[[bodies]]\nname = 'cube'\nmaterial = 'rubber'\nshape.box = { min = [0, 0, 0], max = [1, 1, 1] }\n";
    is_right(told_over_held("3d", cube));
}

/// Clay is on the common grid, of which nodes are told by the number of particles alone.
#[test]
fn disks_beside_clay() {
    let clay =
        "[[bodies]]\nname = 'clay'\nmaterial = 'clay'\nshape.box = { min = [0, -1], max = [6.4, 0] }\n";
    let told = told_over_held("plane-strain", &(balls([8, 4, 0], 0.8) + clay));
    assert!((0.5..2.0).contains(&told), "{told}");
}
