//! Several numbers side by side in a register, on whatever the processor has.
//!
//! This is the only room that knows processors. Loops over particles are written once over [`Lanes`]; [`Processor::run`] compiles them for each
//! [`Machine`] and takes the best one at run time. Every operation rounds like that of a single number and multiplications
//! and additions are never contracted, so that results have the same bits on every machine.

mod pack;
mod pair;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use pack::Pack;
pub use pair::Pair;

use crate::number::{Number, Real};

/// Most lanes of any machine.
pub const MOST_LANES: usize = 8;

/// Numbers side by side.
pub trait Lanes: Number {
    /// The numbers.
    type Real: Real;
    /// How many.
    const COUNT: usize;

    /// The same number in every lane.
    fn splat(x: Self::Real) -> Self;

    /// `COUNT` numbers in a row.
    ///
    /// # Safety
    /// All of them must be there, and nobody may write to them meanwhile.
    unsafe fn load(first: *const Self::Real) -> Self;

    /// Writes `COUNT` numbers in a row.
    ///
    /// # Safety
    /// There must be room for all of them, and nobody may use it meanwhile.
    unsafe fn store(self, first: *mut Self::Real);

    /// Which lanes are not below another's, from the lowest bit on; none that is not a number.
    fn at_least(self, other: Self) -> u32;

    /// `count` numbers in a row, and the first in the lanes beyond.
    ///
    /// # Safety
    /// At least one and all of them must be there, and nobody may write to them meanwhile.
    #[inline(always)]
    unsafe fn load_part(first: *const Self::Real, count: usize) -> Self {
        // SAFETY: only the `count` numbers are read.
        Self::from_fn(|lane| unsafe { *first.add(if lane < count { lane } else { 0 }) })
    }

    /// Writes the first `count` numbers in a row.
    ///
    /// # Safety
    /// There must be room for them, and nobody may use it meanwhile.
    #[inline(always)]
    unsafe fn store_part(self, first: *mut Self::Real, count: usize) {
        let numbers = self.numbers();
        for (lane, &x) in numbers.0.iter().enumerate().take(count) {
            // SAFETY: only `count` numbers are written.
            unsafe { *first.add(lane) = x };
        }
    }

    /// The number `f(i)` in lane `i`.
    #[inline(always)]
    fn from_fn(mut f: impl FnMut(usize) -> Self::Real) -> Self {
        let mut numbers = Numbers([Self::Real::ZERO; MOST_LANES]);
        for (lane, x) in numbers.0.iter_mut().enumerate().take(Self::COUNT) {
            *x = f(lane);
        }
        // SAFETY: `numbers` is as long as any machine's lanes.
        unsafe { Self::load(numbers.0.as_ptr()) }
    }

    /// The lanes one by one, and zeros beyond.
    #[inline(always)]
    fn numbers(self) -> Numbers<Self::Real> {
        let mut numbers = Numbers([Self::Real::ZERO; MOST_LANES]);
        // SAFETY: `numbers` is as long as any machine's lanes.
        unsafe { self.store(numbers.0.as_mut_ptr()) };
        numbers
    }

    /// Writes the lanes of four registers as rows: in row `i` the lanes `i` of all four.
    #[inline(always)]
    fn store_rows(columns: [Self; 4], rows: &mut [[Self::Real; 4]; MOST_LANES]) {
        let columns =
            [columns[0].numbers(), columns[1].numbers(), columns[2].numbers(), columns[3].numbers()];
        for (i, row) in rows.iter_mut().enumerate().take(Self::COUNT) {
            for (entry, column) in row.iter_mut().zip(&columns) {
                *entry = column.0[i];
            }
        }
    }

    /// Cube root by Halley's iteration, y <- y (y^3 + 2x)/(2 y^3 + x), which triples the digits each time.
    #[inline(always)]
    fn cube_root(self) -> Self {
        let numbers = self.numbers();
        let mut y = Self::from_fn(|lane| numbers.0[lane].cube_root_guess());
        // 4 % -> 4e-5 -> 1e-13 -> exact.
        let iterations = if Self::Real::EPSILON.f64() > 1e-10 { 2 } else { 3 };
        for _ in 0..iterations {
            let cube = y * y * y;
            y *= (cube + (self + self)) / ((cube + cube) + self);
        }
        y
    }
}

/// Numbers of a group in memory.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Numbers<T>(pub [T; MOST_LANES]);

/// A kind of processor: how many numbers it holds side by side.
pub trait Machine<T>: Copy + 'static {
    /// Eight: as many particles as a cell in space holds as a rule.
    type Wide: Lanes<Real = T>;
    /// Four.
    type Quad: Lanes<Real = T>;
}

/// Every processor: arrays, which the compiler turns into whatever the build's target has (SSE2, NEON).
#[derive(Clone, Copy, Debug)]
pub struct Any;

impl<T: Real> Machine<T> for Any {
    type Wide = Pair<Pack<T, 4>>;
    type Quad = Pack<T, 4>;
}

/// Fetches the line of memory at a place into the cache, where the processor can be told to.
#[inline(always)]
pub fn prefetch<T>(place: *const T) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: every such processor has the instruction, and it has no effect but in the cache.
    unsafe {
        std::arch::x86_64::_mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(place.cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = place;
}

/// Work to be compiled for every machine.
pub trait Work {
    /// What it works with.
    type Real: Real;
    /// What comes of it.
    type Output;
    /// Does it. Must be `inline(always)` with all that it calls, else it is compiled for [`Any`] only.
    fn run<M: Machine<Self::Real>>(self) -> Self::Output;
}

/// What the processor at hand has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Processor {
    /// Nothing that the build does not assume anyway.
    Any,
    /// AVX2.
    Avx2,
    /// AVX-512 with its short vectors.
    Avx512,
}

impl Processor {
    /// The best that this processor has.
    pub fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if x86::has_avx512() {
                return Processor::Avx512;
            }
            if std::arch::is_x86_feature_detected!("avx2") {
                return Processor::Avx2;
            }
        }
        Processor::Any
    }

    /// All that this processor can run, the best last.
    pub fn available() -> impl Iterator<Item = Self> {
        let best = Self::best();
        [Processor::Any, Processor::Avx2, Processor::Avx512].into_iter().filter(move |&p| p <= best)
    }
}

/// Numbers that every machine holds side by side.
pub trait Laned: Real {
    /// Does work on a processor, which must be one of [`Processor::available`].
    fn run<W: Work<Real = Self>>(processor: Processor, work: W) -> W::Output;
}

macro_rules! laned {
    ($t:ty) => {
        impl Laned for $t {
            #[inline]
            fn run<W: Work<Real = Self>>(processor: Processor, work: W) -> W::Output {
                #[cfg(target_arch = "x86_64")]
                {
                    assert!(processor <= Processor::best(), "the processor has it");
                    match processor {
                        // SAFETY: the processor has AVX-512.
                        Processor::Avx512 => return unsafe { x86::avx512::<$t, W>(work) },
                        // SAFETY: the processor has AVX2.
                        Processor::Avx2 => return unsafe { x86::avx2::<$t, W>(work) },
                        Processor::Any => {}
                    }
                }
                #[cfg(not(target_arch = "x86_64"))]
                let _ = processor;
                work.run::<Any>()
            }
        }
    };
}
laned!(f32);
laned!(f64);

#[cfg(test)]
mod tests;
