//! Lanes of numbers in double precision.

use super::super::{Lanes, MOST_LANES, Machine, RegisterPair};
use super::{Avx2, Avx512, THIRD, apart_avx2, apart_avx512, mask, turn_pd};
use crate::number::{CUBE_ROOT_F64, Number, Task};
use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// The last `n` of the first half and what follows is a mask of `n` lanes.
static LANES: [i64; 8] = [-1, -1, -1, -1, 0, 0, 0, 0];

impl Machine<f64> for Avx512 {
    type Wide = F64x8;
    type Quad = F64x4;

    #[inline(always)]
    fn halves(wide: F64x8) -> F64x4 {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { F64x4(_mm256_add_pd(low(wide.0), high(wide.0))) }
    }
}
impl Machine<f64> for Avx2 {
    type Wide = RegisterPair<F64x4>;
    type Quad = F64x4;

    #[inline(always)]
    fn halves(RegisterPair(lower, upper): RegisterPair<F64x4>) -> F64x4 {
        lower + upper
    }
}

lanes! { F64x8: __m512d as [f64; 8];
    _mm512_set1_pd _mm512_loadu_pd _mm512_storeu_pd;
    _mm512_add_pd _mm512_sub_pd _mm512_mul_pd _mm512_div_pd; _mm512_sqrt_pd _mm512_min_pd _mm512_max_pd _mm512_fmadd_pd apart_avx512;
    |a, b| u32::from(_mm512_cmp_pd_mask::<_CMP_GE_OQ>(a, b));
    |lanes, there, elsewhere| _mm512_mask_blend_pd(lanes as u8, elsewhere, there);
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
    fn add_neighbours(self, other: Self) -> Self {
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
    fn sums([a, b, c, d]: [Self; 4]) -> [f64; 4] {
        let halves = <Avx512 as Machine<f64>>::halves;
        F64x4::sums([halves(a), halves(b), halves(c), halves(d)])
    }
    #[inline(always)]
    unsafe fn store_pairs([a, b, c, d]: [Self; 4], pairs: *mut f64) {
        // SAFETY: values of this type exist only where the processor has the instructions; the caller has the room.
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
    _mm256_add_pd _mm256_sub_pd _mm256_mul_pd _mm256_div_pd; _mm256_sqrt_pd _mm256_min_pd _mm256_max_pd _mm256_fmadd_pd apart_avx2;
    |a, b| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GE_OQ>(a, b)) as u32;
    |lanes, there, elsewhere| {
        let bits = _mm256_setr_epi64x(1, 2, 4, 8);
        let set = _mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x(i64::from(lanes)), bits), bits);
        _mm256_blendv_pd(elsewhere, there, _mm256_castsi256_pd(set))
    };
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
            let mask = lanes_mask(count);
            let numbers = _mm256_maskload_pd(first, mask);
            F64x4(_mm256_blendv_pd(_mm256_set1_pd(rest), numbers, _mm256_castsi256_pd(mask)))
        }
    }
    #[inline(always)]
    unsafe fn load_first(first: *const f64, count: usize) -> Self {
        // SAFETY: lanes beyond the mask are not read.
        unsafe { F64x4(_mm256_maskload_pd(first, lanes_mask(count))) }
    }
    #[inline(always)]
    fn first(self, count: usize) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            let mask = lanes_mask(count);
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
    fn add_neighbours(self, other: Self) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            F64x4(_mm256_add_pd(_mm256_unpacklo_pd(self.0, other.0), _mm256_unpackhi_pd(self.0, other.0)))
        }
    }
    #[inline(always)]
    fn sums([a, b, c, d]: [Self; 4]) -> [f64; 4] {
        let mut sums = [0.0; 4];
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            let [ab, cd] = [_mm256_hadd_pd(a.0, b.0), _mm256_hadd_pd(c.0, d.0)];
            let halves = [_mm256_permute2f128_pd::<0x20>(ab, cd), _mm256_permute2f128_pd::<0x31>(ab, cd)];
            _mm256_storeu_pd(sums.as_mut_ptr(), _mm256_add_pd(halves[0], halves[1]));
        }
        sums
    }
    #[inline(always)]
    unsafe fn store_pairs([a, b, c, d]: [Self; 4], pairs: *mut f64) {
        // SAFETY: values of this type exist only where the processor has the instructions; the caller has the room.
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

/// All bits of the first `count` of four lanes.
#[inline(always)]
unsafe fn lanes_mask(count: usize) -> __m256i {
    // SAFETY: the caller has AVX2, and at most four lanes.
    unsafe { _mm256_loadu_si256(LANES.as_ptr().add(4 - count).cast()) }
}
