//! What a scene takes in memory while it is read, over the length of its text.
//!
//! The text is copied once, as the source of what errors show. TOML's parser takes 24 bytes for each of its tokens
//! and 48 for a value with its place, in lists that double as they grow; a node of ours takes 64. A row `[123456,4],`
//! is six tokens and three values in twelve letters, which makes 12 + 12 + 16 bytes a letter before lists grow: 60
//! hold it. Trees that were copied for each key, with the whole path in each of their nodes, took 264.

use std::alloc::{GlobalAlloc, Layout, System};
use std::fmt::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use stickslip_scene::scene;

/// The system's allocator, which knows how much is taken and how much was at most.
struct Weighing;

static TAKEN: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);
/// One test at a time is weighed.
static ALONE: Mutex<()> = Mutex::new(());

impl Weighing {
    fn take(bytes: usize) {
        MOST.fetch_max(TAKEN.fetch_add(bytes, Ordering::Relaxed) + bytes, Ordering::Relaxed);
    }

    fn give(bytes: usize) {
        TAKEN.fetch_sub(bytes, Ordering::Relaxed);
    }
}

// SAFETY: everything is the system's doing.
unsafe impl GlobalAlloc for Weighing {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Weighing::take(layout.size());
        // SAFETY: the caller's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        Weighing::give(layout.size());
        // SAFETY: the caller's.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        Weighing::take(size);
        Weighing::give(layout.size());
        // SAFETY: the caller's.
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Weighing = Weighing;

const ROWS: usize = 100_000;

fn scene_with(body: &str, rest: &str) -> String {
    format!(
        "space = {{ dimension = '2d', cell = 0.1 }}\ntime.end = 1\n\
         materials.m = {{ density = 1, neo_hookean = {{ young_modulus = 9, poisson_ratio = 0 }} }}\n\
         [[bodies]]\nname = 'b'\nmaterial = 'm'\n{body}\n{rest}\n"
    )
}

fn rows(row: impl Fn(usize) -> String) -> String {
    (0..ROWS).fold(String::new(), |mut all, i| {
        write!(all, "{},", row(i)).expect("text takes it");
        all
    })
}

/// Bytes at most while a text is read, over its own.
fn weight(text: &str) -> f64 {
    let before = TAKEN.load(Ordering::Relaxed);
    MOST.store(before, Ordering::Relaxed);
    let read = scene::parse("a.toml", text, &[]);
    let most = MOST.load(Ordering::Relaxed) - before;
    read.unwrap_or_else(|error| panic!("{error}"));
    most as f64 / text.len() as f64
}

#[test]
fn a_letter_of_a_long_list_takes_some_tens_of_bytes() {
    let _alone = ALONE.lock();
    let ball = "shape.ball = { center = [0, 0], radius = 1 }";
    let table = rows(|i| format!("[{},{}]", 100_000 + i, i % 7));
    let load = format!("loads = [{{ body = 'b', force = [{{ table = [{table}] }}, 0] }}]");
    let load = scene_with(ball, "").replacen("[[bodies]]", &format!("{load}\n[[bodies]]"), 1);
    let corner = |i: usize| std::f64::consts::TAU * i as f64 / ROWS as f64;
    let corners = rows(|i| format!("[{:.6},{:.6}]", corner(i).cos(), corner(i).sin()));
    let polygon = scene_with(&format!("shape.polygon.points = [{corners}]"), "");
    let quoted = rows(|i| format!("['{i} s','{} N']", i % 7));
    let quoted = format!("loads = [{{ body = 'b', force = [{{ table = [{quoted}] }}, 0] }}]");
    let quoted = scene_with(ball, "").replacen("[[bodies]]", &format!("{quoted}\n[[bodies]]"), 1);
    for (what, text) in [("a table", load), ("a polygon", polygon), ("quantities", quoted)] {
        let weight = weight(&text);
        println!("{what}: {weight:.1} bytes a letter");
        assert!(weight < 60.0, "{what}: {weight:.0} bytes a letter");
    }
}

/// Lines and columns by counting letters: rows of eleven in one line, whose values begin two behind theirs.
#[test]
fn a_mistake_deep_in_a_long_list_has_its_key_and_place() {
    let _alone = ALONE.lock();
    let table = rows(|i| format!("[{},{}]", 100_000 + i, i % 7));
    let wrong = table.replacen("[170000,0]", "[170000,'1 m']", 1);
    let before = "force = [{ table = [";
    let text = scene_with(
        "shape.ball = { center = [0, 0], radius = 1 }",
        &format!("[[loads]]\nbody = 'b'\n{before}{wrong}] }}, 0]"),
    );
    let error = scene::parse("a.toml", &text, &[]).expect_err("a length is no force").to_string();
    let column = before.len() + 11 * 70_000 + "[170000,".len() + 1;
    let place = format!("a.toml:10:{column}: loads[0].force[0].table[70000][1]: found \"1 m\"");
    assert!(error.starts_with(&place), "{error:.300}");
}
