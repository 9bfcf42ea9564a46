//! Lanes of x86-64 processors: which there are, and what their types have in common.

use super::Work;
use crate::number::Task;
use std::arch::x86_64::*;

/// A third of 2^33, rounded up: the upper bits of a product with it are a third, for every number of 32 bits.
const THIRD: i64 = 0xaaaa_aaab;

/// Whether the processor has all of AVX-512 that [`Avx512`] uses.
pub fn has_avx512() -> bool {
    std::arch::is_x86_feature_detected!("avx512f")
        && std::arch::is_x86_feature_detected!("avx512vl")
        && std::arch::is_x86_feature_detected!("avx512dq")
        && std::arch::is_x86_feature_detected!("avx512bw")
        && has_avx2()
}

/// Whether the processor has all that [`Avx2`] uses.
pub fn has_avx2() -> bool {
    std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
}

/// AVX-512.
#[derive(Clone, Copy)]
pub struct Avx512;

/// AVX2.
#[derive(Clone, Copy)]
pub struct Avx2;

/// Does work on a kind of number with one of them, in a module of its own: the compiler takes modules side by side, and
/// all kernels in one would keep one core busy while the others wait.
macro_rules! compiled_apart {
    ($module:ident: $t:ty, $machine:ident, $features:literal) => {
        pub mod $module {
            use super::{Work, $machine};

            /// Does work with it.
            ///
            /// # Safety
            /// The processor must have it.
            #[target_feature(enable = $features)]
            pub unsafe fn run<W: Work<Real = $t>>(work: W) -> W::Output {
                work.run::<$machine>()
            }
        }
    };
}
/// Does a task with AVX-512, see [`Number::apart`].
///
/// # Safety
/// The processor must have it.
#[inline(never)]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,fma")]
unsafe fn apart_avx512<J: Task>(task: J) -> J::Output {
    task.run()
}

/// Does a task with AVX2, see [`Number::apart`].
///
/// # Safety
/// The processor must have it.
#[inline(never)]
#[target_feature(enable = "avx2,fma")]
unsafe fn apart_avx2<J: Task>(task: J) -> J::Output {
    task.run()
}

compiled_apart!(double_avx512: f64, Avx512, "avx512f,avx512vl,avx512dq,avx512bw,fma");
compiled_apart!(single_avx512: f32, Avx512, "avx512f,avx512vl,avx512dq,avx512bw,fma");
compiled_apart!(double_avx2: f64, Avx2, "avx2,fma");
compiled_apart!(single_avx2: f32, Avx2, "avx2,fma");

macro_rules! operator {
    ($name:ident $(<const $flag:ident>)?, $op:ident $f:ident $assign:ident $g:ident $intrinsic:ident) => {
        impl $(<const $flag: bool>)? $op for $name $(<$flag>)? {
            type Output = Self;
            #[inline(always)]
            fn $f(self, other: Self) -> Self {
                // SAFETY: values of this type exist only where the processor has the instruction.
                unsafe { Self($intrinsic(self.0, other.0)) }
            }
        }
        impl $(<const $flag: bool>)? $assign for $name $(<$flag>)? {
            #[inline(always)]
            fn $g(&mut self, other: Self) {
                *self = self.$f(other);
            }
        }
    };
}

macro_rules! lanes {
    ($name:ident $(<const $flag:ident>)?: $register:ty as [$t:ty; $count:literal];
     $set:ident $load:ident $store:ident; $add:ident $sub:ident $mul:ident $div:ident;
     $sqrt:ident $min:ident $max:ident $times_plus:ident $apart:ident;
     |$a:ident, $b:ident| $at_least:expr; |$bits:ident, $there:ident, $elsewhere:ident| $select:expr;
     $($part:item)*) => {
        #[doc = concat!(stringify!($count), " numbers in a register.")]
        #[derive(Clone, Copy, Debug)]
        #[repr(transparent)]
        pub struct $name $(<const $flag: bool>)? ($register);

        operator! { $name $(<const $flag>)?, Add add AddAssign add_assign $add }
        operator! { $name $(<const $flag>)?, Sub sub SubAssign sub_assign $sub }
        operator! { $name $(<const $flag>)?, Mul mul MulAssign mul_assign $mul }
        operator! { $name $(<const $flag>)?, Div div DivAssign div_assign $div }

        impl $(<const $flag: bool>)? $name $(<$flag>)? {
            const fn constant(x: $t) -> Self {
                // SAFETY: a register is as large as an array of its lanes, and any bits are numbers.
                Self(unsafe { std::mem::transmute::<[$t; $count], $register>([x; $count]) })
            }
        }

        impl $(<const $flag: bool>)? Neg for $name $(<$flag>)? {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self::constant(-0.0) - self
            }
        }

        impl $(<const $flag: bool>)? Number for $name $(<$flag>)? {
            const ZERO: Self = Self::constant(0.0);
            const NOTHING: Self = Self::constant(-0.0);
            const ONE: Self = Self::constant(1.0);
            const HALF: Self = Self::constant(0.5);
            const EPSILON: Self = Self::constant(<$t>::EPSILON);
            const SIDE_BY_SIDE: usize = <Self as Lanes>::COUNT;
            #[inline(always)]
            fn at_least(self, other: Self) -> u32 {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: values of this type exist only where the processor has the instructions.
                unsafe { $at_least }
            }
            #[inline(always)]
            fn select(lanes: u32, there: Self, elsewhere: Self) -> Self {
                let ($bits, $there, $elsewhere) = (lanes, there.0, elsewhere.0);
                // SAFETY: values of this type exist only where the processor has the instructions.
                unsafe { Self($select) }
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
                Self::splat(value as $t)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: values of this type exist only where the processor has the instructions.
                unsafe { Self($sqrt(self.0)) }
            }
            #[inline(always)]
            fn cbrt(self) -> Self {
                self.cube_root()
            }
            #[inline(always)]
            fn ln(self) -> Self {
                let numbers = self.numbers();
                Self::from_fn(|lane| Number::ln(numbers.0[lane]))
            }
            #[inline(always)]
            fn exp(self) -> Self {
                let numbers = self.numbers();
                Self::from_fn(|lane| Number::exp(numbers.0[lane]))
            }
            #[inline(always)]
            fn abs(self) -> Self {
                self.max(-self)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                // SAFETY: values of this type exist only where the processor has the instructions.
                unsafe { Self($min(self.0, other.0)) }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                // SAFETY: values of this type exist only where the processor has the instructions.
                unsafe { Self($max(self.0, other.0)) }
            }
            #[inline(always)]
            fn times_plus(self, factor: Self, other: Self) -> Self {
                // SAFETY: values of this type exist only where the processor has the instructions.
                unsafe { Self($times_plus(self.0, factor.0, other.0)) }
            }
            #[inline(always)]
            fn apart<J: Task>(task: J) -> J::Output {
                // SAFETY: values of this type exist only where the processor has the instructions.
                unsafe { $apart(task) }
            }
        }

        impl $(<const $flag: bool>)? Lanes for $name $(<$flag>)? {
            type Real = $t;
            const COUNT: usize = $count;
            in_one_register!();
            #[inline(always)]
            fn splat(x: $t) -> Self {
                // SAFETY: values of this type exist only where the processor has the instructions.
                unsafe { Self($set(x)) }
            }
            #[inline(always)]
            unsafe fn load(first: *const $t) -> Self {
                // SAFETY: the caller's, and values of this type exist only where the processor has the instructions.
                unsafe { Self($load(first)) }
            }
            #[inline(always)]
            unsafe fn store(self, first: *mut $t) {
                // SAFETY: the caller's, and values of this type exist only where the processor has the instructions.
                unsafe { $store(first, self.0) }
            }
            $($part)*
        }
    };
}

mod double;
mod single;

/// Writes the columns of a 4 x 4 matrix as its rows.
#[inline(always)]
unsafe fn turn_pd([a, b, c, d]: [__m256d; 4], rows: *mut f64) {
    // SAFETY: the caller has AVX2 and room for sixteen numbers.
    unsafe {
        let [ab, cd] = [_mm256_unpacklo_pd(a, b), _mm256_unpacklo_pd(c, d)];
        let [ab_odd, cd_odd] = [_mm256_unpackhi_pd(a, b), _mm256_unpackhi_pd(c, d)];
        _mm256_storeu_pd(rows, _mm256_permute2f128_pd::<0x20>(ab, cd));
        _mm256_storeu_pd(rows.add(4), _mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd));
        _mm256_storeu_pd(rows.add(8), _mm256_permute2f128_pd::<0x31>(ab, cd));
        _mm256_storeu_pd(rows.add(12), _mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd));
    }
}

#[inline(always)]
fn mask(count: usize) -> u8 {
    ((1_u32 << count) - 1) as u8
}
