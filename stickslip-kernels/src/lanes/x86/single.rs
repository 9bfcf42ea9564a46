//! Lanes of numbers in single precision.

use super::super::{Lanes, MOST_LANES, Machine};
use super::{Avx2, Avx512, THIRD, apart_avx2, mask, turn_pd};
use crate::number::{CUBE_ROOT_F32, Number, Task};
use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// The last `n` of the first half and what follows is a mask of `n` lanes.
static LANES: [i32; 16] = [-1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0, 0, 0, 0];

impl Machine<f32> for Avx512 {
    type Wide = F32x8<true>;
    type Quad = F32x4;

    #[inline(always)]
    fn halves(wide: F32x8<true>) -> F32x4 {
        sum_of_halves(wide)
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

lanes! { F32x8<const MASKS>: __m256 as [f32; 8];
    _mm256_set1_ps _mm256_loadu_ps _mm256_storeu_ps;
    _mm256_add_ps _mm256_sub_ps _mm256_mul_ps _mm256_div_ps; _mm256_sqrt_ps _mm256_min_ps _mm256_max_ps _mm256_fmadd_ps apart_avx2;
    |a, b| _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GE_OQ>(a, b)) as u32;
    |lanes, there, elsewhere| {
        let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        let set = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(lanes as i32), bits), bits);
        _mm256_blendv_ps(elsewhere, there, _mm256_castsi256_ps(set))
    };
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
    #[inline(always)]
    unsafe fn load_part(first: *const f32, count: usize, rest: f32) -> Self {
        // SAFETY: lanes beyond the mask are not read.
        unsafe {
            if MASKS {
                return Self(_mm256_mask_loadu_ps(_mm256_set1_ps(rest), mask(count), first));
            }
            let mask = lanes_mask(count);
            let numbers = _mm256_maskload_ps(first, mask);
            Self(_mm256_blendv_ps(_mm256_set1_ps(rest), numbers, _mm256_castsi256_ps(mask)))
        }
    }
    #[inline(always)]
    unsafe fn load_first(first: *const f32, count: usize) -> Self {
        // SAFETY: lanes beyond the mask are not read.
        unsafe {
            if MASKS {
                return Self(_mm256_maskz_loadu_ps(mask(count), first));
            }
            Self(_mm256_maskload_ps(first, lanes_mask(count)))
        }
    }
    #[inline(always)]
    fn first(self, count: usize) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            if MASKS {
                return Self(_mm256_maskz_mov_ps(mask(count), self.0));
            }
            let mask = lanes_mask(count);
            Self(_mm256_and_ps(self.0, _mm256_castsi256_ps(mask)))
        }
    }
    #[inline(always)]
    unsafe fn store_part(self, mut first: *mut f32, count: usize) {
        // SAFETY: the caller's. Masked stores of AVX take ten times as long as these on some processors.
        unsafe {
            if MASKS {
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
    fn sums([a, b, c, d]: [Self; 4]) -> [f32; 4] {
        F32x4::sums([sum_of_halves(a), sum_of_halves(b), sum_of_halves(c), sum_of_halves(d)])
    }
    #[inline(always)]
    fn alternate([a, b]: [f32; 2]) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { Self(_mm256_setr_ps(a, b, a, b, a, b, a, b)) }
    }
    #[inline(always)]
    fn add_neighbours(self, other: Self) -> Self {
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe {
            let even = _mm256_shuffle_ps::<0b10_00_10_00>(self.0, other.0);
            let odd = _mm256_shuffle_ps::<0b11_01_11_01>(self.0, other.0);
            Self(_mm256_permute_ps::<0b11_01_10_00>(_mm256_add_ps(even, odd)))
        }
    }
    #[inline(always)]
    unsafe fn store_pairs([a, b, c, d]: [Self; 4], pairs: *mut f32) {
        let wide = |x: Self| {
            // SAFETY: values of this type exist only where the processor has the instructions.
            unsafe { _mm256_castps_pd(x.0) }
        };
        // SAFETY: as above, and the caller has room for four pairs.
        unsafe { turn_pd([wide(a), wide(b), wide(c), wide(d)], pairs.cast()) }
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
    _mm_add_ps _mm_sub_ps _mm_mul_ps _mm_div_ps; _mm_sqrt_ps _mm_min_ps _mm_max_ps _mm_fmadd_ps apart_avx2;
    |a, b| _mm_movemask_ps(_mm_cmpge_ps(a, b)) as u32;
    |lanes, there, elsewhere| {
        let bits = _mm_setr_epi32(1, 2, 4, 8);
        let set = _mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(lanes as i32), bits), bits);
        _mm_blendv_ps(elsewhere, there, _mm_castsi128_ps(set))
    };
    #[inline(always)]
    fn sums([a, b, c, d]: [Self; 4]) -> [f32; 4] {
        let mut sums = [0.0; 4];
        // SAFETY: values of this type exist only where the processor has the instructions.
        unsafe { _mm_storeu_ps(sums.as_mut_ptr(), _mm_hadd_ps(_mm_hadd_ps(a.0, b.0), _mm_hadd_ps(c.0, d.0))) };
        sums
    }
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
        unsafe { F32x4(_mm_maskload_ps(first, _mm256_castsi256_si128(lanes_mask(count)))) }
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
fn sum_of_halves<const MASKS: bool>(wide: F32x8<MASKS>) -> F32x4 {
    // SAFETY: values of this type exist only where the processor has the instructions.
    unsafe { F32x4(_mm_add_ps(_mm256_castps256_ps128(wide.0), _mm256_extractf128_ps::<1>(wide.0))) }
}

/// All bits of the first `count` of eight lanes.
#[inline(always)]
unsafe fn lanes_mask(count: usize) -> __m256i {
    // SAFETY: the caller has AVX2, and at most eight lanes.
    unsafe { _mm256_loadu_si256(LANES.as_ptr().add(8 - count).cast()) }
}
