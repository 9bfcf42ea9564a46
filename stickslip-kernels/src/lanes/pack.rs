//! Lanes as an array: what every machine can do.

use super::Lanes;
use crate::number::{Number, Real};
use crate::tensor::array;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// Whether every processor that this build is for multiplies and adds with one rounding.
pub const FUSES: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

/// `N` numbers in an array.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Pack<T, const N: usize>(pub [T; N]);

impl<T: Real, const N: usize> Pack<T, N> {
    #[inline(always)]
    fn map(self, f: impl Fn(T) -> T) -> Self {
        Pack(array(T::ZERO, |i| f(self.0[i])))
    }

    #[inline(always)]
    fn with(self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        Pack(array(T::ZERO, |i| f(self.0[i], other.0[i])))
    }
}

macro_rules! lanewise {
    ($op:ident, $f:ident, $assign:ident, $g:ident) => {
        impl<T: Real, const N: usize> $op for Pack<T, N> {
            type Output = Self;
            #[inline(always)]
            fn $f(self, other: Self) -> Self {
                self.with(other, |a, b| a.$f(b))
            }
        }
        impl<T: Real, const N: usize> $assign for Pack<T, N> {
            #[inline(always)]
            fn $g(&mut self, other: Self) {
                *self = self.$f(other);
            }
        }
    };
}
lanewise!(Add, add, AddAssign, add_assign);
lanewise!(Sub, sub, SubAssign, sub_assign);
lanewise!(Mul, mul, MulAssign, mul_assign);
lanewise!(Div, div, DivAssign, div_assign);

impl<T: Real, const N: usize> Neg for Pack<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl<T: Real, const N: usize> Number for Pack<T, N> {
    const ZERO: Self = Pack([T::ZERO; N]);
    const NOTHING: Self = Pack([T::NOTHING; N]);
    const ONE: Self = Pack([T::ONE; N]);
    const HALF: Self = Pack([T::HALF; N]);
    const EPSILON: Self = Pack([T::EPSILON; N]);
    const SIDE_BY_SIDE: usize = N;
    #[inline(always)]
    fn at_least(self, other: Self) -> u32 {
        (0..N).fold(0, |bits, i| bits | u32::from(self.0[i] >= other.0[i]) << i)
    }
    #[inline(always)]
    fn select(lanes: u32, there: Self, elsewhere: Self) -> Self {
        Pack(array(T::ZERO, |i| if lanes >> i & 1 == 1 { there.0[i] } else { elsewhere.0[i] }))
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        Number::lane(self.numbers().0[lane], 0)
    }
    #[inline(always)]
    fn from_lanes(mut f: impl FnMut(usize) -> f64) -> Self {
        <Self as Lanes>::from_fn(|lane| Number::of(f(lane)))
    }
    #[inline(always)]
    fn of(value: f64) -> Self {
        Pack([T::of(value); N])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(Number::sqrt)
    }
    #[inline(always)]
    fn cbrt(self) -> Self {
        self.cube_root()
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.map(T::ln)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        self.map(T::exp)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(T::abs)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.with(other, T::min)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.with(other, T::max)
    }
    #[inline(always)]
    fn times_plus(self, factor: Self, other: Self) -> Self {
        if FUSES {
            Pack(array(T::ZERO, |i| self.0[i].fused(factor.0[i], other.0[i])))
        } else {
            self * factor + other
        }
    }
}

impl<T: Real, const N: usize> Lanes for Pack<T, N> {
    type Real = T;
    const COUNT: usize = N;
    in_one_register!();

    #[inline(always)]
    fn splat(x: T) -> Self {
        Pack([x; N])
    }

    #[inline(always)]
    unsafe fn load(first: *const T) -> Self {
        // SAFETY: the caller has `N` numbers there; an array is aligned as its entries.
        unsafe { *first.cast::<Self>() }
    }

    #[inline(always)]
    unsafe fn store(self, first: *mut T) {
        // SAFETY: the caller has room for `N` numbers there; an array is aligned as its entries.
        unsafe { *first.cast::<Self>() = self }
    }
}
