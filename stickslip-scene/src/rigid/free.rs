//! Free rigid bodies: what they weigh, what momentum they have, and how they turn.

use crate::scene::{Body, FreeRigid, Scene};
use crate::tensor::{Matrix, Vector};
use serde::{Deserialize, Serialize};

/// Mass, centre and inertia of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass [kg], in the plane per metre of depth.
    pub mass: f64,
    /// Centre of mass at the start [m].
    pub center: [f64; 3],
    /// Tensor of inertia about it at the start [kg m^2].
    pub inertia: Matrix<f64>,
}

impl MassProperties {
    /// Those of a body of a scene: of its shape and its material's density, and what it is given itself. `None` of one
    /// without bounds, or that nothing lets turn or move.
    pub fn of(scene: &Scene, body: &Body, given: &FreeRigid) -> Option<Self> {
        let dimension = scene.dimension.axes();
        let moments = body.shape.moments(dimension)?;
        let density = scene.materials[body.material].density;
        let mass = given.mass.unwrap_or(density * moments.volume);
        // A given mass is spread over the shape.
        let mut inertia = moments.inertia() * (mass / moments.volume);
        if let Some(own) = given.inertia {
            inertia = Matrix::from_fn(|i, j| if i == j { own[i] } else { 0.0 });
        }
        if dimension == 2 {
            let turning = inertia.0[2][2];
            inertia = Matrix::IDENTITY * turning;
        }
        let sound = mass > 0.0 && inertia.det() > 0.0 && mass.is_finite() && inertia.det().is_finite();
        sound.then_some(MassProperties { mass, center: moments.center, inertia })
    }
}

/// Motion of a free rigid body. Momentum and angular momentum are what forces change; the velocities follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeMotion {
    /// Mass [kg].
    pub mass: f64,
    /// I_0, tensor of inertia about the centre at the start [kg m^2].
    inertia: Matrix<f64>,
    /// Its inverse.
    inverse: Matrix<f64>,
    /// What changes from step to step.
    pub state: FreeState,
}

/// What of a free rigid body's motion changes from step to step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FreeState {
    /// Momentum [kg m/s].
    pub momentum: [f64; 3],
    /// Angular momentum about its own centre [kg m^2/s].
    pub angular_momentum: [f64; 3],
    /// Unit quaternion of its turn since the start: real part first.
    quaternion: [f64; 4],
}

/// Fixed-point iterations of the angular velocity at most; two or three are enough for steps that waves limit.
const MOST_ITERATIONS: usize = 50;

impl FreeMotion {
    /// A body with this velocity [m/s] and angular velocity [rad/s].
    pub fn new(properties: &MassProperties, velocity: [f64; 3], spin: [f64; 3]) -> Self {
        let MassProperties { mass, inertia, .. } = *properties;
        let state = FreeState {
            momentum: velocity.map(|v| mass * v),
            angular_momentum: inertia.times(spin),
            quaternion: [1.0, 0.0, 0.0, 0.0],
        };
        FreeMotion { mass, inertia, inverse: inertia.inverse(), state }
    }

    /// The turn Q since the start.
    pub fn orientation(&self) -> Matrix<f64> {
        turn_of(self.state.quaternion)
    }

    /// Turns it to where it is after this rotation since the start.
    pub(super) fn put(&mut self, quaternion: [f64; 4]) {
        self.state.quaternion = quaternion;
    }

    /// Tensor of inertia now, Q I_0 Q^T [kg m^2].
    pub fn inertia(&self) -> Matrix<f64> {
        let turn = self.orientation();
        turn * self.inertia * turn.transpose()
    }

    /// p / m [m/s]
    pub fn velocity(&self) -> [f64; 3] {
        self.state.momentum.map(|p| p / self.mass)
    }

    /// The angular velocity w with which the body turns in a step of `dt` without moments [rad/s]:
    ///
    /// ```text
    /// W = I_0^-1 (P + P')/2,   P' = cay(dt W)^T P,   P = Q^T L,   w = Q W
    /// ```
    /// the mid-point rule of Austin, Krishnaprasad and Wang (1993), J. Comput. Phys. 107, 105-117. With the turn
    /// Q' = cay(dt w) Q it keeps the angular momentum L and the energy P . I_0^-1 P / 2, both to round-off.
    pub fn spin(&self, dt: f64) -> [f64; 3] {
        let turn = self.orientation();
        let before = turn.transpose().times(self.state.angular_momentum);
        let mut spin = self.inverse.times(before);
        for _ in 0..MOST_ITERATIONS {
            let after = Matrix::rotation_by(spin.map(|w| w * dt)).transpose().times(before);
            let next = self.inverse.times(std::array::from_fn(|i| 0.5 * (before[i] + after[i])));
            let change = (Vector(next) - Vector(spin)).norm();
            spin = next;
            if change <= f64::EPSILON * Vector(spin).norm() {
                break;
            }
        }
        turn.times(spin)
    }

    /// Turns by a step of `dt` with the angular velocity `spin` [rad/s].
    pub fn turn(&mut self, spin: [f64; 3], dt: f64) {
        // The Cayley map of dt w is the quaternion (1, dt w / 2) over its length.
        let [x, y, z] = spin.map(|w| 0.5 * dt * w);
        let [a, b, c, d] = self.state.quaternion;
        let product = [
            a - x * b - y * c - z * d,
            b + x * a + y * d - z * c,
            c + y * a + z * b - x * d,
            d + z * a + x * c - y * b,
        ];
        let length = product.iter().map(|q| q * q).sum::<f64>().sqrt();
        self.state.quaternion = product.map(|q| q / length);
    }

    /// p^2 / (2 m) + L . I^-1 L / 2 [J]
    pub fn kinetic(&self) -> f64 {
        let dot = |a: [f64; 3], b: [f64; 3]| Vector(a).dot(Vector(b));
        let own = self.orientation().transpose().times(self.state.angular_momentum);
        let momentum = self.state.momentum;
        0.5 * (dot(momentum, momentum) / self.mass + dot(own, self.inverse.times(own)))
    }
}

/// The rotation of a unit quaternion, real part first.
pub(super) fn turn_of([w, x, y, z]: [f64; 4]) -> Matrix<f64> {
    Matrix([
        [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ])
}

/// The unit quaternion of a rotation that is one to round-off (Shepperd 1978, J. Guid. Control 1, 223-224).
pub(super) fn quaternion_of(turn: &Matrix<f64>) -> [f64; 4] {
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = turn.0;
    // Four times the products of its parts: the row of the largest part has the least round-off.
    let products = [
        [1.0 + xx + yy + zz, zy - yz, xz - zx, yx - xy],
        [zy - yz, 1.0 + xx - yy - zz, xy + yx, xz + zx],
        [xz - zx, xy + yx, 1.0 - xx + yy - zz, yz + zy],
        [yx - xy, xz + zx, yz + zy, 1.0 - xx - yy + zz],
    ];
    let largest = (0..4).max_by(|&a, &b| products[a][a].total_cmp(&products[b][b])).unwrap_or(0);
    let length = products[largest].iter().map(|q| q * q).sum::<f64>().sqrt();
    products[largest].map(|q| q / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A brick that turns about its middle axis, which no rotation about it survives: after a thousand turns its energy
    /// and its angular momentum are what they were, to 1e-10, and it has tumbled.
    #[test]
    fn a_free_asymmetric_top_keeps_energy_and_angular_momentum() {
        let inertia = Matrix([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]]);
        let properties = MassProperties { mass: 1.0, center: [0.0; 3], inertia };
        let mut top = FreeMotion::new(&properties, [0.0; 3], [0.01, 1.0, 0.02]);
        let (energy, angular_momentum) = (top.kinetic(), top.state.angular_momentum);
        let steps_a_turn = 200;
        let dt = std::f64::consts::TAU / f64::from(steps_a_turn);
        let mut lowest = 1.0_f64;
        for _ in 0..1000 * steps_a_turn {
            let spin = top.spin(dt);
            top.turn(spin, dt);
            lowest = lowest.min(top.orientation().0[1][1]);
        }
        assert!((top.kinetic() / energy - 1.0).abs() < 1e-10, "{} {energy}", top.kinetic());
        assert_eq!(top.state.angular_momentum, angular_momentum);
        assert!(lowest < -0.9, "it has not tumbled: {lowest}");
        let turn = top.orientation();
        let product = turn * turn.transpose();
        let off = (0..3)
            .flat_map(|i| (0..3).map(move |j| (i, j)))
            .map(|(i, j)| (product.0[i][j] - Matrix::<f64>::IDENTITY.0[i][j]).abs());
        assert!(off.fold(0.0, f64::max) < 1e-14);
    }

    /// Rotations by all angles about axes of all kinds, rounded to single precision, come back to that.
    #[test]
    fn a_rotation_has_its_quaternion() {
        for axis in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.6, -0.48, 0.64]] {
            for angle in (0..16).map(|i| std::f64::consts::TAU * f64::from(i) / 16.0) {
                let (w, s) = ((0.5 * angle).cos(), (0.5 * angle).sin());
                let turn = turn_of([w, s * axis[0], s * axis[1], s * axis[2]]);
                let rounded = Matrix::from_fn(|i, j| f64::from(turn.0[i][j] as f32));
                let found = turn_of(quaternion_of(&rounded));
                let off = (0..9).map(|k| (found.0[k / 3][k % 3] - turn.0[k / 3][k % 3]).abs());
                assert!(off.fold(0.0, f64::max) < 2e-7, "{axis:?} {angle}");
            }
        }
    }

    /// The nutation of a symmetric top: W about the axis of symmetry stays, and the other turns at (I_3/I_1 - 1) W_3.
    #[test]
    fn a_symmetric_top_nutates_at_its_own_rate() {
        let inertia = Matrix([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.5]]);
        let properties = MassProperties { mass: 1.0, center: [0.0; 3], inertia };
        let mut top = FreeMotion::new(&properties, [0.0; 3], [0.1, 0.0, 2.0]);
        let (rate, dt, steps) = (0.5 * 2.0, 1e-3, 2000);
        for _ in 0..steps {
            let spin = top.spin(dt);
            top.turn(spin, dt);
        }
        let own = top.orientation().transpose().times(top.state.angular_momentum);
        let angle = rate * dt * f64::from(steps);
        assert!(
            (own[0] - 0.1 * angle.cos()).abs() < 1e-6 && (own[1] - 0.1 * angle.sin()).abs() < 1e-6,
            "{own:?}"
        );
    }
}
