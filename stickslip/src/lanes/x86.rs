//! Lanes of x86-64 processors.

use super::{Lanes, MOST_LANES, Machine, Pair, Work};
use crate::number::{CUBE_ROOT_F32, CUBE_ROOT_F64, Number};
use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A third of 2^33, rounded up: the upper bits of a product with it are a third, for every number of 32 bits.
const THIRD: i64 = 0xaaaa_aaab;

/// The last `n` of the first half and what follows is a mask of `n` lanes.
static MASKS_32: [i32; 16] = [-1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0, 0, 0, 0];
static MASKS_64: [i64; 8] = [-1, -1, -1, -1, 0, 0, 0, 0];

/// Whether the processor has all of AVX-512 that [`avx512`] uses.
pub fn has_avx512() -> bool {
    std::arch::is_x86_feature_detected!("avx512f")
        && std::arch::is_x86_feature_detected!("avx512vl")
        && std::arch::is_x86_feature_detected!("avx512dq")
        && std::arch::is_x86_feature_detected!("avx512bw")
        && has_avx2()
}

/// Whether the processor has all that [`avx2`] uses.
pub fn has_avx2() -> bool {
    std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
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

    #[inline(always)]
    fn halves(wide: F64x8) -> F64x4 {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { F64x4(_mm256_add_pd(low(wide.0), high(wide.0))) }
    }
}
impl Machine<f32> for Avx512 {
    type Wide = F32x8<true>;
    type Quad = F32x4;

    #[inline(always)]
    fn halves(wide: F32x8<true>) -> F32x4 {
        sum_of_halves(wide)
    }
}
impl Machine<f64> for Avx2 {
    type Wide = Pair<F64x4>;
    type Quad = F64x4;

    #[inline(always)]
    fn halves(Pair(lower, upper): Pair<F64x4>) -> F64x4 {
        lower + upper
    }
}
impl Machine<f32> for Avx2 {
    type Wide = F32x8<false>;
    type Quad = F32x4;

    #[inline(always)]
    fn halves(wide: F32x8<false>) -> F32x4 {
        sum_of_halves(wide)
    }
}

/// Does work with AVX-512.
///
/// # Safety
/// The processor must have it, see [`has_avx512`].
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,fma")]
pub unsafe fn avx512<T, W: Work<Real = T>>(work: W) -> W::Output
where
    Avx512: Machine<T>,
{
    work.run::<Avx512>()
}

/// Does work with AVX2.
///
/// # Safety
/// The processor must have it, and FMA.
#[target_feature(enable = "avx2,fma")]
pub unsafe fn avx2<T, W: Work<Real = T>>(work: W) -> W::Output
where
    Avx2: Machine<T>,
{
    work.run::<Avx2>()
}

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
     $sqrt:ident $min:ident $max:ident $times_plus:ident;
     |$a:ident, $b:ident| $at_least:expr; $($part:item)*) => {
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

        // SAFETY of all below: values of this type exist only where the processor has the instructions.
        impl $(<const $flag: bool>)? Number for $name $(<$flag>)? {
            const ZERO: Self = Self::constant(0.0);
            const NOTHING: Self = Self::constant(-0.0);
            const ONE: Self = Self::constant(1.0);
            const HALF: Self = Self::constant(0.5);
            const EPSILON: Self = Self::constant(<$t>::EPSILON);
            #[inline(always)]
            fn of(value: f64) -> Self {
                Self::splat(value as $t)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
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
            fn abs(self) -> Self {
                self.max(-self)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                unsafe { Self($min(self.0, other.0)) }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                unsafe { Self($max(self.0, other.0)) }
            }
            #[inline(always)]
            fn times_plus(self, factor: Self, other: Self) -> Self {
                unsafe { Self($times_plus(self.0, factor.0, other.0)) }
            }
        }

        impl $(<const $flag: bool>)? Lanes for $name $(<$flag>)? {
            type Real = $t;
            const COUNT: usize = $count;
            #[inline(always)]
            fn splat(x: $t) -> Self {
                unsafe { Self($set(x)) }
            }
            #[inline(always)]
            unsafe fn load(first: *const $t) -> Self {
                unsafe { Self($load(first)) }
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
    _mm512_add_pd _mm512_sub_pd _mm512_mul_pd _mm512_div_pd; _mm512_sqrt_pd _mm512_min_pd _mm512_max_pd _mm512_fmadd_pd;
    |a, b| u32::from(_mm512_cmp_pd_mask::<_CMP_GE_OQ>(a, b));
    const MASKED: bool = true;
    #[inline(always)]
    fn inverse_cube_root_guess(self) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            let upper = _mm512_srli_epi64::<32>(_mm512_castpd_si512(self.0));
            let third = _mm512_srli_epi64::<33>(_mm512_mul_epu32(upper, _mm512_set1_epi64(THIRD)));
            let guess = _mm512_sub_epi64(_mm512_set1_epi64(CUBE_ROOT_F64 as i64), third);
            F64x8(_mm512_castsi512_pd(_mm512_slli_epi64::<32>(guess)))
        }
    }
    #[inline(always)]
    unsafe fn gather(first: *const f64, index: &[usize; MOST_LANES]) -> Self {
        // SAFETY: the caller's.
        let at = |lane: usize| unsafe { *first.add(index[lane]) };
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { F64x8(_mm512_setr_pd(at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7))) }
    }
    #[inline(always)]
    fn alternate([a, b]: [f64; 2]) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { F64x8(_mm512_broadcast_f64x2(_mm_set_pd(b, a))) }
    }
    #[inline(always)]
    fn fold(self, other: Self) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            F64x8(_mm512_add_pd(_mm512_unpacklo_pd(self.0, other.0), _mm512_unpackhi_pd(self.0, other.0)))
        }
    }
    #[inline(always)]
    fn every_fourth(self, n: usize) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            match n {
                0 => F64x8(_mm512_permutex_pd::<0x00>(self.0)),
                1 => F64x8(_mm512_permutex_pd::<0x55>(self.0)),
                2 => F64x8(_mm512_permutex_pd::<0xaa>(self.0)),
                _ => F64x8(_mm512_permutex_pd::<0xff>(self.0)),
            }
        }
    }
    #[inline(always)]
    fn permuted(self, order: [usize; MOST_LANES]) -> Self {
        let [a, b, c, d, e, f, g, h] = order.map(|lane| lane as i64);
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { F64x8(_mm512_permutexvar_pd(_mm512_setr_epi64(a, b, c, d, e, f, g, h), self.0)) }
    }
    #[inline(always)]
    unsafe fn load_first(first: *const f64, count: usize) -> Self {
        // SAFETY: lanes beyond the mask are not read.
        unsafe { F64x8(_mm512_maskz_loadu_pd(mask(count), first)) }
    }
    #[inline(always)]
    fn first(self, count: usize) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { F64x8(_mm512_maskz_mov_pd(mask(count), self.0)) }
    }
    #[inline(always)]
    fn store_pairs([a, b, c, d]: [Self; 4], pairs: &mut [[[f64; 2]; 4]; MOST_LANES / 2]) {
        let pairs: *mut f64 = pairs.as_mut_ptr().cast();
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            // Quarters 0, 1 and 2, 3 of two columns, then of all four.
            let [ab, cd] = [_mm512_shuffle_f64x2::<0x44>(a.0, b.0), _mm512_shuffle_f64x2::<0x44>(c.0, d.0)];
            let [ab_high, cd_high] =
                [_mm512_shuffle_f64x2::<0xee>(a.0, b.0), _mm512_shuffle_f64x2::<0xee>(c.0, d.0)];
            _mm512_storeu_pd(pairs, _mm512_shuffle_f64x2::<0x88>(ab, cd));
            _mm512_storeu_pd(pairs.add(8), _mm512_shuffle_f64x2::<0xdd>(ab, cd));
            _mm512_storeu_pd(pairs.add(16), _mm512_shuffle_f64x2::<0x88>(ab_high, cd_high));
            _mm512_storeu_pd(pairs.add(24), _mm512_shuffle_f64x2::<0xdd>(ab_high, cd_high));
        }
    }
    #[inline(always)]
    unsafe fn load_part(first: *const f64, count: usize, rest: f64) -> Self {
        // SAFETY: lanes beyond the mask are not read.
        unsafe { F64x8(_mm512_mask_loadu_pd(_mm512_set1_pd(rest), mask(count), first)) }
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
    _mm256_add_pd _mm256_sub_pd _mm256_mul_pd _mm256_div_pd; _mm256_sqrt_pd _mm256_min_pd _mm256_max_pd _mm256_fmadd_pd;
    |a, b| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GE_OQ>(a, b)) as u32;
    #[inline(always)]
    fn inverse_cube_root_guess(self) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            let upper = _mm256_srli_epi64::<32>(_mm256_castpd_si256(self.0));
            let third = _mm256_srli_epi64::<33>(_mm256_mul_epu32(upper, _mm256_set1_epi64x(THIRD)));
            let guess = _mm256_sub_epi64(_mm256_set1_epi64x(CUBE_ROOT_F64 as i64), third);
            F64x4(_mm256_castsi256_pd(_mm256_slli_epi64::<32>(guess)))
        }
    }
    #[inline(always)]
    unsafe fn gather(first: *const f64, index: &[usize; MOST_LANES]) -> Self {
        // SAFETY: the caller's.
        let at = |lane: usize| unsafe { *first.add(index[lane]) };
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { F64x4(_mm256_setr_pd(at(0), at(1), at(2), at(3))) }
    }
    #[inline(always)]
    unsafe fn load_part(first: *const f64, count: usize, rest: f64) -> Self {
        // SAFETY: lanes beyond the mask are not read.
        unsafe {
            let mask = mask_64(count);
            let numbers = _mm256_maskload_pd(first, mask);
            F64x4(_mm256_blendv_pd(_mm256_set1_pd(rest), numbers, _mm256_castsi256_pd(mask)))
        }
    }
    #[inline(always)]
    unsafe fn load_first(first: *const f64, count: usize) -> Self {
        // SAFETY: lanes beyond the mask are not read.
        unsafe { F64x4(_mm256_maskload_pd(first, mask_64(count))) }
    }
    #[inline(always)]
    fn first(self, count: usize) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            let mask = mask_64(count);
            F64x4(_mm256_and_pd(self.0, _mm256_castsi256_pd(mask)))
        }
    }
    #[inline(always)]
    unsafe fn store_part(self, mut first: *mut f64, count: usize) {
        // SAFETY: the caller's. Masked stores of AVX take ten times as long as these on some processors.
        unsafe {
            if count == 4 {
                return self.store(first);
            }
            let mut lanes = _mm256_castpd256_pd128(self.0);
            if count & 2 != 0 {
                _mm_storeu_pd(first, lanes);
                lanes = _mm256_extractf128_pd::<1>(self.0);
                first = first.add(2);
            }
            if count & 1 != 0 {
                _mm_store_sd(first, lanes);
            }
        }
    }
    #[inline(always)]
    fn every_fourth(self, n: usize) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            match n {
                0 => F64x4(_mm256_permute4x64_pd::<0x00>(self.0)),
                1 => F64x4(_mm256_permute4x64_pd::<0x55>(self.0)),
                2 => F64x4(_mm256_permute4x64_pd::<0xaa>(self.0)),
                _ => F64x4(_mm256_permute4x64_pd::<0xff>(self.0)),
            }
        }
    }
    #[inline(always)]
    fn alternate([a, b]: [f64; 2]) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { F64x4(_mm256_setr_pd(a, b, a, b)) }
    }
    #[inline(always)]
    fn fold(self, other: Self) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            F64x4(_mm256_add_pd(_mm256_unpacklo_pd(self.0, other.0), _mm256_unpackhi_pd(self.0, other.0)))
        }
    }
    #[inline(always)]
    fn store_pairs([a, b, c, d]: [Self; 4], pairs: &mut [[[f64; 2]; 4]; MOST_LANES / 2]) {
        let pairs: *mut f64 = pairs.as_mut_ptr().cast();
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            _mm256_storeu_pd(pairs, _mm256_permute2f128_pd::<0x20>(a.0, b.0));
            _mm256_storeu_pd(pairs.add(4), _mm256_permute2f128_pd::<0x20>(c.0, d.0));
            _mm256_storeu_pd(pairs.add(8), _mm256_permute2f128_pd::<0x31>(a.0, b.0));
            _mm256_storeu_pd(pairs.add(12), _mm256_permute2f128_pd::<0x31>(c.0, d.0));
        }
    }
    #[inline(always)]
    fn store_rows([a, b, c, d]: [Self; 4], rows: &mut [[f64; 4]; MOST_LANES]) {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { turn_pd([a.0, b.0, c.0, d.0], rows.as_mut_ptr().cast()) }
    }
}
lanes! { F32x8<const VL>: __m256 as [f32; 8];
    _mm256_set1_ps _mm256_loadu_ps _mm256_storeu_ps;
    _mm256_add_ps _mm256_sub_ps _mm256_mul_ps _mm256_div_ps; _mm256_sqrt_ps _mm256_min_ps _mm256_max_ps _mm256_fmadd_ps;
    |a, b| _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GE_OQ>(a, b)) as u32;
    #[inline(always)]
    fn inverse_cube_root_guess(self) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            let (bits, third) = (_mm256_castps_si256(self.0), _mm256_set1_epi64x(THIRD));
            let even = _mm256_srli_epi64::<33>(_mm256_mul_epu32(bits, third));
            let odd = _mm256_srli_epi64::<33>(_mm256_mul_epu32(_mm256_srli_epi64::<32>(bits), third));
            let third = _mm256_or_si256(even, _mm256_slli_epi64::<32>(odd));
            let guess = _mm256_sub_epi32(_mm256_set1_epi32(CUBE_ROOT_F32 as i32), third);
            Self(_mm256_castsi256_ps(guess))
        }
    }
    #[inline(always)]
    unsafe fn gather(first: *const f32, index: &[usize; MOST_LANES]) -> Self {
        // SAFETY: the caller's.
        let at = |lane: usize| unsafe { *first.add(index[lane]) };
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { Self(_mm256_setr_ps(at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7))) }
    }
    const MASKED: bool = VL;
    #[inline(always)]
    unsafe fn load_part(first: *const f32, count: usize, rest: f32) -> Self {
        // SAFETY: lanes beyond the mask are not read.
        unsafe {
            if VL {
                return Self(_mm256_mask_loadu_ps(_mm256_set1_ps(rest), mask(count), first));
            }
            let mask = mask_32(count);
            let numbers = _mm256_maskload_ps(first, mask);
            Self(_mm256_blendv_ps(_mm256_set1_ps(rest), numbers, _mm256_castsi256_ps(mask)))
        }
    }
    #[inline(always)]
    unsafe fn load_first(first: *const f32, count: usize) -> Self {
        // SAFETY: lanes beyond the mask are not read.
        unsafe {
            if VL {
                return Self(_mm256_maskz_loadu_ps(mask(count), first));
            }
            Self(_mm256_maskload_ps(first, mask_32(count)))
        }
    }
    #[inline(always)]
    fn first(self, count: usize) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            if VL {
                return Self(_mm256_maskz_mov_ps(mask(count), self.0));
            }
            let mask = mask_32(count);
            Self(_mm256_and_ps(self.0, _mm256_castsi256_ps(mask)))
        }
    }
    #[inline(always)]
    unsafe fn store_part(self, mut first: *mut f32, count: usize) {
        // SAFETY: the caller's. Masked stores of AVX take ten times as long as these on some processors.
        unsafe {
            if VL {
                return _mm256_mask_storeu_ps(first, mask(count), self.0);
            }
            if count == 8 {
                return self.store(first);
            }
            let mut lanes = _mm256_castps256_ps128(self.0);
            if count & 4 != 0 {
                _mm_storeu_ps(first, lanes);
                lanes = _mm256_extractf128_ps::<1>(self.0);
                first = first.add(4);
            }
            if count & 2 != 0 {
                _mm_storel_pd(first.cast(), _mm_castps_pd(lanes));
                lanes = _mm_movehl_ps(lanes, lanes);
                first = first.add(2);
            }
            if count & 1 != 0 {
                _mm_store_ss(first, lanes);
            }
        }
    }
    #[inline(always)]
    fn every_fourth(self, n: usize) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            match n {
                0 => Self(_mm256_permute_ps::<0x00>(self.0)),
                1 => Self(_mm256_permute_ps::<0x55>(self.0)),
                2 => Self(_mm256_permute_ps::<0xaa>(self.0)),
                _ => Self(_mm256_permute_ps::<0xff>(self.0)),
            }
        }
    }
    #[inline(always)]
    fn permuted(self, order: [usize; MOST_LANES]) -> Self {
        let [a, b, c, d, e, f, g, h] = order.map(|lane| lane as i32);
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { Self(_mm256_permutevar8x32_ps(self.0, _mm256_setr_epi32(a, b, c, d, e, f, g, h))) }
    }
    #[inline(always)]
    fn alternate([a, b]: [f32; 2]) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { Self(_mm256_setr_ps(a, b, a, b, a, b, a, b)) }
    }
    #[inline(always)]
    fn fold(self, other: Self) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            let even = _mm256_shuffle_ps::<0b10_00_10_00>(self.0, other.0);
            let odd = _mm256_shuffle_ps::<0b11_01_11_01>(self.0, other.0);
            Self(_mm256_permute_ps::<0b11_01_10_00>(_mm256_add_ps(even, odd)))
        }
    }
    #[inline(always)]
    fn store_pairs([a, b, c, d]: [Self; 4], pairs: &mut [[[f32; 2]; 4]; MOST_LANES / 2]) {
        let wide = |x: Self| {
            // SAFETY: values of this type exist only where the processor has the instructions.
            unsafe { _mm256_castps_pd(x.0) }
        };
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { turn_pd([wide(a), wide(b), wide(c), wide(d)], pairs.as_mut_ptr().cast()) }
    }
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
    _mm_add_ps _mm_sub_ps _mm_mul_ps _mm_div_ps; _mm_sqrt_ps _mm_min_ps _mm_max_ps _mm_fmadd_ps;
    |a, b| _mm_movemask_ps(_mm_cmpge_ps(a, b)) as u32;
    #[inline(always)]
    fn inverse_cube_root_guess(self) -> Self {
        // SAFETY: every x86-64 processor has the instructions.
        unsafe {
            let (bits, third) = (_mm_castps_si128(self.0), _mm_set1_epi64x(THIRD));
            let even = _mm_srli_epi64::<33>(_mm_mul_epu32(bits, third));
            let odd = _mm_srli_epi64::<33>(_mm_mul_epu32(_mm_srli_epi64::<32>(bits), third));
            let third = _mm_or_si128(even, _mm_slli_epi64::<32>(odd));
            let guess = _mm_sub_epi32(_mm_set1_epi32(CUBE_ROOT_F32 as i32), third);
            F32x4(_mm_castsi128_ps(guess))
        }
    }
    #[inline(always)]
    unsafe fn load_first(first: *const f32, count: usize) -> Self {
        // SAFETY: lanes beyond the mask are not read; only machines with AVX2 use this type.
        unsafe { F32x4(_mm_maskload_ps(first, _mm_loadu_si128(MASKS_32.as_ptr().add(8 - count).cast()))) }
    }
    #[inline(always)]
    unsafe fn gather(first: *const f32, index: &[usize; MOST_LANES]) -> Self {
        // SAFETY: the caller's.
        let at = |lane: usize| unsafe { *first.add(index[lane]) };
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { F32x4(_mm_setr_ps(at(0), at(1), at(2), at(3))) }
    }
}

#[inline(always)]
fn sum_of_halves<const VL: bool>(wide: F32x8<VL>) -> F32x4 {
    // SAFETY: values of this type exist only where the processor has the instructions.
    unsafe { F32x4(_mm_add_ps(_mm256_castps256_ps128(wide.0), _mm256_extractf128_ps::<1>(wide.0))) }
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

/// All bits of the first `count` of four lanes.
#[inline(always)]
unsafe fn mask_64(count: usize) -> __m256i {
    // SAFETY: the caller has AVX2, and at most four lanes.
    unsafe { _mm256_loadu_si256(MASKS_64.as_ptr().add(4 - count).cast()) }
}

/// All bits of the first `count` of eight lanes.
#[inline(always)]
unsafe fn mask_32(count: usize) -> __m256i {
    // SAFETY: the caller has AVX2, and at most eight lanes.
    unsafe { _mm256_loadu_si256(MASKS_32.as_ptr().add(8 - count).cast()) }
}
