//! A step takes no memory from the system: what it needs it has kept from the steps before.
//!
//! Lists that follow the particles, such as who is in which cell, may still grow a last time while particles wander,
//! and so may what one of several threads keeps when it is handed more than ever before: a handful of times in all, not
//! once a step. One thread with particles that do not wander allocates nothing at all: neither where rigid bodies move
//! by formulas, nor by any contact law, nor at mirrors. A rigid body without bounds is the exception: it gets particles
//! anew where deformable bodies come to new blocks, or where it has moved on by a part of a cell.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, Ordering};

/// The system's allocator, counting.
struct Counting;

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);

// SAFETY: everything is the system's doing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: the caller's.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's.
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const WORLD: &str = r#"
    space = { dimension = "3d", interior = "grid", cell = "25 mm", particles_per_side = 2, basis = "BASIS", domain = DOMAIN }
    time = { end = "1 s", transfer = "TRANSFER" }
    DAMPING
    materials.rubber = { density = "1000 kg/m^3", volume_change = "CHANGE", neo_hookean = { bulk_modulus = "6 MPa", shear_modulus = "3 MPa" } }
    contact = [{ friction = 0.3, law = "LAW" }]
"#;

/// A domain without walls, and one whose lower faces are mirrors.
const OPEN: &str = "{ min = [-1, -1, -1], max = [1, 1, 1] }";
const MIRRORED: &str = r#"{ min = [0, 0, 0], max = [1, 1, 1], x_min = "symmetry", z_min = "symmetry" }"#;

/// Allocations of `steps` steps after `warm_up` others, on so many threads.
fn allocations(
    bodies: &str,
    (basis, law, domain): (&str, &str, &str),
    threads: usize,
    [warm_up, steps]: [usize; 2],
) -> u64 {
    let world = WORLD.replace("BASIS", basis).replace("LAW", law).replace("DOMAIN", domain);
    // With splines XPIC's filter, damping and means of the change of volume, which need room of their own.
    let (transfer, damping, change) = match basis {
        "spline" => ("xpic", "damping = { local = 0.2, bulk_quadratic = 1.5 }", "averaged"),
        _ => ("rflip", "", "own"),
    };
    let world = world.replace("TRANSFER", transfer).replace("DAMPING", damping).replace("CHANGE", change);
    let text = format!("{world}bodies = [{bodies}]");
    let scene = stickslip::scene::parse("allocations.toml", &text, &[]).expect("a scene").scene;
    let mut simulation = stickslip::step::build(&scene).expect("a sound scene");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    // Inside the pool: work that is handed in from outside waits in a list of the pool's.
    pool.install(|| {
        let mut take =
            |steps: usize| (0..steps).for_each(|_| _ = simulation.step(f64::INFINITY).expect("a step"));
        take(warm_up);
        let before = ALLOCATIONS.load(Ordering::Relaxed);
        take(steps);
        ALLOCATIONS.load(Ordering::Relaxed) - before
    })
}

fn block(name: &str, low: [f64; 3], velocity: [f64; 3]) -> String {
    let high = low.map(|x| x + 0.2);
    format!(
        r#"{{ name = "{name}", material = "rubber", shape.box = {{ min = {low:?}, max = {high:?} }}, velocity = {velocity:?} }},"#
    )
}

/// A plate that presses on what lies below 0.2 m, by formulas.
const PLATE: &str = concat!(
    r#"{ name = "plate", material = "rubber", shape.box = { min = [0, 0.2, 0], max = [0.2, 0.25, 0.2] }, "#,
    r#"rigid.velocity = ["1 mm/s * (1 + sin(t / 1 ms))", "if(t < 1 s, -1 mm/s * min(t / 1 ms, 1), 0)", 0], "#,
    r#"rigid.spin = [0, "1e-3 * t", 0] },"#,
);

/// Balls of eight cells' diameter that touch, two along each axis, with a little play.
fn balls(speed: f64) -> String {
    let mut balls = String::new();
    for n in 0..8 {
        let side = [n & 1, n >> 1 & 1, n >> 2].map(f64::from);
        let center = side.map(|x| 0.2 * x);
        let velocity = side.map(|x| speed * (2.0 + 0.5 * (0.5 - x)));
        balls += &format!(
            r#"{{ name = "{n}", material = "rubber", shape.ball = {{ center = {center:?}, radius = 0.1 }}, velocity = {velocity:?} }},"#
        );
    }
    balls
}

// One test: allocations are counted for the whole process.
#[test]
fn steps_take_no_memory() {
    let cube = |speed| block("cube", [0.0; 3], [speed, 0.6 * speed, 0.3 * speed]);
    let blocks = |speed: f64| cube(0.0) + &block("other", [0.0, 0.2, 0.0], [speed, -0.05 * speed, 0.0]);
    for basis in ["linear", "gimp", "spline", "cubic"] {
        for (name, bodies) in [("cube", cube(1e-3)), ("blocks", blocks(1e-3)), ("balls", balls(1e-3))] {
            let count = allocations(&bodies, (basis, "surface", OPEN), 1, [20, 20]);
            assert_eq!(count, 0, "{name} that hardly move, {basis}");
        }
        let pressed = cube(1e-3) + PLATE;
        // The boxes of GIMP particles begin on borders of cells, so what is pushed to and fro crosses them, and a list
        // may grow. What a formula or a law took would be taken several times a step.
        let least = if basis == "linear" { 1 } else { 20 };
        for law in ["surface", "regression"] {
            for (name, domain) in [("open", OPEN), ("mirrored", MIRRORED)] {
                for (bodies, of) in [(&pressed, "a plate moved by formulas"), (&blocks(1e-3), "blocks")] {
                    let count = allocations(bodies, (basis, law, domain), 1, [20, 20]);
                    assert!(count < least, "{of}, {name} domain, {law}, {basis}: {count} in 20 steps");
                }
            }
        }
        for (name, bodies) in [("cube", cube(8.0)), ("blocks", blocks(8.0)), ("balls", balls(8.0))] {
            for threads in [1, 2] {
                // Lists of tiles and impulses grow until particles have crossed every kind of border.
                let count = allocations(&bodies, (basis, "surface", OPEN), threads, [120, 40]);
                assert!(
                    count < 50,
                    "{name} whose particles cross cells, {basis}, {threads} threads: {count} in 40 steps"
                );
            }
        }
    }
}
