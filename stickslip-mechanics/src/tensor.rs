//! Numbers, vectors and matrices of any precision and dimension.
//!
//! Transfer between particles and grid works in the dimension of the scene, `Vector<T, D>`; laws live in three
//! dimensions, `Matrix<T>` and `Symmetric<T>`, whatever the scene: a plane scene embeds its motion with
//! [`Vector::space`].

pub use crate::number::{Number, Real};
use serde::{Deserialize, Serialize};
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Neg, Sub, SubAssign};

/// The array whose entry `i` is `f(i)`.
///
/// The loop is written out: the standard library's is a call, across which a register of several numbers would go
/// through memory.
#[inline(always)]
pub fn array<X: Copy, const N: usize>(fill: X, mut f: impl FnMut(usize) -> X) -> [X; N] {
    let mut entries = [fill; N];
    let mut i = 0;
    while i < N {
        entries[i] = f(i);
        i += 1;
    }
    entries
}

/// A vector of `D` components.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Vector<T, const D: usize>(pub [T; D]);

impl<T: Number, const D: usize> Vector<T, D> {
    /// All components zero.
    pub const ZERO: Self = Vector([T::ZERO; D]);

    /// The vector whose component along axis `i` is `f(i)`.
    #[inline(always)]
    pub fn from_fn(f: impl FnMut(usize) -> T) -> Self {
        Vector(array(T::ZERO, f))
    }

    /// a . b
    #[inline(always)]
    pub fn dot(self, other: Self) -> T {
        let mut sum = T::NOTHING;
        for i in 0..D {
            sum = self.0[i].times_plus(other.0[i], sum);
        }
        sum
    }

    /// Length.
    #[inline(always)]
    pub fn norm(self) -> T {
        self.dot(self).sqrt()
    }
}

impl<T: Real, const D: usize> Vector<T, D> {
    /// The first `D` of three components.
    pub fn of(space: [f64; 3]) -> Self {
        Self::from_fn(|i| T::of(space[i]))
    }

    /// The vector in space; a plane vector has no third component.
    #[inline(always)]
    pub fn space(self) -> [f64; 3] {
        std::array::from_fn(|i| if i < D { self.0[i].f64() } else { 0.0 })
    }

    /// The vector of length one in the same direction; `None` for a vector too short to have one.
    #[inline(always)]
    pub fn direction(self) -> Option<Self> {
        let norm = self.norm();
        let direction = self / norm;
        (norm > T::ZERO && direction.is_finite()).then_some(direction)
    }

    /// Every component is finite.
    #[inline(always)]
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|x| x.is_finite())
    }
}

macro_rules! componentwise {
    ($op:ident, $f:ident, $assign:ident, $g:ident) => {
        impl<T: Number, const D: usize> $op for Vector<T, D> {
            type Output = Self;
            #[inline(always)]
            fn $f(self, other: Self) -> Self {
                Vector::from_fn(|i| self.0[i].$f(other.0[i]))
            }
        }
        impl<T: Number, const D: usize> $assign for Vector<T, D> {
            #[inline(always)]
            fn $g(&mut self, other: Self) {
                for i in 0..D {
                    self.0[i].$g(other.0[i]);
                }
            }
        }
    };
}
componentwise!(Add, add, AddAssign, add_assign);
componentwise!(Sub, sub, SubAssign, sub_assign);

impl<T: Number, const D: usize> Mul<T> for Vector<T, D> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Vector::from_fn(|i| self.0[i] * factor)
    }
}

impl<T: Number, const D: usize> Div<T> for Vector<T, D> {
    type Output = Self;
    #[inline(always)]
    fn div(self, divisor: T) -> Self {
        Vector::from_fn(|i| self.0[i] / divisor)
    }
}

impl<T: Number, const D: usize> Neg for Vector<T, D> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Vector::from_fn(|i| -self.0[i])
    }
}

impl<T: Number, const D: usize> Sum for Vector<T, D> {
    fn sum<I: Iterator<Item = Self>>(vectors: I) -> Self {
        vectors.fold(Self::ZERO, |a, b| a + b)
    }
}

impl<T, const D: usize> Index<usize> for Vector<T, D> {
    type Output = T;
    #[inline(always)]
    fn index(&self, i: usize) -> &T {
        &self.0[i]
    }
}

impl<T, const D: usize> IndexMut<usize> for Vector<T, D> {
    #[inline(always)]
    fn index_mut(&mut self, i: usize) -> &mut T {
        &mut self.0[i]
    }
}

/// a x b in space.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A 3 x 3 matrix, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Matrix<T>(pub [[T; 3]; 3]);

impl<T: Number> Default for Matrix<T> {
    fn default() -> Self {
        Self::ZERO
    }
}

impl<T: Number> Matrix<T> {
    /// All entries zero.
    pub const ZERO: Self = Matrix([[T::ZERO; 3]; 3]);
    /// The identity.
    pub const IDENTITY: Self =
        Matrix([[T::ONE, T::ZERO, T::ZERO], [T::ZERO, T::ONE, T::ZERO], [T::ZERO, T::ZERO, T::ONE]]);

    /// The matrix whose entry in row `i`, column `j` is `f(i, j)`.
    #[inline(always)]
    pub fn from_fn(mut f: impl FnMut(usize, usize) -> T) -> Self {
        let mut entries = [[T::ZERO; 3]; 3];
        for (i, row) in entries.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = f(i, j);
            }
        }
        Matrix(entries)
    }

    /// Determinant.
    #[inline(always)]
    pub fn det(&self) -> T {
        let [a, b, c] = self.0;
        let minor = |i: usize, j: usize| b[i].times_plus(c[j], -(b[j] * c[i]));
        a[0].times_plus(minor(1, 2), a[1].times_plus(minor(2, 0), a[2] * minor(0, 1)))
    }

    /// Inverse; entries are not finite where the determinant is zero.
    #[inline(always)]
    pub fn inverse(&self) -> Self {
        let m = &self.0;
        let per_det = T::ONE / self.det();
        let mut inverse = Self::ZERO;
        // No closure: the compiler may leave it uninlined, and then instructions on registers are calls.
        for i in 0..3 {
            for j in 0..3 {
                let (a, b) = ((j + 1) % 3, (j + 2) % 3);
                let (c, d) = ((i + 1) % 3, (i + 2) % 3);
                inverse.0[i][j] = m[a][c].times_plus(m[b][d], -(m[a][d] * m[b][c])) * per_det;
            }
        }
        inverse
    }

    /// Transpose.
    #[inline(always)]
    pub fn transpose(&self) -> Self {
        Matrix::from_fn(|i, j| self.0[j][i])
    }

    /// (A + A^T) / 2
    #[inline(always)]
    pub fn symmetric_part(&self) -> Symmetric<T> {
        let m = &self.0;
        Symmetric([
            m[0][0],
            m[1][1],
            m[2][2],
            T::HALF * (m[0][1] + m[1][0]),
            T::HALF * (m[1][2] + m[2][1]),
            T::HALF * (m[0][2] + m[2][0]),
        ])
    }

    /// Sum of the diagonal.
    #[inline(always)]
    pub fn trace(&self) -> T {
        let m = &self.0;
        m[0][0] + m[1][1] + m[2][2]
    }

    /// A A^T
    #[inline(always)]
    pub fn times_transpose(&self) -> Symmetric<T> {
        let m = &self.0;
        const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]];
        Symmetric(array(T::ZERO, |k| {
            let [i, j] = PAIRS[k];
            m[i][0].times_plus(m[j][0], m[i][1].times_plus(m[j][1], m[i][2] * m[j][2]))
        }))
    }
}

impl<T: Number> Add for Matrix<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Matrix::from_fn(|i, j| self.0[i][j] + other.0[i][j])
    }
}

impl<T: Number> Sub for Matrix<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Matrix::from_fn(|i, j| self.0[i][j] - other.0[i][j])
    }
}

impl<T: Number> Mul for Matrix<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Matrix::from_fn(|i, j| {
            let [a, b, c] = self.0[i];
            a.times_plus(other.0[0][j], b.times_plus(other.0[1][j], c * other.0[2][j]))
        })
    }
}

impl Matrix<f64> {
    /// The rotation about an axis by an angle, given as their product w [rad], right up to w^3:
    /// Q = (I - W/2)^-1 (I + W/2) with W x = w x x, exactly orthogonal (Cayley).
    pub fn rotation_by([x, y, z]: [f64; 3]) -> Self {
        let half = Matrix([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]) * 0.5;
        (Matrix::IDENTITY - half).inverse() * (Matrix::IDENTITY + half)
    }

    /// A x
    #[inline(always)]
    pub fn times(&self, x: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|j| self.0[i][j] * x[j]).sum())
    }
}

impl<T: Number> Mul<T> for Matrix<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Matrix::from_fn(|i, j| self.0[i][j] * factor)
    }
}

/// A symmetric 3 x 3 matrix: xx, yy, zz, xy, yz, xz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Symmetric<T>(pub [T; 6]);

impl<T: Number> Symmetric<T> {
    /// All entries zero.
    pub const ZERO: Self = Symmetric([T::ZERO; 6]);

    /// `value` times the identity.
    #[inline(always)]
    pub fn isotropic(value: T) -> Self {
        Symmetric([value, value, value, T::ZERO, T::ZERO, T::ZERO])
    }

    /// Entry in row `i`, column `j`.
    #[inline(always)]
    pub fn at(&self, i: usize, j: usize) -> T {
        const PLACE: [[usize; 3]; 3] = [[0, 3, 5], [3, 1, 4], [5, 4, 2]];
        self.0[PLACE[i][j]]
    }

    /// The full matrix.
    #[inline(always)]
    pub fn matrix(&self) -> Matrix<T> {
        Matrix::from_fn(|i, j| self.at(i, j))
    }

    /// Sum of the diagonal.
    #[inline(always)]
    pub fn trace(&self) -> T {
        self.0[0] + self.0[1] + self.0[2]
    }

    /// The matrix less a third of its trace.
    #[inline(always)]
    pub fn deviator(&self) -> Self {
        *self - Symmetric::isotropic(self.trace() * T::of(1.0 / 3.0))
    }

    /// A : B, the sum of products of all nine entries.
    #[inline(always)]
    pub fn double_dot(&self, other: &Self) -> T {
        let (a, b) = (&self.0, &other.0);
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + T::of(2.0) * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])
    }

    /// Largest eigenvalue s_1 of a symmetric matrix S without trace, with no branch.
    ///
    /// ```text
    /// s_1 = 2 sqrt(J_2/3) cos(theta),   cos(3 theta) = (3/2) sqrt(3) det(S) / J_2^(3/2),   J_2 = 1/2 S : S
    /// cos(theta) = 2 y^2 - 1,   4 y^3 - 3 y = cos(3 theta/2) = sqrt((1 + cos(3 theta))/2)
    /// ```
    /// y = cos(theta/2) lies in [sqrt(3)/2, 1], where the slope of its equation is 6 to 9: three steps of Newton's
    /// method from the chord leave less than 1e-13. Where the two largest are one, what rounding does to det(S)
    /// leaves sqrt([`Number::EPSILON`]) of s_1.
    #[inline(always)]
    pub fn largest_of_deviator(&self) -> T {
        let s = &self.0;
        let second = (T::HALF * self.double_dot(self)).max(T::EPSILON * T::EPSILON);
        let third = s[0] * (s[1] * s[2] - s[4] * s[4]) - s[3] * (s[3] * s[2] - s[4] * s[5])
            + s[5] * (s[3] * s[4] - s[1] * s[5]);
        let root = (second * T::of(1.0 / 3.0)).sqrt();
        // det(S)/(2 (J_2/3)^(3/2))
        let cosine = (T::HALF * third / (root * root * root)).max(-T::ONE).min(T::ONE);
        let wanted = (T::HALF + T::HALF * cosine).sqrt();
        let least = T::of(0.75f64.sqrt());
        let mut y = least + (T::ONE - least) * wanted;
        for _ in 0..3 {
            let square = y * y;
            y = (T::of(8.0) * square * y + wanted) / (T::of(12.0) * square - T::of(3.0));
        }
        (root + root) * (T::of(2.0) * y * y - T::ONE)
    }

    /// A v in the dimension of v.
    #[inline(always)]
    pub fn times<const D: usize>(&self, v: Vector<T, D>) -> Vector<T, D> {
        let mut product = Vector::ZERO;
        for i in 0..D {
            for j in 0..D {
                product[i] += self.at(i, j) * v[j];
            }
        }
        product
    }

    /// R A R^T
    #[inline(always)]
    pub fn rotated(&self, r: &Matrix<T>) -> Self {
        (*r * self.matrix() * r.transpose()).symmetric_part()
    }
}

impl<T: Real> Symmetric<T> {
    /// Every entry is finite.
    #[inline(always)]
    pub fn is_finite(&self) -> bool {
        self.0.iter().all(|x| x.is_finite())
    }
}

impl<T: Number> Add for Symmetric<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Symmetric(array(T::ZERO, |i| self.0[i] + other.0[i]))
    }
}

impl<T: Number> AddAssign for Symmetric<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Number> Sub for Symmetric<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Symmetric(array(T::ZERO, |i| self.0[i] - other.0[i]))
    }
}

impl<T: Number> Mul<T> for Symmetric<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Symmetric(array(T::ZERO, |i| self.0[i] * factor))
    }
}
