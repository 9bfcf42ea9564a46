//! Lanes in two registers, where one holds half of what is wanted.

use super::{Lanes, MOST_LANES};
use crate::number::{Number, Task};
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// The lanes of one register and then those of another.
#[derive(Clone, Copy, Debug)]
pub struct RegisterPair<V>(pub V, pub V);

macro_rules! lanewise {
    ($op:ident, $f:ident, $assign:ident, $g:ident) => {
        impl<V: Lanes> $op for RegisterPair<V> {
            type Output = Self;
            #[inline(always)]
            fn $f(self, other: Self) -> Self {
                RegisterPair(self.0.$f(other.0), self.1.$f(other.1))
            }
        }
        impl<V: Lanes> $assign for RegisterPair<V> {
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

impl<V: Lanes> Neg for RegisterPair<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        RegisterPair(-self.0, -self.1)
    }
}

impl<V: Lanes> Number for RegisterPair<V> {
    const ZERO: Self = RegisterPair(V::ZERO, V::ZERO);
    const NOTHING: Self = RegisterPair(V::NOTHING, V::NOTHING);
    const ONE: Self = RegisterPair(V::ONE, V::ONE);
    const HALF: Self = RegisterPair(V::HALF, V::HALF);
    const EPSILON: Self = RegisterPair(V::EPSILON, V::EPSILON);
    const SIDE_BY_SIDE: usize = <Self as Lanes>::COUNT;
    #[inline(always)]
    fn at_least(self, other: Self) -> u32 {
        self.0.at_least(other.0) | self.1.at_least(other.1) << V::COUNT
    }
    #[inline(always)]
    fn select(lanes: u32, there: Self, elsewhere: Self) -> Self {
        let upper = lanes >> V::COUNT;
        RegisterPair(V::select(lanes, there.0, elsewhere.0), V::select(upper, there.1, elsewhere.1))
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
        RegisterPair(V::of(value), V::of(value))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        RegisterPair(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn cbrt(self) -> Self {
        RegisterPair(self.0.cbrt(), self.1.cbrt())
    }
    #[inline(always)]
    fn ln(self) -> Self {
        RegisterPair(self.0.ln(), self.1.ln())
    }
    #[inline(always)]
    fn exp(self) -> Self {
        RegisterPair(self.0.exp(), self.1.exp())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        RegisterPair(self.0.abs(), self.1.abs())
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        RegisterPair(self.0.min(other.0), self.1.min(other.1))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        RegisterPair(self.0.max(other.0), self.1.max(other.1))
    }
    #[inline(always)]
    fn times_plus(self, factor: Self, other: Self) -> Self {
        RegisterPair(self.0.times_plus(factor.0, other.0), self.1.times_plus(factor.1, other.1))
    }
    #[inline(always)]
    fn apart<J: Task>(task: J) -> J::Output {
        V::apart(task)
    }
}

impl<V: Lanes> Lanes for RegisterPair<V> {
    type Real = V::Real;
    type Register = V;
    const COUNT: usize = 2 * V::COUNT;
    const REGISTERS: usize = 2;

    #[inline(always)]
    fn register(self, n: usize) -> V {
        if n == 0 { self.0 } else { self.1 }
    }

    #[inline(always)]
    fn put(&mut self, n: usize, register: V) {
        *(if n == 0 { &mut self.0 } else { &mut self.1 }) = register;
    }

    #[inline(always)]
    fn splat(x: V::Real) -> Self {
        RegisterPair(V::splat(x), V::splat(x))
    }

    #[inline(always)]
    unsafe fn load(first: *const V::Real) -> Self {
        // SAFETY: the caller has as many numbers there as both registers hold.
        unsafe { RegisterPair(V::load(first), V::load(first.add(V::COUNT))) }
    }

    #[inline(always)]
    unsafe fn store(self, first: *mut V::Real) {
        // SAFETY: the caller has room for as many numbers as both registers hold.
        unsafe {
            self.0.store(first);
            self.1.store(first.add(V::COUNT));
        }
    }

    #[inline(always)]
    unsafe fn load_part(first: *const V::Real, count: usize, rest: V::Real) -> Self {
        let upper = first.wrapping_add(V::COUNT);
        // SAFETY: the caller's.
        unsafe {
            RegisterPair(
                V::load_part(first, count.min(V::COUNT), rest),
                V::load_part(upper, count.saturating_sub(V::COUNT), rest),
            )
        }
    }

    #[inline(always)]
    unsafe fn load_first(first: *const V::Real, count: usize) -> Self {
        let upper = first.wrapping_add(V::COUNT);
        // SAFETY: the caller's.
        unsafe {
            RegisterPair(
                V::load_first(first, count.min(V::COUNT)),
                V::load_first(upper, count.saturating_sub(V::COUNT)),
            )
        }
    }

    #[inline(always)]
    unsafe fn store_part(self, first: *mut V::Real, count: usize) {
        let upper = first.wrapping_add(V::COUNT);
        // SAFETY: the caller's.
        unsafe {
            self.0.store_part(first, count.min(V::COUNT));
            self.1.store_part(upper, count.saturating_sub(V::COUNT));
        }
    }

    #[inline(always)]
    unsafe fn gather(first: *const V::Real, index: &[usize; MOST_LANES]) -> Self {
        let mut rest = [index[V::COUNT]; MOST_LANES];
        rest[..V::COUNT].copy_from_slice(&index[V::COUNT..2 * V::COUNT]);
        // SAFETY: the caller's.
        unsafe { RegisterPair(V::gather(first, index), V::gather(first, &rest)) }
    }

    #[inline(always)]
    fn alternate(pair: [V::Real; 2]) -> Self {
        RegisterPair(V::alternate(pair), V::alternate(pair))
    }

    #[inline(always)]
    fn first(self, count: usize) -> Self {
        RegisterPair(self.0.first(count.min(V::COUNT)), self.1.first(count.saturating_sub(V::COUNT)))
    }

    #[inline(always)]
    fn every_fourth(self, n: usize) -> Self {
        const { assert!(V::COUNT.is_multiple_of(4)) };
        RegisterPair(self.0.every_fourth(n), self.1.every_fourth(n))
    }

    #[inline(always)]
    fn add_neighbours(self, other: Self) -> Self {
        RegisterPair(self.0.add_neighbours(other.0), self.1.add_neighbours(other.1))
    }

    #[inline(always)]
    fn inverse_cube_root_guess(self) -> Self {
        RegisterPair(self.0.inverse_cube_root_guess(), self.1.inverse_cube_root_guess())
    }

    #[inline(always)]
    unsafe fn store_pairs(columns: [Self; 4], pairs: *mut V::Real) {
        const { assert!(V::COUNT.is_multiple_of(2)) };
        // SAFETY: the caller's; a lane takes four numbers.
        unsafe {
            V::store_pairs([columns[0].0, columns[1].0, columns[2].0, columns[3].0], pairs);
            let upper = pairs.add(4 * V::COUNT);
            V::store_pairs([columns[0].1, columns[1].1, columns[2].1, columns[3].1], upper);
        }
    }
}
