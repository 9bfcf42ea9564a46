//! Lanes of x86-64 processors.

use super::{Lanes, MOST_LANES, Machine, Pair, Work};
use crate::number::Number;
use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// Whether the processor has all of AVX-512 that [`avx512`] uses.
pub fn has_avx512() -> bool {
    std::arch::is_x86_feature_detected!("avx512f")
        && std::arch::is_x86_feature_detected!("avx512vl")
        && std::arch::is_x86_feature_detected!("avx512dq")
        && std::arch::is_x86_feature_detected!("avx512bw")
}

/// AVX-512.
#[derive(Clone, Copy)]
pub struct Avx512;

/// AVX2.
#[derive(Clone, Copy)]
pub struct Avx2;

impl Machine<f64> for Avx512 {
    type Wide = F64x8;
    type Quad = F64x4;
}
impl Machine<f32> for Avx512 {
    type Wide = F32x8;
    type Quad = F32x4;
}
impl Machine<f64> for Avx2 {
    type Wide = Pair<F64x4>;
    type Quad = F64x4;
}
impl Machine<f32> for Avx2 {
    type Wide = F32x8;
    type Quad = F32x4;
}

/// Does work with AVX-512.
///
/// # Safety
/// The processor must have it, see [`has_avx512`].
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
pub unsafe fn avx512<T, W: Work<Real = T>>(work: W) -> W::Output
where
    Avx512: Machine<T>,
{
    work.run::<Avx512>()
}

/// Does work with AVX2.
///
/// # Safety
/// The processor must have it.
#[target_feature(enable = "avx2")]
pub unsafe fn avx2<T, W: Work<Real = T>>(work: W) -> W::Output
where
    Avx2: Machine<T>,
{
    work.run::<Avx2>()
}

macro_rules! operators {
    ($name:ident, $($op:ident $f:ident $assign:ident $g:ident $intrinsic:ident;)*) => {
        $(
            impl $op for $name {
                type Output = Self;
                #[inline(always)]
                fn $f(self, other: Self) -> Self {
                    // SAFETY: values of this type exist only where the processor has the instruction.
                    unsafe { $name($intrinsic(self.0, other.0)) }
                }
            }
            impl $assign for $name {
                #[inline(always)]
                fn $g(&mut self, other: Self) {
                    *self = self.$f(other);
                }
            }
        )*
    };
}

macro_rules! lanes {
    ($name:ident: $register:ty as [$t:ty; $count:literal];
     $set:ident $load:ident $store:ident; $add:ident $sub:ident $mul:ident $div:ident;
     $sqrt:ident $min:ident $max:ident;
     |$a:ident, $b:ident| $at_least:expr; $($part:item)*) => {
        #[doc = concat!(stringify!($count), " numbers in a register.")]
        #[derive(Clone, Copy, Debug)]
        #[repr(transparent)]
        pub struct $name($register);

        operators! { $name,
            Add add AddAssign add_assign $add;
            Sub sub SubAssign sub_assign $sub;
            Mul mul MulAssign mul_assign $mul;
            Div div DivAssign div_assign $div;
        }

        impl $name {
            const fn constant(x: $t) -> Self {
                // SAFETY: a register is as large as an array of its lanes, and any bits are numbers.
                $name(unsafe { std::mem::transmute::<[$t; $count], $register>([x; $count]) })
            }
        }

        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self::constant(-0.0) - self
            }
        }

        // SAFETY of all below: values of this type exist only where the processor has the instructions.
        impl Number for $name {
            const ZERO: Self = Self::constant(0.0);
            const ONE: Self = Self::constant(1.0);
            const HALF: Self = Self::constant(0.5);
            const EPSILON: Self = Self::constant(<$t>::EPSILON);
            #[inline(always)]
            fn of(value: f64) -> Self {
                Self::splat(value as $t)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                unsafe { $name($sqrt(self.0)) }
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
            fn abs(self) -> Self {
                self.max(-self)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                unsafe { $name($min(self.0, other.0)) }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                unsafe { $name($max(self.0, other.0)) }
            }
        }

        impl Lanes for $name {
            type Real = $t;
            const COUNT: usize = $count;
            #[inline(always)]
            fn splat(x: $t) -> Self {
                unsafe { $name($set(x)) }
            }
            #[inline(always)]
            unsafe fn load(first: *const $t) -> Self {
                unsafe { $name($load(first)) }
            }
            #[inline(always)]
            unsafe fn store(self, first: *mut $t) {
                unsafe { $store(first, self.0) }
            }
            #[inline(always)]
            fn at_least(self, other: Self) -> u32 {
                let ($a, $b) = (self.0, other.0);
                unsafe { $at_least }
            }
            $($part)*
        }
    };
}

lanes! { F64x8: __m512d as [f64; 8];
    _mm512_set1_pd _mm512_loadu_pd _mm512_storeu_pd;
    _mm512_add_pd _mm512_sub_pd _mm512_mul_pd _mm512_div_pd; _mm512_sqrt_pd _mm512_min_pd _mm512_max_pd;
    |a, b| u32::from(_mm512_cmp_pd_mask::<_CMP_GE_OQ>(a, b));
    #[inline(always)]
    unsafe fn load_part(first: *const f64, count: usize) -> Self {
        // SAFETY: lanes beyond the mask are not read.
        unsafe { F64x8(_mm512_mask_loadu_pd(_mm512_set1_pd(*first), mask(count), first)) }
    }
    #[inline(always)]
    unsafe fn store_part(self, first: *mut f64, count: usize) {
        // SAFETY: lanes beyond the mask are not written.
        unsafe { _mm512_mask_storeu_pd(first, mask(count), self.0) }
    }
    #[inline(always)]
    fn store_rows(columns: [Self; 4], rows: &mut [[f64; 4]; MOST_LANES]) {
        let [a, b, c, d] = columns;
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            turn_pd([low(a.0), low(b.0), low(c.0), low(d.0)], rows.as_mut_ptr().cast());
            turn_pd([high(a.0), high(b.0), high(c.0), high(d.0)], rows.as_mut_ptr().add(4).cast());
        }
    }
}
lanes! { F64x4: __m256d as [f64; 4];
    _mm256_set1_pd _mm256_loadu_pd _mm256_storeu_pd;
    _mm256_add_pd _mm256_sub_pd _mm256_mul_pd _mm256_div_pd; _mm256_sqrt_pd _mm256_min_pd _mm256_max_pd;
    |a, b| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GE_OQ>(a, b)) as u32;
    #[inline(always)]
    fn store_rows([a, b, c, d]: [Self; 4], rows: &mut [[f64; 4]; MOST_LANES]) {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { turn_pd([a.0, b.0, c.0, d.0], rows.as_mut_ptr().cast()) }
    }
}
lanes! { F32x8: __m256 as [f32; 8];
    _mm256_set1_ps _mm256_loadu_ps _mm256_storeu_ps;
    _mm256_add_ps _mm256_sub_ps _mm256_mul_ps _mm256_div_ps; _mm256_sqrt_ps _mm256_min_ps _mm256_max_ps;
    |a, b| _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GE_OQ>(a, b)) as u32;
    #[inline(always)]
    fn store_rows([a, b, c, d]: [Self; 4], rows: &mut [[f32; 4]; MOST_LANES]) {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            let [ab, cd] = [_mm256_unpacklo_ps(a.0, b.0), _mm256_unpacklo_ps(c.0, d.0)];
            let [ab_high, cd_high] = [_mm256_unpackhi_ps(a.0, b.0), _mm256_unpackhi_ps(c.0, d.0)];
            let turned = [
                _mm256_shuffle_ps::<0b01_00_01_00>(ab, cd),
                _mm256_shuffle_ps::<0b11_10_11_10>(ab, cd),
                _mm256_shuffle_ps::<0b01_00_01_00>(ab_high, cd_high),
                _mm256_shuffle_ps::<0b11_10_11_10>(ab_high, cd_high),
            ];
            let mut i = 0;
            while i < 4 {
                _mm_storeu_ps(rows[i].as_mut_ptr(), _mm256_castps256_ps128(turned[i]));
                _mm_storeu_ps(rows[i + 4].as_mut_ptr(), _mm256_extractf128_ps::<1>(turned[i]));
                i += 1;
            }
        }
    }
}
lanes! { F32x4: __m128 as [f32; 4];
    _mm_set1_ps _mm_loadu_ps _mm_storeu_ps;
    _mm_add_ps _mm_sub_ps _mm_mul_ps _mm_div_ps; _mm_sqrt_ps _mm_min_ps _mm_max_ps;
    |a, b| _mm_movemask_ps(_mm_cmpge_ps(a, b)) as u32;
}

#[inline(always)]
unsafe fn low(x: __m512d) -> __m256d {
    // SAFETY: the caller has AVX-512.
    unsafe { _mm512_castpd512_pd256(x) }
}

#[inline(always)]
unsafe fn high(x: __m512d) -> __m256d {
    // SAFETY: the caller has AVX-512.
    unsafe { _mm512_extractf64x4_pd::<1>(x) }
}

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
