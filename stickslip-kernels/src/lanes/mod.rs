//! Several numbers side by side in a register, on whatever the processor has.
//!
//! This is the only room that knows processors. Loops over particles are written once over [`Lanes`];
//! [`Processor::run`] compiles them for each [`Machine`] and takes the best one at run time. Every operation rounds
//! like that of a single number, and where the source says so ([`Number::times_plus`]) a product and a sum are rounded
//! together, once. All processors that can do so give the same bits: x86-64 with AVX2 and FMA, and 64-bit ARM. Those
//! that cannot round twice, and differ by round-off.

/// What lanes in a single register have of [`Lanes`].
macro_rules! in_one_register {
    () => {
        type Register = Self;
        const REGISTERS: usize = 1;

        #[inline(always)]
        fn register(self, _: usize) -> Self {
            self
        }

        #[inline(always)]
        fn put(&mut self, _: usize, register: Self) {
            *self = register;
        }
    };
}

mod pack;
mod pair;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use pack::Pack;
pub use pair::RegisterPair;

use crate::number::{Number, Real};
use std::sync::OnceLock;

/// Most lanes of any machine.
pub const MOST_LANES: usize = 8;

/// Numbers side by side.
pub trait Lanes: Number {
    /// The numbers.
    type Real: Real;
    /// What one register holds of them.
    type Register: Lanes<Real = Self::Real>;
    /// How many.
    const COUNT: usize;
    /// How many registers hold them: sums of many terms go through one after the other, lest they spill.
    const REGISTERS: usize;

    /// The lanes of the `n`-th register.
    fn register(self, n: usize) -> Self::Register;

    /// Gives the lanes of the `n`-th register.
    fn put(&mut self, n: usize, register: Self::Register);

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

    /// At most `COUNT` numbers in a row, and `rest` in the lanes beyond.
    ///
    /// # Safety
    /// `count` numbers must be there, and nobody may write to them meanwhile.
    #[inline(always)]
    unsafe fn load_part(first: *const Self::Real, count: usize, rest: Self::Real) -> Self {
        // SAFETY: only the `count` numbers are read.
        Self::from_fn(|lane| if lane < count { unsafe { *first.add(lane) } } else { rest })
    }

    /// The first `count` numbers in a row, at most `COUNT`, and zero in the lanes beyond.
    ///
    /// # Safety
    /// As for [`Lanes::load_part`].
    #[inline(always)]
    unsafe fn load_first(first: *const Self::Real, count: usize) -> Self {
        // SAFETY: the caller's.
        unsafe {
            if count >= Self::COUNT {
                Self::load(first)
            } else {
                Self::load_part(first, count, Self::Real::ZERO)
            }
        }
    }

    /// Writes the first `count` lanes, at most `COUNT`, in a row.
    ///
    /// # Safety
    /// There must be room for them, and nobody else may use it meanwhile.
    #[inline(always)]
    unsafe fn store_part(self, first: *mut Self::Real, count: usize) {
        let numbers = self.numbers();
        for (lane, &x) in numbers.0.iter().enumerate().take(count) {
            // SAFETY: the caller's.
            unsafe { *first.add(lane) = x }
        }
    }

    /// Numbers that lie anyhow: in lane `i` the one at place `index[i]`.
    ///
    /// # Safety
    /// They must be there, and nobody may write to them meanwhile.
    #[inline(always)]
    unsafe fn gather(first: *const Self::Real, index: &[usize; MOST_LANES]) -> Self {
        // SAFETY: the caller's.
        Self::from_fn(|lane| unsafe { *first.add(index[lane]) })
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

    /// Two numbers over and over.
    #[inline(always)]
    fn alternate(pair: [Self::Real; 2]) -> Self {
        Self::from_fn(|lane| pair[lane % 2])
    }

    /// Sums of neighbours, of one and another in turn:  a_0 + a_1, b_0 + b_1, a_2 + a_3, b_2 + b_3, ...
    #[inline(always)]
    fn add_neighbours(self, other: Self) -> Self {
        let (a, b) = (self.numbers(), other.numbers());
        Self::from_fn(|lane| {
            let pair = if lane % 2 == 0 { &a.0 } else { &b.0 };
            pair[lane / 2 * 2] + pair[lane / 2 * 2 + 1]
        })
    }

    /// In all of four lanes that stand together the `n`-th of them.
    #[inline(always)]
    fn every_fourth(self, n: usize) -> Self {
        let numbers = self.numbers();
        Self::from_fn(|lane| numbers.0[lane / 4 * 4 + n])
    }

    /// In lane `i` the number of lane `order[i]`.
    #[inline(always)]
    fn permuted(self, order: [usize; MOST_LANES]) -> Self {
        let numbers = self.numbers();
        Self::from_fn(|lane| numbers.0[order[lane]])
    }

    /// The first `count` lanes, and zero beyond.
    #[inline(always)]
    fn first(self, count: usize) -> Self {
        let numbers = self.numbers();
        Self::from_fn(|lane| if lane < count { numbers.0[lane] } else { Self::Real::ZERO })
    }

    /// The sums over the lanes of four registers: of eight lanes those with the ones four after them first, then
    /// neighbours.
    #[inline(always)]
    fn sums(columns: [Self; 4]) -> [Self::Real; 4] {
        columns.map(|column| {
            let Numbers([a, b, c, d, e, f, g, h]) = column.numbers();
            if Self::COUNT > 4 { ((a + e) + (b + f)) + ((c + g) + (d + h)) } else { (a + b) + (c + d) }
        })
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

    /// Writes the lanes of four registers by pairs: first the lanes 0 and 1 of all four, then the lanes 2 and 3,
    /// and so on; a single lane has zero beside it.
    ///
    /// # Safety
    /// There must be room for eight numbers a pair, which nobody else may use meanwhile.
    #[inline(always)]
    unsafe fn store_pairs(columns: [Self; 4], pairs: *mut Self::Real) {
        let columns =
            [columns[0].numbers(), columns[1].numbers(), columns[2].numbers(), columns[3].numbers()];
        for pair in 0..Self::COUNT.div_ceil(2) {
            for (entry, column) in columns.iter().enumerate() {
                for lane in 0..2 {
                    // SAFETY: the caller's.
                    unsafe { pairs.add(8 * pair + 2 * entry + lane).write(column.0[2 * pair + lane]) };
                }
            }
        }
    }

    /// [`Real::inverse_cube_root_guess`] of every lane.
    #[inline(always)]
    fn inverse_cube_root_guess(self) -> Self {
        let numbers = self.numbers();
        Self::from_fn(|lane| numbers.0[lane].inverse_cube_root_guess())
    }

    /// Cube root without a division: r = x^(-1/3) by r <- r (1 + h/3 + 2 h^2/9), h = 1 - x r^3, which triples the
    /// digits each time, and then one step of Newton's for x r^2.
    #[inline(always)]
    fn cube_root(self) -> Self {
        let (third, ninths) = (Self::of(1.0 / 3.0), Self::of(2.0 / 9.0));
        let mut r = self.inverse_cube_root_guess();
        // 4 % -> 2e-4 -> 3e-11
        for _ in 0..2 {
            let h = (-self).times_plus(r * r * r, Self::ONE);
            r = r.times_plus(h * h.times_plus(ninths, third), r);
        }
        let square = r * r;
        let y = self * square;
        let excess = (y * y).times_plus(y, -self);
        (-excess).times_plus(square * third, y)
    }
}

/// Indices for [`Lanes::gather`]: one for each lane, and the first again in the lanes beyond.
#[inline(always)]
pub fn in_lanes(index: &[u32]) -> [usize; MOST_LANES] {
    let mut lanes = [index[0] as usize; MOST_LANES];
    for (lane, &i) in lanes.iter_mut().zip(index) {
        *lane = i as usize;
    }
    lanes
}

/// Numbers of a group in memory.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Numbers<T>(pub [T; MOST_LANES]);

impl<T: Real> Numbers<T> {
    /// Zeros.
    pub const ZERO: Self = Numbers([T::ZERO; MOST_LANES]);
}

/// A kind of processor: how many numbers it holds side by side.
pub trait Machine<T>: Copy + 'static {
    /// Eight: as many particles as a cell in space holds as a rule.
    type Wide: Lanes<Real = T>;
    /// Four.
    type Quad: Lanes<Real = T>;

    /// The sums of the first four lanes and the last four.
    fn halves(wide: Self::Wide) -> Self::Quad;
}

/// Every processor: arrays, which the compiler turns into whatever the build's target has (SSE2, NEON).
#[derive(Clone, Copy, Debug)]
pub struct Any;

impl<T: Real> Machine<T> for Any {
    type Wide = RegisterPair<Pack<T, 4>>;
    type Quad = Pack<T, 4>;

    #[inline(always)]
    fn halves(RegisterPair(lower, upper): Self::Wide) -> Self::Quad {
        lower + upper
    }
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
    /// Whether it is compiled for AVX-512 as well, where AVX2 would do with the same bits: what takes most of the time
    /// of runs is.
    const BY_AVX512: bool = false;
    /// Does it. Must be `inline(always)` with all that it calls, else it is compiled for [`Any`] only.
    fn run<M: Machine<Self::Real>>(self) -> Self::Output;
    /// Does it on [`Processor::Any`], by arrays if there is no leaner way.
    #[inline(always)]
    fn run_anywhere(self) -> Self::Output
    where
        Self: Sized,
    {
        self.run::<Any>()
    }
}

/// What the processor at hand has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Processor {
    /// Nothing that the build does not assume anyway.
    Any,
    /// AVX2 with fused multiplication and addition.
    Avx2,
    /// AVX-512 with its short vectors.
    Avx512,
}

impl Processor {
    /// The variable that limits the instructions: to `avx2`, or to `base`, those that the build assumes.
    pub const LIMIT: &str = "STICKSLIP_INSTRUCTIONS";

    /// The best that this processor has, or that [`Processor::LIMIT`] allows.
    pub fn best() -> Self {
        static BEST: OnceLock<Processor> = OnceLock::new();
        *BEST.get_or_init(|| Self::here().min(Self::limit().unwrap_or(Processor::Avx512)))
    }

    /// What [`Processor::LIMIT`] allows at most.
    ///
    /// # Errors
    /// It says something else: what was found and what is allowed.
    pub fn limit() -> Result<Self, String> {
        match std::env::var_os(Self::LIMIT) {
            None => Ok(Processor::Avx512),
            Some(limit) if limit == "avx2" => Ok(Processor::Avx2),
            Some(limit) if limit == "base" => Ok(Processor::Any),
            Some(other) => Err(format!(
                "the variable {}: found {}, allowed: avx2, base, or no such variable",
                Self::LIMIT,
                other.to_string_lossy()
            )),
        }
    }

    fn here() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if x86::has_avx512() {
                return Processor::Avx512;
            }
            if x86::has_avx2() {
                return Processor::Avx2;
            }
        }
        Processor::Any
    }

    /// Whether a product and a sum are rounded once, see [`Number::times_plus`].
    pub fn fuses(self) -> bool {
        self != Processor::Any || pack::FUSES
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
    ($t:ty, $avx512:ident, $avx2:ident) => {
        impl Laned for $t {
            #[inline]
            fn run<W: Work<Real = Self>>(processor: Processor, work: W) -> W::Output {
                #[cfg(target_arch = "x86_64")]
                {
                    assert!(processor <= Processor::best(), "the processor has it");
                    match processor {
                        // SAFETY: the processor has AVX-512.
                        Processor::Avx512 if W::BY_AVX512 => return unsafe { x86::$avx512::run(work) },
                        // SAFETY: the processor has AVX2: those with AVX-512 do.
                        Processor::Avx512 | Processor::Avx2 => return unsafe { x86::$avx2::run(work) },
                        Processor::Any => {}
                    }
                }
                #[cfg(not(target_arch = "x86_64"))]
                let _ = processor;
                work.run_anywhere()
            }
        }
    };
}
laned!(f32, single_avx512, single_avx2);
laned!(f64, double_avx512, double_avx2);

#[cfg(test)]
mod tests;
