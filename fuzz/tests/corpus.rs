//! Inputs that fuzzing has found, and sound ones: none panics, takes long, or takes much memory.
//!
//! `fuzz/run` finds them; what it finds is kept in `corpus/`, by the names of the targets.

use peak_alloc::PeakAlloc;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};
use stickslip_fuzz::{TARGETS, Target, prepare};

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Memory that an input of some KiB may take [MiB].
const MOST_MEMORY: f32 = 1024.0;
/// Time that it may take, on a machine that does something else beside.
const LONGEST: Duration = Duration::from_secs(20);

fn replay(target: &Target, what: &str, bytes: &[u8]) {
    ALLOCATOR.reset_peak_usage();
    let begun = Instant::now();
    (target.run)(bytes);
    let (time, memory) = (begun.elapsed(), ALLOCATOR.peak_usage_as_mb());
    assert!(time < LONGEST, "{} {what}: it took {time:?}", target.name);
    assert!(memory < MOST_MEMORY, "{} {what}: it took {memory} MiB", target.name);
}

/// One test: peaks of memory are those of the whole program.
#[test]
fn nothing_that_was_found_does_harm() {
    prepare();
    for target in TARGETS {
        for (i, seed) in (target.seeds)().iter().enumerate() {
            assert!(seed.len() <= target.longest, "{} seed {i}: {} bytes", target.name, seed.len());
            replay(target, &format!("seed {i}"), seed);
        }
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target.name);
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
        paths.sort();
        for path in paths {
            let bytes = fs::read(&path).expect("a file of the repository");
            eprintln!("{}", path.display());
            replay(target, &path.display().to_string(), &bytes);
        }
    }
}
