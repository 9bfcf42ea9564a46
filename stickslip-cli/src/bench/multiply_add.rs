//! How many multiply-adds a core does in a second, in the widest vectors that it has.
//!
//! Twelve independent chains of fused multiply-adds in registers: more than any core's units times the latency of one,
//! so that nothing waits and nothing is loaded.

use serde::{Deserialize, Serialize};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// What a core can do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MultiplyAdds {
    /// In `f64` [1/s].
    pub double: f64,
    /// In `f32` [1/s].
    pub single: f64,
}

/// A loop of so many rounds, and how many numbers a vector of it holds.
type Loop = (fn(u64), usize);

const CHAINS: usize = 12;
/// Rounds between two looks at the clock.
const ROUNDS: u64 = 100_000;
/// Values that keep every chain at 1 without the compiler knowing.
const NEAR: [f64; 2] = [0.5, 0.5];

/// A loop that does `rounds` times [`CHAINS`] vectors of multiply-adds.
macro_rules! chains {
    ($name:ident, $($feature:literal)?, $number:ty, $fill:path, $multiply_add:path) => {
        fn $name(rounds: u64) {
            $(#[target_feature(enable = $feature)])?
            fn chains(rounds: u64) {
                let [b, c] = black_box(NEAR).map(|value| $fill(value as $number));
                let mut sums = [$fill(black_box(1.0)); CHAINS];
                for _ in 0..rounds {
                    for sum in &mut sums {
                        *sum = $multiply_add(*sum, b, c);
                    }
                }
                black_box(sums);
            }
            // SAFETY: `best` gives out only what the processor has the instructions for.
            #[allow(unused_unsafe, reason = "some loops need no more than every processor has")]
            unsafe {
                chains(rounds)
            }
        }
    };
}

#[cfg(target_arch = "x86_64")]
mod vectors {
    use super::{CHAINS, Loop, NEAR, black_box};
    use std::arch::x86_64::*;
    use stickslip::lanes::Processor;

    chains!(wide_double, "avx512f", f64, _mm512_set1_pd, _mm512_fmadd_pd);
    chains!(wide_single, "avx512f", f32, _mm512_set1_ps, _mm512_fmadd_ps);
    chains!(double, "avx2,fma", f64, _mm256_set1_pd, _mm256_fmadd_pd);
    chains!(single, "avx2,fma", f32, _mm256_set1_ps, _mm256_fmadd_ps);

    /// Names of the instructions, and the loops in `f64` and `f32`.
    pub fn best() -> Option<(&'static str, [Loop; 2])> {
        match Processor::best() {
            Processor::Avx512 => Some(("AVX-512", [(wide_double, 8), (wide_single, 16)])),
            Processor::Avx2 => Some(("AVX2", [(double, 4), (single, 8)])),
            Processor::Any => None,
        }
    }
}

#[cfg(target_arch = "aarch64")]
mod vectors {
    use super::{CHAINS, Loop, NEAR, black_box};
    use std::arch::aarch64::*;

    chains!(double, "neon", f64, vdupq_n_f64, vfmaq_f64);
    chains!(single, "neon", f32, vdupq_n_f32, vfmaq_f32);

    /// Names of the instructions, and the loops in `f64` and `f32`.
    pub fn best() -> Option<(&'static str, [Loop; 2])> {
        // Every 64-bit ARM processor has it.
        Some(("NEON", [(double, 2), (single, 4)]))
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod vectors {
    use super::Loop;

    pub fn best() -> Option<(&'static str, [Loop; 2])> {
        None
    }
}

fn same<T>(value: T) -> T {
    value
}

fn separate_double(a: f64, b: f64, c: f64) -> f64 {
    a * b + c
}

fn separate_single(a: f32, b: f32, c: f32) -> f32 {
    a * b + c
}

chains!(plain_double,, f64, same, separate_double);
chains!(plain_single,, f32, same, separate_single);

/// The widest instructions that this program knows and this processor has.
fn best() -> (&'static str, [Loop; 2]) {
    vectors::best().unwrap_or(("scalar", [(plain_double, 1), (plain_single, 1)]))
}

/// Name of the instructions that [`multiply_adds`] uses.
pub fn instructions() -> &'static str {
    best().0
}

/// What the calling thread's core does at best, measured for so long in each number format.
pub fn multiply_adds(duration: Duration) -> MultiplyAdds {
    let [double, single] = best().1.map(|(run, lanes)| {
        run(ROUNDS); // The clock rises to its full rate, and wide units wake up.
        let begin = Instant::now();
        let mut best: f64 = 0.0;
        while best == 0.0 || begin.elapsed() < duration {
            let start = Instant::now();
            run(ROUNDS);
            best = best.max((ROUNDS * (CHAINS * lanes) as u64) as f64 / start.elapsed().as_secs_f64());
        }
        best
    });
    MultiplyAdds { double, single }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_core_does_something() {
        let rate = multiply_adds(Duration::from_millis(2));
        assert!(rate.double > 1e6 && rate.single > 1e6, "{rate:?}");
    }
}
