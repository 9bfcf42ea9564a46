//! Contact with the normal and the gap from logistic regression over the particles around a node.
//!
//! ```text
//! minimise  sum_p w_p (c_p - f(phi . (x_p - x_i) + phi_0))^2 + penalty |phi|^2,   f(z) = 2/(1 + exp(-z)) - 1
//! c_p = -1 in the first body, 1 in the second;   n = phi / |phi|
//! gap = min_b ((x_p - x_i) . n - r_p) - max_a ((x_p - x_i) . n + r_p),   r_p = l_p |F_p^T n|
//! ```
//! Nairn, Hammerquist and Smith (2020), Comput. Methods Appl. Mech. Eng. 362, 112859. The two groups of particles are
//! told apart by a plane; the particles nearest to it, with the radius of the ellipsoid in their deformed box, are the
//! surfaces. Bodies push while they approach without a gap. The plane is found by damped Gauss-Newton steps from the
//! difference of the volume gradients.

use super::PairLaw;
use crate::contact::{Change, Facing, LawInputs, Pair, common_normal};
use crate::tensor::{Matrix, Real, Vector};

/// Contact by logistic regression.
pub struct Regression;

/// Weight of the plane's slope against one misplaced particle: with particles that a plane can part,
/// it keeps the slope finite.
const PENALTY: f64 = 1e-4;
/// Steps of Gauss and Newton at most.
const STEPS: usize = 25;
/// Largest change of the plane in one step, as a part of its slope.
const LONGEST: f64 = 0.5;
/// Slope with which the search starts [1/cell].
const FIRST_SLOPE: f64 = 4.0;

/// A particle near a node: where it is [cells], which body it is of (-1 or 1), and its deformed half-axes [cells].
#[derive(Clone, Copy, Debug)]
pub struct NearParticle<T, const D: usize> {
    arm: Vector<T, D>,
    label: T,
    axes: Matrix<T>,
}

impl<T: Real, const D: usize> PairLaw<T, D> for Regression {
    fn facing(&self, look: &LawInputs<T, D>, points: &mut Vec<NearParticle<T, D>>) -> Option<Facing<T, D>> {
        let [a, b] = look.pair.map(|side| &look.sides[side]);
        let Some(start) = (b.volume_gradient - a.volume_gradient).direction() else {
            return Some(Facing { normal: None, gap: T::ONE });
        };
        let per_cell = T::ONE / look.near.lattice.cell;
        points.clear();
        for (side, label) in [(a, -T::ONE), (b, T::ONE)] {
            look.near.around(side.body, look.node, |arm, particle, mirror| {
                points.push(NearParticle {
                    arm: arm * per_cell,
                    label,
                    axes: mirror * particle.deformation * (particle.half_width * per_cell),
                });
            });
        }
        let normal = plane(points, start);
        Some(Facing { normal: Some(normal), gap: gap(points, normal) })
    }

    fn change(&self, pair: &Pair<T, D>, velocities: [Vector<T, D>; 2]) -> Change<T, D> {
        if pair.gap > T::ZERO {
            return Change::NONE;
        }
        common_normal(pair, velocities, |approach, _| approach > T::ZERO)
    }
}

/// Normal of the plane between two groups of points.
fn plane<T: Real, const D: usize>(points: &[NearParticle<T, D>], start: Vector<T, D>) -> Vector<T, D> {
    let mut slope: [f64; 4] = [0.0; 4];
    (0..D).for_each(|i| slope[i] = FIRST_SLOPE * start[i].f64());
    // The offset is the last unknown.
    let unknowns = D + 1;
    for _ in 0..STEPS {
        let (mut matrix, mut right) = ([[0.0; 4]; 4], [0.0; 4]);
        for point in points {
            let row: [f64; 4] = std::array::from_fn(|i| if i < D { point.arm[i].f64() } else { 1.0 });
            let z: f64 = (0..unknowns).map(|i| slope[if i < D { i } else { 3 }] * row[i.min(D)]).sum();
            let f = 2.0 / (1.0 + libm::exp(-z)) - 1.0;
            let rate = 0.5 * (1.0 - f * f);
            for i in 0..unknowns {
                right[i] += rate * row[i] * (point.label.f64() - f);
                for j in 0..unknowns {
                    matrix[i][j] += rate * rate * row[i] * row[j];
                }
            }
        }
        let count = points.len() as f64;
        for i in 0..unknowns {
            // The offset bears no penalty but enough weight to be solvable.
            let penalty = if i < D { PENALTY * count } else { 1e-12 * count };
            matrix[i][i] += penalty;
            right[i] -= if i < D { penalty * slope[i] } else { 0.0 };
        }
        let change = solve(matrix, right, unknowns);
        let size = |v: &dyn Fn(usize) -> f64| (0..D).map(|i| v(i) * v(i)).sum::<f64>().sqrt();
        let (now, moved) = (size(&|i| slope[i]), size(&|i| change[i]));
        let damping = (LONGEST * now / moved.max(f64::MIN_POSITIVE)).min(1.0);
        for i in 0..unknowns {
            slope[if i < D { i } else { 3 }] += damping * change[i];
        }
        if moved <= 1e-8 * now {
            break;
        }
    }
    Vector::<T, D>::from_fn(|i| T::of(slope[i])).direction().unwrap_or(start)
}

/// Distance between the particles of the two groups along a normal, negative where they overlap [cells].
fn gap<T: Real, const D: usize>(points: &[NearParticle<T, D>], normal: Vector<T, D>) -> T {
    let (mut first, mut second) = (None::<T>, None::<T>);
    for point in points {
        let along = point.arm.dot(normal);
        let radius =
            Vector::<T, 3>::from_fn(|j| (0..D).fold(T::ZERO, |sum, i| sum + normal[i] * point.axes.0[i][j]))
                .norm();
        if point.label < T::ZERO {
            let surface = along + radius;
            first = Some(first.map_or(surface, |x| x.max(surface)));
        } else {
            let surface = along - radius;
            second = Some(second.map_or(surface, |x| x.min(surface)));
        }
    }
    match (first, second) {
        (Some(first), Some(second)) => second - first,
        _ => T::ONE,
    }
}

/// Solves a symmetric positive definite system of `n` equations by elimination.
fn solve(mut matrix: [[f64; 4]; 4], mut right: [f64; 4], n: usize) -> [f64; 4] {
    for i in 0..n {
        let pivot = matrix[i];
        for j in i + 1..n {
            let factor = matrix[j][i] / pivot[i];
            matrix[j].iter_mut().zip(pivot).for_each(|(entry, above)| *entry -= factor * above);
            right[j] -= factor * right[i];
        }
    }
    let mut solution = [0.0; 4];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| matrix[i][k] * solution[k]).sum();
        solution[i] = (right[i] - known) / matrix[i][i];
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Particles of half-width 1/4 cell on a lattice, parted by a plane with the given normal through the node.
    fn lattice(normal: [f64; 2], overhang: f64) -> Vec<NearParticle<f64, 2>> {
        let mut points = Vec::new();
        for i in -3..3 {
            for j in -3..3 {
                let arm = Vector([0.25 + 0.5 * f64::from(i), 0.25 + 0.5 * f64::from(j)]);
                let along = arm.dot(Vector(normal));
                let across = arm[0] * normal[1] - arm[1] * normal[0];
                // The second body ends at the side, as at the corner of a block.
                if along < 0.0 || across < overhang {
                    let label = if along < 0.0 { -1.0 } else { 1.0 };
                    points.push(NearParticle { arm, label, axes: Matrix::IDENTITY * 0.25 });
                }
            }
        }
        points
    }

    #[test]
    fn flat_faces_have_their_normal_and_no_gap() {
        let points = lattice([0.0, 1.0], 9.0);
        let normal = plane(&points, Vector([0.3, 0.953939]));
        assert!((normal - Vector([0.0, 1.0])).norm() < 1e-3, "{normal:?}");
        assert!(gap(&points, Vector([0.0, 1.0])).abs() < 1e-12);
    }

    #[test]
    fn a_corner_of_a_block_on_a_plane_has_nearly_the_planes_normal() {
        let points = lattice([0.0, 1.0], 0.1);
        // The gradients alone tilt here.
        let normal = plane(&points, Vector([0.4, 0.916515]));
        assert!(normal[1] > 0.99, "{normal:?}");
    }

    #[test]
    fn a_slanted_face_is_found_from_its_stairs() {
        let n = [0.6, 0.8];
        let normal = plane(&lattice(n, 9.0), Vector([0.0, 1.0]));
        assert!(normal.dot(Vector(n)) > 0.99, "{normal:?}");
    }
}
