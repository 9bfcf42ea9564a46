//! Trials that tests put laws to: many motions, and waves in every direction.

use super::plane_stress::thickening;
use super::{Entries, Law, Motion};
use crate::tensor::{Matrix, Number, Real, Symmetric};

/// Numbers that look like chance and are the same in every run (Knuth's linear congruential generator).
pub struct Chance(pub u64);

impl Chance {
    /// Between 0 and 1.
    pub fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Between -1 and 1.
    pub fn signed(&mut self) -> f64 {
        2.0 * self.number() - 1.0
    }

    /// Entries between -1 and 1.
    pub fn matrix(&mut self) -> Matrix<f64> {
        Matrix::from_fn(|_, _| self.signed())
    }

    /// A direction.
    pub fn direction(&mut self) -> [f64; 3] {
        loop {
            let vector = [self.signed(), self.signed(), self.signed()];
            let square: f64 = vector.iter().map(|x| x * x).sum();
            if (0.01..1.0).contains(&square) {
                return vector.map(|x| x / square.sqrt());
            }
        }
    }

    /// A deformation that stretches by up to e^size along any axes.
    pub fn deformation(&mut self, size: f64) -> Matrix<f64> {
        let axes = Matrix::rotation_by(std::array::from_fn(|_| 3.0 * self.signed()));
        let turned = Matrix::rotation_by(std::array::from_fn(|_| 3.0 * self.signed()));
        let stretches: [f64; 3] = std::array::from_fn(|_| (size * self.signed()).exp());
        axes * Matrix::from_fn(|i, j| if i == j { stretches[i] } else { 0.0 }) * turned
    }
}

/// Paths of ten steps from rest: tiny strains, large ones, none, and steps of no duration.
/// Whatever a law answers is a number. In single precision the largest strains are left out, whose powers have none.
pub fn answers_are_numbers<T: Real, L: Law<T>>(law: &L, paths: usize) {
    let mut chance = Chance(7);
    let narrow = |matrix: &Matrix<f64>| Matrix::from_fn(|i, j| T::of(matrix.0[i][j]));
    let sizes = &[0.0, 1e-12, 1e-6, 1e-3, 0.05, 0.3, 1.0][..if T::EPSILON.f64() < 1e-10 { 7 } else { 6 }];
    for path in 0..paths {
        let size = sizes[path % sizes.len()];
        let dt = T::of([0.0, 1e-12, 1e-6, 1e-3, 1.0][path / sizes.len() % 5]);
        let axial = path % 3 == 0;
        let (mut deformation, mut stress) = (Matrix::IDENTITY, Symmetric::ZERO);
        let mut history = L::History::ZERO;
        for _ in 0..10 {
            let increment = match axial {
                true => {
                    let stretches: [f64; 3] = std::array::from_fn(|_| (size * chance.signed()).exp());
                    Matrix::from_fn(|i, j| if i == j { stretches[i] } else { 0.0 })
                }
                false => chance.deformation(size),
            };
            deformation = increment * deformation;
            let (f, jacobian) = (narrow(&deformation), T::of(deformation.det()));
            let motion = Motion { deformation: f, jacobian, increment: narrow(&increment), stress, dt };
            let response = law.respond(&motion, &history);
            (stress, history) = (response.stress, response.history);
            let energies = [law.strain_energy(&f, &stress, &history), law.dissipation(&history)];
            let moduli =
                [law.wave_modulus(&f, jacobian, &history), law.shear_modulus(&f, jacobian, &history)];
            let all = stress.0.iter().chain(history.entries()).chain(&energies).chain(&moduli);
            assert!(all.clone().all(|x| x.is_finite()), "{path}: {motion:?} {:?}", all.collect::<Vec<_>>());
            let [waves, shear, lost] = [moduli[0], moduli[1], energies[1]].map(Real::f64);
            assert!(waves >= shear * (1.0 - 1e-5) && shear >= 0.0, "{path}: {moduli:?}");
            assert!(lost >= 0.0, "{path}: {lost}");
        }
    }
}

/// Over many states and waves: the largest stiffness d^2/de^2 W((I + e m n^T) F) over what the law says, for waves
/// along n in which matter moves along any m, and for those in which it moves across n, over its shear modulus.
pub fn stiffness_over_moduli<L: Law<f64>>(law: &L, (states, size): (usize, f64)) -> [f64; 2] {
    let mut chance = Chance(11);
    let none = L::History::ZERO;
    let mut largest = [0.0f64; 2];
    for _ in 0..states {
        let f = chance.deformation(size);
        let (waves, shear) = (law.wave_modulus(&f, f.det(), &none), law.shear_modulus(&f, f.det(), &none));
        for _ in 0..60 {
            let (n, m, h) = (chance.direction(), chance.direction(), 1e-3);
            let dot: f64 = (0..3).map(|i| n[i] * m[i]).sum();
            let across: [f64; 3] = std::array::from_fn(|i| m[i] - dot * n[i]);
            let length = across.iter().map(|x| x * x).sum::<f64>().sqrt();
            let stiffness = |m: [f64; 3]| {
                let energy = |e: f64| {
                    let moved = Matrix::from_fn(|i, j| e * m[i] * n[j]) + Matrix::IDENTITY;
                    law.strain_energy(&(moved * f), &Symmetric::ZERO, &none)
                };
                // The fourth-order difference.
                let near = energy(h) + energy(-h);
                let far = energy(2.0 * h) + energy(-2.0 * h);
                (16.0 * near - far - 30.0 * energy(0.0)) / (12.0 * h * h)
            };
            for m in [m, n] {
                largest[0] = largest[0].max(stiffness(m) / waves);
            }
            if length > 0.1 && shear > 0.0 {
                largest[1] = largest[1].max(stiffness(across.map(|x| x / length)) / shear);
            }
        }
    }
    largest
}

/// A plate that is stretched and sheared in its plane in ten steps has a thickness without stress at each of them.
pub fn plates_have_a_thickness<L: Law<f64>>(law: &L, paths: usize) {
    let mut chance = Chance(17);
    for path in 0..paths {
        let size = [1e-6, 1e-3, 0.02, 0.1][path % 4];
        let (mut f, mut stress, mut history) = (Matrix::IDENTITY, Symmetric::ZERO, L::History::ZERO);
        for _ in 0..10 {
            let [along, across] = [0, 1].map(|_| (size * chance.signed()).exp());
            let (sine, cosine) = chance.signed().sin_cos();
            let stretched = Matrix([[along, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, 1.0]]);
            let turned = Matrix([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]]);
            let increment = turned * stretched;
            let deformation = increment * f;
            let jacobian = deformation.det();
            let motion = Motion { deformation, jacobian, increment, stress, dt: 1e-3 };
            let found = thickening(law, &motion, &history);
            assert_eq!(found.found, 1, "{path}: {motion:?}");
            let moved = motion.thickened(found.stretch);
            let response = law.respond(&moved, &history);
            let modulus = law.wave_modulus(&moved.deformation, moved.jacobian, &history);
            assert!(response.stress.0[2].abs() < 1e-9 * modulus, "{path}: {:?}", response.stress);
            (f, stress, history) = (moved.deformation, response.stress, response.history);
        }
    }
}

/// Two numbers side by side, as the engine has more of them in a register.
#[derive(Clone, Copy, Debug)]
pub struct Two([f64; 2]);

macro_rules! by_lane {
    ($($op:ident $f:ident $assign:ident $g:ident;)*) => {$(
        impl std::ops::$op for Two {
            type Output = Two;
            fn $f(self, other: Two) -> Two {
                Two([self.0[0].$f(other.0[0]), self.0[1].$f(other.0[1])])
            }
        }
        impl std::ops::$assign for Two {
            fn $g(&mut self, other: Two) {
                *self = std::ops::$op::$f(*self, other);
            }
        }
    )*};
}
by_lane! {
    Add add AddAssign add_assign;
    Sub sub SubAssign sub_assign;
    Mul mul MulAssign mul_assign;
    Div div DivAssign div_assign;
}

impl std::ops::Neg for Two {
    type Output = Two;
    fn neg(self) -> Two {
        Two(self.0.map(|x| -x))
    }
}

impl Number for Two {
    const ZERO: Self = Two([0.0; 2]);
    const NOTHING: Self = Two([-0.0; 2]);
    const ONE: Self = Two([1.0; 2]);
    const HALF: Self = Two([0.5; 2]);
    const EPSILON: Self = Two([f64::EPSILON; 2]);
    const SIDE_BY_SIDE: usize = 2;
    fn of(value: f64) -> Self {
        Two([value; 2])
    }
    fn sqrt(self) -> Self {
        Two(self.0.map(Number::sqrt))
    }
    fn cbrt(self) -> Self {
        Two(self.0.map(Number::cbrt))
    }
    fn ln(self) -> Self {
        Two(self.0.map(Number::ln))
    }
    fn exp(self) -> Self {
        Two(self.0.map(Number::exp))
    }
    fn abs(self) -> Self {
        Two(self.0.map(Number::abs))
    }
    fn min(self, other: Self) -> Self {
        Two([self.0[0].min(other.0[0]), self.0[1].min(other.0[1])])
    }
    fn max(self, other: Self) -> Self {
        Two([self.0[0].max(other.0[0]), self.0[1].max(other.0[1])])
    }
    fn at_least(self, other: Self) -> u32 {
        u32::from(self.0[0] >= other.0[0]) | u32::from(self.0[1] >= other.0[1]) << 1
    }
    fn select(lanes: u32, there: Self, elsewhere: Self) -> Self {
        let pick = |lane: usize| if lanes >> lane & 1 == 1 { there.0[lane] } else { elsewhere.0[lane] };
        Two([pick(0), pick(1)])
    }
    fn lane(self, lane: usize) -> f64 {
        self.0[lane]
    }
    fn from_lanes(mut f: impl FnMut(usize) -> f64) -> Self {
        Two([f(0), f(1)])
    }
}

/// Two particles side by side answer with the same bits as one after the other, whatever each does.
pub fn lanes_know_nothing_of_each_other<L: Law<f64>, W: Law<Two>>(law: &L, wide: &W, paths: usize) {
    let mut chance = Chance(13);
    for path in 0..paths {
        let size = [[1e-6, 0.3], [1e-3, 0.0], [0.05, 1e-3], [0.1, 0.1]][path % 4];
        let dt = [1e-6, 1e-3, 1.0][path % 3];
        let mut single = [(Matrix::IDENTITY, Symmetric::ZERO, L::History::ZERO); 2];
        let (mut stress, mut history) = (Symmetric::ZERO, W::History::ZERO);
        for _ in 0..10 {
            let steps = size.map(|size| chance.deformation(size));
            for ((deformation, stress, history), increment) in single.iter_mut().zip(steps) {
                *deformation = increment * *deformation;
                let jacobian = deformation.det();
                let motion = Motion { deformation: *deformation, jacobian, increment, stress: *stress, dt };
                let response = law.respond(&motion, history);
                (*stress, *history) = (response.stress, response.history);
            }
            let both = |of: [Matrix<f64>; 2]| Matrix::from_fn(|i, j| Two(of.map(|one| one.0[i][j])));
            let deformation = [single[0].0, single[1].0];
            let jacobian = Two(deformation.map(|one| one.det()));
            let (deformation, increment) = (both(deformation), both(steps));
            let motion = Motion { deformation, jacobian, increment, stress, dt: Two([dt; 2]) };
            let response = wide.respond(&motion, &history);
            (stress, history) = (response.stress, response.history);
            let waves = wide.wave_modulus(&deformation, jacobian, &history);
            let energy = wide.strain_energy(&deformation, &stress, &history);
            for (lane, (f, alone, remembered)) in single.iter().enumerate() {
                let found = stress.0.iter().chain(history.entries()).chain([&waves, &energy]);
                let last =
                    [law.wave_modulus(f, f.det(), remembered), law.strain_energy(f, alone, remembered)];
                let exact = alone.0.iter().chain(remembered.entries()).chain(&last);
                for (found, exact) in found.zip(exact) {
                    assert_eq!(found.0[lane].to_bits(), exact.to_bits(), "{path}: {found:?} {exact}");
                }
            }
        }
    }
}
