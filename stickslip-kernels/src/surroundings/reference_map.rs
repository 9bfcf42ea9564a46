//! Where a body's material was before it deformed: what lets a node see the exact surface.

use crate::geometry::MirroredShape;
use crate::tensor::{Matrix, Real, Vector};

/// The undeformed place of the material around a node, linear in the position.
///
/// ```text
/// X(q) = <X + F^-1 (q - x)>             <y> = sum_p w_p y_p / sum_p w_p,   w_p = V_p S_i(x_p)
///      = <X> + <F^-1> (q - <x>)         of a body that flows plastically
/// ```
/// with X_p where particle p was at the start. Exact for motions with one deformation gradient, rigid ones among them.
/// Plastic flow resists no error of a particle's own F, and carrying each particle by that before taking the mean would
/// let the errors in: where such material is, positions alone say. The idea of carrying the undeformed place is the
/// reference map's (Kamrin, Rycroft and Nave 2012, J. Mech. Phys. Solids 60, 1952).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceMap<T, const D: usize> {
    /// X at the node [m].
    pub place: Vector<T, D>,
    /// F^-1 [-].
    pub inverse: Matrix<T>,
    /// Centre of the material's volume around the node, seen from the node [m].
    pub center: Vector<T, D>,
}

/// Where a point lies from a body's deformed surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset<T, const D: usize> {
    /// Distance, negative inside [m].
    pub distance: T,
    /// Outward normal; zero where no direction stands out [-].
    pub normal: Vector<T, D>,
}

impl<T: Real, const D: usize> ReferenceMap<T, D> {
    /// Nothing.
    pub const EMPTY: Self = ReferenceMap { place: Vector::ZERO, inverse: Matrix::ZERO, center: Vector::ZERO };

    /// The same, seen from a point `arm` away [m].
    pub fn seen_from(&self, arm: Vector<T, D>) -> Self {
        let f = &self.inverse.0;
        let place = Vector::from_fn(|i| (0..D).fold(self.place[i], |x, j| x + f[i][j] * arm[j]));
        ReferenceMap { place, inverse: self.inverse, center: self.center - arm }
    }

    /// How far a point, seen from the node [m], is from the surface of an undeformed shape carried along.
    ///
    /// ```text
    /// n = F^-T N / |F^-T N|,   distance = phi(X) / |F^-T N|,   N = grad phi
    /// ```
    pub fn offset(&self, point: Vector<T, D>, whole: &MirroredShape) -> Offset<T, D> {
        let f = &self.inverse.0;
        let place = Vector::<T, D>::from_fn(|i| (0..D).fold(self.place[i], |x, j| x + f[i][j] * point[j]));
        let level = whole.level(place.space());
        let slope =
            Vector::<T, D>::from_fn(|j| (0..D).fold(T::ZERO, |g, i| g + f[i][j] * T::of(level.gradient[i])));
        match slope.direction() {
            Some(normal) => Offset { distance: T::of(level.distance) / slope.norm(), normal },
            None => Offset { distance: T::of(level.distance), normal: Vector::ZERO },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Shape;

    /// x = A X + b, so X = A^-1 (x - b), at the node `at`.
    fn deformed(a: [[f64; 2]; 2], b: [f64; 2], at: [f64; 2]) -> ReferenceMap<f64, 2> {
        let f = Matrix([[a[0][0], a[0][1], 0.0], [a[1][0], a[1][1], 0.0], [0.0, 0.0, 1.0]]);
        let inverse = f.inverse();
        let arm = [at[0] - b[0], at[1] - b[1]];
        let place = Vector([0, 1].map(|i| inverse.0[i][0] * arm[0] + inverse.0[i][1] * arm[1]));
        ReferenceMap { place, inverse, center: Vector::ZERO }
    }

    /// A square stretched to twice its width, turned by 30 degrees and moved: faces, distances and normals are exact.
    #[test]
    fn a_stretched_and_turned_face_is_exact() {
        let whole = MirroredShape::new(&Shape::Box { min: [-1.0; 3], max: [1.0; 3] }, Vec::new(), 2);
        let (sin, cos) = f64::sin_cos(30f64.to_radians());
        let a = [[2.0 * cos, -sin], [2.0 * sin, cos]];
        let (normal, side) = ([cos, sin], [-sin, cos]);
        for (along, across) in [(2.3, 0.2), (1.9, -0.4), (2.0, 0.0)] {
            let at = [0, 1].map(|i| [5.0, -3.0][i] + along * normal[i] + across * side[i]);
            let place = deformed(a, [5.0, -3.0], at);
            let seen = place.offset(Vector::ZERO, &whole);
            assert!((seen.distance - (along - 2.0)).abs() < 1e-12, "{seen:?}");
            assert!((seen.normal - Vector(normal)).norm() < 1e-12, "{seen:?}");
            // From another node the same point looks the same.
            let away =
                deformed(a, [5.0, -3.0], [at[0] - 0.7, at[1] + 0.1]).offset(Vector([0.7, -0.1]), &whole);
            assert!((seen.distance - away.distance).abs() < 1e-12);
        }
    }

    #[test]
    fn a_sheared_face_has_the_deformed_normal() {
        let whole = MirroredShape::new(&Shape::Box { min: [-1.0; 3], max: [1.0; 3] }, Vec::new(), 2);
        // The side X = 1 leans over: its tangent (0, 1) becomes (1/2, 1).
        let seen = deformed([[1.0, 0.5], [0.0, 1.0]], [0.0; 2], [1.2, 0.0]).offset(Vector::ZERO, &whole);
        let normal = Vector([1.0, -0.5]) / 1.25f64.sqrt();
        assert!(
            (seen.normal - normal).norm() < 1e-12 && (seen.distance - 0.2 * normal[0]).abs() < 1e-12,
            "{seen:?}"
        );
    }
}
