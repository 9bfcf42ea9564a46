//! What the laws of soils share: constants of strength, and the elastic step of grains that may have come apart.
//!
//! ```text
//! p = -tr(sigma)/3,   q = sqrt(3/2 s : s),   s = dev(sigma)               pressure positive
//! p* = p_e - K o                                                           p_e: of the elastic step
//! o  = (0 - p_r)/K where the pressure p_r that flow leaves is below zero, else 0
//! ```
//!
//! o is the volume strain by which soil that bears no tension came apart: it bears no pressure until it has its volume
//! back. Without that, what is pulled apart and pushed together again would take more room than before, and press. Flow
//! that dilates closes the gap as well. Soil that bears tension flows under it, and remembers no gap.

use super::declaration::{
    ANGLE, Absent, AllowedRange, BadConstants, Constant, End, Form, Given, NOT_NEGATIVE, PRESSURE, Quantity,
};
use super::hypoelastic::turned_and_strained;
use super::{History, Hypoelastic, Motion};
use crate::column::Kind;
use crate::tensor::{Number, Symmetric};
use std::f64::consts::FRAC_PI_2;

/// Names of the constants in scene files.
pub(super) const FRICTION_ANGLE: &str = "friction_angle";
pub(super) const DILATION_ANGLE: &str = "dilation_angle";
pub(super) const COHESION: &str = "cohesion";
pub(super) const TENSION_STRENGTH: &str = "tension_strength";

/// Tension that no soil bears, for one without a bound on it [Pa].
const BOUNDLESS: f64 = 1e30;

const ACUTE: AllowedRange = AllowedRange {
    from: End::At(0.0),
    to: End::Beyond(FRAC_PI_2),
    because: " rad, a right angle; degrees have their unit",
};

/// The constants of strength; `tension` says what tension is bounded.
pub(super) const fn constants(tension: &'static str) -> [Constant; 4] {
    [
        Constant::required(
            FRICTION_ANGLE,
            "Angle of internal friction phi, of Mohr and Coulomb.",
            (ANGLE, ACUTE),
            "\"30 deg\"",
        ),
        Constant::optional(
            DILATION_ANGLE,
            "Angle of dilation psi, by which shear loosens, at most the friction angle; 0 without it.",
            (ANGLE, ACUTE),
            0.0,
        ),
        Constant::optional(
            COHESION,
            "Shear strength without pressure, c; 0 without it.",
            (PRESSURE, NOT_NEGATIVE),
            0.0,
        ),
        Constant {
            name: TENSION_STRENGTH,
            summary: tension,
            form: Form::Number(Quantity { name: TENSION_STRENGTH, unit: PRESSURE, bounds: NOT_NEGATIVE }),
            absent: Absent::Judged,
        },
    ]
}

/// Constants of strength in SI units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strength {
    /// phi [rad]
    pub friction_angle: f64,
    /// psi [rad]
    pub dilation_angle: f64,
    /// c [Pa]
    pub cohesion: f64,
    /// As it is given [Pa].
    pub tension_strength: Option<f64>,
}

impl Strength {
    /// # Errors
    /// More dilation than friction, which would make energy of nothing; neither friction nor cohesion.
    pub fn build(given: &Given) -> Result<Self, BadConstants> {
        let strength = Strength {
            friction_angle: given.number(FRICTION_ANGLE),
            dilation_angle: given.number(DILATION_ANGLE),
            cohesion: given.number(COHESION),
            tension_strength: given.get(TENSION_STRENGTH),
        };
        let Strength { friction_angle, dilation_angle, cohesion, .. } = strength;
        if dilation_angle > friction_angle {
            let allowed = format!(
                "at most the {FRICTION_ANGLE}, {friction_angle} rad, else flow would give energy instead of taking it"
            );
            return Err(BadConstants::of(DILATION_ANGLE, format!("{dilation_angle} rad"), allowed));
        }
        if friction_angle == 0.0 && cohesion == 0.0 {
            let found = format!("{FRICTION_ANGLE} = 0 and {COHESION} = 0");
            return Err(BadConstants::together(found, "one of them above 0, else nothing bears shear"));
        }
        Ok(strength)
    }

    /// The same by name.
    pub fn given(&self, given: Given) -> Given {
        let given = given
            .with(FRICTION_ANGLE, self.friction_angle)
            .with(DILATION_ANGLE, self.dilation_angle)
            .with(COHESION, self.cohesion);
        match self.tension_strength {
            Some(strength) => given.with(TENSION_STRENGTH, strength),
            None => given,
        }
    }

    /// The bound of tension where friction alone would bear so much [Pa].
    pub fn tension(&self, borne: f64) -> f64 {
        self.tension_strength.unwrap_or(BOUNDLESS).min(borne).min(BOUNDLESS)
    }
}

/// What a particle of frictional soil remembers.
pub(super) const HISTORY: [History; 3] = [
    History::new("plastic_shear_strain", "", Kind::Number),
    History::new("opening", "", Kind::Number),
    History::new("frictional_dissipation", "J/m^3", Kind::Number),
];

/// The elastic step, and what was before it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial<T> {
    /// sigma* [Pa]
    pub stress: Symmetric<T>,
    /// J times the stress at the start of the step, turned with the material [Pa].
    pub before: Symmetric<T>,
}

/// p [Pa]
#[inline(always)]
pub(super) fn pressure<T: Number>(stress: &Symmetric<T>) -> T {
    -(stress.trace() * T::of(1.0 / 3.0))
}

/// q of a deviator [Pa].
#[inline(always)]
pub(super) fn equivalent<T: Number>(deviator: &Symmetric<T>) -> T {
    (T::of(1.5) * deviator.double_dot(deviator)).sqrt()
}

/// The elastic step of soil that came apart by o.
#[inline(always)]
pub(super) fn trial<T: Number>(elastic: &Hypoelastic<T>, motion: &Motion<T>, opening: T) -> Trial<T> {
    let (turned, strain) = turned_and_strained(motion);
    Trial {
        stress: elastic.strained(&turned, &strain)
            + Symmetric::isotropic(elastic.elastic.bulk_modulus * opening),
        before: turned * (motion.jacobian / motion.increment.det()),
    }
}

/// o of soil with this bound of tension, if flow leaves less pressure than the bound by `missing` [Pa].
#[inline(always)]
pub(super) fn opening<T: Number>(elastic: &Hypoelastic<T>, tension: T, missing: T) -> T {
    T::select(T::ZERO.at_least(tension), missing / elastic.elastic.bulk_modulus, T::ZERO)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::material::plane_stress::thickening;
    use crate::material::tests::{motion_of, rotation, sample_gradients};
    use crate::material::{Entries, Law, Response};
    use crate::tensor::Matrix;

    /// Where a particle is.
    #[derive(Clone, Copy, Debug)]
    pub struct State<H> {
        /// The motion that led there.
        pub motion: Motion<f64>,
        /// What the law remembers.
        pub history: H,
        /// Work of the stress per undeformed volume.
        pub work: f64,
    }

    impl<H: Entries<f64>> State<H> {
        /// Undeformed, under a stress.
        pub fn under(stress: Symmetric<f64>) -> Self {
            State { motion: Motion { stress, ..motion_of(Matrix::IDENTITY) }, history: H::ZERO, work: 0.0 }
        }

        /// After a step.
        pub fn moved<L: Law<f64, History = H>>(&self, law: &L, increment: Matrix<f64>) -> Self {
            let before = self.motion;
            let deformation = increment * before.deformation;
            let jacobian = before.jacobian * increment.det();
            let motion = Motion { deformation, jacobian, increment, ..before };
            let Response { stress, history } = law.respond(&motion, &self.history);
            // Half a step's Jacobian and stress, and the strain at its middle.
            let middle = (increment - Matrix::IDENTITY) * (increment + Matrix::IDENTITY).inverse() * 2.0;
            let mean = (stress * jacobian + before.stress * before.jacobian) * 0.5;
            let work = self.work + mean.double_dot(&middle.symmetric_part());
            State { motion: Motion { stress, ..motion }, history, work }
        }

        pub fn stress(&self) -> Symmetric<f64> {
            self.motion.stress
        }

        pub fn p(&self) -> f64 {
            pressure(&self.motion.stress)
        }

        pub fn q(&self) -> f64 {
            equivalent(&self.motion.stress.deviator())
        }

        pub fn stored<L: Law<f64, History = H>>(&self, law: &L) -> f64 {
            law.strain_energy(&self.motion.deformation, &self.motion.stress, &self.history)
        }
    }

    /// A step along the axes by these logarithmic strains.
    pub fn along_axes(strain: [f64; 3]) -> Matrix<f64> {
        Matrix::from_fn(|i, j| if i == j { strain[i].exp() } else { 0.0 })
    }

    /// Steps that strain z by `axial` each, while x and, if `both`, y have the stress with which all began.
    pub fn pressed<L: Law<f64>>(
        law: &L,
        (start, both): (State<L::History>, bool),
        (steps, axial): (usize, f64),
        mut look: impl FnMut(&State<L::History>),
    ) -> State<L::History> {
        let side = start.stress().0[0];
        let mut now = start;
        for _ in 0..steps {
            let step =
                |lateral: f64| now.moved(law, along_axes([lateral, if both { lateral } else { 0.0 }, axial]));
            let (mut low, mut high) = (-4.0 * axial.abs(), 4.0 * axial.abs());
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                match step(middle).stress().0[0] > side {
                    true => high = middle,
                    false => low = middle,
                }
            }
            now = step(0.5 * (low + high));
            look(&now);
        }
        now
    }

    /// The same numbers on every machine, between -1 and 1.
    pub struct Chance(u64);

    impl Chance {
        pub fn new(seed: u64) -> Self {
            Chance(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
        }

        pub fn next(&mut self) -> f64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }

        /// A displacement gradient of this size whose step keeps every direction's orientation.
        pub fn increment(&mut self, size: f64) -> Matrix<f64> {
            loop {
                let step = Matrix::IDENTITY + Matrix::from_fn(|_, _| self.next() * size);
                if step.det() > 0.05 {
                    return step;
                }
            }
        }
    }

    impl Chance {
        /// The same in the plane, at constant thickness.
        pub fn in_plane(&mut self, size: f64) -> Matrix<f64> {
            let mut step = self.increment(size);
            for i in 0..2 {
                (step.0[i][2], step.0[2][i]) = (0.0, 0.0);
            }
            step.0[2][2] = 1.0;
            step
        }
    }

    /// Walks 20,000 random paths of a few steps, from no strain at all to strains of several tenths in a step, and
    /// looks at each state and the one before.
    pub fn random_paths<L: Law<f64>>(
        law: &L,
        start: impl Fn(&mut Chance) -> Symmetric<f64>,
        mut look: impl FnMut(&State<L::History>, &State<L::History>),
    ) {
        const SIZES: [f64; 8] = [0.0, 1e-15, 1e-8, 1e-5, 1e-3, 1e-2, 0.1, 0.5];
        for path in 0..20_000u64 {
            let mut chance = Chance::new(path + 1);
            let size = SIZES[path as usize % SIZES.len()];
            let mut now = State::under(start(&mut chance));
            for step in 0..8 {
                // Some return, some turn, some are of another size.
                let size = if step % 4 == 3 { SIZES[(path / 8) as usize % SIZES.len()] } else { size };
                let mut increment = chance.increment(size);
                if step % 3 == 2 {
                    increment = increment * ((1.0 + chance.next() * size.min(0.3)) / increment.det().cbrt());
                }
                let next = now.moved(law, increment);
                assert!(next.stress().is_finite(), "{path} {step}: {:?} {:?}", now.motion, next.motion);
                assert!(
                    next.history.entries().iter().all(|x| x.is_finite()),
                    "{path} {step}: {:?}",
                    next.motion
                );
                let modulus = law.wave_modulus(&next.motion.deformation, next.motion.jacobian, &next.history);
                assert!(modulus.is_finite() && modulus >= 0.0, "{path} {step}: {modulus}");
                look(&now, &next);
                now = next;
            }
        }
    }

    /// Pressed soil that noise shakes, in shape and volume, while it is compressed by 1e-3 in all: at the end there is
    /// no gap, and the pressure is K times the volume strain. The noise is ten times what the pressure compresses, so
    /// on the way the soil opens again and again.
    pub fn noise_leaves_no_gap<L: Law<f64, History = [f64; 3]>>(law: &L, bulk_modulus: f64) {
        let (steps, compression, borne) = (4000, 1e-3, 2e-4);
        for seed in 1..=20 {
            let mut chance = Chance::new(seed);
            let mut state: State<[f64; 3]> = State::under(Symmetric::isotropic(-borne * bulk_modulus));
            let mut opened = 0;
            for step in 1..=steps {
                let noise = if step == steps { 0.0 } else { 2e-3 * chance.next() };
                let volume = (noise - compression * f64::from(step) / f64::from(steps)).exp();
                let shape = chance.increment(1e-3);
                let wanted = volume / state.motion.jacobian / shape.det();
                state = state.moved(law, shape * wanted.cbrt());
                opened += i32::from(state.history[1] > 0.0);
            }
            assert!((steps / 20..steps / 2).contains(&opened), "{seed}: open in {opened} steps");
            let exact = (borne + compression) * bulk_modulus;
            assert!(state.history[1] == 0.0 && (state.p() / exact - 1.0).abs() < 1e-3, "{seed}: {state:?}");
        }
    }

    /// A turn leaves energies, history and the stress in the material's frame alone.
    pub fn only_turns<L: Law<f64>>(law: &L, before: &State<L::History>) {
        let q = rotation();
        let after = before.moved(law, q);
        let expected = before.stress().rotated(&q);
        let scale = before.p().abs() + before.q();
        for (s, e) in after.stress().0.iter().zip(expected.0) {
            assert!((s - e).abs() < 1e-11 * scale, "{s} {e}");
        }
        for (a, b) in after.history.entries().iter().zip(before.history.entries()) {
            assert!((a - b).abs() < 1e-11 * (1.0 + b.abs()), "{a} {b}");
        }
    }

    /// The largest J times stiffness against longitudinal waves by the next small step over [`Law::wave_modulus`].
    pub fn stiffest<L: Law<f64>>(law: &L, state: &State<L::History>) -> f64 {
        let (f, j) = (&state.motion.deformation, state.motion.jacobian);
        let allowed = law.wave_modulus(f, j, &state.history);
        let mut chance = Chance::new(7);
        let mut largest = 0.0f64;
        // A stress that relaxes does so without strain as well.
        let rest = state.moved(law, Matrix::IDENTITY);
        for _ in 0..40 {
            let n = [chance.next(), chance.next(), chance.next()];
            let square: f64 = n.iter().map(|x| x * x).sum();
            for change in [1e-7, -1e-7] {
                let step = Matrix::from_fn(|a, b| n[a] * n[b] / square * change) + Matrix::IDENTITY;
                let after = state.moved(law, step).stress() - rest.stress();
                let along: f64 =
                    (0..3).map(|a| (0..3).map(|b| n[a] * n[b] * after.at(a, b)).sum::<f64>()).sum();
                largest = largest.max(j * along / (square * change) / allowed);
            }
        }
        largest
    }

    /// The same over 200 random paths of a few steps from a stress.
    pub fn stiffest_on_paths<L: Law<f64>>(law: &L, stress: Symmetric<f64>) -> f64 {
        let start = State::under(stress);
        let mut largest = stiffest(law, &start);
        let mut chance = Chance::new(3);
        for path in 0..200 {
            let mut state = start;
            for _ in 0..4 {
                state = state.moved(law, chance.increment([1e-3, 1e-2][path % 2]));
                largest = largest.max(stiffest(law, &state));
            }
        }
        largest
    }

    /// Plates on 300 random paths from rest have a thickness that leaves next to no stress out of the plane, over this
    /// modulus.
    pub fn plates_have_a_thickness<L: Law<f64> + std::fmt::Debug>(law: &L, modulus: f64) {
        for path in 0..300 {
            let mut chance = Chance::new(path + 1);
            let mut state: State<L::History> = State::under(Symmetric::ZERO);
            let size = [1e-5, 1e-4, 1e-3, 1e-2][path as usize % 4];
            for _ in 0..6 {
                let mut step = chance.in_plane(size);
                let deformation = step * state.motion.deformation;
                let jacobian = deformation.det();
                let motion = Motion { deformation, jacobian, increment: step, ..state.motion };
                let found = thickening(law, &motion, &state.history);
                let now = (state.motion, state.history.entries());
                assert_eq!(found.found, 1, "{law:?} {path} {now:?} {step:?}");
                step.0[2][2] = found.stretch;
                state = state.moved(law, step);
                assert!(state.stress().0[2].abs() < 1e-7 * modulus, "{:?}", state.motion);
            }
        }
    }

    /// Steps along sample gradients of this size, to and fro, from a stress: by how much the work misses what is stored
    /// and dissipated, over the work done in magnitude.
    pub fn ledger<L: Law<f64>>(law: &L, (stress, size): (Symmetric<f64>, f64), steps: usize) -> f64 {
        let mut worst = 0.0f64;
        for h in sample_gradients() {
            let path = |t: f64| {
                let f = Matrix::IDENTITY + h * (size * (5.0 * t).sin());
                f * ((1.0 - 0.02 * size * (3.0 * t).sin()) / f.det().cbrt())
            };
            let start: State<L::History> = State::under(stress);
            let (mut now, mut done) = (start, 0.0);
            for i in 1..=steps {
                let next = path(i as f64 / steps as f64);
                let moved = now.moved(law, next * now.motion.deformation.inverse());
                done += (moved.work - now.work).abs();
                now = moved;
            }
            let gained = now.stored(law) - start.stored(law) + law.dissipation(&now.history);
            worst = worst.max((gained - now.work).abs() / done);
        }
        worst
    }

    /// Random paths in single precision: everything stays finite, and the stress off the surface by little more than it
    /// rounds to. `outside` is over the scale of stress.
    pub fn in_single_precision<L: Law<f32>>(
        law: &L,
        pressed: f32,
        mut outside: impl FnMut(&Motion<f32>, &L::History) -> f32,
    ) {
        const SIZES: [f64; 6] = [0.0, 1e-7, 1e-5, 1e-3, 1e-2, 0.2];
        for path in 0..6_000u64 {
            let mut chance = Chance::new(path + 1);
            let (mut f, mut history) = (Matrix::IDENTITY, L::History::ZERO);
            let mut stress = Symmetric::isotropic(-pressed * (1.0 + chance.next() as f32));
            for _ in 0..8 {
                let step = chance.increment(SIZES[path as usize % SIZES.len()]);
                let increment = Matrix(step.0.map(|row| row.map(|x| x as f32)));
                f = increment * f;
                let mut motion = Motion { deformation: f, jacobian: f.det(), increment, stress, dt: 1e-4 };
                let response = law.respond(&motion, &history);
                (stress, history) = (response.stress, response.history);
                motion.stress = stress;
                assert!(stress.is_finite(), "{path}: {motion:?}");
                assert!(history.entries().iter().all(|x| x.is_finite()), "{path}: {motion:?}");
                let off = outside(&motion, &history);
                assert!(off < 1e-5, "{path}: {motion:?} {off}");
            }
        }
    }
}
