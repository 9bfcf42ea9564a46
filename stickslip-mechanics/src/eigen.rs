//! Principal values and axes of symmetric tensors, side by side in every lane, with no branch.
//!
//! Rotations of Jacobi (1846) by turns in the planes of the axes, with tan(phi) of the smaller angle,
//!
//! ```text
//! t = 2 a_pq / (d +- sqrt(d^2 + 4 a_pq^2)),   d = a_qq - a_pp, the sign that of d
//! ```
//! which is never above one and has no 0/0 to fear but where a_pq = d = 0, where it is zero. The off-diagonal entries
//! fall by their squares; four sweeps of three rotations leave round-off.

use crate::tensor::{Matrix, Number, Symmetric};

/// Sweeps over the three planes.
const SWEEPS: usize = 4;

/// Principal values and axes of a symmetric tensor.
#[derive(Clone, Copy, Debug)]
pub struct Principal<T> {
    /// Principal values, in no order.
    pub values: [T; 3],
    /// Unit axes, the columns of a rotation.
    pub axes: Matrix<T>,
}

impl<T: Number> Principal<T> {
    /// Of a symmetric tensor.
    #[inline(always)]
    pub fn of(tensor: &Symmetric<T>) -> Self {
        let mut a = tensor.matrix().0;
        let mut axes = Matrix::IDENTITY;
        for _ in 0..SWEEPS {
            rotate::<T, 0, 1, 2>(&mut a, &mut axes);
            rotate::<T, 0, 2, 1>(&mut a, &mut axes);
            rotate::<T, 1, 2, 0>(&mut a, &mut axes);
        }
        Principal { values: [a[0][0], a[1][1], a[2][2]], axes }
    }

    /// The tensor with these axes and other values.
    #[inline(always)]
    pub fn with(&self, values: [T; 3]) -> Symmetric<T> {
        let scaled = Matrix::from_fn(|row, i| self.axes.0[row][i] * values[i]);
        (scaled * self.axes.transpose()).symmetric_part()
    }
}

/// Rotates axes P and Q so that the entry between them vanishes; R is the third.
#[inline(always)]
fn rotate<T: Number, const P: usize, const Q: usize, const R: usize>(
    a: &mut [[T; 3]; 3],
    axes: &mut Matrix<T>,
) {
    let d = a[Q][Q] - a[P][P];
    let twice = a[P][Q] + a[P][Q];
    // Scaled, so that no square is lost.
    let size = d.abs().max(twice.abs());
    let per = T::ONE / size.max(T::of(LEAST));
    let (x, y) = (d * per, twice * per);
    let root = (x * x + y * y).sqrt();
    let sum = T::select(T::ZERO.at_least(x), x - root, x + root);
    // Nothing to turn where both are zero: the quotient is then 0 over something.
    let nothing = T::of(LEAST).at_least(size);
    let t = y / T::select(nothing, T::ONE, sum);
    let cos = T::ONE / (T::ONE + t * t).sqrt();
    let sin = t * cos;
    let change = t * a[P][Q];
    a[P][P] -= change;
    a[Q][Q] += change;
    let (first, second) = (a[P][R], a[Q][R]);
    let turned = [cos * first - sin * second, sin * first + cos * second];
    (a[P][R], a[R][P]) = (turned[0], turned[0]);
    (a[Q][R], a[R][Q]) = (turned[1], turned[1]);
    (a[P][Q], a[Q][P]) = (T::ZERO, T::ZERO);
    for row in &mut axes.0 {
        let (first, second) = (row[P], row[Q]);
        (row[P], row[Q]) = (cos * first - sin * second, sin * first + cos * second);
    }
}

/// Entries below this are nothing.
const LEAST: f64 = 1e-30;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::trials::Chance;

    /// Of 30,000 tensors whose entries lie up to twelve decades apart, of which some have values in common:
    /// the axes are a rotation, and the values with them the tensor, to round-off.
    #[test]
    fn values_and_axes_make_the_tensor() {
        let mut chance = Chance(1);
        for trial in 0..30_000 {
            let scale = 10f64.powi(trial % 25 - 12);
            let tensor = match trial % 5 {
                0 => Symmetric::isotropic(scale),
                1 => {
                    let q = chance.deformation(0.0);
                    Symmetric([1.0, 1.0, 1.0 + scale, 0.0, 0.0, 0.0]).rotated(&q)
                }
                2 => {
                    let entries: [f64; 6] =
                        std::array::from_fn(|_| chance.signed() * 10f64.powf(12.0 * chance.signed()));
                    Symmetric(entries)
                }
                3 => Symmetric([chance.signed(), chance.signed(), 0.0, chance.signed(), 0.0, 0.0]) * scale,
                _ => chance.matrix().symmetric_part() * scale,
            };
            let found = Principal::of(&tensor);
            let size = tensor.double_dot(&tensor).sqrt();
            let off = found.with(found.values) - tensor;
            assert!(off.double_dot(&off).sqrt() <= 4e-15 * size, "{tensor:?} {found:?}");
            let unit = found.axes.times_transpose() - Symmetric::isotropic(1.0);
            assert!(unit.double_dot(&unit).sqrt() < 1e-14, "{found:?}");
        }
        let none = Principal::of(&Symmetric::<f64>::ZERO);
        assert_eq!((none.values, none.axes), ([0.0; 3], Matrix::IDENTITY));
    }

    /// Diagonals, shears, and values that are one, also of little size.
    #[test]
    fn principal_values_and_directions_are_those_of_the_matrix() {
        let turn = Matrix::rotation_by([0.4, -0.7, 1.1]);
        for values in [
            [1.0, 2.0, 3.0],
            [3.0, 1.0, 1.0],
            [1.0, 1.0, -2.0],
            [1.0, 1.0 + 1e-9, 1.0],
            [0.0; 3],
            [5.0; 3],
            [1e9, 1.0, -1e-3],
            [1e-12, 3e-12, -2e-12],
            [0.0, 0.0, 1e-25],
        ] {
            let largest = values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            for turn in [Matrix::IDENTITY, turn, turn * turn] {
                let matrix = Principal { values, axes: turn }.with(values);
                let principal = Principal::of(&matrix);
                let (mut found, columns) = (principal.values, principal.axes);
                let off = principal.with(found) - matrix;
                assert!(off.0.iter().all(|x| x.abs() <= 4e-15 * largest), "{values:?} {off:?}");
                let unit = columns * columns.transpose() - Matrix::IDENTITY;
                assert!(unit.0.as_flattened().iter().all(|x| x.abs() < 1e-14), "{values:?} {unit:?}");
                let mut expected = values;
                found.sort_by(f64::total_cmp);
                expected.sort_by(f64::total_cmp);
                let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 4e-15 * largest;
                assert!(found.iter().zip(&expected).all(near), "{found:?} {expected:?}");
            }
        }
    }

    #[test]
    fn single_precision_finds_them_too() {
        let mut chance = Chance(2);
        for _ in 0..10_000 {
            let tensor = Symmetric(chance.matrix().symmetric_part().0.map(|x| x as f32));
            let found = Principal::of(&tensor);
            let off = found.with(found.values) - tensor;
            assert!(off.double_dot(&off).sqrt() <= 2e-6, "{tensor:?} {found:?}");
        }
    }
}
