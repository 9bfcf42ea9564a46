//! What the machine itself can do: copy memory, multiply and add.

use super::multiply_add::{MultiplyAdds, multiply_adds};
use serde::{Deserialize, Serialize};
use std::hint::black_box;
use std::sync::Barrier;
use std::time::{Duration, Instant};
use stickslip::pages::ask_for_large;

/// The limits of so many threads together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Threads.
    pub threads: usize,
    /// Bytes read plus bytes written in a second of copying arrays that no cache holds [1/s].
    pub copy: f64,
    /// Multiply-adds in a second in registers.
    pub multiply_add: MultiplyAdds,
}

/// How thoroughly limits are measured.
#[derive(Clone, Copy, Debug)]
pub struct Care {
    /// Bytes that each thread copies from one array to another.
    pub bytes: usize,
    /// Time for each rate.
    pub duration: Duration,
}

/// Measures all threads at once; the copy is the best of several, as whatever disturbs a copy makes it slower.
pub fn measure(threads: usize, care: Care) -> Limits {
    let barrier = Barrier::new(threads);
    let each: Vec<(f64, MultiplyAdds)> = std::thread::scope(|scope| {
        let start = || (copy(care, &barrier), in_step(&barrier, || multiply_adds(care.duration)));
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(start)).collect();
        running.into_iter().map(|thread| thread.join().expect("no measurement panics")).collect()
    });
    Limits {
        threads,
        copy: each.iter().map(|(copy, _)| copy).sum(),
        multiply_add: MultiplyAdds {
            double: each.iter().map(|(_, rate)| rate.double).sum(),
            single: each.iter().map(|(_, rate)| rate.single).sum(),
        },
    }
}

fn in_step<R>(barrier: &Barrier, measure: impl FnOnce() -> R) -> R {
    barrier.wait();
    measure()
}

/// Bytes read plus bytes written in a second by this thread, while the others copy too.
fn copy(care: Care, barrier: &Barrier) -> f64 {
    let numbers = care.bytes / size_of::<u64>();
    // In pages as large as the engine's.
    let filled = |number: u64| {
        let mut array = Vec::with_capacity(numbers);
        ask_for_large(array.as_ptr(), numbers);
        array.resize(numbers, number);
        array
    };
    let (from, mut to) = (filled(1), filled(2));
    in_step(barrier, || {
        let mut best: f64 = 0.0;
        let begin = Instant::now();
        while best == 0.0 || begin.elapsed() < care.duration {
            let start = Instant::now();
            to.copy_from_slice(black_box(&from));
            black_box(&mut to);
            best = best.max((2 * size_of_val(&from[..])) as f64 / start.elapsed().as_secs_f64());
        }
        best
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_thread_adds_to_the_limits() {
        let care = Care { bytes: 1 << 16, duration: Duration::from_millis(1) };
        let limits = measure(2, care);
        assert_eq!(limits.threads, 2);
        assert!(limits.copy > 1e6 && limits.multiply_add.double > 1e6, "{limits:?}");
    }
}
