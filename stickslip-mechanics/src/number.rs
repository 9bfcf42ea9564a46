//! Numbers: one at a time, [`Real`], or several side by side in a register, [`crate::lanes`].
//!
//! Laws and shape functions are written over [`Number`], so that the same text serves one particle and a group of them.

use std::fmt::Debug;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// What laws compute with: a real number, or several side by side.
///
/// Every operation rounds as IEEE 754 says, so that one number and each of several have the same bits,
/// but for [`Number::times_plus`].
pub trait Number:
    Copy
    + Debug
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + 'static
{
    /// 0.
    const ZERO: Self;
    /// -0, the sum of nothing: adding to it changes no bit, so that a sum that begins with it takes one addition less.
    const NOTHING: Self;
    /// 1.
    const ONE: Self;
    /// 1/2.
    const HALF: Self;
    /// Distance from 1 to the next number.
    const EPSILON: Self;
    /// The nearest number to an `f64`.
    fn of(value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Cube root of a positive, normal number, to within an ulp or two.
    fn cbrt(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// e to this power.
    fn exp(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// The smaller of two numbers.
    fn min(self, other: Self) -> Self;
    /// The larger of two numbers.
    fn max(self, other: Self) -> Self;
    /// How many stand side by side.
    const SIDE_BY_SIDE: usize;
    /// Which lanes are not below another's, from the lowest bit on; none that is not a number.
    fn at_least(self, other: Self) -> u32;
    /// One number in the lanes whose bits are set, another in the rest.
    fn select(lanes: u32, there: Self, elsewhere: Self) -> Self;
    /// The one in a lane.
    fn lane(self, lane: usize) -> f64;
    /// Each lane's number from a function: the nearest to what it returns.
    fn from_lanes(f: impl FnMut(usize) -> f64) -> Self;
    /// self * factor + other. Single numbers round the product and the sum; several side by side round once where the
    /// processor has an instruction for that ([`crate::lanes::Processor::fuses`]).
    #[inline(always)]
    fn times_plus(self, factor: Self, other: Self) -> Self {
        self * factor + other
    }
    /// Does a task in a function of its own, with the instructions that these numbers have: it is compiled once for
    /// each kind of number, not into every loop that asks for it.
    #[inline(never)]
    fn apart<J: Task>(task: J) -> J::Output {
        task.run()
    }
}

/// What [`Number::apart`] does.
pub trait Task {
    /// What comes of it.
    type Output;
    /// Does it. Must be `inline(always)` with all that it calls.
    fn run(self) -> Self::Output;
}

/// A floating-point number: `f32` or `f64`.
///
/// Transcendental functions come from `libm`, so that every build gives the same bits.
pub trait Real: Number + Default + PartialOrd + Sum {
    /// The smallest positive number of full precision.
    const TINY: Self;
    /// The largest finite number.
    const LARGEST: Self;
    /// The same number in `f64`.
    fn f64(self) -> f64;
    /// Largest integer not above.
    fn floor(self) -> i32;
    /// Neither infinite nor not a number.
    fn is_finite(self) -> bool;
    /// self * factor + other, rounded once.
    fn fused(self, factor: Self, other: Self) -> Self;
    /// One over the cube root of a positive, normal number, to within 4 %.
    fn inverse_cube_root_guess(self) -> Self;
}

macro_rules! real {
    ($t:ty, $cbrt:path, $ln:path, $exp:path, $guess:expr) => {
        impl Number for $t {
            const ZERO: Self = 0.0;
            const NOTHING: Self = -0.0;
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const EPSILON: Self = <$t>::EPSILON;
            const SIDE_BY_SIDE: usize = 1;
            #[inline(always)]
            fn at_least(self, other: Self) -> u32 {
                u32::from(self >= other)
            }
            #[inline(always)]
            fn select(lanes: u32, there: Self, elsewhere: Self) -> Self {
                if lanes & 1 == 1 { there } else { elsewhere }
            }
            #[inline(always)]
            fn lane(self, _lane: usize) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn from_lanes(mut f: impl FnMut(usize) -> f64) -> Self {
                f(0) as $t
            }
            #[inline(always)]
            fn of(value: f64) -> Self {
                value as $t
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn cbrt(self) -> Self {
                $cbrt(self)
            }
            #[inline(always)]
            fn ln(self) -> Self {
                $ln(self)
            }
            #[inline(always)]
            fn exp(self) -> Self {
                $exp(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                self.abs()
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                self.min(other)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                self.max(other)
            }
        }

        impl Real for $t {
            const TINY: Self = <$t>::MIN_POSITIVE;
            const LARGEST: Self = <$t>::MAX;
            #[inline(always)]
            fn f64(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn floor(self) -> i32 {
                let truncated = self as i32;
                truncated - i32::from(truncated as $t > self)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                self.is_finite()
            }
            #[inline(always)]
            fn fused(self, factor: Self, other: Self) -> Self {
                self.mul_add(factor, other)
            }
            #[inline(always)]
            fn inverse_cube_root_guess(self) -> Self {
                <$t>::from_bits($guess(self.to_bits()))
            }
        }
    };
}
// Dividing the bits by three divides the exponent by three; the constants make up for its bias and spread the error
// evenly.
real!(f32, libm::cbrtf, libm::logf, libm::expf, |bits: u32| CUBE_ROOT_F32.wrapping_sub(bits / 3));
real!(f64, libm::cbrt, libm::log, libm::exp, |bits: u64| CUBE_ROOT_F64.wrapping_sub((bits >> 32) / 3) << 32);

/// Bits from which to take a third of those of an `f32`, see [`Real::inverse_cube_root_guess`].
pub const CUBE_ROOT_F32: u32 = 1_419_917_306;
/// The same for the upper half of the bits of an `f64`.
pub const CUBE_ROOT_F64: u64 = 1_430_188_458;
